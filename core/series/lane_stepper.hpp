// One Taylor step of eight runs at once, as far as it is plain: what a flight and a contact are made of.
//
// A step is plain where it shows at once that no event lies in it, or just the impact that ends a flight. Anything else
// (a gap within its remainder, a release, an edge, a number that is none) is left to the run's own stepper, which takes
// the step again. All steps have the order at which the cost over the length is least here, whatever the runs, so that
// none depends on its neighbours; brief flights, which end long before that could serve, have a lower one.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "number/eight.hpp"
#include "program/terms.hpp"
#include "series/series.hpp"

namespace achilles {

// What is stepped: the programs of one model (Model), which must outlive the stepper.
struct LanePrograms {
    std::size_t coordinates;
    const SeriesProgram &flight, &contact;
    const ProgramOf<ContactTerms>& contact_terms;
};

// Of eight runs: what a step starts from, and after it what it came to.
struct LaneStep {
    explicit LaneStep(std::size_t coordinates)
        : q_and_v(2 * coordinates), impulse_direction(coordinates), g(coordinates) {}

    Eight t, until;     // s: now, and where the motion ends at the latest
    Eight state_error;  // as in Gap
    // In flight: the gap, as in Gap; `known` is 1 where it starts from zero, else 0. After a step without event that at
    // its end, by the series.
    Eight h, hdot, error, rate_error, known;
    Eight duration;  // of the (last) step, s
    Eight brief;     // of a flight: how long a brief one might have been here, s
    // The contact quantities where it ends, and what the rounding of q does to h.
    Eight end_h, end_hdot, end_W, end_gap_t, rounding;
    // In contact: how many steps were made, of which only the last may not be plain; the least gap at their ends.
    Eight least_gap;
    long steps = 0;
    std::vector<Eight> q_and_v, impulse_direction, g;  // the state; M^-1 g'/W and dh where the step ends
    // How it ended. After one that is not plain t is as before, in contact q_and_v and the duration are those before
    // it, and nothing else has a meaning.
    enum class End : char { not_plain, no_event, impact };
    std::array<End, Eight::count> end{};
};

class LaneStepper {
 public:
    virtual ~LaneStepper() = default;
    // The runs' parameters, in the order of the description.
    virtual void fix(const std::vector<Eight>& parameters) = 0;
    // One step. A brief one should come to its end before LaneStep::brief of a flight like it, or it is but a part of it.
    virtual void fly(LaneStep& step, bool brief = false) = 0;
    // Steps until one of the runs comes to its end, or to a step that is not plain; at most so many.
    virtual void stay(LaneStep& step, long most) = 0;
};

// By which vectors the numbers are worked on: those that every processor has, with machine code for AVX2 or without, or those of
// AVX-512, with its own. The results are the same to the last bit.
enum class Vectors { portable, portable_with_machine_code, avx512, avx512_with_machine_code };
// What this processor and this build can do, the fastest first.
std::vector<Vectors> possible_vectors();
std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance,
                                               Vectors vectors = possible_vectors().front());

}  // namespace achilles
