// The execution automaton alone: its step requests, and its response to given step results.
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "output/output.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/execution.hpp"

namespace achilles {
namespace {

using StepOutcome = StepResult::StepOutcome;
using AmbiguityPolicy = ExecutionAutomaton::AmbiguityPolicy;

// A ball thrown upwards from x = 0 at speed 1 lands at t = 2 with rate -1. Step results are supplied by the tests.
class Automaton : public testing::Test {
 protected:
    Automaton() {
        run_.v << 1.0;
        run_.options.end_time = 10.0;
    }
    ExecutionAutomaton execution(AmbiguityPolicy ambiguity_policy = AmbiguityPolicy::retry_tight) {
        return ExecutionAutomaton(model_, run_, surfaces_, nullptr, Recording::final_state, ambiguity_policy);
    }
    // Result of a step to t without an event, on the exact motion. `end` and its data may be changed.
    StepResult at(double t, StepOutcome end = StepOutcome::no_event) {
        state_.q.resize(1);
        state_.v.resize(1);
        state_.q << t - 0.5 * t * t;
        state_.v << 1.0 - t;
        StepResult result;
        result.end = end;
        result.steps = result.evaluations = 1;
        state_.t = t;
        result.duration = t;
        result.state = &state_;
        result.gap = state_.q[0];
        result.starts = {{{state_.q[0], state_.v[0]}, 0, false}};
        result.contact = surfaces_.of(0).at(state_);
        return result;
    }

    std::shared_ptr<const Model> model_ = test::drop();
    achilles::Run run_ = model_->default_run();
    ContactCache surfaces_{*model_, run_};
    State state_;
};

TEST_F(Automaton, RequestsFlightStepsUntilTheEndTime) {
    auto execution = this->execution();
    const StepRequest* request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_TRUE(request->mode.held().empty());
    EXPECT_EQ(request->state.t, 0.0);
    EXPECT_EQ(request->until, 10.0);
    EXPECT_EQ(request->starts[0].multiplicity, 1);
    EXPECT_EQ(request->starts[0].gap.hdot, 1.0);
    EXPECT_TRUE(request->begins && request->plain && !request->exactly);
    EXPECT_EQ(request->most, run_.options.max_steps);
    EXPECT_EQ(execution.next(), request);  // a request stays until its result comes
    EXPECT_TRUE(request->begins);
    execution.accept(at(0.5));
    request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_EQ(request->state.t, 0.5);
    EXPECT_EQ(request->state.q[0], 0.375);
    EXPECT_EQ(request->starts[0].gap.h, 0.375);
    EXPECT_EQ(request->starts[0].multiplicity, 0);
    EXPECT_FALSE(request->begins);
    EXPECT_EQ(request->most, run_.options.max_steps - 1);
}

// Newton's law; then contact, if the truncation at the next impact is certified.
TEST_F(Automaton, BouncesOrCompletes) {
    auto bouncing = execution();
    ASSERT_NE(bouncing.next(), nullptr);
    bouncing.accept(at(2.0, StepOutcome::impact));
    const StepRequest* request = bouncing.next();
    ASSERT_NE(request, nullptr);
    EXPECT_TRUE(request->mode.held().empty());
    EXPECT_TRUE(request->begins);
    EXPECT_EQ(request->state.t, 2.0);
    EXPECT_EQ(request->state.v[0], 0.5);
    EXPECT_EQ(request->starts[0].gap.hdot, 0.5);
    EXPECT_EQ(request->starts[0].multiplicity, 1);

    run_.options.truncation.eps_q = run_.options.truncation.eps_v = run_.options.truncation.eps_t = 10.0;
    auto completing = execution();
    ASSERT_NE(completing.next(), nullptr);
    completing.accept(at(2.0, StepOutcome::impact));
    request = completing.next();
    ASSERT_NE(request, nullptr);
    EXPECT_TRUE(completing.completing());
    EXPECT_EQ(request->mode.held(), ContactSet::of(0));
    EXPECT_TRUE(request->begins);
    EXPECT_EQ(request->state.v[0], 0.0);
    EXPECT_NEAR(request->until, 4.0, 1e-9);  // 2 + 2 e/(1 - e)
    StepResult result = at(request->until);
    state_.q << 0.0;
    state_.v << 0.0;
    completing.accept(result);
    request = completing.next();
    ASSERT_NE(request, nullptr);
    EXPECT_FALSE(completing.completing());
    EXPECT_EQ(request->mode.held(), ContactSet::of(0));
    EXPECT_TRUE(request->begins);
    EXPECT_EQ(request->until, 10.0);
    state_.t = 10.0;
    completing.accept(result);
    EXPECT_EQ(completing.next(), nullptr);
    EXPECT_EQ(completing.next(), nullptr);
    const Trajectory trajectory = completing.finish();
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time);
    ASSERT_EQ(trajectory.phases.size(), 2u);
    EXPECT_EQ(trajectory.phases[1].kind, Phase::Kind::constrained);
    EXPECT_EQ(trajectory.statistics.impacts, 1);
    EXPECT_EQ(trajectory.statistics.evaluations, 3);
}

// On the floor, without a release: g = 1.
TEST_F(Automaton, ReleasesOnlyWhereTheForceIsProvedToFall) {
    run_.v << 0.0;
    auto execution = this->execution();
    const StepRequest* request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_EQ(request->mode.held(), ContactSet::of(0));
    StepResult result = at(0.5, StepOutcome::force_vanishes);
    state_.q << 0.0;
    state_.v << 0.0;
    execution.accept(result);
    EXPECT_EQ(execution.next(), nullptr);
    EXPECT_EQ(execution.finish().outcome.kind, Outcome::Kind::undecided);
}

// Repeats the whole segment from its start, once.
TEST_F(Automaton, RetriesTheSegmentIfAStepIsAmbiguous) {
    auto execution = this->execution();
    for (const double t : {0.5, 1.0}) {
        ASSERT_NE(execution.next(), nullptr);
        execution.accept(at(t));
    }
    ASSERT_NE(execution.next(), nullptr);
    execution.accept(at(1.5, StepOutcome::ambiguous));
    const StepRequest* request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_TRUE(request->exactly && request->begins);
    EXPECT_EQ(request->state.t, 0.0);
    EXPECT_EQ(request->state.q[0], 0.0);
    EXPECT_EQ(request->starts[0].multiplicity, 1);
    EXPECT_EQ(request->most, run_.options.max_steps);
    execution.accept(at(0.5));
    request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_TRUE(request->exactly && !request->begins);
    execution.accept(at(1.5, StepOutcome::ambiguous));
    EXPECT_EQ(execution.next(), nullptr);
    const Trajectory trajectory = execution.finish();
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::undecided);
    EXPECT_EQ(trajectory.end_time, 1.5);
    EXPECT_EQ(trajectory.statistics.steps, 2);
    EXPECT_EQ(trajectory.statistics.evaluations, 5);
}

