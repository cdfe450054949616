// Impacts of two sliding contacts that collapse (theory-collapse.md 5): W is not symmetric, and friction takes a fixed
// share of every impact.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "contacts/collapse.hpp"
#include "core/simulate/collapses.hpp"

namespace achilles {
namespace {

using test::collapses_of;
using test::run_cut_at;

// Planes at an angle with W_NN = (1, -gamma; -gamma, 1), on which a point slides with the slips z + a x + b y.
struct SlidingPlanes {
    double gamma = 0.9, mu_p = 0.1, mu_r = 0.2, e_p = 0.1, e_r = 0.15;
    std::array<double, 2> slip_p{0.3, -0.2}, slip_r{-0.1, 0.25};  // coefficients of x and y
    double slide = 12.0;                                          // rate of z
    std::string potential = "0", bend_p = "0", bend_r = "0", force = "0";
    std::array<double, 4> start{0.01, -1.0, 0.055, -3.2};  // x, x', y, y'

    double root() const { return std::sqrt(1.0 - gamma * gamma); }
    std::shared_ptr<const Model> model() const {
        return test::typed(fmt::format(
            R"toml(coordinate = [{{name = "x", start = {}, rate = {}, force = "{}"}}, {{name = "y", start = {}, rate = {}}},
    {{name = "z", rate = {}}}]
lagrangian = {{kinetic = "(x'^2 + y'^2 + z'^2)/2", potential = "{}"}}
constraint = [{{name = "p", gap = "x + {}", restitution = {}, slip = "z' + {}*x' + {}*y'", friction = {}}},
    {{name = "r", gap = "{}*y - {}*x + {}", restitution = {}, slip = "z' + {}*x' + {}*y'", friction = {}}}]
run = {{end_time = 0.25}}
)toml",
            start[0], start[1], force, start[2], start[3], slide, potential, bend_p, e_p, slip_p[0], slip_p[1], mu_p,
            root(), gamma, bend_r, e_r, slip_r[0], slip_r[1], mu_r));
    }
};

// The same planes with a constant force (fx, fy), impact after impact: (x', y', z') by impulses of contact and friction.
struct ImpactsInTurn {
    double t = 0.0;
    std::array<double, 3> v{};
    int impacts = 0;
};
ImpactsInTurn impacts_of(const SlidingPlanes& planes, double fx, double fy) {
    const std::array<std::array<double, 3>, 2> normal{{{1.0, 0.0, 0.0}, {-planes.gamma, planes.root(), 0.0}}};
    const std::array<std::array<double, 3>, 2> slip{
        {{planes.slip_p[0], planes.slip_p[1], 1.0}, {planes.slip_r[0], planes.slip_r[1], 1.0}}};
    const std::array<double, 2> mu{planes.mu_p, planes.mu_r}, e{planes.e_p, planes.e_r};
    const auto dot = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    ImpactsInTurn run;
    run.v = {planes.start[1], planes.start[3], planes.slide};
    std::array<double, 2> h{planes.start[0], planes.root() * planes.start[2] - planes.gamma * planes.start[0]};
    const std::array<double, 3> force{fx, fy, 0.0};
    const auto landing = [](double gap, double rate, double acceleration) {
        const double D = rate * rate - 2.0 * acceleration * gap;
        return rate < 0.0 && D > 0.0 ? 2.0 * gap / (-rate + std::sqrt(D)) : std::numeric_limits<double>::infinity();
    };
    for (; run.impacts < 800 && std::max(h[0], h[1]) > 1e-290; ++run.impacts) {
        const std::array<double, 2> rate{dot(normal[0], run.v), dot(normal[1], run.v)},
            a{dot(normal[0], force), dot(normal[1], force)},
            waits{landing(h[0], rate[0], a[0]), landing(h[1], rate[1], a[1])};
        const std::size_t next = waits[0] > 0.0 && waits[0] < waits[1] ? 0 : 1;
        const double wait = waits[next];
        run.t += wait;
        h[1 - next] += wait * (rate[1 - next] + 0.5 * wait * a[1 - next]);
        h[next] = 0.0;
        for (std::size_t i = 0; i < 3; ++i) run.v[i] += wait * force[i];
        std::array<double, 3> direction = normal[next];
        for (std::size_t i = 0; i < 3; ++i) direction[i] -= mu[next] * slip[next][i];  // the slip is positive
        const double impulse = -(1.0 + e[next]) * dot(normal[next], run.v) / dot(normal[next], direction);
        for (std::size_t i = 0; i < 3; ++i) run.v[i] += impulse * direction[i];
    }
    return run;
}

