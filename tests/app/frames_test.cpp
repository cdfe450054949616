// Animations: which pictures there are, that an interrupted run goes on where it was, that they do not depend on who
// drew them, and that nothing of another run is lost.
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
#include "core/systems.hpp"
#include "crew.hpp"
#include "figure/animation.hpp"
#include "image/image.hpp"
#include "model/description.hpp"
#include "model/model.hpp"
#include "origin.hpp"
#include "progress.hpp"
#include "simulate/simulate.hpp"

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
    EXPECT_EQ(answer.err, "");  // no progress in a file
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
    EXPECT_NE(answer.out.find(" (3 were there)\n"), std::string::npos) << answer.out;
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
    const std::string hint = "\ndraw into another folder, or add --overwrite to replace what is there\n";

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

    // Half as long: what is left of the old ones would be the end of the film.
    const Answer replaced = folder.run(film + "--end 1 --overwrite --out film");
    EXPECT_EQ(replaced.status, 2);  // --end twice
    const std::string half = "frames ./mine.toml --end 1 --fps 2.5 --size 320x200 --scale 0.5 --view height ";
    EXPECT_EQ(folder.run(half + "--out film").status, 2);
    ASSERT_EQ(folder.run(half + "--overwrite --out film").status, 0);
    EXPECT_EQ(names(contents(folder.path() / "film")), (std::vector<std::string>(six.begin(), six.begin() + 3)));
    // The same without the word: they are of the same run.
    const Answer again = folder.run(half + "--out film");
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_NE(again.out.find("(3 were there)"), std::string::npos);

    folder.put("film/frame_00001.png", "my cat");
    const Answer cat = folder.run(half + "--out film");
    EXPECT_EQ(cat.status, 2);
    EXPECT_EQ(cat.err, "film/frame_00001.png: this is no picture of an animation" + hint);
    EXPECT_EQ(content(folder.path() / "film/frame_00001.png"), "my cat");
}

TEST(Frames, KnowWhereTheyComeFrom) {
    const Folder folder;
    ASSERT_EQ(folder.run(short_film + "--jobs 2 --out film").status, 0);
    const std::string bytes = content(folder.path() / "film/frame_00004.png");
    const Origin origin = origin_of(bytes);
    EXPECT_EQ(origin.command, "achilles " + short_film.substr(0, short_film.size() - 1));
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
        {"--out film --fps 0", "--fps 0: this must lie in [0.001, 1000]\n"},
        {"--out film --fps x", "--fps x: this is not a finite number\n"},
        {"--out film --speed -1", "--speed -1: this must lie in [1e-09, 1000000000]\n"},
        {"--out film --jobs 1.5", "--jobs 1.5: 1 to 256 processes can draw\n"},
        {"--out film --jobs 0", "--jobs 0: 1 to 256 processes can draw\n"},
        {"--out film --speed 0.001 --fps 60",
         "achilles: these would be more than 100000 frames\n"
         "fewer a second (--fps), a higher --speed or an earlier --end make it less\n"},
        {"--out film --view heigt",
         "--view heigt: this system has no view 'heigt'; did you mean 'height'?\nits views are: horizontal, height, "
         "gap, path, horizontal rate, contact force\n"},
        {"--out film --size 17000x10",
         "--size 17000x10: this is no size in pixels\nwrite WIDTHxHEIGHT, as in --size 1600x1000; each from 64 to "
         "16384\n"},
        {"--out /dev/null/film", "/dev/null/film: the folder cannot be made: Not a directory\n"},
        {"--out /proc/film", "/proc/film: the folder cannot be made: No such file or directory\n"},
        {"", "achilles: --out is required\n'achilles frames --help' tells more\n"},
    };
    for (const auto& [options, message] : cases) {
        const Answer answer = folder.run("frames ball_on_sine " + options);
        EXPECT_EQ(answer.status, 2) << options;
        EXPECT_EQ(answer.err, message);
        EXPECT_EQ(answer.out, "");
        EXPECT_TRUE(folder.files().empty()) << options;
    }
    // A file in the way of the folder; libraries that are missing, which only the drawing processes notice.
    folder.put("film", "mine");
    EXPECT_EQ(folder.run(short_film + "--out film").err, "film: the folder cannot be made: Not a directory\n");
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
    const Folder folder;
    const Answer answer =
        folder.run("frames ball_on_sine --end 1 --fps 1 --size 16384x16384 --jobs 1 --out film", "ulimit -v 1200000;");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err.rfind("achilles: ", 0), 0u) << answer.err;
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

// The whole command on a terminal of its own.
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

