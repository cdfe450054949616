// Runs whose ends are wanted, eight at a time.
#pragma once

#include <array>
#include <atomic>
#include <map>

#include "series/lane_stepper.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/execution.hpp"
#include "simulate/many.hpp"

namespace achilles {

// One thread's share of them. A few dozen runs are under way; the requests of those in flight, in brief flight and in contact
// wait in three lines, and eight of whichever is longest are answered by one vector step. What is not plain is answered by
// the run's own stepper.
class SideBySide {
 public:
    // The results are the same whatever the vectors.
    explicit SideBySide(const std::shared_ptr<const Model>& model, Vectors vectors = possible_vectors().front());

    // For 0 <= i < count, as next.fetch_add(1) gives them: take(i, what run_of(i) came to).
    struct Share {
        std::size_t count;
        std::atomic<std::size_t>& next;
        const std::function<Run(std::size_t)>& run_of;
        const std::function<void(std::size_t, Attempt&&)>& take;
    };
    // Until no run is left, here or to be begun. What run_of or take throws leaves this of no further use.
    void work(const Share& share);

 private:
    struct Member {
        Member(std::size_t number, const std::shared_ptr<const Model>& model, const Run& run);
        std::size_t index;
        std::size_t set = 0;  // of parameters: no two members with one number differ in those that move them
        Surfaces surfaces;
        Execution execution;
        EventStepper stepper;
        const StepRequest* request = nullptr;  // that waits in line
        StepRequest own;                       // as its own stepper is asked
        bool alone = false;                    // the rest of this stretch is left to its own stepper,
        bool leaves = false;                   // or but what is not plain where it leaves the surface
        // Of the bounce before, in one step: how long it was, how fast it began, and how long a brief one might have been.
        struct Bounce {
            double duration = 0.0, hdot = 0.0, brief = 0.0;
        } before;
        bool is_brief() const;
    };
    enum class Kind { flight, brief_flight, contact };
    using Line = std::vector<Member*>;

    void begin(std::size_t index);
    Member& member_for(std::size_t index, const Run& run);
    std::size_t set_of(const std::vector<double>& parameters);
    bool move_alike(const std::vector<double>& some, const std::vector<double>& others) const;
    void go_on(Member& member, bool refused);
    void finish(Member& member);
    void step(Kind kind);
    void choose(Line& line);
    // The run in a lane; lanes without one repeat the first.
    Member& member_in(std::size_t lane) const { return *members_[lane < members_.size() ? lane : 0]; }
    LaneStepper& prepare();
    void gather(bool flying);
    long most_steps() const;
    bool read(std::size_t lane, bool flying);
    void read_contact(std::size_t lane);
    void read_gap(std::size_t lane);

    LaneStep step_;
    // The same of one lane, as it is told.
    State end_;
    StepResult result_;
    Line members_;  // of the step that is made: a lane each
    std::shared_ptr<const Model> model_;
    bool has_lanes_;                // the model can be stepped in lanes,
    Vectors vectors_;               // which are these
    const Share* share_ = nullptr;  // while it works
    std::vector<std::unique_ptr<Member>> all_;
    std::array<Line, 3> lines_;  // by Kind
    Line spare_;
    std::vector<std::size_t> moving_;  // the parameters that the motion depends on
    std::size_t sets_ = 0;
    std::vector<double> last_parameters_;  // of the last set
    struct Prepared {
        std::unique_ptr<LaneStepper> stepper;
        std::array<std::size_t, Eight::count> sets{};  // whose parameters its lanes have
    };
    std::map<double, Prepared> steppers_;  // by tolerance
};

}  // namespace achilles
