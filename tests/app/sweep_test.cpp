// `achilles sweep`: files, interruptions, and --resume.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "app/program.hpp"

namespace achilles::test {
namespace {

constexpr const char* grid =
    "sweep ball_on_sine --over x=-3:3:40 --over y=-2:2:25 --print x --print \"zeno_time(2)\" "
    "--print held --print outcome --end 9 ";

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    }
    return cells;
}

TEST(SweepCommand, WritesATable) {
    const Folder folder;
    const Answer answer = folder.run(
        "sweep ball_on_sine --over e=0:0.4:3 --over \"x'=log:1:2:2\" --print \"zeno_time(2)\" "
        "--print \"zeno_time(2) - zeno_time(1)\" --print held --units");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(answer.err,
              "achilles: warning: zeno_time(2) does not exist in any of the 6 runs\n"
              "achilles: warning: zeno_time(2) - zeno_time(1) does not exist in any of the 6 runs\n");
    const auto lines = lines_of(answer.out);
    ASSERT_EQ(lines.size(), 8u);
    EXPECT_EQ(lines[0], "e,x',zeno_time(2),zeno_time(2) - zeno_time(1),held,outcome");
    EXPECT_EQ(lines[1], ",m/s,s,,,");
    EXPECT_TRUE(lines[2].starts_with("0,1,")) << lines[2];
    EXPECT_TRUE(lines[7].starts_with("0.4,2,")) << lines[7];
    for (const char* file : {"--csv table.csv", "--csv table.csv --threads 1", "--csv - --threads 2"}) {
        const Answer same = folder.run(
            "sweep ball_on_sine --over e=0:0.4:3 --over \"x'=log:1:2:2\" --print "
            "\"zeno_time(2)\" --print \"zeno_time(2) - zeno_time(1)\" --print held --units " +
            std::string(file));
        EXPECT_EQ(same.status, 0) << same.err;
        const bool is_file = std::string(file).find("table") != std::string::npos;
        EXPECT_EQ(is_file ? content(folder.path() / "table.csv") : same.out, answer.out);
    }
    EXPECT_EQ(folder.files(), std::vector<std::string>{"table.csv"});
}

TEST(SweepCommand, ReplacesAFileWithItsModeAndLeavesOthersAlone) {
    namespace fs = std::filesystem;
    const Folder folder;
    folder.put("a.csv", "old\n");
    folder.put("a.csv.new", "mine\n");
    fs::permissions(folder.path() / "a.csv", fs::perms(0640));
    EXPECT_EQ(folder.run("sweep ball_on_sine --over x=0:1:3 --print x --end 1 --csv a.csv").status, 0);
    EXPECT_TRUE(content(folder.path() / "a.csv").starts_with("x(0),x,outcome\n0,"));
    EXPECT_EQ(fs::status(folder.path() / "a.csv").permissions(), fs::perms(0640));
    EXPECT_EQ(content(folder.path() / "a.csv.new"), "mine\n");
    EXPECT_EQ(folder.files().size(), 2u);
}

TEST(SweepCommand, MissingValuesAreEmptyCells) {
    const Folder folder;
    const Answer answer =
        folder.run("sweep ball_on_sine --over y=-3:3:3 --print \"impact_time(9)\" --print held --end 1");
    EXPECT_EQ(answer.status, 0);
    EXPECT_TRUE(answer.err.starts_with("achilles: warning: y = -3 m is outside its range")) << answer.err;
    EXPECT_NE(answer.err.find("warning: 1 of the runs: cannot start; first at y = -3: "), std::string::npos)
        << answer.err;
    const auto lines = lines_of(answer.out);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[1], "-3,,,cannot start");
    EXPECT_EQ(lines[3], "3,,,end time");
}

// Rows of sections, compared with the events of single runs.
TEST(SweepCommand, WritesSections) {
    const Folder folder;
    const Answer answer =
        folder.run("sweep ball_on_sine --over x=-1:0:2 --at zeno --print x --print t --end 20 --print \"x'\"");
    const auto lines = lines_of(answer.out);
    ASSERT_GE(lines.size(), 3u) << answer.err;
    EXPECT_EQ(lines[0], "x(0),t,contact,x,t,x',outcome");
    const auto last = cells_of(lines.back());
    ASSERT_EQ(last.size(), 7u);
    EXPECT_EQ(last[0], "0");
    EXPECT_NEAR(std::stod(last[1]), 12.466, 1e-3);
    EXPECT_EQ(last[1], last[4]);
    EXPECT_EQ(last[2], "contact");
}

