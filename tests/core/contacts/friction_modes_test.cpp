// Modes and impacts with dry friction on small matrices (theory-friction.md 1 to 3, reference/friction.json).
#include "contacts/friction_modes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <utility>

namespace achilles {
namespace {

using Eigen::Matrix2d, Eigen::Vector2d, Eigen::VectorXd;
using enum ContactState;

Matrix2d matrix(double W_NN, double W_NT, double W_TT) { return (Matrix2d() << W_NN, W_NT, W_NT, W_TT).finished(); }

FrictionProblem one_contact(const Matrix2d& W, const Vector2d& accelerations, double mu, double mu_s,
                            std::vector<ContactState> states) {
    FrictionProblem problem{{{0, 0, 1, mu, mu_s, states.size() == 2, std::move(states)}}, W, accelerations};
    return problem;
}

FrictionImpactProblem one_impact(const Matrix2d& W, const Vector2d& before, double mu, double e) {
    FrictionImpactProblem problem;
    problem.elements = {{0, 0, 1, 0.0, 0.0, false, {open, held, slip_plus, slip_minus}}};
    problem.e = {e};
    problem.W = W;
    problem.before = before;
    problem.coefficient = [mu](std::size_t, double) { return mu; };
    return problem;
}

Matrix2d random_delassus(std::mt19937& generator) {
    std::uniform_real_distribution<double> any(-1.0, 1.0), positive(0.05, 1.0);
    const double N = positive(generator), T = positive(generator);
    return matrix(N, 0.99 * any(generator) * std::sqrt(N * T), T);
}

// W(phi) of a rod that slides with u < 0, mu = 5/3 (theory-friction.md 2).
TEST(FrictionModes, RodHasNoMotionOrTwo) {
    const double phi = std::acos(-1.0) / 3.0, mu = 5.0 / 3.0, c = std::cos(phi), s = std::sin(phi);
    const Matrix2d W = matrix(1.0 + 3.0 * c * c, 3.0 * c * s, 1.0 + 3.0 * s * s);
    EXPECT_NEAR(W(0, 0) - mu * W(0, 1), 1.0 + 3.0 * c * (c - mu * s), 1e-15);
    EXPECT_LT(W(0, 0) - mu * W(0, 1), 0.0);
    const auto kind = [&](double hddot, ContactState slides) {
        return choose_mode(one_contact(W, {hddot, 0.0}, mu, mu, {open, slides})).kind;
    };
    // The sign of the slip for which W is negative depends on the side to which the rod leans.
    EXPECT_EQ(kind(-1.0, slip_plus), FrictionChoice::Kind::none);
    EXPECT_EQ(kind(0.247, slip_plus), FrictionChoice::Kind::several);
    EXPECT_EQ(kind(-1.0, slip_minus), FrictionChoice::Kind::one);
    EXPECT_EQ(kind(0.247, slip_minus), FrictionChoice::Kind::one);
}

// Where mu |W_NT| < W_NN and mu_s = mu, exactly one of the four states obeys the laws.
TEST(FrictionModes, OneContactAtRestHasOneState) {
    std::mt19937 generator(42);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    int stuck = 0, slid = 0, left = 0;
    for (int i = 0; i < 20000; ++i) {
        const Matrix2d W = random_delassus(generator);
        const double mu = std::abs(any(generator)) * std::min(2.0, 0.999 * W(0, 0) / std::abs(W(0, 1)));
        const FrictionChoice choice =
            choose_mode(one_contact(W, {any(generator), any(generator)}, mu, mu, {open, held, slip_plus, slip_minus}));
        ASSERT_EQ(choice.kind, FrictionChoice::Kind::one) << i;
        ASSERT_EQ(choice.motions.size(), 1u) << i;
        const ContactState state = choice.motions[0].mode.state(0);
        ++(state == held ? stuck : state == open ? left : slid);
    }
    EXPECT_GT(stuck, 1000);
    EXPECT_GT(slid, 1000);
    EXPECT_GT(left, 1000);
}

// A static coefficient above the kinetic one: the contact sticks wherever the cone of rest contains the force.
TEST(FrictionModes, StickWinsInsideTheConeOfRest) {
    const FrictionChoice choice =
        choose_mode(one_contact(matrix(1.0, 0.0, 1.0), {-1.0, 0.4}, 0.3, 0.5, {open, held, slip_plus, slip_minus}));
    ASSERT_EQ(choice.kind, FrictionChoice::Kind::one);
    EXPECT_EQ(choice.motions.size(), 2u);  // sliding obeys the laws, too
    EXPECT_EQ(choice.motions[0].mode.state(0), held);
    EXPECT_EQ(choice.motions[1].mode.state(0), slip_plus);
}

// The force of a joint that slides is known: its level, against the slip.
TEST(FrictionModes, AJointPushesAgainstItsSlip) {
    const FrictionProblem problem{{{0, -1, 0, 0.3, 0.3, false, {held, slip_plus, slip_minus}}},
                                  Eigen::MatrixXd::Constant(1, 1, 2.0),
                                  VectorXd::Constant(1, 1.0)};
    for (const auto& [state, force] : {std::pair(slip_plus, -0.3), std::pair(slip_minus, 0.3)}) {
        const FrictionMotion motion = motion_in(problem, Mode().with(0, state));
        EXPECT_EQ(motion.forces[0], force);
        EXPECT_EQ(motion.accelerations[0], 1.0 + 2.0 * force);
    }
    const FrictionChoice choice = choose_mode(problem);
    ASSERT_EQ(choice.kind, FrictionChoice::Kind::one);
    EXPECT_EQ(choice.motions[0].mode.state(0), slip_plus);
}

// A coefficient that falls with the speed: whether an impact sticks is decided at the speed e |u-|/(1 + e), and how much
// it slows a slide at the speed at the end of the compression.
TEST(FrictionImpact, SticksByTheCoefficientOfItsSpeed) {
    FrictionImpactProblem problem = one_impact(matrix(1.0, 0.0, 1.0), {-1.0, 0.9}, 0.0, 0.5);
    problem.is_constant = false;
    problem.coefficient = [](std::size_t, double speed) { return 0.7 - 0.5 * speed; };
    const FrictionImpact impact = friction_impact(problem);
    ASSERT_EQ(impact.kind, FrictionChoice::Kind::one);
    EXPECT_EQ(impact.mode.state(0), slip_plus) << "0.9 > 1.5*mu(0.3), but not 1.5*mu(0)";
    EXPECT_NEAR(impact.after[1], 0.15, 1e-12) << "mu(0.4) = 0.5";
}

TEST(FrictionImpact, KanesParadoxIsCapped) {
    const FrictionImpact impact = friction_impact(one_impact(matrix(1.0, 0.6, 1.0), {-1.0, -0.6}, 1.0, 0.9));
    ASSERT_EQ(impact.kind, FrictionChoice::Kind::one);
    ASSERT_EQ(impact.caps.size(), 1u);
    EXPECT_NEAR(impact.caps[0].second * 0.9, 0.8, 1e-12);
    EXPECT_NEAR(impact.impulses[0], 2.25, 1e-12);
    EXPECT_NEAR(impact.impulses[1], -0.75, 1e-12);
    EXPECT_NEAR(impact.after[0], 0.8, 1e-12);
    EXPECT_EQ(impact.after[1], 0.0);
    EXPECT_LE(impact.energy_change, 0.0);
    EXPECT_NEAR(impact.energy_change, 0.0, 1e-12);
}

// The same without the cap: T rises from 0.5 to 0.6328125.
TEST(FrictionImpact, KanesParadoxGainsEnergy) {
    FrictionImpactProblem problem = one_impact(matrix(1.0, 0.6, 1.0), {-1.0, -0.6}, 1.0, 0.9);
    problem.may_gain_energy = true;
    const FrictionImpact impact = friction_impact(problem);
    ASSERT_EQ(impact.kind, FrictionChoice::Kind::one);
    EXPECT_NEAR(impact.impulses[0], 2.40625, 1e-12);
    EXPECT_NEAR(impact.impulses[1], -0.84375, 1e-12);
    EXPECT_NEAR(impact.after[0], 0.9, 1e-12);
    EXPECT_NEAR(impact.after[1], 0.0, 1e-12);
    EXPECT_NEAR(impact.energy_change, 0.1328125, 1e-12);
    EXPECT_TRUE(impact.gains_energy);
    EXPECT_TRUE(impact.caps.empty());
}

TEST(FrictionImpact, WithoutFrictionIsNewtons) {
    const FrictionImpact impact = friction_impact(one_impact(matrix(2.0, 0.6, 1.0), {-1.0, 0.7}, 0.0, 0.5));
    ASSERT_EQ(impact.kind, FrictionChoice::Kind::one);
    EXPECT_EQ(impact.impulses[0], 0.75);
    EXPECT_EQ(impact.after[0], 0.5);
}

// Constant mu: exactly one set of impulses, the law holds, and no impact gains energy.
TEST(FrictionImpact, RandomImpactsObeyTheLawAndGainNoEnergy) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0), part(0.0, 1.0);
    int capped = 0, stuck = 0;
    for (int i = 0; i < 100000; ++i) {
        const Matrix2d W = random_delassus(generator);
        const Vector2d before(-part(generator) - 1e-3, 2.0 * any(generator));
        const double mu = 2.0 * part(generator), e = part(generator);
        const FrictionImpact impact = friction_impact(one_impact(W, before, mu, e));
        ASSERT_EQ(impact.kind, FrictionChoice::Kind::one) << i;
        const double p = impact.impulses[0], p_T = impact.impulses[1], size = p * (1.0 + std::abs(before[1]));
        const double factor = impact.caps.empty() ? 1.0 : impact.caps[0].second;
        ASSERT_GT(p, 0.0);
        ASSERT_NEAR(impact.after[0], -factor * e * before[0], 1e-12);
        ASSERT_LE((before + W * impact.impulses - impact.after).norm(), 1e-10 * size);
        ASSERT_LE(std::abs(p_T), mu * p * (1.0 + 1e-9));
        if (impact.mode.state(0) == held) {
            ++stuck;
        } else {
            ASSERT_NEAR(p_T, (impact.after[1] > 0.0 ? -mu : mu) * p, 1e-9 * size);
        }
        ASSERT_LE(impact.energy_change, 1e-13 * size);
        // dT = -(1 - e) p w/2 + p_T (u- + u+)/2
        const double by_gap = 0.5 * (1.0 - factor * e) * p * before[0];
        ASSERT_NEAR(impact.energy_change, by_gap + 0.5 * p_T * (before[1] + impact.after[1]), 1e-12 * size);
        capped += impact.caps.empty() ? 0 : 1;
    }
    EXPECT_GT(capped, 300);
    EXPECT_GT(stuck, 10000);
}

