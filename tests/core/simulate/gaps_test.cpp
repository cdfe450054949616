// Runs with forces, moving gaps and several gaps, against 113-bit references (tests/reference/gaps.json).
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/systems.hpp"
#include "floor/laws.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

using Json = nlohmann::json;

const Json& reference_runs() {
    static const Json all = Json::parse(std::ifstream(ACHILLES_SOURCE_DIR "/tests/reference/gaps.json")).at("runs");
    return all;
}

double number_in(const Json& text) { return std::stod(text.get<std::string>()); }

ContactSet contacts_in(const Json& list) {
    ContactSet set;
    for (const Json& contact : list) set = set.with(contact.get<std::size_t>());
    return set;
}

using Case = std::tuple<std::string, Method>;

class Gaps : public testing::TestWithParam<Case> {
 protected:
    void SetUp() override {
        const auto& [name, method] = GetParam();
        expected_ = reference_runs().at(name);
        const auto model = std::make_shared<const Model>(
            read_system(std::string(ACHILLES_SOURCE_DIR "/tests/reference/gaps/") + name + ".toml"));
        run_ = model->default_run();
        run_.options.method = method;
        auto& truncation = run_.options.truncation;
        truncation.eps_q = truncation.eps_v = truncation.eps_t = 1e-9;
        trajectory_ = simulate(model, run_);
    }
    Json expected_;
    achilles::Run run_;
    Trajectory trajectory_;
};

// The reference lists impacts faster than 1e-3.
TEST_P(Gaps, AreAsInTheReference) {
    ASSERT_EQ(trajectory_.outcome.kind, Outcome::Kind::end_time) << trajectory_.outcome.message;
    std::vector<Event> events;
    for (const Event& event : trajectory_.events)
        if (event.kind != Event::Kind::impact || event.impact_speed > 1e-3) events.push_back(event);
    const Json& expected = expected_.at("events");
    ASSERT_EQ(events.size(), expected.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        SCOPED_TRACE(expected[i].dump());
        EXPECT_EQ(names_of(events[i].kind).word, expected[i].at("kind").get<std::string>());
        EXPECT_EQ(events[i].contacts, ContactSet::of(expected[i].at("contact").get<std::size_t>()));
        EXPECT_EQ(events[i].mode.held(), contacts_in(expected[i].at("held")));
        EXPECT_EQ(events[i].opened, contacts_in(expected[i].value("opened", Json::array())));
        EXPECT_NEAR(events[i].t, number_in(expected[i].at("t")), 1e-9);
    }
    const Json& end = expected_.at("end");
    for (Eigen::Index i = 0; i < run_.q.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        EXPECT_NEAR(trajectory_.end.q[i], number_in(end.at("q")[k]), 1e-8);
        EXPECT_NEAR(trajectory_.end.v[i], number_in(end.at("v")[k]), 1e-8);
    }
    EXPECT_EQ(trajectory_.end_mode.held(), contacts_in(end.at("held")));
}

TEST_P(Gaps, BalanceTheirEnergy) {
    EXPECT_NEAR(trajectory_.work, number_in(expected_.at("work")) + number_in(expected_.at("wall_work")), 1e-9);
    EXPECT_NEAR(trajectory_.loss, number_in(expected_.at("loss")), 1e-9);
    EXPECT_NEAR(number_in(expected_.at("energy_end")) - number_in(expected_.at("energy_start")),
                trajectory_.work - trajectory_.loss, 1e-9);
    EXPECT_LT(trajectory_.statistics.energy_drift, 1e-11);
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
    return std::get<0>(info.param) + "_" + std::string(to_text(std::get<1>(info.param)));
}
INSTANTIATE_TEST_SUITE_P(Reference, Gaps,
                         testing::Combine(testing::Values("driven_damped_pendulum", "travelling_wave",
                                                          "vibrating_table", "bowl_and_post", "pendulum_two_stops",
                                                          "ball_in_box"),
                                          testing::Values(Method::taylor, Method::dopri5)),
                         name_of);

