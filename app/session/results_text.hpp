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
// "2.7251422 ± 7.4e-7": the time of a Zeno point. The tolerance is the larger of the certified distance to the exact
// Zeno time from the computed state at the cut, and the integration error estimate. Without a certificate: only the
// time.
std::string time_text(const Trajectory& trajectory, std::size_t event, double error = 0.0);
// Explanation of this tolerance.
std::string precision_text();
// `before` followed by "proved: t in [LOW, HIGH]"; empty if no proof encloses the event.
std::string proved_text(const Session& session, std::size_t event, const std::string& before = "");

}  // namespace achilles
