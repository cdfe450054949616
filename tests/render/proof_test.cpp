// Tubes of a proof around the curves of plots over time.
#include "figure/proof.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/systems.hpp"
#include "figure/layout.hpp"
#include "figure/publication.hpp"
#include "paint/paint.hpp"
#include "paint/svg.hpp"
#include "render/support.hpp"

namespace achilles {
namespace {

struct ProofFixture {
    explicit ProofFixture(const std::string& name, double end, const InitialUncertainty& spread = {}) {
        const auto model = test::load(name);
        Run asked = model->default_run();
        asked.options.end_time = end;
        run = simulate(model, asked);
        proof = proof_of(run, spread);
    }
    Panel plot(const ViewDescription& view, const Framing& framing = {}) const {
        const PreparedView prepared(*run.model, view);
        const Theme theme = light_theme();
        return with_proof(compose(run, plot_samples(run), prepared, theme, framing), run, proof, prepared, framing,
                          theme);
    }
    Trajectory run;
    Proof proof;
};

ViewDescription over_time(const std::vector<std::string>& y) {
    ViewDescription view;
    view.x.text = "t";
    for (const std::string& text : y) view.y.push_back({text, {}});
    return view;
}

// Whether the slices of a tube around the time t contain y.
bool holds(const Tube& tube, double t, double y) {
    for (std::size_t i = 0; i + 1 < tube.slices.size(); ++i) {
        const Tube::Slice &a = tube.slices[i], &b = tube.slices[i + 1];
        if (!(a.x <= t && t <= b.x)) continue;
        const double share = b.x > a.x ? (t - a.x) / (b.x - a.x) : 0.0, slack = 1e-5;  // error of the chord between
                                                                                       // instants
        return y >= a.low + share * (b.low - a.low) - slack && y <= a.high + share * (b.high - a.high) + slack;
    }
    return false;
}

// Every member of the box stays inside the tubes, including rates and gaps. Excluded are times between two instants
// within which a member's event and that of the curve lie.
TEST(ProofTube, HoldsTheMembers) {
    const ProofFixture ball("ball_on_sine", 6.0, {1e-3, {}});
    ASSERT_GT(ball.proof.enclosure.proved_until, 2.0);
    const Panel panel = ball.plot(over_time({"x", "y", "gap"}));
    ASSERT_EQ(panel.tubes.size(), 3U);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> off(-1e-3, 1e-3);
    int asked = 0;
    for (int member = 0; member < 30; ++member) {
        achilles::Run run = ball.run.run;
        for (Eigen::Index i = 0; i < 2; ++i) run.q[i] += off(random), run.v[i] += off(random);
        const Trajectory truth = simulate(ball.run.model, run);
        Sampler sampler(truth);
        for (double t = 0.01; t < ball.proof.enclosure.proved_until - 0.02; t += 0.037, ++asked) {
            const State state = sampler.at(t).state;
            const double gap = state.q[1] - std::sin(state.q[0]);
            EXPECT_TRUE(holds(panel.tubes[0], t, state.q[0])) << t;
            EXPECT_TRUE(holds(panel.tubes[1], t, state.q[1])) << t;
            EXPECT_TRUE(holds(panel.tubes[2], t, gap)) << t;
        }
    }
    EXPECT_GT(asked, 1000);
}

// The tube is not drawn where its curve hides it. In a close view it is drawn at the proved distance from the curve.
TEST(ProofTube, IsDrawnWhereItIsSeen) {
    const ProofFixture ball("ball_on_sine", 4.0, {1e-8, {}});
    EXPECT_TRUE(ball.plot(over_time({"x"})).tubes.empty());
    const double x = Sampler(ball.run).at(3.5).state.q[0];
    Framing close;
    const double reach = 2e-6;
    close.x = {3.5 - reach, 3.5 + reach};
    close.y = {x - reach, x + reach};
    Panel panel;
    {
        const PreparedView prepared(*ball.run.model, over_time({"x"}));
        panel = with_proof(compose(ball.run, plot_samples(ball.run), prepared, light_theme(), close), ball.run,
                           ball.proof, prepared, close, light_theme());
    }
    ASSERT_EQ(panel.tubes.size(), 1U);
    double first = 3.5, last = 3.5;  // the curve is straight here, and so is its tube
    for (const Tube::Slice& at : panel.tubes[0].slices) {
        if (!(std::abs(at.x - 3.5) <= 1.001 * reach)) continue;
        EXPECT_LT(at.high - at.low, 1e-6);
        EXPECT_GT(at.high - at.low, 2e-8);
        first = std::min(first, at.x), last = std::max(last, at.x);
    }
    EXPECT_LT(first, 3.5 - 0.99 * reach);
    EXPECT_GT(last, 3.5 + 0.99 * reach);
}

// No member has a negative gap, and in contact the gap is 0.
TEST(ProofTube, KnowsWhatTheSurfaceForbids) {
    const ProofFixture ball("ball_on_sine", 3.5, {1e-5, {}});
    ASSERT_TRUE(ball.proof.enclosure.end);
    Framing close;
    close.y = {-1e-4, 1e-4};
    const Panel panel = ball.plot(over_time({"gap"}), close);
    ASSERT_EQ(panel.tubes.size(), 1U);
    double zeno = 0.0;
    for (const EnclosedEvent& event : ball.proof.enclosure.events)
        if (event.kind == Event::Kind::zeno) zeno = event.t.hi();
    ASSERT_GT(zeno, 2.7);
    for (const Tube::Slice& at : panel.tubes[0].slices) {
        EXPECT_GE(at.low, -1e-14) << at.x;
        if (at.x > zeno + 1e-3) {
            EXPECT_NEAR(at.high, 0.0, 1e-12) << at.x;
        }
    }
}

// A line marks the end of the proof, and no tube follows.
TEST(ProofTube, EndsWhereTheProofIsUndecided) {
    const ProofFixture ball("ball_on_sine", 4.0, {2e-2, {}});
    const double until = ball.proof.enclosure.proved_until;
    ASSERT_FALSE(ball.proof.enclosure.end);
    const Panel panel = ball.plot(over_time({"x", "y"}));
    ASSERT_EQ(panel.tubes.size(), 2U);
    for (const Tube& tube : panel.tubes)
        for (const Tube::Slice& at : tube.slices) EXPECT_LE(at.x, until);
    const auto mark = std::find_if(panel.markers.begin(), panel.markers.end(),
                                   [](const Markers& markers) { return markers.shape == Markers::MarkerShape::bar; });
    ASSERT_NE(mark, panel.markers.end());
    ASSERT_EQ(mark->points.size(), 1U);
    EXPECT_EQ(mark->points[0].x, until);
    // The text must not claim a later time, although some of these times would be rounded up.
    Proof other = ball.proof;
    for (const double reached : {until, 2.6366666, 1.9999999, 0.3}) {
        other.enclosure.proved_until = reached;
        Figure figure;
        figure.panels = {panel};
        name_proof(figure, other, light_theme());
        ASSERT_EQ(figure.keys.size(), 2U);
        const std::string begin = "undecided from ", &label = figure.keys[1].label;
        ASSERT_TRUE(label.starts_with(begin) && label.ends_with(" s on")) << label;
        EXPECT_LE(std::stold(label.substr(begin.size())), reached) << label;
        EXPECT_GT(std::stold(label.substr(begin.size())), 0.99999 * reached) << label;
    }
    ASSERT_EQ(panel.bands.size(), 1U);
    EXPECT_EQ(panel.bands[0].low, until);
    // A proof has no bounds on work or paths, so nothing is drawn.
    EXPECT_TRUE(ball.plot(over_time({"loss"})).tubes.empty());
    ViewDescription path = over_time({"y"});
    path.x.text = "x";
    EXPECT_TRUE(ball.plot(path).tubes.empty());
    EXPECT_TRUE(ball.plot(path).bands.empty());
}

TEST(ProofTube, IsInTheLegendAndInEveryKindOfPicture) {
    const ProofFixture ball("ball_on_sine", 4.0, {1e-2, {}});
    const std::vector<ViewDescription> views{over_time({"y"})};
    const Figure figure = publication(ball.run, views, {}, &ball.proof);
    ASSERT_GE(figure.keys.size(), 2U);
    const auto named = [&](const std::string& begin) {
        return std::any_of(figure.keys.begin(), figure.keys.end(),
                           [&](const Key& key) { return key.label.starts_with(begin); });
    };
    EXPECT_TRUE(named("proved: start \u00b1 0.01"));
    EXPECT_EQ(named("undecided from "), !ball.proof.enclosure.end.has_value());
    const std::string text = to_text(figure);
    EXPECT_NE(text.find("tube \"proved\""), std::string::npos) << text;
    EXPECT_EQ(to_text(publication(ball.run, views, {})).find("tube"), std::string::npos);
    const auto measure = [](const std::string& label, float size) {
        return 0.5F * size * static_cast<float>(label.size());
    };
    int strips = 0;
    for (const auto& item : layout(figure, measure, {0.0F, 0.0F, 600.0F, 400.0F}, 1.0))
        if (const auto* strip = std::get_if<Strip>(&item)) {
            EXPECT_EQ(strip->upper.size(), strip->lower.size());
            for (std::size_t i = 0; i < strip->upper.size(); ++i)
                EXPECT_LE(strip->upper[i].y, strip->lower[i].y + 1e-9) << i;  // pixels count downward
            ++strips;
        }
    EXPECT_EQ(strips, 2) << "the tube and its key";
    const std::string drawn = svg(figure, {600, 400, 1.0, 0.0}, ACHILLES_BINARY_DIR "/assets/fonts", {});
    EXPECT_NE(drawn.find("fill-opacity=\"0.43\""), std::string::npos);
}

// A path has no tube. Its legend must not suggest that the curve hides one.
TEST(ProofTube, IsNotClaimedWhereNoPlotIsOverTime) {
    const ProofFixture proven("ball_on_sine", 5.0, {0.05, {}});
    ViewDescription path = over_time({"y"});
    path.x.text = "x";
    const auto keys = [&](const std::vector<ViewDescription>& views) {
        std::vector<std::string> labels;  // of the proof only
        for (const auto& key : publication(proven.run, views, {}, &proven.proof, {}).keys)
            if (key.label.starts_with("proved") || key.label.starts_with("undecided")) labels.push_back(key.label);
        return labels;
    };
    ASSERT_EQ(proven.proof.enclosure.outcome.kind, Enclosure::ProofOutcome::Kind::undecided);
    const auto alone = keys({path});
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_TRUE(alone[0].starts_with("proved until ")) << alone[0];
    EXPECT_TRUE(alone[0].ends_with("(tubes are drawn in plots over t only)")) << alone[0];
    const auto both = keys({path, over_time({"y"})});
    ASSERT_EQ(both.size(), 2U);
    EXPECT_EQ(both[0].find("only"), std::string::npos) << both[0];
}

TEST(ProofTube, IsFilledEvenly) {
    Offscreen surface(support::options(200, 100));
    const Image image = support::picture(surface, [](ImDrawList* list) {
        Strip strip{{}, {}, {0, 0, 0, 100}, {0.0F, 0.0F, 200.0F, 100.0F}};
        for (double x = 20.0; x <= 180.0; x += 3.7) {
            strip.upper.push_back({x, 30.0});
            strip.lower.push_back({x, 70.0});
        }
        paint(Sheet{strip}, list);
    });
    const int inside = support::darkness(image, 30, 50);
    EXPECT_NEAR(inside, 100, 2);
    for (int x = 22; x < 176; ++x)
        for (const int y : {32, 50, 67}) EXPECT_EQ(support::darkness(image, x, y), inside) << x << " " << y;
    EXPECT_EQ(support::darkness(image, 100, 27), 0);
    EXPECT_EQ(support::darkness(image, 100, 73), 0);
    EXPECT_EQ(support::darkness(image, 10, 50), 0);
}

}  // namespace
}  // namespace achilles
