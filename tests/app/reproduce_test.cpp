// Pictures that store their origin: reproduced from their own content, whatever became of the files.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/program.hpp"
#include "core/deny_executable.hpp"
#include "image/image.hpp"
#include "image/notes.hpp"
#include "pictures/origin.hpp"

namespace achilles::test {
namespace {

// A system file with content that could get lost: carriage returns, letters beyond Latin-1, XML markup.
const std::string falling_ball =
    "title = \"Ein Ball f\xC3\xA4llt: \xCE\xB8 < 3 & \\\"so\\\"\"\r\n# ]]> 'x'\r\n"
    "[[coordinate]]\nname = \"y\"\nstart = 1.0\nunit = \"m\"\n[[parameter]]\nname = \"g\"\nvalue = 9.81\n"
    "[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"g*y\"\n[[constraint]]\ngap = \"y\"\nrestitution = 0.5\n"
    "[run]\nend_time = 5.0\n";

const std::string figure_arguments = "figure ./drop.toml --set g=3 --set \"y'=0.5\" --size 400x300 --out ";

TEST(Origin, ACommandLineKeepsItsWords) {
    const std::vector<std::string> words{"figure", "a b'c.toml", "--out",   "x.png", "--set",     "x'=1.5",
                                         "",       "--size=3x4", "--out=y", "a\nb",  "\xCE\xB8=1"};
    const std::string text = command_line(words);
    EXPECT_EQ(text, "achilles figure 'a b'\\''c.toml' --set 'x'\\''=1.5' '' --size=3x4 'a\nb' '\xCE\xB8=1'");
    EXPECT_EQ(words_of(text), (std::vector<std::string>{"figure", "a b'c.toml", "--set", "x'=1.5", "", "--size=3x4",
                                                        "a\nb", "\xCE\xB8=1"}));
    EXPECT_EQ(command_line({"figure", "--", "--out"}), "achilles figure -- --out");
    for (const char* damaged : {"", "rm -rf", "achilles 'a", "achilles  a", "achilles a'b'", "achilles $(x)"})
        EXPECT_THROW(words_of(damaged), std::runtime_error) << damaged;
}

class ReproducedPicture : public testing::TestWithParam<std::string> {
 protected:
    void SetUp() override {
        if (GetParam() == "pdf" && std::system("rsvg-convert --version >/dev/null 2>&1") != 0)
            GTEST_SKIP() << "without rsvg-convert";
    }
};

// A mechanism typed as bodies: the picture carries the bodies, not the energies made of them.
TEST_P(ReproducedPicture, KeepsBodiesAsTyped) {
    const Folder folder;
    const std::string leg = content(ACHILLES_SOURCE_DIR "/tests/reference/mechanisms/kneed_leg.toml");
    folder.put("leg.toml", leg);
    const std::string picture = "leg." + GetParam();
    ASSERT_EQ(folder.run("figure ./leg.toml --set mt=9 --end 1 --size 400x300 --out " + picture).status, 0);
    EXPECT_EQ(origin_of(content(folder.path() / picture)).sources.at(0).text, leg);
    std::filesystem::remove(folder.path() / "leg.toml");
    const Answer again = folder.run("reproduce " + picture);
    EXPECT_EQ(again.err, "achilles: " + picture + ": reproduced with the same bytes\n");
}

TEST_P(ReproducedPicture, FromWhatItCarriesWhateverBecameOfTheFile) {
    const Folder folder;
    folder.put("drop.toml", falling_ball);
    const std::string picture = "picture." + GetParam();
    ASSERT_EQ(folder.run(figure_arguments + picture).status, 0);
    const std::string bytes = content(folder.path() / picture);

    const Origin origin = origin_of(bytes);
    EXPECT_EQ(origin.software, "Achilles 0.1.0");
    EXPECT_EQ(origin.command, "achilles figure ./drop.toml --set g=3 --set 'y'\\''=0.5' --size 400x300");
    ASSERT_EQ(origin.sources.size(), 1u);
    EXPECT_EQ(origin.sources[0].name, "./drop.toml");
    EXPECT_EQ(origin.sources[0].text, falling_ball);

    folder.put("drop.toml", "title = \"another\"\n");
    const Answer altered = folder.run("reproduce " + picture + " --out again");
    EXPECT_EQ(altered.status, 0) << altered.err;
    EXPECT_EQ(altered.out, origin.command + "\n");
    EXPECT_EQ(content(folder.path() / "again"), bytes);
    std::filesystem::remove(folder.path() / "drop.toml");
    EXPECT_EQ(folder.run("reproduce " + picture + " --out -").out, bytes);
    const Answer compared = folder.run("reproduce " + picture);
    EXPECT_EQ(compared.status, 0) << compared.err;
    EXPECT_EQ(compared.err, "achilles: " + picture + ": reproduced with the same bytes\n");
    EXPECT_EQ(folder.files().size(), 2u);
}

TEST_P(ReproducedPicture, TellsAReaderParametersOptionsAndCertificates) {
    const Folder folder;
    folder.put("drop.toml", falling_ball);
    ASSERT_EQ(folder.run(figure_arguments + "a." + GetParam()).status, 0);
    const std::string bytes = content(folder.path() / ("a." + GetParam()));
    std::string all;
    for (const Note& note : notes_of(bytes)) all += note.keyword + ": " + note.text + "\n";
    for (const char* part :
         {"Title: Ein Ball f\xC3\xA4llt: \xCE\xB8 < 3 & \"so\"\n", "Software: Achilles 0.1.0\n",
          "Achilles Parameters: g = 3, y(0) = 1, y'(0) = 0.5\n",
          "Achilles Options: tolerance 1e-10, method taylor, end time 5, ", "Achilles Certificates: Zeno point at t = ",
          ": certified for the exact motion from the computed state at the cut: Zeno time tau_inf in [",
          "outcome: end time"})
        EXPECT_NE(all.find(part), std::string::npos) << part << all;
}

// The notes state limits of the run; the limit of steps only if it was set.
TEST_P(ReproducedPicture, TellsAReaderOfALimitOfSteps) {
    const Folder folder;
    folder.put("drop.toml", falling_ball);
    for (const bool limited : {false, true}) {
        const std::string picture = "a." + GetParam();
        ASSERT_EQ(folder.run(figure_arguments + picture + (limited ? " --max-steps 100000" : "")).status, 0);
        const std::string bytes = content(folder.path() / picture);
        std::string told;
        for (const Note& note : notes_of(bytes))
            if (note.keyword == "Achilles Options") told = note.text;
        EXPECT_EQ(told.find("at most 200000 impacts, at most 100000 steps, ") != std::string::npos, limited) << told;
        EXPECT_EQ(told.find("steps") != std::string::npos, limited) << told;
    }
}

TEST_P(ReproducedPicture, ADifferenceIsTold) {
    const Folder folder;
    folder.put("drop.toml", falling_ball);
    const std::string picture = "a." + GetParam();
    ASSERT_EQ(folder.run(figure_arguments + picture).status, 0);
    const std::string bytes = content(folder.path() / picture);
    if (picture_format(bytes) == "png") {
        // Another version, with valid checksums.
        Notes notes = png_notes(bytes);
        notes[1].text = "Achilles 0.0.9";
        folder.put(picture, with_notes(bytes.substr(0, 33) + bytes.substr(bytes.find("IDAT") - 4), notes));
    } else {
        std::string other = bytes;
        other.replace(other.find("Achilles 0.1.0"), 14, "Achilles 0.0.9");
        folder.put(picture, other);
    }
    const Answer answer = folder.run("reproduce " + picture + " --out again");
    EXPECT_EQ(answer.status, 1);
    EXPECT_EQ(answer.err,
              "achilles: " + picture +
                  ": reproduced with different bytes (it was made by Achilles 0.0.9, this is Achilles 0.1.0)\n");
    EXPECT_EQ(content(folder.path() / "again"), bytes);
}

INSTANTIATE_TEST_SUITE_P(Origin, ReproducedPicture, testing::Values("png", "svg", "pdf"));

TEST(Reproduce, PaperAndScreenshotWithItsJournal) {
    const Folder folder;
    ASSERT_EQ(folder.run("paper --scale 0.5").status, 0);
    ASSERT_EQ(folder.run("paper --format svg --out svg").status, 0);
    folder.put("drop.toml", falling_ball);
    folder.put("tour.journal",
               "open ./drop.toml\r\nset g 2 # Gr\xC3\xB6\xC3\x9F"
               "e\nseek 0.4\n");
    ASSERT_EQ(folder.run("screenshot --journal tour.journal --allow-files --size 1000x700 --out s.png").status, 0);
    std::filesystem::remove(folder.path() / "drop.toml");
    std::filesystem::remove(folder.path() / "tour.journal");
    std::filesystem::create_directory(folder.path() / "assets");
    const auto fonts = std::filesystem::path(ACHILLES_BINARY_DIR) / "assets/fonts";
    std::filesystem::create_directory_symlink(fonts, folder.path() / "assets/fonts");
    for (const std::string picture : {"achilles-paper/fig4d.png", "achilles-paper/fig4.png", "achilles-paper/zeno.png",
                                      "svg/fig4e.svg", "svg/zeno.svg", "s.png"}) {
        // Assets without systems: only the picture can be read.
        const Answer answer = folder.run("reproduce " + picture + " --out again", "ACHILLES_ASSETS=assets");
        EXPECT_EQ(answer.status, 0) << answer.err;
        EXPECT_EQ(content(folder.path() / "again"), content(folder.path() / picture)) << picture;
    }
    EXPECT_EQ(folder.run("reproduce achilles-paper/fig4.png").out, "achilles paper --scale 0.5\n");
}

// A picture may be untrusted: file output of its journal is not repeated.
TEST(Reproduce, AJournalThatSavesWritesNothing) {
    const Folder folder;
    folder.put("drop.toml", falling_ball);
    folder.put("other.toml", "mine");
    folder.put("tour.journal",
               "open ./drop.toml\nopen drop.toml\nsave copy.toml\nsave other.toml overwrite\nopen copy.toml\n");
    std::filesystem::remove(folder.path() / "other.toml");
    ASSERT_EQ(folder.run("screenshot --journal tour.journal --allow-files --size 1000x700 --out s.png").status, 0);
    EXPECT_EQ(content(folder.path() / "other.toml"), falling_ball);
    folder.put("other.toml", "mine");
    std::filesystem::remove(folder.path() / "copy.toml");
    const Answer answer = folder.run("reproduce s.png");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(content(folder.path() / "other.toml"), "mine");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "copy.toml"));
}