// The same bytes with one and two threads, and after two interruptions by a file size limit.
TEST(SweepCommand, GoesOnWhereItWasInterrupted) {
    const Folder folder;
    const bool has_hdf5 = folder.run(std::string(grid) + "--hdf5 whole.h5 --csv whole.csv --threads 1").status == 0;
    const auto files = [&](const std::string& name) {
        return "--csv " + name + ".csv" + (has_hdf5 ? " --hdf5 " + name + ".h5" : "");
    };
    if (!has_hdf5) folder.run(std::string(grid) + files("whole"));
    const std::string whole = content(folder.path() / "whole.csv");
    ASSERT_EQ(lines_of(whole).size(), 1001u);
    EXPECT_EQ(folder.run(std::string(grid) + files("two") + " --threads 2").status, 0);
    EXPECT_EQ(content(folder.path() / "two.csv"), whole);
    EXPECT_EQ(content(folder.path() / "two.h5"), content(folder.path() / "whole.h5"));

    for (const char* limit : {"30", "60"}) {  // blocks of 1024 bytes
        const bool again = limit == std::string("60");
        const Answer stopped = folder.run(std::string(grid) + files("part") + (again ? " --resume" : ""),
                                          std::string("trap '' XFSZ; ulimit -f ") + limit + ";");
        EXPECT_EQ(stopped.status, 3);
        EXPECT_NE(stopped.err.find("achilles: the file cannot be written: part.csv.part: File too large"),
                  std::string::npos)
            << stopped.err;
        EXPECT_NE(stopped.err.find("--resume continues from part.csv.part"), std::string::npos) << stopped.err;
        EXPECT_FALSE(std::filesystem::exists(folder.path() / "part.csv"));
    }
    const Answer anew = folder.run(std::string(grid) + files("part"));
    EXPECT_EQ(anew.status, 2);
    EXPECT_NE(anew.err.find("part.csv.part: this is an unfinished sweep with "), std::string::npos) << anew.err;
    const Answer other = folder.run(std::string(grid) + files("part") + " --resume --set e=0.3");
    EXPECT_EQ(other.status, 2);
    EXPECT_NE(other.err.find("it is a different sweep\n    there: --over x=-3:3:40"), std::string::npos) << other.err;
    EXPECT_NE(other.err.find(" --set e=0.3 --end 9\n"), std::string::npos) << other.err;
    // A partly written record at the end of the log is ignored.
    std::ofstream(folder.path() / "part.csv.part", std::ios::app) << "half a record";
    EXPECT_EQ(folder.run(std::string(grid) + files("part") + " --resume --threads 2").status, 0);
    EXPECT_EQ(content(folder.path() / "part.csv"), whole);
    EXPECT_EQ(content(folder.path() / "part.h5"), content(folder.path() / "whole.h5"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "part.csv.part"));
}

TEST(SweepCommand, ChecksThatTheSystemIsTheSame) {
    const Folder folder;
    folder.put("drop.toml", drop_text);
    const std::string command = "sweep ./drop.toml --over y=1:2:300 --print t --csv a.csv";
    EXPECT_EQ(folder.run(command, "trap '' XFSZ; ulimit -f 3;").status, 3);
    std::string changed = drop_text;
    changed.replace(changed.find("9.81"), 4, "9.80");
    folder.put("drop.toml", changed);
    const Answer answer = folder.run(command + " --resume");
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(
        answer.err.find("the system has changed in line 7\n    there: potential = \"9.81*y\"\n    here:  potential "
                        "= \"9.80*y\""),
        std::string::npos)
        << answer.err;
}

