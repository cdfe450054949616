// Animations: the ffmpeg command, a missing or failing ffmpeg, and progress and cancellation of the drawing process. A
// script that writes down its arguments replaces ffmpeg.
#include "pictures/film.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/open.hpp"
#include "app/program.hpp"
#include "pictures/export.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

const std::string short_film = "frames ball_on_sine --end 2 --fps 2.5 --size 320x200 --jobs 1 --out ";

// A folder with a substitute for ffmpeg.
struct Studio : test::Folder {
    // `what`: shell commands of the substitute. $last is its output file, $said the file for its arguments.
    explicit Studio(const std::string& what =
                        "echo \"$@\" > $said; ls \"$(dirname \"$last\")\" | wc -l >> $said; echo film > \"$last\"") {
        fs::create_directory(path() / "bin");
        put("bin/ffmpeg", "#!/bin/sh\nsaid='" + (path() / "said").string() + "'\nfor last; do :; done\n" + what + "\n");
        fs::permissions(path() / "bin/ffmpeg", fs::perms::owner_all);
    }
    std::string before() const { return "PATH=" + (path() / "bin").string() + ":$PATH "; }
    test::Answer make(const std::string& arguments) const { return run(arguments, before()); }
    std::string said() const { return test::content(path() / "said"); }
};

TEST(Film, IsJoinedFromItsFramesWhichGo) {
    const Studio studio;
    const test::Answer answer = studio.make(short_film + "film.mp4");
    ASSERT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(test::content(studio.path() / "film.mp4"), "film\n");
    EXPECT_FALSE(fs::exists(studio.path() / "film.frames"));
    EXPECT_NE(studio.said().find("-framerate 2.5 -i "), std::string::npos);
    EXPECT_NE(studio.said().find("frame_%05d.png -pix_fmt yuv420p -y"), std::string::npos) << studio.said();
    EXPECT_NE(studio.said().find("\n8\n"), std::string::npos) << "six frames, a log and how far it is:\n"
                                                              << studio.said();
    ASSERT_EQ(studio.make(short_film + "film.gif").status, 0);
    EXPECT_NE(studio.said().find("palettegen"), std::string::npos);
}

// ffmpeg is looked up before any frame is drawn.
TEST(Film, WithoutFfmpegIsRefused) {
    const test::Folder folder;
    // `timeout`, with which the folder runs programs, must be found.
    const test::Answer answer =
        folder.run(short_film + "film.mp4", "PATH=/usr/bin/none:$(dirname $(command -v timeout)) ");
    if (fs::exists("/usr/bin/ffmpeg") || fs::exists("/bin/ffmpeg")) GTEST_SKIP() << "it stands beside timeout";
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err.rfind("--out film.mp4: a film needs ffmpeg, which is not installed\n", 0), 0U) << answer.err;
    EXPECT_NE(answer.err.find("achilles frames ball_on_sine --out film.frames"), std::string::npos) << answer.err;
    EXPECT_TRUE(folder.files().empty());
}

TEST(Film, HasAnEndingThatCanBeMade) {
    const Studio studio;
    for (const std::string name : {"film.avi", "film.MOV", "film.webm", "a.b/film.mkv", "film.png", "film.mp44"}) {
        const test::Answer answer = studio.make(short_film + name);
        const std::string ending = fs::path(name).extension().string().substr(1);
        EXPECT_EQ(answer.status, 2) << name;
        EXPECT_EQ(
            answer.err.find("--out " + name + ": the name of a film ends in .mp4 or .gif, but this one ends in ."), 0U)
            << answer.err;
        EXPECT_FALSE(fs::exists(studio.path() / name));
    }
    EXPECT_FALSE(fs::exists(studio.path() / "a.b"));
    // Folders: existing, with a trailing slash, or with an extension that is not a file format.
    fs::create_directory(studio.path() / "mine.frames");
    for (const std::string name : {"mine.frames", "film.avi/", "run1.5", "plain"}) {
        EXPECT_EQ(studio.make("frames ball_on_sine --end 0.5 --fps 2 --size 320x200 --out " + name).status, 0) << name;
        EXPECT_TRUE(fs::exists(studio.path() / name / "frame_00000.png")) << name;
    }
}

