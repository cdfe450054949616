// Animation frames: which ones are drawn, continuation after an interruption, independence from the number of
// processes, and protection of frames of other runs.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>

#include "app/program.hpp"
#include "image/image.hpp"
#include "pictures/origin.hpp"

namespace achilles::test {
namespace {

namespace fs = std::filesystem;

// Six small pictures: 0, 0.4, ... 2.0 s.
const std::string short_film = "frames ball_on_sine --end 2 --fps 2.5 --size 320x200 --scale 0.5 --view height ";

std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder))
        files[entry.path().filename().string()] = content(entry.path());
    return files;
}

std::vector<std::string> names(const std::map<std::string, std::string>& files) {
    std::vector<std::string> result;
    for (const auto& [name, bytes] : files) result.push_back(name);
    return result;
}

const std::vector<std::string> six{"frame_00000.png", "frame_00001.png", "frame_00002.png",
                                   "frame_00003.png", "frame_00004.png", "frame_00005.png"};

TEST(Frames, AreNumberedAndTheSameByOneProcessAndByThree) {
    const Folder folder;
    const Answer answer = folder.run(short_film + "--jobs 1 --out one");
    ASSERT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(answer.err, "");  // no progress if standard error is a file
    const std::string at = fs::canonical(folder.path()).string() + "/one";
    EXPECT_EQ(answer.out, "6 frames of 320x200 in " + at + "\nffmpeg -framerate 2.5 -i " + at +
                              "/frame_%05d.png -pix_fmt yuv420p ball_on_sine.mp4\n");
    ASSERT_EQ(folder.run(short_film + "--jobs=3 --out three").status, 0);
    const auto one = contents(folder.path() / "one"), three = contents(folder.path() / "three");
    EXPECT_EQ(names(one), six);
    EXPECT_EQ(one, three);
    for (const auto& [name, bytes] : one)
        for (const auto& [other, others_bytes] : one) EXPECT_EQ(bytes == others_bytes, name == other) << name << other;
    const Image image = read_png(folder.path() / "one/frame_00003.png");
    EXPECT_EQ(image.width, 320);
    EXPECT_EQ(image.height, 200);
}

TEST(Frames, BeginWhereTheRunDoes) {
    const Folder folder;
    const std::string film = "frames ball_on_sine --size 320x200 --fps 1 --view height --out ";
    ASSERT_EQ(folder.run(film + "here --start-time 5 --end 7").status, 0);
    EXPECT_EQ(contents(folder.path() / "here").size(), 3u);
    ASSERT_EQ(folder.run(film + "there --start-time -1 --end 1").status, 0);
    EXPECT_EQ(contents(folder.path() / "there").size(), 3u);
}

TEST(Frames, GoOnWhereARunWasInterrupted) {
    const Folder folder;
    ASSERT_EQ(folder.run(short_film + "--out film").status, 0);
    const fs::path film = folder.path() / "film";
    const auto before = contents(film);
    fs::remove(film / "frame_00002.png");
    folder.put("film/frame_00004.png", before.at("frame_00004.png").substr(0, 3000));
    folder.put("film/frame_00005.png", "");
    folder.put("film/frame_00001.png.part12345", "half a picture");
    folder.put("film/notes.txt", "mine");
    const auto kept = fs::last_write_time(film / "frame_00003.png");
    const Answer answer = folder.run(short_film + "--out film");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_NE(answer.out.find("6 frames of 320x200 in "), std::string::npos);
    EXPECT_NE(answer.out.find(" (3 already existed)\n"), std::string::npos) << answer.out;
    EXPECT_EQ(fs::last_write_time(film / "frame_00003.png"), kept);
    EXPECT_EQ(content(film / "notes.txt"), "mine");
    fs::remove(film / "notes.txt");
    EXPECT_EQ(contents(film), before);
}