// A body slides on a floor at about x' = 1 until it hits a wall. The force 3/2 - x'^2 lifts it against gravity 1.
std::shared_ptr<const Model> lifted(double e, double push) {
    return test::typed(fmt::format(R"toml(
title = "Lifted where it is slow"
coordinate = [{{ name = "x", start = 0, rate = 1.1, force = "{} - x'/10" }},
              {{ name = "y", start = 0, force = "3/2 - x'^2" }}]
lagrangian = {{ kinetic = "(x'^2 + y'^2)/2", potential = "y" }}
constraint = [{{ name = "wall", gap = "1 - x", restitution = {} }}, {{ name = "floor", gap = "y", restitution = 0.5 }}]
[run]
end_time = 1.5
)toml",
                                   push, e));
}

// Contact forces may depend on velocities. An impact that only presses the held contact may remove its contact force.
TEST(HeldContacts, AnImpactMayTakeTheForceFromWhatIsHeld) {
    const auto floor = ContactSet::of(1), wall = ContactSet::of(0);
    for (const Method method : test::both_methods) {
        const auto model = lifted(0.5, 0.0);
        auto run = model->default_run();
        run.options.method = method;
        run.options.tolerance = 1e-12;
        const Trajectory trajectory = simulate(model, run);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        ASSERT_EQ(trajectory.events.size(), 1u);  // the impact, which opens the floor contact
        EXPECT_EQ(trajectory.events[0].contacts, wall);
        EXPECT_EQ(trajectory.events[0].opened, floor);
        EXPECT_TRUE(trajectory.end_mode.held().empty());
        // x' decreases by 1/10 per meter, from 1 at the wall to -1/2; then y'' = 1/2 - (exp(-t/10)/2)^2.
        const double blow = 10.0 * std::log(1.1), t = 1.5 - blow;
        EXPECT_NEAR(trajectory.events[0].t, blow, 1e-12);
        EXPECT_NEAR(trajectory.end.q[1], t * t / 4.0 - 0.25 / 0.04 * (std::exp(-0.2 * t) - 1.0 + 0.2 * t), 1e-12);
    }
}

// The same with a wall whose impact is plastic and holds the body: the floor contact is released, the wall contact
// stays.
TEST(HeldContacts, APlasticImpactMayTakeTheForceFromWhatIsHeld) {
    const auto model = lifted(0.0, 0.01);
    const Trajectory trajectory = simulate(model, model->default_run());
    ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    ASSERT_EQ(trajectory.events.size(), 1u);
    EXPECT_EQ(trajectory.events[0].opened, ContactSet::of(1));
    EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(0));
    const double t = 1.5 - trajectory.events[0].t;
    EXPECT_NEAR(trajectory.end.q[0], 1.0, 1e-12);
    EXPECT_NEAR(trajectory.end.q[1], t * t / 4.0, 1e-11);
}

// An impact transmitted to a held, moving contact does work there, too.
TEST(HeldContacts, WhatIsPassedOnToASurfaceThatMovesDoesWork) {
    const auto model = test::typed(R"toml(
title = "Body on a lift, against a wall that leans over"
coordinate = [{ name = "x", start = 0, rate = 1 }, { name = "y", start = 0, rate = 0.3 }]
lagrangian = { kinetic = "(x'^2 + y'^2)/2", potential = "y" }
constraint = [{ name = "wall", gap = "1 - x - y/2", restitution = 0.5 },
              { name = "lift", gap = "y - 0.3*t", restitution = 0.5 }]
[run]
end_time = 1.5
)toml");
    const Trajectory trajectory = simulate(model, model->default_run());
    ASSERT_FALSE(trajectory.events.empty());
    const Event& blow = trajectory.events[0];
    EXPECT_EQ(blow.mode.held(), ContactSet::of(1));
    // W = 1 for the wall while the lift holds the body: p = (1 + e) |hdot|, and half of it acts on the lift.
    const double impulse = 1.5 * 1.15, before = 0.3 * blow.t;
    EXPECT_NEAR(blow.work - before, 0.3 * impulse / 2.0, 1e-12);
    EXPECT_NEAR(blow.loss, 0.5 * impulse * 0.5 * 1.15, 1e-12);
    const auto violations = test::energy(trajectory);
    EXPECT_TRUE(violations.empty()) << violations.front();
}

}  // namespace
}  // namespace achilles
