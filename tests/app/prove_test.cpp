// The command `achilles prove`.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace achilles::test {

using nlohmann::json;

TEST(Prove, TellsAWholeRunAsIntervals) {
    const Answer answer = Folder().run("prove ball_on_sine --end 20 --samples 5 --json -");
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(answer.err, "");
    const json proof = json::parse(answer.out);
    for (const char* key : {"achilles", "system", "claim", "proved_until", "events", "end", "samples", "outcome",
                            "statistics", "assumptions"})
        EXPECT_TRUE(proof.contains(key)) << key;
    EXPECT_EQ(proof["proved_until"], 20.0);
    EXPECT_EQ(proof["outcome"]["kind"], "end time");
    EXPECT_EQ(proof["samples"].size(), 5u);
    int zenos = 0;
    for (const json& event : proof["events"]) {
        EXPECT_EQ(event.contains("v_before") && event.contains("v_after"), event["kind"] == "impact");
        EXPECT_EQ(event.contains("v"), event["kind"] != "impact");
        EXPECT_LE(event["t"][0].get<double>(), event["t"][1].get<double>());
        zenos += event["kind"] == "zeno" ? 1 : 0;
    }
    EXPECT_EQ(zenos, 2);
    EXPECT_LT(proof["end"]["q"][0][1].get<double>() - proof["end"]["q"][0][0].get<double>(), 6e-11);
}

TEST(Prove, TellsAPersonWhatIsProvedAndWhatItStandsOn) {
    const Answer answer = Folder().run("prove ball_on_sine --end 4 --verbose");
    EXPECT_EQ(answer.status, 0);
    for (const char* words :
         {"For every start with", "is proved until t = 4", "zeno     t = 2.72514217273", "rounded to nearest"})
        EXPECT_NE(answer.out.find(words), std::string::npos) << words << "\n" << answer.out;
}

// The summary has at most 15 lines; its table has the Zeno points and the release, but no impacts.
TEST(Prove, AnswersFirst) {
    const Answer answer = Folder().run("prove ball_on_sine");
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(answer.out.rfind("Ball bouncing on a sinusoidal surface: proved to t = 20 s, the end\n\n  event ", 0), 0u)
        << answer.out;
    EXPECT_LE(std::count(answer.out.begin(), answer.out.end(), '\n'), 15) << answer.out;
    for (const char* words :
         {"\n  Zeno ", "\n  release ", "\n  end ", "Holds for x = 0, y = 2, x' = 1.5, y' = 0, m = 1"})
        EXPECT_NE(answer.out.find(words), std::string::npos) << words << "\n" << answer.out;
    EXPECT_EQ(answer.out.find("\n  impact"), std::string::npos) << answer.out;
    const Answer undecided = Folder().run("prove ball_on_sine --width 1e-3");
    EXPECT_NE(undecided.out.find(" s of 20 s, then undecided\n  "), std::string::npos) << undecided.out;
    EXPECT_NE(undecided.out.find("Try a smaller box"), std::string::npos) << undecided.out;
}

// Boxes, interval parameters, subdivision; and status 3 without an end if a box is too wide.
TEST(Prove, TakesBoxesAndInterval) {
    const Folder folder;
    const json wide = json::parse(folder.run("prove ball_on_sine --end 4 --width 1e-6 --json -").out);
    EXPECT_GT(wide["end"]["q"][0][1].get<double>() - wide["end"]["q"][0][0].get<double>(), 2e-6);
    const json parameters = json::parse(
        folder.run("prove ball_on_sine --end 4 --set e=0.4999999..0.5000001 --set x=-1e-7..1e-7 --json -").out);
    EXPECT_LE(parameters["claim"]["q"][0][0].get<double>(), -1e-7);
    EXPECT_GT(parameters["claim"]["q"][0][0].get<double>(), -1.0000001e-7);
    EXPECT_TRUE(parameters["end"].is_object());
    EXPECT_EQ(folder.run("prove ball_on_sine --end 4 --width 1e-6 --split 2").status, 0);
    const Answer undecided = folder.run("prove ball_on_sine --end 20 --width 1e-3 --json -");
    EXPECT_EQ(undecided.status, 3);
    EXPECT_NE(undecided.err.find("undecided at t = "), std::string::npos);
    EXPECT_TRUE(json::parse(undecided.out)["end"].is_null());
}

// If a proof is undecided, the reason is printed once on a terminal, and the time reached is rounded down.
TEST(Prove, SaysOnceWhyItIsUndecided) {
    const Folder folder;
    const Answer text = folder.run("prove ball_on_sine --set e=0.46..0.5 --verbose"),
                 data = folder.run("prove ball_on_sine --set e=0.46..0.5 --json -");
    EXPECT_EQ(text.status, 3);
    EXPECT_EQ(data.status, 3);
    const json proof = json::parse(data.out);
    const std::string reason = proof["outcome"]["message"];
    const auto count = [&](const std::string& all) {
        int times = 0;
        for (std::size_t at = all.find(reason); at != all.npos; at = all.find(reason, at + 1)) ++times;
        return times;
    };
    EXPECT_EQ(count(text.out), 1) << text.out;
    EXPECT_EQ(count(text.err), 0) << text.err;
    EXPECT_EQ(count(data.err), 1) << data.err;
    for (const Answer& answer : {text, data}) {
        const std::size_t at = answer.err.find("undecided at t = ");
        ASSERT_NE(at, answer.err.npos) << answer.err;
        EXPECT_LE(std::stold(answer.err.substr(at + 17)), proof["proved_until"].get<double>()) << answer.err;
    }
}

// The claim is printed with the numbers as typed.
TEST(Prove, PrintsWhatWasTyped) {
    const Folder folder;
    const Answer answer = folder.run("prove ball_on_floor --set r=0.059..0.061 --width 1e-5 --end 0.9 --verbose");
    EXPECT_NE(answer.out.find("r in [0.059, 0.061]"), std::string::npos) << answer.out;
    EXPECT_NE(answer.out.find("y in [0.99999, 1.00001]"), std::string::npos) << answer.out;
    const Answer parts = folder.run("prove ball_on_sine --end 12 --set e=0.499..0.501 --split 16 --verbose");
    EXPECT_NE(parts.out.find("7 to 8 more before the cut, by part"), std::string::npos) << parts.out;
    EXPECT_NE(parts.out.find("  release  t = 3.73"), std::string::npos) << parts.out;
}

TEST(Prove, RefusesWhatItDoesNotCoverAndWhatIsImpossible) {
    const Folder folder;
    for (const auto& [arguments, told] : std::vector<std::pair<std::string, std::string>>{
             {"ball_on_sine --set e=0.6..0.5", "LOW is above HIGH"},
             {"ball_on_sine --set e=0.9..1.1", "the part above 1 is impossible"},
             {"ball_on_sine --set y=-0.1..0.1", "the gap is negative in part of the initial box"},
             {"ball_on_sine --set e=0.5..z", "--set e=z"},
             {"ball_on_sine --width -1", "the half-width must be 0 or more"},
             {"ball_on_sine --split 0", "a whole number from 1 to 1000"}}) {
        const Answer answer = folder.run("prove " + arguments + " --json out.json");
        EXPECT_EQ(answer.status, 2) << arguments;
        EXPECT_NE(answer.err.find(told), std::string::npos) << arguments << "\n" << answer.err;
    }
    EXPECT_TRUE(folder.files().empty());
}

}  // namespace achilles::test
