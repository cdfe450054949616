// Runs with forces, moving and several gaps against others in 113-bit arithmetic (tests/reference/gaps.json).
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/systems.hpp"
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

// The impacts of the reference are those above a speed of 1e-3.
TEST_P(Gaps, AreAsInTheReference) {
    ASSERT_EQ(trajectory_.outcome.kind, Outcome::Kind::end_time) << trajectory_.outcome.message;
    std::vector<Event> events;
    for (const Event& event : trajectory_.events)
        if (event.kind != Event::Kind::impact || event.impact_speed > 1e-3) events.push_back(event);
    const Json& expected = expected_.at("events");
    ASSERT_EQ(events.size(), expected.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        SCOPED_TRACE(expected[i].dump());
        EXPECT_EQ(to_text(events[i].kind), expected[i].at("kind").get<std::string>());
        EXPECT_EQ(events[i].contacts, ContactSet::of(expected[i].at("contact").get<std::size_t>()));
        EXPECT_EQ(events[i].held, contacts_in(expected[i].at("held")));
        EXPECT_EQ(events[i].opened, contacts_in(expected[i].value("opened", Json::array())));
        EXPECT_NEAR(events[i].t, number_in(expected[i].at("t")), 1e-9);
    }
    const Json& end = expected_.at("end");
    for (Eigen::Index i = 0; i < run_.q.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        EXPECT_NEAR(trajectory_.end.q[i], number_in(end.at("q")[k]), 1e-8);
        EXPECT_NEAR(trajectory_.end.v[i], number_in(end.at("v")[k]), 1e-8);
    }
    EXPECT_EQ(trajectory_.end_held, contacts_in(end.at("held")));
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

}  // namespace
}  // namespace achilles
