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
#include "session/study_jobs.hpp"

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

namespace {

// "1e−6" for "1e-06", as in the bounds beside it.
std::string minus_signs(std::string text) {
    if (const std::size_t at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
    return with_minus(std::move(text));
}

// "Zeno 2", "Zeno 2 of wall".
std::string title_of_zeno(const Trajectory& run, std::size_t index) {
    const Event& event = run.events[index];
    const auto number = std::count_if(run.events.begin(), run.events.begin() + static_cast<std::ptrdiff_t>(index) + 1,
                                      [](const Event& one) { return is_zeno_point(one); });
    const std::string contacts = event_contacts_text(run, event);
    return (event.is_collapse()         ? std::string("Collapse")
            : is_plastic_landing(event) ? std::string("Landing")
                                        : fmt::format("Zeno {}", number)) +
           (contacts.empty() ? "" : " of " + contacts);
}

// Where the bounces end: "It would bounce infinitely often; we stopped computing bounces after the 9th, 1.6 ms before."
std::string where_cut(const Trajectory& run, std::size_t index) {
    const Event& event = run.events[index];
    if (is_plastic_landing(event)) return "It stays in contact without a bounce.";
    if (!event.truncation) return "";
    const int impacts = event.is_collapse() ? 0 : bounce_sequence_of(run, index).impacts;
    const std::string after = impacts > 0 ? fmt::format("after the {}, ", ordinal(impacts)) : "";
    return fmt::format("It would bounce infinitely often; we stopped computing bounces {}{} before.", after,
                       duration_text(event.t - event.truncation->t));
}

std::string what_is_not_covered(const Session& session, std::size_t index) {
    if (session.enclosed(index) != nullptr)
        return "Covered by the proof of this run: integration and rounding errors, and all cuts.";
    const double error = session.precision().of_event(index);
    const bool is_known = session.error_estimate() != nullptr && std::isfinite(error) && error > 0.0;
    return fmt::format("Not covered: integration error before the cut{}.",
                       is_known ? ", about " + minus_signs(fmt::format("{:.0e}", error)) + " s (estimate)" : "");
}

}  // namespace

std::string ordinal(int number) {
    const int last = number % 10, teens = number % 100;
    const bool is_th = last == 0 || last > 3 || (teens > 10 && teens < 14);
    return fmt::format("{}{}", number, is_th ? "th" : last == 1 ? "st" : last == 2 ? "nd" : "rd");
}

std::string duration_text(double seconds) {
    constexpr std::pair<double, const char*> scales[] = {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "\u00b5s"}, {1e-9, "ns"}};
    for (const auto& [scale, unit] : scales)
        if (const double value = seconds / scale; value >= 1.0)
            return value >= 99.5 ? fmt::format("{:.0f} {}", value, unit) : fmt::format("{:.2g} {}", value, unit);
    return fmt::format("{:.2g} s", seconds);
}

CertificateText certificate_text(const Session& session, std::size_t index) {
    const Trajectory& run = session.trajectory();
    const Certificate& certificate = *run.events[index].certificate;
    const bool has_bounces = !is_plastic_landing(run.events[index]);
    CertificateText text{title_of_zeno(run, index),
                         !has_bounces                         ? ""
                         : session.enclosed(index) != nullptr ? "PROVED"
                         : certificate.certified              ? "CERTIFIED"
                                                              : "NOT CERTIFIED",
                         where_cut(run, index),
                         {},
                         what_is_not_covered(session, index)};
    if (!certificate.decision) return text;
    const NormUnits units = norm_units(session.description());
    const Certificate::Decision& decision = *certificate.decision;
    const auto add = [&](const Inequality& inequality, const char* error, const std::string& unit) {
        // The paper's conditions compare the gap speed at the cut with the speeds that keep each error within its limit.
        const std::string name = certificate.paper ? fmt::format("gap speed, for the {}", error) : error;
        const std::string of = certificate.paper ? "" : unit;
        text.rows.push_back({name, minus_signs(bound_text(inequality.left)) + of,
                             minus_signs(fmt::format("{:.3g}", inequality.right)) + of,
                             inequality.right > 0.0 ? std::clamp(inequality.ratio(), 0.0, 1.0) : 0.0,
                             inequality.name == decision.closest().name});
    };
    // Its error is that of the time from the cut on, with which a proof of the run has nothing to do.
    add(decision.time, "time from the cut on", " s");
    add(decision.position, "position until then", units.position);
    add(decision.velocity, "velocity at that time", units.velocity);
    return text;
}

std::vector<std::string> certificate_lines(const Event& event) {
    constexpr int digits = 6;
    const Certificate& c = *event.certificate;
    std::vector<std::string> lines;
    if (is_plastic_landing(event)) {
        lines.emplace_back("stays in contact without a bounce");
        lines.push_back(
            minus_signs("gap'' from " + rounded_down(-c.a_max, digits) + " to " + rounded_up(-c.a_min, digits)));
        return lines;
    }
    lines.push_back(fmt::format("cut to \u03c4\u221e: q moves < {}, v < {}", bound_text(c.position_bound),
                                bound_text(c.velocity_bound)));
    if (c.uniform_position)
        lines.push_back(fmt::format("error until \u03c4\u221e: q \u2264 {}", bound_text(*c.uniform_position)));
    if (c.shadowing_position)
        lines.push_back(fmt::format("error at \u03c4\u221e: q \u2264 {}, v \u2264 {}",
                                    bound_text(*c.shadowing_position), bound_text(*c.shadowing_velocity)));
    lines.push_back("gap'' from " + rounded_down(-c.a_max, digits) + " to " + rounded_up(-c.a_min, digits));
    if (c.cut_at_resolution) lines.emplace_back("cut below rounding: no shorter flight is resolved");
    for (std::string& line : lines) line = minus_signs(std::move(line));
    return lines;
}

}  // namespace achilles