// The same for two contacts of a plane body: no impact gains energy, and velocities obey W.
TEST(FrictionImpact, RandomImpactsOfTwoContactsGainNoEnergy) {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0), part(0.0, 1.0);
    int solved = 0, capped = 0;
    for (int i = 0; i < 5000; ++i) {
        Eigen::MatrixXd rows(4, 3);  // of gaps and slips, in units in which M = 1
        for (Eigen::Index k = 0; k < 2; ++k) {
            const double angle = 3.0 * any(generator);
            rows.row(2 * k) << std::cos(angle), std::sin(angle), any(generator);
            rows.row(2 * k + 1) << -std::sin(angle), std::cos(angle), any(generator);
        }
        FrictionImpactProblem problem;
        problem.elements = {{0, 0, 1, 0.0, 0.0, false, {open, held, slip_plus, slip_minus}},
                            {1, 2, 3, 0.0, 0.0, false, {open, held, slip_plus, slip_minus}}};
        problem.e = {part(generator), part(generator)};
        problem.W = rows * rows.transpose();
        problem.before = rows * Eigen::Vector3d(any(generator), any(generator), any(generator));
        if (problem.before[0] > 0.0 || problem.before[2] > 0.0) continue;
        const double mu[] = {part(generator), part(generator)};
        problem.coefficient = [&mu](std::size_t element, double) { return mu[element]; };
        const FrictionImpact impact = friction_impact(problem);
        if (impact.kind != FrictionChoice::Kind::one) continue;
        ++solved;
        capped += impact.caps.empty() ? 0 : 1;
        const double size = 1.0 + impact.impulses.norm();
        ASSERT_LE((problem.before + problem.W * impact.impulses - impact.after).norm(), 1e-9 * size) << i;
        ASSERT_LE(impact.energy_change, 1e-12 * size) << i;
        for (Eigen::Index k = 0; k < 2; ++k) {
            ASSERT_GE(impact.impulses[2 * k], -1e-12 * size) << i;
            ASSERT_LE(std::abs(impact.impulses[2 * k + 1]), mu[k] * impact.impulses[2 * k] + 1e-9 * size) << i;
        }
    }
    EXPECT_GT(solved, 1000);
    EXPECT_GT(capped, 10);
}

