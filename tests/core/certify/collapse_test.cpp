// The bound on the time of a collapse, against sequences of impacts with k, e and accelerations that vary within their
// enclosures (theory-collapse.md 3).
#include "certify/collapse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "contacts/collapse.hpp"

namespace achilles {
namespace {

// First t > 0 with h + v t + a t^2/2 = 0 for v < 0.
double landing(double h, double v, double a) {
    const double D = v * v - 2.0 * a * h;
    return D < 0.0 ? std::numeric_limits<double>::infinity() : 2.0 * h / (-v + std::sqrt(D));
}

struct PairStart {
    double rise, fall, gap;
};

// Time of the impacts in turn after one of contact 0, with accelerations of either sign chosen at random in every
// flight. Negative if they stop alternating.
double time_of(const std::array<double, 2>& k, const std::array<double, 2>& e, double spread, double ah,
               PairStart start, std::mt19937_64& random) {
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    std::array<double, 2> sigma{start.rise, -start.fall}, h{0.0, start.gap};
    std::size_t next = 1;
    double t = 0.0;
    for (int i = 0; i < 400 && h[next] > 1e-300; ++i) {
        const std::array<double, 2> a{part(random) < 0.0 ? -ah : ah, part(random) < 0.0 ? -ah : ah};
        const double wait = landing(h[next], sigma[next], a[next]);
        const std::size_t other = 1 - next;
        // The risen contact must not come back before.
        const double back = h[other] + sigma[other] * wait + 0.5 * a[other] * wait * wait;
        if (!std::isfinite(wait) || back < 0.0) return -1.0;
        t += wait;
        h[other] = back;
        h[next] = 0.0;
        for (std::size_t n = 0; n < 2; ++n) sigma[n] += a[n] * wait;
        const double u = -sigma[next];
        if (!(u > 0.0)) return -1.0;
        sigma[other] -= k[next] * (1.0 + spread * part(random)) * u;
        sigma[next] = std::clamp(e[next] * (1.0 + spread * part(random)), 0.0, 1.0) * u;
        next = other;
        if (!(sigma[next] < 0.0)) return -1.0;
    }
    return t;
}

struct CollapseTally {
    int starts = 0, certified = 0;
    double worst = 0.0;
};

CollapseTally tally_of(double spread, double reach) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> part(0.0, 1.0);
    CollapseTally tally;
    for (int n = 0; n < 1500; ++n) {
        const double c2 = 0.6 + 0.39 * part(random);
        const std::array<double, 2> e{0.01 + 0.3 * part(random), 0.01 + 0.3 * part(random)};
        const AlternateImpacts law({1.0, -std::sqrt(c2), -std::sqrt(c2), 1.0, e});
        if (!law.is_real || !law.is_fast) continue;
        const double fall = law.nu(0) * e[0] * (1.0 + 2.0 * part(random)), gap = 0.01 * part(random);
        const double ah = reach * part(random) / gap;  // beta = ah gap for u = 1
        const auto around = [&](double x) { return Interval(x * (1.0 - spread), x * (1.0 + spread)); };
        const AlternationBounds bounds{
            {around(law.k[0]), around(law.k[1])}, {around(e[0]), around(e[1])}, Interval(ah)};
        std::string_view failed;
        ++tally.starts;
        const auto bound = collapse_time(bounds, {0, Interval(1.0), Interval(fall), Interval(gap)}, failed);
        if (!bound) {
            EXPECT_FALSE(failed.empty());
            continue;
        }
        EXPECT_LT(bound->contraction, 1.0);
        ++tally.certified;
        for (int run = 0; run < 5; ++run) {
            const double t = time_of(law.k, e, spread, ah, {e[0], fall, gap}, random);
            EXPECT_GE(t, 0.0) << n << ": a certified collapse ended";
            EXPECT_LE(t, bound->T.hi() * (1.0 + 1e-12)) << n;
            tally.worst = std::max(tally.worst, t / bound->T.hi());
        }
    }
    return tally;
}

TEST(CollapseTime, HoldsForEveryAccelerationWithinItsBound) {
    const CollapseTally none = tally_of(0.0, 0.0), some = tally_of(0.0, 0.02);
    EXPECT_GT(none.certified, 0.7 * none.starts);
    EXPECT_GT(none.worst, 0.999999);  // without force the bound is nearly attained
    EXPECT_GT(some.certified, 0.3 * some.starts);
    EXPECT_GT(some.worst, 0.99);
}

TEST(CollapseTime, HoldsForKAndRestitutionWithinTheirEnclosures) {
    const CollapseTally moved = tally_of(0.005, 0.01);
    EXPECT_GT(moved.certified, 0.2 * moved.starts);
    EXPECT_GT(moved.worst, 0.9);
}

// Without force the exact time is known.
TEST(CollapseTime, IsTheClosedFormWithoutForce) {
    const AlternateImpacts law({1.0, -0.9, -0.9, 1.0, {0.1, 0.1}});
    const AlternationBounds bounds{
        {Interval(law.k[0]), Interval(law.k[1])}, {Interval(0.1), Interval(0.1)}, Interval(0.0)};
    std::string_view failed;
    const auto bound = collapse_time(bounds, {0, Interval(1.0), Interval(0.8), Interval(0.01)}, failed);
    ASSERT_TRUE(bound) << failed;
    const double exact = law.time(0, 0.1, -0.8, 0.01);
    EXPECT_GE(bound->T.hi(), exact);
    EXPECT_LE(bound->T.hi(), 1.05 * exact);
}

TEST(CollapseTime, NamesTheInequalityThatFails) {
    const AlternateImpacts law({1.0, -0.9, -0.9, 1.0, {0.1, 0.1}});
    const auto failure = [&](double fall, double acceleration, double e = 0.1) {
        const AlternationBounds bounds{
            {Interval(law.k[0]), Interval(law.k[1])}, {Interval(e), Interval(e)}, Interval(acceleration)};
        std::string_view failed;
        EXPECT_FALSE(collapse_time(bounds, {0, Interval(1.0), Interval(fall), Interval(0.01)}, failed));
        return failed;
    };
    EXPECT_EQ(failure(0.8, 1e3), collapse::still_gap);  // the other contact may turn around before its impact
    EXPECT_EQ(failure(0.8, 30.0, 0.001), collapse::stays_up);
    EXPECT_EQ(failure(0.09, 0.0), collapse::rises);  // outside the cone
}

}  // namespace
}  // namespace achilles
