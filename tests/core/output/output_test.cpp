// JSON, CSV and the summary: a contract that scripts read.
#include "output/output.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "core/systems.hpp"

namespace achilles {
namespace {

class Outputs : public testing::Test {
 protected:
    Outputs() : model(test::load("ball_on_sine")), trajectory(simulate(model, with(Conditions::paper))) {}
    achilles::Run with(Conditions conditions) const {
        auto run = model->default_run();
        run.options.truncation.conditions = conditions;
        return run;
    }
    std::shared_ptr<const Model> model;
    Trajectory trajectory;
};

std::vector<std::string> split(const std::string& line, char by) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, by);) parts.push_back(part);
    return parts;
}

TEST_F(Outputs, JsonHasTheKeysOfTheContract) {
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_EQ(json["achilles"], version());
    EXPECT_EQ(json["system"]["coordinates"], (nlohmann::json{"x", "y"}));
    EXPECT_EQ(json["system"]["parameters"]["g"], 1.0);
    for (const char* key : {"method", "tolerance", "conditions", "reinitialization", "eps_q", "eps_v", "eps_t"})
        EXPECT_TRUE(json["options"].contains(key)) << key;
    ASSERT_EQ(json["phases"].size(), 4u);
    EXPECT_EQ(json["phases"][0]["kind"], "hybrid");
    EXPECT_EQ(json["phases"][1]["kind"], "constrained");
    EXPECT_EQ(json["phases"][0]["end"], json["phases"][1]["start"]);
    std::size_t impacts = 0;
    for (const auto& event : json["events"]) {
        if (event["kind"] == "impact") {
            ++impacts;
            EXPECT_EQ(event["v_before"].size(), 2u);
            EXPECT_GT(event["impact_speed"].get<double>(), 0.0);
        } else if (event["kind"] == "zeno") {
            EXPECT_LT(event["truncation"]["t"].get<double>(), event["t"].get<double>());
            for (const char* key : {"t", "q", "v", "v_before", "impact_speed"})
                EXPECT_TRUE(event["truncation"].contains(key)) << key;
            const auto& c = event["certificate"];
            EXPECT_EQ(c["certified"], true);
            EXPECT_LT(c["zeno_time"][0].get<double>(), event["t"].get<double>());
            EXPECT_GT(c["zeno_time"][1].get<double>(), event["t"].get<double>());
            EXPECT_TRUE(c["shadowing_position"].is_null());
            EXPECT_TRUE(c["uniform_position"].is_null());
            for (const char* key : {"position_bound", "velocity_bound", "a_min", "a_max", "decisive", "e1", "e2",
                                    "beta", "eta", "zeta", "c1", "c2", "c3"})
                EXPECT_TRUE(c.contains(key)) << key;
        }
    }
    EXPECT_EQ(json["statistics"]["impacts"], impacts);
    EXPECT_EQ(json["end"]["t"], 20.0);
    EXPECT_EQ(json["end"]["phase"], "constrained");
    EXPECT_EQ(json["outcome"]["kind"], "end time");
    EXPECT_EQ(json["end"]["q"][0].get<double>(), trajectory.end.q[0]);  // the same double
}

TEST_F(Outputs, JsonHasTheNumbersOfEveryEvent) {
    const auto json = nlohmann::json::parse(to_json(trajectory));
    const auto numbers = [](const Vector& x) { return std::vector<double>(x.begin(), x.end()); };
    ASSERT_EQ(json["events"].size(), trajectory.events.size());
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        const auto& written = json["events"][i];
        const bool impact = event.kind == Event::Kind::impact;
        EXPECT_EQ(written["t"], event.t);
        EXPECT_EQ(written["q"], numbers(event.q));
        EXPECT_EQ(written[impact ? "v_after" : "v"], numbers(event.v_after));
        if (impact) {
            EXPECT_EQ(written["v_before"], numbers(event.v_before));
        }
        if (event.truncation) {
            EXPECT_EQ(written["truncation"]["v_before"], numbers(event.truncation->v_before));
            EXPECT_EQ(written["truncation"]["v"], numbers(event.truncation->v));
        }
    }
}

