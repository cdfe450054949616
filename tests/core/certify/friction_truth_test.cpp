// Certificates of bouncing with dry friction (theory-friction.md 4) against bouncing in 34 digits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "certify/friction_beside.hpp"
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

TEST(FrictionTruth, CertificatesOfSlidingHold) { expect_true(check_friction_tails(false, 100, 1)); }
TEST(FrictionTruth, CertificatesOfStickingHold) { expect_true(check_friction_tails(true, 100, 2)); }
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

// A contact that bounces while another one is held: how each of them behaves, and whether its impacts are capped.
struct Beside {
    const char* name;
    Rubbing held, bouncing;
    int trials, proved, capped;  // at least so many
};
void PrintTo(const Beside& beside, std::ostream* stream) { *stream << beside.name; }
class FrictionBeside : public testing::TestWithParam<Beside> {};

namespace {

// With 1/part of the trials. Their number of certificates varies, so half of the share of a part is enough.
void expect_certificates_to_hold(const Beside& beside, int part) {
    const auto least = [&](int all) { return part == 1 ? all : (all + 2 * part - 1) / (2 * part); };
    const BesideHeld tally =
        check_bouncing_beside(beside.held, beside.bouncing, beside.trials / part, 1, beside.capped > 0);
    EXPECT_EQ(tally.violations, 0) << tally.first_failure;
    EXPECT_GE(tally.proved, least(beside.proved));
    EXPECT_GE(tally.capped, least(beside.capped));
    EXPECT_LE(tally.closest, 1.0);
}

}  // namespace

TEST_P(FrictionBeside, CertificatesHold) { expect_certificates_to_hold(GetParam(), GetParam().capped > 0 ? 2 : 4); }
TEST_P(FrictionBeside, DISABLED_ManyCertificatesHold) { expect_certificates_to_hold(GetParam(), 1); }

INSTANTIATE_TEST_SUITE_P(Kinds, FrictionBeside,
                         testing::Values(Beside{"smooth_beside_smooth", Rubbing::none, Rubbing::none, 50, 30, 0},
                                         Beside{"slip_beside_smooth", Rubbing::none, Rubbing::slides, 60, 30, 0},
                                         Beside{"stick_beside_smooth", Rubbing::none, Rubbing::sticks, 60, 30, 0},
                                         Beside{"smooth_beside_slip", Rubbing::slides, Rubbing::none, 60, 30, 0},
                                         Beside{"slip_beside_slip", Rubbing::slides, Rubbing::slides, 60, 30, 0},
                                         Beside{"stick_beside_slip", Rubbing::slides, Rubbing::sticks, 60, 30, 0},
                                         Beside{"smooth_beside_stick", Rubbing::sticks, Rubbing::none, 80, 30, 0},
                                         Beside{"slip_beside_stick", Rubbing::sticks, Rubbing::slides, 120, 30, 0},
                                         Beside{"stick_beside_stick", Rubbing::sticks, Rubbing::sticks, 160, 25, 0},
                                         Beside{"capped_beside_smooth", Rubbing::none, Rubbing::sticks, 100, 10, 6},
                                         Beside{"capped_beside_stick", Rubbing::sticks, Rubbing::sticks, 100, 4, 3}),
                         [](const auto& beside) { return std::string(beside.param.name); });

}  // namespace achilles::test