// A coefficient that depends on the speed belongs to the slip at the end of the compression.
TEST(FrictionImpact, CoefficientIsThatOfTheCompressedState) {
    FrictionImpactProblem problem = one_impact(matrix(1.0, 0.0, 1.0), {-1.0, 3.0}, 0.0, 0.5);
    const auto mu = [](double speed) { return 0.1 + 0.2 * std::exp(-speed); };
    problem.coefficient = [mu](std::size_t, double speed) { return mu(speed); };
    problem.is_constant = false;
    const FrictionImpact impact = friction_impact(problem);
    ASSERT_EQ(impact.kind, FrictionChoice::Kind::one);
    const double speed = (impact.after[1] + 0.5 * 3.0) / 1.5;
    EXPECT_NEAR(impact.impulses[1], -mu(speed) * impact.impulses[0], 1e-13);
    EXPECT_NE(impact.impulses[1], -mu(3.0) * impact.impulses[0]);
}

// Two contacts that nothing couples: a gain of one is not paid for by the other.
TEST(FrictionImpact, UncoupledContactsAreCappedApart) {
    FrictionImpactProblem problem;
    problem.elements = {{0, 0, 1, 0.0, 0.0, false, {open, held, slip_plus, slip_minus}},
                        {1, 2, 3, 0.0, 0.0, false, {open, held, slip_plus, slip_minus}}};
    problem.e = {0.9, 0.5};
    problem.W = Eigen::MatrixXd::Zero(4, 4);
    problem.W.topLeftCorner(2, 2) = matrix(1.0, 0.6, 1.0);
    problem.W.bottomRightCorner(2, 2) = matrix(1.0, 0.0, 1.0);
    problem.before = (VectorXd(4) << -1.0, -0.6, -10.0, 0.0).finished();
    problem.coefficient = [](std::size_t, double) { return 1.0; };
    const FrictionImpact impact = friction_impact(problem);
    ASSERT_EQ(impact.kind, FrictionChoice::Kind::one);
    ASSERT_EQ(impact.caps.size(), 1u);
    EXPECT_EQ(impact.caps[0].first, 0u);
    EXPECT_NEAR(impact.after[0], 0.8, 1e-12);
    EXPECT_EQ(impact.after[2], 5.0);
}

}  // namespace
}  // namespace achilles
