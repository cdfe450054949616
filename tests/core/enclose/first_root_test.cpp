#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "certify/taylor.hpp"
#include "enclose/crossing_surface.hpp"

namespace achilles::test {

TEST(FirstRoot, ProvesThatThereIsNoneOrOneOrSaysNothing) {
    const Intervals falls{Interval(1.0), Interval(0.0), Interval(-1.0)};  // 1 - t^2
    EXPECT_EQ(first_root(falls, 0.999).kind, FirstRoot::Kind::none);
    const FirstRoot one = first_root(falls, 1.5);
    EXPECT_EQ(one.kind, FirstRoot::Kind::one);
    EXPECT_TRUE(one.at.contains(1.0));
    EXPECT_LT(width(one.at), 1e-6);
    const Intervals touches{Interval(1.0), Interval(-2.0), Interval(1.0)};  // (1 - t)^2
    const FirstRoot doubt = first_root(touches, 2.0);
    EXPECT_EQ(doubt.kind, FirstRoot::Kind::undecided);
    EXPECT_GT(doubt.at.lo(), 0.9);
    EXPECT_LT(doubt.at.lo(), 1.0);
    // Two roots in one step; then sets in which only some members have them.
    EXPECT_EQ(first_root({Interval(0.99), Interval(-2.0), Interval(1.0)}, 2.0).kind, FirstRoot::Kind::one);
    EXPECT_EQ(first_root({Interval(0.99, 1.01), Interval(-2.0), Interval(1.0)}, 2.0).kind, FirstRoot::Kind::undecided);
    EXPECT_EQ(first_root({Interval(-0.1, 1.0), Interval(1.0)}, 2.0).kind, FirstRoot::Kind::undecided);
    // A root that the end of the interval cuts.
    EXPECT_EQ(first_root({Interval(0.9, 1.1), Interval(-1.0)}, 1.0).kind, FirstRoot::Kind::undecided);
    EXPECT_EQ(first_root({Interval::undefined(), Interval(-1.0)}, 1.0).kind, FirstRoot::Kind::undecided);
}

// Lemma: h/t^m and its derivative lie in those of the series with the remainder as a constant interval coefficient.
// Here h = sum of a_j exp(b_j t), without its first m orders. Orders are counted from 0.
TEST(FirstRoot, ARemainderMayBeDifferentiated) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    constexpr int K = 5;
    for (int trial = 0; trial < 60; ++trial) {
        const double a = uniform(random), b = 3.0 * uniform(random), c = uniform(random), d = 3.0 * uniform(random);
        const double T = 0.2 + 0.5 * std::abs(uniform(random));
        double factorial = 1.0;
        std::array<double, K + 1> order{};
        for (int k = 0; k <= K; ++k) {
            if (k > 0) factorial *= k;
            order[static_cast<std::size_t>(k)] = (a * std::pow(b, k) + c * std::pow(d, k)) / factorial;
        }
        const auto top = [&](const Interval& t) {  // h_{K+1} along the solution
            return (Interval(a * std::pow(b, K + 1)) * exp(Interval(b) * t) +
                    Interval(c * std::pow(d, K + 1)) * exp(Interval(d) * t)) /
                   Interval(factorial * (K + 1));
        };
        for (int m = 0; m <= 3; ++m) {
            Intervals p;
            for (int k = m; k <= K; ++k)
                p.push_back(Interval(order[static_cast<std::size_t>(k)]) + Interval(-1e-14, 1e-14));
            p.push_back(top({0.0, T}));
            const auto h = [&](const Real& t) {
                Real sum = a * exp(b * t) + c * exp(d * t), power = 1;
                for (int k = 0; k < m; ++k, power *= t) sum -= Real(order[static_cast<std::size_t>(k)]) * power;
                return Real(sum / pow(t, m));
            };
            for (const double share : {0.1, 0.5, 0.9, 1.0}) {
                const double t = share * T, step = 1e-9;
                const double value = static_cast<double>(h(Real(t)));
                const double slope = static_cast<double>((h(Real(t) + step) - h(Real(t) - step)) / (2 * Real(step)));
                const Interval v = value_over(p, Interval(t)), s = slope_over(p, Interval(t));
                EXPECT_TRUE(v.lo() - 1e-11 <= value && value <= v.hi() + 1e-11) << m;
                EXPECT_TRUE(s.lo() - 1e-9 <= slope && slope <= s.hi() + 1e-9) << m;
            }
        }
    }
}

}  // namespace achilles::test
