// Redundant contacts: all contacts at rest are reported as held, and the load-bearing ones may change without an event
// (theory-gaps.md 2.5).
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "core/systems.hpp"
#include "floor/laws.hpp"
#include "output/output.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles {
namespace {

// A plate of mass 1, or a beam if it has no tilt v, on supports at (x, y) under a load at (u, v) on the plate. The
// coordinate "s" moves at rate 1.
struct Plate {
    std::vector<std::pair<double, double>> supports;
    std::string load, x, y;
    double weight = 1.0, end = 4.0;

    std::shared_ptr<const Model> model(bool reversed = false) const {
        std::string constraints;
        for (std::size_t i = 0; i < supports.size(); ++i) {
            const std::size_t k = reversed ? supports.size() - 1 - i : i;
            constraints += fmt::format("{}{{ name = \"c{}\", gap = \"z + ({})*u + ({})*v\", restitution = 0 }}",
                                       i == 0 ? "" : ", ", k, supports[k].first, supports[k].second);
        }
        return test::typed(fmt::format(R"toml(
title = "Plate"
coordinate = [{{ name = "s", start = 0, rate = 1 }}, {{ name = "z", start = 0, force = "-({0})" }},
              {{ name = "u", start = 0, force = "-({0})*({1})" }}, {{ name = "v", start = 0, force = "-({0})*({2})" }}]
lagrangian = {{ kinetic = "(s'^2 + z'^2 + u'^2 + v'^2)/2", potential = "{4}*z" }}
constraint = [{3}]
[run]
end_time = {5}
)toml",
                                       load, x, y, constraints, weight, end));
    }
};

const std::vector<std::pair<double, double>> four_legs = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
const std::vector<std::pair<double, double>> beam = {{-1, 0}, {0, 0}, {1, 0}};

void expect_laws(const Trajectory& trajectory) {
    for (const auto law : {test::energy, test::gap, test::phases, test::contact_force})
        for (const std::string& violation : law(trajectory)) ADD_FAILURE() << violation;
}

Trajectory simulated(const std::shared_ptr<const Model>& model, Method method = Method::taylor) {
    auto run = model->default_run();
    run.options.method = method;
    Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_FALSE(trajectory.rerun_options);
    return trajectory;
}

// Expects a single phase that holds all contacts, for this motion of the load.
void expect_rest(const Plate& plate) {
    SCOPED_TRACE(plate.load + " at " + plate.x + ", " + plate.y);
    for (const Method method : test::both_methods) {
        const Trajectory trajectory = simulated(plate.model(), method);
        EXPECT_TRUE(trajectory.events.empty());
        ASSERT_EQ(trajectory.phases.size(), 1u);
        EXPECT_EQ(trajectory.phases[0].mode.held().count(), static_cast<int>(plate.supports.size()));
        EXPECT_TRUE(trajectory.phases[0].is_nonunique());
        EXPECT_NEAR(trajectory.end.q.tail(3).norm() + trajectory.end.v.tail(3).norm(), 0.0, 1e-12);
        expect_laws(trajectory);
    }
}

TEST(RedundantContacts, WhoCarriesMayChangeWithoutAnEvent) {
    for (const char* x : {"s/4 - 1/2", "0.6*cos(3*t)"})
        for (const char* y : {"0.2", "0", "s/4 - 1/2", "0.6*sin(2*t)"}) expect_rest({four_legs, "2", x, y});
    expect_rest({beam, "1", "s/4 - 0.6", "0"});
}

// Contact forces touch 0 and grow again: the load reaches a diagonal, or the middle, where any three supports would
// suffice.
TEST(RedundantContacts, AForceThatOthersShareMayTouchZero) {
    expect_rest({four_legs, "2", "0.3 + 0.2*cos(t)^2", "0.3"});
    expect_rest({four_legs, "2", "0.3*cos(t)^2", "0"});
    expect_rest({four_legs, "4*cos(t)^2", "0.4", "0.1"});
    expect_rest({beam, "4*cos(t)^2", "0.3", "0"});
    // The load stops over a leg in the middle, which is redundant.
    expect_rest({{{0, 0}, {1, -1}, {-1, 0}, {0, 1}}, "2", "0.3*cos(t)^2", "0.2*cos(t)^2"});
}

