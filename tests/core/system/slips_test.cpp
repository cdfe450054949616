// Slips of contacts between shapes: at h = 0 each is the difference of the velocities of the two material points, for every
// pair that can touch, on grounds and bodies that move, turn and drift with time.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/systems.hpp"
#include "expression/parse.hpp"

namespace achilles::slips_of_pairs {
namespace {

// A number and its rate.
struct Dual {
    double value = 0.0, rate = 0.0;
};
Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.rate + b.rate}; }
Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.rate - b.rate}; }
Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.rate * b.value + a.value * b.rate}; }
Dual operator/(Dual a, Dual b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.rate - quotient * b.rate) / b.value};
}
Dual number(double value) { return {value, 0.0}; }
Dual sine(Dual a) { return {std::sin(a.value), std::cos(a.value) * a.rate}; }
Dual cosine(Dual a) { return {std::cos(a.value), -std::sin(a.value) * a.rate}; }
Dual root(Dual a) { return {std::sqrt(a.value), a.rate / (2.0 * std::sqrt(a.value))}; }

using Vector2 = std::array<Dual, 2>;
Vector2 operator+(const Vector2& a, const Vector2& b) { return {a[0] + b[0], a[1] + b[1]}; }
Vector2 turned(const Vector2& a, Dual angle) {
    const Dual c = cosine(angle), s = sine(angle);
    return {c * a[0] - s * a[1], s * a[0] + c * a[1]};
}
// The velocity of a point that is fixed in a body: of the body's origin, its spin, and the point's place from there.
std::array<double, 2> material(const Vector2& origin, double spin, double dx, double dy) {
    return {origin[0].rate - spin * dy, origin[1].rate + spin * dx};
}

// The contact of the body `a`, or of one of its points, with `t`, which is on the frame `base`. That has the origin
// (u + 0.3 sin t, w) and the angle psi + 0.2 t. `a` is at (x, y), or on the ground `t` at [x, radius + y].
struct SlipCase {
    const char *name, *touched, *touches, *constraint;
    // In the axes of `base`, by a parameter and time: the place of contact, and the direction in which the parameter moves
    // it. The free side is on the left of that direction, or on its right.
    std::function<Vector2(Dual, Dual)> place, direction;
    bool is_free_on_left = true;
    double radius = 0.0, speed = 0.0;
    std::array<double, 2> corner{};                 // what touches, in the axes of `a`
    std::function<double(double, double)> scale{};  // of the slip; default: 1
    bool is_on_ground = false;
};
void PrintTo(const SlipCase& one, std::ostream* out) { *out << one.name; }

constexpr double line_angle = 0.4;
Vector2 on_line(Dual s, Dual) {
    return {number(0.1) + s * number(std::cos(line_angle)), number(0.2) + s * number(std::sin(line_angle))};
}
Vector2 along_line(Dual, Dual) { return {number(std::cos(line_angle)), number(std::sin(line_angle))}; }
Vector2 on_rod(Dual s, Dual) { return {number(0.0), s}; }
Vector2 along_rod(Dual, Dual) { return {number(0.0), number(1.0)}; }
template <int tenths>
Vector2 on_circle(Dual s, Dual) {
    return {number(tenths / 10.0) * cosine(s), number(tenths / 10.0) * sine(s)};
}
Vector2 along_circle(Dual s, Dual) { return {number(-1.0) * sine(s), cosine(s)}; }
Vector2 on_curve(Dual s, Dual t) { return {s, number(0.3) * sine(s) + number(0.1) * sine(t + s)}; }
Vector2 along_curve(Dual s, Dual t) { return {number(1.0), number(0.3) * cosine(s) + number(0.1) * cosine(t + s)}; }
double height_scale(double s, double t) {
    const double slope = 0.3 * std::cos(s) + 0.1 * std::cos(t + s);
    return std::sqrt(1.0 + slope * slope);
}

