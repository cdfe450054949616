// The results of a run in words: its Zeno points, releases and opening impacts, and the certificates of Zeno points.
#pragma once

#include <string>
#include <vector>

#include "session/session.hpp"

namespace achilles {

struct ListedResult {
    std::size_t event = 0;
    int zeno = 0;  // number among the Zeno points
};

// All results of a run. Of contacts that repeatedly come to rest and are opened only the last.
std::vector<ListedResult> results_of(const Trajectory& trajectory);
// The result to show: the selected event, or the last one up to the current time; else the first.
std::size_t present_result(const Session& session, const std::vector<ListedResult>& results);
// "Zeno 2", "landing", "release knee", "wall opens knee".
std::string result_name(const Trajectory& trajectory, const ListedResult& result);
// What happened at an event, and how accurate its time is.
std::string result_explanation(const Session& session, std::size_t event);

// The time of an event as it is shown everywhere: the digits that its bound supports.
struct EventTime {
    std::string digits;  // "2.7251422", or "?"
    // "8e-7", whole units of the last digit. Digits and bound contain the proved interval or, without a proof, the
    // certified one and the estimated integration error. Empty: no bound is known, and the digits are those that the
    // estimate leaves.
    std::string bound;
    std::string short_text;  // "2.7251422(8)", the same where there is little room
    bool is_proved = false;
    std::string text() const;  // "2.7251422 ± 8e−7"
};
// `error`: the estimated error of the time, s. `enclosed`: the event in a proof of the run; null: not proved.
EventTime event_time(const Trajectory& trajectory, std::size_t event, double error = 0.0,
                     const EnclosedEvent* enclosed = nullptr);
EventTime event_time(const Session& session, std::size_t event);
// The most decimals of such times in this run, for a column of them.
int decimals_of_times(const Trajectory& trajectory);
// Explanation of the bound.
std::string precision_text();
// `before` followed by "proved: t = 2.7251421727 ± 1.3e−10 s"; empty if no proof encloses the event.
std::string proved_text(const Session& session, std::size_t event, const std::string& before = "");

// ---- certificates ----

// The certificate of a Zeno point in words and numbers for a reader: what happened, each error with its bound and what
// is allowed, and what is not covered.
struct CertificateText {
    std::string title;     // "Zeno 1", "Landing of wall"
    std::string verdict;   // "CERTIFIED", "PROVED"; empty: the contact is made without a bounce
    std::string sentence;  // "It would bounce infinitely often; ..."
    struct Row {
        std::string error, bound, allowed;  // "time from the cut on", "6.9e-07 s", "1e-06 s"
        double share = 0.0;                 // bound/allowed
        bool is_nearest = false;            // the one nearest to its limit
    };
    std::vector<Row> rows;  // empty: nothing had to be decided
    std::string not_covered;
};
// The event must have a certificate.
CertificateText certificate_text(const Session& session, std::size_t event);

// The bounds of the certificate line by line, for the details. The Zeno time is not among them: event_time() has it.
std::vector<std::string> certificate_lines(const Event& event);

// "9th", "21st".
std::string ordinal(int number);
// "1.6 ms": a duration in the unit that suits it, with two digits.
std::string duration_text(double seconds);

}  // namespace achilles