// Starts a sweep that takes minutes, and ends it by a signal when its log has grown.
std::string ended_by(const Folder& folder, const std::string& signal, const std::string& command) {
    folder.put("script", "'" ACHILLES_BINARY_DIR "/achilles' " + command +
                             " --csv long.csv --threads 2 2>err &\np=$!\nfor i in $(seq 2000); do\n"
                             "  [ \"$(stat -c %s long.csv.part 2>/dev/null || echo 0)\" -gt 12000 ] && break\n"
                             "  sleep 0.01\ndone\nkill -" +
                             signal + " $p\nwait $p\necho $? >status\n");
    const int ignored = std::system(("cd '" + folder.path().string() + "' && sh ./script 2>/dev/null").c_str());
    EXPECT_EQ(ignored, 0);
    return content(folder.path() / "status");
}

TEST(SweepCommand, StopsBetweenChunksWhenAskedTo) {
    const Folder folder;
    for (const char* signal : {"INT", "TERM"}) {
        std::filesystem::remove(folder.path() / "long.csv.part");
        EXPECT_EQ(ended_by(folder, signal, "sweep ball_on_sine --over x=-3:3:1e7 --print x"), "3\n");
        const std::string told = content(folder.path() / "err");
        EXPECT_NE(told.find(" of 10000000 runs: the same command with --resume continues from long.csv.part"),
                  std::string::npos)
            << told;
    }
}

TEST(SweepCommand, LosesOnlyChunksUnderWayWhenItIsKilled) {
    const Folder folder;
    const std::string command = "sweep ball_on_sine --over x=-3:3:30000 --print x";
    const std::string status = ended_by(folder, "KILL", command);
    if (status == "137\n") {
        const Answer answer = folder.run(command + " --csv long.csv");
        EXPECT_NE(answer.err.find("this is an unfinished sweep with "), std::string::npos) << answer.err;
    }
    EXPECT_EQ(folder.run(command + " --csv long.csv --resume").status, 0);
    EXPECT_EQ(folder.run(command + " --csv whole.csv").status, 0);
    EXPECT_EQ(content(folder.path() / "long.csv"), content(folder.path() / "whole.csv"));
}

TEST(SweepCommand, InvalidRequestsWriteNothing) {
    const Folder folder;
    folder.put("drop.toml", drop_text);
    folder.put("mine.csv.part", "a file of mine\n");
    const std::string sweep = "sweep ./drop.toml --over y=1:2:5 --print t ";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"sweep ./drop.toml --print t", "--over: nothing is varied"},
        {"sweep ./drop.toml --over y=1:2:0 --print t --csv a.csv",
         "--over y=1:2:0: the number of values must be a whole"},
        {"sweep ./drop.toml --over y=1:2:5 --print tt --csv a.csv",
         "--print tt: unknown name 'tt'; did you mean 't'?\n    tt\n    ^\n"},
        {sweep + "--at impcat", "--at impcat: unknown event\nwrite --at impact"},
        {sweep + "--set y=1.5", "--over y: it is both varied and fixed, by --set y\nremove --set y or --over y"},
        {sweep + "--threads 0", "--threads 0: a whole number from 1 to 1024 is expected"},
        {sweep + "--units --hdf5 a.h5", "--units: this needs --csv F"},
        {sweep + "--hdf5 -", "--hdf5 -: HDF5 output needs a file"},
        {sweep + "--resume", "--resume: this needs a file"},
        {sweep + "--csv drop.toml", "drop.toml: this output would overwrite the input file "},
        {sweep + "--csv ./here/a.csv", "there is no folder ./here"},
        {sweep + "--csv mine.csv",
         "mine.csv.part: the sweep stores its progress here, but this file is not an unfinished sweep"},
        {sweep + "--csv a.csv --hdf5 a.csv", "two outputs cannot go to the same file"},
    };
    for (const auto& [command, wrong] : cases) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 2) << command;
        if (answer.err.find("has no HDF5 support") != std::string::npos) continue;
        EXPECT_NE(answer.err.find(wrong), std::string::npos) << command << "\n" << answer.err;
        EXPECT_EQ(answer.out, "");
    }
    EXPECT_EQ(folder.files().size(), 2u);
    EXPECT_EQ(content(folder.path() / "mine.csv.part"), "a file of mine\n");
    EXPECT_EQ(folder.run(sweep + "--csv /dev/full").status, 2);
    EXPECT_FALSE(std::filesystem::exists("/dev/full.part"));
}

