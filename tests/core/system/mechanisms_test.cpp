// Mechanisms typed as bodies: the reference mechanisms give their events, and the expanded file is the same system.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/systems.hpp"
#include "expression/parse.hpp"
#include "output/output.hpp"
#include "run/trajectory.hpp"
#include "system/units.hpp"

namespace achilles {
namespace {

std::string mechanism_text(const std::string& name) {
    return read_text(test::source_file("tests/reference/mechanisms/" + name + ".toml"));
}

const nlohmann::json& mechanism_results() {
    static const nlohmann::json all =
        nlohmann::json::parse(std::ifstream(test::source_file("tests/reference/mechanisms/events.json")));
    return all;
}

std::vector<std::string> mechanism_names() {
    std::vector<std::string> names;
    for (const auto& [name, result] : mechanism_results().items()) names.push_back(name);
    return names;
}

class ReferenceMechanisms : public testing::TestWithParam<std::string> {};

TEST_P(ReferenceMechanisms, GiveTheirEvents) {
    const std::string& name = GetParam();
    const auto& expected = mechanism_results().at(name)["events"];
    const auto model = std::make_shared<const Model>(parse_system(mechanism_text(name), name + ".toml"));
    const Trajectory run = simulate(model, model->default_run());
    const double tolerance = name == "triple_pendulum" || name == "kneed_leg" ? 1e-7 : 1e-8;
    ASSERT_EQ(run.events.size(), expected.size());
    for (std::size_t i = 0; i < run.events.size(); ++i) {
        EXPECT_EQ(names_of(run.events[i].kind).word, expected[i]["kind"]) << "event " << i;
        EXPECT_NEAR(run.events[i].t, expected[i]["t"].get<double>(), tolerance) << "event " << i;
    }
}

// The expanded file describes the same system, byte for byte, and has nothing left to expand.
TEST_P(ReferenceMechanisms, AreTheirExpandedFiles) {
    const std::string name = GetParam() + ".toml", text = mechanism_text(GetParam());
    const std::string expanded = expand_system(text, name);
    EXPECT_EQ(expand_system(expanded, name), expanded);
    for (const char* key : {"body", "ground", "spring", "between", "world"})
        EXPECT_EQ(expanded.find(std::string("\n") + key + " ="), std::string::npos) << key;
    const auto json_of = [&](const std::string& system) {
        const auto model = std::make_shared<const Model>(parse_system(system, name));
        achilles::Run run = model->default_run();
        run.options.end_time = std::min(run.options.end_time, 2.0);
        return to_json(simulate(model, run));
    };
    EXPECT_EQ(json_of(expanded), json_of(text));
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceMechanisms, testing::ValuesIn(mechanism_names()),
                         [](const auto& one) { return one.param; });

// ---- what is written ----

std::string value_of_key(const std::string& expanded, const std::string& key) {
    const std::size_t at = expanded.find(key + " = \"");
    if (at == expanded.npos) return "";
    const std::size_t begin = at + key.size() + 4;
    return expanded.substr(begin, expanded.find('"', begin) - begin);
}

std::string kinetic_of(const std::string& name) {
    return value_of_key(expand_system(mechanism_text(name), name), "lagrangian.kinetic");
}

// A mechanician would write these: no 1*x, no sum of a negative term, no sin^2 + cos^2.
TEST(ExpandedMechanisms, AreWrittenAsAMechanicianWould) {
    EXPECT_EQ(kinetic_of("double_pendulum"),
              "(m1 + 3*m2)*L1^2/6*theta1'^2 + m2*L1*L2/2*cos(theta2)*theta1'*(theta1' + theta2') + "
              "m2*L2^2/6*(theta1' + theta2')^2");
    EXPECT_EQ(kinetic_of("falling_rod"), "m/2*x'^2 + m/2*y'^2 + m*L^2/24*theta'^2");
    const std::string rod = expand_system(mechanism_text("falling_rod"), "falling_rod");
    EXPECT_EQ(value_of_key(rod, "lagrangian.potential"), "m*g*y");
    EXPECT_EQ(value_of_key(rod, "gap"), "y - L/2*cos(theta)");
    const std::string waves = expand_system(mechanism_text("disc_on_waves"), "disc_on_waves");
    EXPECT_EQ(value_of_key(waves, "lagrangian.potential").find("sqrt(") != std::string::npos, true);
    EXPECT_LT(waves.size(), 2500U);
}

// ---- two ways to say the same ----

struct SameMechanism {
    const char *name, *one, *other;
};

// Two links that hang from a cart: the shape of the lower one, and more tables.
std::string links(const std::string& shape, const std::string& more) {
    return R"toml(coordinate = [{name = "x", rate = 0.5}, {name = "a", start = 0.4}, {name = "b", start = -0.3, rate = 1}]
parameter = [{name = "k", value = 7}, {name = "d", value = 0.4}]
world = {gravity = [0, -9.81], points = {hook = [0.5, 1]}}
body = [
  {name = "cart", mass = 2, box = [0.4, 0.2], at = ["x", 0]},
  {name = "upper", mass = 1, rod = [[0, 0], [0, -0.7]], at = "cart", angle = "a"},
  {name = "lower", mass = 1.5, on = "upper", at = "end", angle = "b", )toml" +
           shape + R"toml(},
]
constraint = [{gap = "50 - x", restitution = 0.5}]
run = {end_time = 1.5, tolerance = 1e-12}
)toml" + more;
}

const SameMechanism same_mechanisms[] = {
    {"BoxAndPolygon", "box = [0.6, 0.3]|", "polygon = [[-0.3, -0.15], [0.3, -0.15], [0.3, 0.15], [-0.3, 0.15]]|"},
    {"PolygonTurnedRound", "polygon = [[0, 0], [0.5, 0], [0.1, 0.4]]|", "polygon = [[0.1, 0.4], [0.5, 0], [0, 0]]|"},
    {"RodAndItsInertia", "rod = [[0, 0], [0, -0.6]]|", "center = [0, -0.3], inertia = \"1.5*0.6^2/12\"|"},
    {"DiscAndItsInertia", "disc = 0.2|", "inertia = \"1.5*0.2^2/2\"|"},
    {"RingAndItsInertia", "ring = 0.2|", "inertia = \"1.5*0.2^2\"|"},
    {"SpringAndForces",
     "rod = [[0, 0], [0, -0.6]]|spring = [{between = [\"lower.end\", \"cart\"], stiffness = \"k\", rest = 0}]",
     "rod = [[0, 0], [0, -0.6]]|force = [{at = \"lower.end\", value = [\"k*(cart.x - lower.end.x)\", \"k*(cart.y - "
     "lower.end.y)\"], against = \"cart\"}]"},
    {"SpringWithLength",
     "rod = [[0, 0], [0, -0.6]]|spring = [{between = [\"lower.end\", \"world.hook\"], stiffness = \"k\", rest = 0.4}]",
     "rod = [[0, 0], [0, -0.6]]|lagrangian.potential = \"k/2*(sqrt((lower.end.x - world.hook.x)^2 + (lower.end.y - "
     "world.hook.y)^2) - 0.4)^2\""},
    {"DamperAndForce",
     "rod = [[0, 0], [0, -0.6]]|damper = [{between = [\"world.hook\", \"lower.end\"], damping = \"d\"}]",
     "rod = [[0, 0], [0, -0.6]]|lagrangian.dissipation = \"d/2*((lower.end.x - world.hook.x)*lower.end.x' + "
     "(lower.end.y - world.hook.y)*lower.end.y')^2/((lower.end.x - world.hook.x)^2 + (lower.end.y - "
     "world.hook.y)^2)\""},
    {"AngleSpringAndTorques",
     "rod = [[0, 0], [0, -0.6]]|spring = [{angle = \"b\", stiffness = 3, rest = 0.2}]\ndamper = [{angle = \"b\", "
     "damping = \"d\"}]",
     "rod = [[0, 0], [0, -0.6]]|torque = [{on = \"lower\", value = \"3*(0.2 - b) - d*(lower.angle' - upper.angle')\", "
     "against = \"upper\"}]"},
    {"OriginByName", "rod = [[0, 0], [0, -0.6]]|force = [{on = \"lower\", at = \"origin\", value = [2, 1]}]",
     "rod = [[0, 0], [0, -0.6]]|force = [{on = \"lower\", at = [0, 0], value = [2, 1]}]"},
    {"FollowerForce", "rod = [[0, 0], [0, -0.6]]|force = [{on = \"lower\", at = \"end\", value = [2, \"x'\"]}]",
     "rod = [[0, 0], [0, -0.6]]|force = [{at = \"lower.end\", value = [\"2*cos(lower.angle) - x'*sin(lower.angle)\", "
     "\"2*sin(lower.angle) + x'*cos(lower.angle)\"]}]"},
};

void PrintTo(const SameMechanism& one, std::ostream* out) { *out << one.name; }

class SameMechanisms : public testing::TestWithParam<SameMechanism> {};

TEST_P(SameMechanisms, MoveAlike) {
    const auto end_of = [](const std::string& shape_and_more) {
        const std::size_t bar = shape_and_more.find('|');
        const auto model = test::typed(links(shape_and_more.substr(0, bar), shape_and_more.substr(bar + 1)));
        return simulate(model, model->default_run()).end;
    };
    const auto one = end_of(GetParam().one), other = end_of(GetParam().other);
    for (Eigen::Index i = 0; i < 3; ++i) {
        EXPECT_NEAR(one.q[i], other.q[i], 1e-10);
        EXPECT_NEAR(one.v[i], other.v[i], 1e-9);
    }
}

INSTANTIATE_TEST_SUITE_P(Said, SameMechanisms, testing::ValuesIn(same_mechanisms),
                         [](const auto& one) { return one.param.name; });

// ---- drawings ----

// A curve in the axes of a body keeps its parameter, with a name that the file does not use.
TEST(DrawingsOnBodies, AreTurnedWithTheirParameter) {
    const SystemDescription system = parse_system(
        links("disc = 0.1",
              "drawing = [{shape = \"curve\", on = \"lower\", over = [\"w\", -1, \"x + 1\"], at = [\"w + x\", "
              "\"w^2\"]}]\n"));
    const auto is_curve = [](const DrawingDescription& each) { return each.shape == DrawingDescription::Shape::curve; };
    const auto curve = std::find_if(system.drawings.begin(), system.drawings.end(), is_curve);
    ASSERT_NE(curve, system.drawings.end());
    Graph graph;
    Scope scope;
    const std::string names[] = {"x", "a", "b", curve->over};
    for (std::uint32_t i = 0; i < 4; ++i) scope.allowed.emplace(names[i], graph.symbol(i));
    const double x = 0.3, a = 0.4, b = -0.7, w = 0.6, u = w + x, v = w * w, angle = a + b;
    const double values[] = {x, a, b, w};
    const auto value = [&](std::size_t i) { return value_of(parse(curve->points[0][i].text, scope, graph), values); };
    EXPECT_NEAR(value(0), x + 0.7 * std::sin(a) + u * std::cos(angle) - v * std::sin(angle), 1e-15);
    EXPECT_NEAR(value(1), -0.7 * std::cos(a) + u * std::sin(angle) + v * std::cos(angle), 1e-15);
    EXPECT_EQ(curve->over_limits[1].text, "x + 1");
}

// ---- names of bodies ----

// Views keep the names of bodies as typed, and every expression that is typed later knows them; a coordinate comes before
// a body with its name.
TEST(NamesOfBodies, StayInViewsAndAreKnownLater) {
    const std::string text = R"toml(coordinate = [{name = "theta", start = 0.3, rate = 2, unit = "rad"}, {name = "s"}]
parameter = [{name = "L", value = 2, unit = "m"}]
body = [
  {name = "arm", mass = 1, rod = [[0, 0], ["L", 0]], angle = "theta"},
  {name = "s", mass = 1, at = ["s", 5]}]
constraint = [{gap = "arm.end.y", restitution = 0}]
view = [{x = "arm.end.x", y = ["2*arm.end.y", "s.y"]}]
)toml";
    const Model model(parse_system(text, "f.toml"));
    const ViewDescription& view = model.description().views.at(0);
    EXPECT_EQ(view.x.text, "arm.end.x");
    EXPECT_EQ(view.y[0].text, "2*arm.end.y");
    EXPECT_EQ(view.name, "2*arm.end.y");
    const auto value = [&](const std::string& expression) {
        const Text typed{expression, {}};
        const Program program = model.compile_view({&typed, 1});
        auto run = model.evaluator<double>(program, model.default_run().parameters);
        const achilles::Run start = model.default_run();
        set_state(run, {start.q, start.v});
        run.run();
        return run.output(0);
    };
    EXPECT_NEAR(value("arm.end.x + s.y"), 2.0 * std::cos(0.3) + 5.0, 1e-15);
    EXPECT_NEAR(value("arm.end.y'"), 4.0 * std::cos(0.3), 1e-15);
    EXPECT_EQ(value("s + 1"), 1.0);
    EXPECT_EQ(unit_of_expression(model.description(), "arm.end.x"), "m");
    EXPECT_EQ(unit_of_expression(model.description(), "arm.angle'"), "rad/s");
    EXPECT_EQ(unit_of_expression(model.description(), "am.end.x"), "");
    try {
        value("1 + arm.edn.x");
        FAIL() << "no such point";
    } catch (const InputError& error) {
        EXPECT_EQ(error.message, "unknown point 'edn' of 'arm'; did you mean 'end'?");
        EXPECT_EQ(error.at.column, 5);
    }
}

