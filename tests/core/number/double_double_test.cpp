// Fine always contains the exact value, and is precise: compared with 100 digits.
#include "number/double_double.hpp"

#include <gtest/gtest.h>

#include "core/number/interval_cases.hpp"

namespace achilles {
namespace {

using cases::Draw;
using cases::Exact;

// A Fine number and the exact value that it represents.
struct BallAndExact {
    DoubleDoubleBall fine;
    Exact exact;
};

Exact error_of(const BallAndExact& x) { return abs(x.exact - Exact(x.fine.high()) - Exact(x.fine.low())); }

void expect_contained(const BallAndExact& x, const char* what) {
    if (!x.fine.is_defined()) return;
    const Exact own = abs(x.exact) * Exact("1e-98");  // error of the 100 digits
    EXPECT_LE(error_of(x), Exact(x.fine.radius()) + own) << what << " " << x.fine.high();
    EXPECT_TRUE(cases::encloses(x.fine.range(), x.exact)) << what << " " << x.fine.high();
}

// A random sum of two doubles, or an interval with a random value inside.
BallAndExact drawn(Draw& draw, double size) {
    const double a = draw.uniform(-size, size), b = draw.uniform(-0x1p-55, 0x1p-55) * a;
    BallAndExact result{DoubleDoubleBall(a) + DoubleDoubleBall(b), Exact(a) + Exact(b)};
    if (draw.engine() % 2 == 0) {
        const Interval around(a - 1e-12 * size, a + 1e-12 * size);
        result = {DoubleDoubleBall(around), Exact(draw.uniform(around.lo(), around.hi()))};
    }
    return result;
}

template <class Visitor>
void visit(const BallAndExact& a, const BallAndExact& b, const Visitor& visitor) {
    visitor("sum", BallAndExact{a.fine + b.fine, a.exact + b.exact});
    visitor("difference", BallAndExact{a.fine - b.fine, a.exact - b.exact});
    visitor("product", BallAndExact{a.fine * b.fine, a.exact * b.exact});
    if (b.exact != 0) visitor("quotient", BallAndExact{a.fine / b.fine, a.exact / b.exact});
    if (a.exact >= 0) visitor("root", BallAndExact{sqrt(a.fine), sqrt(a.exact)});
    if (abs(a.exact) < 0x1p60) {
        visitor("sine", BallAndExact{sin(a.fine), sin(a.exact)});
        visitor("cosine", BallAndExact{cos(a.fine), cos(a.exact)});
    }
}

TEST(DoubleDouble, ContainsTheExactResult) {
    Draw draw;
    for (int i = 0; i < 4000; ++i) {
        const BallAndExact a = drawn(draw, 8.0), b = drawn(draw, i % 3 == 0 ? 1e-9 : 5.0);
        visit(a, b, [](const char* what, const BallAndExact& result) { expect_contained(result, what); });
        const double x = draw.number(), y = draw.number();
        visit({x, Exact(x)}, {y, Exact(y)}, [](const char* what, const BallAndExact& r) { expect_contained(r, what); });
    }
}

// Results of point arguments to 96 bits, and operations on these results to 72.
TEST(DoubleDouble, IsFine) {
    Draw draw;
    for (int i = 0; i < 4000; ++i) {
        BallAndExact a{draw.uniform(0.25, 4.0), {}}, b{draw.uniform(0.25, 4.0), {}};
        a.exact = a.fine.high();
        b.exact = b.fine.high();
        visit(a, b, [&](const char* what, const BallAndExact& result) {
            expect_contained(result, what);
            EXPECT_LT(result.fine.radius(), 0x1p-96 * std::abs(result.fine.high()) + 0x1p-100) << what;
            visit(result, a, [&](const char* then, const BallAndExact& after) {
                expect_contained(after, then);
                if (std::abs(result.fine.high()) < 0x1p-20) return;  // roots and quotients of it are less precise
                EXPECT_LT(after.fine.radius(), 0x1p-72 * std::abs(after.fine.high()) + 0x1p-90) << what << ", " << then;
            });
        });
    }
}

// Errors propagate: the error of a function of a wide number is as large as its argument's error, and not much larger.
TEST(DoubleDouble, CarriesItsError) {
    const DoubleDoubleBall wide(Interval(0.9999, 1.0001));
    for (const DoubleDoubleBall& x :
         {wide * DoubleDoubleBall(3.0), wide + wide, DoubleDoubleBall(1.0) / wide, sqrt(wide), sin(wide), cos(wide)}) {
        EXPECT_GT(x.radius(), 4e-5);
        EXPECT_LT(x.radius(), 4e-4);
    }
}

TEST(DoubleDouble, InvalidOperationsAreUndefined) {
    const DoubleDoubleBall around_zero(Interval(-1e-20, 1e-20));
    EXPECT_FALSE((DoubleDoubleBall(1.0) / DoubleDoubleBall(0.0)).is_defined());
    EXPECT_FALSE((DoubleDoubleBall(1.0) / around_zero).is_defined());
    EXPECT_FALSE(sqrt(DoubleDoubleBall(-1.0)).is_defined());
    EXPECT_FALSE(sqrt(around_zero).is_defined());
    EXPECT_FALSE((DoubleDoubleBall(1e300) * DoubleDoubleBall(1e300)).is_defined());
    EXPECT_FALSE((DoubleDoubleBall::undefined() + DoubleDoubleBall(1.0)).is_defined());
    EXPECT_FALSE((DoubleDoubleBall(0.0) * DoubleDoubleBall::undefined()).is_defined());
    EXPECT_FALSE((DoubleDoubleBall::undefined() * DoubleDoubleBall(0.0)).range().is_defined());
    EXPECT_FALSE(sin(DoubleDoubleBall::undefined()).is_defined());
    EXPECT_FALSE(log(DoubleDoubleBall(-1.0)).is_defined());
}

// The operations and constants that programs need besides.
TEST(DoubleDouble, IsAScalarOfPrograms) {
    EXPECT_EQ((DoubleDoubleBall(0.0) + DoubleDoubleBall(0.0)).range().hi(), 0.0);
    EXPECT_EQ((DoubleDoubleBall(3.0) * DoubleDoubleBall(0.0)).radius(), 0.0);
    const Exact pi = boost::math::constants::pi<Exact>();
    expect_contained({DoubleDoubleBall::half_pi(), pi / 2}, "pi/2");
    EXPECT_LT(DoubleDoubleBall::half_pi().radius(), 0x1p-107);
    EXPECT_TRUE(exp(DoubleDoubleBall(1.0)).range().contains(std::exp(1.0)));
    EXPECT_TRUE(pow(DoubleDoubleBall(2.0), DoubleDoubleBall(0.5)).range().contains(std::sqrt(2.0)));
    EXPECT_TRUE(tan(DoubleDoubleBall(1.0)).range().contains(std::tan(1.0)));
    EXPECT_LT(tan(DoubleDoubleBall(1.0)).radius(), 0x1p-96);
}

}  // namespace
}  // namespace achilles
