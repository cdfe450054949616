// Friction as read: slip rows, levels, what is dropped, what is refused.
#include <gtest/gtest.h>

#include "check/check.hpp"
#include "core/system/mistakes.hpp"
#include "core/systems.hpp"
#include "enclose/enclosure.hpp"
#include "output/output.hpp"
#include "system/units.hpp"

namespace achilles {
namespace {

// A ball on waves, whose surface moves, with a Stribeck curve; and a rough axle.
const std::string on_waves = R"toml(title = "w"
coordinate = [{name = "x", start = 0.3, rate = 0.7, unit = "m"}, {name = "y", start = 2, rate = -0.2, unit = "m"},
    {name = "phi", rate = 3, unit = "rad"}]
parameter = [{name = "mu", value = 0.3}, {name = "V", value = 0.25, unit = "m/s"},
    {name = "tau", value = 0.01, unit = "N*m"}, {name = "m", value = 1, unit = "kg"}, {name = "L", value = 1, unit = "m"}]
lagrangian.kinetic = "m/2*(x'^2 + y'^2) + m/8*(L*phi')^2"
lagrangian.potential = "y"
[[constraint]]
name = "waves"
gap = "y - sin(x)"
slip = "x' + cos(x)*y' - V*cos(t)"
friction = "mu + exp(-slip)/10"
static_friction = "mu + 0.2"
restitution = 0.5
[[constraint]]
name = "smooth"
gap = "x + 5"
slip = "y'"
restitution = 0.5
[[constraint]]
name = "foot"
gap = "4 - x"
slip = "y'"
friction = "inf"
restitution = 0.5
[[friction]]
name = "axle"
slip = "2*phi'"
level = "tau*(1 + slip^2)"
)toml";

// The value of an expression of the equations at the start of the run, with this sliding speed.
double at_start(const Model& model, Expression e, double speed = 0.0) {
    const Run run = model.default_run();
    std::vector<double> values(model.layout().count(), 0.0);
    for (std::size_t i = 0; i < model.layout().dof; ++i) {
        values[model.layout().q(i)] = run.q[static_cast<Eigen::Index>(i)];
        values[model.layout().v(i)] = run.v[static_cast<Eigen::Index>(i)];
    }
    for (std::size_t i = 0; i < run.parameters.size(); ++i) values[model.layout().parameter(i)] = run.parameters[i];
    values[model.layout().sliding_speed()] = speed;
    return value_of(e, values);
}

TEST(Friction, IsReadWithItsSlipRow) {
    const auto model = test::typed(on_waves);
    const auto& frictions = model->equations().friction;
    ASSERT_EQ(frictions.size(), 3u);  // waves, foot, axle
    EXPECT_EQ(model->layout().frictions, 3u);
    const FrictionLaw &waves = frictions.at(0), &foot = frictions.at(2), &axle = frictions.at(joint_number(0));
    ASSERT_EQ(waves.d.size(), 3u);
    EXPECT_DOUBLE_EQ(at_start(*model, waves.d[0]), 1.0);
    EXPECT_DOUBLE_EQ(at_start(*model, waves.d[1]), std::cos(0.3));
    EXPECT_DOUBLE_EQ(at_start(*model, waves.d[2]), 0.0);
    EXPECT_DOUBLE_EQ(at_start(*model, waves.c), -0.25);
    EXPECT_DOUBLE_EQ(at_start(*model, waves.slip), 0.7 - 0.2 * std::cos(0.3) - 0.25);
    EXPECT_DOUBLE_EQ(at_start(*model, waves.level, 0.5), 0.3 + std::exp(-0.5) / 10.0);
    EXPECT_DOUBLE_EQ(at_start(*model, waves.static_level, 0.5), 0.5);
    EXPECT_TRUE(foot.never_slides);
    EXPECT_FALSE(waves.never_slides);
    EXPECT_DOUBLE_EQ(at_start(*model, axle.d[2]), 2.0);
    EXPECT_DOUBLE_EQ(at_start(*model, axle.level, 0.5), 0.0125);
    EXPECT_DOUBLE_EQ(at_start(*model, axle.static_level, 0.5), 0.01);  // the level at slip 0
}

TEST(Friction, IsNamedInViewsWithUnits) {
    const SystemDescription system = parse_system(on_waves);
    EXPECT_EQ(sliding_names(system, "slip"), (std::vector<std::string>{"slip_waves", "slip_foot", "slip_axle"}));
    EXPECT_EQ(unit_of_expression(system, "slip_waves"), "m/s");
    EXPECT_EQ(unit_of_expression(system, "slip_axle"), "rad/s");
    EXPECT_EQ(unit_of_expression(system, "friction_force_waves"), "N");
    EXPECT_EQ(unit_of_expression(system, "friction_force_axle"), "N*m");
    EXPECT_EQ(unit_of_expression(system, "heat"), "J");
    const Model model(system);
    const Text texts[] = {{"slip_waves + heat + friction_force_axle", {}}};
    const Program view = model.compile_view(texts);
    auto value = model.evaluator(view, model.default_run().parameters);
    set_state(value, model.default_run().start());
    value.input(model.layout().heat()) = 10.0;
    value.input(model.layout().friction_force(2)) = 100.0;
    value.run();
    EXPECT_DOUBLE_EQ(value.output(0), 110.0 + 0.45 - 0.2 * std::cos(0.3));
}

// Zero after folding is no friction: the description, the slots and the run are those of the file without it.
TEST(Friction, ThatFoldsToZeroIsDropped) {
    const std::string rough =
        test::changed(test::good, {{"restitution = \"e\"", "slip = \"x'\"\nfriction = FRICTION\nrestitution = \"e\""}});
    const auto smooth =
        test::typed(test::changed(test::good, {{"restitution = \"e\"", "slip = \"x'\"\nrestitution = \"e\""}}));
    const std::string run = to_json(simulate(smooth, smooth->default_run()));
    for (const char* zero : {"0", "0.0", "\"0\"", "\"0*m\"", "\"m - m\"", "\"0*slip\"", "0\nstatic_friction = 0"}) {
        const auto model = test::typed(test::changed(rough, {{"FRICTION", zero}}));
        EXPECT_FALSE(model->description().has_friction()) << zero;
        EXPECT_EQ(model->layout().count(), smooth->layout().count()) << zero;
        EXPECT_EQ(to_json(simulate(model, model->default_run())), run) << zero;
    }
    for (const char* friction : {"\"m\"", "\"inf\"", "inf", "1e-300", "0\nstatic_friction = 0.1"})
        EXPECT_TRUE(parse_system(test::changed(rough, {{"FRICTION", friction}})).has_friction()) << friction;
    // Of several, the others stay.
    const SystemDescription system = parse_system(test::changed(
        on_waves, {{"friction = \"mu + exp(-slip)/10\"\nstatic_friction = \"mu + 0.2\"", "friction = 0"},
                   {"[[friction]]", "[[friction]]\nname = \"first\"\nslip = \"x'\"\nlevel = 0\n[[friction]]"}}));
    EXPECT_EQ(sliding_names(system, "slip"), (std::vector<std::string>{"slip_foot", "slip_axle"}));
    EXPECT_EQ(system.frictions.size(), 1u);
}

// On a curve the gap is not a distance, so the reader divides the slip in the coefficient by its scale.
TEST(Friction, OfBodiesTakesTheSlidingSpeed) {
    const auto text = [](const char* curve, const char* more) {
        return fmt::format(
            R"toml(coordinate = [{{name = "x", start = 0.3, rate = 0.7}}, {{name = "y", start = 2, rate = -0.2}}]
parameter = [{{name = "v0", value = 0.5}}]
body = [{{name = "ball", mass = 1, at = ["x", "y"]}}]
ground = [{{name = "waves", curve = "{}", over = [-5, 5]}}]
constraint = [
    {{between = ["ball", "waves"]{}, friction = "0.1 + slip*exp(-slip/v0)", static_friction = "ball.y/10", restitution = 0.5}}
]
)toml",
            curve, more);
    };
    const double speed = std::abs(0.7 - 0.2 * std::cos(0.3)) / std::sqrt(1.0 + std::cos(0.3) * std::cos(0.3));
    const double expected = 0.1 + speed * std::exp(-speed / 0.5);
    for (const char* more : {"", ", normal = true"}) {
        const auto model = test::typed(text("sin(x)", more));
        const FrictionLaw& law = model->equations().friction.at(0);
        EXPECT_NEAR(at_start(*model, law.level, std::abs(at_start(*model, law.slip))), expected, 1e-15) << more;
        EXPECT_NEAR(at_start(*model, law.static_level), 0.2, 1e-15);
        // The expanded file is the same system.
        const auto expanded = test::typed(expand_system(text("sin(x)", more), "e.toml"));
        const FrictionLaw& same = expanded->equations().friction.at(0);
        EXPECT_NEAR(at_start(*expanded, same.level, std::abs(at_start(*expanded, same.slip))), expected, 1e-15);
    }
    const auto flat = test::typed(text("0*x", ""));
    EXPECT_EQ(flat->description().constraints[0].friction.text, "0.1 + slip*exp(-slip/v0)");
}

