// Laws of mechanisms that are typed as bodies, on random ones: the expanded file gives the same bytes, energy and work
// balance although time moves parts of them, and a mirrored world, a shifted one, or another order of the bodies changes
// no motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/systems.hpp"
#include "output/output.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {
namespace {

// The world in which a mechanism is typed.
struct World {
    double mirror = 1.0;  // -1: left and right are exchanged
    double dx = 0.0, dy = 0.0;
    bool is_reversed = false;  // the bodies stand in reverse order
};

// A tree of one to three bodies with springs, dampers, forces and contacts. The first is free in the plane, or in the axes
// of a frame that time moves.
class RandomMechanism {
 public:
    RandomMechanism(std::uint64_t seed, const World& world) : engine_(seed), world_(world) {}

    std::string text() {
        const bool is_carried = chance(0.4), turns = chance(0.5);
        const int count = 1 + static_cast<int>(3.0 * uniform(0.0, 1.0));
        const double hook_x = uniform(-0.5, 0.5), gravity_x = chance(0.3) ? uniform(-1.0, 1.0) : 0.0;
        if (is_carried) {
            const std::string sway = fmt::format("{:.3f}*sin({:.3f}*t)", uniform(0.02, 0.1), uniform(2.0, 6.0));
            bodies_.push_back(fmt::format("name = \"frame\", at = {}{}", point(sway, "0.05*cos(3*t)"),
                                          turns ? ", angle = " + angle("0.2*sin(2*t)") : ""));
        }
        coordinate("x", uniform(-0.3, 0.3), uniform(-1.0, 1.0));
        coordinate("y", uniform(1.6, 2.0), uniform(-1.0, 1.0));
        coordinate("a0", uniform(-1.0, 1.0), uniform(-1.0, 1.0));
        const std::string place = is_carried ? "on = \"frame\", at = " + local("x", "y") : "at = " + point("x", "y");
        bodies_.push_back(fmt::format("name = \"b0\", {}, angle = {}, {}", place, angle("a0"), shape(true)));
        for (int k = 1; k < count; ++k) {
            coordinate(fmt::format("a{}", k), uniform(-1.0, 1.0), uniform(-1.0, 1.0));
            bodies_.push_back(fmt::format("name = \"b{}\", on = \"b{}\", at = {}, angle = {}, {}", k, k - 1,
                                          local(decimal(uniform(-0.2, 0.2)), decimal(uniform(-0.2, 0.2))),
                                          angle(fmt::format("a{}", k)), shape(false)));
        }
        if (world_.is_reversed) std::reverse(bodies_.begin(), bodies_.end());
        const std::string last = fmt::format("b{}", count - 1);
        std::string more;
        if (chance(0.6))
            more +=
                fmt::format("spring = [{{between = [\"world.hook\", \"{}.p\"], stiffness = {:.3f}, rest = {:.3f}}}]\n",
                            last, uniform(1.0, 20.0), uniform(0.0, 1.0));
        if (chance(0.6))
            more += fmt::format(
                "damper = [{{between = [\"world.hook\", \"{}\"], damping = {:.3f}}}, "
                "{{angle = \"a0\", damping = 0.1}}]\n",
                last, uniform(0.0, 1.0));
        if (chance(0.5))
            more += fmt::format(
                "force = [{{on = \"{0}\", at = \"p\", value = {1}}}, {{at = \"{0}\", value = {2}, against = "
                "\"world.hook\"}}]\n",
                last, local("0.3*cos(t)", "0.2"), local("-0.1*x'", "0.5*sin(2*t)"));
        if (chance(0.5))
            more += fmt::format("torque = [{{on = \"{}\", value = {}}}]\n", last,
                                angle(fmt::format("{:.3f}*sin(t) - 0.1*a0'", uniform(-0.5, 0.5))));
        return coordinates_ + "]\nparameter = [{name = \"m\", value = 1.3}, {name = \"g\", value = 9.81}]\n" +
               fmt::format("world = {{gravity = {}, points = {{hook = {}}}}}\nbody = [\n",
                           local(decimal(gravity_x), "-g"), point(decimal(hook_x), "2.6")) +
               joined(bodies_) + "]\n" + more + grounds(is_carried) + contacts() + "run = {end_time = 1.2}\n";
    }

