// `simulate --derivatives` and `--of`: JSON, summary, and errors.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

TEST(Derivatives, OfTheCommandLineAreThoseOfTheContract) {
    const Folder folder;
    const std::string exact = "simulate ball_on_sine --tolerance 1e-14 --eps 1e-9";
    const Answer answer =
        folder.run(exact + " --derivatives --of \"zeno_time(2)\" --of \"x + 2*g\" --of work --json -");
    ASSERT_EQ(answer.status, 0) << answer.err;
    json run = json::parse(answer.out);
    EXPECT_EQ(run["derivatives"]["directions"], (json{"x", "y", "x'", "y'", "m", "g", "e"}));
    // theory-derivatives.md 11
    const json by_end = run["end"]["derivatives"]["q"][0];
    EXPECT_NEAR(by_end[0].get<double>(), -4.947980848111053, 1e-9);
    EXPECT_NEAR(by_end[6].get<double>(), 2.011895474797504, 1e-9);
    const json of = run["derivatives"]["of"];
    ASSERT_EQ(of.size(), 3u);
    EXPECT_EQ(of[0]["expression"], "zeno_time(2)");
    EXPECT_NEAR(of[0]["value"].get<double>(), 12.465774972267969, 1e-9);
    EXPECT_NEAR(of[0]["derivatives"][5].get<double>(), -30.31330158465276, 1e-8);
    EXPECT_NEAR(of[1]["derivatives"][5].get<double>(), 6.123710783881202 + 2.0, 1e-9);
    EXPECT_TRUE(of[2]["derivatives"][0].is_null());
    EXPECT_EQ(of[2]["reason"], "derivatives of work are not computed");
    EXPECT_GT(run["derivatives"]["margins"]["a_inf"].get<double>(), 1.0);
    EXPECT_TRUE(run["derivatives"]["margins"]["gap_minimum"].is_null());
    EXPECT_TRUE(run["derivatives"]["none_from"].is_null());
    for (const json& event : run["events"]) {
        const bool impact = event["kind"] == "impact";
        EXPECT_EQ(event["derivatives"]["t"].size(), 7u);
        EXPECT_EQ(event["derivatives"]["q"].size(), 2u);
        EXPECT_EQ(event["derivatives"].contains("v_before"), impact);
        EXPECT_EQ(event["derivatives"].contains("v"), !impact);
    }
    // Without the added fields it equals the run without derivatives, byte for byte.
    const json plain = json::parse(folder.run(exact + " --json -").out);
    run.erase("derivatives");
    run["end"].erase("derivatives");
    for (json& event : run["events"]) event.erase("derivatives");
    EXPECT_EQ(run.dump(), plain.dump());
}

TEST(Derivatives, AreInTheSummary) {
    const Folder folder;
    const Answer answer = folder.run("simulate ball_on_sine --derivatives --of \"impact_speed(1)\"");
    ASSERT_EQ(answer.status, 0) << answer.err;
    for (const char* told : {"zeno_time(1): x -4.02709", "x at the end: x -4.947", "impact_speed(1) = 0.456",
                             "smallest -hddot at a Zeno point 1.02", "Certificates do not cover derivatives."})
        EXPECT_NE(answer.out.find(told), std::string::npos) << told << "\n" << answer.out;
    const Answer stop = folder.run("simulate box_dropped_flat --derivatives");
    EXPECT_NE(stop.out.find("s on: several contacts close at the same time"), std::string::npos) << stop.out;
    const Answer other = folder.run("simulate ball_on_sine --method dopri5 --derivatives");
    EXPECT_NE(other.out.find("from the start of each dopri5 step"), std::string::npos) << other.out;
}

TEST(Derivatives, RefuseWhatCannotBe) {
    const Folder folder;
    const auto expect_refused = [&](const std::string& words, const std::string& told) {
        const Answer answer = folder.run("simulate ball_on_sine " + words);
        EXPECT_EQ(answer.status, 2) << words;
        EXPECT_NE(answer.err.find(told), std::string::npos) << answer.err;
        EXPECT_EQ(answer.out, "");
    };
    expect_refused("--derivatives --of \"zeno_tme(1)\"", "zeno_time");
    expect_refused("--derivatives --of \"x +\"", "--of x +");
    expect_refused("--of x", "--derivatives");
    expect_refused("--derivatives --reinitialization euclidean", "kinetic");
}

}  // namespace
}  // namespace achilles::test
