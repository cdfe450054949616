// The runs of a sweep as a window wants them: coarse to fine, on threads of their own, and anew when something changes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/worker.hpp"
#include "study/table.hpp"

namespace achilles {

// Its first picture comes from the first of these, which are the same sweep with fewer points; the last is the sweep. A
// section of one run alone is that of shorter and shorter runs.
std::vector<Sweep> coarse_to_fine(const Sweep& sweep);

class SweepJob {
 public:
    // What is to be computed of this model; nothing: no more. Goes on with what is under way, or is there, if it is the same: what
    // the base has in place of an axis does not matter.
    void ask(const std::shared_ptr<const Model>& model, std::optional<Sweep> sweep);
    // Takes in what is ready and begins what is finer. Without patience: until the finest is there.
    void update(Patience patience);
    // Called on another thread when update() would take something in.
    void on_ready(std::function<void()> ready) { worker_.on_ready(std::move(ready)); }

    // Null: there is nothing to see yet. While it is made anew that of the sweep before it, if its columns are the same.
    const std::shared_ptr<const SweepData>& data() const { return data_; }
    bool is_busy() const { return next_ < levels_.size(); }
    // Whether the data are those of what was asked last, be they coarse.
    bool is_current() const { return is_current_; }
    double share() const;                                    // of the work, that is done
    const std::string& problem() const { return problem_; }  // why it cannot be; empty: it can

 private:
    void begin();  // the next level
    std::shared_ptr<const Model> model_;
    std::optional<Sweep> sweep_;
    std::vector<Sweep> levels_;
    std::size_t next_ = 0;  // the level under way
    std::shared_ptr<const SweepData> data_;
    bool is_current_ = false;
    std::string problem_;
    Worker<std::shared_ptr<const SweepData>> worker_;
};

}  // namespace achilles