// Requirements of a picture are checked before the runs; a picture that fails later does not affect the other files.
TEST(SweepCommand, DrawsOrReportsWhyNot) {
    const Folder folder;
    folder.put("drop.toml", drop_text);
    const std::string sweep = "sweep ./drop.toml --over y=1:2:10 --print \"impact_time(1)\" --out a.";
    std::filesystem::create_directories(folder.path() / "none");
    for (const char* ending : {"png", "svg"}) {
        const Answer answer = folder.run(sweep + ending, "ACHILLES_ASSETS=none");
        EXPECT_EQ(answer.status, 2) << answer.err;
        EXPECT_EQ(answer.err.rfind(std::string("--out a.") + ending + ": ", 0), 0u) << answer.err;
        EXPECT_EQ(folder.files().size(), 2u) << "the system and the empty folder";
    }
    const Answer full = folder.run(sweep + "png", "trap '' XFSZ; ulimit -f 6;");
    EXPECT_EQ(full.status, 3);
    EXPECT_EQ(full.err,
              "achilles: the file cannot be written: a.png: File too large\nachilles: all 10 runs are done, but not "
              "all files are written; the runs are kept in a.png.part: the same command writes the files\n");
    const Answer other = folder.run(sweep + "png --set y=1.5 --end 3");
    EXPECT_EQ(other.status, 2) << "of another sweep they are not thrown away";
    const Answer again = folder.run(sweep + "png");
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "a.png"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.png.part"));
}

// Derivatives and their quantities in one table: standard output, file, HDF5, curves and maps.
TEST(SweepCommand, PrintsDerivatives) {
    const Folder folder;
    const std::string prints = "--print \"zeno_time(1)\" --print \"d(zeno_time(1), e)\" ";
    const std::string curve_sweep = "sweep ball_on_sine --over e=0.3:0.5:3 --end 5 " + prints;
    const Answer answer = folder.run(curve_sweep + "--csv -");
    ASSERT_EQ(answer.status, 0) << answer.err;
    const auto lines = lines_of(answer.out);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0], "e,zeno_time(1),\"d(zeno_time(1), e)\",outcome");
    const auto number = [&](std::size_t row, std::size_t column) { return std::stod(cells_of(lines[row])[column]); };
    EXPECT_NEAR(number(2, 2), (number(3, 1) - number(1, 1)) / 0.2, 0.2 * std::abs(number(2, 2)));
    EXPECT_EQ(folder.run(curve_sweep + "--csv a.csv --out a.svg --out a.png --threads 1").status, 0);
    EXPECT_EQ(content(folder.path() / "a.csv"), answer.out);
    const std::string svg = content(folder.path() / "a.svg");
    EXPECT_NE(svg.find("\xE2\x88\x82"), std::string::npos) << "the sign of a partial derivative";
    EXPECT_EQ(folder.run("reproduce a.svg").status, 0);
    EXPECT_EQ(
        folder.run("sweep ball_on_sine --over e=0.3:0.5:3 --over x=-1:1:3 --end 5 " + prints + "--out m.svg").status,
        0);
    const Answer refused = folder.run("sweep ball_on_sine --over e=0:1:3 --print \"d(impacts, e)\" --csv b.csv");
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(refused.err.rfind("--print d(impacts, e): 'impacts' is a whole number", 0), 0u) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "b.csv"));
}

TEST(SweepCommand, SaysWhatItCameToWhereAFileIsNamed) {
    const Folder folder;
    const std::string sweep = "sweep ball_on_sine --over e=0:0.95:9 --print \"zeno_time(2)\" ";
    const Answer answer = folder.run(sweep + "--csv curve.csv");
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(answer.out, "");
    // The range equals that of the column.
    double low = 1e9, high = -1e9;
    int there = 0;
    const auto lines = lines_of(content(folder.path() / "curve.csv"));
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::string cell = cells_of(lines[i])[1];
        if (cell.empty()) continue;
        ++there, low = std::min(low, std::stod(cell)), high = std::max(high, std::stod(cell));
    }
    ASSERT_TRUE(there > 0 && there < 9) << there;
    const std::string range = fmt::format("zeno_time(2)   {:.6g} to {:.6g} s in {} runs; does not exist in {} (", low,
                                          high, there, 9 - there);
    EXPECT_EQ(
        answer.err.rfind("Ball bouncing on a sinusoidal surface: 9 runs, all reached the end time\n  " + range, 0), 0U)
        << answer.err << range;
    EXPECT_NE(answer.err.find(")\nwrote curve.csv\n"), std::string::npos) << answer.err;
    EXPECT_EQ(folder.run(sweep).err, "") << "standard output is the table, and nobody reads the other stream";
}