 private:
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    bool chance(double part) { return uniform(0.0, 1.0) < part; }
    static std::string decimal(double value) { return fmt::format("{:.4f}", value); }
    static std::string joined(const std::vector<std::string>& tables) {
        std::string text;
        for (const std::string& table : tables) text += "  {" + table + "},\n";
        return text;
    }
    std::string mirrored(const std::string& value) const { return world_.mirror < 0.0 ? "-(" + value + ")" : value; }
    std::string angle(const std::string& value) const { return "\"" + mirrored(value) + "\""; }
    // A point of the world; a vector, or a point of a body.
    std::string point(const std::string& x, const std::string& y) const {
        return fmt::format("[\"{} + {}\", \"{} + {}\"]", mirrored(x), world_.dx, y, world_.dy);
    }
    std::string local(const std::string& x, const std::string& y) const {
        return fmt::format("[\"{}\", \"{}\"]", mirrored(x), y);
    }

    void coordinate(const std::string& name, double start, double rate) {
        coordinates_ += fmt::format("  {{name = \"{}\", start = {:.4f}, rate = {:.4f}}},\n", name, start, rate);
    }

    std::string shape(bool is_first) {
        const double size = uniform(0.1, 0.25);
        const std::string mass = fmt::format("mass = \"{:.3f}*m\", points = {{p = {}}}, ", uniform(0.5, 2.0),
                                             local(decimal(uniform(-0.2, 0.2)), decimal(uniform(-0.2, 0.2))));
        const double kind = uniform(0.0, 4.0);
        if (is_first) first_is_disc_ = kind < 1.0;
        if (kind < 1.0) return mass + fmt::format("disc = {:.3f}", size);
        if (kind < 2.0) return mass + fmt::format("box = [{:.3f}, {:.3f}]", size, size / 2.0);
        if (kind < 3.0)
            return mass + fmt::format("rod = [{}, {}]", local("0", "0"), local(decimal(size), decimal(-size)));
        return mass + fmt::format("inertia = 0.02, center = {}", local(decimal(size / 3.0), "0.05"));
    }

    std::string grounds(bool is_carried) {
        const std::string left = fmt::format("{}", world_.mirror * -3.0 + world_.dx),
                          right = fmt::format("{}", world_.mirror * 3.0 + world_.dx);
        const bool is_swapped = world_.mirror < 0.0;
        const std::string y = decimal(world_.dy);
        std::string text = fmt::format("ground = [\n  {{name = \"floor\", line = [[{}, {}], [{}, {}]], speed = {}}},\n",
                                       is_swapped ? right : left, y, is_swapped ? left : right, y, 0.3 * world_.mirror);
        text += fmt::format("  {{name = \"hills\", curve = \"0.1*sin(2*{}) + {}\", over = [-3, 3]}},\n",
                            mirrored(fmt::format("(x - {})", world_.dx)), y);
        if (is_carried)
            text += fmt::format("  {{name = \"knob\", disc = 0.2, on = \"frame\", at = {}}},\n", local("0.2", "0.4"));
        has_knob_ = is_carried;
        return text + "]\n";
    }

    std::string contacts() {
        std::string text = "constraint = [\n";
        const auto add = [&](const char* name, const std::string& between) {
            text += fmt::format("  {{name = \"{}\", {}, restitution = {:.3f}}},\n", name, between, uniform(0.3, 0.8));
        };
        add("down", "between = [\"b0.p\", \"floor\"]");
        if (first_is_disc_) add("roll", "between = [\"b0\", \"floor\"]");
        if (chance(0.5)) add("hill", "between = [\"b0.p\", \"hills\"], normal = true");
        if (chance(0.5)) add("rope", "between = [\"world.hook\", \"b0\"], longest = 1.9");
        if (has_knob_) add("knob", first_is_disc_ ? "between = [\"b0\", \"knob\"]" : "between = [\"b0.p\", \"knob\"]");
        return text + "]\n";
    }

