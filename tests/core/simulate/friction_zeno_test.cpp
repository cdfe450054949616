// Zeno points with dry friction (theory-friction.md 4): runs against closed forms and against references of 29 digits,
// and the order in the impact speed of the cut.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

// A point that bounces on a slope with the gravity alpha along it.
std::string point_on_slope(double alpha) {
    return fmt::format(R"-(coordinate = [{{name = "x"}}, {{name = "y", start = 0.5}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - {}*x"
constraint = [{{gap = "y", restitution = 0.5, slip = "x'", friction = 0.5}}]
)-",
                       alpha);
}

// A ball that bounces on a floor; u is the velocity of its lowest point.
std::string ball(double mu, double v, double omega) {
    return fmt::format(
        R"-(coordinate = [{{name = "x", rate = {}}}, {{name = "y", start = 0.5}}, {{name = "phi", rate = {}}}]
lagrangian.kinetic = "(x'^2 + y'^2 + 2/5*phi'^2)/2"
lagrangian.potential = "y"
constraint = [{{gap = "y", restitution = 0.5, slip = "x' + phi'", friction = {}}}]
)-",
        v, omega, mu);
}

// A body that bounces on a sine; the reference's `tails`.
struct Tail {
    const char* name;
    double A, r;
    const char* friction;
    double e, coupling;         // of x and y in the mass matrix
    double q[3], v[3], end;     // start and end
    double q_end[3], v_end[3];  // the reference at the end
    double zeno_time, heat_and_loss;
    Certificate::Tail kind;
};
void PrintTo(const Tail& tail, std::ostream* stream) { *stream << tail.name; }

std::string system_of(const Tail& tail) {
    return fmt::format(R"-(coordinate = [
  {{name = "x", start = {}, rate = {}}}, {{name = "y", start = {}, rate = {}}}, {{name = "phi", start = {}, rate = {}}}]
lagrangian.kinetic = "(x'^2 + y'^2 + 2*{}*x'*y' + 2/5*phi'^2)/2"
lagrangian.potential = "y"
[[constraint]]
gap = "y - {}*sin(x)"
restitution = {}
slip = "(x' + {}*cos(x)*y')/sqrt(1 + {}*cos(x)^2) + {}*phi'"
friction = "{}"
)-",
                       tail.q[0], tail.v[0], tail.q[1], tail.v[1], tail.q[2], tail.v[2], tail.coupling, tail.A, tail.e,
                       tail.A, tail.A * tail.A, tail.r, tail.friction);
}

const Tail tails[] = {
    {"sine_slip",
     1,
     0,
     "0.1",
     0.5,
     0,
     {2.6, 0.75, 0},
     {0.7, 0, 0},
     3,
     {5.61063344355087096802929, -0.622984168934473868199869, 0},
     {0.911963857547931451644516, 0.713369540985421611282468, 0},
     2.38576023924764017674259,
     0.9476970791947464015,
     Certificate::Tail::slip},
    {"sine_slip_stribeck",
     1,
     0,
     "0.1 + 0.1*exp(-slip)",
     0.5,
     0,
     {2.6, 0.75, 0},
     {0.7, 0, 0},
     2.9,
     {5.47757226707667181177966, -0.721255412504711585534426, 0},
     {0.961433273287134497411499, 0.665955222718226086760335, 0},
     2.40265201343060052497876,
     1.032330263680063606,
     Certificate::Tail::slip},
    {"sine_stick_e5",
     1,
     0.5,
     "0.6",
     0.5,
     0,
     {2.6, 0.75, 0},
     {0.7, 0, -0.5},
     3,
     {5.04641719211714264906531, -0.944729357666873118920609, -2.90150369762032554040294},
     {0.82345637254159397763644, 0.269971199344980908306821, -1.73316455762876460703207},
     2.83164431025762081769951,
     1.0134750579252069423,
     Certificate::Tail::stick},
    {"sine_slip_then_stick",
     1,
     0.5,
     "0.6",
     0.2,
     0,
     {2.6, 0.75, 0},
     {0.7, 0, -0.5},
     2.6,
     {4.68029182575983024074266, -0.999484930554657014789948, -2.20027208036124506800853},
     {0.906730750372503736317327, -0.0290984801556191609519155, -1.81439507849690845292739},
     1.93779543208016591206094,
     0.97457534277067117412,
     Certificate::Tail::slip},
    {"gentle_stick_e7",
     0.3,
     0.5,
     "0.8",
     0.7,
     0,
     {2, 0.6, 0},
     {0.3, 0, -0.5},
     8,
     {6.35362024564127011214395, 0.0211130142017277387446432, -8.24347139431066020319688},
     {0.462824648604630430287309, 0.138503120392938864724891, -0.966208610424437387445507},
     4.61488170621193911065347,
     0.3704802851693175409,
     Certificate::Tail::stick},
    {"gentle_stick_e3",
     0.3,
     0.5,
     "0.8",
     0.3,
     0,
     {2, 0.6, 0},
     {0.3, 0, -0.5},
     3,
     {3.15194046248923123806645, -0.00310428726943422913012503, -2.22843932356602789030827},
     {0.512713546834081532517026, -0.153805829137976979536286, -1.07057258359067739678577},
     1.56491066034604400486477,
     0.32561344883022839793,
     Certificate::Tail::stick},
    {"coupled_stick",
     0.3,
     0.5,
     "1.2",
     0.3,
     0.4,
     {2, 0.6, 0},
     {0.3, 0, -0.5},
     2.2,
     {3.02195791384001982422548, 0.035804869734155618349868, -1.51004370004583400375504},
     {0.479386842080931977553975, -0.142788098011687711879748, -1.00040029047201650755695},
     1.48956671698615239055963,
     0.36131518354050973567,
     Certificate::Tail::stick},
    {"coupled_slip",
     0.3,
     0.5,
     "0.1",
     0.3,
     0.4,
     {2, 0.6, 0},
     {0.3, 0, -0.5},
     2.2,
     {3.18265263019626692811907, -0.0123145320784607508408714, -1.34605110757574224119919},
     {0.715189848044057753583234, -0.214376116711471357313615, -0.762268952680679663276709},
     1.4924485144070597697638,
     0.37370477068755525196,
     Certificate::Tail::slip},
};

