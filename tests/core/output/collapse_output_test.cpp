// A collapse in the summary, in JSON and in sweeps.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/systems.hpp"
#include "output/output.hpp"

namespace achilles {
namespace {

TEST(CollapseOutput, HasASentenceAndJson) {
    const auto model = std::make_shared<const Model>(
        read_system(test::source_file("tests/reference/collapse/collapse_second_opens.toml")));
    const Trajectory run = simulate(model, model->default_run());
    const std::string text = summary(run);
    EXPECT_NE(text.find("p and r: infinitely many impacts within"), std::string::npos) << text;
    EXPECT_NE(text.find("no force needed (speeds x 0.767, gaps x 0.013 per two impacts)"), std::string::npos) << text;
    EXPECT_NE(text.find("p is held, r leaves"), std::string::npos) << text;
    const auto json = nlohmann::json::parse(to_json(run));
    const auto& events = json["events"];
    const auto found =
        std::find_if(events.begin(), events.end(), [](const auto& one) { return one["kind"] == "collapse"; });
    ASSERT_NE(found, events.end());
    EXPECT_EQ((*found)["contacts"], (nlohmann::json{"p", "r"}));
    EXPECT_EQ((*found)["held"], nlohmann::json{"p"});
    EXPECT_EQ((*found)["opened"], nlohmann::json{"r"});
    EXPECT_GT((*found)["impulses"]["p"], 0.0);
    EXPECT_GT((*found)["loss"], 0.0);
    EXPECT_TRUE((*found)["certificate"]["certified"]);
}

TEST(CollapseOutput, SaysWhichWayTheContactsSlide) {
    const auto model = test::load("slider_crank_friction");
    const std::string text = summary(simulate(model, model->default_run()));
    EXPECT_NE(text.find("c3 slides with slip > 0, c4 slides with slip > 0"), std::string::npos) << text;
}

}  // namespace
}  // namespace achilles