TEST_F(Automaton, RetriesASegmentOnce) {
    auto execution = this->execution();
    ASSERT_NE(execution.next(), nullptr);
    execution.accept(at(1.5, StepOutcome::ambiguous));
    ASSERT_TRUE(execution.next()->exactly);
    execution.accept(at(2.0, StepOutcome::impact));
    const StepRequest* request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_TRUE(!request->exactly && request->begins);
    StepResult result = at(2.1, StepOutcome::ambiguous);  // of another flight
    execution.accept(result);
    request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_TRUE(request->exactly);
    EXPECT_EQ(request->state.t, 2.0);
}

TEST_F(Automaton, EndsUndecidedByPolicyOrAtTheTightestTolerance) {
    for (const bool exact : {false, true}) {
        if (exact) run_.options.tolerance = exact_tolerance;
        auto execution = this->execution(exact ? AmbiguityPolicy::retry_tight : AmbiguityPolicy::stop);
        ASSERT_NE(execution.next(), nullptr);
        execution.accept(at(1.5, StepOutcome::ambiguous));
        EXPECT_EQ(execution.next(), nullptr);
        EXPECT_EQ(execution.finish().outcome.kind, Outcome::Kind::undecided);
    }
}

// An event at the end of the previous step: no step is counted, time does not advance, and the state is moved onto the
// surface.
TEST_F(Automaton, LandsWithoutAStep) {
    auto execution = this->execution();
    ASSERT_NE(execution.next(), nullptr);
    execution.accept(at(1.999999));
    ASSERT_NE(execution.next(), nullptr);
    StepResult result = at(2.0, StepOutcome::impact);
    state_.t = 1.999999;
    result.steps = 0;
    execution.accept(result);
    const StepRequest* request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_EQ(request->state.t, 1.999999);
    EXPECT_EQ(request->state.q[0], 0.0);
    EXPECT_EQ(request->state.v[0], 0.5);
    EXPECT_EQ(request->most, run_.options.max_steps - 1);
}

TEST_F(Automaton, EndsWhereNoStepFollowsOrTheSurfaceIsNotReached) {
    for (const auto& [end, kind] : {std::pair(StepOutcome::step_failed, Outcome::Kind::not_a_number),
                                    std::pair(StepOutcome::off_surface, Outcome::Kind::undecided)}) {
        auto execution = this->execution();
        ASSERT_NE(execution.next(), nullptr);
        StepResult result = at(0.5, end);
        result.failure = StepFailure::not_a_number;
        execution.accept(result);
        EXPECT_EQ(execution.next(), nullptr);
        EXPECT_EQ(execution.finish().outcome.kind, kind);
    }
}

