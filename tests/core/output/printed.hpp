// Printed numbers read back in quadruple precision.
#pragma once

#include "core/enclose/truth.hpp"

namespace achilles::test {

// The set of reals that a text represents: "= 0.1", "= 2.5 +- 1.3e-09", "in [0.059, 0.061]".
struct PrintedSet {
    Real low, high;
    static PrintedSet of(const std::string& text) {
        if (text.starts_with("in [") && text.ends_with("]")) {
            const std::size_t comma = text.find(", ");
            return {Real(text.substr(4, comma - 4)), Real(text.substr(comma + 2, text.size() - comma - 3))};
        }
        const std::size_t sign = text.find(" +- ");
        if (!text.starts_with("= ")) ADD_FAILURE() << text;
        const Real center(text.substr(2, sign == text.npos ? sign : sign - 2));
        const Real off = sign == text.npos ? Real(0) : Real(text.substr(sign + 4));
        return {center - off, center + off};
    }
    Real width() const { return high - low; }
};

// Rounding error of the quadruples, which is not an error of the text.
inline Real rounding_of(const PrintedSet& x) {
    return (boost::multiprecision::abs(x.low) + boost::multiprecision::abs(x.high)) * Real(1e-32);
}
inline bool holds(const PrintedSet& x, const Interval& all) {
    return x.low - rounding_of(x) <= Real(all.lo()) && Real(all.hi()) <= x.high + rounding_of(x);
}
inline bool lies_in(const PrintedSet& x, const Interval& all) {
    return x.low + rounding_of(x) >= Real(all.lo()) && Real(all.hi()) >= x.high - rounding_of(x);
}

}  // namespace achilles::test
