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

// Until runs have friction.
TEST(FrictionCommands, ProofsAreRefused) {
    const Folder folder;
    folder.put("block.toml", rough_block);
    const Answer answer = folder.run("prove ./block.toml");
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(answer.err.find("a proof does not cover friction"), std::string::npos) << answer.err;
}

TEST(FrictionCommands, TheEuclideanRestartIsRefused) {
    const Folder folder;
    folder.put("block.toml", rough_block);
    const Answer answer = folder.run("simulate ./block.toml --reinitialization euclidean");
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(answer.err.find("the euclidean reinitialization does not go with friction"), std::string::npos)
        << answer.err;
}

}  // namespace
}  // namespace achilles::test
