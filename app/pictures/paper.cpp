#include "pictures/paper.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "figure/axes.hpp"
#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "figure/publication.hpp"
#include "number/angle.hpp"
#include "output/precision.hpp"
#include "simulate/impact.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

ViewDescription view(const std::string& name, const std::string& x, const std::string& y) {
    ViewDescription result;
    result.name = name;
    result.x.text = x;
    result.y.emplace_back().text = y;
    return result;
}

const Event* nth(const Trajectory& trajectory, Event::Kind kind, int n) {
    for (const Event& event : trajectory.events)
        if (event.kind == kind && n-- == 0) return &event;
    return nullptr;
}

}  // namespace

namespace {

Figure empty_page() {
    const Theme theme = light_theme();
    Figure page;
    page.background = theme.background;
    page.ink = theme.ink;
    return page;
}

// The panels of the paper's figure; the first four show the ball.
std::vector<Panel> paper_panels(const Trajectory& ball, const Trajectory& pendulum) {
    const Theme theme = light_theme();
    Framing framing;
    framing.for_print = true;  // the path panel then includes h = 0, as in `figure`
    std::vector<Panel> panels;
    const std::vector<Sample> of_ball = plot_samples(ball), of_pendulum = plot_samples(pendulum);
    const auto add = [&](const Trajectory& run, std::span<const Sample> samples, const ViewDescription& what) {
        panels.push_back(compose(run, samples, PreparedView(*run.model, what), theme, framing));
    };
    add(ball, of_ball, view("(a)", "t", "x"));
    add(ball, of_ball, view("(b)", "t", "y"));
    add(ball, of_ball, view("(c)", "t", "gap"));
    add(ball, of_ball, view("(d)", "x", "y"));
    add(pendulum, of_pendulum, view("(e)", "t", "theta1"));
    add(pendulum, of_pendulum, view("(f)", "t", "theta2"));
    return panels;
}

Curve level(const Panel& panel, double y, const std::string& label, const Color& color, std::vector<double> dash) {
    return {label, {color, 1.4, std::move(dash)}, {{panel.x.low, y}, {panel.x.high, y}}};
}

// Time of rest from a velocity threshold instead of a certificate, for thresholds from 0 to 1 m/s.
Panel threshold_panel(const Trajectory& ball) {
    constexpr int parts = 200;
    const Theme theme = light_theme();
    Panel panel;
    panel.title = "(a)\u00A0\u00A0second Zeno time of the ball";
    panel.x.label = with_unit("threshold of the impact speed", "m/s");
    panel.y.label = with_unit(typeset("t"), "s");
    set_ticks(panel.x, 0.0, 1.0, 0.0);
    set_ticks(panel.y, 10.8, 12.8, 0.0);
    const Event* certified = nth(ball, Event::Kind::zeno, 1);
    Curve cut;
    cut.label = "if bouncing stops below a threshold speed";
    cut.stroke = {phase_color(theme, Phase::Kind::hybrid), 1.8, {}};
    if (certified != nullptr) cut.points.push_back({0.0, certified->t});
    for (int i = 1; i <= parts; ++i) {
        const double speed = static_cast<double>(i) / parts;
        const double t = contact_time_with_velocity_threshold(ball, speed);
        // The curve jumps where one more impact falls below the threshold.
        if (!cut.points.empty() && std::isfinite(t) && std::abs(t - cut.points.back().y) > 1e-3)
            cut.points.push_back({speed - 0.5 / parts, cut.points.back().y}),
                cut.points.push_back({speed - 0.5 / parts, t});
        cut.points.push_back({speed, t});
    }
    panel.curves.push_back(cut);
    if (certified != nullptr)
        panel.curves.push_back(level(panel, certified->t, "certified, \U0001D70F_{\u221E}",
                                     phase_color(theme, Phase::Kind::constrained), {}));
    panel.curves.push_back(level(panel, 11.0, "read off the paper's plot", theme.surface, {6.0, 3.5}));
    panel.legend = panel.legend_above = true;
    return panel;
}

// Widths of all certified intervals over the impact speed at the cut.
Panel widths_panel(const Trajectory& ball, const Trajectory& pendulum) {
    const Theme theme = light_theme();
    constexpr std::array names{"first", "second", "third"};
    constexpr std::array shapes{Markers::MarkerShape::circle, Markers::MarkerShape::square,
                                Markers::MarkerShape::triangle};
    Panel panel;
    panel.title = "(b)\u00A0\u00A0width of the certified intervals of Zeno times";
    panel.x.label = "impact speed at the cut (m/s, rad/s)";
    panel.y.label = with_unit("width", "s");
    panel.x.logarithmic = panel.y.logarithmic = true;
    double slowest = 1.0, fastest = 1e-12, least = 1.0, most = 1e-16;
    std::size_t hue = 0;
    for (const auto& [name, run] : {std::pair{"ball", &ball}, std::pair{"pendulum", &pendulum}}) {
        const auto all = certified_widths(*run);
        for (std::size_t n = 0; n < all.size() && n < names.size(); ++n, ++hue) {
            Curve curve;
            Markers dots;
            curve.stroke = phase_stroke(theme, Phase::Kind::constrained, hue, 5);
            curve.stroke.width = 1.2;
            dots.label = fmt::format("{}, {}", name, names[n]);
            dots.shape = shapes[n];
            dots.fill = curve.stroke.color;
            dots.edge = theme.background;
            dots.size = 8.0;
            for (const CertifiedWidth& cut : all[n]) {
                curve.points.push_back({cut.speed, cut.high - cut.low});
                slowest = std::min(slowest, cut.speed), fastest = std::max(fastest, cut.speed);
                least = std::min(least, curve.points.back().y), most = std::max(most, curve.points.back().y);
            }
            dots.points = curve.points;
            panel.curves.push_back(curve);
            panel.markers.push_back(dots);
        }
    }
    set_ticks(panel.x, slowest, fastest, 0.06);
    set_ticks(panel.y, least, most, 0.06);
    panel.legend = panel.legend_above = true;
    return panel;
}

}  // namespace

