#include "session/contact_forces_text.hpp"

#include <fmt/format.h>

#include "expression/parse.hpp"
#include "figure/label.hpp"
#include "output/output.hpp"
#include "session/session.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/contact_forces.hpp"
#include "system/units.hpp"

namespace achilles {

FrictionShare friction_share(const Trajectory& run, std::size_t which, Mode mode, const State& state) {
    ContactForces forces(*run.model, run.run.parameters);
    forces.set(state, mode);
    const Slip slip = ContactCache(*run.model, run.run).slip(which, state);
    const double pressing = is_joint(which) ? 1.0 : forces.force(which);
    return {forces.friction_force(which),
            pressing * (slip_sign(mode.state(which)) == 0 ? slip.static_coefficient : slip.coefficient)};
}

std::string contact_forces_text(const Session& session, const std::optional<std::size_t>& only) {
    const Sample& now = session.now();
    const Trajectory& run = session.trajectory();
    const SystemDescription& description = session.description();
    ContactForces forces(*run.model, run.run.parameters);
    forces.set(now);
    const auto value = [&](double force, const std::string& expression) {
        const std::string unit = typeset_unit(unit_of_expression(description, expression));
        return fmt::format("{:.4g}{}{}", force, unit.empty() ? "" : " ", unit);
    };
    std::string text;
    for (const std::size_t contact : now.mode.held())
        if (!only || contact == *only)
            text += fmt::format("normal force of {}: {}\n", description.constraints[contact].name,
                                value(forces.force(contact), output_names(description, "lambda")[contact]));
    const std::vector<SlidingPlace> places = sliding_places(description);
    const std::vector<std::string> names = sliding_names(description, "friction_force");
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t which = places[i].number;
        if ((only && which != *only) || !now.mode.held().with(now.mode.joints()).contains(which)) continue;
        State state = now.state;
        state.t = now.t;
        const FrictionShare share = friction_share(run, which, now.mode, state);
        text += fmt::format("friction of {}: {}", places[i].name, value(share.force, names[i]));
        if (!places[i].never_slides) text += fmt::format(" of at most {}", value(share.limit, names[i]));
        text += "\n";
    }
    return text;
}

}  // namespace achilles
