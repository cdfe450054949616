#include "study/chunks.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <optional>

namespace achilles {

namespace {

struct Done {
    Chunk chunk;
    std::string bytes;
};

// How long the next chunk is.
class Lengths {
 public:
    explicit Lengths(int threads) : threads_(static_cast<std::uint64_t>(threads)) {}

    std::uint64_t next(std::uint64_t left) const {
        constexpr double seconds = 0.25;
        constexpr std::uint64_t least = 1, at_first = 32, most = 4096, few = 32;
        const double rate = rate_.load(std::memory_order_relaxed);
        const std::uint64_t length =
            rate > 0.0 ? static_cast<std::uint64_t>(std::clamp(rate * seconds, double{least}, double{most})) : at_first;
        // Near the end they are shorter, so that no thread waits long for the last one.
        const std::uint64_t share = std::max(few, left / (2 * threads_));
        return std::min({length, share, left});
    }

    void note(std::uint64_t count, double seconds) {
        rate_.store(static_cast<double>(count) / std::max(seconds, 1e-6), std::memory_order_relaxed);
    }

 private:
    std::uint64_t threads_;
    std::atomic<double> rate_{0.0};  // items a second, of one thread
};

}  // namespace

bool do_chunks(std::uint64_t first, std::uint64_t end, int threads, const ChunkTask& task, const ChunkWriter& write,
               const std::atomic<bool>& stop) {
    // More threads than cores, where they are asked for.
    std::optional<tbb::global_control> limit;
    if (threads > 0)
        limit.emplace(
            tbb::global_control::max_allowed_parallelism,
            std::max<std::size_t>(static_cast<std::size_t>(threads),
                                  tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    const int workers = arena.max_concurrency();
    Lengths lengths(workers);
    std::uint64_t next = first;
    const auto cut = [&](tbb::flow_control& control) {
        if (next >= end || stop) {
            control.stop();
            return Chunk{};
        }
        const Chunk chunk{next, lengths.next(end - next)};
        next += chunk.count;
        return chunk;
    };
    const auto work = [&](Chunk chunk) {
        const auto clock = std::chrono::steady_clock::now();
        Done done{chunk, task(chunk)};
        lengths.note(chunk.count, std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count());
        return done;
    };
    const auto put = [&](const Done& done) { write(done.chunk, done.bytes); };
    using tbb::filter_mode;
    arena.execute([&] {
        tbb::parallel_pipeline(static_cast<std::size_t>(workers > 1 ? 2 * workers : 1),
                               tbb::make_filter<void, Chunk>(filter_mode::serial_in_order, cut) &
                                   tbb::make_filter<Chunk, Done>(filter_mode::parallel, work) &
                                   tbb::make_filter<Done, void>(filter_mode::serial_in_order, put));
    });
    return next >= end;
}

}  // namespace achilles