// A run with a truncation at eps in position, velocity and time.
Trajectory completed(const std::string& text, double end, double eps, Method method = Method::taylor) {
    const auto model = derive(parse_system(text));
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    run.options.method = method;
    run.options.tolerance = method == Method::taylor ? 1e-14 : 1e-10;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = eps;
    Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    return trajectory;
}

const Event* zeno_event(const Trajectory& trajectory) {
    for (const Event& event : trajectory.events)
        if (event.is_zeno()) return &event;
    return nullptr;
}
double first_time(const Trajectory& trajectory, Event::Kind kind) {
    for (const Event& event : trajectory.events)
        if (event.kind == kind) return event.t;
    return -1.0;
}

double energy_balance_of(const Trajectory& trajectory) {
    auto energy = trajectory.model->evaluator(trajectory.model->energy(), trajectory.run.parameters);
    const auto at = [&](const State& state) {
        set_state(energy, state);
        energy.run();
        return energy.total();
    };
    return at(trajectory.end) - at(trajectory.run.start()) + trajectory.loss + trajectory.heat - trajectory.work;
}

class FrictionZeno : public testing::TestWithParam<Method> {
 protected:
    static double accuracy() { return GetParam() == Method::taylor ? 1e-12 : 1e-7; }
};

TEST_P(FrictionZeno, PointOnASlopeSticksThroughItsZenoPoint) {
    const Trajectory run = completed(point_on_slope(0.3), 5.0, 1e-4, GetParam());
    const Event* zeno = zeno_event(run);
    ASSERT_NE(zeno, nullptr);
    EXPECT_EQ(zeno->certificate->tail, Certificate::Tail::stick);
    EXPECT_EQ(zeno->sticks_from, 1);
    EXPECT_EQ(zeno->mode.state(0), ContactState::held);
    EXPECT_NEAR(zeno->t, 3.0, accuracy());
    EXPECT_NEAR(run.end.q[0], 0.35, accuracy());
    EXPECT_EQ(run.end.v[0], 0.0);
    EXPECT_NEAR(run.loss, 0.5, accuracy());
    EXPECT_NEAR(run.heat, 0.105, accuracy());
    EXPECT_NEAR(energy_balance_of(run), 0.0, 1e-12);
}