// When all contact forces vanish at once there is no load to share, and the continuation is undecided.
TEST(RedundantContacts, WhereEveryForceTouchesZeroNothingIsDecided) {
    const auto model = Plate{four_legs, "4*cos(t)^2", "0.4", "0.1", 0.0}.model();
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::undecided);
    EXPECT_NEAR(trajectory.end_time, std::acos(0.0), 1e-4);
}

// The load moves past the last support. That contact alone stays closed, from the instant where load and weight balance
// on it.
TEST(RedundantContacts, OnlyThoseAreReleasedThatOpen) {
    for (const Method method : test::both_methods) {
        const Trajectory trajectory = simulated(Plate{beam, "2", "s", "0"}.model(), method);
        ASSERT_EQ(trajectory.events.size(), 1u);
        const Event& release = trajectory.events[0];
        EXPECT_EQ(release.kind, Event::Kind::release);
        EXPECT_NEAR(release.t, 1.5, 1e-9);
        EXPECT_EQ(release.contacts, ContactSet::of(0).with(1));
        EXPECT_EQ(release.mode.held(), ContactSet::of(2));
        EXPECT_FALSE(trajectory.phases[1].is_nonunique());
        expect_laws(trajectory);
    }
}

// The reported contact forces are of least norm, also where three legs would suffice.
TEST(RedundantContacts, ForcesAreOfLeastNorm) {
    const Trajectory trajectory = simulated(Plate{four_legs, "1", "s/4 - 1/2", "0.2"}.model());
    ContactForces forces(*trajectory.model, trajectory.run.parameters);
    Sampler sampler(trajectory);
    for (int i = 0; i <= 40; ++i) {
        const double t = 0.1 * i, x = t / 4 - 0.5;
        forces.set(sampler.at(t));
        for (std::size_t leg = 0; leg < 4; ++leg)
            EXPECT_NEAR(forces.force(leg), (2.0 + four_legs[leg].first * x + four_legs[leg].second * 0.2) / 4, 1e-12);
    }
}

TEST(RedundantContacts, IsTold) {
    const Trajectory trajectory = simulated(Plate{beam, "2", "s", "0"}.model());
    const auto json = nlohmann::json::parse(to_json(trajectory, {}));
    EXPECT_EQ(json["phases"][0]["not_unique"], true);
    EXPECT_EQ(json["phases"][0]["held"], (nlohmann::json{"c0", "c1", "c2"}));
    EXPECT_FALSE(json["phases"][1].contains("not_unique"));
    EXPECT_NE(summary(trajectory).find("in contact with c0, c1, c2, t = 0 to 1.5 s, forces not unique\n"),
              std::string::npos)
        << summary(trajectory);
}

// A gap given twice behaves as one gap. The moving table throws the ball and catches it.
TEST(RedundantContacts, AGapThatIsGivenTwiceIsThrownAndCaught) {
    const auto ball = [](const std::string& second) {
        return test::typed(fmt::format(R"toml(
title = "Ball on a moving table"
coordinate = [{{ name = "x", start = 0, rate = 0.3 }}, {{ name = "y", start = 0.5 }}]
lagrangian = {{ kinetic = "1/2*(x'^2 + y'^2)", potential = "y" }}
constraint = [{{ name = "a", gap = "y - 0.3*sin(2*t)", restitution = 0 }}{}]
[run]
end_time = 10
)toml",
                                       second));
    };
    for (const Method method : test::both_methods) {
        const Trajectory one = simulated(ball(""), method);
        const Trajectory two =
            simulated(ball(", { name = \"b\", gap = \"2*y - 0.6*sin(2*t)\", restitution = 0 }"), method);
        expect_laws(two);
        EXPECT_LT((one.end.q - two.end.q).norm() + (one.end.v - two.end.v).norm(), 1e-9);
        EXPECT_NEAR(one.work, two.work, 1e-9);
        EXPECT_NEAR(one.loss, two.loss, 1e-9);
        EXPECT_EQ(one.phases.size(), two.phases.size());
        for (const Phase& phase : two.phases) EXPECT_NE(phase.mode.held().count(), 1);
    }
}

