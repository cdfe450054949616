// The command `achilles orbit`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

TEST(OrbitCommand, TellsAPeriodicRunAsJson) {
    const Answer answer = Folder().run("orbit ball_down_a_wave --json -");
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(answer.err, "");
    const json orbit = json::parse(answer.out);
    for (const char* key : {"achilles", "system", "options", "section", "period", "state", "multipliers",
                            "zero_multipliers", "stable", "margins", "psi", "events", "derivatives", "branch"})
        EXPECT_TRUE(orbit.contains(key)) << key;
    EXPECT_NEAR(orbit["period"].get<double>(), 3.544294646668781307, 1e-12);
    EXPECT_NEAR(orbit["state"]["q"][0].get<double>(), 0.8593599338715185793874, 1e-12);
    EXPECT_EQ(orbit["state"]["t"], 0.0);
    ASSERT_EQ(orbit["multipliers"].size(), 4u);
    EXPECT_EQ(orbit["multipliers"][0], json({1.0, 0.0}));
    EXPECT_NEAR(orbit["multipliers"][1][0].get<double>(), -0.7014332700695572695, 1e-10);
    EXPECT_EQ(orbit["zero_multipliers"], 2);
    EXPECT_EQ(orbit["stable"], true);
    EXPECT_EQ(orbit["section"], "release");
    EXPECT_EQ(orbit["events"].back()["kind"], "release");
    EXPECT_NEAR(orbit["derivatives"]["b"]["q"][0].get<double>(), -1.62553706857792739, 1e-9);
    EXPECT_TRUE(orbit["branch"].is_null());
}

TEST(OrbitCommand, SummaryHasTheOrbitAndItsStability) {
    const Answer answer = Folder().run("orbit ball_down_a_wave --verbose");
    EXPECT_EQ(answer.status, 0);
    for (const char* words : {"period 3.5442946466688 s, from the release at t = 0 s", "x = 0.859359933872 m",
                              "1 (along the motion), -0.70143327007, 0, 0 (the last 2 exactly)",
                              "stable: perturbations shrink to 0.7014 of their size per period", "a_inf 2.874"})
        EXPECT_NE(answer.out.find(words), std::string::npos) << words << "\n" << answer.out;
}

TEST(OrbitCommand, AnswersFirst) {
    const Answer answer = Folder().run("orbit ball_down_a_wave");
    EXPECT_EQ(answer.out.rfind("Ball down a tilted wave: stable periodic orbit, period 3.5442946466688 s\n", 0), 0u)
        << answer.out;
    EXPECT_LE(std::count(answer.out.begin(), answer.out.end(), '\n'), 15) << answer.out;
    for (const char* words : {"multipliers   1 (along the motion), -0.70143327, 0, 0",
                              "release at 0 s, 17 impacts from 1.886433 s "
                              "before the cut, Zeno point at 2.43686 s",
                              "not a proof"})
        EXPECT_NE(answer.out.find(words), std::string::npos) << words << "\n" << answer.out;
    const Answer branch = Folder().run("orbit ball_down_a_wave --set e=0.3 --continue b=0.04:0.08");
    EXPECT_NE(branch.out.find("b = 0.06669076"), std::string::npos) << branch.out;
    EXPECT_NE(branch.out.find("period doubling (multiplier -1)"), std::string::npos) << branch.out;
}

// Starts at the end of a run, at a state in a file, and with a shift on the command line.
TEST(OrbitCommand, StartsFromARunAFileOrAShift) {
    const Folder folder;
    ASSERT_EQ(folder.run("orbit ball_down_a_wave --json orbit.json").status, 0);
    const json first = json::parse(content(folder.path() / "orbit.json"));
    const auto period = [&](const std::string& more) {
        const Answer answer = folder.run("orbit ball_down_a_wave --json - " + more);
        EXPECT_EQ(answer.status, 0) << answer.err;
        return answer.status == 0 ? json::parse(answer.out)["period"].get<double>() : 0.0;
    };
    EXPECT_NEAR(period("--from end"), first["period"].get<double>(), 1e-12);
    EXPECT_NEAR(period("--from orbit.json"), first["period"].get<double>(), 1e-12);
    EXPECT_NEAR(period("--from start --shift 'x=4*pi/2'"), first["period"].get<double>(), 1e-12);
    // Another amplitude, another period: the old orbit is only a guess.
    EXPECT_GT(std::abs(period("--set A=0.6") - first["period"].get<double>()), 1e-3);
}

