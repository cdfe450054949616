// Executions that must agree: two tolerances, two methods, two reinitializations, two runs of the same.
#include "floor/agreement.hpp"
#include "laws/laws.hpp"
#include "output/output.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {
namespace {

class Agreement : public Law {};

TEST_P(Agreement, TwoTolerancesAgree) {
    auto run = run_of(GetParam());
    run.options.tolerance = 1e-8;
    const Trajectory loose = simulated(GetParam(), run);
    run.options.tolerance = 1e-11;
    const Trajectory tight = simulated(GetParam(), run);
    EXPECT_LE(distance(loose.end, tight.end), 1e-5)
        << "a motion that cannot be predicted so far makes a poor example: end it sooner";
    EXPECT_EQ(loose.phases.size(), tight.phases.size());
}

// The same happens to every contact, at the same times, however steps are made. Until the end errors grow as the motion makes
// them: 1e-9 (ball_in_gusts) was measured.
TEST_P(Agreement, TwoMethodsTellTheSame) {
    if (GetParam().method != Method::taylor) return;  // asked once of the two
    auto run = run_of(GetParam());
    run.options.tolerance = 1e-12;
    const Trajectory one = simulated(GetParam(), run);
    run.options.method = Method::dopri5;
    const Trajectory other = simulated(GetParam(), run);
    const Distance apart = between(outline_of(one), outline_of(other));
    EXPECT_LE(apart.size, 5e-9) << apart.where;
}

// What the euclidean restart adds is of the order of the impact speed at the cut, which eps bounds, and
// grows with the motion: up to 28 eps (triple_pendulum) was measured.
TEST_P(Agreement, KineticAndEuclideanAgreeAsEpsFalls) {
    auto run = run_of(GetParam());
    run.options.tolerance = 1e-12;
    for (const double eps : {1e-3, 1e-5, 1e-7}) {
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = eps;
        run.options.truncation.reinitialization = Reinitialization::kinetic;
        const Trajectory kinetic = simulated(GetParam(), run);
        run.options.truncation.reinitialization = Reinitialization::euclidean;
        const Trajectory euclidean = simulated(GetParam(), run);
        EXPECT_LE(distance(kinetic.end, euclidean.end), 100.0 * eps) << "eps " << eps;
    }
}

TEST_P(Agreement, TwoRunsAreTheSameBytes) {
    Trajectory a = simulated(GetParam(), run_of(GetParam())), b = simulated(GetParam(), run_of(GetParam()));
    a.statistics.seconds = b.statistics.seconds = 0.0;
    EXPECT_EQ(to_json(a), to_json(b));
    EXPECT_EQ(to_csv(a), to_csv(b));
}

INSTANTIATE_TEST_SUITE_P(Execution, Agreement, testing::ValuesIn(all_cases()), name_of);

}  // namespace
}  // namespace achilles::test