// Time and velocity afterwards are those of the sequence of impacts, one by one.
TEST(SlidingCollapse, EndsWhereTheImpactsInTurnEnd) {
    SlidingPlanes planes;
    planes.potential = "x + 2*y";
    for (const double mu : {0.0, 0.1, 0.4}) {
        planes.mu_p = mu;
        planes.mu_r = 0.5 * mu + 0.05;
        const ImpactsInTurn exact = impacts_of(planes, -1.0, -2.0);
        ASSERT_GT(exact.impacts, 20);
        const auto model = planes.model();
        for (const Method method : test::both_methods) {
            const Trajectory run = run_cut_at(model, 1e-10, method);
            ASSERT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
            const auto collapses = collapses_of(run);
            ASSERT_EQ(collapses.size(), 1u) << mu;
            EXPECT_NEAR(collapses[0].t, exact.t, 1e-11) << mu;
            const Certificate& certificate = *collapses[0].certificate;
            EXPECT_LE(certificate.zeno_low, exact.t + 1e-13);
            EXPECT_GE(certificate.zeno_high, exact.t - 1e-13);
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(collapses[0].v_after[i], exact.v[static_cast<std::size_t>(i)], 1e-10) << mu;
        }
    }
}

// With friction the factor of the speeds is that of the unsymmetric W, and heat and loss add up to the lost energy.
TEST(SlidingCollapse, ReportsThePlasticImpactWithFriction) {
    SlidingPlanes planes;
    planes.potential = "x + 2*y";
    const Trajectory run = run_cut_at(planes.model(), 1e-8);
    ASSERT_EQ(collapses_of(run).size(), 1u) << run.outcome.message;
    const Event event = collapses_of(run)[0];
    const double W12 = -0.9 - planes.mu_r * planes.slip_r[0], W11 = 1.0 - planes.mu_p * planes.slip_p[0],
                 W21 = -0.9 - planes.mu_p * (-0.9 * planes.slip_p[0] + planes.root() * planes.slip_p[1]),
                 W22 = 1.0 - planes.mu_r * (-0.9 * planes.slip_r[0] + planes.root() * planes.slip_r[1]);
    const AlternateImpacts law({W11, W12, W21, W22, {planes.e_p, planes.e_r}});
    EXPECT_NEAR(event.collapse_info->speed_ratio, law.mu_plus, 1e-12);
    EXPECT_NEAR(event.collapse_info->gap_ratio, law.mu_minus, 1e-12);
    const double kept = 0.5 * event.v_after.squaredNorm(),
                 given = 0.5 * (planes.slide * planes.slide + planes.start[1] * planes.start[1] +
                                planes.start[3] * planes.start[3]) +
                         planes.start[0] + 2.0 * planes.start[2];
    EXPECT_NEAR(event.heat + event.loss, given - kept, 1e-9);
    EXPECT_GT(event.heat, 0.1);
}

// The certificates of early cuts, against cuts at the resolution of double precision, on random pairs with curved gaps and
// forces that slide with either sign.
TEST(SlidingCollapse, CertificatesOfEarlyCutsContainTheTrueMotion) {
    std::mt19937 random(7);
    const auto draw = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    test::EarlyCuts cuts;
    for (int i = 0; i < 30; ++i) {
        SlidingPlanes planes;
        planes.gamma = draw(0.90, 0.97);
        planes.mu_p = draw(0.0, 0.2);
        planes.mu_r = draw(0.0, 0.2);
        planes.e_p = draw(0.03, 0.15);
        planes.e_r = draw(0.03, 0.15);
        for (std::size_t k = 0; k < 2; ++k) {
            planes.slip_p[k] = draw(-0.3, 0.3);
            planes.slip_r[k] = draw(-0.3, 0.3);
        }
        planes.slide = draw(0.0, 1.0) < 0.5 ? draw(12, 18) : draw(-18, -12);
        planes.start = {0.01, -draw(0.9, 1.1), (0.0108 * draw(0.9, 1.1) + planes.gamma * 0.01) / planes.root(),
                        -(planes.gamma + draw(0.4, 0.6)) / planes.root()};
        planes.potential = fmt::format("{}*x + {}*y + {}*z^2", draw(-3, 3), draw(-3, 3), draw(-1, 1));
        planes.force = fmt::format("{}*z'*x' + {}*y'", draw(-0.1, 0.1), draw(-1, 1));
        planes.bend_p = fmt::format("{}*z^2 + {}*x*z", draw(-0.01, 0.01), draw(-0.1, 0.1));
        planes.bend_r = fmt::format("{}*z^2 + {}*y*z", draw(-0.01, 0.01), draw(-0.1, 0.1));
        SCOPED_TRACE(i);
        cuts.compare(planes.model());
    }
    EXPECT_GE(cuts.compared, 27);
    EXPECT_GE(cuts.resolved, 15);   // else the cuts were not early
    EXPECT_GT(cuts.closest, 1e-4);  // else the bounds would say nothing
}