// Bouncing slides although resting sticks.
TEST_P(FrictionZeno, PointOnASlopeSlidesThroughAndStopsLater) {
    const Trajectory run = completed(point_on_slope(0.45), 8.0, 1e-4, GetParam());
    const Event* zeno = zeno_event(run);
    ASSERT_NE(zeno, nullptr);
    EXPECT_EQ(zeno->certificate->tail, Certificate::Tail::slip);
    EXPECT_EQ(zeno->mode.state(0), ContactState::slip_plus);
    EXPECT_NEAR(zeno->t, 3.0, accuracy());
    EXPECT_NEAR(zeno->v_after[0], 0.15, accuracy());
    EXPECT_NEAR(first_time(run, Event::Kind::stick), 6.0, accuracy());
    EXPECT_NEAR(run.end.q[0], 0.85, accuracy());
    EXPECT_NEAR(run.loss, 0.5, accuracy());
    EXPECT_NEAR(run.heat, 0.3825, accuracy());
    EXPECT_NEAR(run.heat - zeno->heat, 0.1125, accuracy());
    EXPECT_NEAR(energy_balance_of(run), 0.0, 1e-12);
}

TEST_P(FrictionZeno, BallSlidesThrough) {
    const Trajectory run = completed(ball(0.1, 2.0, 0.5), 6.0, 1e-4, GetParam());
    const Event* zeno = zeno_event(run);
    ASSERT_NE(zeno, nullptr);
    EXPECT_EQ(zeno->certificate->tail, Certificate::Tail::slip);
    EXPECT_NEAR(zeno->t, 3.0, accuracy());
    EXPECT_NEAR(run.end.q[0], 10.25, accuracy());
    EXPECT_NEAR(run.end.v[0], 1.4, accuracy());
    EXPECT_NEAR(run.end.v[2], -1.0, accuracy());
}

TEST_P(FrictionZeno, BallBouncesToRolling) {
    const Trajectory run = completed(ball(0.2, 1.0, 0.5), 5.0, 1e-4, GetParam());
    ASSERT_NE(zeno_event(run), nullptr);
    EXPECT_NEAR(run.end.q[0], 3.414285714285714285714, accuracy());
    EXPECT_NEAR(run.end.v[0], 4.0 / 7.0, accuracy());
}

// W = (1, 0.6, 1), mu = 0.4: all impacts stick although the contact at rest slides.
TEST_P(FrictionZeno, SkewBodySticksAtItsImpactsAndThenSlides) {
    const double alpha = -0.2, e = 0.2, force_y = (-1.0 - 0.6 * alpha) / 0.64, force_x = (alpha + 0.6) / 0.64;
    const std::string text = fmt::format(R"-(coordinate = [{{name = "x", rate = -0.2}}, {{name = "y", start = 0.5}}]
lagrangian.kinetic = "(x'^2 + y'^2 - 1.2*x'*y')/1.28"
lagrangian.potential = "{:.17g}*x + {:.17g}*y"
constraint = [{{gap = "y", restitution = {}, slip = "x'", friction = 0.4}}]
)-",
                                         -force_x, -force_y, e);
    const Trajectory run = completed(text, 3.0, 1e-4, GetParam());
    const Event* zeno = zeno_event(run);
    ASSERT_NE(zeno, nullptr);
    EXPECT_EQ(zeno->certificate->tail, Certificate::Tail::stick_then_slip);
    EXPECT_EQ(zeno->mode.state(0), ContactState::slip_plus);
    EXPECT_NEAR(zeno->t, 1.5, accuracy());
    const double at_zeno = -0.2 + 0.5 * alpha + 2.0 * alpha * e * e / (1.0 - e * e), udot = alpha + 0.2 / 0.76;
    EXPECT_NEAR(zeno->q[0], at_zeno, accuracy());
    EXPECT_NEAR(run.end.q[0], at_zeno + 0.5 * udot * 1.5 * 1.5, accuracy());
    EXPECT_NEAR(energy_balance_of(run), 0.0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Methods, FrictionZeno, testing::Values(Method::taylor, Method::dopri5));

class FrictionTail : public testing::TestWithParam<Tail> {};

// eps = 1e-8 cuts at speeds w of about 1e-4, so that w^3 is below 1e-10.
TEST_P(FrictionTail, AgreesWithTheReference) {
    const Tail& tail = GetParam();
    const Trajectory run = completed(system_of(tail), tail.end, 1e-8);
    const Event* zeno = zeno_event(run);
    ASSERT_NE(zeno, nullptr);
    EXPECT_EQ(zeno->certificate->tail, tail.kind);
    EXPECT_NEAR(zeno->t, tail.zeno_time, 1e-9);
    EXPECT_LE(zeno->certificate->zeno_low, tail.zeno_time + 1e-12);
    EXPECT_GE(zeno->certificate->zeno_high, tail.zeno_time - 1e-12);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(run.end.q[i], tail.q_end[i], 1e-9);
        EXPECT_NEAR(run.end.v[i], tail.v_end[i], 1e-9);
    }
    EXPECT_NEAR(run.heat + run.loss, tail.heat_and_loss, 1e-9);
    EXPECT_NEAR(energy_balance_of(run), 0.0, 1e-12);
}

