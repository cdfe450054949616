// Contacts that bounce while others are held with dry friction (theory-friction.md 4.3), and bouncing whose impacts are
// all capped: closed forms, the same motion without the held contact, and what is not completed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

Trajectory run_with(const std::string& text, double end, double eps, Method method = Method::taylor) {
    const auto model = derive(parse_system(text));
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    run.options.method = method;
    run.options.tolerance = method == Method::taylor ? 1e-14 : 1e-10;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = eps;
    return simulate(model, run);
}

Trajectory ended_run(const std::string& text, double end, double eps, Method method = Method::taylor) {
    Trajectory run = run_with(text, end, eps, method);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    return run;
}

const Event& zeno_of(const Trajectory& run) {
    for (const Event& event : run.events)
        if (event.is_zeno()) return event;
    throw std::runtime_error("no Zeno point: " + run.outcome.message);
}

// E + heat + loss - work at the end, minus E at the start.
double balance_of(const Trajectory& run) {
    auto energy = run.model->evaluator(run.model->energy(), run.run.parameters);
    const auto at = [&](const State& state) {
        set_state(energy, state);
        energy.run();
        return energy.total();
    };
    return at(run.end) - at(run.run.start()) + run.loss + run.heat - run.work;
}

// A block on an incline of the tangential gravity alpha carries a mass, of the same weight 1, that bounces on it.
std::string carrier(double alpha, double speed, double friction) {
    return fmt::format(R"-(coordinate = [{{name = "x", rate = {}}}, {{name = "y"}}, {{name = "z", start = 0.5}}]
lagrangian.kinetic = "x'^2 + (y'^2 + z'^2)/2"
lagrangian.potential = "y + z - 2*{}*x"
[[constraint]]
name = "incline"
gap = "y"
slip = "x'"
friction = {}
restitution = 0
[[constraint]]
name = "seat"
gap = "z - y"
restitution = 0.5
)-",
                       speed, alpha, friction);
}

class FrictionBesideHeld : public testing::TestWithParam<Method> {
 protected:
    static double accuracy() { return GetParam() == Method::taylor ? 1e-12 : 1e-7; }
};

// The bouncing lasts until t = 3. The impulses that it passes on slow the block as its weight would: u = u0 + (alpha -
// mu) t at the end, but x = u0 t + alpha t^2/2 - mu (t^2 - H)/2 with the height H = 0.5 of the fall.
TEST_P(FrictionBesideHeld, BlockSlidesWhileItsLoadBounces) {
    const Trajectory run = ended_run(carrier(0.3, 1.0, 0.2), 4.0, 1e-4, GetParam());
    const Event& zeno = zeno_of(run);
    EXPECT_EQ(zeno.mode.state(0), ContactState::slip_plus);
    EXPECT_EQ(zeno.mode.state(1), ContactState::held);
    EXPECT_NEAR(zeno.t, 3.0, accuracy());
    EXPECT_NEAR(zeno.q[0], 3.0 + 0.3 * 4.5 - 0.2 * (9.0 - 0.5) / 2.0, accuracy());
    EXPECT_NEAR(zeno.v_after[0], 1.3, accuracy());
    EXPECT_NEAR(run.end.q[0], zeno.q[0] + 1.35, accuracy());
    EXPECT_NEAR(balance_of(run), 0.0, 1e-12);
    ASSERT_TRUE(zeno.certificate->others);
    const auto& held = zeno.certificate->others->held.at(0);
    EXPECT_NEAR(held.transmission_low, 1.0, 1e-12);
    EXPECT_NEAR(held.least_force, 1.0, 1e-12);
}