TEST(Reproduce, ARunThatStoppedEarlyIsThatAgain) {
    const Folder folder;
    ASSERT_EQ(folder.run("figure ball_on_sine --max-impacts 3 --out a.svg").status, 3);
    EXPECT_EQ(folder.run("reproduce a.svg").status, 3);
}

// Damaged pictures of any kind: status 2, the name, one sentence, and no output.
TEST(Reproduce, RefusesWhatItCannotTrust) {
    const Folder folder;
    folder.put("drop.toml", falling_ball);
    ASSERT_EQ(folder.run(figure_arguments + "a.png").status, 0);
    ASSERT_EQ(folder.run(figure_arguments + "a.svg").status, 0);
    const std::string png = content(folder.path() / "a.png"), svg = content(folder.path() / "a.svg");
    const std::string bare = png.substr(0, 33) + png.substr(png.find("IDAT") - 4);
    std::string flipped = png;
    flipped[200] = static_cast<char>(flipped[200] ^ 1);
    using std::string_literals::operator""s;
    std::string empty_notes;
    for (int i = 0; i <= 65536; ++i) empty_notes += "\x00\x00\x00\x02tEXtk\x00j*l\xE0"s;
    const auto with = [&](const Notes& notes) { return with_notes(bare, notes); };
    const Note command{"Achilles Command", "achilles figure ./drop.toml"};
    const std::pair<std::string, std::string> cases[] = {
        {"", "x: this is not a PNG, SVG or PDF file; a picture that achilles wrote is expected\n"},
        {"GIF89a", "x: this is not a PNG, SVG or PDF file; a picture that achilles wrote is expected\n"},
        {png.substr(0, 9000), "x: the PNG file is incomplete\n"},
        {png.substr(0, 5), "x: this is not a PNG file\n"},
        {flipped, "x: the PNG file is damaged: a checksum is wrong\n"},
        {bare, "x: this picture does not contain the command that made it\n"},
        {"<svg/>", "x: this picture does not contain the command that made it\n"},
        {svg.substr(0, 1200), "x: its notes are incomplete\n"},
        // A command in broken UTF-8; a length beyond the file; too many notes.
        {bare.substr(0, 33) +
             "\x00\x00\x00\x1FiTXtAchilles Command\x00\x00\x00\x00\x00"
             "achilles \xFF\x9CN\xEDj"s +
             bare.substr(33),
         "x: this picture does not contain the command that made it\n"},
        {bare.substr(0, 33) + "\x7F\xFF\xFF\xFFtEXt"s + bare.substr(33), "x: the PNG file is incomplete\n"},
        {bare.substr(0, 33) + empty_notes + bare.substr(33), "x: a PNG file holds at most 65536 notes\n"},
        {with({{"Achilles Command", "rm -rf /"}}), "x: the command stored in it is not an achilles command\n"},
        {with({{"Achilles Command", "achilles list"}}),
         "x: its command cannot be run here: A subcommand is required\nachilles list\n"},
        {with({{"Achilles Command", "achilles reproduce a.png"}}),
         "x: its command cannot be run here: A subcommand is required\nachilles reproduce a.png\n"},
        {with({{"Achilles Command", "achilles figure 'a"}}),
         "x: the command stored in it is damaged: an incomplete word\n"},
        {with({{"Achilles Command", "achilles figure ./drop.toml --out=b.png"}}),
         "x: its command cannot be run here: --out: At Most 1 required but rec"},
        {with({command}),
         "./drop.toml: the picture does not contain this file\nthe files stored in it are incomplete\n"},
        {with({command, {"Achilles System", "./drop.toml title = 1"}}),
         "x: a file stored in it is damaged: it has no name\n"},
        {with({command, {"Achilles System", "./drop.toml\ntitle = \"x\""}}), "./drop.toml:1"},
    };
    for (const auto& [bytes, message] : cases) {
        folder.put("x", bytes);
        const Answer answer = folder.run("reproduce x --out again.png");
        EXPECT_EQ(answer.status, 2) << message;
        EXPECT_EQ(answer.err.substr(0, message.size()), message);
        EXPECT_EQ(answer.out, "");
        EXPECT_EQ(folder.files().size(), 4u) << message;
    }
    EXPECT_EQ(folder.run("reproduce none.png").err, "none.png: there is no such file\n");
    EXPECT_EQ(folder.run("reproduce a.png --out none/a.png").status, 2);
}