// Two contacts that close at once come to rest at once, and slide on with what the friction of the plastic impact leaves.
TEST(SlidingCollapse, ATieIsThePlasticImpact) {
    SlidingPlanes planes;
    planes.start = {0.0, -1.0, 0.0, -3.5};
    planes.potential = "x + y";
    const Trajectory run = run_cut_at(planes.model(), 1e-8);
    ASSERT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    ASSERT_GE(run.events.size(), 2u);
    EXPECT_TRUE(run.events[0].is_impact());
    ASSERT_TRUE(run.events[1].is_collapse());
    const Event& event = run.events[1];
    EXPECT_EQ(event.certificate->zeno_low, event.certificate->zeno_high);
    EXPECT_NEAR(event.v_after[0], 0.0, 1e-14);
    EXPECT_NEAR(event.v_after[1], 0.0, 1e-14);
    double friction = 0.0;
    const auto& impulses = event.collapse_info->impulses;
    friction += planes.mu_p * impulses.at(0).second + planes.mu_r * impulses.at(1).second;
    EXPECT_GT(friction, 0.1);
    EXPECT_NEAR(event.v_after[2], planes.slide - friction, 1e-13);
    EXPECT_EQ(slip_sign(event.mode.state(0)), 1);
    EXPECT_EQ(slip_sign(event.mode.state(1)), 1);
}

// Where the impacts use up the slip, its sign is not kept, and the sequence is not cut before that.
TEST(SlidingCollapse, IsNotCutWhereASlipMayEnd) {
    SlidingPlanes planes;
    planes.mu_p = planes.mu_r = 0.4;
    planes.potential = "x + 2*y";
    const Trajectory slides_on = run_cut_at(planes.model(), 0.01);
    ASSERT_EQ(collapses_of(slides_on).size(), 1u);
    const double lost = planes.slide - collapses_of(slides_on)[0].v_after[2];  // of the slip
    int cut = 0;
    for (const double short_of : {3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001}) {
        planes.slide = lost - short_of;
        const Trajectory run = run_cut_at(planes.model(), 0.01);
        // A wrong cut would end here: the slip would reach zero before the collapse.
        EXPECT_EQ(run.outcome.message.find("before the Zeno time"), std::string::npos) << run.outcome.message;
        for (const Event& event : collapses_of(run)) {
            ++cut;
            const auto slip = [&](const Vector& v) { return v[2] + planes.slip_p[0] * v[0] + planes.slip_p[1] * v[1]; };
            EXPECT_GT(slip(event.truncation->v_before) * slip(event.v_after), 0.0) << short_of;
            EXPECT_GT(slip_sign(event.mode.state(0)) * slip(event.v_after), 0.0) << short_of;
        }
    }
    EXPECT_LT(cut, 4);
}

// An independent program (scipy's DOP853, impact by impact, plastic impacts at the ends) gave these numbers; without
// friction it agrees with tests/reference/collapse.json to 1e-13.
TEST(SlidingCollapse, TheSliderCrankWithFrictionRunsToItsEnd) {
    const auto model = test::load("slider_crank_friction");
    const std::vector<double> collapse{0.00269250443070, 0.02589436783950, 0.03981508743462, 0.06214192419839,
                                       0.07205775738680},
        release{0.01503132845240, 0.03434504307467, 0.05083541866627, 0.06834157226589, 0.08354928075546};
    for (const Method method : test::both_methods) {
        const Trajectory run = run_cut_at(model, 1e-11, method);
        ASSERT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        const auto collapses = collapses_of(run), releases = test::events_of(run, Event::Kind::release);
        ASSERT_EQ(collapses.size(), collapse.size());
        ASSERT_EQ(releases.size(), release.size());
        for (std::size_t i = 0; i < collapse.size(); ++i) {
            EXPECT_NEAR(collapses[i].t, collapse[i], 3e-11) << i;
            EXPECT_NEAR(releases[i].t, release[i], 3e-11) << i;
        }
        EXPECT_NEAR(test::events_of(run, Event::Kind::reversal).at(0).t, 0.03414086107678, 3e-11);
        EXPECT_NEAR(run.end.q[0], 7.573849471527009, 1e-9);
        EXPECT_NEAR(run.end.q[1], -0.4975130322927959, 1e-9);
        EXPECT_NEAR(run.end.v[0], 64.292487292806, 1e-6);
    }
}

}  // namespace
}  // namespace achilles