TEST_P(FrictionBesideHeld, BlockSticksWhileItsLoadBounces) {
    const Trajectory run = ended_run(carrier(0.15, 0.0, 0.4), 4.0, 1e-4, GetParam());
    const Event& zeno = zeno_of(run);
    EXPECT_EQ(zeno.mode.state(0), ContactState::held);
    EXPECT_NEAR(zeno.t, 3.0, accuracy());
    EXPECT_EQ(run.end.q[0], 0.0);
    EXPECT_EQ(run.end.v[0], 0.0);
    EXPECT_NEAR(run.loss, 0.5, accuracy());
}

// The load has friction on the block, and sticks to it at its impacts, as a point on a slope does: it moves by alpha/2
// (1 + 4/3 (1 + 1/4 + ...)) T^2 with the first flight of length T = 1.
TEST_P(FrictionBesideHeld, LoadSticksToABlockThatSticks) {
    const Trajectory run = ended_run(R"-(coordinate = [
  {name = "x"}, {name = "y"}, {name = "s"}, {name = "z", start = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2 + s'^2 + z'^2)/2"
lagrangian.potential = "y + z - 0.2*(x + s)"
constraint = [
  {name = "incline", gap = "y", slip = "x'", friction = 0.9, restitution = 0},
  {name = "seat", gap = "z - y", slip = "s' - x'", friction = 0.8, restitution = 0.5}]
)-",
                                     4.0, 1e-4, GetParam());
    const Event& zeno = zeno_of(run);
    EXPECT_EQ(zeno.certificate->tail, Certificate::Tail::stick);
    EXPECT_EQ(zeno.mode.state(0), ContactState::held);
    EXPECT_NEAR(zeno.t, 3.0, accuracy());
    EXPECT_NEAR(run.end.q[0], 0.0, 1e-12);
    EXPECT_NEAR(run.end.q[2], 0.1 * (1.0 + 4.0 / 3.0), accuracy());
    EXPECT_NEAR(balance_of(run), 0.0, 1e-12);
}

// A cart on the ground, or a fixed one, with a pendulum of mass 0.3 that bounces on a stop.
std::string pendulum_on_cart(double friction) {
    return fmt::format(R"-(coordinate = [{{name = "x"}}, {{name = "y"}}, {{name = "theta", start = 1.6}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2 + 0.3/2*((x' + cos(theta)*theta')^2 + (y' + sin(theta)*theta')^2)"
lagrangian.potential = "9.81*y + 0.3*9.81*(y - cos(theta))"
[[constraint]]
name = "ground"
gap = "y"
slip = "x'"
friction = {}
restitution = 0
[[constraint]]
name = "stop"
gap = "theta - 1.2"
restitution = 0.5
)-",
                       friction);
}
constexpr const char* pendulum = R"-(coordinate = [{name = "theta", start = 1.6}]
lagrangian.kinetic = "theta'^2/2"
lagrangian.potential = "-9.81*cos(theta)"
constraint = [{gap = "theta - 1.2", restitution = 0.5}]
)-";

// The impulses on the ground are in the direction of the pendulum: |p_T|/p = cot 1.2 = 0.389.
TEST_P(FrictionBesideHeld, CartHeldByFrictionStaysWhileItsPendulumBounces) {
    const Trajectory run = ended_run(pendulum_on_cart(0.6), 2.0, 1e-6, GetParam()),
                     alone = ended_run(pendulum, 2.0, 1e-6, GetParam());
    const Event& zeno = zeno_of(run);
    EXPECT_NEAR(zeno.t, zeno_of(alone).t, accuracy());
    EXPECT_EQ(zeno.mode.state(0), ContactState::held);
    EXPECT_NEAR(zeno.truncation->impact_speed, zeno_of(alone).truncation->impact_speed, accuracy());
    EXPECT_NEAR(run.loss, 0.3 * alone.loss, accuracy());
    EXPECT_NEAR(run.end.q[0], 0.0, 1e-12);
    EXPECT_NEAR(balance_of(run), 0.0, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Methods, FrictionBesideHeld, testing::Values(Method::taylor, Method::dopri5));

TEST(FrictionObstacle, NamesTheCartThatIsKicked) {
    const Trajectory run = run_with(pendulum_on_cart(0.3), 2.0, 1e-6);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::undecided);
    EXPECT_NE(
        run.outcome.message.find("not completed because 'ground' changes between sticking and sliding at the impacts"),
        std::string::npos)
        << run.outcome.message;
}