TEST(Progress, TellsHowMuchHowFastAndHowLong) {
    EXPECT_EQ(progress_line(0, 120, 0.5, "frames"), "[..............................]   0%  0/120 frames");
    EXPECT_EQ(progress_line(60, 120, 5.0, "frames"),
              "[###############...............]  50%  60/120 frames  12.0/s  0:05 left");
    EXPECT_EQ(progress_line(1, 1000, 1.0, "frames"),
              "[..............................]   0%  1/1000 frames  1.0/s  16:39 left");
    EXPECT_EQ(progress_line(0, 0, 0.0, "frames"), "[##############################] 100%  0/0 frames");
}

// A task writes a file, which every process can see.
TEST(Crew, DoesEveryTaskOnce) {
    for (const int jobs : {1, 2, 7}) {
        const Folder folder;
        std::size_t last = 0;
        const auto begin = [&]() -> std::function<void(std::size_t)> {
            return [&](std::size_t task) {
                EXPECT_FALSE(fs::exists(folder.path() / std::to_string(task)));
                folder.put(std::to_string(task), "done");
            };
        };
        const CrewOutcome outcome = share_work(20, jobs, begin, [&](std::size_t done) {
            EXPECT_GT(done, last);
            last = done;
        });
        EXPECT_EQ(outcome.done, 20u);
        EXPECT_EQ(outcome.signal, 0);
        EXPECT_EQ(last, 20u);
        EXPECT_EQ(folder.files().size(), 20u);
    }
    EXPECT_EQ(share_work(
                  0, 2, [] { return nullptr; }, [](std::size_t) {})
                  .done,
              0u);
}

TEST(Crew, WhereOneIsKilledTheOthersGoOn) {
    const Folder folder;
    const auto begin = [&]() -> std::function<void(std::size_t)> {
        return [&](std::size_t task) {
            if (task == 3) ::raise(SIGKILL);
            folder.put(std::to_string(task), "done");
        };
    };
    const CrewOutcome outcome = share_work(20, 2, begin, [](std::size_t) {});
    EXPECT_EQ(outcome.done, 19u);
    EXPECT_EQ(outcome.signal, SIGKILL);
    EXPECT_EQ(folder.files().size(), 19u);
    EXPECT_FALSE(fs::exists(folder.path() / "3"));
}

TEST(Crew, TheFirstProblemEndsTheWork) {
    const Folder folder;
    const auto begin = [&]() -> std::function<void(std::size_t)> {
        return [&](std::size_t task) {
            if (task == 3) throw InputError("a file", {}, "the disk is full", "make room");
            folder.put(std::to_string(task), "done");
        };
    };
    try {
        share_work(20000, 1, begin, [](std::size_t) {});
        FAIL() << "no problem was told";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "a file: the disk is full\nmake room");
        EXPECT_EQ(error.file, "a file");
    }
    EXPECT_EQ(folder.files().size(), 3u);
}

// A process that draws is killed from outside: status 3, a message, whole pictures, and the next run draws the rest.
TEST(Frames, AKilledProcessIsToldAndLeavesWholePictures) {
    const Folder folder;
    const std::string film = "frames ball_on_sine --end 20 --fps 20 --size 320x200 --scale 0.5 --jobs 1 --out film";
    fs::create_directory(folder.path() / "film");
    const int watch = ::inotify_init1(IN_CLOEXEC);
    ASSERT_GE(::inotify_add_watch(watch, (folder.path() / "film").c_str(), IN_MOVED_TO), 0);
    const pid_t id = ::fork();
    if (id == 0) {
        const std::string command =
            "cd '" + folder.path().string() + "' && exec '" ACHILLES_BINARY_DIR "/achilles' " + film + " 2>err";
        ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        ::_exit(127);
    }
    char event[4096];
    ASSERT_GT(::read(watch, event, sizeof event), 0);  // the first picture is there
    ::close(watch);
    std::ifstream children("/proc/" + std::to_string(id) + "/task/" + std::to_string(id) + "/children");
    pid_t child = 0;
    ASSERT_TRUE(children >> child);
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = -1;
    ::waitpid(id, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 3);
    const std::string err = content(folder.path() / "err");
    EXPECT_EQ(err.rfind("achilles: a process that drew was ended by signal 9: ", 0), 0u) << err;
    EXPECT_NE(err.find(" of 401 frames are missing\nthe same command draws those that are\n"), std::string::npos)
        << err;
    const Answer answer = folder.run(film);
    EXPECT_EQ(answer.status, 0) << answer.err;
    const auto files = contents(folder.path() / "film");
    EXPECT_EQ(files.size(), 401u);
    EXPECT_EQ(files.begin()->first, "frame_00000.png");
    EXPECT_EQ(files.rbegin()->first, "frame_00400.png");
}

