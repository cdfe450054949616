#include "session/results_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "output/contacts.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "session/certificate_text.hpp"
#include "session/event_rows.hpp"
#include "session/number_text.hpp"

namespace achilles {

std::string result_explanation(const Session& session, std::size_t index) {
    const Event& event = session.trajectory().events[index];
    std::string text = typeset_sentence(
        fmt::format("{} at t = {} s{}: {}", names_of(event).name, event_time(session, index).text(),
                    session.enclosed(index) != nullptr ? ", proved" : "", session.sentences().of(index)));
    if (session.precision().is_beyond(event.t)) return text;  // a certificate refers to the computed motion
    if (!event.is_zeno()) return text + "\nClick: why";
    if (session.enclosed(index) != nullptr) return text;
    if (!event.certificate || !event.certificate->certified) return text + "\nnot certified";
    for (const std::string& line : certificate_lines(event)) text += "\n" + typeset_sentence(line);
    return text + (is_plastic_landing(event) ? "" : "\n" + precision_text());
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

std::string EventTime::text() const { return with_minus(digits + (bound.empty() ? "" : " \u00b1 " + bound)); }

int decimals_of_times(const Trajectory& trajectory) {
    constexpr int most = 10, digits = 12;  // as wide as the column of times
    const double end = std::max(std::abs(trajectory.run.options.start_time), std::abs(trajectory.end_time));
    const int whole = end < 10.0 ? 1 : static_cast<int>(std::floor(std::log10(end))) + 1;
    return std::clamp(digits - whole, 0, most);
}

EventTime event_time(const Trajectory& trajectory, std::size_t index, double error, const EnclosedEvent* enclosed) {
    const Event& event = trajectory.events[index];
    const int decimals = decimals_of_times(trajectory);
    if (enclosed == nullptr && !std::isfinite(error)) return {unknown_number, "", unknown_number, false};
    const bool is_certified = event.certificate && event.certificate->certified;
    const Interval bounds = enclosed != nullptr ? enclosed->t
                            : is_certified      ? Interval(event.certificate->zeno_low, event.certificate->zeno_high)
                                                : Interval(event.t);
    const double half = 0.5 * width(bounds);
    if (enclosed == nullptr && !(half > 0.0)) {
        const std::string digits = number_with_decimals(event.t, error, std::min(decimals, 9));
        return {digits, "", digits, false};
    }
    // Leave out digits within the tolerance.
    const double integration =
        enclosed != nullptr ? 0.0 : std::max(error, integration_error_of_time(trajectory, index));
    const double off = std::max(half, integration);
    const int known = off > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(off))), 0, decimals) : decimals;
    const double center = enclosed != nullptr ? mid(bounds) : event.t;
    const std::string digits = fmt::format("{:.{}f}", center, known);
    const double value = std::strtod(digits.c_str(), nullptr), unit = std::pow(10.0, -known);
    double units = std::ceil(std::max({bounds.hi() - value, value - bounds.lo(), integration, 0.0}) / unit);
    while (value + units * unit < bounds.hi() || value - units * unit > bounds.lo()) ++units;
    const std::string last = fmt::format("{:.0f}", units);
    std::string bound = fmt::format("{:g}", std::strtod(fmt::format("{}e-{}", last, known).c_str(), nullptr));
    if (const std::size_t zero = bound.find("e-0"); zero != std::string::npos) bound.erase(zero + 2, 1);
    return {digits, bound, fmt::format("{}({})", digits, last), enclosed != nullptr};
}

EventTime event_time(const Session& session, std::size_t event) {
    return event_time(session.trajectory(), event, session.precision().of_event(event), session.enclosed(event));
}

std::string proved_text(const Session& session, std::size_t event, const std::string& before) {
    return session.enclosed(event) == nullptr ? "" : before + "proved: t = " + event_time(session, event).text() + " s";
}

}  // namespace achilles
