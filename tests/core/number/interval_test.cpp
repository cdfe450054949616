// Interval always contains the exact value: compared with 100 digits on random and hostile endpoints.
#include "number/interval.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/number/interval_cases.hpp"
#include "expression/scalar.hpp"

namespace achilles {
namespace {

using cases::Argument;
using cases::Draw;
using cases::encloses;
using cases::Exact;
using cases::TestOperation;

// Point arguments: undefined exactly where the function is undefined, otherwise around the exact value.
TEST(Interval, ContainsTheExactResult) {
    Draw draw;
    cases::visit_everything([&](const TestOperation& operation, auto function) {
        for (int i = 0; i < 2000; ++i) {
            const auto [a, b] = cases::arguments(draw, operation);
            const double x = a.inside, y = b.inside;
            if (operation.trigonometric && std::abs(x) > 0x1p60) continue;  // more digits than Exact has
            const Interval ours = function(a.interval, b.interval);
            if (!cases::is_inside(operation.domain, a.interval, b.interval)) {
                EXPECT_FALSE(ours.is_defined()) << operation.name << " " << x << " " << y;
            } else if (ours.is_defined() || !cases::may_refuse(operation.domain)) {
                const Exact exact = function(Exact(x), Exact(y));
                EXPECT_TRUE(encloses(ours, exact)) << operation.name << " " << x << " " << y;
            }
            EXPECT_TRUE(cases::sizes_hold(a.interval, x)) << x;
        }
    });
}

// At point arguments the result is a few ulps wide.
TEST(Interval, FunctionsOfPointsAreNarrow) {
    Draw draw;
    cases::visit_functions([&](const TestOperation& operation, auto function) {
        for (int i = 0; i < 2000; ++i) {
            const Interval x(cases::arguments(draw, operation).first.inside);
            if (x.lo() < operation.low || x.hi() > operation.high) continue;
            const Interval ours = function(x, x);
            if (!ours.is_defined() || !std::isfinite(ours.hi())) continue;
            EXPECT_LE(width(ours), 40 * 0x1p-52 * mag(ours) + 40 * 0x1p-1074) << operation.name << "(" << x.lo() << ")";
        }
    });
}

// With a smaller widening w, from r to r -+ w |r|, the same arguments would find errors. With w = 2^-53 they do if r is
// a power of two below the exact value. Only quotients are safe: if x > y then x/y >= 1 + ulp(y)/y > 1 + 2^-53, which
// does not round to 1.
TEST(Interval, LessWideningWouldBeCaught) {
    Draw draw;
    cases::visit_everything([&](const TestOperation& operation, auto function) {
        if (operation.selects) return;
        int half = 0, none = 0;
        for (int i = 0; i < 6000; ++i) {
            const auto [a, b] = cases::arguments(draw, operation);
            const double x = a.inside, y = b.inside, r = function(x, y);
            // Denormals and overflow are widened for other reasons.
            if (!std::isnormal(r) || !cases::is_inside(operation.domain, Interval(x), Interval(y))) continue;
            if (operation.trigonometric && std::abs(x) > 0x1p60) continue;
            const Exact exact = function(Exact(x), Exact(y));
            const auto outside = [&](double w) {
                return !encloses(Interval(r - w * std::abs(r), r + w * std::abs(r)), exact);
            };
            half += outside(0x1p-53);
            none += outside(0.0);
        }
        const std::string name = operation.name;
        if (name != "power 1") {  // which rounds nothing
            EXPECT_GT(none, 100) << name << ", half: " << half;
        }
        if (name == "+" || name == "-" || name == "*" || name == "sqrt" || name == "exp" || name == "cosh") {
            EXPECT_GT(half, 10) << name;
        }
        if (name == "/") {
            EXPECT_EQ(half, 0);
        }
    });
}

TEST(Interval, SineAndCosineReachOneExactlyAtTheirExtrema) {
    for (int k = -40; k <= 40; ++k) {
        const double x = k * 1.5707963267948966;  // next to k pi/2
        const Interval around(std::nextafter(x, -HUGE_VAL) - 1e-9, std::nextafter(x, HUGE_VAL) + 1e-9);
        const int quarter = ((k % 4) + 4) % 4;
        EXPECT_EQ(sin(around).hi() == 1.0, quarter == 1) << k;
        EXPECT_EQ(sin(around).lo() == -1.0, quarter == 3) << k;
        EXPECT_EQ(cos(around).hi() == 1.0, quarter == 0) << k;
        EXPECT_EQ(cos(around).lo() == -1.0, quarter == 2) << k;
    }
    EXPECT_TRUE(sin(Interval(0.0, 7.0)).contains(Interval(-1.0, 1.0)));
    EXPECT_TRUE(cos(Interval(1e300)).contains(Interval(-1.0, 1.0)));
    EXPECT_TRUE(sin(Interval::everything()).contains(Interval(-1.0, 1.0)));
    EXPECT_TRUE(cos(Interval(1e5, 1e5 + 1e-3)).contains(std::cos(1e5 + 5e-4)));
    EXPECT_LT(width(cos(Interval(1e5, 1e5 + 1e-3))), 1.1e-3);
}

// The rough check never misses a multiple of pi, close to which it does not answer, and finds that most narrow
// intervals have none.
TEST(Interval, AnglesClearOfMultiplesOfPiAreFoundRoughly) {
    Draw draw;
    int clear = 0, none = 0;
    for (int i = 0; i < 40000; ++i) {
        const double shift = i % 2 == 0 ? 0.0 : 0.5;
        const double turns = std::round(draw.uniform(-1.0, 1.0) * std::exp2(draw.uniform(0.0, 38.0))) + shift;
        const double size = std::exp2(draw.uniform(-50.0, 1.0));  // how far from the multiple it may start
        const double from = 3.141592653589793 * turns + draw.uniform(-size, size);
        const Interval a(from, from + std::exp2(draw.uniform(-50.0, 2.0)));
        const bool is_clear = rounding::is_clear_of_multiples(a, shift);
        const bool has_none = rounding::multiples_of_pi(a, shift).none();
        EXPECT_TRUE(!is_clear || has_none) << a.lo() << " " << a.hi() << " " << shift;
        clear += is_clear;
        none += has_none;
        const Interval narrow(draw.uniform(-100.0, 100.0));
        const bool is_rough = rounding::is_clear_of_multiples(narrow, shift);
        EXPECT_TRUE(is_rough || mig(sin(narrow)) > 0.9999 || mig(cos(narrow)) > 0.9999) << narrow.lo();
    }
    EXPECT_GT(none, 10000);
    EXPECT_GT(clear, none / 8);
}

TEST(Interval, Powers) {
    Draw draw;
    for (int i = 0; i < 3000; ++i) {
        const auto [a, x] = draw.around(draw.number());
        if (std::abs(x) > 1e30 || mag(a) > 1e30) continue;
        for (int n : {-3, -2, -1, 0, 1, 2, 3, 4, 7}) {
            const Interval ours = integer_power(a, n);
            if (n < 0 && (a.contains(0.0) || mig(a) < 1e-60)) continue;  // may underflow: undefined is allowed
            EXPECT_TRUE(encloses(ours, n >= 0 ? Exact(pow(Exact(x), n)) : 1 / Exact(pow(Exact(x), -n)))) << x << n;
        }
        const double base = std::abs(x) + 1e-10, exponent = draw.uniform(-5.0, 5.0);
        EXPECT_TRUE(encloses(pow(Interval(base, 2 * base), Interval(exponent, exponent + 0.1)),
                             pow(Exact(base), Exact(exponent))))
            << base << "^" << exponent;
    }
    EXPECT_EQ(integer_power(Interval(-2.0, 1.0), 2).lo(), 0.0);  // tight: not [-2, 4]
    EXPECT_LT(integer_power(Interval(-2.0, 1.0), 4).hi(), 16.001);
    EXPECT_NEAR(integer_power(Interval(-2.0, 1.0), 3).lo(), -8.0, 1e-12);
    EXPECT_FALSE(pow(Interval(0.0, 1.0), Interval(0.5)).is_defined());
    EXPECT_FALSE(integer_power(Interval(-1.0, 1.0), -1).is_defined());
}

TEST(Interval, UnboundedSetsAreSets) {
    const double inf = HUGE_VAL;
    EXPECT_TRUE((Interval(0.0, inf) * Interval(0.0)).contains(0.0));
    EXPECT_TRUE((Interval(1.0, inf) / Interval(1.0, inf)).contains(Interval(0.0, 1e300)));
    EXPECT_TRUE((Interval(1e308) * Interval(10.0)).contains(Interval(std::numeric_limits<double>::max(), inf)));
    EXPECT_TRUE((Interval(1e308) + Interval(1e308)).is_defined());
    EXPECT_TRUE(atan(Interval::everything()).contains(Interval(-1.57, 1.57)));
    EXPECT_TRUE(exp(Interval::everything()).contains(Interval(0.0, inf)));
    EXPECT_FALSE(Interval(inf).is_defined());
    EXPECT_FALSE(Interval(-inf, -inf).is_defined());
}

// A corner of these products is 0 inf, in each of the four places.
TEST(Interval, ProductsOfZeroAndUnboundedSetsAreDefined) {
    for (const Interval& zero : {Interval(0.0), Interval(0.0, 1.0), Interval(-1.0, 0.0)}) {
        const Interval left = zero * Interval::everything(), right = Interval::everything() * zero;
        EXPECT_TRUE(left.is_defined() && left.contains(0.0));
        EXPECT_TRUE(right.is_defined() && right.contains(0.0));
    }
    EXPECT_LE((Interval(0.0) * Interval::everything()).hi(), 1e-300);
}

TEST(Interval, WhatTouchesIsNotLess) {
    EXPECT_FALSE(certainly_less(Interval(0.0, 1.0), Interval(1.0, 2.0)));
    EXPECT_TRUE(certainly_less(Interval(0.0, 0.5), Interval(1.0, 2.0)));
}

TEST(Interval, UndefinedPropagatesAndProvesNothing) {
    const Interval one(1.0);
    const std::vector<Interval> undefined{
        Interval::undefined(),      Interval(2.0, 1.0),    Interval(std::nan("")),         one / Interval(-1.0, 1.0),
        one / Interval(0.0),        sqrt(Interval(-1, 1)), log(Interval(0.0, 1.0)),        asin(Interval(0.5, 1.5)),
        acos(Interval(-2)),         tan(Interval(1, 2)),   pow(Interval(-1), Interval(1)), tan(Interval(1e200)),
        tan(Interval::everything())};
    for (const Interval& u : undefined) {
        std::vector<Interval> results{u,           -u,          u + one,         one + u,         u - one,   one - u,
                                      u * one,     one * u,     u * Interval(0), Interval(0) * u, u / one,   one / u,
                                      sqrt(u),     sin(u),      cos(u),          tan(u),          asin(u),   acos(u),
                                      atan(u),     sinh(u),     cosh(u),         tanh(u),         exp(u),    log(u),
                                      square(u),   abs(u),      hull(u, one),    hull(one, u),    max(u, 1), max(1, u),
                                      pow(u, one), pow(one, u), pow(2, u)};
        for (int n : {-2, -1, 0, 1, 2, 3}) results.push_back(integer_power(u, n));
        for (const Interval& r : results) {
            EXPECT_FALSE(r.is_defined()) << &r - results.data();
            EXPECT_TRUE(std::isnan(r.lo()) && std::isnan(r.hi())) << &r - results.data();
            EXPECT_FALSE(certainly_less(r, one) || certainly_less(one, r));
            EXPECT_FALSE(certainly_positive(r) || certainly_negative(r));
            EXPECT_FALSE(r.contains(0.0) || r.contains(one) || Interval::everything().contains(r));
            EXPECT_EQ(mag(r), HUGE_VAL);
            EXPECT_EQ(mig(r), 0.0);
            EXPECT_EQ(rad(r), HUGE_VAL);
            EXPECT_EQ(width(r), HUGE_VAL);
        }
    }
}

TEST(Interval, IsAScalarOfPrograms) {
    EXPECT_TRUE(encloses(scalar_pi<Interval>(), boost::math::constants::pi<Exact>()));
    EXPECT_EQ(scalar_from<Interval>(Constant{0.1, 0.09, 0.11, "1", "10"}).hi(), 0.11);
    EXPECT_EQ(integer_power<double>(3.0, -2), 1.0 / 9.0);
}

}  // namespace
}  // namespace achilles