const char* const line = R"toml([[ground]]
line = [[0.1, 0.2], ["0.1 + cos(al)", "0.2 + sin(al)"]]
speed = 0.7)toml";
const char* const rod = "[[body]]\nrod = [[0, 0], [0, 2]]";
const char* const curve = R"toml([[ground]]
curve = "0.3*sin(x) + 0.1*sin(t + x)"
over = [-5, 5]
speed = 0.2)toml";
const char* const tip = "points = {tip = [0.5, -0.2]}";
const char* const box = "box = [0.4, 0.2]";
const char* const disc = "disc = 0.3";
const char* const of_tip = R"(between = ["a.tip", "t"])";
const char* const of_corner = R"(between = ["a.upper_left", "t"])";
const char* const whole = R"(between = ["a", "t"])";
constexpr std::array<double, 2> at_tip{0.5, -0.2}, at_corner{-0.2, 0.1}, at_origin{};

const SlipCase slip_cases[] = {
    {"PointOnLine", line, tip, of_tip, on_line, along_line, true, 0.0, 0.7, at_tip},
    {"CornerOnLine", line, box, of_corner, on_line, along_line, true, 0.0, 0.7, at_corner},
    {"DiscOnLine", line, disc, whole, on_line, along_line, true, 0.3, 0.7},
    {"PointOnRod", rod, tip, of_tip, on_rod, along_rod, true, 0.0, 0.0, at_tip},
    {"DiscOnRod", rod, disc, whole, on_rod, along_rod, true, 0.3},
    {"CornerOnDisc", "[[body]]\ndisc = 0.5", box, of_corner, on_circle<5>, along_circle, false, 0.0, 0.0, at_corner},
    {"DiscOnDisc", "[[body]]\ndisc = 0.5", disc, whole, on_circle<5>, along_circle, false, 0.3},
    {"DiscOnDrivenDisc", "[[ground]]\ndisc = 0.5\nspeed = 0.3", disc, whole, on_circle<5>, along_circle, false, 0.3,
     0.3},
    {"PointInRing", "[[body]]\nring = 2", tip, of_tip, on_circle<20>, along_circle, true, 0.0, 0.0, at_tip},
    {"DiscInRing", "[[body]]\nring = 2", disc, whole, on_circle<20>, along_circle, true, 0.3},
    {"DiscInDrivenRing", "[[ground]]\nring = 2\nspeed = -0.4", disc, whole, on_circle<20>, along_circle, true, 0.3,
     -0.4},
    {"PointOnCurve", curve, tip, of_tip, on_curve, along_curve, true, 0.0, 0.2, at_tip, height_scale},
    {"CornerOnCurve", curve, box, of_corner, on_curve, along_curve, true, 0.0, 0.2, at_corner, height_scale},
    {"PointOnCurveAlongItsNormal", curve, tip, "between = [\"a.tip\", \"t\"]\nnormal = true", on_curve, along_curve,
     true, 0.0, 0.2, at_tip},
    {"DiscOnCurve", curve, disc, whole, on_curve, along_curve, true, 0.3, 0.2, at_origin, {}, true},
    {"DiscPlacedOnLine", line, disc, whole, on_line, along_line, true, 0.3, 0.7, at_origin, {}, true},
    {"PointPlacedOnLine", line, "", whole, on_line, along_line, true, 0.0, 0.7, at_origin, {}, true},
    {"DiscPlacedOnDisc",
     "[[ground]]\ndisc = 0.5\nspeed = 0.3",
     disc,
     whole,
     on_circle<5>,
     along_circle,
     false,
     0.3,
     0.3,
     at_origin,
     {},
     true},
    {"DiscPlacedInRing",
     "[[ground]]\nring = 2\nspeed = -0.4",
     disc,
     whole,
     on_circle<20>,
     along_circle,
     true,
     0.3,
     -0.4,
     at_origin,
     {},
     true},
};

