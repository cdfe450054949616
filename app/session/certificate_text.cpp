#include "session/certificate_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/contacts.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "session/number_text.hpp"
#include "session/study_jobs.hpp"

namespace achilles {

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
