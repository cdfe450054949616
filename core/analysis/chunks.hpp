// Parallel work in consecutive chunks, written in order.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace achilles {

// Items first, ..., first + count - 1.
struct Chunk {
    std::uint64_t first = 0, count = 0;
};

// Computes a chunk: returns bytes that depend only on the chunk. Called on several threads at once, of this process or
// of others (analysis/distributed_chunks.hpp).
using ChunkTask = std::function<std::string(Chunk)>;
// Receives the bytes in the order of the chunks, one call at a time.
using ChunkWriter = std::function<void(Chunk, const std::string&)>;

// Processes items [first, end) on this many threads (0: one for every core). After the first ones, chunks last about a
// quarter of a second; results do not depend on how items are divided. For each thread, at most one chunk is in
// progress and two wait to be written. Once `stop` is set, no further chunk starts; those in progress are finished and
// written. Returns whether all is done. An exception from task or write ends the work and is rethrown.
bool do_chunks(std::uint64_t first, std::uint64_t end, int threads, const ChunkTask& task, const ChunkWriter& write,
               const std::atomic<bool>& stop);

// The number of threads to use; 0: one for every core that this process may use.
int threads_for(int requested);

// ---- chunks to work on: the source of threads and of other processes ----

// Called from several threads at once.
class ChunkSource {
 public:
    virtual ~ChunkSource() = default;
    // The next chunk; waits if there is none yet. nullopt: there are no further chunks.
    virtual std::optional<Chunk> take() = 0;
    // The result of a chunk, and the time that it took (s).
    virtual void put(Chunk chunk, std::string bytes, double seconds) = 0;
    // Reports an exception of a task; no further chunk is handed out.
    virtual void fail(std::exception_ptr problem) = 0;
};

// Processes chunks until there are no more, on the calling thread and threads - 1 others; on fewer if no more can be
// created.
void work_on(ChunkSource& source, int threads, const ChunkTask& task);

// Divides items [first, end) into chunks and writes their results in order. The thread that delivers the next chunk to
// be written writes it and those that waited for it; the other threads continue meanwhile.
class ChunkQueue final : public ChunkSource {
 public:
    ChunkQueue(std::uint64_t first, std::uint64_t end, const ChunkWriter& write, const std::atomic<bool>& stop);

    // Announces further threads: for each, one chunk may be in progress and two may wait to be written.
    void add_threads(int threads);
    std::optional<Chunk> take() override;
    // The same without waiting: nullopt if there is none now.
    std::optional<Chunk> take_at_once();
    void put(Chunk chunk, std::string bytes, double seconds) override;
    void fail(std::exception_ptr problem) override;
    bool has_failed() const;
    // Whether all is written. Throws the first exception.
    bool finish();

 private:
    bool is_over() const;
    bool has_room() const;
    Chunk cut();
    std::uint64_t next_length() const;
    void write_waiting(std::unique_lock<std::mutex>& lock);

    struct CompletedChunk {
        Chunk chunk;
        std::string bytes;
    };
    const ChunkWriter& write_;
    const std::atomic<bool>& stop_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::uint64_t next_, written_, end_;       // items: start of the next chunk; all before written_ are written
    std::uint64_t threads_ = 0, started_ = 0;  // started_: chunks handed out and not written
    std::map<std::uint64_t, CompletedChunk> waiting_;  // finished chunks, by their first item
    bool is_writing_ = false;
    double rate_ = 0.0;  // items per second, for one thread
    std::exception_ptr problem_;
};

}  // namespace achilles