// Random supports and loads, some of which tip the plate. Checks the laws, the other method, and another order of
// contacts.
TEST(RedundantContacts, AnyPlateObeysTheLaws) {
    std::mt19937 random(5);
    const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    int rested = 0, released = 0;
    for (int trial = 0; trial < 24; ++trial) {
        SCOPED_TRACE(trial);
        Plate plate{{}, fmt::format("{:.3f}", number(0.5, 3.0)), "", ""};
        const int count = 3 + trial % 4;
        for (int i = 0; i < count; ++i)
            plate.supports.emplace_back(std::round(100 * number(-1, 1)) / 100, std::round(100 * number(-1, 1)) / 100);
        // relative to the center of the supports
        for (auto& [x, y] : plate.supports) {
            if (trial % 3 == 0) y = 0.0;
            x = x > 0 ? x + 0.5 : x - 0.5;
            y = y > 0 ? y + 0.5 : y < 0 ? y - 0.5 : 0.0;
        }
        const double size = number(0.1, 0.8);
        plate.x = fmt::format("{:.3f}*cos({:.3f}*t + {:.3f})", size, number(0.5, 3), number(0, 6));
        plate.y = trial % 3 == 0 ? "0" : fmt::format("{:.3f}*sin({:.3f}*t)", size, number(0.5, 3));
        const auto model = plate.model(), renamed = plate.model(true);
        auto run = model->default_run();
        run.options.end_time = 2.0;
        const Trajectory trajectory = simulate(model, run);
        if (trajectory.outcome.kind != Outcome::Kind::end_time) {  // a tipping plate may chatter
            EXPECT_FALSE(trajectory.events.empty()) << trajectory.outcome.message;
            continue;
        }
        (trajectory.events.empty() ? rested : released) += 1;
        expect_laws(trajectory);
        const Trajectory other = simulate(renamed, run);
        EXPECT_EQ(other.events.size(), trajectory.events.size());
        EXPECT_LT((other.end.q - trajectory.end.q).norm(), 1e-8);
        run.options.method = Method::dopri5;
        const Trajectory again = simulate(model, run);
        EXPECT_LT((again.end.q - trajectory.end.q).norm(), 1e-6);
    }
    EXPECT_GE(rested, 6);
    EXPECT_GE(released, 2);
}

// A list of contacts in a message must not be empty. With gaps scaled by 1e8, 'wall' touches while nothing is held.
TEST(RedundantContacts, NamesNoEmptySet) {
    const auto model = test::typed(R"toml(
title = "ball between a moving floor, a wall and a disc"
[[coordinate]]
name = "x"
start = -0.1971
rate = -1.5677
[[coordinate]]
name = "y"
start = 1.3496
rate = 0.5744
force = "-0.2*y'"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "9.81*y"
[[constraint]]
name = "floor"
gap = "1e8*(y - (0.218662*sin(1.127388*x + 3.001771) + 0.2*sin(13.408985*t)))"
restitution = 0.7
[[constraint]]
name = "wall"
gap = "1e8*(x + 1.813743)"
restitution = 0
[[constraint]]
name = "disc"
gap = "1e8*(sqrt((x - 1.318784)^2 + (y - 0.364146)^2) - 0.4)"
restitution = 0.747
)toml");
    const std::string message = simulate(model, model->default_run()).outcome.message;
    for (const char* empty : {"with ,", "with and", "while  ", "of  ", " ,"})
        EXPECT_EQ(message.find(empty), std::string::npos) << message;
}

}  // namespace
}  // namespace achilles
