#include "figure/paper.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "figure/compose.hpp"
#include "figure/ticks.hpp"
#include "simulate/impact.hpp"
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

// The surface y = sin x under the path.
void add_surface(Panel& panel, const Theme& theme) {
    Curve surface;
    surface.stroke = {theme.surface, 1.0, {}};
    for (int i = 0; i <= 400; ++i) {
        const double x = panel.x.low + (panel.x.high - panel.x.low) * i / 400.0;
        surface.points.push_back({x, std::sin(x)});
    }
    panel.curves.insert(panel.curves.begin(), surface);
}

const Event* nth(const Trajectory& trajectory, Event::Kind kind, int n) {
    for (const Event& event : trajectory.events)
        if (event.kind == kind && n-- == 0) return &event;
    return nullptr;
}

std::string time_of(const Event* event) { return event == nullptr ? "none" : fmt::format("{:.9g}", event->t); }

std::string row(const std::string& what, const std::string& paper, const std::string& ours, const std::string& why) {
    const std::string text = fmt::format("  {:<34} {:<14} {:<16} {}", what, paper, ours, why);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
}

}  // namespace

std::vector<NamedFigure> paper_figures(const Trajectory& ball, const Trajectory& pendulum) {
    const Theme theme = light_theme();
    std::vector<Panel> panels;
    const std::vector<Sample> of_ball = plot_samples(ball), of_pendulum = plot_samples(pendulum);
    const auto add = [&](const Trajectory& run, std::span<const Sample> samples, const ViewDescription& what) {
        panels.push_back(compose(run, samples, PreparedView(*run.model, what), theme));
    };
    add(ball, of_ball, view("(a)", "t", "x"));
    add(ball, of_ball, view("(b)", "t", "y"));
    add(ball, of_ball, view("(c)", "t", "gap"));
    add(ball, of_ball, view("(d)", "x", "y"));
    add_surface(panels.back(), theme);
    add(pendulum, of_pendulum, view("(e)", "t", "theta1"));
    add(pendulum, of_pendulum, view("(f)", "t", "theta2"));
    place_legend(panels[0]);

    std::vector<NamedFigure> figures;
    Figure page;
    page.background = theme.background;
    page.ink = theme.ink;
    page.grid = theme.grid;
    for (Panel panel : panels) {
        Figure single = page;
        single.panels.push_back(panel);
        place_legend(single.panels[0]);
        figures.push_back({"fig4" + panel.title.substr(1, 1), 900, 600, single});
    }
    page.columns = 2;
    page.panels = panels;
    figures.push_back({"fig4", 1400, 1350, page});
    return figures;
}

double rest_time_with_threshold(const Trajectory& ball, double speed) {
    Run run = ball.run;
    run.options.truncation.conditions =
        Conditions::paper;  // the sharp ones would end the bouncing before the threshold
    double elapsed = 0.0;
    for (int zeno = 0; zeno < 2; ++zeno) {
        run.options.end_time = ball.run.options.end_time - elapsed;
        const Trajectory motion = simulate(ball.model, run);
        Surface surface(*ball.model, run);
        const Event* cut = nullptr;
        for (const Event& event : motion.events) {
            if (event.kind != Event::Kind::impact || event.impact_speed >= speed) continue;
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

std::string paper_table(const Trajectory& ball, const Trajectory& pendulum) {
    std::string text = "Or & Ames 2009, Fig. 4: the paper's numbers and ours\n\n";
    text += row("", "paper", "Achilles", "");
    const Event* last = nth(ball, Event::Kind::zeno, 1);
    text += row("ball, first Zeno time", "about 3", time_of(nth(ball, Event::Kind::zeno, 0)), "read off the plot");
    text += row("ball, release", "about 4", time_of(nth(ball, Event::Kind::release, 0)), "read off the plot");
    text += row("ball, second Zeno time", "about 11", time_of(last), "see below");
    const Event* lock = nth(pendulum, Event::Kind::zeno, 0);
    text += row("pendulum, first lock", "", time_of(lock), "");
    if (lock != nullptr)
        text += row("pendulum, theta1 at the first lock", "about -40 deg",
                    fmt::format("{:.4g} deg", lock->q[0] * 180.0 / std::numbers::pi), "read off the plot");
    const Event* release = nth(pendulum, Event::Kind::release, 0);
    text += row("pendulum, first release", "", time_of(release), "");
    if (release != nullptr)
        text += row("pendulum, theta1 at release", "0", fmt::format("{:.1g}", release->q[0] + 0.0),
                    "hddot = g sin(theta1)/L~");
    text += fmt::format(
        "\nThe second Zeno time of the ball is {}, not 11. A simulation that comes to rest at the first impact with\n"
        "hddot < 0 and a speed below 1 does so at {:.4g} in the second valley, which one would read as about 11.\n"
        "The restitution is 0.5; the paper's text for Example 3 prints 10.5.\n",
        time_of(last), rest_time_with_threshold(ball, 1.0));
    return text;
}

}  // namespace achilles
