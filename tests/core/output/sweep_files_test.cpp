// The rows of a sweep as bytes, and the log that stores them.
#include "output/sweep_files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/systems.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

class SweepFiles : public testing::Test {
 protected:
    SweepFiles() {
        std::string name = (fs::temp_directory_path() / "achilles_XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
        log_ = folder_ / "a.csv.part";
    }
    ~SweepFiles() override { fs::remove_all(folder_); }

    // Writes three chunks.
    void write() {
        SweepLog log(log_, key_, false, 1000);
        log.append({0, 10}, std::string(1000, 'a'));
        log.append({10, 1}, "");
        log.append({11, 5}, std::string(100, 'b'));
        EXPECT_EQ(log.done(), 16u);
    }
    std::uint64_t done() { return SweepLog(log_, key_, true, 1000).done(); }

    fs::path folder_, log_;
    SweepKey key_{"Achilles", "--over e=0:1:16 --print t", "csv ", "title = \"a\"\ne = 1\n"};
};

TEST_F(SweepFiles, KeepRowsAsBytes) {
    const auto model = test::load("ball_on_sine");
    for (const char* text :
         {"--over y=-3:3:5 --print x --print held --end 3", "--over y=-3:3:5 --print x --print t --at impact --end 3",
          "--over y=0:3:2 --print held"}) {
        const SweepTable table(model, read_sweep(text, model->description()));
        const Rows rows = table.rows(0, 2);
        const std::string bytes = to_bytes(rows);
        EXPECT_EQ(to_bytes(rows_from(bytes, table)), bytes);
        EXPECT_EQ(sweep_csv(table, rows_from(bytes, table)), sweep_csv(table, rows));
        for (std::size_t size = 0; size < bytes.size(); ++size)
            EXPECT_THROW(rows_from(bytes.substr(0, size), table), std::runtime_error) << size;
        EXPECT_THROW(rows_from(bytes + "x", table), std::runtime_error);
    }
}

// A sweep without axes: a section of one run.
TEST_F(SweepFiles, MayHaveNoAxis) {
    const auto model = test::load("ball_on_sine");
    const std::string text = "--print x --at impact --end 3";
    const SweepTable table(model, read_sweep(text, model->description()));
    EXPECT_EQ(to_text(table.sweep(), model->description()), text);
    EXPECT_EQ(table.sweep().count(), 1u);
    EXPECT_EQ(sweep_csv_heading(table, true), "t,contact,x,outcome\ns,,m,\n");
    const Rows rows = table.rows(0, 1);
    ASSERT_GT(rows.count(), 1u);
    EXPECT_EQ(sweep_csv(table, rows).rfind(fmt::format("{}", rows.times[0]), 0), 0u);
    EXPECT_THROW(read_sweep("--print x", model->description()), InputError);
    EXPECT_THROW(read_sweep("--print x --at impact --random 4", model->description()), InputError);
}

TEST_F(SweepFiles, AreReadBackFromTheLog) {
    write();
    std::string all;
    const SweepLog log(log_, key_, true, 1000);
    log.each([&](Chunk chunk, std::string_view bytes) {
        all +=
            std::to_string(chunk.first) + "+" + std::to_string(chunk.count) + ":" + std::to_string(bytes.size()) + " ";
    });
    EXPECT_EQ(all, "0+10:1000 10+1:0 11+5:100 ");
    EXPECT_THROW(SweepLog(log_, key_, true, 1000), InputError) << "while another one has it";
}

// Whatever byte the log is truncated at or corrupted in.
TEST_F(SweepFiles, LoseOnlyCorruptedChunks) {
    write();
    const auto size = fs::file_size(log_);
    const std::uint64_t first = size - 3 * 32 - 1100;
    std::string whole(size, '\0');
    std::ifstream(log_, std::ios::binary).read(whole.data(), static_cast<std::streamsize>(size));
    for (std::uint64_t at = 0; at < size; at += at < first || at > size - 140 ? 1 : 37) {
        std::ofstream(log_, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(at));
        const std::uint64_t expected = at < first + 1032 ? 0 : at < first + 1064 ? 10 : 11;
        EXPECT_EQ(done(), expected) << at;
        if (at < first) continue;
        std::string wrong = whole;
        wrong[at] = static_cast<char>(wrong[at] ^ 4);
        std::ofstream(log_, std::ios::binary).write(wrong.data(), static_cast<std::streamsize>(size));
        EXPECT_EQ(done(), expected) << at;
    }
}

TEST_F(SweepFiles, AreOfOneSweep) {
    write();
    for (std::string SweepKey::*part : {&SweepKey::software, &SweepKey::sweep, &SweepKey::files, &SweepKey::system}) {
        SweepKey other = key_;
        (other.*part) += "x";
        EXPECT_NE(difference(key_, other), "");
        EXPECT_THROW(SweepLog(log_, other, true, 1000), InputError);
        EXPECT_THROW(SweepLog(log_, other, false, 1000), InputError);
    }
    EXPECT_THROW(SweepLog(log_, key_, false, 1000), InputError) << "points would be lost";
    EXPECT_EQ(SweepLog(log_, key_, false, 16).done(), 16u) << "all of them are there: only files are to be made";
    SweepKey other = key_;
    other.sweep += "x";
    EXPECT_THROW(SweepLog(log_, other, false, 16), InputError);
    EXPECT_EQ(done(), 16u) << "and none is";
    EXPECT_EQ(difference(key_, key_), "");
}

}  // namespace
}  // namespace achilles
