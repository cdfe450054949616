// Chunks shared by ranks: the messages between them, with threads in place of processes.
#include "analysis/distributed_chunks.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <mutex>
#include <thread>

namespace achilles {
namespace {

// Ranks in one process. Each has a mailbox.
class Boxes {
 public:
    explicit Boxes(int size) : boxes_(static_cast<std::size_t>(size)) {}

    class Rank final : public Messages {
     public:
        Rank(Boxes& boxes, int rank) : boxes_(boxes), rank_(rank) {}
        int rank() const override { return rank_; }
        int size() const override { return static_cast<int>(boxes_.boxes_.size()); }
        int cores() const override { return 1; }
        void send(int to, std::string_view bytes) override {
            const std::scoped_lock lock(boxes_.mutex_);
            boxes_.boxes_[static_cast<std::size_t>(to)].push_back({rank_, std::string(bytes)});
        }
        std::optional<RankMessage> receive() override {
            const std::scoped_lock lock(boxes_.mutex_);
            auto& box = boxes_.boxes_[static_cast<std::size_t>(rank_)];
            if (box.empty()) return {};
            RankMessage letter = std::move(box.front());
            box.pop_front();
            return letter;
        }
        void leave() override {}

     private:
        Boxes& boxes_;
        int rank_;
    };

 private:
    std::mutex mutex_;
    std::vector<std::deque<Messages::RankMessage>> boxes_;
};

std::string squares_of(Chunk chunk) {
    std::string text;
    for (std::uint64_t i = chunk.first; i < chunk.first + chunk.count; ++i) text += std::to_string(i * i) + "\n";
    return text;
}

// The same, but slow.
std::string squares(Chunk chunk) {
    std::this_thread::sleep_for(std::chrono::microseconds(20 * chunk.count));
    return squares_of(chunk);
}

struct Shared {
    std::string written, problem;
    bool is_done = false;
};

// Runs rank 0 in this thread, and the other ranks in threads with the task that `begin` returns for their rank.
using Begin = std::function<RankTask(int rank, std::string_view order)>;
Shared share(int size, std::uint64_t count, const Begin& begin, const std::atomic<bool>& stop = false,
             const ChunkWriter& also = {}) {
    Boxes boxes(size);
    std::vector<std::jthread> others;
    for (int rank = 1; rank < size; ++rank)
        others.emplace_back([&boxes, &begin, rank] {
            Boxes::Rank messages(boxes, rank);
            help_with_chunks(messages, [&](std::string_view order) { return begin(rank, order); });
        });
    Boxes::Rank messages(boxes, 0);
    Shared outcome;
    const auto write = [&](Chunk chunk, const std::string& bytes) {
        if (also) also(chunk, bytes);
        outcome.written += bytes;
    };
    try {
        outcome.is_done = do_chunks(messages, "squares", 0, count, 2, squares, write, stop);
    } catch (const std::runtime_error& problem) {
        outcome.problem = problem.what();
    }
    dismiss(messages);
    return outcome;
}

TEST(DistributedChunks, ShareChunksThatAreWrittenInOrder) {
    const std::string alone = squares_of({0, 3000});
    for (const int size : {1, 2, 4}) {
        std::atomic<int> orders{0}, theirs{0};
        const Shared outcome = share(size, 3000, [&](int, std::string_view order) {
            orders += order == "squares" ? 1 : 100;
            return RankTask{2, [&](Chunk chunk) {
                                ++theirs;
                                return squares(chunk);
                            }};
        });
        EXPECT_EQ(outcome.problem, "");
        EXPECT_TRUE(outcome.is_done);
        EXPECT_EQ(outcome.written, alone) << size;
        EXPECT_EQ(orders, size - 1);
        EXPECT_EQ(theirs > 0, size > 1);
    }
}

TEST(DistributedChunks, TellWhatWentWrongInOneOfThem) {
    const std::string alone = squares_of({0, 100000});
    const Shared outcome = share(3, 100000, [&](int rank, std::string_view) {
        return RankTask{0, [rank](Chunk chunk) {
                            if (rank == 2 && chunk.first > 500) throw std::bad_alloc();
                            return squares(chunk);
                        }};
    });
    EXPECT_TRUE(outcome.problem.starts_with("rank 2 on ")) << outcome.problem;
    EXPECT_TRUE(outcome.problem.ends_with(": std::bad_alloc")) << outcome.problem;
    EXPECT_TRUE(alone.starts_with(outcome.written));
    EXPECT_LT(outcome.written.size(), alone.size());
}

TEST(DistributedChunks, TellOfAnOrderThatOneCannotRead) {
    const Shared outcome = share(
        2, 100000, [&](int, std::string_view) -> RankTask { throw std::runtime_error("this is another version"); });
    EXPECT_TRUE(outcome.problem.ends_with(": this is another version")) << outcome.problem;
}

TEST(DistributedChunks, EndWhereTheDiskIsFull) {
    const Shared outcome = share(
        3, 100000,
        [&](int, std::string_view) {
            return RankTask{1, squares};
        },
        false,
        [](Chunk chunk, const std::string&) {
            if (chunk.first > 300) throw std::runtime_error("no room");
        });
    EXPECT_EQ(outcome.problem, "no room");
    EXPECT_TRUE(squares_of({0, 100000}).starts_with(outcome.written));
}

// A killed rank no longer answers. Once all are told to stop, nothing waits for it.
TEST(DistributedChunks, KilledRanksAreNotWaitedFor) {
    Boxes boxes(2);
    std::atomic<bool> stop{false};
    const std::jthread mute([&] {
        Boxes::Rank messages(boxes, 1);
        help_with_chunks(messages, [&](std::string_view) {
            return RankTask{1, [&](Chunk) {
                                std::this_thread::sleep_for(std::chrono::milliseconds(50));
                                stop = true;
                                std::this_thread::sleep_for(std::chrono::seconds(1));
                                return std::string();
                            }};
        });
    });
    Boxes::Rank messages(boxes, 0);
    std::string written;
    const auto clock = std::chrono::steady_clock::now();
    EXPECT_FALSE(do_chunks(
        messages, "", 0, 1'000'000'000, 1, squares, [&](Chunk, const std::string& bytes) { written += bytes; }, stop));
    EXPECT_LT(std::chrono::steady_clock::now() - clock, std::chrono::milliseconds(1000));
    dismiss(messages);
    EXPECT_TRUE(squares_of({0, 1000}).starts_with(written.substr(0, 1000)));
}

}  // namespace
}  // namespace achilles