// The error of the completed motion is of third order in the impact speed w of the cut: the slope of its logarithm over
// cuts at many speeds is 3.
TEST_P(FrictionTail, HasThirdOrder) {
    const Tail& tail = GetParam();
    std::vector<double> x, y;
    std::string measured;
    for (double eps = 0.1; eps > 1e-7; eps *= 0.7) {
        const Trajectory run = completed(system_of(tail), tail.end, eps);
        const Event* zeno = zeno_event(run);
        ASSERT_NE(zeno, nullptr);
        const double w = zeno->truncation->impact_speed;
        if (!x.empty() && std::log(w) > x.back() - 0.01) continue;
        // For a contact that sticks, 0.034 w^2 is missing without the term of the slip (e = 0.7).
        EXPECT_NEAR(zeno->t, tail.zeno_time, 4.0 * w * w * w + 1e-12) << w;
        double error = 0.0;
        for (int i = 0; i < 3; ++i)
            error = std::max({error, std::abs(run.end.q[i] - tail.q_end[i]), std::abs(run.end.v[i] - tail.v_end[i])});
        if (error < 1e-11) break;  // rounding
        measured += fmt::format(" {:.3g}: {:.3g},", w, error);
        x.push_back(std::log(w));
        y.push_back(std::log(error));
    }
    ASSERT_GE(x.size(), 3u);
    const std::size_t last = std::min<std::size_t>(x.size(), 4);  // the smallest speeds
    const double slope = (y.back() - y[y.size() - last]) / (x.back() - x[x.size() - last]);
    EXPECT_NEAR(slope, 3.0, 0.1) << "errors by speed:" << measured;
}

INSTANTIATE_TEST_SUITE_P(Reference, FrictionTail, testing::ValuesIn(tails),
                         [](const auto& tail) { return std::string(tail.param.name); });

// The first impact on the sine slides, the others stick.
TEST(FrictionCompletion, NamesTheFirstImpactThatSticks) {
    const Trajectory run = completed(system_of(tails[2]), tails[2].end, 1e-6);
    const Event* zeno = zeno_event(run);
    ASSERT_NE(zeno, nullptr);
    EXPECT_EQ(zeno->sticks_from, 2);
}

// A contact without friction beside a joint on x, which slides or sticks.
std::string beside_joint(double coupling, double speed, double level) {
    return fmt::format(R"-(coordinate = [{{name = "x", rate = {}}}, {{name = "y", start = 0.5}}]
lagrangian.kinetic = "(x'^2 + y'^2 + 2*{}*x'*y')/2"
lagrangian.potential = "y"
constraint = [{{gap = "y", restitution = 0.5}}]
friction = [{{name = "guide", slip = "x'", level = {}}}]
)-",
                       speed, coupling, level);
}

TEST(FrictionCompletion, CompletesBesideJointsThatFeelNoImpulse) {
    for (const double speed : {1.0, 0.0}) {
        const Trajectory run = completed(beside_joint(0.0, speed, 0.1), 5.0, 1e-4);
        const Event* zeno = zeno_event(run);
        ASSERT_NE(zeno, nullptr);
        EXPECT_EQ(zeno->certificate->tail, Certificate::Tail::none);
        EXPECT_NEAR(zeno->t, 3.0, 1e-12);
        EXPECT_NEAR(run.end.q[0], speed * 5.0 - (speed > 0.0 ? 0.05 * 25.0 : 0.0), 1e-12);
        EXPECT_NEAR(energy_balance_of(run), 0.0, 1e-12);
    }
}

TEST(FrictionCompletion, DoesNotCompleteBesideAJointThatIsKicked) {
    const auto model = derive(parse_system(beside_joint(0.2, 0.0, 0.5)));
    achilles::Run run = model->default_run();
    run.options.end_time = 10.0;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 0.1;
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::undecided);
    EXPECT_EQ(zeno_event(trajectory), nullptr);
    EXPECT_GT(trajectory.statistics.impacts, 20);
}

}  // namespace
}  // namespace achilles
