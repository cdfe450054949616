// The process pool and its progress display.
#include "pictures/process_pool.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "app/program.hpp"
#include "system/description.hpp"

namespace achilles::test {
namespace {

namespace fs = std::filesystem;

TEST(Progress, TellsHowMuchHowFastAndHowLong) {
    EXPECT_EQ(progress_line(0, 120, 0.5, "frames"), "[..............................]   0%  0/120 frames");
    EXPECT_EQ(progress_line(60, 120, 5.0, "frames"),
              "[###############...............]  50%  60/120 frames  12.0/s  0:05 left");
    EXPECT_EQ(progress_line(1, 1000, 1.0, "frames"),
              "[..............................]   0%  1/1000 frames  1.0/s  16:39 left");
    EXPECT_EQ(progress_line(0, 0, 0.0, "frames"), "[##############################] 100%  0/0 frames");
}

// A task writes a file, which every process can see.
TEST(ProcessPool, DoesEveryTaskOnce) {
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

TEST(ProcessPool, WhereOneIsKilledTheOthersGoOn) {
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

TEST(ProcessPool, TheFirstProblemEndsTheWork) {
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

}  // namespace
}  // namespace achilles::test