// Foreign notes, one in broken UTF-8, one after the pixels, do not affect the picture.
TEST(Reproduce, ForeignNotesChangeNothing) {
    using std::string_literals::operator""s;
    const Folder folder;
    folder.put("drop.toml", falling_ball);
    ASSERT_EQ(folder.run(figure_arguments + "a.png").status, 0);
    const std::string png = content(folder.path() / "a.png");
    const std::size_t end = png.size() - 12;
    const std::string broken = "\x00\x00\x00\x0DiTXtComment\x00\x00\x00\x00\x00\xFFvo\x85R"s,
                      plain = "\x00\x00\x00\x0CtEXtComment\x00mine\xE6\xB6\x86v"s;
    const std::string added = png.substr(0, 33) + broken + png.substr(33, end - 33) + plain + png.substr(end);
    EXPECT_EQ(png_notes(added).size(), png_notes(png).size() + 1);
    EXPECT_EQ(png_notes(added).back(), (Note{"Comment", "mine"}));
    folder.put("x", added);
    const Answer answer = folder.run("reproduce x --out again.png");
    EXPECT_EQ(answer.status, 1);
    EXPECT_EQ(answer.err.substr(0, 44), "achilles: x: reproduced with different bytes");
    EXPECT_EQ(content(folder.path() / "again.png"), png);
}

