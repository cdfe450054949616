// Runs eight at a time: the same bits with any vector width and any neighboring runs, and the same results as single
// runs.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/machine_code.hpp"
#include "core/systems.hpp"
#include "series/lane_stepper.hpp"
#include "simulate/batch.hpp"

namespace achilles {
namespace {

class Uniform {
 public:
    explicit Uniform(unsigned seed) : random_(seed) {}
    // Uniform in [-most, most).
    double operator()(double most) { return most * (2.0 * static_cast<double>(random_() >> 11) * 0x1p-53 - 1.0); }

 private:
    std::mt19937_64 random_;
};

void append(std::string& bytes, double x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof x); }

void append(std::string& bytes, const Double8& x) {
    for (const double lane : x.lane) append(bytes, lane);
}

// A system with every function that has no domain boundary, including those that no gallery system uses.
std::shared_ptr<const Model> many_functions() {
    return test::typed(R"toml(
title = "A test"
[[coordinate]]
name = "x"
start = 0.3
rate = 0.4
[[coordinate]]
name = "y"
start = 1.2
[[parameter]]
name = "a"
value = 0.2
[[parameter]]
name = "e"
value = 0.4
[lagrangian]
kinetic = "1/2*(1 + a*tanh(x)^2)*x'^2 + 1/2*y'^2 + a/10*x'*y'"
potential = "y + a*cosh(x/3) + exp(-x^2)/20 + atan(x)*a + x^4/50"
[[constraint]]
gap = "y - a*sin(x) - sinh(x/9) - tan(x/20)/(2 + x^2)^3 + 2^(-x)/30"
restitution = "e"
[run]
end_time = 12.0
)toml");
}

// The same, with time in every position where it may occur.
std::shared_ptr<const Model> many_functions_of_time() {
    SystemDescription system = many_functions()->description();
    system.coordinates[0].force.text = "cos(2*t)/5 - tanh(x')*exp(-t)/9 + sqrt(2 + sin(t))/9";
    system.potential.text += " + y*sin(3*t)/20";
    system.constraints[0].gap.text += " - log(2 + cos(t))/20 - t/50 - atan(t)/60";
    return std::make_shared<const Model>(std::move(system));
}

std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models() {
    std::vector<std::pair<std::string, std::shared_ptr<const Model>>> all;
    // Only runs with one contact, and without friction, are stepped in lanes.
    for (const std::string& name : test::systems_without_friction())
        if (const auto model = test::load(name); model->contacts() == 1) all.emplace_back(name, model);
    for (const std::string name : test::timed_systems) all.emplace_back(name, test::load(name));
    all.emplace_back("many functions", many_functions());
    all.emplace_back("many functions of time", many_functions_of_time());
    return all;
}

// ---- steps ----

TEST(SineAndCosineOfLanes, AreRightToAnUlpOfOne) {
    Uniform uniform(1);
    for (int i = 0; i < 20000; ++i) {
        Double8 angle, sine, cosine;
        for (double& x : angle.lane) x = uniform(std::pow(10.0, uniform(8.0)));
        sine_and_cosine_of_lanes(&angle, &sine, &cosine);
        for (std::size_t lane = 0; lane < Double8::count; ++lane) {
            EXPECT_NEAR(sine[lane], std::sin(angle[lane]), 0x1p-52) << angle[lane];
            EXPECT_NEAR(cosine[lane], std::cos(angle[lane]), 0x1p-52) << angle[lane];
        }
    }
}

TEST(SineAndCosineOfLanes, KnowWhatIsNoAngleAndDoNotDisturbTheOthers) {
    Double8 angle, sine, cosine;
    angle[0] = std::numeric_limits<double>::infinity();
    angle[1] = std::numeric_limits<double>::quiet_NaN();
    angle[2] = 1e300;
    angle[3] = -0.0;
    angle[4] = 0.5;
    angle[5] = 1e-300;
    sine_and_cosine_of_lanes(&angle, &sine, &cosine);
    EXPECT_TRUE(std::isnan(sine[0]) && std::isnan(cosine[0]) && std::isnan(sine[1]) && std::isnan(cosine[1]));
    EXPECT_EQ(sine[2], std::sin(1e300));
    EXPECT_EQ(cosine[2], std::cos(1e300));
    EXPECT_EQ(cosine[3], 1.0);
    EXPECT_NEAR(sine[4], std::sin(0.5), 0x1p-53);
    EXPECT_EQ(sine[5], 1e-300);
}

// A step from a random state, in flight or in contact.
LaneStep any_step(const Model& model, Uniform& uniform) {
    const Run run = model.default_run();
    LaneStep step(model.lane_programs().coordinates);
    const std::size_t n = step.impulse_direction.size();
    for (std::size_t lane = 0; lane < Double8::count; ++lane) {
        for (std::size_t i = 0; i < n; ++i) {
            step.q_and_v[i][lane] = run.q[static_cast<Eigen::Index>(i)] + uniform(0.3);
            step.q_and_v[n + i][lane] = run.v[static_cast<Eigen::Index>(i)] + uniform(0.5);
        }
        step.known[lane] = lane % 2 == 0 ? 1.0 : 0.0;
        step.h[lane] = lane % 2 == 0 ? 0.0 : std::abs(uniform(0.5));
        step.hdot[lane] = 0.6 + uniform(0.5);
        step.t[lane] = static_cast<double>(lane) / 3.0;  // explicit time; the motion takes 5 s from there
        step.until[lane] = 5.0 + step.t[lane];
    }
    return step;
}

std::vector<Double8> parameters_of(const Model& model) {
    std::vector<Double8> parameters;
    for (const double value : model.default_run().parameters) {
        Double8& eight = parameters.emplace_back();
        for (std::size_t lane = 0; lane < Double8::count; ++lane)
            eight[lane] = value * (1.0 + 0.01 * static_cast<double>(lane));
    }
    return parameters;
}

std::string bytes_of(const LaneStep& step) {
    std::string bytes;
    for (const Double8& x : step.q_and_v) append(bytes, x);
    for (const Double8& x : step.impulse_direction) append(bytes, x);
    for (const Double8& x : step.g) append(bytes, x);
    for (const Double8* x : {&step.t, &step.h, &step.hdot, &step.error, &step.rate_error, &step.duration, &step.brief,
                             &step.end_h, &step.end_hdot, &step.end_W, &step.end_gap_t, &step.rounding})
        append(bytes, *x);
    for (const LaneStep::LaneOutcome end : step.end) bytes.push_back(static_cast<char>(end));
    return bytes;
}

TEST(LaneSteps, AreTheSameToTheLastBitByAnyVectors) {
    for (const auto& [name, model] : models()) {
        for (const double tolerance : {1e-6, 1e-13}) {
            std::vector<std::string> flights, brief_flights, contacts;
            for (const Vectors vectors : possible_vectors()) {
                const auto stepper = make_lane_stepper(model->lane_programs(), tolerance, vectors);
                stepper->fix(parameters_of(*model));
                Uniform uniform(2);
                flights.emplace_back();
                brief_flights.emplace_back();
                contacts.emplace_back();
                for (int i = 0; i < 20; ++i) {
                    LaneStep flight = any_step(*model, uniform), brief_flight = flight, contact = flight;
                    stepper->fly(flight);
                    flights.back() += bytes_of(flight);
                    stepper->fly(brief_flight, true);
                    brief_flights.back() += bytes_of(brief_flight);
                    stepper->stay(contact, 3);
                    contacts.back() += bytes_of(contact);
                }
            }
            for (std::size_t i = 1; i < flights.size(); ++i) {
                EXPECT_TRUE(flights[i] == flights[0]) << name << " " << tolerance << ", vectors " << i;
                EXPECT_TRUE(brief_flights[i] == brief_flights[0]) << name << " " << tolerance << ", vectors " << i;
                EXPECT_TRUE(contacts[i] == contacts[0]) << name << " " << tolerance << ", vectors " << i;
            }
        }
    }
}

Double8 eight(double x) {
    Double8 result;
    for (double& lane : result.lane) lane = x;
    return result;
}

// A step claims nothing about a contact force below its remainder, a negative one, or a state that is not finite.
TEST(LaneSteps, KnowThatAForceStaysOnlyAboveItsRemainder) {
    const auto model = test::drop();
    for (const Vectors vectors : possible_vectors()) {
        const auto stepper = make_lane_stepper(model->lane_programs(), 1e-10, vectors);
        Double8 g = eight(1.0);
        g[1] = 1e-11;
        g[2] = -1.0;
        stepper->fix({g});
        LaneStep step(model->lane_programs().coordinates);
        step.until = eight(1.0);
        step.q_and_v[0][3] = std::numeric_limits<double>::quiet_NaN();
        step.q_and_v[1][4] = std::numeric_limits<double>::infinity();
        stepper->stay(step, 5);
        for (std::size_t lane = 0; lane < Double8::count; ++lane) {
            const bool plain = lane == 0 || lane > 4;
            EXPECT_EQ(step.end[lane] == LaneStep::LaneOutcome::no_event, plain) << lane;
            if (lane == 1 || lane == 2) {
                EXPECT_EQ(step.t[lane], 0.0);
            }
        }
    }
}

// The ball slides along the valley of the sine. A call ends with the first run that reaches its end time; the others
// can go on from there. A lane without a run ends no call.
TEST(LaneSteps, GoOnInContactUntilARunEnds) {
    const auto model = test::load("ball_on_sine");
    std::vector<Double8> parameters;
    for (const double value : model->default_run().parameters) parameters.push_back(eight(value));
    const auto slide = [&](Vectors vectors, bool has_idle_lane) {
        const auto stepper = make_lane_stepper(model->lane_programs(), 1e-10, vectors);
        stepper->fix(parameters);
        LaneStep step(model->lane_programs().coordinates);
        for (std::size_t lane = 0; lane < Double8::count; ++lane) {
            const double x = -1.5 - 0.05 * static_cast<double>(lane), speed = 0.3;
            step.q_and_v[0][lane] = x;
            step.q_and_v[1][lane] = std::sin(x);
            step.q_and_v[2][lane] = speed;
            step.q_and_v[3][lane] = speed * std::cos(x);
        }
        step.until = eight(10.0);
        step.until[0] = 0.01;
        step.until[1] = 2.0;
        step.idle[0] = has_idle_lane;
        step.least_gap = eight(1.0);
        step.error_per_step = 1e-11;
        stepper->stay(step, 1000);
        return step;
    };
    for (const Vectors vectors : possible_vectors()) {
        const LaneStep all = slide(vectors, false), seven = slide(vectors, true);
        EXPECT_EQ(all.steps, 1);
        EXPECT_FALSE(all.goes_on[0]);
        EXPECT_TRUE(all.goes_on[1]);
        EXPECT_EQ(all.t[0], 0.01);
        EXPECT_GT(seven.steps, 2);
        EXPECT_FALSE(seven.goes_on[1]);
        EXPECT_EQ(seven.t[1], 2.0);
        for (std::size_t lane = 2; lane < Double8::count; ++lane) {
            EXPECT_TRUE(seven.goes_on[lane]) << lane;
            EXPECT_EQ(static_cast<int>(seven.end[lane]), static_cast<int>(LaneStep::LaneOutcome::no_event)) << lane;
            EXPECT_GT(seven.t[lane], all.t[lane]) << lane;
            EXPECT_NEAR(seven.state_error[lane], 1e-11 * static_cast<double>(seven.steps), 1e-24) << lane;
            EXPECT_LT(std::abs(seven.least_gap[lane]), 1e-14) << lane;
        }
    }
}

// A ball thrown from or landing on a floor: h = 1e-3 + t - t^2/2 has its minimum at the end. If the gap is within the
// remainder, or within the error of earlier steps, the lane defers to the scalar stepper.
TEST(LaneSteps, TellAnImpactOnlyBeyondTheRemainder) {
    const auto model = test::drop();
    const auto stepper = make_lane_stepper(model->lane_programs(), 1e-10);
    stepper->fix({eight(1.0)});
    LaneStep step(model->lane_programs().coordinates);
    const double flight = 1.0 + std::sqrt(1.0 + 2.0e-3);  // until it lands
    for (std::size_t lane = 0; lane < Double8::count; ++lane) {
        step.q_and_v[0][lane] = step.h[lane] = 1e-3;
        step.q_and_v[1][lane] = step.hdot[lane] = 1.0;
    }
    const double ends[] = {2.5,           flight + 1e-6, flight + 1e-11, flight - 1e-11,
                           flight - 1e-6, 1.0,           flight - 1e-4,  flight - 1e-6};
    std::copy(std::begin(ends), std::end(ends), step.until.lane);
    step.error[6] = 2e-3;       // more than the height there
    step.rate_error[7] = 1e-6;  // moves the gap by as much as its height at the end
    stepper->fly(step);
    using LaneOutcome = LaneStep::LaneOutcome;
    const LaneOutcome expected[] = {
        LaneOutcome::impact,   LaneOutcome::impact,   LaneOutcome::needs_scalar_step, LaneOutcome::needs_scalar_step,
        LaneOutcome::no_event, LaneOutcome::no_event, LaneOutcome::needs_scalar_step, LaneOutcome::needs_scalar_step};
    for (std::size_t lane = 0; lane < Double8::count; ++lane)
        EXPECT_EQ(static_cast<int>(step.end[lane]), static_cast<int>(expected[lane])) << lane;
    EXPECT_NEAR(step.t[0], flight, 1e-13);
    EXPECT_GT(step.error[4], 0.0);  // the error that the next step must take into account
    EXPECT_LT(step.error[4], 1e-8);
}

// The remainder of a low flight is small relative to its height. At tolerance 1e-10, a gap of 1e-12 counts as open.
TEST(LaneSteps, KnowLowFlightsAgainstTheirHeight) {
    const auto model = test::drop();
    const auto stepper = make_lane_stepper(model->lane_programs(), 1e-10);
    stepper->fix({eight(1.0)});
    LaneStep step(model->lane_programs().coordinates);
    step.q_and_v[1] = step.hdot = eight(1e-3);
    step.known = eight(1.0);
    step.until = eight(2e-3 - 1e-9);
    stepper->fly(step);
    for (const LaneStep::LaneOutcome end : step.end)
        EXPECT_EQ(static_cast<int>(end), static_cast<int>(LaneStep::LaneOutcome::no_event));
}

// If a flight ends before the order of a brief step is used up, it is the same flight as with full steps. Otherwise the
// brief step is a part of it, as long as its series is accurate.
TEST(LaneSteps, OfBriefFlightsLandWhereOthersDo) {
    const auto model = test::load("ball_on_sine");
    const auto stepper = make_lane_stepper(model->lane_programs(), 1e-10);
    std::vector<Double8> parameters;
    for (const double value : model->default_run().parameters) parameters.push_back(eight(value));
    stepper->fix(parameters);
    const auto flight = [&](double speed, bool brief) {
        LaneStep step(model->lane_programs().coordinates);
        step.q_and_v[2] = eight(1.0);  // from x = y = 0, along the slope
        step.q_and_v[3] = eight(1.0 + speed);
        step.hdot = eight(speed);
        step.known = eight(1.0);
        step.until = eight(10.0);
        stepper->fly(step, brief);
        return step;
    };
    using LaneOutcome = LaneStep::LaneOutcome;
    const LaneStep low = flight(1e-3, true), low_by_others = flight(1e-3, false);
    EXPECT_EQ(static_cast<int>(low.end[0]), static_cast<int>(LaneOutcome::impact));
    EXPECT_LT(low.duration[0], low.brief[0]);
    EXPECT_NEAR(low.duration[0], low_by_others.duration[0], 1e-12);
    EXPECT_NEAR(low.brief[0], low_by_others.brief[0], 1e-9);  // both report the possible length
    const LaneStep high = flight(1.0, true), high_by_others = flight(1.0, false);
    EXPECT_EQ(static_cast<int>(high.end[0]), static_cast<int>(LaneOutcome::no_event));
    EXPECT_EQ(high.duration[0], high.brief[0]);
    EXPECT_LT(high.duration[0], high_by_others.duration[0]);
}

// ---- runs ----

std::string end_of(const RunResult& attempt) {
    if (const auto* error = std::get_if<InputError>(&attempt)) return error->what();
    const auto& trajectory = std::get<Trajectory>(attempt);
    std::string bytes = trajectory.outcome.message;
    append(bytes, trajectory.end_time);
    for (Eigen::Index i = 0; i < trajectory.end.q.size(); ++i) {
        append(bytes, trajectory.end.q[i]);
        append(bytes, trajectory.end.v[i]);
    }
    append(bytes, trajectory.loss);
    append(bytes, trajectory.statistics.least_gap);
    for (const long count :
         {trajectory.statistics.steps, trajectory.statistics.impacts, trajectory.statistics.evaluations})
        append(bytes, static_cast<double>(count));
    for (const Phase& phase : trajectory.phases) append(bytes, phase.start + phase.end + phase.impacts);
    return bytes;
}

std::vector<RunResult> together(const std::shared_ptr<const Model>& model, const std::vector<Run>& runs,
                                int threads = 0) {
    std::vector<RunResult> attempts(runs.size());
    simulate_ends(
        model, runs.size(), [&](std::size_t i) { return runs[i]; },
        [&](std::size_t i, RunResult&& attempt) { attempts[i] = std::move(attempt); }, threads);
    return attempts;
}

std::vector<Run> near_default(const Model& model, int count, double far, unsigned seed) {
    Uniform uniform(seed);
    std::vector<Run> runs;
    for (int i = 0; i < count; ++i) {
        Run run = model.default_run();
        for (double& x : run.q) x += uniform(far);
        for (double& x : run.v) x += uniform(far);
        runs.push_back(run);
    }
    return runs;
}

double difference(const State& a, const State& b) {
    return std::max((a.q - b.q).cwiseAbs().maxCoeff(), (a.v - b.v).cwiseAbs().maxCoeff());
}

// Equal within the effect of the tolerance on times, speeds and the place of a cut.
void expect_same_sequence(const std::vector<EventRecord>& some, const std::vector<EventRecord>& others) {
    ASSERT_EQ(some.size(), others.size());
    for (std::size_t k = 0; k < some.size(); ++k) {
        EXPECT_EQ(some[k].kind, others[k].kind) << k;
        EXPECT_EQ(some[k].contacts, others[k].contacts) << k;
        EXPECT_NEAR(some[k].t, others[k].t, 1e-6) << k;
        EXPECT_NEAR(some[k].impact_speed, others[k].impact_speed, 1e-6) << k;
    }
}

TEST(RunsSideBySide, EndWhereEachEndsAlone) {
    for (const auto& [name, model] : models()) {
        auto runs = near_default(*model, 40, 0.05, 3);
        for (auto& run : runs) run.options.tolerance = 1e-12;
        const auto attempts = together(model, runs);
        int compared = 0;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            SCOPED_TRACE(name + " " + std::to_string(i));
            const auto* trajectory = std::get_if<Trajectory>(&attempts[i]);
            if (trajectory == nullptr) {
                EXPECT_THROW(simulate(model, runs[i]), InputError);
                continue;
            }
            const Trajectory alone = simulate(model, runs[i]);
            EXPECT_LE(difference(trajectory->end, alone.end), 1e-8);
            EXPECT_EQ(trajectory->statistics.impacts, alone.statistics.impacts);
            EXPECT_EQ(trajectory->outcome.message, alone.outcome.message);
            EXPECT_EQ(trajectory->end_time, alone.end_time);
            EXPECT_GE(trajectory->statistics.least_gap, -1e-12);
            expect_same_sequence(sequence_of(*trajectory), sequence_of(alone));
            ASSERT_EQ(trajectory->phases.size(), alone.phases.size());
            for (std::size_t k = 0; k < alone.phases.size(); ++k) {
                EXPECT_NEAR(trajectory->phases[k].end, alone.phases[k].end, 1e-6);
                EXPECT_EQ(trajectory->phases[k].impacts, alone.phases[k].impacts);
            }
            ++compared;
        }
        EXPECT_GE(compared, 15) << name;
    }
}

