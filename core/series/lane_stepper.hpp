// One Taylor step of eight runs at once, in flight or in contact, as long as it is plain.
//
// A step is plain if the partial sums show that it contains no event, or only the impact that ends a flight. In any
// other case (a gap within its remainder, a release, a singularity, NaN) the run's own stepper repeats the step. All
// steps have the order with the least cost per length here, whatever the runs, so that no run depends on its neighbors.
// Brief flights, which end long before such a step does, have a lower order.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "number/double8.hpp"
#include "program/terms.hpp"
#include "series/series.hpp"

namespace achilles {

// The programs of one model (Model), which must outlive the stepper.
struct LanePrograms {
    std::size_t coordinates;
    const SeriesProgram &flight, &contact;
    const TypedProgram<ContactTerms>& contact_terms;
};

// For eight runs: the input of a step, and its result.
struct LaneStep {
    explicit LaneStep(std::size_t coordinates)
        : q_and_v(2 * coordinates), impulse_direction(coordinates), g(coordinates) {}

    Double8 t, until;     // s: current time, and latest end of the motion
    Double8 state_error;  // as in Gap
    // In flight: the gap, as in Gap; `known` is 1 if it starts from zero, else 0. After a step without an event, the
    // gap at the end of the step, from its series.
    Double8 h, hdot, error, rate_error, known;
    Double8 duration;  // of the last step, s
    Double8 brief;     // in flight: the length of a brief step from here, s
    // The contact quantities at the end of the step, and the effect on h of rounding q.
    Double8 end_h, end_hdot, end_W, end_gap_t, rounding;
    // In contact: how much state_error grows in each step; the minimum gap at the ends of steps, including that given;
    // and the number of steps, of which only the last may not be plain.
    double error_per_step = 0.0;
    Double8 least_gap;
    long steps = 0;
    std::vector<Double8> q_and_v, impulse_direction, g;  // the state; M^-1 g'/W and dh at the end of the step
    // The outcome of the step. After a step that is not plain, t is unchanged; in contact q_and_v and `duration` are
    // those before it. All other members are then undefined.
    enum class LaneOutcome : char { needs_scalar_step, no_event, impact };
    std::array<LaneOutcome, Double8::count> end{};
    // In contact: lanes without a run are idle; their data are valid, but their outcome does not matter. A lane goes on
    // if its run can make another step from here as it is.
    std::array<bool, Double8::count> idle{}, goes_on{};
};

class LaneStepper {
 public:
    virtual ~LaneStepper() = default;
    // The parameters of the runs, in the order of the description.
    virtual void fix(const std::vector<Double8>& parameters) = 0;
    // One step in flight. A brief step has the lower order; the flight should end within LaneStep::brief, or needs more
    // steps.
    virtual void fly(LaneStep& step, bool brief = false) = 0;
    // Steps in contact until one of the runs does not go on; at most `most` steps.
    virtual void stay(LaneStep& step, long most) = 0;
};

// The vectors used: those of every processor, of AVX2 or of AVX-512, with or without machine code. That of portable
// vectors needs AVX2. The results are the same to the last bit.
enum class Vectors {
    portable,
    portable_with_machine_code,
    avx2,
    avx2_with_machine_code,
    avx512,
    avx512_with_machine_code
};
// What this processor and this build support, the fastest first.
std::vector<Vectors> possible_vectors();
std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance,
                                               Vectors vectors = possible_vectors().front());

}  // namespace achilles
