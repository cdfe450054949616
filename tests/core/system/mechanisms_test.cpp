// Mechanisms typed as bodies: the reference mechanisms give their events, the expanded file is the same system, and slips
// are the differences of the velocities of material points.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "core/systems.hpp"
#include "expression/parse.hpp"
#include "output/output.hpp"
#include "run/trajectory.hpp"

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

// ---- slips ----

// Contact of a disc or a point with something that moves, turns and drifts. The frame of the touched body has the origin
// (u + 0.3 sin t, w) and the angle psi + 0.2 t; what touches is at (x, y) with the angle phi.
struct SlipCase {
    const char* name;
    const char* touched;  // the body or ground `t`
    const char* touches;  // the body `a`
    const char* between;
    // In the frame of the touched body, by a parameter: the place of contact, the normal, and the surface velocity.
    std::function<std::array<double, 2>(double)> place, normal;
    double radius, speed;
    std::function<double(double, double)> scale;  // of the slip, at the parameter and time
    double moving = 0.0;                          // factor of cos(t) in the velocity along y of the touched material
};

constexpr double line_angle = 0.4;

std::array<double, 2> along_circle(double s) { return {std::cos(s), std::sin(s)}; }

const SlipCase slip_cases[] = {
    {"DiscOnLine",
     R"toml(ground = [{name = "t", line = [[0.1, 0.2], ["0.1 + cos(al)", "0.2 + sin(al)"]], on = "base", speed = 0.7}])toml",
     "disc = 0.3",
     R"toml(["a", "t"])toml",
     [](double s) {
         return std::array{0.1 + s * std::cos(line_angle), 0.2 + s * std::sin(line_angle)};
     },
     [](double) {
         return std::array{-std::sin(line_angle), std::cos(line_angle)};
     },
     0.3,
     0.7,
     {}},
    {"PointOnRod",
     R"toml(body = [{name = "t", rod = [[0, 0], [0, 2]], on = "base"}])toml",
     "points = {tip = [0, 0]}",
     R"toml(["a.tip", "t"])toml",
     [](double s) {
         return std::array{0.0, s};
     },
     [](double) {
         return std::array{-1.0, 0.0};
     },
     0.0,
     0.0,
     {}},
    {"DiscOnDisc",
     R"toml(body = [{name = "t", disc = 0.5, on = "base"}])toml",
     "disc = 0.3",
     R"toml(["a", "t"])toml",
     [](double s) {
         return std::array{0.5 * std::cos(s), 0.5 * std::sin(s)};
     },
     along_circle,
     0.3,
     0.0,
     {}},
    {"DiscInRing",
     R"toml(ground = [{name = "t", ring = 2, on = "base", speed = -0.4}])toml",
     "disc = 0.3",
     R"toml(["a", "t"])toml",
     [](double s) {
         return std::array{2.0 * std::cos(s), 2.0 * std::sin(s)};
     },
     [](double s) {
         return std::array{-std::cos(s), -std::sin(s)};
     },
     0.3,
     -0.4,
     {}},
    {"PointOnCurve",
     R"toml(ground = [{name = "t", curve = "0.3*sin(x) + 0.1*sin(t)", over = [-5, 5], on = "base", speed = 0.2}])toml",
     "points = {tip = [0, 0]}", R"toml(["a.tip", "t"])toml",
     [](double s) {
         return std::array{s, 0.3 * std::sin(s)};
     },
     [](double s) {
         const double slope = 0.3 * std::cos(s), k = std::sqrt(1 + slope * slope);
         return std::array{-slope / k, 1 / k};
     },
     0.0, 0.2, [](double s, double) { return std::sqrt(1 + 0.09 * std::cos(s) * std::cos(s)); }, 0.1},
};

