// Output files are complete or unchanged, and never overwrite inputs.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "app/program.hpp"
#include "cli/write_files.hpp"
#include "system/description.hpp"

namespace achilles::test {
namespace {

namespace fs = std::filesystem;

mode_t mode_of(const fs::path& file) {
    struct stat there {};
    return ::stat(file.c_str(), &there) == 0 ? there.st_mode & 07777 : 0;
}

void write(const std::string& file, const std::string& text) {
    OutputFiles files;
    files.add(file);
    files.put(file, text);
    files.commit();
}

TEST(OutputFiles, KeepTheModeAndFollowLinks) {
    const Folder folder;
    const fs::path file = folder.path() / "a.toml", link = folder.path() / "link", dangling = folder.path() / "to_new";
    folder.put("a.toml", "old");
    ::chmod(file.c_str(), 0640);
    fs::create_symlink("a.toml", link);
    fs::create_symlink("new.toml", dangling);
    write(link, "new");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(content(file), "new");
    EXPECT_EQ(mode_of(file), 0640U);
    const mode_t mask = ::umask(0027);
    write(dangling, "made");
    ::umask(mask);
    EXPECT_TRUE(fs::is_symlink(dangling));
    EXPECT_EQ(content(folder.path() / "new.toml"), "made");
    EXPECT_EQ(mode_of(folder.path() / "new.toml"), 0640U);
    EXPECT_EQ(folder.files().size(), 4U);
}

// Leftover of a killed process, even with our process id.
TEST(OutputFiles, LeftoverPartFilesDoNotBlockWriting) {
    const Folder folder;
    folder.put("a.json.part" + std::to_string(::getpid()), "half");
    write(folder.path() / "a.json", "whole");
    EXPECT_EQ(content(folder.path() / "a.json"), "whole");
}

TEST(OutputFiles, AreAllThereOrAsTheyWere) {
    const Folder folder;
    const std::string one = folder.path() / "one", two = folder.path() / "two", three = folder.path() / "three";
    folder.put("one", "old");
    OutputFiles files;
    for (const std::string& file : {one, two, three}) {
        files.add(file);
        files.put(file, "new");
    }
    fs::create_directory(three);  // blocks the rename
    EXPECT_THROW(files.commit(), InputError);
    EXPECT_EQ(content(one), "old");
    EXPECT_FALSE(fs::exists(two));
}

TEST(OutputFiles, RejectInputsAndDuplicates) {
    const Folder folder;
    folder.put("in.toml", drop_text);
    fs::create_hard_link(folder.path() / "in.toml", folder.path() / "hard.toml");
    fs::create_symlink("in.toml", folder.path() / "soft.toml");
    folder.put("a", "old");
    fs::create_hard_link(folder.path() / "a", folder.path() / "b");
    folder.put("j.journal", "seek 0\n");
    ASSERT_EQ(folder.run("figure in.toml --out p.svg").status, 0);
    const std::string picture = content(folder.path() / "p.svg");
    const std::size_t before = folder.files().size();
    for (const std::string command :
         {"simulate in.toml --json in.toml", "simulate in.toml --csv hard.toml", "simulate soft.toml --json ./in.toml",
          "simulate in.toml --json a --csv b", "figure in.toml --out in.toml --format svg",
          "screenshot in.toml --size 640x480 --out in.toml",
          "screenshot --journal j.journal --size 640x480 --out j.journal",
          "screenshot in.toml --size 640x480 --out c.png --record c.png", "screenshot in.toml --record a --out c.png",
          "reproduce p.svg --out p.svg", "figure in.toml --do 'save c.svg' --out c.svg",
          "figure in.toml --do 'export c.svg' --out c.svg"}) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 2) << command;
        EXPECT_NE(answer.err, "") << command;
        EXPECT_EQ(content(folder.path() / "in.toml"), drop_text) << command;
        EXPECT_EQ(content(folder.path() / "a"), "old") << command;
        EXPECT_EQ(content(folder.path() / "j.journal"), "seek 0\n") << command;
        EXPECT_EQ(content(folder.path() / "p.svg"), picture) << command;
        EXPECT_EQ(folder.files().size(), before) << command;
    }
}

