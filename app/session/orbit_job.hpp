// The search for a periodic run, and its branch, on a thread of their own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
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

class OrbitJob {
 public:
    // What is under way is given up.
    void begin(const std::shared_ptr<const Model>& model, const std::string& text, const Run& base,
               OrbitQuestion question);
    void forget();
    // Takes in what is ready: true where something was.
    bool update(Patience patience);
    // Called on another thread when update() would take something in.
    void on_ready(std::function<void()> ready) { worker_.on_ready(std::move(ready)); }

    // How many runs the search has tried; null: nothing is under way.
    const OrbitWatch* under_way() const { return watch_.get(); }
    // The last that was searched for; null: nothing.
    const std::shared_ptr<const FoundOrbit>& found() const { return found_; }

 private:
    std::shared_ptr<OrbitWatch> watch_;
    std::shared_ptr<const FoundOrbit> found_;
    Worker<std::shared_ptr<const FoundOrbit>> worker_;
};

}  // namespace achilles
