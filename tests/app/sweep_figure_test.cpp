// `achilles sweep --out`.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/program.hpp"

namespace achilles::test {
namespace {

constexpr const char* curve = "sweep ball_on_sine --over e=0:0.9:60 --print \"zeno_time(1)\" ";

std::vector<std::string> files_in(const Folder& folder) {
    std::vector<std::string> files = folder.files();
    std::sort(files.begin(), files.end());
    return files;
}

// Written beside the table, in several formats at once, without leftovers.
TEST(SweepPicture, StandsBesideTheTable) {
    const Folder folder;
    const Answer answer = folder.run(std::string(curve) + "--csv a.csv --out a.svg --out a.png --size 600x400");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(answer.out, "");
    EXPECT_EQ(files_in(folder), (std::vector<std::string>{"a.csv", "a.png", "a.svg"}));
    const std::string svg = content(folder.path() / "a.svg");
    EXPECT_NE(svg.find("Zeno time 1 (s)"), svg.npos);
    EXPECT_NE(svg.find("the sequence of events changes"), svg.npos);
    EXPECT_NE(svg.find(" --over e=0:0.9:60 "), svg.npos) << "its title";
    EXPECT_EQ(content(folder.path() / "a.csv"), folder.run(curve).out);
}

TEST(SweepPicture, IsMadeAgain) {
    const Folder folder;
    for (const std::string& sweep :
         {std::string(curve) + "--csv a.csv --threads 1",
          std::string("sweep ball_on_sine --over x=-3:3:9 --over y=-2:2:7 --print x --print held --end 3 --dark"),
          std::string("sweep ball_on_sine --over y=1:2:9 --print x --print \"x'\" --at impact --end 3 --hdf5 a.h5"),
          std::string("sweep ball_on_sine --print x --print \"x'\" --at impact --end 3 --width-mm 85"),
          std::string("sweep ball_on_sine --over x=-3:3 --over y=-2:2 --random 30 --seed 5 --print x --end 3")}) {
        const Answer made = folder.run(sweep + " --out a.svg --out b.png");
        if (made.err.find("has no HDF5 support") != made.err.npos) continue;
        ASSERT_EQ(made.status, 0) << made.err;
        for (const char* picture : {"a.svg", "b.png"}) {
            const Answer again = folder.run(std::string("reproduce ") + picture);
            EXPECT_EQ(again.status, 0) << sweep << again.err;
            for (const char* word : {"--csv", "--hdf5", "--threads", "--out"})
                EXPECT_EQ(again.out.find(word), again.out.npos);
        }
    }
    // The system file is stored in the picture.
    folder.put("mine.toml", content(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_floor.toml"));
    ASSERT_EQ(folder.run("sweep mine.toml --over e=0:0.5:4 --print t --out c.svg").status, 0);
    folder.put("mine.toml", "broken");
    EXPECT_EQ(folder.run("reproduce c.svg").status, 0);
}

// Reproducing an untrusted picture writes no other files.
TEST(SweepPicture, UntrustedPictureWritesNoOtherFiles) {
    const Folder folder;
    ASSERT_EQ(folder.run(std::string(curve) + "--out a.svg").status, 0);
    std::string svg = content(folder.path() / "a.svg");
    const std::string before = "--over e=0:0.9:60 --print";
    for (std::size_t at = svg.find(before); at != svg.npos; at = svg.find(before, at + 30))
        svg.replace(at, before.size(), "--csv stolen.csv --resume " + before);
    folder.put("b.svg", svg);
    folder.run("reproduce b.svg");
    EXPECT_EQ(files_in(folder), (std::vector<std::string>{"a.svg", "b.svg"}));
}

TEST(SweepPicture, GoesOnWhereItWasInterrupted) {
    const Folder folder;
    const std::string sweep =
        "sweep ball_on_sine --over x=-3:3:60 --over y=-2:2:60 --print x --end 9 --size 400x300 --out ";
    ASSERT_EQ(folder.run(sweep + "whole.png").status, 0);
    // Interrupted after some chunks by a file size limit.
    const Answer cut = folder.run(sweep + "a.png", "ulimit -f 40; trap '' XFSZ; ");
    EXPECT_EQ(cut.status, 3) << cut.err;
    EXPECT_NE(cut.err.find("--resume continues from a.png.part"), cut.err.npos) << cut.err;
    EXPECT_EQ(files_in(folder), (std::vector<std::string>{"a.png.part", "whole.png"}));
    const Answer rest = folder.run(sweep + "a.png --resume");
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_EQ(files_in(folder), (std::vector<std::string>{"a.png", "whole.png"}));
    EXPECT_EQ(content(folder.path() / "a.png"), content(folder.path() / "whole.png"));
}

TEST(SweepPicture, IsAsHighAsItsPanelsNeedUnlessASizeIsGiven) {
    const Folder folder;
    std::string many = "sweep ball_on_floor --over e=0:0.5:3 --out a.svg";
    for (int i = 1; i <= 12; ++i) many += " --print " + std::to_string(i) + "*e";
    const auto is_as_ever = [&](const std::string& command) {
        EXPECT_EQ(folder.run(command).status, 0);
        return content(folder.path() / "a.svg").find("viewBox=\"0 0 1200 800\"") != std::string::npos;
    };
    EXPECT_FALSE(is_as_ever(many));
    EXPECT_EQ(folder.run("reproduce a.svg").status, 0);
    EXPECT_TRUE(is_as_ever(many + " --size 1200x800"));
    EXPECT_TRUE(is_as_ever("sweep ball_on_floor --over e=0:0.5:3 --out a.svg --print 2*e"));
}

TEST(SweepPicture, SaysWhatItLeavesOut) {
    const Folder folder;
    const std::string sweep = "sweep ball_in_sloped_box --over e_floor=0.3:0.9:4 --at impact --print x --print held ";
    const Answer answer = folder.run(sweep + "--end 2 --csv a.csv --out a.svg");
    EXPECT_EQ(answer.status, 0);
    const std::string warning = "achilles: warning: --print held: text values are not drawn in a section\n";
    EXPECT_EQ(answer.err.rfind(warning, 0), 0U) << answer.err;
    EXPECT_EQ(folder.run(sweep + "--end 2 --csv a.csv").err.find("warning"), std::string::npos) << "the table has it";
}

TEST(SweepPicture, IsRefusedBeforeTheWork) {
    const Folder folder;
    const auto refused = [&](const std::string& more) {
        const Answer answer = folder.run("sweep ball_on_sine " + more);
        EXPECT_EQ(answer.status, 2) << more;
        EXPECT_TRUE(folder.files().empty()) << more;
        return answer.err;
    };
    EXPECT_NE(refused("--over e=0:1:3 --over x=0:1:3 --over y=1:2:3 --print t --out a.png")
                  .find("--out: a sweep over 3 axes cannot be drawn"),
              std::string::npos);
    EXPECT_NE(refused("--over e=0:1:3 --print t --out a.txt").find("a.txt"), std::string::npos);
    EXPECT_NE(refused("--over e=0:1:3 --print t --out -").find("needs a file"), std::string::npos);
    EXPECT_NE(refused("--over e=0:1:3 --print t --out a.png --out a.png").find("a.png"), std::string::npos);
    EXPECT_NE(refused("--over e=0:1:20000000 --print t --out a.png").find("runs are too many for a figure"),
              std::string::npos);
    EXPECT_NE(refused("--over e=0:1:3 --print t --dark").find("--dark: this needs --out F"), std::string::npos);
    EXPECT_NE(refused("--print t").find("nothing is varied"), std::string::npos);
}

}  // namespace
}  // namespace achilles::test
