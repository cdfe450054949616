// The search for a periodic run, and its branch, on a thread of their own.
#pragma once

#include <memory>
#include <string>

#include "session/worker.hpp"
#include "study/orbit.hpp"

namespace achilles {

// What was found, and how it was asked for.
struct FoundOrbit {
    std::string text;  // of the command
    Run base;          // of which that was asked
    OrbitAnswer answer;

    // What is told as one after the other: the points of the branch or, without one, the orbit alone. Empty: there is none.
    std::size_t count() const { return answer.branch ? answer.branch->points.size() : answer.orbit ? 1 : 0; }
    const OrbitPoint& point(std::size_t i) const { return answer.branch ? answer.branch->points[i] : *answer.orbit; }
    // Which of them the search had found, before a branch was followed.
    std::size_t first() const;
};

// `run` on this periodic run: its start and parameters; no shorter than a period.
Run run_on(const OrbitPoint& point, Run run);

class OrbitJob : public Job<FoundOrbit, OrbitWatch> {
 public:
    // The last orbit is forgotten, and a search under way stopped.
    void begin(const std::shared_ptr<const Model>& model, const std::string& text, const Run& base,
               OrbitQuestion question);
};

}  // namespace achilles
