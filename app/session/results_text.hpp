// The results of a run: its Zeno points, releases and opening impacts, in words.
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

}  // namespace achilles
