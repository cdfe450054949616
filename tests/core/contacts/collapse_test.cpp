// Impacts of two contacts that alternate without force (theory-collapse.md 1 and 4).
#include "contacts/collapse.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace achilles {
namespace {

// The impacts in turn after an impact of contact 0, in the order of the theory: speeds and gaps one by one.
struct AlternateRun {
    double t = 0.0;
    bool alternates = true;  // the last speed was positive
    double speed = 0.0;
};
AlternateRun impacts_in_turn_of(const PairLaw<double>& pair, double rise, double fall, double gap, int most) {
    AlternateRun sequence;
    std::array<double, 2> sigma{rise, -fall}, h{0.0, gap};
    const std::array<double, 2> W{pair.W11, pair.W22};
    std::size_t next = 1;
    for (int i = 0; i < most && sequence.alternates; ++i) {
        const double wait = h[next] / -sigma[next];
        sequence.t += wait;
        h[1 - next] += wait * sigma[1 - next];
        h[next] = 0.0;
        const double u = -sigma[next];
        sigma[next] = pair.e[next] * u;
        sigma[1 - next] += (next == 0 ? pair.W21 : pair.W12) * (1.0 + pair.e[next]) * u / W[next];
        next = 1 - next;
        sequence.alternates = sigma[next] < 0.0;
        sequence.speed = u;
    }
    return sequence;
}

PairLaw<double> random_pair(std::mt19937_64& random) {
    std::uniform_real_distribution<double> part(0.0, 1.0);
    const double W1 = std::exp(4.0 * part(random) - 2.0), W2 = std::exp(4.0 * part(random) - 2.0);
    const double skew = std::exp(part(random) - 0.5);  // of contacts that slide
    const double c = std::sqrt(W1 * W2 * (0.7 + 0.299 * part(random)));
    return {W1, -c * skew, -c / skew, W2, {0.01 + 0.4 * part(random), 0.01 + 0.4 * part(random)}};
}

// Inside the cone the impacts have no end, and take exactly the time of the closed form; outside they end.
TEST(AlternateImpacts, HaveTheTimeOfTheClosedForm) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> part(0.0, 1.0);
    int inside = 0, outside = 0;
    for (int i = 0; i < 2000; ++i) {
        const PairLaw<double> pair = random_pair(random);
        const AlternateImpacts law(pair);
        if (!law.is_real || law.mu_minus > 0.8 * law.mu_plus) continue;
        const double limit = law.nu(0), fall = limit * (0.5 + 1.5 * part(random));
        if (std::abs(fall - limit) < 1e-3 * limit) continue;
        const double T = law.time(0, 1.0, -fall, 0.01);
        const AlternateRun sequence = impacts_in_turn_of(pair, 1.0, fall, 0.01, 400);
        if (fall > limit) {
            ++inside;
            ASSERT_TRUE(sequence.alternates) << i;
            EXPECT_NEAR(sequence.t, T, 1e-9 * T) << i;
        } else {
            ++outside;
            EXPECT_FALSE(sequence.alternates) << i;
            EXPECT_LT(T, 0.0) << i;
        }
    }
    EXPECT_GT(inside, 200);
    EXPECT_GT(outside, 100);
}

// Per two impacts the speeds fall by mu+.
TEST(AlternateImpacts, LoseSpeedByTheGreaterFactor) {
    const PairLaw<double> pair{1.0, -0.9, -0.9, 1.0, {0.1, 0.1}};
    const AlternateImpacts law(pair);
    EXPECT_NEAR(law.mu_plus, 0.7671, 1e-4);
    EXPECT_NEAR(law.mu_minus, 0.01304, 1e-5);
    const double first = impacts_in_turn_of(pair, 0.1, 1.0, 0.01, 20).speed;
    EXPECT_NEAR(impacts_in_turn_of(pair, 0.1, 1.0, 0.01, 22).speed / first, law.mu_plus, 1e-9);
}

// Three equal balls: both conditions have thresholds in closed form.
TEST(AlternateImpacts, OfThreeBallsHaveTheKnownThresholds) {
    const auto balls = [](double e) { return PairLaw<double>{2.0, -1.0, -1.0, 2.0, {e, e}}; };
    const double collapse = 7.0 - 4.0 * std::sqrt(3.0), fast = 9.0 - 4.0 * std::sqrt(5.0);
    for (const double sign : {-1.0, 1.0}) {
        EXPECT_EQ(AlternateImpacts(balls(collapse * (1.0 + 1e-9 * sign))).is_real, sign < 0.0);
        EXPECT_EQ(AlternateImpacts(balls(fast * (1.0 + 1e-9 * sign))).is_fast, sign < 0.0);
    }
    const AlternateImpacts slow(balls(0.05));
    EXPECT_NEAR(slow.mu_plus, 0.16, 1e-12);
    EXPECT_NEAR(slow.mu_minus, 0.015625, 1e-12);
    EXPECT_NEAR(slow.nu(0), 2.5, 1e-12);
}

// The unit of a gap changes neither conditions nor time.
TEST(AlternateImpacts, DoNotDependOnTheUnitOfAGap) {
    const PairLaw<double> pair{1.0, -0.9, -0.9, 1.2, {0.1, 0.2}}, other{1.0, -900.0, -900.0, 1.2e6, {0.1, 0.2}};
    const AlternateImpacts a(pair), b(other);
    EXPECT_NEAR(a.mu_plus, b.mu_plus, 1e-14);
    EXPECT_NEAR(a.time(0, 0.1, -1.0, 0.01), b.time(0, 0.1, -1000.0, 10.0), 1e-14);
}

TEST(AlternateImpacts, CollapseAtATieOnlyIfProved) {
    const auto tie = [](double c, double e1, double e2, double radius = 0.0) {
        return collapses_at_tie({Interval(1.0),
                                 Interval(c - radius, c + radius),
                                 Interval(c),
                                 Interval(1.0),
                                 {Interval(e1), Interval(e2)}});
    };
    EXPECT_TRUE(tie(-0.9, 0.1, 0.1));
    EXPECT_FALSE(tie(0.9, 0.1, 0.1));
    EXPECT_FALSE(tie(-0.5, 0.5, 0.5));
    EXPECT_FALSE(tie(-0.9, 0.0, 0.1));  // a contact with e = 0 stays where it lands
    EXPECT_FALSE(tie(-0.9, 1.0, 0.1));
    // On the threshold c = (sqrt e1 + sqrt e2)/sqrt((1 + e1)(1 + e2)) nothing is proved.
    const double c = 2.0 * std::sqrt(0.1) / 1.1;
    EXPECT_TRUE(tie(-c - 1e-9, 0.1, 0.1));
    EXPECT_FALSE(tie(-c - 1e-9, 0.1, 0.1, 2e-9));
    EXPECT_FALSE(tie(-c + 1e-9, 0.1, 0.1));
}

}  // namespace
}  // namespace achilles