TEST(Animation, PutsThePlotsWhereTheWorldIsLarger) {
    const Rectangle screen{0, 0, 1600, 950};
    const StillAreas wide = still_areas(4.0, 3, screen), tall = still_areas(0.8, 3, screen);
    EXPECT_EQ(wide.columns, 3);
    EXPECT_EQ(wide.world.width, 1600.0F);
    EXPECT_EQ(wide.plots.y, wide.world.y + wide.world.height);
    EXPECT_EQ(tall.columns, 1);
    EXPECT_EQ(tall.world.height, 950.0F);
    EXPECT_EQ(tall.plots.x, tall.world.width);
    EXPECT_EQ(still_areas(1.0, 0, screen).world.width, 1600.0F);
}

TEST(Animation, IsTheSameSmallerAsLongAsItCanBeRead) {
    EXPECT_DOUBLE_EQ(still_scale({1600, 1000, 1.0}), 1.3);
    EXPECT_DOUBLE_EQ(still_scale({3200, 2000, 1.0}), 2.6);
    EXPECT_DOUBLE_EQ(still_scale({3200, 1000, 2.0}), 2.6);
    EXPECT_DOUBLE_EQ(still_scale({320, 200, 1.0}), 0.5);
    EXPECT_DOUBLE_EQ(still_scale({16384, 16384, 8.0}), 11.0);
}

TEST(Animation, ShowsThePresentAndFillsThePlots) {
    const auto model = test::load("ball_on_sine");
    const Trajectory trajectory = simulate(model, model->default_run());
    const std::vector<ViewDescription> views{model->description().views[1]};  // height
    Animation animation(trajectory, views, {1600, 1000, 1.0}, 1.0 / 30.0);
    const Still before = animation.at(1.0), after = animation.at(3.2);
    EXPECT_EQ(to_text(before).substr(0, to_text(before).find("shape")),
              "Ball bouncing on a sinusoidal surface\n𝑡 = 1.00 s\nhybrid\n");
    EXPECT_NE(to_text(after).find("𝑡 = 3.20 s\nconstrained\n"), std::string::npos);

    const Panel &first = before.plots.panels[0], &second = after.plots.panels[0];
    EXPECT_EQ(first.y.low, second.y.low);
    EXPECT_EQ(first.y.high, second.y.high);
    // Pale curves of the whole run, then the curves until now.
    ASSERT_EQ(first.curves.size(), 4u);
    EXPECT_EQ(first.curves[0].points.size(), second.curves[0].points.size());
    EXPECT_LT(first.curves[0].stroke.color.a, 100);
    EXPECT_EQ(first.curves[2].points.back().x, 1.0);
    EXPECT_TRUE(first.curves[3].points.empty());
    EXPECT_EQ(second.curves[3].points.back().x, 3.2);
    // Impacts until now, then the cursor and the dot.
    ASSERT_EQ(second.markers.size(), 5u);
    EXPECT_TRUE(first.markers[0].points.empty());
    EXPECT_GT(second.markers[0].points.size(), 3u);
    for (const Point& p : second.markers[0].points) EXPECT_LE(p.x, 3.2);
    EXPECT_EQ(second.markers[1].points.size(), 1u);  // one Zeno point
    EXPECT_TRUE(second.markers[2].points.empty());   // no release yet
    EXPECT_EQ(second.markers[3].points[0].x, 3.2);
    EXPECT_EQ(second.markers[4].points[0].x, 3.2);
    EXPECT_NEAR(second.markers[4].points[0].y, Sampler(trajectory).at(3.2).state.q[1], 1e-15);
    // The ball in front of its way in contact, which is in front of the surface, then the way in flight.
    const std::vector<Shape>& shapes = after.world.shapes;
    ASSERT_EQ(shapes.size(), 4u);
    const Shape& disc = shapes[3];
    EXPECT_EQ(disc.kind, Shape::Kind::disc);
    EXPECT_TRUE(shapes[2].stroke.dash.empty());
    EXPECT_EQ(shapes[2].stroke.color.r, phase_color(light_theme(), Phase::Kind::constrained).r);
    EXPECT_EQ(shapes[1].stroke.color, light_theme().surface);
    EXPECT_FALSE(shapes[0].stroke.dash.empty());
    EXPECT_NEAR(disc.points[0].x, Sampler(trajectory).at(3.2).state.q[0], 1e-12);
}

}  // namespace
}  // namespace achilles::test
