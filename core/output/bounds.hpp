// Bounds and intervals as decimals that claim no more than the numbers they print: what is concluded is rounded outward,
// what is assumed is rounded inward. Every comparison of a decimal with a double is exact.
#pragma once

#include <string>

#include "number/interval.hpp"

namespace achilles {

// The least decimal of so many digits that is not below x, an upper bound: "3.6e-7".
std::string rounded_up(double x, int digits = 2);
// The greatest one that is not above x: a lower bound, or the time that a proof reaches.
std::string rounded_down(double x, int digits = 2);
// A bound, rounded up to two digits; one below 1e-16, the rounding of numbers about 1, is printed as that.
std::string bound_text(double bound);
// An estimate, which bounds nothing: its nearest decimal of one digit, "4e-9".
std::string estimate_text(double estimate);

// "[low, high]", rounded outward, with as many digits as tell the ends apart and two more.
std::string interval_text(double low, double high);
// "2.7251421727(13)": the last digits of the number may be off by so many of them. Both ends are inside.
std::string short_text(const Interval& x);
// "= 2.7251421727 +- 1.3e-09": a conclusion. Both ends are inside. "= 2.5" where the interval is exactly that.
std::string outer_text(const Interval& x);
// "= 0.1" or "in [0.059, 0.061]": a hypothesis. What is printed lies in the interval: what a person wrote, or a decimal
// between it and what as_written() adds on both sides.
std::string inner_text(const Interval& x);

}  // namespace achilles