TEST(Frames, OfAnotherRunAreNeitherMixedNorLost) {
    const Folder folder;
    const auto system = content(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml");
    folder.put("mine.toml", system);
    const std::string film = "frames ./mine.toml --end 2 --fps 2.5 --size 320x200 --scale 0.5 --view height ";
    ASSERT_EQ(folder.run(film + "--out film").status, 0);
    const auto before = contents(folder.path() / "film");
    const std::string hint = "\ndraw into another folder, or add --overwrite to replace this file\n";

    const Answer other = folder.run(film + "--set e=0.4 --out film");
    EXPECT_EQ(other.status, 2);
    EXPECT_EQ(other.err, "film/frame_00000.png: this picture was made by another command:\n    achilles " +
                             film.substr(0, film.size() - 1) + hint);
    folder.put("mine.toml", system + "# changed\n");
    const Answer changed = folder.run(film + "--out film");
    EXPECT_EQ(changed.status, 2);
    EXPECT_EQ(
        changed.err,
        "film/frame_00000.png: this picture was made by the same command, but from a system file that has changed "
        "since" +
            hint);
    EXPECT_EQ(contents(folder.path() / "film"), before);

    // Half as long: leftover frames of the old animation would appear at its end.
    const Answer replaced = folder.run(film + "--end 1 --overwrite --out film");
    EXPECT_EQ(replaced.status, 2);  // --end twice
    const std::string half = "frames ./mine.toml --end 1 --fps 2.5 --size 320x200 --scale 0.5 --view height ";
    EXPECT_EQ(folder.run(half + "--out film").status, 2);
    ASSERT_EQ(folder.run(half + "--overwrite --out film").status, 0);
    EXPECT_EQ(names(contents(folder.path() / "film")), (std::vector<std::string>(six.begin(), six.begin() + 3)));
    // Without --overwrite: the frames belong to the same run.
    const Answer again = folder.run(half + "--out film");
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_NE(again.out.find("(3 already existed)"), std::string::npos);

    folder.put("film/frame_00001.png", "my cat");
    const Answer cat = folder.run(half + "--out film");
    EXPECT_EQ(cat.status, 2);
    EXPECT_EQ(cat.err, "film/frame_00001.png: this is not a frame of an animation" + hint);
    EXPECT_EQ(content(folder.path() / "film/frame_00001.png"), "my cat");
}

TEST(Frames, KnowWhereTheyComeFrom) {
    const Folder folder;
    const std::string film = short_film + "--camera follow";
    ASSERT_EQ(folder.run(film + " --jobs 2 --out film").status, 0);
    const std::string bytes = content(folder.path() / "film/frame_00004.png");
    const Origin origin = origin_of(bytes);
    EXPECT_EQ(origin.command, "achilles " + film);
    EXPECT_EQ(origin.picture, "frame_00004");
    ASSERT_EQ(origin.sources.size(), 1u);
    EXPECT_EQ(origin.sources[0].text, content(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml"));
    const Answer answer = folder.run("reproduce film/frame_00004.png --out again.png");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(content(folder.path() / "again.png"), bytes);
    EXPECT_EQ(folder.files().size(), 2u);
}

TEST(Frames, RefusalsAreOneMessageAndLeaveNothing) {
    const Folder folder;
    const std::pair<std::string, std::string> cases[] = {
        {"--out film --fps 0", "--fps 0: the value must lie in [0.001, 1000]\n"},
        {"--out film --fps x", "--fps x: 'x' is not a finite number: pi is the only name allowed here\n"},
        {"--out film --speed -1", "--speed -1: the value must lie in [1e-09, 1000000000]\n"},
        {"--out film --camera fixed", "--camera fixed: the camera must be fit, follow or zeno\n"},
        {"--out film --jobs 1.5", "--jobs 1.5: the number of processes must be a whole number from 1 to 256\n"},
        {"--out film --jobs 0", "--jobs 0: the number of processes must be a whole number from 1 to 256\n"},
        {"--out film --speed 0.001 --fps 60",
         "achilles: this would take more than 100000 frames\nuse a lower --fps, a higher --speed or an earlier "
         "--end\n"},
        {"--out film --view heigt",
         "--view heigt: this system has no view 'heigt'; did you mean 'height'?\nits views are: horizontal, height, "
         "gap, path, horizontal rate, contact force\n"},
        {"--out film --size 17000x10",
         "--size 17000x10: this is not a size in pixels\nwrite WIDTHxHEIGHT, as in --size 1600x1000; each from 64 to "
         "16384\n"},
        {"--out /dev/null/film", "/dev/null/film: the folder cannot be created: Not a directory\n"},
        {"--out /proc/film", "/proc/film: the folder cannot be created: No such file or directory\n"},
        {"", "achilles: --out is missing; write --out F.mp4\n"},
    };
    for (const auto& [options, message] : cases) {
        const Answer answer = folder.run("frames ball_on_sine " + options);
        EXPECT_EQ(answer.status, 2) << options;
        EXPECT_EQ(answer.err, message);
        EXPECT_EQ(answer.out, "");
        EXPECT_TRUE(folder.files().empty()) << options;
    }
    // A file in place of the folder; missing libraries, which only the drawing processes notice.
    folder.put("film", "mine");
    EXPECT_EQ(folder.run(short_film + "--out film").err, "film: the folder cannot be created: Not a directory\n");
    const Folder hidden;
    hidden.put("libOSMesa.so.8", "");
    hidden.put("libEGL.so.1", "");
    const Answer without = folder.run(short_film + "--out new", "LD_LIBRARY_PATH='" + hidden.path().string() + "'");
    EXPECT_EQ(without.status, 2);
    EXPECT_EQ(without.err.rfind("achilles: drawing without a window needs OSMesa or EGL, but ", 0), 0u) << without.err;
    EXPECT_EQ(std::count(without.err.begin(), without.err.end(), '\n'), 2);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"film"});
}

TEST(Frames, TooLittleMemoryIsAMessage) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer needs more address space than this test allows";
#endif
    const Folder folder;
    const Answer answer =
        folder.run("frames ball_on_sine --end 1 --fps 1 --size 16384x16384 --jobs 1 --out film", "ulimit -v 1200000;");
    EXPECT_EQ(answer.status, 3);
    EXPECT_EQ(answer.err.rfind("achilles: there is not enough memory for drawing", 0), 0u) << answer.err;
    EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
    EXPECT_TRUE(folder.files().empty());
}

