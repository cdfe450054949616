// Limits and ticks of an axis: steps of 1, 2 or 5, exact multiples, the fewest digits that tell neighbours apart;
// powers of ten on a logarithmic axis.
#pragma once

#include "figure/figure.hpp"

namespace achilles {

// Sets limits and ticks; axis.logarithmic is set before. `margin` is the share of the range left free at each end; 0
// keeps the limits as they are. At most `most` labels. A range without extent gets one; limits that are not finite
// become [0, 1].
void set_ticks(Axis& axis, double low, double high, double margin, int most = 6);

// A number as a tick label: U+2212 for minus, never "-0", the digits that `step` needs; in powers of ten from 1e6 on.
// `largest` is the greatest size on the axis: it decides the form and the power, so that all labels of an axis agree.
std::string tick_label(double value, double step, double largest = 0.0);

// "10\u207B\u00B3" for -3.
std::string power_of_ten(int exponent);

}  // namespace achilles
