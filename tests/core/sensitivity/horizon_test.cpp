// The horizon of a run: other tolerances give the same motion before it, and a different motion after it.
#include <gtest/gtest.h>

#include <limits>

#include "core/sensitivity/estimates.hpp"
#include "output/output.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {
namespace {

struct Meaningless {
    const char* file;  // relative to the source folder
    std::vector<std::pair<std::string, double>> values;
    double end;
    bool is_exact = false;  // parabolic flights: every tolerance takes the same steps, so another method is compared
};

// Elastic billiards, driven oscillators and chaotic systems, whose final states are meaningless.
const std::vector<Meaningless>& meaningless() {
    static const std::vector<Meaningless> all{{"tests/reference/horizon/shaker.toml", {}, 10.0},
                                              {"tests/reference/horizon/sinai_billiard.toml", {}, 60.0},
                                              {"tests/reference/horizon/lorenz_rates.toml", {}, 50.0},
                                              {"tests/reference/horizon/duffing.toml", {}, 400.0},
                                              {"tests/reference/horizon/duffing_stop.toml", {}, 200.0},
                                              {"tests/reference/horizon/spring_pendulum.toml", {}, 30.0},
                                              {"tests/reference/horizon/parametric_pendulum.toml", {}, 60.0},
                                              {"tests/reference/horizon/two_balls.toml", {}, 60.0, true},
                                              {"tests/reference/horizon/wedge_billiard.toml", {}, 40.0, true},
                                              {"assets/systems/ball_on_vibrating_table.toml", {{"e", 0.9}}, 60.0},
                                              {"assets/systems/ball_on_sine.toml", {{"e", 0.99}}, 200.0}};
    return all;
}

std::shared_ptr<const Model> model_of(const Meaningless& one) {
    return std::make_shared<const Model>(read_system(source_file(one.file)));
}

Run run_of(const Model& model, const Meaningless& one) {
    Run run = model.default_run();
    for (const auto& [name, value] : one.values)
        for (std::size_t i = 0; i < model.description().parameters.size(); ++i)
            if (model.description().parameters[i].name == name) run.parameters[i] = value;
    run.options.end_time = one.end;
    return run;
}

// Largest difference of a coordinate between two runs in [from, to], relative to its range.
double difference(const Trajectory& a, const Trajectory& b, const State& range, double from, double to) {
    constexpr int instants = 2000;
    Sampler of_a(a), of_b(b);
    double largest = 0.0;
    for (int k = 0; k <= instants; ++k) {
        const double t = from + (to - from) * k / instants;
        const Vector q = of_a.at(t).state.q - of_b.at(t).state.q;
        for (Eigen::Index i = 0; i < q.size(); ++i) largest = std::max(largest, std::abs(q[i]) / range.q[i]);
    }
    return largest;
}

TEST(Horizon, LiesWhereOtherTolerancesPart) {
    for (const Meaningless& one : meaningless()) {
        const auto model = model_of(one);
        const auto run = run_of(*model, one);
        const Trajectory trajectory = simulate(model, run);
        const ErrorEstimate estimate = estimate_error(trajectory);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << one.file;
        ASSERT_TRUE(estimate.trusted_until) << one.file;
        const double horizon = *estimate.trusted_until;
        ASSERT_LT(horizon, 0.95 * trajectory.end_time) << one.file;
        auto other = with(run, 1e-13, 1e-9);
        if (one.is_exact) other.options.method = Method::dopri5;
        const Trajectory truth = simulate(model, other);
        const double end = std::min(trajectory.end_time, truth.end_time);
        const State range = estimate.course.range();
        const double before = difference(trajectory, truth, range, run.options.start_time, horizon);
        EXPECT_LT(before, 2e-2) << one.file;
        EXPECT_GT(before, one.is_exact ? 1e-6 : 5e-5) << one.file << ": the horizon comes too early";
        EXPECT_GT(difference(trajectory, truth, range, horizon, end), 0.2) << one.file;
    }
}

TEST(Horizon, IsTheEndOfOrdinaryRuns) {
    int trusted = 0;
    for (const std::string& name : all_systems()) {
        const auto model = load(name);
        const Trajectory trajectory = simulate(model, model->default_run());
        const ErrorEstimate estimate = estimate_error(trajectory);
        EXPECT_EQ(estimate.trusted_until.has_value(), estimate.end.has_value()) << name;
        EXPECT_FALSE(horizon_remark(trajectory, estimate)) << name;
        if (!estimate.end) continue;
        EXPECT_EQ(*estimate.trusted_until, trajectory.end_time) << name;
        ++trusted;
    }
    EXPECT_GE(trusted, 25);
}

TEST(Horizon, IsNoneWithoutAnEstimate) {
    const auto model = load("ball_on_sine");
    auto run = model->default_run();
    run.options.method = Method::dopri5;
    const ErrorEstimate estimate = estimate_error(simulate(model, run));
    EXPECT_FALSE(estimate.trusted_until);
    EXPECT_FALSE(estimate.no_estimate_reason.empty());
}

// Rounding errors of q and t grow like the perturbations of the run. Regression: on the shaken floor sigma was 1.8e-4
// at t = 1.71, where perturbations of rounding size grow to 1e-10.
TEST(Horizon, RoundingGrowsAsTheErrorDoes) {
    const auto model = model_of(meaningless()[0]);
    auto run = model->default_run();
    run.options.end_time = 1.71;
    const auto end = estimate_error(simulate(model, run)).end.value();
    EXPECT_GT(end.sigma, 1e-12);
    EXPECT_LT(end.sigma, 1e-8);
}

// ---- the error course, from given events ----

Run still(double q, double v) {
    Run run;
    run.q = Vector::Constant(1, q);
    run.v = Vector::Constant(1, v);
    return run;
}

Event event_at(double t, double q, double v) {
    Event event;
    event.t = t;
    event.q = Vector::Constant(1, q);
    event.v_before = event.v_after = Vector::Constant(1, v);
    return event;
}

State sizes(double q, double v) { return {Vector::Constant(1, q), Vector::Constant(1, v), 0.0}; }

TEST(ErrorCourse, FindsTheFirstShareThatIsExceeded) {
    ErrorCourse course;
    course.begin(still(5.0, 0.0));
    course.add(event_at(1.0, 5.0, 0.0), sizes(0.9e-12, 0.0));  // smallest allowed range: 1e-9
    EXPECT_FALSE(course.horizon());
    course.add(event_at(2.0, 7.0, 3.0), sizes(1.9e-3, 2.9e-3));  // the ranges so far are 2 and 3
    EXPECT_FALSE(course.horizon());
    course.add(event_at(3.0, 6.0, 1.0), sizes(1.0e-3, 3.1e-3));
    ASSERT_EQ(course.horizon(), 3.0);
    EXPECT_TRUE(course.is_rate());
    EXPECT_EQ(course.range().q[0], 2.0);
    ErrorCourse least;
    least.begin(still(5.0, 0.0));
    least.add(event_at(1.0, 5.0, 0.0), sizes(1.1e-12, 0.0));
    EXPECT_EQ(least.horizon(), 1.0);
    EXPECT_FALSE(least.is_rate());
}

TEST(ErrorCourse, DoesNotRecover) {
    ErrorCourse course;
    course.begin(still(0.0, 0.0));
    course.add(event_at(1.0, 1.0, 1.0), sizes(1e-6, 1e-6));
    course.add(event_at(2.0, 1.0, 1.0), sizes(1e-8, 1e-8));
    EXPECT_EQ(course.at(2.0)->q[0], 1e-8) << "before the horizon it may";
    EXPECT_EQ(course.at(1.5)->q[0], 1e-6) << "the larger of both sides";
    course.add(event_at(3.0, 1.0, 1.0), sizes(0.01, std::numeric_limits<double>::quiet_NaN()));
    course.add(event_at(4.0, 1.0, 1.0), sizes(0.0, 0.0));
    EXPECT_EQ(course.horizon(), 3.0);
    EXPECT_EQ(course.at(4.0)->q[0], 0.01);
    EXPECT_EQ(course.at(9.0)->v[0], std::numeric_limits<double>::infinity());
    EXPECT_EQ(course.at(0.0)->q[0], 0.0);
}

// A coordinate has its maximum inside a step: the range includes the whole flight.
TEST(ErrorCourse, KnowsTheRangeInsideSteps) {
    const auto model = typed(
        "title = \"throw\"\n[[coordinate]]\nname = \"y\"\nrate = 10\n[lagrangian]\nkinetic = \"y'^2/2\"\n"
        "potential = \"10*y\"\n[[constraint]]\ngap = \"y + 1\"\nrestitution = 0.5\n[run]\nend_time = 2\n");
    const ErrorEstimate estimate = estimate_error(simulate(model, model->default_run()));
    EXPECT_NEAR(estimate.course.range().q[0], 5.0, 0.2);
    EXPECT_EQ(estimate.trusted_until, 2.0);
}

}  // namespace
}  // namespace achilles::test