// The friction that the block needs is between what it has under its own weight and what it has with its load.
TEST(FrictionObstacle, NamesTheBlockThatSlidesInFlights) {
    const Trajectory run = run_with(carrier(0.3, 0.0, 0.4), 4.0, 1e-4);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::undecided);
    EXPECT_NE(run.outcome.message.find("not completed because 'incline'"), std::string::npos) << run.outcome.message;
}

TEST(FrictionObstacle, NamesAFrictionThatDependsOnTheSlip) {
    std::string text = carrier(0.3, 1.0, 0.2);
    text.replace(text.find("friction = 0.2"), 14, "friction = \"0.2 + 0.1*exp(-slip)\"");
    const Trajectory run = run_with(text, 4.0, 1e-4);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::undecided);
    EXPECT_NE(
        run.outcome.message.find("'incline' slides with a friction that depends on its slip, and feels the impulses"),
        std::string::npos)
        << run.outcome.message;
}

// What sticks has the coefficient at slip 0, whatever it is at other slips.
TEST(FrictionBesideStribeck, BlockSticksWithAnyCoefficientOfSliding) {
    std::string text = carrier(0.15, 0.0, 0.4);
    text.replace(text.find("friction = 0.4"), 14, "friction = \"0.3 + 0.1*exp(-slip)\"");
    const Trajectory run = ended_run(text, 4.0, 1e-4);
    EXPECT_NEAR(zeno_of(run).t, 3.0, 1e-12);
}

// A bead on a rough sine carries a bouncing mass; a ladder slides while its head bounces on the wall; a block slides on
// two feet while one of them bounces.
struct Slider {
    const char* name;
    const char* text;
    double end;
    Certificate::Tail tail;
};
void PrintTo(const Slider& slider, std::ostream* stream) { *stream << slider.name; }
const Slider sliders[] = {
    {"bead",
     R"-(coordinate = [{name = "x", start = -1, rate = 0.3}, {name = "y", start = "-0.5*sin(1)", rate = "0.15*cos(1)"},
                  {name = "z", start = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2)/2 + (x'^2 + z'^2)/4"
lagrangian.potential = "9.81*y + 9.81/2*z"
constraint = [
  {name = "wire", gap = "y - 0.5*sin(x)", slip = "x' + 0.5*cos(x)*y'", friction = 0.2, restitution = 0},
  {name = "seat", gap = "z - y - 0.2", restitution = 0.5}]
)-",
     1.4, Certificate::Tail::none},
    {"ladder", R"-(coordinate = [{name = "x", start = 1.01, rate = -1}, {name = "y", start = "sqrt(3)"},
                  {name = "phi", start = "120 deg", unit = "rad"}]
world = {gravity = [0, -9.81]}
body = [{name = "ladder", mass = 12, rod = [[-2, 0], [2, 0]], at = ["x", "y"], angle = "phi"}]
ground = [{name = "floor", line = [[0, 0], [4, 0]]}, {name = "wall", line = [[0, 4], [0, 0]]}]
constraint = [
  {name = "foot", between = ["ladder.start", "floor"], friction = 0.3, restitution = 0},
  {name = "head", between = ["ladder.end", "wall"], restitution = 0.3}]
)-",
     0.16, Certificate::Tail::none},
    {"block", R"-(coordinate = [{name = "x", rate = 3}, {name = "y", start = "0.5*cos(0.02) + sin(0.02)"},
                  {name = "phi", start = 0.02}]
