// Sets of states and their images, checked with members in 34 digits.
#include <Eigen/QR>
#include <array>
#include <random>

#include "core/enclose/truth.hpp"
#include "number/jet.hpp"

namespace achilles::test {

namespace {

// A nonlinear map, over any number type.
template <class Number>
std::array<Number, 3> bent(const std::array<Number, 3>& z, double turn) {
    using std::cos, std::sin;
    return {z[0] * Number(cos(turn)) - z[1] * Number(sin(turn)) + Number(0.125) * z[2] * z[2],
            z[0] * Number(sin(turn)) + z[1] * Number(cos(turn)), sin(z[0]) - Number(0.25) * z[1] * z[2]};
}

void apply_bent(Doubleton& set, double turn) {
    using Gradient = Jet<Interval, 3>;
    const Intervals hull = set.hull(), center = set.center();
    std::array<Gradient, 3> over;
    std::array<Interval, 3> at;
    for (std::size_t i = 0; i < 3; ++i) {
        over[i] = Gradient::variable(hull[i], i);
        at[i] = center[i];
    }
    over = bent(over, turn);
    const auto value = bent(at, turn);
    IntervalMatrix slope(3, 3);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) slope(i, j) = over[i].slope[j];
    set.map({value.begin(), value.end()}, slope);
}

}  // namespace

TEST(Doubleton, HoldsTheImagesOfItsMembersUnderMapsThatBend) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (const double half : {1e-2, 1e-5, 1e-9, 0.0}) {
        for (int trial = 0; trial < 10; ++trial) {
            Intervals box;
            for (int i = 0; i < 3; ++i) box.push_back(Interval(uniform(random)) + Interval(-half, half));
            Doubleton set(box);
            std::vector<std::array<Real, 3>> members(40);
            for (std::size_t m = 0; m < members.size(); ++m)
                for (std::size_t i = 0; i < 3; ++i) {
                    const double share = m < 8 ? (m >> i & 1u ? 1.0 : 0.0) : 0.5 + 0.5 * uniform(random);
                    members[m][i] = Real(box[i].lo()) + share * (Real(box[i].hi()) - Real(box[i].lo()));
                }
            for (int round = 0; round < 12; ++round) {
                const double turn = uniform(random);
                apply_bent(set, turn);
                for (auto& member : members) member = bent(member, turn);
                if (round == 5) {  // one coordinate becomes the same for all members
                    set.set(1, 0.5);
                    for (auto& member : members) member[1] = 0.5;
                }
                for (const auto& member : members)
                    for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(contains(set.hull(i), member[i])) << half;
                for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(set.hull(i).contains(set.center(i)));
            }
        }
    }
}

// A box would grow by a factor of 1.4 at each rotation by an eighth of a turn.
TEST(Doubleton, DoesNotGrowByTurning) {
    Doubleton set({Interval(-1e-3, 1e-3), Interval(1.0 - 1e-3, 1.0 + 1e-3)});
    const double c = std::sqrt(0.5);
    for (int round = 0; round < 80; ++round) {
        IntervalMatrix slope(2, 2);
        slope(0, 0) = slope(1, 1) = slope(1, 0) = Interval(c);
        slope(0, 1) = Interval(-c);
        Intervals at(2);
        for (std::size_t i = 0; i < 2; ++i)
            for (std::size_t j = 0; j < 2; ++j) at[i] += slope(i, j) * Interval(set.center(j));
        set.map(at, slope);
    }
    EXPECT_LT(rad(set.hull(0)), 1.001e-3);
    EXPECT_LT(rad(set.hull(1)), 1.001e-3);
}

TEST(Doubleton, RefusesWhatIsNotDefined) {
    Doubleton set({Interval(0.0), Interval(1.0, 2.0)});
    EXPECT_THROW(set.map({Interval::undefined(), Interval(0.0)}, IntervalMatrix::identity(2)), ProofStopped);
    IntervalMatrix endless = IntervalMatrix::identity(2);
    endless(0, 1) = Interval::everything();
    EXPECT_THROW(set.map({Interval(0.0), Interval(0.0)}, endless), ProofStopped);
}

// Orthogonal to rounding, and clearly less than that.
TEST(NearOrthogonalMatrix, EnclosesWhatItsInverseGives) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    constexpr int n = 4;
    for (const double off : {0.0, 1e-12, 1e-6, 1e-2})
        for (int trial = 0; trial < 50; ++trial) {
            Eigen::MatrixXd matrix(n, n);
            for (double& entry : matrix.reshaped()) entry = uniform(random);
            matrix = Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).householderQ() * Eigen::MatrixXd::Identity(n, n);
            for (double& entry : matrix.reshaped()) entry += off * uniform(random);
            std::array<Real, n> y;
            for (Real& entry : y) entry = uniform(random);
            Intervals x;
            for (int i = 0; i < n; ++i) {
                Real sum = 0;
                for (int k = 0; k < n; ++k) sum += Real(matrix(i, k)) * y[static_cast<std::size_t>(k)];
                const double near = static_cast<double>(sum);
                x.emplace_back(std::nextafter(near, -10.0), std::nextafter(near, 10.0));
            }
            const Intervals inverse = NearOrthogonalSolver(matrix).solve(x);
            for (std::size_t i = 0; i < n; ++i) ASSERT_TRUE(contains(inverse[i], y[i])) << off;
        }
    EXPECT_THROW(NearOrthogonalSolver(Eigen::MatrixXd::Zero(3, 3)), ProofStopped);
}

}  // namespace achilles::test