TEST(SweepCommand, SaysWhatExistsInNoRunAndDrawsNothingOfIt) {
    const Folder folder;
    const std::string sweep = "sweep ball_on_sine --over e=0.1:0.5:3 --end 1 --print \"zeno_time(1)\" ";
    EXPECT_EQ(folder.run(sweep).err, "achilles: warning: zeno_time(1) does not exist in any of the 3 runs\n");
    const Answer nothing = folder.run(sweep + "--csv a.csv --out a.svg");
    EXPECT_EQ(nothing.status, 3);
    EXPECT_NE(nothing.err.find("no picture is drawn"), std::string::npos) << nothing.err;
    EXPECT_NE(nothing.err.find("zeno_time(1)   does not exist in any of the 3 runs\nwrote a.csv\n"), std::string::npos)
        << nothing.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.csv"});
    const Answer other = folder.run(sweep + "--print x --out b.svg");
    EXPECT_EQ(other.status, 0) << other.err;
    EXPECT_EQ(content(folder.path() / "b.svg").find("Zeno time"), std::string::npos) << "it has no panel";
}

TEST(SweepCommand, HasNoTwoColumnsOfOneName) {
    const Answer answer = Folder().run("sweep ball_on_sine --over x=0:1:3 --over \"x'=1:2:2\" --print x --end 1");
    EXPECT_EQ(answer.out.substr(0, answer.out.find('\n')), "x(0),x',x,outcome");
}

// ---- HDF5 ----

std::string bytes_of(const std::vector<double>& numbers) {
    std::string bytes(numbers.size() * sizeof(double), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

class SweepHdf5 : public testing::Test {
 protected:
    void write(const std::string& sweep, bool is_read_by_python = true) {
        const Answer answer = folder_.run(sweep + " --csv a.csv --hdf5 a.h5");
        if (answer.err.find("HDF5") != std::string::npos && answer.status == 2) GTEST_SKIP() << answer.err;
        ASSERT_EQ(answer.status, 0) << answer.err;
        file_ = content(folder_.path() / "a.h5");
        const auto lines = lines_of(content(folder_.path() / "a.csv"));
        names_ = cells_of(lines[0]);
        columns_.resize(names_.size());
        for (std::size_t i = 1; i < lines.size(); ++i) {
            const auto cells = cells_of(lines[i]);
            for (std::size_t k = 0; k < cells.size(); ++k) columns_[k].push_back(cells[k]);
        }
        if (is_read_by_python) read_by_python();
    }

    // The numbers of a CSV column in the binary form of the file.
    std::string numbers(std::size_t column) const {
        std::vector<double> values;
        for (const std::string& cell : columns_[column])
            values.push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell));
        return bytes_of(values);
    }
    bool holds(const std::string& bytes) const { return file_.find(bytes) != std::string::npos; }

    // Reads the file with h5py, if that is installed.
    void read_by_python() {
        folder_.put("read.py",
                    "import h5py, numpy, csv\nf = h5py.File('a.h5')\n"
                    "table = list(csv.reader(open('a.csv')))\n"
                    "for k, name in enumerate(table[0]):\n"
                    "    if 'axes/' + name in f or name == 'outcome': continue\n"
                    "    v = f['values/' + name]\n"
                    "    if v.dtype.kind == 'f':\n"
                    "        c = numpy.array([float(r[k] or 'nan') for r in table[1:]])\n"
                    "        assert numpy.array_equal(v[:].ravel(), c, equal_nan=True), name\n"
                    "assert f['signature'].dtype == 'uint64' and f['signature'].shape == f['values/outcome'].shape\n");
        const std::string cd = "cd '" + folder_.path().string() + "' && ";
        if (std::system((cd + "python3 -c 'import h5py' 2>/dev/null").c_str()) != 0) return;
        EXPECT_EQ(std::system((cd + "python3 read.py").c_str()), 0);
    }

    Folder folder_;
    std::string file_;
    std::vector<std::string> names_;
    std::vector<std::vector<std::string>> columns_;
};