std::vector<NamedFigure> paper_figures(const Trajectory& ball, const Trajectory& pendulum) {
    std::vector<NamedFigure> figures;
    const std::vector<Panel> panels = paper_panels(ball, pendulum);
    const Trajectory* const runs[] = {&ball, &pendulum};
    for (std::size_t i = 0; i < panels.size(); ++i) {
        Figure single = empty_page();
        single.panels.push_back(panels[i]);
        apply_print_style(single, std::span(runs).subspan(i < 4 ? 0 : 1, 1));
        // Panels with equal axes are wide and low here: use a smaller height.
        const int height = panels[i].equal_axes ? 380 : 600;
        figures.push_back({"fig4" + panels[i].title.substr(1, 1), 900, height, single});
    }
    Figure page = empty_page();
    page.columns = 2;
    page.panels = panels;
    apply_print_style(page, runs);
    figures.push_back({"fig4", 1400, 1050, page});
    Figure more = empty_page();
    more.grid.a = 0;
    more.panels = {threshold_panel(ball), widths_panel(ball, pendulum)};
    figures.push_back({"zeno", 1000, 1200, more});
    return figures;
}

std::vector<std::vector<CertifiedWidth>> certified_widths(const Trajectory& trajectory) {
    std::vector<double> times;
    for (const Event& event : trajectory.events)
        if (event.is_zeno()) times.push_back(event.t);
    std::vector<std::vector<CertifiedWidth>> widths(times.size());
    Run run = trajectory.run;
    run.options.truncation.conditions = Conditions::sharp;
    run.options.truncation.reinitialization = Reinitialization::kinetic;
    for (int half_decade = 2; half_decade <= 16; ++half_decade) {
        Truncation& truncation = run.options.truncation;
        truncation.eps_q = truncation.eps_v = truncation.eps_t = std::pow(10.0, -0.5 * half_decade);
        std::size_t n = 0;
        for (const Event& event : simulate(trajectory.model, run).events) {
            if (!event.is_zeno() || n == times.size()) continue;
            std::vector<CertifiedWidth>& of = widths[n++];
            if (!event.certificate || !event.certificate->certified || !event.truncation) continue;
            const CertifiedWidth cut{event.truncation->impact_speed, event.certificate->zeno_low,
                                     event.certificate->zeno_high};
            // Two tolerances may cut at the same impact.
            if (of.empty() || of.back().speed > 1.01 * cut.speed) of.push_back(cut);
        }
    }
    return widths;
}

double contact_time_with_velocity_threshold(const Trajectory& ball, double speed) {
    Run run = ball.run;
    run.options.truncation.conditions =
        // The sharp conditions would end the impact sequence before the threshold.
        Conditions::paper;
    double elapsed = 0.0;
    for (int zeno = 0; zeno < 2; ++zeno) {
        run.options.end_time = ball.run.options.end_time - elapsed;
        const Trajectory motion = simulate(ball.model, run);
        ContactKinematics surface(*ball.model, run);
        const Event* cut = nullptr;
        for (const Event& event : motion.events) {
            if (!event.is_impact() || event.impact_speed >= speed) continue;
            const State landed{event.q, reinitialize(surface.at({event.q, event.v_before}), event.v_before,
                                                     Reinitialization::kinetic)};
            if (surface.normal_acceleration(landed) >= 0.0) continue;
            run.q = landed.q;
            run.v = landed.v;
            cut = &event;
            break;
        }
        if (cut == nullptr) return std::numeric_limits<double>::quiet_NaN();
        elapsed += cut->t;
    }
    return elapsed;
}