    std::mt19937_64 engine_;
    World world_;
    std::string coordinates_ = "coordinate = [\n";
    std::vector<std::string> bodies_;
    bool first_is_disc_ = false, has_knob_ = false;
};

constexpr std::uint64_t mechanism_count = 40;

std::string mechanism(std::uint64_t seed, const World& world = {}) { return RandomMechanism(seed, world).text(); }

Trajectory run_of_text(const std::string& text, double tolerance) {
    const auto model = std::make_shared<const Model>(parse_system(text, "mechanism.toml"));
    Run run = model->default_run();
    run.options.tolerance = tolerance;
    return simulate(model, run);
}

TEST(Mechanisms, AreTheirExpandedFiles) {
    for (std::uint64_t seed = 0; seed < mechanism_count; ++seed) {
        const std::string text = mechanism(seed), expanded = expand_system(text, "mechanism.toml");
        EXPECT_EQ(expanded.find("body = "), std::string::npos);
        EXPECT_EQ(to_json(run_of_text(expanded, 1e-10)), to_json(run_of_text(text, 1e-10))) << "seed " << seed << "\n"
                                                                                            << text;
    }
}

// The energy changes by the work of forces and prescribed motion and by the losses of impacts, and by nothing else.
TEST(Mechanisms, BalanceEnergyAndWork) {
    int impacts = 0, driven = 0;
    for (std::uint64_t seed = 0; seed < mechanism_count; ++seed) {
        const std::string text = mechanism(seed);
        const Trajectory run = run_of_text(text, 1e-10);
        EXPECT_LE(run.statistics.energy_drift, 1e-8) << "seed " << seed << "\n" << text;
        impacts += run.events.empty() ? 0 : 1;
        driven += text.find("\"frame\"") == text.npos ? 0 : 1;
    }
    EXPECT_GE(impacts, 20);
    EXPECT_GE(driven, 8);
}

// The coordinates keep their meaning, so the events and the end are the same.
void expect_the_same_motion(const World& world) {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < mechanism_count; ++seed) {
        const Trajectory one = run_of_text(mechanism(seed), 1e-12), two = run_of_text(mechanism(seed, world), 1e-12);
        if (one.outcome.kind != Outcome::Kind::end_time) continue;
        ++compared;
        ASSERT_EQ(two.outcome.kind, one.outcome.kind) << "seed " << seed << ": " << two.outcome.message;
        ASSERT_EQ(one.events.size(), two.events.size()) << "seed " << seed << "\n" << mechanism(seed, world);
        for (std::size_t i = 0; i < one.events.size(); ++i) {
            EXPECT_EQ(one.events[i].kind, two.events[i].kind) << "seed " << seed;
            EXPECT_NEAR(one.events[i].t, two.events[i].t, 1e-8) << "seed " << seed;
        }
        EXPECT_LE((one.end.q - two.end.q).lpNorm<Eigen::Infinity>(), 1e-7) << "seed " << seed;
    }
    EXPECT_GE(compared, 3 * static_cast<int>(mechanism_count) / 4);
}

TEST(Mechanisms, MoveAlikeInAMirroredWorld) { expect_the_same_motion({.mirror = -1.0}); }
TEST(Mechanisms, MoveAlikeElsewhere) { expect_the_same_motion({.dx = 0.75, .dy = -1.5}); }
TEST(Mechanisms, MoveAlikeInAnyOrderOfTheBodies) { expect_the_same_motion({.is_reversed = true}); }

}  // namespace
}  // namespace achilles::test
