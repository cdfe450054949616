#include "session/event_text.hpp"

#include <fmt/format.h>

#include <optional>

#include "expression/parse.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "session/number_text.hpp"
#include "session/results_text.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/contact_forces.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// The first inequality that fails, if any.
std::optional<Inequality> failed(const Certificate& certificate) {
    for (const Inequality& inequality : certificate.inequalities())
        if (!(inequality.left < inequality.right)) return inequality;
    return std::nullopt;
}

}  // namespace

std::string why_not_cut(const ImpactReason& reason, const Certificate* attempt, bool several, bool all_at_once,
                        const ShownUnit& acceleration) {
    if (reason.cut)
        return "The impact sequence is cut here: the error of the motion that follows is certified to be within the "
               "tolerances. For the bounds see the next event, the Zeno point.";
    if (!reason.contact || all_at_once)
        return "Not cut: several contacts take part in this impact, which Moreau's law resolves together.";
    if (reason.normal_acceleration == 0.0) return "Not cut: nothing presses the body onto the surface here.";
    if (!(reason.normal_acceleration < 0.0))
        return fmt::format(
            "Not cut: the surface falls away here; the gap would open with acceleration {}.",
            number_with_unit(number(reason.normal_acceleration * acceleration.factor), acceleration.text));
    if (attempt == nullptr)
        return fmt::format(
            "Not cut: nothing can be certified yet; the gap's acceleration may change sign{} before the Zeno point.",
            several ? ", or another contact may open or close," : "");
    const std::optional<Inequality> inequality = failed(*attempt);
    if (!inequality) return "Not cut: this impact came before the conditions were checked.";
    if (!(inequality->right > 0.0))
        return fmt::format("Not cut: the {} must be below {}, and its bound is {}.", inequality->name,
                           number(inequality->right, "{:.3g}"), number(inequality->left, "{:.3g}"));
    return fmt::format("Not cut: the {} requires {} < {}; the left side is {} times too large.", inequality->name,
                       number(inequality->left, "{:.3g}"), number(inequality->right, "{:.3g}"),
                       number(inequality->left / inequality->right, "{:.3g}"));
}

std::string event_title(const char* kind, const Session& session, const Event& event, std::size_t index) {
    const std::string contacts = event_contacts_text(session.trajectory(), event);
    return fmt::format("{}{}{}, event {}", kind, contacts.empty() ? "" : " of ", contacts, index + 1);
}

std::string event_time_text(const Session& session, std::size_t event) {
    return fmt::format("t = {} s", event_time(session, event).text());
}

std::string what_is_held(const Session& session, const Event& event, const ImpactReason& reason) {
    const Model& model = *session.model();
    std::string text = reason.mode.is_free() ? "No contact is held. "
                                             : fmt::format("Held: {}. ", joined_names(model, reason.mode.held()));
    if (!event.opened.empty())
        text += fmt::format("It opens {}, where the impulse would have to pull. ", joined_names(model, event.opened));
    if (event.joint && event.joint->order_matters)
        text += "The order of the impacts matters but is unknown: they are resolved together. ";
    if (event.joint && event.joint->is_nonunique) text += "The impulses are not unique; this is one choice. ";
    return text;
}

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