// Most steps are lane steps. They are of lower order than those of single runs, so there are more of them.
TEST(RunsSideBySide, TakeFewStepsAlone) {
    const auto model = test::load("ball_on_sine");
    const auto runs = near_default(*model, 200, 1.0, 4);
    long together_steps = 0, alone_steps = 0;
    for (const RunResult& attempt : together(model, runs))
        together_steps += std::get<Trajectory>(attempt).statistics.steps;
    for (const auto& run : runs) alone_steps += simulate(model, run, nullptr, Recording::final_state).statistics.steps;
    EXPECT_GT(static_cast<double>(together_steps), 1.1 * static_cast<double>(alone_steps));  // lower order
}

// A step that lanes refuse is made once, by the scalar stepper. Here it is in contact and reaches past the release.
TEST(RunsSideBySide, CountNoStepThatIsNotMade) {
    const auto model = test::model_of({.potential = "b*(1 - a)", .a_rate = 1.0, .end = 2.0});
    const auto attempts = together(model, {model->default_run()});
    const auto& run = std::get<Trajectory>(attempts[0]);
    const Trajectory alone = simulate(model, model->default_run());
    ASSERT_EQ(run.phases.size(), 2u) << run.outcome.message;
    EXPECT_EQ(run.phases[0].kind, Phase::Kind::constrained);
    EXPECT_NEAR(run.phases[0].end, 1.0, 1e-12);
    EXPECT_EQ(run.statistics.steps, alone.statistics.steps);
}

