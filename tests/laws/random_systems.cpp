#include "laws/random_systems.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <random>

#include "core/systems.hpp"
#include "laws/laws.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

SystemDescription random_system(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const auto from = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    const auto is = [&](double chance) { return from(0.0, 1.0) < chance; };
    const auto restitution = [&] { return is(0.5) ? std::string("0") : fmt::format("{:.3f}", from(0.2, 0.8)); };
    const auto damping = [&](const char* rate) { return is(0.5) ? "0" : fmt::format("-0.2*{}", rate); };
    const bool has_mass = is(0.3);
    std::string text = "title = \"random\"\n";
    const auto coordinate = [&](const char* name, double start, double rate, const std::string& force) {
        text += fmt::format("[[coordinate]]\nname = \"{}\"\nstart = {:.4f}\nrate = {:.4f}\nforce = \"{}\"\n", name,
                            start, rate, force);
    };
    coordinate("x", from(-0.3, 0.3), from(-2.0, 2.0), damping("x'"));
    coordinate("y", from(1.0, 1.6), from(-1.0, 1.0), damping("y'"));
    if (has_mass) coordinate("z", from(3.0, 4.0), from(-2.0, 2.0), damping("z'"));
    text += fmt::format("[lagrangian]\nkinetic = \"(x'^2 + y'^2{})/2\"\npotential = \"9.81*y\"\n",
                        has_mass ? " + 2*z'^2" : "");
    const auto constraint = [&](const std::string& name, const std::string& gap) {
        text +=
            fmt::format("[[constraint]]\nname = \"{}\"\ngap = \"{}\"\nrestitution = {}\n", name, gap, restitution());
    };
    std::string floor = "y";
    if (is(0.6))
        floor += fmt::format(" - {:.4f}*sin({:.4f}*x + {:.4f})", from(0.05, 0.3), from(0.8, 1.3), from(0.0, 6.0));
    if (is(0.3)) floor += fmt::format(" - {:.4f}*sin({:.4f}*t)", from(0.01, 0.2), from(5.0, 20.0));
    constraint("floor", floor);
    if (is(0.8)) constraint("wall", fmt::format("x + {:.4f}{}", from(0.8, 2.0), is(0.2) ? " + 0.1*t" : ""));
    if (is(0.4))
        constraint("disc", fmt::format("sqrt((x - {:.4f})^2 + (y - {:.4f})^2) - 0.4", from(1.0, 1.5), from(0.3, 0.6)));
    if (has_mass) {
        constraint("end", fmt::format("{:.4f} - z", from(4.5, 6.0)));
        constraint("stop", fmt::format("z - {:.4f}", from(2.0, 2.5)));
    }
    return parse_system(text + "[run]\nend_time = 4\n", "random.toml");
}

namespace {

Trajectory run_of(const SystemDescription& system) {
    const auto model = std::make_shared<const Model>(system);
    return simulate(model, model->default_run());
}

// `sign` of the slips is taken for +.
std::string of(const Event& event, int sign) {
    std::string text(names_of(event.kind).word);
    for (const auto& [what, set] : {std::pair("of", event.contacts),
                                    {"held", event.mode.held()},
                                    {"with friction at joints", event.mode.joints()},
                                    {"opened", event.opened}}) {
        text += fmt::format(" {}", what);
        for (const std::size_t i : set) text += fmt::format(" {}", i);
    }
    text += " slipping";
    for (const std::size_t i : event.mode.slipping())
        text += fmt::format(" {}{}", sign * slip_sign(event.mode.state(i)) > 0 ? '+' : '-', i);
    return text;
}

// The system with every gap multiplied by `factor`, the slip at a contact by sign*factor, and that of a joint by sign.
SystemDescription scaled_system(SystemDescription system, double factor, int sign) {
    for (ConstraintDescription& constraint : system.constraints) {
        constraint.gap.text = fmt::format("{:.17g}*({})", factor, constraint.gap.text);
        if (!constraint.has_friction()) continue;
        constraint.slip.text = fmt::format("{:.17g}*({})", sign * factor, constraint.slip.text);
        constraint.friction.text = with_slip(constraint.friction.text, fmt::format("slip/{:.17g}", factor));
    }
    for (FrictionDescription& joint : system.frictions) joint.slip.text = fmt::format("{}*({})", sign, joint.slip.text);
    return system;
}

}  // namespace

std::string difference_by_scaling(const SystemDescription& system, double factor, int sign) {
    const Trajectory one = run_of(system);
    if (one.outcome.kind == Outcome::Kind::undecided) return "undecided";
    const Trajectory two = run_of(scaled_system(system, factor, sign));
    if (one.outcome.kind != two.outcome.kind)
        return fmt::format("'{}' at {} and '{}' at {}", one.outcome.message, one.end_time, two.outcome.message,
                           two.end_time);
    for (std::size_t i = 0; i < std::max(one.events.size(), two.events.size()); ++i) {
        if (i >= one.events.size() || i >= two.events.size())
            return fmt::format("{} and {} events", one.events.size(), two.events.size());
        const Event &a = one.events[i], &b = two.events[i];
        if (of(a, 1) != of(b, sign) || !(std::abs(a.t - b.t) <= 1e-7))
            return fmt::format("event {}: {} at {} and {} at {}", i, of(a, 1), a.t, of(b, sign), b.t);
    }
    return "";
}

}  // namespace achilles::test