TEST(Frames, AFolderInUseIsLeftAlone) {
    const Folder folder;
    fs::create_directory(folder.path() / "film");
    const int lock = ::open((folder.path() / "film").c_str(), O_RDONLY | O_DIRECTORY);
    ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
    const Answer answer = folder.run(short_film + "--out film");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err, "film: another process is drawing into this folder\n");
    EXPECT_TRUE(contents(folder.path() / "film").empty());
    ::close(lock);
}

TEST(Frames, ARunThatStoppedEarlyIsDrawnAsFarAsItCame) {
    const Folder folder;
    const Answer answer =
        folder.run("frames ball_on_sine --max-impacts 3 --fps 1 --size 320x200 --scale 0.5 --out film");
    EXPECT_EQ(answer.status, 3);
    EXPECT_EQ(answer.err.rfind("achilles: the run stopped early: ", 0), 0u) << answer.err;
    EXPECT_EQ(names(contents(folder.path() / "film")), (std::vector<std::string>(six.begin(), six.begin() + 3)));
}

// The complete command on a pseudoterminal.
TEST(Frames, ATerminalSeesTheProgress) {
    const Folder folder;
    const std::string out = (folder.path() / "film").string();
    int terminal = -1;
    const pid_t id = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    ASSERT_GE(id, 0);
    if (id == 0) {
        ::execl(ACHILLES_BINARY_DIR "/achilles", "achilles", "frames", "ball_on_sine", "--end", "1", "--fps", "2",
                "--size", "320x200", "--scale", "0.5", "--out", out.c_str(), nullptr);
        ::_exit(127);
    }
    std::string seen;
    char buffer[1024];
    for (ssize_t count; (count = ::read(terminal, buffer, sizeof buffer)) > 0;)
        seen.append(buffer, static_cast<std::size_t>(count));
    int status = -1;
    ::waitpid(id, &status, 0);
    ::close(terminal);
    EXPECT_EQ(WEXITSTATUS(status), 0) << seen;
    EXPECT_NE(seen.find("[..............................]   0%  0/3 frames"), std::string::npos) << seen;
    EXPECT_NE(seen.find("[##############################] 100%  3/3 frames"), std::string::npos) << seen;
    EXPECT_NE(seen.find("\r\x1b[K3 frames of 320x200 in "), std::string::npos) << seen;
}