// After a release the scalar stepper integrates the flight only until the gap is known to be open. Lane steps are of
// lower order, so more of them are needed.
TEST(RunsSideBySide, FlyOnTogetherPastARelease) {
    const auto model = test::load("double_pendulum");
    auto begun = model->default_run(), long_after = begun;  // of one flight, from t = 5.6 to 9
    begun.options.end_time = 6.5;
    long_after.options.end_time = 8.9;
    const auto attempts = together(model, {begun, long_after});
    const auto steps = [&](std::size_t i) { return std::get<Trajectory>(attempts[i]).statistics.steps; };
    const long alone = simulate(model, long_after).statistics.steps - simulate(model, begun).statistics.steps;
    ASSERT_EQ(std::get<Trajectory>(attempts[1]).passages.back().kind, Event::Kind::release);
    EXPECT_GT(static_cast<double>(steps(1) - steps(0)), 1.2 * static_cast<double>(alone)) << alone;
}

// Runs that differ in everything that may differ.
std::vector<Run> mixture(const Model& model) {
    auto runs = near_default(model, 60, 0.5, 5);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        Options& options = runs[i].options;
        const auto part = static_cast<double>(i) / static_cast<double>(runs.size());
        if (i % 3 != 0) runs[i].parameters[1] = 1.0 + part;                            // g
        if (i % 4 != 0) runs[i].parameters[2] = i % 12 == 1 ? 0.0 : 0.1 + 0.8 * part;  // e
        if (i % 5 == 0) options.tolerance = 1e-6;
        if (i % 6 == 0) options.end_time = 3.0 + 20.0 * part;
        if (i % 7 == 0) options.truncation.conditions = Conditions::paper;
        if (i % 8 == 0) options.truncation.reinitialization = Reinitialization::euclidean;
        if (i % 9 == 0) options.method = Method::dopri5;
        if (i % 10 == 9) runs[i].q[1] = -3.0;  // cannot start
        if (i % 11 == 0) options.max_steps = 25;
        if (i % 13 == 5) options.max_impacts = 5;
        if (i % 17 == 0) runs[i].parameters[2] = 1.0;
        if (i % 19 == 0) runs[i].options.end_time = 1e-3;
    }
    for (auto& run : runs)
        if (run.parameters[2] == 1.0) run.options.max_impacts = 40;
    return runs;
}