// Progress as ffmpeg reports it.
TEST(Film, TellsHowManyFramesAreJoined) {
    const Studio studio(
        "echo frame=3; echo progress=continue; sleep 0.5; echo frame=7; sleep 0.5; echo film > \"$last\"");
    fs::create_directory(studio.path() / "frames");
    const std::string before = std::getenv("PATH");
    ::setenv("PATH", ((studio.path() / "bin").string() + ":" + before).c_str(), 1);
    std::vector<std::size_t> told;
    const std::string film =
        joined({studio.path() / "frames", 30.0, 320, 200}, (studio.path() / "a.mp4").string(), [&](std::size_t frames) {
            if (told.empty() || told.back() != frames) told.push_back(frames);
        });
    ::setenv("PATH", before.c_str(), 1);
    EXPECT_EQ(film, "film\n");
    if (!told.empty() && told.front() == 0) told.erase(told.begin());
    EXPECT_EQ(told, (std::vector<std::size_t>{3, 7}));
    EXPECT_TRUE(fs::is_empty(studio.path() / "frames"));
}

// If joining fails, the old file and the frames are kept; the frames are not drawn again.
TEST(Film, FailedJoiningKeepsTheOldFileAndTheFrames) {
    const Studio studio("echo no such codec >&2; exit 1");
    studio.put("film.mp4", "another film");
    const test::Answer answer = studio.make(short_film + "film.mp4");
    EXPECT_EQ(answer.status, 3);
    EXPECT_NE(answer.err.find("no such codec"), std::string::npos) << answer.err;
    EXPECT_EQ(test::content(studio.path() / "film.mp4"), "another film");
    EXPECT_TRUE(fs::exists(studio.path() / "film.frames/frame_00005.png"));
    EXPECT_FALSE(fs::exists(studio.path() / "film.frames/joined.mp4"));
}

TEST(Film, GoesOverNoInputAndIntoNoFramesOfAnother) {
    const Studio studio;
    studio.put("film.mp4", test::drop_text);
    EXPECT_EQ(studio.make("frames ./film.mp4 --out film.mp4").status, 2);
    EXPECT_EQ(test::content(studio.path() / "film.mp4"), test::drop_text);
    ASSERT_EQ(studio.run("frames ball_on_sine --end 1 --fps 2 --size 320x200 --out other.frames").status, 0);
    const test::Answer answer = studio.make(short_film + "other.mp4");
    EXPECT_EQ(answer.status, 2);
    EXPECT_FALSE(fs::exists(studio.path() / "other.mp4"));
}

TEST(Film, ShowsThePlotsThatCommandsAskFor) {
    const test::Folder folder;
    const std::string words = "frames ball_on_sine --end 1 --fps 1 --size 320x200 --jobs 1 ";
    ASSERT_EQ(folder.run(words + "--do 'grid 1 1' --do 'plot 1 x y' --out a").status, 0);
    ASSERT_EQ(folder.run(words + "--out b").status, 0);
    EXPECT_NE(test::content(folder.path() / "a/frame_00001.png"), test::content(folder.path() / "b/frame_00001.png"));
    EXPECT_EQ(folder.run("reproduce a/frame_00001.png").status, 0);
    EXPECT_EQ(folder.run(words + "--do 'grid 1 1' --view height --out c").status, 2);
}

// A session starts it in another process with its own text, and can stop it.
TEST(Film, OfASessionIsFollowedAndStopped) {
    const Studio studio;  // its ffmpeg is never run
    const test::Folder folder;
    const std::string before = std::getenv("PATH");
    ::setenv("PATH", ((studio.path() / "bin").string() + ":" + before).c_str(), 1);
    Session session = test::session("ball_on_sine");
    session.apply(command::SetText{session.document().text + "# not saved\n"});
    session.apply(command::SetEndTime{2000.0});
    command::Export what{(folder.path() / "film.mp4").string(), false, 0};
    what.pixels = 640;
    EXPECT_THROW(begin_film(session, what), InputError) << "60000 frames";
    what.fps = 1.0;
    const auto film = begin_film(session, what);
    for (int i = 0; i < 600 && film->progress().empty() && !film->update(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_NE(film->progress().find("/2001 frames"), std::string::npos) << film->progress() << film->output();
    film->cancel();
    EXPECT_TRUE(film->update());
    EXPECT_TRUE(folder.files().empty()) << "a film that is given up leaves something";
    ::setenv("PATH", before.c_str(), 1);
}

TEST(Film, OfASessionIsCheckedBeforeItIsBegun) {
    const test::Folder folder;
    Session session = test::session("ball_on_sine");
    const std::string file = (folder.path() / "film.mp4").string();
    for (const char* line : {"plot 1", "mechanism", "width 85", "pixels 100", "fps 1e7"}) {
        session.apply(parse_command("export " + file + " " + line));
        EXPECT_NE(session.error(), "") << line;
    }
    folder.put("film.mp4", "there");
    session.apply(parse_command("export " + file));
    EXPECT_NE(session.error().find("the file already exists"), std::string::npos);
}

}  // namespace
}  // namespace achilles