// The program in its own process, drawing 161 pictures into "film" with one worker. Its first picture exists.
class Drawing161 {
 public:
    explicit Drawing161(const Folder& folder) {
        fs::create_directory(folder.path() / "film");
        const int watch = ::inotify_init1(IN_CLOEXEC);
        ::inotify_add_watch(watch, (folder.path() / "film").c_str(), IN_MOVED_TO);
        // At low priority the drawing cannot finish before the test stops it, even on a busy machine.
        const std::string command = "cd '" + folder.path().string() +
                                    "' && exec nice -n 19 '" ACHILLES_BINARY_DIR "/achilles' " + film161 + " 2>err";
        id_ = ::fork();
        if (id_ == 0) {
            ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            ::_exit(127);
        }
        char event[4096];
        EXPECT_GT(::read(watch, event, sizeof event), 0);
        ::close(watch);
    }
    pid_t id() const { return id_; }
    pid_t child() const {
        std::ifstream children("/proc/" + std::to_string(id_) + "/task/" + std::to_string(id_) + "/children");
        pid_t first = 0;
        EXPECT_TRUE(children >> first);
        return first;
    }
    int wait() const {
        int status = -1;
        ::waitpid(id_, &status, 0);
        return status;
    }
    static constexpr const char* film161 =
        "frames ball_on_sine --end 20 --fps 8 --size 320x200 --scale 0.5 --jobs 1 --out film";

 private:
    pid_t id_ = 0;
};

// Repeats the command and checks that all pictures are complete.
void expect_completed(const Folder& folder) {
    const Answer answer = folder.run(Drawing161::film161);
    EXPECT_EQ(answer.status, 0) << answer.err;
    const auto files = contents(folder.path() / "film");
    EXPECT_EQ(files.size(), 161u);
    EXPECT_EQ(files.begin()->first, "frame_00000.png");
    EXPECT_EQ(files.rbegin()->first, "frame_00160.png");
    for (const auto& [name, bytes] : files) EXPECT_EQ(origin_of(bytes).picture + ".png", name);
}

TEST(Frames, AKilledProcessIsToldAndLeavesWholePictures) {
    const Folder folder;
    const Drawing161 drawing(folder);
    ASSERT_EQ(::kill(drawing.child(), SIGKILL), 0);
    EXPECT_EQ(WEXITSTATUS(drawing.wait()), 3);
    const std::string err = content(folder.path() / "err");
    EXPECT_EQ(err.rfind("achilles: a drawing process was ended by signal 9: ", 0), 0u) << err;
    EXPECT_NE(err.find(" of 161 frames are missing\nrun the same command again to draw them\n"), std::string::npos)
        << err;
    expect_completed(folder);
}

// The drawing processes then end by themselves and release the folder.
TEST(Frames, WorkersEndIfTheProgramIsKilled) {
    const Folder folder;
    const Drawing161 drawing(folder);
    ASSERT_EQ(::kill(drawing.id(), SIGKILL), 0);
    EXPECT_TRUE(WIFSIGNALED(drawing.wait()));
    const int lock = ::open((folder.path() / "film").c_str(), O_RDONLY | O_DIRECTORY);
    EXPECT_EQ(::flock(lock, LOCK_EX), 0);
    EXPECT_LT(contents(folder.path() / "film").size(), 161u);
    ::close(lock);
    expect_completed(folder);
}

}  // namespace
}  // namespace achilles::test
