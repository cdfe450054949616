#include "session/contact_forces_text.hpp"

#include <fmt/format.h>

#include "expression/parse.hpp"
#include "figure/label.hpp"
#include "output/output.hpp"
#include "session/session.hpp"
#include "simulate/contact_forces.hpp"
#include "system/units.hpp"

namespace achilles {

std::string contact_forces_text(const Session& session) {
    const Sample& now = session.now();
    if (!now.contact) return "";
    const Trajectory& run = session.trajectory();
    const SystemDescription& description = session.description();
    ContactForces forces(*run.model, run.run.parameters);
    forces.set(now);
    std::string text;
    const auto add = [&](const char* what, std::size_t contact, double force) {
        const std::string unit =
            typeset_unit(unit_of_expression(description, output_names(description, "lambda")[contact]));
        text += fmt::format("{} of {}: {:.4g}{}{}\n", what, description.constraints[contact].name, force,
                            unit.empty() ? "" : " ", unit);
    };
    for (const std::size_t contact : now.mode.held()) {
        add("force", contact, forces.force(contact));
        if (!session.model()->has_friction()) continue;
        if (const double friction = forces.friction_force(contact); friction != 0.0) add("friction", contact, friction);
    }
    return text;
}

}  // namespace achilles