world = {gravity = [0, -9.81]}
body = [{name = "block", mass = 1, box = [2, 1], at = ["x", "y"], angle = "phi"}]
ground = [{name = "floor", line = [[-2, 0], [2, 0]]}]
constraint = [
  {name = "left", between = ["block.lower_left", "floor"], friction = 0.3, restitution = 0},
  {name = "right", between = ["block.lower_right", "floor"], friction = 0.3, restitution = 0.5}]
)-",
     0.4, Certificate::Tail::slip},
};
class FrictionSlider : public testing::TestWithParam<Slider> {};

// The cut at w leaves an error of third order: much smaller than the height of the flights, which is of second order.
// The order itself is measured where the error is above rounding.
TEST_P(FrictionSlider, IsCompletedWithThirdOrder) {
    const Slider& slider = GetParam();
    const Trajectory truth = ended_run(slider.text, slider.end, 1e-11);
    EXPECT_EQ(zeno_of(truth).certificate->tail, slider.tail);
    double last = 0.0, last_w = 0.0;
    for (const double eps : {1e-2, 1e-3, 1e-4}) {
        const Trajectory run = ended_run(slider.text, slider.end, eps);
        const double w = zeno_of(run).truncation->impact_speed;
        const double error = (run.end.q - truth.end.q).norm() + (run.end.v - truth.end.v).norm();
        EXPECT_NEAR(balance_of(run), 0.0, 1e-11);
        EXPECT_GE(zeno_of(truth).t, zeno_of(run).certificate->zeno_low - 1e-11);
        EXPECT_LE(zeno_of(truth).t, zeno_of(run).certificate->zeno_high + 1e-11);
        EXPECT_LT(error, 5.0 * w * w * w + 1e-11);
        if (last_w > 1.5 * w && last > 1e-10) {
            EXPECT_GT(std::log(last / error) / std::log(last_w / w), 2.6) << w << " " << error << " " << last;
        }
        last = error;
        last_w = w;
    }
}
INSTANTIATE_TEST_SUITE_P(Systems, FrictionSlider, testing::ValuesIn(sliders),
                         [](const auto& slider) { return std::string(slider.param.name); });

// W = (1, 0.6, 1), a = 1, alpha = -0.3: every impact would gain energy. The first has u/w = -0.3, all others -0.6.
TEST(FrictionCap, SequenceOfCappedImpactsIsCompleted) {
    const std::string text = R"-(coordinate = [{name = "x"}, {name = "y", start = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2 - 1.2*x'*y')/1.28"
lagrangian.potential = "-(0.3/0.64)*x + (0.82/0.64)*y"
constraint = [{gap = "y", restitution = 0.9, slip = "x'", friction = 1.0}]
)-";
    const double first = std::sqrt(0.73), later = 0.8;
    for (const double eps : {10.0, 1e-2, 1e-4, 1e-6}) {
        const Trajectory run = ended_run(text, 12.0, eps);
        const Event& zeno = zeno_of(run);
        EXPECT_LE(zeno.certificate->zeno_low, 1.0 + 2.0 * first / (1.0 - later) + 1e-14);
        EXPECT_GE(zeno.certificate->zeno_high, 1.0 + 2.0 * first / (1.0 - later) - 1e-14);
        if (zeno.truncation->t < 1.1) continue;  // the first impact has another restitution than the sequence after it
        EXPECT_EQ(zeno.certificate->tail, Certificate::Tail::stick);
        EXPECT_NEAR(zeno.t, 1.0 + 2.0 * first / (1.0 - later), 1e-12);
        EXPECT_NEAR(run.end.q[0], -0.15 * (1.0 + 4.0 * first * first / (1.0 - later * later)), 1e-12);
        EXPECT_NEAR(run.loss + run.heat, 0.0, 1e-12);  // an impact neither gains nor loses energy
        EXPECT_NEAR(balance_of(run), 0.0, 1e-12);
    }
}

}  // namespace
}  // namespace achilles
