// Newton's impact law over doubles, intervals and jets, and Moreau's law: examples with known results.
#include "contacts/impact_law.hpp"

#include <gtest/gtest.h>

#include <array>

#include "contacts/moreau.hpp"
#include "core/contacts/some_contacts.hpp"
#include "number/jet.hpp"

namespace achilles {
namespace {

// A frictionless ball of mass 2 moves at 5 sideways and 3 downwards. The floor (e = 1/2) rises at 1/4, so hdot = -3 -
// 1/4. On a fixed floor v+ = -e v-, p = m (1 + e) |v-|, and the loss is (1 - e^2) m v^2/2 = (1 - e^2) 9.
template <class Number>
struct Ball {
    Number e, hdot, W = Number(0.5);
    std::array<Number, 2> v{Number(5.0), Number(-3.0)};
    Number removed = newton::removed_rate(e, hdot), p = newton::impulse(e, hdot, W);
    void strike() {
        newton::move_along(
            v.data(), 2, [](std::size_t i) { return Number(i == 1 ? 1.0 : 0.0); }, removed);
    }
};

TEST(ImpactLaw, OfABallOnAFloorThatStands) {
    Ball<double> ball{0.5, -3.0};
    ball.strike();
    EXPECT_EQ(ball.v[0], 5.0);
    EXPECT_EQ(ball.v[1], 1.5);
    EXPECT_EQ(newton::rate_after(ball.e, ball.hdot), 1.5);
    EXPECT_EQ(ball.p, 9.0);
    EXPECT_EQ(newton::loss(ball.p, ball.e, ball.hdot), 9.0 * 0.75);
    EXPECT_EQ(newton::work(ball.p, 0.0), 0.0);
}

// T changes from 9 to m (2.125)^2/2: the work of the floor minus the loss.
TEST(ImpactLaw, OfABallOnAFloorThatRises) {
    Ball<double> ball{0.5, -3.25};
    ball.strike();
    EXPECT_EQ(ball.v[1], 1.875);
    EXPECT_EQ(ball.p, 9.75);
    EXPECT_EQ(newton::work(ball.p, -0.25), 2.4375);
    EXPECT_EQ(newton::loss(ball.p, ball.e, ball.hdot), 7.921875);
    EXPECT_EQ(ball.v[1] * ball.v[1] - 9.0, 2.4375 - 7.921875);
}

TEST(ImpactLaw, OfIntervalsHoldsTheNumbers) {
    Ball<Interval> ball{Interval(0.25, 0.5), Interval(-3.0)};
    ball.strike();
    const auto expect_hull = [](const Interval& x, double lo, double hi) {
        EXPECT_TRUE(x.contains(lo) && x.contains(hi));
        EXPECT_LT(width(x), hi - lo + 1e-13);
    };
    expect_hull(ball.v[0], 5.0, 5.0);
    expect_hull(ball.v[1], 0.75, 1.5);
    expect_hull(newton::rate_after(ball.e, ball.hdot), 0.75, 1.5);
    expect_hull(ball.p, 7.5, 9.0);
}

// Derivatives with respect to e and hdot.
TEST(ImpactLaw, OfJetsHasTheDerivatives) {
    using Number = Jet<double, 2>;
    Ball<Number> ball{Number::variable(0.5, 0), Number::variable(-3.0, 1)};
    ball.strike();
    using Slope = std::array<double, 2>;
    EXPECT_EQ(ball.v[1].value, 1.5);
    EXPECT_EQ(ball.v[1].slope, (Slope{3.0, -1.5}));
    EXPECT_EQ(newton::rate_after(ball.e, ball.hdot).slope, (Slope{3.0, -0.5}));
    EXPECT_EQ(ball.p.slope, (Slope{6.0, -3.0}));                                    // -hdot/W, -(1 + e)/W
    EXPECT_EQ(newton::loss(ball.p, ball.e, ball.hdot).slope, (Slope{-9.0, -4.5}));  // m/2 hdot^2 (1 - e^2)
}

// The ball hits a right-angled corner of a floor (e = 1/2) and a wall (e = 1/4). The two contacts are uncoupled.
TEST(ImpactLaw, InARightCornerIsOneForEachContact) {
    ContactMatrix<double> W(2, 2);
    W << 0.5, 0.0, 0.0, 0.5;
    const ContactVector<double> e = numbers({0.5, 0.25}), before = numbers({-3.0, -4.0});
    const auto impact = moreau_impact(W, before, e, {});
    EXPECT_EQ(impact->hdot_after, numbers({1.5, 1.0}));
    EXPECT_EQ(impact->impulses, numbers({9.0, 10.0}));
    EXPECT_EQ(impact->loss, 6.75 + 15.0);
    for (Eigen::Index i = 0; i < 2; ++i) {
        EXPECT_EQ(impact->impulses[i], newton::impulse(e[i], before[i], W(i, i)));
        EXPECT_EQ(impact->hdot_after[i], newton::rate_after(e[i], before[i]));
    }
}

// The ball slides along a wall of a 60-degree corner, g1 g2' = -1/2, and hits the other wall: kappa = 1/2, W_2^{1} =
// 3/8.
TEST(ImpactLaw, InASharpCornerPassesHalfOn) {
    const auto impact = moreau_impact(0.5 * pair_with(-0.5), numbers({0.0, -3.0}), numbers({0.25, 0.5}), contacts({0}));
    EXPECT_EQ(impact->impulses, numbers({6.0, 12.0}));
    EXPECT_EQ(impact->hdot_after, numbers({0.0, 1.5}));
    EXPECT_EQ(impact->loss, 9.0);  // T along the wall: (m/2)(3/sin 60)^2 = 12; 1/4 of it remains
    EXPECT_TRUE(impact->opened.empty());
}

}  // namespace
}  // namespace achilles
