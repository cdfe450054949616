// Who is held and who leaves, proved over intervals.
#include "contacts/accelerations.hpp"

#include <gtest/gtest.h>

#include "contacts/complementarity.hpp"
#include "core/contacts/some_contacts.hpp"

namespace achilles {
namespace {

using Matrix = ContactMatrix<double>;
using Vector = ContactVector<double>;
using Eigen::Index;

ContactMatrix<Interval> about(const Matrix& W, double radius) {
    return enclosure(W, Matrix::Constant(W.rows(), W.cols(), radius));
}
ContactVector<Interval> about(const Vector& x, double radius) {
    ContactVector<Interval> result(x.size());
    for (Index j = 0; j < x.size(); ++j) result[j] = Interval(x[j]) + Interval(-radius, radius);
    return result;
}

TEST(Accelerations, AreProvedWhereTheyAreClear) {
    const Matrix W = pair_with(-0.8);
    const Vector hddot = numbers({-1.0, 0.5});
    const auto signs = classify(about(W, 1e-10), about(hddot, 1e-10), contacts({0, 1}));
    ASSERT_TRUE(signs);
    EXPECT_EQ(signs->held, contacts({0, 1}));
    EXPECT_TRUE(signs->lambda[0].contains(0.6 / 0.36));
    EXPECT_LT(width(signs->lambda[0]), 1e-8);

    const auto apart = classify(about(pair_with(0.5), 1e-10), about(hddot, 1e-10), contacts({0}));
    EXPECT_EQ(apart->held, contacts({0}));
    EXPECT_EQ(apart->leaves, contacts({1}));
    EXPECT_TRUE(apart->acceleration[1].contains(1.0));
    EXPECT_TRUE(apart->undecided.empty());
}

// The second has no acceleration, or no force: which set holds is open, but the first is held in either.
TEST(Accelerations, InDoubtLeaveWhatIsProvedBothWays) {
    const auto signs = classify(about(pair_with(-0.5), 1e-12), about(numbers({-1.0, 0.5}), 1e-12), contacts({0}));
    ASSERT_TRUE(signs);
    EXPECT_EQ(signs->held, contacts({0}));
    EXPECT_EQ(signs->undecided, contacts({1}));
    EXPECT_TRUE(signs->leaves.empty());
}

// That the second may be held takes away the proof for the first: lambda_1 is 1 while the second is free, and
// (1 - 0.9 * 1.2)/0.19 < 0 is possible while both are held.
TEST(Accelerations, DoubtSpreads) {
    ContactVector<Interval> hddot(2);
    hddot[0] = -1.0;
    hddot[1] = Interval(-1.2, -0.85);
    const auto signs = classify(about(pair_with(0.9), 0.0), hddot, contacts({0}));
    ASSERT_TRUE(signs);
    EXPECT_EQ(signs->undecided, contacts({0, 1}));
}

TEST(Accelerations, AskForAPositiveDefiniteBlock) {
    const Vector pressed = numbers({-1.0, -1.0});
    EXPECT_FALSE(classify(about(pair_with(1.0), 0.0), about(pressed, 0.0), contacts({0, 1})));
    EXPECT_FALSE(classify(about(pair_with(0.9), 0.2), about(pressed, 0.0), contacts({0, 1})));
    EXPECT_TRUE(classify(about(pair_with(0.9), 0.01), about(pressed, 0.0), contacts({0, 1})));
    ContactMatrix<Interval> undefined = about(pair_with(0.0), 0.0);
    undefined(0, 0) = Interval::undefined();
    EXPECT_FALSE(classify(undefined, about(pressed, 0.0), contacts({0, 1})));
}

// What is proved is true of every problem inside the enclosures, by the solver.
TEST(Accelerations, AreTrueAtRandom) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    int decided = 0, doubtful = 0;
    for (int run = 0; run < 1'000; ++run) {
        const Index m = 1 + static_cast<Index>(random() % 6);
        const Matrix G = random_matrix(m, 8, random), W = G * G.transpose();
        const Vector hddot = random_matrix(m, 1, random);
        const double radius = run % 2 == 0 ? 1e-9 : 0.1;
        const auto answer = solve_complementarity(W, hddot);
        const auto signs = classify(about(W, radius), about(hddot, radius), answer->active);
        if (!signs) continue;
        ASSERT_EQ(signs->held.count() + signs->leaves.count() + signs->undecided.count(), m);
        decided += signs->undecided.empty();
        doubtful += !signs->undecided.empty() && !(signs->held.empty() && signs->leaves.empty());
        for (int sample = 0; sample < 10; ++sample) {
            Matrix other = W;
            Vector start = hddot;
            for (Index i = 0; i < m; ++i) {
                start[i] += radius * part(random);
                for (Index k = 0; k <= i; ++k) other(i, k) = other(k, i) = W(i, k) + radius * part(random);
            }
            const auto truth = solve_complementarity(other, start);
            ASSERT_TRUE(truth) << run;
            for (Index j = 0; j < m; ++j) {
                if (contains(signs->held, j)) {
                    ASSERT_GT(truth->p[j], 0.0) << run;
                    ASSERT_TRUE(signs->lambda[j].lo() <= truth->p[j] + 1e-12 &&
                                truth->p[j] <= signs->lambda[j].hi() + 1e-12)
                        << run;
                }
                if (contains(signs->leaves, j)) {
                    ASSERT_GT(truth->y[j], 0.0) << run;
                    ASSERT_TRUE(signs->acceleration[j].lo() <= truth->y[j] + 1e-12 &&
                                truth->y[j] <= signs->acceleration[j].hi() + 1e-12)
                        << run;
                }
            }
        }
    }
    EXPECT_GT(decided, 500);
    EXPECT_GT(doubtful, 30);
}

}  // namespace
}  // namespace achilles