TEST(RunsSideBySide, DependOnNoNeighborAndNoThread) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);  // also on two cores
    const auto model = test::load("ball_on_sine");
    const auto runs = mixture(*model);
    std::vector<std::string> alone;
    for (const auto& run : runs) alone.push_back(end_of(together(model, {run})[0]));
    for (const int threads : {1, 2, 8}) {
        const auto attempts = together(model, runs, threads);
        for (std::size_t i = 0; i < runs.size(); ++i)
            EXPECT_TRUE(end_of(attempts[i]) == alone[i]) << i << " on " << threads << " threads";
    }
}

// Runs that differ in restitution alone reuse the compiled programs of the previous run.
TEST(RunsSideBySide, ForgetTheRestitutionOfTheRunBefore) {
    const auto model = test::load("double_pendulum");
    for (const Conditions conditions : {Conditions::sharp, Conditions::paper}) {
        auto runs = near_default(*model, 60, 0.0, 9);
        for (std::size_t i = 0; i < runs.size(); ++i) {
            runs[i].parameters.back() = 0.1 + 0.008 * static_cast<double>(i);  // e
            runs[i].options.truncation.conditions = conditions;
        }
        const auto attempts = together(model, runs, 1);
        for (std::size_t i = 0; i < runs.size(); ++i) {
            EXPECT_GE(std::get<Trajectory>(attempts[i]).phases.size(), 3u) << i;
            EXPECT_TRUE(end_of(attempts[i]) == end_of(together(model, {runs[i]})[0])) << i;
        }
    }
}

