// What is typed is what is meant: numbers, ranges and units on the command line, and what is said of them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
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

}  // namespace
}  // namespace achilles::test
