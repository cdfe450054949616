// Random members of boxes are inside the enclosures; bench_enclose tests a thousand of each.
#include "certify/members.hpp"

#include "core/enclose/truth.hpp"

namespace achilles::test {

TEST(Members, OfABoxAreInItsEnclosure) {
    long compared = 0;
    for (const std::string& name : systems_without_friction()) {
        SCOPED_TRACE(name);
        const auto model = load(name);
        const double half = name == "triple_pendulum" ? 1e-10 : 1e-6;
        const Membership members = members_of(model, claim_around(*model, 4.0, half, 0.0, 21), 8, 11);
        EXPECT_EQ(members.outside, 0) << members.first;
        compared += members.compared;
    }
    EXPECT_GT(compared, 3200);
}

// The enclosure must not be much larger than the set of its members. Otherwise it would be useless and hide errors.
TEST(Members, OfABoxAreNotMuchFewerThanItsEnclosureHolds) {
    for (const Problem& problem : problems) {
        const auto model = load(problem.asset);
        const Membership members = members_of(model, claim_around(*model, 20.0, 1e-6, 0.0), 50, 12);
        EXPECT_EQ(members.outside, 0) << members.first;
        EXPECT_TRUE(members.proved.end);
        EXPECT_LT(members.width_over_observed, 2.0) << problem.asset;
    }
}

// With intervals for e and g. The driven oscillator forgets its initial state each cycle; so must its box.
TEST(Members, OfABoxWithParametersAreInItsEnclosure) {
    for (const std::string name : {"ball_on_sine", "double_pendulum", "impact_oscillator"}) {
        SCOPED_TRACE(name);
        const auto model = load(name);
        const Membership members = members_of(model, claim_around(*model, 8.0, 1e-7, 1e-7), 50, 13);
        EXPECT_EQ(members.outside, 0) << members.first;
        EXPECT_TRUE(members.proved.end) << members.proved.outcome.message;
        EXPECT_LT(members.width_over_observed, 3.0);
    }
}

}  // namespace achilles::test
