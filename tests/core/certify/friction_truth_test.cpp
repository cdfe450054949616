// Certificates of bouncing with dry friction (theory-friction.md 4) against bouncing in 34 digits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "certify/friction_tails.hpp"

namespace achilles::test {

namespace {

// Most certificates must exist, and the bounds must not be so wide that no error could violate them.
void expect_true(const FrictionTails& tails) {
    EXPECT_EQ(tails.violations, 0) << tails.first_failure;
    EXPECT_GT(tails.proved, tails.trials / 4);
    EXPECT_GT(tails.closest, 0.3);
    EXPECT_LE(tails.closest, 1.0);
}

}  // namespace

TEST(FrictionTruth, CertificatesOfSlidingHold) { expect_true(check_friction_tails(false, 300, 1)); }
TEST(FrictionTruth, CertificatesOfStickingHold) { expect_true(check_friction_tails(true, 300, 2)); }
// 2 000 certificates of each kind; takes minutes.
TEST(FrictionTruth, DISABLED_ManyCertificatesHold) {
    for (const bool sticks : {false, true}) {
        const FrictionTails tails = check_friction_tails(sticks, 6000, 3);
        expect_true(tails);
        EXPECT_GE(tails.proved, 2000);
        RecordProperty(sticks ? "sticking" : "sliding",
                       fmt::format("{} proved, {} violations, largest part of a bound {:.4f}", tails.proved,
                                   tails.violations, tails.closest));
    }
}

}  // namespace achilles::test