// If standard output cannot be written, the status reports it.
TEST(StandardOutput, FullDeviceIsAnError) {
    const Folder folder;
    folder.put("drop.toml", drop_text);
    for (const std::string arguments :
         {"--version", "--help", "simulate --help", "list", "help", "help data", "check ./drop.toml", "new mine",
          "simulate ./drop.toml", "simulate ./drop.toml --json -", "simulate ./drop.toml --csv -", "show ./drop.toml",
          "sweep ./drop.toml --over y=1:2:5 --print t", "prove ./drop.toml --end 0.1", "figure ./drop.toml --out -",
          "frames ./drop.toml --end 0.1 --size 320x200 --out film"}) {
        if (arguments.starts_with("show ") && folder.run("show --help").status != 0) continue;
        folder.put("script", "'" ACHILLES_BINARY_DIR "/achilles' " + arguments +
                                 " >/dev/full 2>err </dev/null\necho $? >status\n");
        ASSERT_EQ(std::system(("cd '" + folder.path().string() + "' && sh ./script").c_str()), 0);
        EXPECT_EQ(content(folder.path() / "status"), "2\n") << arguments;
        const std::string err = content(folder.path() / "err");
        EXPECT_NE(err.find("standard output: "), std::string::npos) << arguments << ": " << err;
    }
}

// A pipe without a reader: prints a note, waits, and then writes everything. The note of the run before is
// removed first: a shell that starts the program later would find it and read the pipe too soon.
TEST(Pipe, WaitsForAReader) {
    const Folder folder;
    folder.put("drop.toml", drop_text);
    for (const std::string arguments :
         {"simulate ./drop.toml --json pipe", "sweep ./drop.toml --over y=1:2:5 --print t --csv pipe"}) {
        folder.put("script",
                   "rm -f err\nmkfifo pipe\n'" ACHILLES_BINARY_DIR "/achilles' " + arguments +
                       " 2>err &\np=$!\nfor i in $(seq 1000); do grep -q waiting err && break; sleep 0.01; done\n"
                       "cat pipe >got\nwait $p\necho $? >status\nrm pipe\n");
        ASSERT_EQ(std::system(("cd '" + folder.path().string() + "' && timeout 60 sh ./script").c_str()), 0)
            << arguments;
        EXPECT_EQ(content(folder.path() / "status"), "0\n");
        EXPECT_NE(content(folder.path() / "err").find("pipe: waiting for a program that reads this pipe\n"),
                  std::string::npos)
            << content(folder.path() / "err");
        const std::size_t pipe = arguments.find(" pipe");
        EXPECT_EQ(content(folder.path() / "got"), folder.run(arguments.substr(0, pipe) + " -").out);
    }
}

// Lack of memory, threads or drawing libraries gives a message and status 3.
TEST(Memory, LackOfMemoryIsReported) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer reserves more memory than the limits here allow";
#endif
    const Folder folder;
    for (const std::string arguments :
         {"figure ball_on_sine --out o.png", "screenshot ball_on_sine --out o.png",
          "frames ball_on_sine --end 0.1 --size 640x480 --out film",
          "sweep ball_on_sine --over e=0:0.5:3 --print x --out o.png", "simulate ball_on_sine"})
        for (const int limit : {200000, 250000, 450000}) {
            std::filesystem::remove_all(folder.path() / "film");
            std::filesystem::remove(folder.path() / "o.png");
            const Answer answer = folder.run(arguments, "ulimit -v " + std::to_string(limit) + ";");
            if (answer.status == 0) continue;
            EXPECT_EQ(answer.status, 3) << limit << " " << arguments << answer.err;
            EXPECT_NE(answer.err.find("memory"), std::string::npos) << limit << " " << arguments << answer.err;
            EXPECT_FALSE(std::filesystem::exists(folder.path() / "o.png"));
        }
    EXPECT_EQ(folder.run("figure ball_on_sine --out o.png", "ulimit -v 200000;").status, 3);
    EXPECT_EQ(folder.run("figure ball_on_sine --out o.png", "ulimit -v 2000000;").status, 0);
}

// A recorded screenshot is reproduced from its record.
TEST(Record, IsWrittenByAScreenshot) {
    const Folder folder;
    folder.put("j.journal", "# told\nset e 0.4\n");
    const std::string size = " --size 640x480";
    const Answer made = folder.run(
        "screenshot ball_on_sine --end 5 --set x=1 --journal j.journal --do 'seek 2' --record "
        "r.journal --out a.png" +
        size);
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(content(folder.path() / "r.journal"), "open ball_on_sine\nend 5\nset x 1\nset e 0.4\nseek 2\n");
    ASSERT_EQ(folder.run("screenshot double_pendulum --journal r.journal --out b.png" + size).status, 0);
    const auto pixels = [&](const char* name) {
        const std::string bytes = content(folder.path() / name);
        return bytes.substr(bytes.find("IDAT"));
    };
    EXPECT_TRUE(pixels("a.png") == pixels("b.png"));
    EXPECT_EQ(folder.run("reproduce a.png").status, 0);
    const Answer again = folder.run("screenshot --record r.journal --out c.png" + size);
    EXPECT_EQ(again.status, 2);
    EXPECT_EQ(again.err.find("r.journal: the file already exists"), 0U) << again.err;
}

}  // namespace
}  // namespace achilles::test