TEST_F(Automaton, CountsStepsAgainstTheirBoundAndEndsAtTheEndTime) {
    run_.options.max_steps = 3;
    auto execution = this->execution();
    ASSERT_NE(execution.next(), nullptr);
    StepResult result = at(0.5);
    result.steps = 2;
    execution.accept(result);
    const StepRequest* request = execution.next();
    ASSERT_NE(request, nullptr);
    EXPECT_EQ(request->most, 1);
    execution.accept(at(1.0));
    EXPECT_EQ(execution.next(), nullptr);
    EXPECT_EQ(execution.finish().outcome.kind, Outcome::Kind::too_many_steps);

    run_.options.end_time = 1.0;
    ASSERT_TRUE(execution.restart(run_));
    ASSERT_NE(execution.next(), nullptr);
    execution.accept(at(1.0));
    EXPECT_EQ(execution.next(), nullptr);
    EXPECT_EQ(execution.finish().outcome.kind, Outcome::Kind::end_time);
}

// Steps at the resolution of time are refused for lanes, and end the run after a bounded number.
TEST_F(Automaton, GivesUpWhereTimeStandsStill) {
    auto execution = this->execution();
    ASSERT_NE(execution.next(), nullptr);
    execution.accept(at(1.0));
    ASSERT_TRUE(execution.next()->plain);
    int steps = 0;
    for (; execution.next() != nullptr && steps < 1000; ++steps) {
        EXPECT_EQ(execution.next()->plain, steps == 0);
        execution.accept(at(1.0));
    }
    EXPECT_EQ(steps, 101);
    EXPECT_EQ(execution.finish().outcome.kind, Outcome::Kind::step_too_small);
}

TEST_F(Automaton, StartsAgainOnlyForARunOfItsKind) {
    auto execution = this->execution();
    const auto refuses = [&](const auto& change) {
        auto other = run_;
        change(other);
        return !execution.restart(other);
    };
    // Whether the motion stays the same is the caller's responsibility: it owns the surfaces and the stepper.
    EXPECT_FALSE(refuses([](achilles::Run& run) { run.parameters[0] = 2.0; }));
    EXPECT_TRUE(refuses([](achilles::Run& run) { run.options.tolerance *= 0.1; }));
    EXPECT_TRUE(refuses([](achilles::Run& run) { run.options.method = Method::dopri5; }));
    EXPECT_TRUE(refuses([](achilles::Run& run) { run.options.truncation.eps_q *= 0.1; }));
    EXPECT_FALSE(refuses([](achilles::Run& run) { run.q[0] = 1.0; }));
    EXPECT_EQ(execution.next()->state.q[0], 1.0);
}

// ---- with its stepper ----

// Definition 5: flights and impacts, then contact, until the next flight. A segment begins at every event and only
// there.
TEST(AutomatonAndStepper, TakeTurnsAsDefinition5Says) {
    const auto model = test::load("ball_on_sine");
    const auto run = model->default_run();
    ContactCache surfaces(*model, run);
    ExecutionAutomaton execution(model, run, surfaces, nullptr, Recording::full, AmbiguityPolicy::retry_tight);
    EventStepper stepper(*model, run, surfaces);
    long stretches = 0;
    bool event = true, released = false;
    while (const StepRequest* request = execution.next()) {
        stretches += request->begins ? 1 : 0;
        const bool zeno = request->begins && !event;  // the motion in contact continues past the Zeno point
        if (zeno) {
            EXPECT_EQ(request->mode.held(), ContactSet::of(0));
        } else {
            EXPECT_EQ(request->begins, event);
        }
        if (released) {
            EXPECT_TRUE(request->mode.held().empty());
        }
        const double t = request->state.t, until = request->until;
        const ContactSet held = request->mode.held();
        const StepResult& result = stepper.step(*request);
        EXPECT_GT(result.state->t, t);
        EXPECT_LE(result.state->t, until);
        event = result.end != StepOutcome::no_event;
        released = result.end == StepOutcome::force_vanishes;
        EXPECT_TRUE(!event || result.end == (held.empty() ? StepOutcome::impact : StepOutcome::force_vanishes));
        execution.accept(result);
    }
    const Trajectory trajectory = execution.finish(), alone = simulate(model, run);
    EXPECT_EQ(stretches, 1 + static_cast<long>(trajectory.events.size()));
    EXPECT_EQ(trajectory.outcome.message, alone.outcome.message);
    EXPECT_EQ(to_text(trajectory), to_text(alone));
}

}  // namespace
}  // namespace achilles