TEST_F(Outputs, SharpCertificatesBoundTheRestartedMotion) {
    const Trajectory sharp = simulate(model, with(Conditions::sharp));
    const auto json = nlohmann::json::parse(to_json(sharp));
    for (const auto& event : json["events"]) {
        if (event["kind"] != "zeno") continue;
        const auto& c = event["certificate"];
        EXPECT_EQ(c["conditions"], "sharp");
        EXPECT_LE(c["shadowing_position"].get<double>(), 1e-6);
        EXPECT_LE(c["shadowing_velocity"].get<double>(), 1e-6);
        EXPECT_LE(c["uniform_position"].get<double>(), 1e-6);
        EXPECT_GT(c["uniform_position"].get<double>(), c["shadowing_position"].get<double>());
        EXPECT_EQ(c["decisive"], "position bound");
        EXPECT_FALSE(c.contains("e1"));
        EXPECT_EQ(c["inequalities"].size(), 5u);
    }
    const std::string text = summary(sharp);
    EXPECT_NE(text.find("of the true motion;\n            decided by the position bound"), std::string::npos) << text;
    EXPECT_NE(text.find("of the true position (the bounces not drawn are no higher)"), std::string::npos) << text;
}

TEST_F(Outputs, WhatIsNotFiniteIsNull) {
    trajectory.end.q[0] = std::numeric_limits<double>::quiet_NaN();
    trajectory.statistics.energy_drift = std::numeric_limits<double>::infinity();
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_TRUE(json["end"]["q"][0].is_null());
    EXPECT_TRUE(json["statistics"]["energy_drift"].is_null());
}

TEST_F(Outputs, CsvHasTwoRowsAtAnImpactTheSecondWithALargerJ) {
    const std::vector<std::string> lines = split(to_csv(trajectory), '\n');
    EXPECT_EQ(lines[0], "t,phase,x,y,x',y',gap,gap rate,lambda,energy,j");
    std::size_t pairs = 0, cuts = 0;
    for (std::size_t i = 2; i < lines.size(); ++i) {
        const auto before = split(lines[i - 1], ','), after = split(lines[i], ',');
        ASSERT_EQ(after.size(), 11u);
        EXPECT_GE(std::stod(after[6]), -1e-12);
        if (before[0] != after[0] || before[10] == after[10]) continue;
        ++pairs;
        EXPECT_EQ(std::stoi(after[10]), std::stoi(before[10]) + 1);
        const auto j = static_cast<std::size_t>(std::stoi(after[10]));
        if (j < trajectory.events.size() && trajectory.events[j].kind == Event::Kind::zeno) {
            // The last impact before a Zeno point: what follows is the restarted motion.
            EXPECT_EQ(std::stod(after[2 + 2]), trajectory.events[j].truncation->v[0]);
            EXPECT_NEAR(std::stod(after[7]), 0.0, 1e-15);
            ++cuts;
        } else if (after[1] == "hybrid" && before[1] == "hybrid") {
            EXPECT_NEAR(std::stod(after[7]), -0.5 * std::stod(before[7]), 1e-9 + 1e-6 * std::abs(std::stod(before[7])));
        }
    }
    EXPECT_EQ(pairs, trajectory.events.size());
    EXPECT_EQ(cuts, 2u);
    EXPECT_EQ(lines[1].substr(0, 13), "0,hybrid,0,2,");
}

TEST_F(Outputs, TheSummarySpeaksOfEveryZenoPointAndOfWhatIsNotCovered) {
    const std::string text = summary(trajectory);
    EXPECT_NE(text.find("zeno      t = 2.725142173"), std::string::npos) << text;
    EXPECT_NE(text.find("release   t = 3.73182"), std::string::npos) << text;
    EXPECT_NE(text.find("tau_inf in [2.725142172"), std::string::npos) << text;
    EXPECT_NE(text.find("decided by the condition c3: velocity"), std::string::npos) << text;
    EXPECT_NE(text.find("do not cover"), std::string::npos) << text;
    EXPECT_NE(text.find("outcome: end time"), std::string::npos) << text;
}

TEST_F(Outputs, TextIsForGoldens) {
    const std::string text = to_text(trajectory);
    EXPECT_EQ(text.substr(0, 62), "phase hybrid [0, 2.72514217] impacts 23\nphase constrained [2.7");
}

}  // namespace
}  // namespace achilles
