// Executions that must agree: two tolerances, two methods, two reinitializations, two identical runs.
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

// Every contact has the same events at the same times with both methods. Until the end the errors grow with the motion;
// the largest measured difference is 1e-9 (ball_in_gusts).
TEST_P(Agreement, TwoMethodsTellTheSame) {
    if (GetParam().method != Method::taylor) return;  // one test for the pair of methods
    auto run = run_of(GetParam());
    run.options.tolerance = 1e-12;
    const Trajectory one = simulated(GetParam(), run);
    run.options.method = Method::dopri5;
    const Trajectory other = simulated(GetParam(), run);
    const Distance apart = between(outline_of(one), outline_of(other));
    EXPECT_LE(apart.size, 5e-9) << apart.where;
}

// The difference of the two restarts is of the order of the impact speed at the cut, which eps bounds. It grows with
// the motion; the largest measured value is 28 eps (triple_pendulum).
TEST_P(Agreement, KineticAndEuclideanAgreeAsEpsFalls) {
    if (model_of(GetParam().system)->has_friction()) return;  // Euclidean is refused
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

INSTANTIATE_TEST_SUITE_P(ExecutionAutomaton, Agreement, testing::ValuesIn(all_cases()), name_of);

}  // namespace
}  // namespace achilles::test