namespace {

// A number of the paper for comparison with ours.
struct PaperNumber {
    std::string what, paper, unit;
    double stated;  // as a number; NaN if the paper gives none
    std::optional<double> ours;
    std::string why;
};

std::string row(const std::string& what, const std::string& paper, const std::string& ours,
                const std::string& difference, const std::string& why) {
    const std::string text = fmt::format("  {:<34} {:<14} {:<14} {:<12} {}", what, paper, ours, difference, why);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
}

std::string row(const PaperNumber& s) {
    const std::string unit = s.unit.empty() ? "" : " " + s.unit;
    const double zero = 0.0;  // avoids printing "-0"
    return row(s.what, s.paper, s.ours ? fmt::format("{:.9g}{}", *s.ours + zero, unit) : "none",
               s.ours && std::isfinite(s.stated) ? fmt::format("{:+.3g}{}", *s.ours - s.stated + zero, unit) : "",
               s.why);
}

std::optional<double> time_of(const Event* event) { return event == nullptr ? std::nullopt : std::optional(event->t); }

// The first coordinate at an event, in degrees.
std::optional<double> degrees_at(const Event* event) {
    if (event == nullptr) return std::nullopt;
    const double angle = degrees(event->q[0]);
    return std::abs(angle) < 1e-9 ? 0.0 : angle;
}

// The certified intervals for the sharp conditions and the system's own tolerances.
std::string intervals_text(const std::string& name, const Trajectory& trajectory) {
    Run run = trajectory.run;
    run.options.truncation.conditions = Conditions::sharp;
    std::string text;
    int n = 0;
    for (const Event& event : simulate(trajectory.model, run).events) {
        if (!event.is_zeno() || !event.certificate) continue;
        const Certificate& c = *event.certificate;
        text += fmt::format("  {:<34} {}  width {:.1e}  {} impacts before the cut\n",
                            fmt::format("{}, Zeno time {}", name, ++n), interval_text(c.zeno_low, c.zeno_high),
                            c.zeno_high - c.zeno_low, event.impacts);
    }
    return text;
}

}  // namespace

std::string paper_table(const Trajectory& ball, const Trajectory& pendulum) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const auto time = [](const Trajectory& run, Event::Kind kind, int n) { return time_of(nth(run, kind, n)); };
    const std::string read = "read off the plot";
    const PaperNumber all[] = {
        {"ball, first Zeno time", "about 3", "", 3.0, time(ball, Event::Kind::zeno, 0), read},
        {"ball, release", "about 4", "", 4.0, time(ball, Event::Kind::release, 0), read},
        {"ball, second Zeno time", "about 11", "", 11.0, time(ball, Event::Kind::zeno, 1), "see below"},
        {"pendulum, first lock", "", "", none, time(pendulum, Event::Kind::zeno, 0), ""},
        {"pendulum, theta1 at the first lock", "about -40 deg", "deg", -40.0,
         degrees_at(nth(pendulum, Event::Kind::zeno, 0)), read},
        {"pendulum, first release", "", "", none, time(pendulum, Event::Kind::release, 0), ""},
        {"pendulum, theta1 at release", "0 deg", "deg", 0.0, degrees_at(nth(pendulum, Event::Kind::release, 0)),
         "hddot = g sin(theta1)/L~"}};
    std::string text = "Or & Ames 2009, Fig. 4: the paper's numbers and ours\n\n";
    text += row("", "paper", "Achilles", "difference", "");
    for (const PaperNumber& stated : all) text += row(stated);
    const auto last = time(ball, Event::Kind::zeno, 1);
    text += fmt::format(
        "\nThe second Zeno time of the ball is {}, not 11. A simulation that comes to rest at the first impact with\n"
        "hddot < 0 and a speed below 1 does so at {:.4g} in the second valley, which one would read as about 11.\n"
        "The restitution is 0.5; the paper's text for Example 3 prints 10.5.\n",
        last ? fmt::format("{:.9g}", *last) : "none", contact_time_with_velocity_threshold(ball, 1.0));
    return text +
           "\nCertified intervals of the Zeno times (s; sharp conditions), each for the motion from the computed state "
           "at the cut:\n\n" +
           intervals_text("ball", ball) + intervals_text("pendulum", pendulum);
}

}  // namespace achilles
