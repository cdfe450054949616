// A long work in chunks that follow one another, done by several threads and written by one.
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

// What a chunk comes to, as bytes that depend on it alone. Asked of several threads at once, of this process or of others
// (study/ranks.hpp).
using ChunkTask = std::function<std::string(Chunk)>;
// Takes the bytes in the order of the chunks, one after the other.
using ChunkWriter = std::function<void(Chunk, const std::string&)>;

// Does items [first, end) on so many threads (0: one for every core). Chunks are as long as they take a quarter of a second,
// but for the first ones, as nothing depends on where they are cut; beside the one of each thread two more may wait for
// one before them, and no more. Once `stop` is set no chunk is begun, and those under way are finished and written. Whether
// all is done. What task or write throws ends it, and is thrown again.
bool do_chunks(std::uint64_t first, std::uint64_t end, int threads, const ChunkTask& task, const ChunkWriter& write,
               const std::atomic<bool>& stop);

// As many threads as asked for; 0: one for every core that this process may use.
int threads_for(int asked);

// Where chunks come from and where what they come to goes: what threads, and other processes, take their work from.

// Asked of several threads at once.
class ChunkSource {
 public:
    virtual ~ChunkSource() = default;
    // The next chunk; waits while there is none yet. Nothing: there will be no other.
    virtual std::optional<Chunk> take() = 0;
    // What a chunk came to, and how long that took (s).
    virtual void put(Chunk chunk, std::string bytes, double seconds) = 0;
    // What a task has thrown: no chunk is handed out after it.
    virtual void fail(std::exception_ptr problem) = 0;
};

// Takes chunks and does them, on the thread that asks and so many others, until there are no more. Where the machine has
// no more threads, on fewer.
void work_on(ChunkSource& source, int threads, const ChunkTask& task);

// Items [first, end), cut into chunks and written in order. Whoever puts the chunk that is next writes it, and those that waited
// for it; the others go on meanwhile.
class ChunkQueue final : public ChunkSource {
 public:
    ChunkQueue(std::uint64_t first, std::uint64_t end, const ChunkWriter& write, const std::atomic<bool>& stop);

    // So many more threads will take from it: for each a chunk may be under way, and two wait for one before them.
    void add_threads(int threads);
    std::optional<Chunk> take() override;
    // The same without waiting: nothing, where there is none now.
    std::optional<Chunk> take_at_once();
    void put(Chunk chunk, std::string bytes, double seconds) override;
    void fail(std::exception_ptr problem) override;
    bool has_failed() const;
    // Whether all is written. Throws the first problem.
    bool finish();

 private:
    bool is_over() const;
    bool has_room() const;
    Chunk cut();
    std::uint64_t next_length() const;
    void write_waiting(std::unique_lock<std::mutex>& lock);

    struct Done {
        Chunk chunk;
        std::string bytes;
    };
    const ChunkWriter& write_;
    const std::atomic<bool>& stop_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::uint64_t next_, written_, end_;       // items: of the next chunk, and up to which all are written
    std::uint64_t threads_ = 0, started_ = 0;  // chunks that are handed out and not written
    std::map<std::uint64_t, Done> waiting_;    // done, by their first item
    bool is_writing_ = false;
    double rate_ = 0.0;  // items a second, of one thread
    std::exception_ptr problem_;
};

}  // namespace achilles
