// `mpirun -n N achilles sweep`: the same files for every N, and the state after a rank or the disk fails.
#include <gtest/gtest.h>

#include "app/program.hpp"
#include "cli/sweep_output.hpp"
#include "cli/sweep_work.hpp"
#include "model/read_system.hpp"

namespace achilles::test {
namespace {

constexpr const char* program = ACHILLES_BINARY_DIR "/achilles";
// Ignore memory that MPI keeps until the end.
const std::string with_mpi = "ASAN_OPTIONS=detect_leaks=0 ";
// Allow root, and more ranks than cores.
const std::string mpirun = with_mpi + "mpirun --oversubscribe --allow-run-as-root ";

int count_of(const std::string& what, const std::string& text) {
    int count = 0;
    for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++count;
    return count;
}

class SweepRanks : public testing::Test {
 protected:
    void SetUp() override {
        if (std::system("mpirun --version 2>/dev/null | grep -q 'Open MPI'") != 0)
            GTEST_SKIP() << "mpirun is missing, or not that of Open MPI (openmpi-bin)";
        if (!std::filesystem::exists(ACHILLES_BINARY_DIR "/libachilles_mpi.so"))
            GTEST_SKIP() << "built without MPI (libopenmpi-dev)";
    }
    Answer run(int ranks, const std::string& arguments) const {
        return folder_.run(arguments, mpirun + ("-n " + std::to_string(ranks)));
    }
    // Runs a shell script.
    int script(const std::string& text) const {
        folder_.put("script", text);
        const int status = std::system(("cd '" + folder_.path().string() + "' && timeout 60 sh ./script").c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string file(const char* name) const { return content(folder_.path() / name); }
    bool has(const char* name) const { return std::filesystem::exists(folder_.path() / name); }
    Folder folder_;
};

TEST_F(SweepRanks, WriteTheSameBytesHoweverMany) {
    const std::string sweep =
        "sweep ball_on_sine --over x=-3:3:60 --over y=-2:2:50 --print x --print \"zeno_time(2)\" --print held --end 9 ";
    const std::string hdf5 = folder_.run(sweep + "--hdf5 one.h5").status == 0 ? " --hdf5 " : "";
    std::filesystem::remove(folder_.path() / "one.h5");
    const auto files = [&](const std::string& name) {
        return "--csv " + name + ".csv" + (hdf5.empty() ? "" : hdf5 + name + ".h5");
    };
    const Answer one = folder_.run(sweep + files("one") + " --threads 1");
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(count_of("\n", file("one.csv")), 3001);
    const auto renamed = [](std::string text, const std::string& name) {
        for (const char* ending : {".csv\n", ".h5\n"})
            if (const std::size_t at = text.find(std::string("wrote one") + ending); at != text.npos)
                text.replace(at, 9, "wrote " + name);
        return text;
    };
    const auto expect_same = [&](const Answer& answer, const char* name) {
        EXPECT_EQ(answer.status, 0) << answer.err;
        EXPECT_EQ(answer.err, renamed(one.err, name)) << "the summary and warnings, once";
        EXPECT_EQ(answer.out, "");
        EXPECT_EQ(file((std::string(name) + ".csv").c_str()), file("one.csv")) << name;
        EXPECT_EQ(file((std::string(name) + ".h5").c_str()), file("one.h5")) << name;
    };
    expect_same(folder_.run(sweep + files("threads") + " --threads 2"), "threads");
    expect_same(run(1, sweep + files("a")), "a");
    expect_same(run(2, sweep + files("b")), "b");
    expect_same(run(2, sweep + files("b2") + " --threads 2"), "b2");
    expect_same(run(4, sweep + files("c")), "c");
}

TEST_F(SweepRanks, AreSilentButForTheFirst) {
    const std::string sweep = "sweep ball_on_sine --over x=-3:3:5 --print ";
    const Answer table = run(3, sweep + "x"), wrong = run(3, sweep + "xx --csv a.csv"), help = run(2, "sweep --help");
    EXPECT_EQ(table.status, 0) << table.err;
    EXPECT_EQ(table.out, folder_.run(sweep + "x").out);
    EXPECT_EQ(wrong.status, 2);
    EXPECT_EQ(count_of("--print xx: unknown name 'xx'", wrong.err), 1) << wrong.err;
    EXPECT_EQ(help.status, 0) << help.err;
    EXPECT_EQ(count_of("Usage: ", help.out), 1) << help.out;
    EXPECT_TRUE(folder_.files().empty());
}

// A script that runs a shared sweep until its log has grown by this much, and then stops it by the last command.
std::string interrupted(const std::string& sweep, const std::string& how) {
    return "size=$(stat -c %s a.csv.part 2>/dev/null || echo 0)\n" + std::string(mpirun) +
           "-n 2 sh -c 'echo $$ >pid$OMPI_COMM_WORLD_RANK; exec " + program + " " + sweep +
           "--csv a.csv --resume' 2>err &\nm=$!\nfor i in $(seq 2000); do\n"
           "  [ \"$(stat -c %s a.csv.part 2>/dev/null || echo 0)\" -gt $((size + 9000)) ] && break\n"
           "  sleep 0.01\ndone\nkill -" +
           how + "\nwait $m";
}

// A rank is killed, then rank 0 is stopped; --resume continues with and without ranks.
TEST_F(SweepRanks, GoOnWhereTheyWereInterrupted) {
    const std::string sweep = "sweep ball_on_sine --over x=-3:3:100000 --print x --print t ",
                      told = " of 100000 runs: the same command with --resume continues from a.csv.part\n";
    EXPECT_EQ(script(interrupted(sweep, "KILL $(cat pid1)")), 137);
    EXPECT_EQ(count_of(told, file("err")), 1) << file("err");
    ASSERT_TRUE(has("a.csv.part"));
    EXPECT_EQ(script(interrupted(sweep, "INT $(cat pid0)")), 3);
    EXPECT_EQ(count_of(told, file("err")), 1) << file("err");
    ASSERT_TRUE(has("a.csv.part"));
    EXPECT_FALSE(has("a.csv"));
    EXPECT_EQ(run(2, sweep + "--csv a.csv --resume").status, 0);
    EXPECT_EQ(folder_.run(sweep + "--csv whole.csv").status, 0);
    EXPECT_EQ(file("a.csv"), file("whole.csv"));
    EXPECT_FALSE(has("a.csv.part"));
}

// mpirun asks all processes to stop a second after Ctrl-C, and kills them one second later.
TEST_F(SweepRanks, StopWhenMpirunIsInterrupted) {
    const std::string sweep = "sweep ball_on_sine --over x=-3:3:1e7 --print x ";
    EXPECT_NE(script(interrupted(sweep, "INT $m")), 0);
    EXPECT_EQ(count_of(" of 10000000 runs: the same command with --resume continues from a.csv.part\n", file("err")), 1)
        << file("err");
    const Answer again = folder_.run(sweep + "--csv a.csv");
    EXPECT_NE(again.err.find("this is an unfinished sweep with "), std::string::npos) << again.err;
}

// The size limit would also apply to memory shared by the ranks, so they communicate by the loopback device.
TEST_F(SweepRanks, EndWhereTheDiskIsFull) {
    const std::string sweep = "sweep ball_on_sine --over x=-3:3:3000 --print x --csv a.csv";
    EXPECT_EQ(script(std::string(mpirun) +
                     "--mca btl self,tcp -n 2 sh -c '[ $OMPI_COMM_WORLD_RANK = 1 ] || { trap \"\" XFSZ; ulimit -f 60; "
                     "}; exec " +
                     program + " " + sweep + "' 2>err"),
              3);
    EXPECT_EQ(count_of("achilles: the file cannot be written: a.csv.part: File too large\nachilles: the sweep stopped "
                       "early, at ",
                       file("err")),
              1)
        << file("err");
    EXPECT_EQ(run(2, sweep + " --resume").status, 0);
    EXPECT_EQ(folder_.run("sweep ball_on_sine --over x=-3:3:3000 --print x --csv whole.csv").status, 0);
    EXPECT_EQ(file("a.csv"), file("whole.csv"));
}

// Without a connection each would do all the work and write the same file.
TEST_F(SweepRanks, RefuseWhatTheyCannotShare) {
    std::filesystem::copy_file(program, folder_.path() / "achilles");
    const std::string sweep = "sweep ball_on_sine --over x=-3:3:5 --print x --csv a.csv",
                      assets = "export ACHILLES_ASSETS=" ACHILLES_BINARY_DIR "/assets\n";
    EXPECT_EQ(script(assets + mpirun + "-n 2 ./achilles " + sweep + " 2>err"), 2);
    EXPECT_EQ(count_of("achilles: 2 processes were started, but they cannot share a sweep: ", file("err")), 1)
        << file("err");
    EXPECT_EQ(count_of("lib/achilles/libachilles_mpi.so is missing", file("err")), 1) << file("err");
    EXPECT_FALSE(has("a.csv"));
    EXPECT_EQ(script(assets + "ACHILLES_MPI=0 " + mpirun + "-n 1 ./achilles " + sweep), 0);
    const Answer other = folder_.run(sweep, with_mpi + "PMI_RANK=0 PMI_SIZE=3");
    EXPECT_EQ(other.status, 2);
    EXPECT_NE(other.err.find("3 processes were started, but they cannot share a sweep: each process finds 1"),
              other.err.npos);
}

// Other processes get the same results from the text of the order alone.
TEST(SweepWork, IsTheSameFromItsOrder) {
    const auto description = read_system(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml");
    auto base = default_run(description);
    for (const char* set : {"e=1/3", "x'=1.3", "y=2.1"}) assign(base, description, set);
    base.options.end_time = 7.0;
    base.options.tolerance = 1e-9;
    base.options.truncation.eps_q = 1e-5;
    const SweepSpec sweep = make_sweep({{"x=-3:3:40", "y=-1:1:3"}, {"x", "zeno_time(1)/3", "held"}}, base, description);
    const SweepTable table(std::make_shared<const Model>(description), sweep);
    const RowStorage kept{true, true, true};
    const std::string order = sweep_order(table, kept, 3);
    const RankTask share = sweep_share(order);
    EXPECT_EQ(share.threads, 3);
    EXPECT_EQ(share.task({5, 40}), sweep_chunk(table, kept, {5, 40}));
    EXPECT_NE(share.task({5, 40}), sweep_chunk(table, {true, false, true}, {5, 40}));
    EXPECT_THROW(sweep_share("0.0.1" + order.substr(order.find('\n'))), std::runtime_error);
    // The failures are appended to the stored rows.
    RunFailures failures, none;
    SweepSummary summary(table), whole(table);
    const std::string bytes = failures.take(summary.take(sweep_chunk(table, kept, {0, 120})));
    EXPECT_EQ(bytes, serialize_rows(table, kept, table.rows(0, 120)));
    whole.note(table.rows(0, 120));
    EXPECT_EQ(summary.text(), whole.text());
    EXPECT_EQ(none.append_to("a"), std::string("a\0", 2));
    EXPECT_GT(failures.append_to("").size(), 1u) << "some cannot start";
    EXPECT_EQ(none.take(failures.append_to("rows")), "rows");
    EXPECT_EQ(none.append_to(""), failures.append_to(""));
}

TEST(SweepAlone, IsNotLinkedWithMpi) {
    EXPECT_EQ(content(program).find("libmpi"), std::string::npos);
    const Folder folder;
    const Answer slurm =
        folder.run("sweep ball_on_sine --over x=0:1:2 --print x", "SLURM_PROCID=0 SLURM_STEP_NUM_TASKS=3");
    EXPECT_EQ(slurm.status, 2);
    EXPECT_NE(slurm.err.find("start them with: srun --mpi=pmix"), std::string::npos) << slurm.err;
    EXPECT_EQ(folder.run("sweep ball_on_sine --over x=0:1:2 --print x", "SLURM_PROCID=0 SLURM_STEP_NUM_TASKS=1").status,
              0);
}

}  // namespace
}  // namespace achilles::test
