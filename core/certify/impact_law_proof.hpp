// Proves that one set of impulses obeys the impact law with friction, and one set of forces the law of forces, while a
// contact bounces beside others that are held (theory-friction.md 4.3).
#pragma once

#include <optional>

#include "model/model.hpp"
#include "number/interval.hpp"

namespace achilles {

// What is not proved, or nothing. `program` is that of the terms, with the inputs of a box that contains the state at
// all impacts; `speed` is its input Layout::sliding_speed(), which this sets, and e encloses the restitution.
//
// A contact rests (its slip is 0 after every impact) or slides (u is not 0). Its states are
//     rests     open; sticks; slides with either sign
//     slides    open; closed, with a friction impulse theta mu p for any theta in [-1, 1]
// In every combination of states, the matrix that determines the impulses is proved to have a positive determinant. No
// impulses that obey the law then reverse a slip, which is proved, too; and those are unique. The determinants are linear
// in each theta, and changes of slips are quotients of such functions, so that theta = 1 and -1 suffice.
std::optional<BouncingObstacle> doubt_of_impact_law(const ImpactLawTerms& terms, Evaluator<Interval>& program,
                                                    std::uint32_t speed, const Interval& e);

}  // namespace achilles