TEST(OrbitCommand, FollowsABranch) {
    const Answer answer = Folder().run("orbit ball_down_a_wave --continue e=0.55:0.8 --set e=0.6 --json -");
    ASSERT_EQ(answer.status, 0) << answer.err;
    const json branch = json::parse(answer.out)["branch"];
    EXPECT_EQ(branch["parameter"], "e");
    EXPECT_GT(branch["points"].size(), 3u);
    EXPECT_EQ(branch["points"][0]["value"], 0.55);
    EXPECT_TRUE(branch["points"][0]["multipliers"].is_array() && branch["points"][0]["state"]["q"].is_array());
    EXPECT_EQ(branch["folds"], json::array());
    EXPECT_EQ(branch["flips"], json::array());
    ASSERT_EQ(branch["lost"].size(), 1u);
    EXPECT_NEAR(branch["lost"][0]["value"].get<double>(), 0.6632133961, 1e-8);
    const Answer text = Folder().run("orbit ball_down_a_wave --set e=0.3 --continue b=0.04:0.08 --verbose");
    EXPECT_NE(text.out.find("period doubling (mu = -1)  b = 0.0666907604986"), std::string::npos) << text.out;
}

TEST(OrbitCommand, RefusesWhatItCannotBeAsked) {
    const Folder folder;
    const auto told = [&](const std::string& arguments) {
        const Answer answer = folder.run("orbit " + arguments + " --json out.json");
        EXPECT_EQ(answer.status, 2) << arguments;
        EXPECT_TRUE(folder.files().empty()) << arguments;
        return answer.err;
    };
    for (const auto& [arguments, words] :
         {std::pair{"ball_down_a_wave --continue ee=0:1", "there is no parameter 'ee'; did you mean 'e'?"},
          std::pair{"ball_down_a_wave --continue e=0:0.3", "the search starts at e = 0.5, outside this range"},
          std::pair{"ball_down_a_wave --continue e=0.3", "a range is expected"},
          std::pair{"ball_down_a_wave --shift z=1", "there is no coordinate 'z'"},
          std::pair{"ball_down_a_wave --shift x=2*pie", "unknown name 'pie'; did you mean 'pi'?"},
          std::pair{"ball_down_a_wave --from nothing.json", "nothing.json: there is no such file"},
          std::pair{"ball_down_a_wave --reinitialization euclidean", "they need the kinetic reinitialization"},
          std::pair{"ball_on_table", "the period of the drive must be given"},
          std::pair{"ball_on_table --period 1", "do not repeat with this period"},
          std::pair{"ball_down_a_wave --set e=2", "restitution"}})
        EXPECT_NE(told(arguments).find(words), std::string::npos) << arguments << "\n" << told(arguments);
    const Answer none = folder.run("orbit ball_on_floor --json out.json");
    EXPECT_EQ(none.status, 3);
    EXPECT_NE(none.err.find("no periodic orbit found: "), std::string::npos) << none.err;
    EXPECT_TRUE(folder.files().empty());
}

// Pictures of one period and of the branch, and their reproduction.
TEST(OrbitCommand, DrawsWhatIsMadeAgain) {
    const Folder folder;
    ASSERT_EQ(folder.run("orbit ball_down_a_wave --json orbit.json").status, 0);
    const std::string branch = "orbit ball_down_a_wave --set e=0.3 --continue b=0.05:0.08 --from orbit.json ";
    for (const std::string& command : {branch + "--out branch.svg", branch + "--size 500x400 --out branch.png",
                                       std::string("orbit ball_down_a_wave --view path --out period.svg")}) {
        const Answer answer = folder.run(command);
        ASSERT_EQ(answer.status, 0) << answer.err;
        EXPECT_NE(answer.out.find("multipliers"), std::string::npos);
        const std::string picture = command.substr(command.rfind(' ') + 1);
        const Answer again = folder.run("reproduce " + picture);
        EXPECT_EQ(again.status, 0) << again.err;
        EXPECT_NE(again.err.find("the same bytes"), std::string::npos) << again.err;
    }
    const std::string drawn = content(folder.path() / "branch.svg");
    for (const char* words : {"period doubling", "not stable", "stable"})
        EXPECT_NE(drawn.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace achilles::test