TEST(Figure, RefusalsAreOneMessageAndLeaveNothing) {
    const Folder folder;
    const std::pair<std::string, std::string> cases[] = {
        {"figure ball_on_sine --out a.jpg", "--out a.jpg: the file name must end in .png, .svg or .pdf\n"},
        {"figure ball_on_sine --out a",
         "--out a: the file name must end in .png, .svg or .pdf\nor add --format png, svg or pdf\n"},
        {"figure ball_on_sine --out a.png --view heigt",
         "--view heigt: this system has no view 'heigt'; did you mean 'height'?\nits views are: horizontal, height, "
         "gap, path, horizontal rate, contact force\n"},
        {"figure ball_on_sine --out none/a.png", "none/a.png: there is no folder none\n"},
        {"figure ball_on_sine --out a.svg --columns 0",
         "--columns 0: the number of columns must be a whole number from 1 to 20\n"},
        {"figure ball_on_sine --out /dev/full --format svg",
         "/dev/full: the file cannot be written: No space left on device\n"},
    };
    for (const auto& [command, message] : cases) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 2) << command;
        EXPECT_EQ(answer.err, message);
        EXPECT_TRUE(folder.files().empty());
    }
}

TEST(Figure, IsOfTheSizeAskedForAndGoesToStandardOutput) {
    const Folder folder;
    ASSERT_EQ(folder.run("figure falling_rod --size 300x200 --transparent --out a.png").status, 0);
    EXPECT_EQ(read_png(folder.path() / "a.png").width, 300);
    EXPECT_EQ(folder.run("figure falling_rod --size 300x200 --transparent --out -").out,
              content(folder.path() / "a.png"));
    EXPECT_EQ(folder.run("figure falling_rod --view angle --format svg --out -").out.rfind("<?xml", 0), 0u);
}