TEST(RunsSideBySide, SayWhatARunAloneSays) {
    const auto model = test::load("ball_on_sine");
    const auto runs = mixture(*model);
    const auto attempts = together(model, runs);
    int outcomes[8] = {};
    for (std::size_t i = 0; i < runs.size(); ++i) {
        SCOPED_TRACE(i);
        const auto* trajectory = std::get_if<Trajectory>(&attempts[i]);
        EXPECT_EQ(trajectory == nullptr, i % 10 == 9);
        if (trajectory == nullptr) continue;
        const Trajectory alone = simulate(model, runs[i]);
        ++outcomes[static_cast<int>(trajectory->outcome.kind)];
        EXPECT_LE(trajectory->statistics.steps, runs[i].options.max_steps);
        EXPECT_LE(trajectory->statistics.impacts, runs[i].options.max_impacts);
        if (runs[i].options.max_steps > 25) {
            EXPECT_EQ(trajectory->outcome.kind, alone.outcome.kind);
        }
    }
    EXPECT_GT(outcomes[static_cast<int>(Outcome::Kind::end_time)], 20);
    EXPECT_GT(outcomes[static_cast<int>(Outcome::Kind::too_many_impacts)], 2);
    EXPECT_GT(outcomes[static_cast<int>(Outcome::Kind::too_many_steps)], 2);
}

