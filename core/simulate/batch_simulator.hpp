// Batch simulation: eight runs at a time in the lanes of a vector, for final states.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <map>

#include "series/lane_stepper.hpp"
#include "simulate/batch.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/execution.hpp"

namespace achilles {

// The runs of one thread. A few dozen runs are in progress, in three groups: free flight, brief flight and contact. The
// largest group makes one vector step. A flight leaves its lane after one step. A run in contact keeps its lane until
// its segment ends, so that no step depends on the neighbors; free lanes are refilled from the queue of the group. A
// request that is not plain is served by the stepper of its own run.
class BatchSimulator {
 public:
    // The results do not depend on `vectors`.
    explicit BatchSimulator(const std::shared_ptr<const Model>& model, Vectors vectors = possible_vectors().front());

    // A source of runs: for every i < count from next.fetch_add(1), the result of run_of(i) is passed to take(i,
    // result).
    struct BatchSlice {
        std::size_t count;
        std::atomic<std::size_t>& next;
        const std::function<Run(std::size_t)>& run_of;
        const std::function<void(std::size_t, RunResult&&)>& take;
    };
    // Works until no run is left, in progress or to start. After an exception from run_of or take, this object must not
    // be used again.
    void work(const BatchSlice& share);

 private:
    struct BatchRun {
        BatchRun(std::size_t number, const std::shared_ptr<const Model>& model, const Run& run);
        std::size_t index;
        std::size_t set = 0;  // number of its parameter set: members with equal numbers have equal motions
        ContactCache surfaces;
        ExecutionAutomaton execution;
        EventStepper stepper;
        const StepRequest* request = nullptr;  // waiting in a queue
        StepRequest own;                       // the request for its own stepper
        bool alone = false;                    // the rest of this segment is left to its own stepper
        bool leaves = false;                   // its own stepper serves it until the gap is known to be open
        // The last bounce, made in one step: its duration, its initial gap rate, and the length that a brief step could
        // have had.
        struct BounceTiming {
            double duration = 0.0, hdot = 0.0, brief = 0.0;
        } before;
        bool is_brief() const;
    };
    enum class Kind { flight, brief_flight, contact };
    static constexpr std::size_t lanes = Double8::count;
    // The runs of one kind: in the lanes of its vector step, and waiting for one.
    struct RunGroup {
        explicit RunGroup(Eigen::Index coordinates) : step(static_cast<std::size_t>(coordinates)) {}
        std::size_t size() const { return taken + queue.size(); }
        BatchRun& first() const {
            return **std::find_if(runs.begin(), runs.end(), [](auto* run) { return run; });
        }

        LaneStep step;
        std::array<BatchRun*, lanes> runs{};  // null for an idle lane
        std::array<long, lanes> steps{};      // made in the lane
        std::size_t taken = 0;                // number of lanes that are not idle
        std::vector<BatchRun*> queue;
    };

    void begin(std::size_t index);
    BatchRun& member_for(std::size_t index, const Run& run);
    std::size_t set_of(const std::vector<double>& parameters);
    bool move_alike(const std::vector<double>& some, const std::vector<double>& others) const;
    void go_on(BatchRun& member, bool refused);
    void finish(BatchRun& member);
    void step(Kind kind);
    void fill_lanes(RunGroup& group, bool flying);
    static void load(RunGroup& group, std::size_t lane, const StepRequest& request, bool flying);
    LaneStepper& prepare(const RunGroup& group);
    static long most_steps(const RunGroup& group);
    void leave(RunGroup& group, std::size_t lane, bool flying);
    bool read(const RunGroup& group, std::size_t lane, bool flying);
    void read_contact(const LaneStep& step, std::size_t lane);
    void read_gap(const LaneStep& step, std::size_t lane, BatchRun& run);

    // The result for one lane.
    State end_;
    StepResult result_;
    std::shared_ptr<const Model> model_;
    bool has_lanes_;                     // the model can be stepped in lanes
    Vectors vectors_;                    // of the lanes
    const BatchSlice* share_ = nullptr;  // set during work()
    std::vector<std::unique_ptr<BatchRun>> all_;
    std::array<RunGroup, 3> groups_;  // by Kind
    std::vector<BatchRun*> spare_;
    std::vector<std::size_t> moving_;  // indices of the parameters that the motion depends on
    std::size_t sets_ = 0;
    std::vector<double> last_parameters_;  // of the last parameter set
    struct StepperSlot {
        std::unique_ptr<LaneStepper> stepper;
        std::array<std::size_t, lanes> sets{};  // parameter sets in its lanes
    };
    std::map<double, StepperSlot> steppers_;  // by tolerance
};

}  // namespace achilles
