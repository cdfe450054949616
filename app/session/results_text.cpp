#include "session/results_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "output/contacts.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "session/event_rows.hpp"
#include "session/number_text.hpp"

namespace achilles {

std::string result_explanation(const Session& session, std::size_t index) {
    const Event& event = session.trajectory().events[index];
    const std::string event_text = typeset_sentence(
        fmt::format("{} at t = {} s: {}", names_of(event).name,
                    known_digits(event.t, session.precision().of_event(index), 10), session.sentences().of(index)));
    if (session.precision().is_beyond(event.t)) return event_text;  // a certificate refers to the computed motion
    if (!event.is_zeno()) return event_text + proved_text(session, index, "\n") + "\nClick: why";
    if (session.enclosed(index) != nullptr) return event_text + proved_text(session, index, "\n");
    std::string proof = event.certificate ? sentence(*event.certificate, session.description()) : "not certified";
    for (std::size_t at = proof.find("; "); at != std::string::npos; at = proof.find("; ", at))
        proof.replace(at, 2, "\n");
    return event_text + "\n" + typeset_sentence(proof) + (is_plastic_landing(event) ? "" : "\n" + precision_text());
}

std::string result_name(const Trajectory& trajectory, const ListedResult& result) {
    const Event& event = trajectory.events[result.event];
    const std::string contacts = event_contacts_text(trajectory, event), space = contacts.empty() ? "" : " ";
    if (event.is_impact()) return fmt::format("{} opens {}", contacts, joined_names(*trajectory.model, event.opened));
    const std::string number = is_zeno_point(event) ? fmt::format(" {}", result.zeno) : "";
    return fmt::format("{}{}{}{}", names_of(event).label, number, space, contacts);
}

std::vector<ListedResult> results_of(const Trajectory& trajectory) {
    std::vector<ListedResult> results;
    int zeno = 0;
    const std::vector<ChatterPhases> chatters = chatters_of(trajectory);
    auto chatter = chatters.begin();
    for (const std::size_t turn : turns(trajectory, true)) {
        const Event& event = trajectory.events[turn];
        zeno += is_zeno_point(event) ? 1 : 0;
        while (chatter != chatters.end() && turn >= chatter->last_event) ++chatter;
        if (chatter != chatters.end() && turn >= chatter->first_event && turn + 1 < chatter->last_event) continue;
        results.push_back({turn, zeno});
    }
    return results;
}

std::size_t present_result(const Session& session, const std::vector<ListedResult>& results) {
    const auto& events = session.trajectory().events;
    const auto reaches = [&](const ListedResult& result) {
        if (session.selected() > 0) return static_cast<int>(result.event) < session.selected();
        return events[result.event].t <= session.time();
    };
    const auto after = std::partition_point(results.begin(), results.end(), reaches);
    return after == results.begin() ? 0 : static_cast<std::size_t>(after - results.begin()) - 1;
}

std::string precision_text() {
    return "\u00b1: certified for the Zeno time from the computed state at the cut.\nErrors of the integration and of "
           "the cuts before it are not covered: where\ntheir estimate is larger, it is shown instead, and it is not "
           "certified.";
}

std::string time_text(const Trajectory& trajectory, std::size_t index, double error) {
    const Event& event = trajectory.events[index];
    if (!std::isfinite(error)) return unknown_number;
    const bool is_proved = event.certificate && event.certificate->certified;
    const double low = is_proved ? event.certificate->zeno_low : 0.0,
                 high = is_proved ? event.certificate->zeno_high : 0.0;
    const double half = 0.5 * (high - low);
    if (!is_proved || !(half > 0.0)) return number_with_decimals(event.t, error, 6);
    // Leave out digits within the tolerance.
    const double integration = std::max(error, integration_error_of_time(trajectory, index));
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(std::max(half, integration)))), 0, 12);
    const std::string text = fmt::format("{:.{}f}", event.t, digits);
    const double value = std::strtod(text.c_str(), nullptr);
    return text + " \u00b1 " + rounded_up(std::max({high - value, value - low, integration}));
}

std::string proved_text(const Session& session, std::size_t event, const std::string& before) {
    const EnclosedEvent* const enclosed = session.enclosed(event);
    if (enclosed == nullptr) return "";
    return before + "proved: t in " + with_minus(interval_text(enclosed->t.lo(), enclosed->t.hi()));
}

}  // namespace achilles
