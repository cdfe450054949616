#include "session/event_text.hpp"

#include <fmt/format.h>

#include <optional>

#include "output/contacts.hpp"
#include "output/output.hpp"
#include "session/number_text.hpp"
#include "session/results_text.hpp"

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

}  // namespace achilles
