// Runs whose ends are wanted, eight at a time.
#pragma once

#include <atomic>
#include <map>

#include "series/lane_stepper.hpp"
#include "simulate/execution.hpp"
#include "simulate/many.hpp"

namespace achilles {

// One thread's share of them. A few dozen runs are under way; those in flight and those in contact wait in two lines,
// and whichever is longer makes a step. What is not plain is done by the run's own Execution.
class SideBySide {
 public:
    SideBySide(const std::shared_ptr<const Model>& model, std::size_t count, std::atomic<std::size_t>& next,
               const std::function<Run(std::size_t)>& run_of, const std::function<void(std::size_t, Attempt&&)>& take);

    // Until no run is left, here or to be begun.
    void work();

 private:
    struct Member {
        Member(std::size_t number, const std::shared_ptr<const Model>& model, const Run& run)
            : index(number), execution(model, run, nullptr, Keep::end) {}
        std::size_t index;
        std::size_t set = 0;  // of parameters: no two members with one number differ in them
        Execution execution;
    };
    using Line = std::vector<Member*>;

    void begin(std::size_t index);
    Member& member_for(std::size_t index, const Run& run);
    std::size_t set_of(const std::vector<double>& parameters);
    void go_on(Member& member);
    void step(Line& line, bool flying);
    void choose(Line& line);
    // The run in a lane; lanes without one repeat the first.
    Member& member_in(std::size_t lane) const { return *members_[lane < members_.size() ? lane : 0]; }
    LaneStepper& prepare();
    void gather(bool flying);
    void after_flight(Execution& run, std::size_t lane);
    void after_contact(Execution& run, std::size_t lane);
    Contact contact_of(std::size_t lane) const;
    long most_steps_in_contact() const;
    void move(Execution& run, std::size_t lane, long steps, double least_gap) const;

    LaneStep step_;
    Line members_;  // of the step that is made: a lane each
    const std::shared_ptr<const Model>& model_;
    std::size_t count_;
    std::atomic<std::size_t>& next_;
    const std::function<Run(std::size_t)>& run_of_;
    const std::function<void(std::size_t, Attempt&&)>& take_;
    std::vector<std::unique_ptr<Member>> all_;
    Line flying_, staying_, spare_;
    std::size_t sets_ = 0;
    std::vector<double> last_parameters_;  // of the last set
    struct Prepared {
        std::unique_ptr<LaneStepper> stepper;
        std::array<std::size_t, Eight::count> sets{};  // whose parameters its lanes have
    };
    std::map<double, Prepared> steppers_;  // by tolerance
};

}  // namespace achilles
