// Complementarity problem 0 <= p perpendicular b + W p >= 0: problems with known answers, and random ones.
#include "contacts/complementarity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/contacts/some_contacts.hpp"

namespace achilles {
namespace {

using Matrix = ContactMatrix<double>;
using Forces = ContactVector<double>;
using Eigen::Index;

// Largest violation of complementarity and of the signs, relative to the summands of each row.
double fault(const Matrix& W, const Forces& b, const Complementarity& answer) {
    double worst = 0.0;
    for (Index j = 0; j < b.size(); ++j) {
        const double y = b[j] + W.row(j).dot(answer.p);
        const double size = std::abs(b[j]) + W.row(j).cwiseAbs().dot(answer.p) + 1e-300;
        worst = std::max({worst, -y / size, std::abs(y - answer.y[j]) / size});
        if (!(answer.p[j] >= 0.0) || !(answer.y[j] >= 0.0) || answer.p[j] * answer.y[j] != 0.0) return HUGE_VAL;
        if (contains(answer.active, j) != (answer.p[j] > 0.0)) return HUGE_VAL;
    }
    return worst;
}

TEST(Complementarity, OfOneContact) {
    const Matrix W = Matrix::Constant(1, 1, 3.0);
    const auto pressed = solve_complementarity(W, numbers({-1.0}));
    EXPECT_EQ(pressed->p[0], 1.0 / 3.0);
    EXPECT_EQ(pressed->y[0], 0.0);
    EXPECT_EQ(pressed->active, contacts({0}));
    const auto leaving = solve_complementarity(W, numbers({1.0}));
    EXPECT_EQ(leaving->p[0], 0.0);
    EXPECT_EQ(leaving->y[0], 1.0);
    EXPECT_TRUE(leaving->active.empty());
    EXPECT_TRUE(solve_complementarity(Matrix(0, 0), Forces(0)));
}

// Taken alone, the second contact would open (theory-gaps.md 8). The first contact, which is held, keeps it closed.
TEST(Complementarity, JudgesNoContactAlone) {
    const auto answer = solve_complementarity(pair_with(-0.8), numbers({-1.0, 0.5}));
    EXPECT_EQ(answer->active, contacts({0, 1}));
    EXPECT_NEAR(answer->p[0], 0.6 / 0.36, 1e-14);
    EXPECT_NEAR(answer->p[1], 0.3 / 0.36, 1e-14);
}

TEST(Complementarity, HasNoAnswerInASlotWithoutPlay) {
    EXPECT_FALSE(solve_complementarity(pair_with(-1.0), numbers({-1.0, -1.0})));
    EXPECT_FALSE(solve_complementarity(pair_with(-1.0), numbers({-1.0, 0.5})));
    EXPECT_FALSE(solve_complementarity(pair_with(0.0), numbers({-1.0, std::nan("")})));
    EXPECT_FALSE(solve_complementarity(Matrix::Zero(1, 1), numbers({-1.0})));
    const auto squeezed = solve_complementarity(pair_with(-1.0), numbers({-1.0, 1.0}));  // p = (1 + t, t)
    EXPECT_FALSE(squeezed->unique);
    EXPECT_EQ(squeezed->p, numbers({1.0, 0.0}));
}

// Height, pitch and roll of a table of unit inertia. The weight acts at (x, y); the legs stand at (+-1, +-1).
TEST(Complementarity, OfATableOnFourLegs) {
    Matrix G(4, 3);
    G << 1, 1, 1, 1, -1, 1, 1, -1, -1, 1, 1, -1;
    const Matrix W = G * G.transpose();
    const auto table = [&](double x, double y) {
        return *solve_complementarity(W, -G * Eigen::Vector3d(8.0, 8.0 * x, 8.0 * y));
    };
    const Complementarity middle = table(0.0, 0.0);
    EXPECT_FALSE(middle.unique);
    EXPECT_EQ(middle.active.count(), 4);
    for (Index j = 0; j < 4; ++j) {
        EXPECT_NEAR(middle.p[j], 2.0, 1e-14);
        EXPECT_EQ(middle.y[j], 0.0);
    }
    // Load near one leg: the least-norm solution without sign constraints would pull at the opposite leg.
    const Complementarity aside = table(0.75, 0.625);
    EXPECT_FALSE(aside.unique);
    EXPECT_NEAR(aside.p[0], 5.5, 1e-14);
    EXPECT_NEAR(aside.p[1], 1.0, 1e-14);
    EXPECT_EQ(aside.p[2], 0.0);
    EXPECT_NEAR(aside.p[3], 1.5, 1e-14);
    EXPECT_TRUE(aside.y.isZero(0.0));
}

TEST(Complementarity, SharesTheForceOfAGapThatIsGivenTwice) {
    const auto twice = solve_complementarity(pair_with(1.0), numbers({-1.0, -1.0}));
    EXPECT_FALSE(twice->unique);
    EXPECT_NEAR(twice->p[0], 0.5, 1e-15);
    EXPECT_NEAR(twice->p[1], 0.5, 1e-15);
    Matrix W(2, 2);  // gaps h and 3 h
    W << 1.0, 3.0, 3.0, 9.0;
    const auto tripled = solve_complementarity(W, numbers({-1.0, -3.0}));
    EXPECT_FALSE(tripled->unique);
    EXPECT_NEAR(tripled->p[0], 0.5, 1e-15);
    EXPECT_NEAR(3.0 * tripled->p[1], 0.5, 1e-15);
}

// Two contacts approach at 1e-14 times the speed of a third, uncoupled contact. Its rounding error must not decide
// them.
TEST(Complementarity, OfContactsFarApart) {
    Matrix W = Matrix::Identity(3, 3);
    W(0, 1) = W(1, 0) = -0.25;
    const auto alone = solve_complementarity(W.topLeftCorner(2, 2), numbers({-1e-14, 2e-15}));
    const auto beside = solve_complementarity(W, numbers({-1e-14, 2e-15, -1.0}));
    EXPECT_EQ(alone->active, contacts({0, 1}));
    EXPECT_EQ(alone->p, beside->p.head(2));
    EXPECT_EQ(alone->y, beside->y.head(2));
}

TEST(Complementarity, TakesAnEntryOfRoundingSizeForZero) {
    const auto answer = solve_complementarity(pair_with(1e-15), numbers({-1.0, 0.0}));
    EXPECT_EQ(answer->y, numbers({0.0, 0.0}));
    EXPECT_GT(solve_complementarity(pair_with(1e-13), numbers({-1.0, 0.0}))->y[1], 0.0);
}

// One to eight gaps in random units, with at least as many coordinates as gaps.
void regular_problems(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-3.0, 3.0);
    for (int run = 0; run < count; ++run) {
        const Index m = 1 + static_cast<Index>(random() % 8), n = m + static_cast<Index>(random()) % (9 - m);
        Matrix G = random_matrix(m, n, random);
        Forces b = random_matrix(m, 1, random);
        for (Index j = 0; j < m; ++j) {
            const double unit = std::pow(10.0, exponent(random));
            G.row(j) *= unit;
            b[j] *= random() % 4 == 0 ? 0.0 : unit;
        }
        const Matrix W = G * G.transpose();
        const auto answer = solve_complementarity(W, b);
        ASSERT_TRUE(answer) << run;
        ASSERT_LE(fault(W, b, *answer), 1e-12) << run;
        const Order order = random_order(m, random);
        const auto other = solve_complementarity(renumbered(W, order), renumbered(b, order));
        ASSERT_TRUE(other) << run;
        const Forces p = renumbered(answer->p, order), y = renumbered(answer->y, order);
        const Forces weight = renumbered(W, order).diagonal().cwiseSqrt();
        const double size = p.cwiseProduct(weight).maxCoeff() + 1e-300;
        // A condition number of 1e9 is accepted and costs nine digits of p. y still equals b + W p to rounding.
        ASSERT_LE((other->y - y).cwiseQuotient(weight).cwiseAbs().maxCoeff(), 1e-11 * (size + b.cwiseAbs().maxCoeff()));
        const double distance = (other->p - p).cwiseProduct(weight).cwiseAbs().maxCoeff();
        ASSERT_TRUE(!answer->unique || distance <= 1e-6 * size) << run;
    }
}

TEST(Complementarity, HoldsAtRandom) { regular_problems(10'000, 1); }
TEST(Complementarity, DISABLED_HoldsAtRandomAtLength) { regular_problems(1'000'000, 2); }

// More contacts than coordinates, and duplicated contacts: the answer is a solution, of least norm.
TEST(Complementarity, OfDependentGradientsAtRandom) {
    std::mt19937 random(3);
    int several = 0;
    for (int run = 0; run < 500; ++run) {
        const Index m = 2 + static_cast<Index>(random() % 7), n = 1 + static_cast<Index>(random() % 7);
        Matrix G = random_matrix(m, n, random);
        G.row(0) = (random() % 2 == 0 ? 1.0 : 2.5) * G.row(m - 1);
        const Matrix W = G * G.transpose();
        const Forces b = G * random_matrix(n, 1, random);
        const auto answer = solve_complementarity(W, b);
        ASSERT_TRUE(answer) << run;
        ASSERT_LE(fault(W, b, *answer), 1e-12) << run;
        if (answer->unique) continue;
        ++several;
        // Other solutions: give one contact a force beforehand and require y = 0 there all the same.
        const auto norm = [&](const Forces& p) { return W.diagonal().dot(p.cwiseAbs2()); };
        for (Index j = 0; j < m; ++j) {
            Forces given = Forces::Zero(m);
            given[j] = 0.5 * answer->p[j] + (random() % 2 == 0 ? 0.1 : 0.0);
            const auto rest = solve_complementarity(W, b + W * given);
            if (!rest) continue;
            const Complementarity other{rest->p + given, rest->y, {}, false};
            if ((other.y - answer->y).cwiseAbs().maxCoeff() > 1e-12 || other.y[j] > 0.0) continue;
            ASSERT_GE(norm(other.p), norm(answer->p) * (1.0 - 1e-9)) << run;
        }
        const Order order = random_order(m, random);
        const auto same = solve_complementarity(renumbered(W, order), renumbered(b, order));
        ASSERT_LE((same->p - renumbered(answer->p, order)).cwiseAbs().maxCoeff(), 1e-6 * (1.0 + answer->p.maxCoeff()))
            << run;
    }
    EXPECT_GT(several, 150);
}

}  // namespace
}  // namespace achilles
