// What is typed is what is meant: numbers, ranges and units on the command line, and what is said of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/program.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

TEST(Meant, AValueOutsideItsRangeIsToldOnceAndUsed) {
    const Folder folder;
    const std::string warning =
        "achilles: warning: theta1 = 30 rad is outside its range, -1.5708 to 1.5708: an angle in degrees is written 30 "
        "deg\n";
    for (const char* command : {"simulate double_pendulum --end 0.1 --set theta1=30 --json a.json",
                                "figure double_pendulum --end 0.1 --set theta1=30 --out a.svg",
                                "screenshot double_pendulum --end 0.1 --set theta1=30 --out a.png"}) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 0);
        EXPECT_EQ(answer.err, warning) << command;
    }
    EXPECT_EQ(json::parse(content(folder.path() / "a.json"))["events"].size(), 0u);
    const Answer degrees = folder.run("simulate double_pendulum --end 0.1 --set 'theta1=30 deg' --set L1=1/2 --json -");
    EXPECT_EQ(degrees.err, "");
    EXPECT_EQ(json::parse(degrees.out)["system"]["parameters"]["L1"], 0.5);
    const Answer none = folder.run("simulate double_pendulum --set 'L1=30 deg'");
    EXPECT_EQ(none.status, 2);
    EXPECT_EQ(none.err,
              "--set L1=30 deg: '30 deg' is not a finite number: 'deg' may follow a number where the unit is rad, and "
              "here it is m\n");
}

TEST(Data, HoldsTheInstantsThatWereAskedFor) {
    const Folder folder;
    ASSERT_EQ(folder.run("simulate ball_on_sine --samples 5 --json a.json --csv a.csv --plain-names").status, 0);
    const json root = json::parse(content(folder.path() / "a.json"));
    ASSERT_EQ(root["samples"].size(), 5u);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(root["samples"][static_cast<std::size_t>(i)]["t"], 5.0 * i);
    EXPECT_EQ(root["samples"][4]["q"], root["end"]["q"]);
    EXPECT_EQ(root["start"]["v"], (json{1.5, 0.0}));
    const std::string csv = content(folder.path() / "a.csv");
    EXPECT_EQ(csv.rfind("t,phase,x,y,x_rate,y_rate,gap,gap_rate,lambda_,energy,j\n0,hybrid,0,2,1.5,0,", 0), 0u) << csv;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
    folder.put("t.txt", "3\n1\n");
    const Answer answer = folder.run("simulate ball_on_sine --times t.txt --json -");
    EXPECT_EQ(json::parse(answer.out)["samples"][1]["t"], 1.0);
}

TEST(Data, InstantsThatCannotBeAreBadInput) {
    const Folder folder;
    folder.put("t.txt", "3\n21\n");
    const std::pair<const char*, const char*> mistakes[] = {
        {"--times t.txt --csv a.csv", "t.txt:2:1: 21 is outside the run, 0 to 20\n    21\n    ^\n"},
        {"--times none.txt --csv a.csv", "none.txt: there is no such file\n"},
        {"--samples 1 --csv a.csv", "--samples 1: a whole number from 2 to 1000000 is expected\n"},
        {"--samples 2.5 --csv a.csv", "--samples 2.5: a whole number from 2 to 1000000 is expected\n"},
        {"--samples 5 --times t.txt --csv a.csv", "--samples: the instants are those of --times already\n"},
        {"--samples 5", "--samples: this needs --csv F or --json F\n"},
        {"--plain-names --json a.json", "--plain-names: this needs --csv F\n"}};
    for (const auto& [arguments, message] : mistakes) {
        const Answer answer = folder.run(std::string("simulate ball_on_sine ") + arguments);
        EXPECT_EQ(answer.status, 2) << arguments;
        EXPECT_EQ(answer.err, message);
        EXPECT_EQ(folder.files().size(), 1u) << arguments;
    }
}

}  // namespace
}  // namespace achilles::test