// `sweep --print arm.end.x` of a pendulum that touches nothing.
TEST(NamesOfBodies, AreKnownWithoutAContact) {
    const Model model(parse_system(R"toml(coordinate = [{name = "theta", start = 0.3, unit = "rad"}]
body = [{name = "arm", mass = 1, rod = [[0, 0], [2, 0]], angle = "theta"}]
)toml",
                                   "f.toml"));
    const Text typed{"arm.end.x", {}};
    const Program program = model.compile_view({&typed, 1});
    const achilles::Run start = model.default_run();
    auto run = model.evaluator<double>(program, start.parameters);
    set_state(run, {start.q, start.v});
    run.run();
    EXPECT_NEAR(run.output(0), 2.0 * std::cos(0.3), 1e-15);
    EXPECT_EQ(unit_of_expression(model.description(), "arm.angle"), "rad");
}

// ---- prescribed motion ----

// In axes that move and turn with time, a free body moves on a straight line of the world, and a free spin stays.
TEST(PrescribedMotion, LeavesAFreeBodyOnAStraightLine) {
    const auto model = test::typed(
        R"toml(coordinate = [{name = "x", start = 0.4, rate = 0.3}, {name = "y", start = -0.2}, {name = "phi", rate = 2}]
body = [
  {name = "table", at = ["0.3*sin(2*t)", "0.1*t^2"], angle = "0.7*t + 0.2*t^2"},
  {name = "free", mass = 2, inertia = 0.5, rod = [[0, 0], [0.6, 0]], center = [0.2, 0], on = "table", at = ["x", "y"], angle = "phi"},
]
constraint = [{gap = "100 - x", restitution = 0.5}]
run = {end_time = 2.0, tolerance = 1e-13}
)toml");
    const Trajectory run = simulate(model, model->default_run());
    const auto center = [](double t, const Vector& q, const Vector& v) {
        const double a = 0.7 * t + 0.2 * t * t, w = 0.7 + 0.4 * t, c = std::cos(a), s = std::sin(a);
        const double b = a + q[2], spin = w + v[2];
        return std::array{
            0.3 * std::sin(2 * t) + c * q[0] - s * q[1] + 0.2 * std::cos(b),
            0.1 * t * t + s * q[0] + c * q[1] + 0.2 * std::sin(b),
            0.6 * std::cos(2 * t) + c * (v[0] - w * q[1]) - s * (v[1] + w * q[0]) - 0.2 * spin * std::sin(b),
            0.2 * t + s * (v[0] - w * q[1]) + c * (v[1] + w * q[0]) + 0.2 * spin * std::cos(b), spin};
    };
    const achilles::Run start = model->default_run();
    const auto begin = center(0.0, start.q, start.v), end = center(2.0, run.end.q, run.end.v);
    EXPECT_NEAR(end[0], begin[0] + 2.0 * begin[2], 1e-10);
    EXPECT_NEAR(end[1], begin[1] + 2.0 * begin[3], 1e-10);
    for (std::size_t i = 2; i < 5; ++i) EXPECT_NEAR(end[i], begin[i], 1e-10) << i;
}

}  // namespace
}  // namespace achilles
