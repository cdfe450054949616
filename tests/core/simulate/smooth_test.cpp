// Systems without a constraint: a smooth motion, in every output.
#include <gtest/gtest.h>

#include "check/check.hpp"
#include "core/systems.hpp"
#include "enclose/enclosure.hpp"
#include "output/output.hpp"
#include "sensitivity/error_estimate.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

const std::string smooth_oscillator = R"toml(title = "oscillator"
coordinate = [{name = "x", start = 1, unit = "m"}, {name = "y", rate = 2, unit = "m"}]
lagrangian.kinetic = "x'^2/2 + y'^2/2"
lagrangian.potential = "x^2/2 + 2*y^2"
run.end_time = 3
)toml";

TEST(SmoothSystem, RunsWithoutContacts) {
    for (const char* constraints : {"", "constraint = []\n"}) {
        const auto model = test::typed(constraints + smooth_oscillator);
        EXPECT_EQ(model->contacts(), 0u);
        for (const Method method : test::both_methods) {
            achilles::Run run = model->default_run();
            run.options.method = method;
            model->check(run);
            const Trajectory trajectory = simulate(model, run);
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time);
            EXPECT_TRUE(trajectory.events.empty());
            ASSERT_EQ(trajectory.phases.size(), 1u);
            EXPECT_EQ(trajectory.phases[0].kind, Phase::Kind::hybrid);
            EXPECT_EQ(trajectory.end_time, 3.0);
            EXPECT_NEAR(trajectory.end.q[0], std::cos(3.0), 1e-8);
            EXPECT_NEAR(trajectory.end.q[1], std::sin(6.0), 1e-8);
            EXPECT_NEAR(trajectory.end.v[1], 2.0 * std::cos(6.0), 1e-8);
            if (method != Method::taylor) continue;
            const auto error = estimate_error(trajectory);
            ASSERT_TRUE(error.end) << error.no_estimate_reason;
            EXPECT_LT(error.end->size(), 1e-6);
        }
    }
}

TEST(SmoothSystem, IsProved) {
    const auto model = test::typed(smooth_oscillator);
    const Enclosure proof = prove(model, problem_from_decimals(model->default_run()));
    ASSERT_TRUE(proof.end) << proof.outcome.message;
    EXPECT_TRUE(proof.events.empty());
    EXPECT_NEAR(mid(proof.end->q[0]), std::cos(3.0), 1e-9);
    EXPECT_NEAR(mid(proof.end->v[1]), 2.0 * std::cos(6.0), 1e-9);
    EXPECT_LT(rad(proof.end->q[0]), 1e-9);
}

TEST(SmoothSystem, HasNoGapInItsOutput) {
    const auto model = test::typed(smooth_oscillator);
    const Trajectory trajectory = simulate(model, model->default_run());
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_EQ(json["system"]["contacts"], nlohmann::json::array());
    EXPECT_TRUE(json["statistics"]["least_gap"].is_null());
    const std::string csv = to_csv(trajectory);
    EXPECT_EQ(csv.substr(0, csv.find('\n')), "t,phase,x,y,x',y',energy,j");
    EXPECT_EQ(summary(trajectory).find("least gap"), std::string::npos) << summary(trajectory);
    for (const ViewDescription& view : model->description().views)
        EXPECT_EQ(view.y[0].text.find("gap"), std::string::npos) << view.name;
    double disagreement = 1.0;
    const std::string report = check_report(*model, model->default_run(), 0.0, Notation::text, disagreement);
    EXPECT_LT(disagreement, max_disagreement);
    EXPECT_EQ(report.find("gap"), std::string::npos) << report;
}

TEST(SmoothSystem, HasNoGapInItsViews) {
    EXPECT_EQ(test::told_by_reading(smooth_oscillator + "view = [{name = \"v\", x = \"t\", y = [\"gap\"]}]\n"),
              "f.toml:6:37: 'gap' needs a [[constraint]], and this system has none\n    view = [{name = \"v\", x = "
              "\"t\", y = "
              "[\"gap\"]}]\n                                        ^");
}

}  // namespace
}  // namespace achilles
