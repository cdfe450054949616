// Derivatives against differences; derivatives over intervals against those at points.
#include "number/jet.hpp"

#include <gtest/gtest.h>

#include "expression/scalar.hpp"

namespace achilles::test {

namespace {

template <class Number>
std::vector<Number> functions_of(const Number& x, const Number& y) {
    using std::acos, std::asin, std::atan, std::cos, std::cosh, std::exp, std::log, std::pow, std::sin, std::sinh,
        std::sqrt, std::tan, std::tanh;
    Number sine, cosine;
    sine_and_cosine(x * y, sine, cosine);
    return {x + y * x,     x - y / x,   -x * y,      sqrt(x + y), exp(x * y),          log(x + y),
            sin(x * y),    cos(x - y),  tan(x * y),  asin(x * y), acos(x * y),         atan(x / y),
            sinh(x),       cosh(x * y), tanh(y - x), pow(x, y),   integer_power(x, 3), integer_power(y, -2),
            sine * cosine, 2.0 * x / y};
}

}  // namespace

TEST(Jet, DerivativesAreThoseOfDifferences) {
    using TwoDirections = Jet<double, 2>;
    const double x = 0.7, y = 0.45, step = 1e-6;
    const auto all = functions_of(TwoDirections::variable(x, 0), TwoDirections::variable(y, 1));
    const auto at = [](double a, double b) { return functions_of(Jet<double, 1>(a), Jet<double, 1>(b)); };
    for (std::size_t i = 0; i < all.size(); ++i) {
        SCOPED_TRACE(i);
        EXPECT_EQ(all[i].value, at(x, y)[i].value);
        EXPECT_NEAR(all[i].slope[0], (at(x + step, y)[i].value - at(x - step, y)[i].value) / (2.0 * step), 1e-7);
        EXPECT_NEAR(all[i].slope[1], (at(x, y + step)[i].value - at(x, y - step)[i].value) / (2.0 * step), 1e-7);
    }
}

TEST(Jet, OverABoxContainsThePoints) {
    using TwoDirections = Jet<Interval, 2>;
    const Interval x(0.69, 0.71), y(0.44, 0.46);
    const auto all = functions_of(TwoDirections::variable(x, 0), TwoDirections::variable(y, 1));
    for (const double a : {0.69, 0.7, 0.71})
        for (const double b : {0.44, 0.45, 0.46}) {
            const auto here = functions_of(Jet<double, 2>::variable(a, 0), Jet<double, 2>::variable(b, 1));
            for (std::size_t i = 0; i < all.size(); ++i) {
                EXPECT_TRUE(all[i].value.contains(here[i].value)) << i;
                for (std::size_t j = 0; j < 2; ++j) EXPECT_TRUE(all[i].slope[j].contains(here[i].slope[j])) << i;
            }
        }
    EXPECT_FALSE(log(TwoDirections::variable({-1.0, 1.0}, 0)).value.is_defined());
    EXPECT_FALSE((TwoDirections(1.0) / TwoDirections::variable({-1.0, 1.0}, 0)).slope[0].is_defined());
}

// Constants have the precision of the number type: 1/3 is not a double. Their derivative is zero.
TEST(Jet, HasTheConstantsOfItsNumber) {
    Constant third{1.0 / 3.0, std::nextafter(1.0 / 3.0, 0.0), std::nextafter(1.0 / 3.0, 1.0), "1", "3"};
    const auto constant = scalar_from<Jet<Interval, 2>>(third);
    EXPECT_EQ(constant.value.lo(), third.low);
    EXPECT_EQ(constant.value.hi(), third.high);
    EXPECT_EQ(mag(constant.slope[1]), 0.0);
    const auto pi = scalar_pi<Jet<Interval, 2>>();
    EXPECT_LT(pi.value.lo(), pi.value.hi());
    EXPECT_EQ(mag(pi.slope[0]), 0.0);
}

// Exactly 0: widening it to the smallest denormal would slow down everything that follows.
TEST(Jet, ZeroTimesAnythingIsZero) {
    const Interval product = times(Interval(0.0), Interval(-3.0, 1e300));
    EXPECT_EQ(product.lo(), 0.0);
    EXPECT_EQ(product.hi(), 0.0);
    EXPECT_FALSE(times(Interval(0.0), Interval::undefined()).is_defined());
}

}  // namespace achilles::test