std::string slip_system(const SlipCase& one) {
    const std::string touched = one.touched;
    const bool is_ground = touched.starts_with("ground");
    std::string text =
        R"toml(coordinate = [{name = "x"}, {name = "y"}, {name = "phi"}, {name = "u"}, {name = "w"}, {name = "psi"}]
parameter = [{name = "al", value = 0.4}]
[[body]]
name = "base"
mass = 2
inertia = 3
at = ["u + 0.3*sin(t)", "w"]
angle = "psi + 0.2*t"
[[body]]
name = "a"
mass = 1
inertia = 1
at = ["x", "y"]
angle = "phi"
)toml" + std::string(one.touches) +
        "\n";
    // The touched table is inline; the arrays of tables above are written out.
    const std::size_t open = touched.find('{'), close = touched.rfind('}');
    std::string inner = touched.substr(open + 1, close - open - 1);
    text += is_ground ? "[[ground]]\n" : "[[body]]\n";
    int depth = 0;
    for (const char c : inner) {
        depth += (c == '[' || c == '{') - (c == ']' || c == '}');
        text += c == ',' && depth == 0 ? '\n' : c;
    }
    return text + "\n[[constraint]]\nrestitution = 0.5\nbetween = " + one.between + "\n";
}

void PrintTo(const SlipCase& one, std::ostream* out) { *out << one.name; }

class Slips : public testing::TestWithParam<SlipCase> {};

TEST_P(Slips, AreDifferencesOfVelocitiesOfMaterialPoints) {
    const SlipCase& one = GetParam();
    const SystemDescription system = parse_system(slip_system(one), "slip.toml");
    Graph graph;
    Scope scope;
    const char* const names[] = {"x", "y", "phi", "u", "w", "psi", "x'", "y'", "phi'", "u'", "w'", "psi'", "al", "t"};
    for (std::uint32_t i = 0; i < 14; ++i) scope.allowed.emplace(names[i], graph.symbol(i));
    const Expression slip = parse(system.constraints[0].slip.text, scope, graph),
                     gap = parse(system.constraints[0].gap.text, scope, graph);
    std::mt19937 random(41);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int state = 0; state < 1000; ++state) {
        double values[14];
        for (double& value : values) value = uniform(random);
        values[12] = line_angle;
        const double s = 3.0 * uniform(random), t = values[13];
        const double angle = values[5] + 0.2 * t, c = std::cos(angle), d = std::sin(angle), turn = values[11] + 0.2;
        std::array<double, 2> place = one.place(s);
        place[1] += one.moving * std::sin(t);
        const auto [nx, ny] = one.normal(s);
        const auto turned = [&](double x, double y) { return std::array{c * x - d * y, d * x + c * y}; };
        const auto lever = turned(place[0], place[1]), n = turned(nx, ny);
        const double origin[] = {values[3] + 0.3 * std::sin(t), values[4]};
        values[0] = origin[0] + lever[0] + one.radius * n[0];
        values[1] = origin[1] + lever[1] + one.radius * n[1];
        ASSERT_NEAR(value_of(gap, values), 0.0, 1e-14);
        const double spin = values[8];
        const double touches[] = {values[6] + spin * one.radius * n[1], values[7] - spin * one.radius * n[0]};
        const auto material = turned(0.0, one.moving * std::cos(t));
        const double touched[] = {values[9] + 0.3 * std::cos(t) - turn * lever[1] + material[0] + one.speed * n[1],
                                  values[10] + turn * lever[0] + material[1] - one.speed * n[0]};
        const double expected =
            ((touches[0] - touched[0]) * n[1] - (touches[1] - touched[1]) * n[0]) * (one.scale ? one.scale(s, t) : 1.0);
        const double largest =
            std::max({std::abs(touches[0]), std::abs(touches[1]), std::abs(touched[0]), std::abs(touched[1])});
        EXPECT_NEAR(value_of(slip, values), expected, 1e-14 * largest)
            << "state " << state << ": " << system.constraints[0].slip.text;
    }
}

INSTANTIATE_TEST_SUITE_P(OfPairs, Slips, testing::ValuesIn(slip_cases), [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace achilles