TEST(RunsSideBySide, AreTheSameWithoutMachineCode) {
    const test::MachineCodeSwitch on(nullptr);
    for (const auto& [name, model] : models()) {
        const auto runs = near_default(*model, 16, 0.1, 7);
        const auto by_code = together(model, runs);
        const test::MachineCodeSwitch off("0");
        const auto by_loops = together(std::make_shared<const Model>(model->description()), runs);
        for (std::size_t i = 0; i < runs.size(); ++i)
            EXPECT_TRUE(end_of(by_code[i]) == end_of(by_loops[i])) << name << " " << i;
    }
}

// If a function has a singularity, every run is simulated separately.
TEST(RunsSideBySide, OfAPartialSystemAreSimulatedOneByOne) {
    const auto model = test::typed(R"toml(
title = "A test"
[[coordinate]]
name = "x"
start = 1.0
rate = 0.5
[[coordinate]]
name = "y"
start = 3.0
[lagrangian]
kinetic = "1/2*(x'^2 + y'^2)"
potential = "y + x"
[[constraint]]
gap = "y - sqrt(x)"
restitution = "0.5"
[run]
end_time = 20.0
)toml");
    const auto runs = near_default(*model, 10, 0.3, 6);
    const auto attempts = together(model, runs);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        EXPECT_EQ(end_of(attempts[i]), end_of(simulate(model, runs[i])));
        EXPECT_EQ(std::get<Trajectory>(attempts[i]).outcome.kind, Outcome::Kind::left_the_domain);
    }
}

TEST(RunsSideBySide, ExceptionOfRunOfEndsTheBatch) {
    const auto model = test::load("ball_on_sine");
    struct Cancelled {};
    const auto run_of = [&](std::size_t i) { return i == 50 ? throw Cancelled() : model->default_run(); };
    EXPECT_THROW(simulate_ends(model, 100, run_of, [](std::size_t, RunResult&&) {}), Cancelled);
    simulate_ends(model, 0, run_of, [](std::size_t, RunResult&&) { FAIL(); });
}

}  // namespace
}  // namespace achilles