TEST_F(SweepHdf5, HoldsAGrid) {
    write(
        "sweep ball_on_sine --over x=-3:3:13 --over y=-2:2:17 --print x/2 --print \"zeno_time(1)\" --print held --end "
        "5");
    if (file_.empty()) return;
    EXPECT_TRUE(holds(numbers(2))) << "x/2, in the order of the grid";
    EXPECT_TRUE(holds(numbers(3)));
    std::vector<double> axis;
    for (std::size_t i = 0; i < 17; ++i) axis.push_back(std::stod(columns_[1][i]));
    EXPECT_TRUE(holds(bytes_of(axis)));
    std::string outcomes;
    for (const std::string& outcome : columns_[5]) outcomes += (outcome + std::string(12, '\0')).substr(0, 12);
    EXPECT_TRUE(holds(outcomes)) << "as wide as the widest, 'cannot start'";
    EXPECT_TRUE(
        holds("achilles sweep ball_on_sine --over x=-3:3:13 --over y=-2:2:17 --print x/2 --print "
              "\"zeno_time(1)\" --print held --end 5"));
    EXPECT_TRUE(holds("tolerance = 1e-10, method = taylor"));
    EXPECT_TRUE(holds("title = \"Ball bouncing on a sinusoidal surface\""));
    EXPECT_FALSE(holds("--threads")) << "nor when it was made";
}

TEST_F(SweepHdf5, HoldsDerivatives) {
    write("sweep ball_on_sine --over e=0.3:0.5:3 --print \"d(zeno_time(1) , e)\" --print x --end 5", false);
    if (file_.empty()) return;
    EXPECT_TRUE(holds("d(zeno_time(1) , e)"));
    columns_.erase(columns_.begin() + 1);  // the heading contains a comma, so the rows have one cell less
    EXPECT_TRUE(holds(numbers(1)));
}

TEST_F(SweepHdf5, HoldsSectionsByRows) {
    write("sweep ball_on_sine --over x=-1:1:5 --at impact --print impact_speed --end 8", false);
    if (file_.empty()) return;
    ASSERT_EQ(names_, (std::vector<std::string>{"x", "t", "contact", "impact_speed", "outcome"}));
    for (const std::size_t column : {0, 1, 3}) EXPECT_TRUE(holds(numbers(column))) << names_[column];
}

// There is room for the log, but not for the file.
TEST_F(SweepHdf5, IsMadeOfTheLogWhereItCouldNotBeWritten) {
    const std::string sweep = "sweep ball_on_sine --over x=-3:3:30 --print x --hdf5 ";
    if (folder_.run(sweep + "whole.h5").status == 2) GTEST_SKIP() << "there is no HDF5";
    const Answer full = folder_.run(sweep + "a.h5", "trap '' XFSZ; ulimit -f 6;");
    EXPECT_EQ(full.status, 3);
    EXPECT_EQ(full.err,
              "achilles: the file cannot be written: a.h5: File too large\nachilles: all 30 runs are done, but not all "
              "files are written; the runs are kept in a.h5.part: the same command writes the files\n");
    EXPECT_EQ(folder_.files().size(), 2u) << "the whole one, and the log";
    EXPECT_EQ(folder_.run(sweep + "a.h5 --resume").status, 0);
    EXPECT_EQ(content(folder_.path() / "a.h5"), content(folder_.path() / "whole.h5"));
}

TEST_F(SweepHdf5, HasNoPathThroughAnother) {
    const Answer answer = folder_.run("sweep ball_on_sine --over x=-1:1:5 --print y --print y/2 --hdf5 b.h5");
    EXPECT_EQ(answer.status, 2);
    EXPECT_TRUE(folder_.files().empty());
}

}  // namespace
}  // namespace achilles::test
