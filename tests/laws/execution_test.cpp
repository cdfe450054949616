// The laws of one execution, on the run that each file asks for.
#include "laws/laws.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {
namespace {

std::string listed(const Violations& violations) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(violations.size(), 10); ++i) text += violations[i] + "\n";
    return text;
}

// Every law is asked of the file's run, of the other conditions and of the other re-initialisation.
template <class F>
void on_every_run(const Case& one, F law) {
    for (const Conditions conditions : {Conditions::sharp, Conditions::paper}) {
        for (const Reinitialization kind : {Reinitialization::kinetic, Reinitialization::euclidean}) {
            SCOPED_TRACE(std::string(to_text(conditions)) + ", " + std::string(to_text(kind)));
            auto run = run_of(one);
            run.options.truncation.conditions = conditions;
            run.options.truncation.reinitialization = kind;
            const Trajectory trajectory = simulate(model_of(one.system), run);
            ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
            const Violations violations = law(trajectory);
            EXPECT_TRUE(violations.empty()) << listed(violations);
        }
    }
}

TEST_P(Law, EnergyIsConstantInPhasesAndNeverRisesAtImpacts) { on_every_run(GetParam(), energy); }
TEST_P(Law, TheGapIsNeverNegative) { on_every_run(GetParam(), gap); }
TEST_P(Law, PhasesAbutAndAlternate) { on_every_run(GetParam(), phases); }
TEST_P(Law, TheContactForcePressesUntilTheRelease) { on_every_run(GetParam(), contact_force); }

INSTANTIATE_TEST_SUITE_P(Execution, Law, testing::ValuesIn(all_cases()), name_of);

}  // namespace
}  // namespace achilles::test