// Missing libraries: the search path leads to empty files of their names first.
TEST(Figure, IsTheSameByEitherLibraryAndNamesThePackagesWithoutBoth) {
    const Folder folder, without_first, without_both;
    without_first.put("libOSMesa.so.8", "");
    without_both.put("libOSMesa.so.8", "");
    without_both.put("libEGL.so.1", "");
    const std::string command = "figure ball_on_sine --size 600x400 --out ";
    const auto hiding = [](const Folder& hidden) { return "LD_LIBRARY_PATH='" + hidden.path().string() + "'"; };
    ASSERT_EQ(folder.run(command + "a.png").status, 0);
    const Answer second = folder.run(command + "b.png", hiding(without_first));
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_EQ(content(folder.path() / "a.png"), content(folder.path() / "b.png"));
    EXPECT_EQ(folder.run(command + "c.png", hiding(without_first) + " ACHILLES_OFFSCREEN=osmesa").status, 2);
    const Answer neither = folder.run(command + "c.png", hiding(without_both));
    EXPECT_EQ(neither.status, 2);
    EXPECT_EQ(neither.err,
              "achilles: drawing without a window needs OSMesa or EGL, but libOSMesa.so.8 is missing, and libEGL.so.1 "
              "is missing\ninstall the package libosmesa6, or libegl1 and libgl1-mesa-dri\n");
    EXPECT_EQ(folder.run(command + "c.svg", hiding(without_both)).status, 0);  // needs neither
    EXPECT_EQ(folder.files().size(), 3u);
}