TEST(Friction, IsPrintedByCheck) {
    const auto model = test::typed(on_waves);
    double disagreement = 1.0;
    const std::string answer = check_answer(*model, model->default_run(), disagreement);
    EXPECT_LT(disagreement, max_disagreement);
    EXPECT_NE(
        answer.find("\nFriction\n"
                    "  waves  slip = x' + cos(x)*y' - V*cos(t), coefficient mu + exp(-slip)/10 = 0.3772 at the start, "
                    "static mu + 0.2 = 0.5\n"
                    "  foot   slip = y', never slides\n"
                    "  axle   slip = 2*phi', level tau*(1 + slip^2) = 0.37 N m at the start\n"),
        answer.npos)
        << answer;
}

// Runs are covered; a proof refuses the file at its first friction.
TEST(Friction, IsNotCoveredByProofs) {
    const auto model = test::typed(on_waves);
    const auto refusal = [](const auto& start) {
        try {
            start();
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal([&] { check(*model, problem_from_decimals(model->default_run())); }),
              "typed.toml:12:13: a proof does not cover dry friction\n"
              "    friction = \"mu + exp(-slip)/10\"\n"
              "                ^\n"
              "achilles simulate runs this system, with an estimate of its error");
}

}  // namespace
}  // namespace achilles
