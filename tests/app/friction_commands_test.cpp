// What the commands do with a file that has friction.
#include <gtest/gtest.h>

#include <string>

#include "app/program.hpp"

namespace achilles::test {
namespace {

const std::string rough_block = R"toml(title = "block"
coordinate = [{name = "x", rate = 1}, {name = "y"}]
parameter = [{name = "mu", value = 0.3}]
lagrangian.kinetic = "1/2*(x'^2 + y'^2)"
lagrangian.potential = "y"
constraint = [{name = "floor", gap = "y", slip = "x'", friction = "mu", restitution = 0}]
friction = [{name = "guide", slip = "x' - 1/5", level = "0.1 + slip", static_level = 0.2}]
orbit = {q = [0, 0], v = [0, 0], period = 1}
)toml";

TEST(FrictionCommands, CheckPrintsTheFriction) {
    const Folder folder;
    folder.put("block.toml", rough_block);
    for (const char* how : {"", " --verbose"}) {
        const Answer answer = folder.run(std::string("check ./block.toml") + how);
        EXPECT_EQ(answer.status, 0) << answer.err;
        EXPECT_NE(answer.out.find("floor  slip = x', coefficient mu = 0.3\n"), std::string::npos) << answer.out;
        EXPECT_NE(answer.out.find("guide  slip = x' - 1/5, level 0.1 + slip = 0.9 at the start, static 0.2"),
                  std::string::npos)
            << answer.out;
    }
    EXPECT_EQ(folder.run("check ./block.toml --latex").status, 0);
    const Answer expanded = folder.run("check ./block.toml --expand");
    EXPECT_NE(expanded.out.find("friction = \"mu\""), std::string::npos) << expanded.out;
}

TEST(FrictionCommands, ProofsAreRefused) {
    const Folder folder;
    folder.put("block.toml", rough_block);
    const Answer answer = folder.run("prove ./block.toml");
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(answer.err.find("a proof does not cover dry friction"), std::string::npos) << answer.err;
}

// Events are numbered as in sweeps, those of one kind from 1 on.
TEST(FrictionCommands, DerivativesNumberEventsByKind) {
    const Folder folder;
    const Answer run = folder.run("simulate stick_slip_belt --end 15 --derivatives");
    EXPECT_EQ(run.status, 0) << run.err;
    for (const char* name : {"  slip_time(1): ", "  stick_time(1): ", "  slip_time(2): "})
        EXPECT_NE(run.out.find(name), std::string::npos) << name << run.out;
    EXPECT_EQ(run.out.find("slip_time(3)"), std::string::npos) << run.out;
    const Answer sweep = folder.run("sweep stick_slip_belt --over k=1:2:2 --end 15 --csv - --at stick --print x");
    EXPECT_EQ(sweep.status, 0) << sweep.err;
    EXPECT_EQ(sweep.out.substr(0, 22), "k,t,contact,x,outcome\n") << sweep.out;
    const Answer wrong = folder.run("sweep stick_slip_belt --over k=1:2:2 --csv - --at some_event --print t");
    EXPECT_EQ(wrong.status, 2);
    const Answer smooth = folder.run("sweep ball_on_sine --over e=0:0.5:2 --csv - --at stick --print t");
    EXPECT_EQ(smooth.status, 2);
    EXPECT_EQ(smooth.err, "--at stick: only systems with friction have this event\n");
    EXPECT_NE(wrong.err.find("write --at impact, --at zeno, --at release, --at stick, --at slip or --at reversal"),
              std::string::npos)
        << wrong.err;
}

TEST(FrictionCommands, SweepsPrintNoNegativeZero) {
    const Folder folder;
    folder.put("block.toml", rough_block);
    const Answer answer = folder.run(
        "sweep ./block.toml --over mu=0:0.1:2 --end 0.5 --print friction_force_floor "
        "--csv f.csv");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_NE(answer.err.find("-0.1 to 0 in 2 runs"), std::string::npos) << answer.err;
}

TEST(FrictionCommands, TheEuclideanRestartIsRefused) {
    const Folder folder;
    folder.put("block.toml", rough_block);
    const Answer answer = folder.run("simulate ./block.toml --reinitialization euclidean");
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(answer.err.find("the euclidean reinitialization cannot be used with friction"), std::string::npos)
        << answer.err;
}

}  // namespace
}  // namespace achilles::test