// On a hardened system Mesa's fast renderer would crash.
TEST(Figure, IsDrawnWhereNoMemoryCanBeMadeExecutable) {
    const Folder folder;
    const std::string out = folder.path() / "a.png";
    const pid_t child = fork();  // the restriction cannot be undone in a process
    ASSERT_GE(child, 0);
    if (child == 0) {
        if (!deny_executable_memory()) _exit(99);
        execl(ACHILLES_BINARY_DIR "/achilles", "achilles", "figure", "ball_on_sine", "--view", "gap", "--size",
              "400x300", "--out", out.c_str(), nullptr);
        _exit(98);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    if (WEXITSTATUS(status) == 99) GTEST_SKIP() << "no seccomp here";
    EXPECT_EQ(WEXITSTATUS(status), 0);
    // Three curves, not an empty page.
    EXPECT_GT(content(out).size(), 5000U);
}

// Uses librsvg's program; if it is missing, the message names its package before the run.
TEST(Figure, IsWrittenAsPdf) {
    const Folder folder;
    const std::string figure = "figure ball_on_sine --end 5 --view height ";
    const Folder tools;  // a PATH with only what runs the program
    std::filesystem::create_symlink("/usr/bin/timeout", tools.path() / "timeout");
    const Answer missing = folder.run(figure + "--out a.pdf", "PATH='" + tools.path().string() + "'");
    EXPECT_EQ(missing.status, 2);
    EXPECT_EQ(missing.err,
              "--out a.pdf: a PDF needs rsvg-convert, which is not installed\ninstall the package librsvg2-bin, or end "
              "the name in .svg\n");
    EXPECT_TRUE(folder.files().empty());
    if (std::system("rsvg-convert --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "without rsvg-convert";
    ASSERT_EQ(folder.run(figure + "--out a.pdf").status, 0);
    ASSERT_EQ(folder.run(figure + "--out b.PDF").status, 0);
    const std::string pdf = content(folder.path() / "a.pdf");
    EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
    EXPECT_EQ(pdf, content(folder.path() / "b.PDF"));  // no date in it
    const std::string box = "/MediaBox [ 0 0 ";
    ASSERT_NE(pdf.find(box), std::string::npos);
    EXPECT_NEAR(std::stod(pdf.substr(pdf.find(box) + box.size())), 170.0 / 25.4 * 72.0, 0.02);  // 170 mm in points
    ASSERT_EQ(folder.run("figure ball_on_sine --end 5 --do \"export c.pdf\" --out d.svg --allow-files").status, 0);
    EXPECT_EQ(content(folder.path() / "c.pdf").substr(0, 5), "%PDF-");
}

// From cairo 1.18 on, rsvg-convert compresses the end of a PDF, where notes are added, except in PDF 1.4.
TEST(Figure, IsAPdfThatNotesCanBeAddedTo) {
    const Folder folder, tools;
    std::filesystem::create_symlink("/usr/bin/timeout", tools.path() / "timeout");
    const std::filesystem::path writer = tools.path() / "rsvg-convert";
    std::ofstream(writer) << "#!/bin/sh\n"
                             "case \"$*\" in\n"
                             "*--format=pdf1.4*) printf '%%PDF-1.4\\n1 0 obj\\n<< /Producer (sh)\\n>>\\nendobj\\n';\n"
                             "    printf 'trailer\\n<< /Info 1 0 R\\n>>\\nstartxref\\n9\\n%%%%EOF\\n' ;;\n"
                             "*) printf '%%PDF-1.7\\nstartxref\\n9\\n%%%%EOF\\n' ;;\n"
                             "esac\n";
    std::filesystem::permissions(writer, std::filesystem::perms::owner_all);
    const Answer answer =
        folder.run("figure ball_on_sine --end 5 --view height --out a.pdf", "PATH='" + tools.path().string() + "'");
    EXPECT_EQ(answer.status, 0) << answer.err;
    const std::string pdf = content(folder.path() / "a.pdf");
    EXPECT_EQ(pdf.substr(0, 8), "%PDF-1.4");
    EXPECT_NE(pdf.find("/Producer (sh)\n%Achilles notes\n"), std::string::npos) << pdf;
}

TEST(Figure, TooLittleMemoryIsAMessage) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer needs more address space than this test allows";
#endif
    const Folder folder;
    const Answer answer =
        folder.run("figure ball_on_sine --view gap --size 16384x16384 --out a.png", "ulimit -v 1200000;");
    EXPECT_EQ(answer.status, 3);
    EXPECT_EQ(answer.err.rfind("achilles: there is not enough memory for drawing", 0), 0u) << answer.err;
    EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
    EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace achilles::test
