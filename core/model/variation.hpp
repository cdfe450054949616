// A motion together with its derivatives in some directions (theory-derivatives.md 2).
#pragma once

#include "model/derive.hpp"
#include "series/series.hpp"

namespace achilles {

// Inputs of a variation. Copy 0 is the motion, copy d > 0 its derivative in direction d.
struct VariationLayout {
    std::uint32_t dof = 0, p = 0;  // number of coordinates and of parameters of the motion
    std::uint32_t directions = 0;
    std::uint32_t copies() const { return 1 + directions; }
    std::uint32_t coordinates() const { return dof * copies(); }
    // The slot of a copy of q, v, a parameter or t, which is input `slot` of the motion (Layout).
    std::uint32_t input(std::uint32_t copy, std::uint32_t slot) const;
    // The time is last; its derivatives are constants.
    Slots slots() const;
};

// With a = f(q, v, p, t), the derivatives obey the variational equation a' = f_q q' + f_v v' + f_p p' + f_t t'. The motion
// and its derivatives together are a motion with copies() times as many coordinates and gaps. The gaps of held contacts
// are 0. The outputs of the series are the accelerations, copy after copy, then the gaps. With eight lanes, each
// lane computes the derivatives along another direction.
struct MotionVariation {
    VariationLayout layout;
    SeriesProgram series;
    LaneCode code;
};

// `motion` belongs to a graph of this layout. Throws ExpressionTooLarge.
MotionVariation make_variation(const ModeDynamics& motion, const Layout& layout, std::uint32_t directions);

}  // namespace achilles