// `m` is what moves with x, y and phi, so that `a` may be placed where its inertia would depend on time.
std::string slip_system(const SlipCase& one) {
    return R"toml(coordinate = [{name = "x"}, {name = "y"}, {name = "phi"}, {name = "u"}, {name = "w"}, {name = "psi"}]
parameter = [{name = "al", value = 0.4}]
[[body]]
name = "base"
mass = 2
inertia = 3
at = ["u + 0.3*sin(t)", "w"]
angle = "psi + 0.2*t"
[[body]]
name = "m"
mass = 1
inertia = 1
at = ["x", "y"]
angle = "phi"
[[body]]
name = "a"
angle = "phi"
)toml" +
           (one.is_on_ground ? fmt::format("on = \"t\"\nat = [\"x\", \"{} + y\"]\n", one.radius)
                             : std::string("at = [\"x\", \"y\"]\n")) +
           one.touches + "\n" + one.touched + "\nname = \"t\"\non = \"base\"\n[[constraint]]\nrestitution = 0.5\n" +
           one.constraint + "\n";
}

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
        if (one.is_on_ground) values[1] = 0.0;
        const auto coordinate = [&](std::size_t i) { return Dual{values[i], values[6 + i]}; };
        const Dual t{values[13], 1.0}, phi = coordinate(2), angle = coordinate(5) + number(0.2) * t;
        const Vector2 base{coordinate(3) + number(0.3) * sine(t), coordinate(4)};
        const Dual s = one.is_on_ground ? coordinate(0) : number(3.0 * uniform(random));
        // The place of contact, the normal towards what touches, and the tangent, which is the normal turned right.
        const auto normal_at = [&](Dual at, Dual time) {
            const Vector2 e = one.direction(at, time);
            const Dual length = number(one.is_free_on_left ? 1.0 : -1.0) * root(e[0] * e[0] + e[1] * e[1]);
            return Vector2{number(-1.0) * e[1] / length, e[0] / length};
        };
        const Vector2 local = one.place(s, t), local_n = normal_at(s, t);
        const Vector2 place = turned(local, number(angle.value)), n = turned(local_n, number(angle.value));
        const double nx = n[0].value, ny = n[1].value, r = one.radius;
        Vector2 origin;
        double spin = phi.rate, corner[] = {0.0, 0.0};
        if (one.is_on_ground) {
            const Dual d = number(r) + coordinate(1);
            origin = base + turned({local[0] + d * local_n[0], local[1] + d * local_n[1]}, angle);
            spin += angle.rate + local_n[0].value * local_n[1].rate - local_n[1].value * local_n[0].rate;
        } else {
            const double c = std::cos(phi.value), k = std::sin(phi.value);
            corner[0] = c * one.corner[0] - k * one.corner[1];
            corner[1] = k * one.corner[0] + c * one.corner[1];
            values[0] = base[0].value + place[0].value + r * nx - corner[0];
            values[1] = base[1].value + place[1].value + r * ny - corner[1];
            origin = {coordinate(0), coordinate(1)};
        }
        ASSERT_NEAR(value_of(gap, values), 0.0, 1e-14) << system.constraints[0].gap.text;
        const auto touching = material(origin, spin, corner[0] - r * nx, corner[1] - r * ny);
        // The points of a curve that moves with t stay at their abscissa.
        const Vector2 drift = one.place(number(s.value), t);
        const Vector2 moved = turned({number(drift[0].rate), number(drift[1].rate)}, number(angle.value));
        auto touched = material(base, angle.rate, place[0].value, place[1].value);
        touched = {touched[0] + moved[0].value + one.speed * ny, touched[1] + moved[1].value - one.speed * nx};
        const double expected = ((touching[0] - touched[0]) * ny - (touching[1] - touched[1]) * nx) *
                                (one.scale ? one.scale(s.value, t.value) : 1.0);
        const double largest =
            std::max({std::abs(touching[0]), std::abs(touching[1]), std::abs(touched[0]), std::abs(touched[1])});
        EXPECT_NEAR(value_of(slip, values), expected, 1e-14 * largest)
            << "state " << state << ": " << system.constraints[0].slip.text;
    }
}

INSTANTIATE_TEST_SUITE_P(OfPairs, Slips, testing::ValuesIn(slip_cases), [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace achilles::slips_of_pairs
