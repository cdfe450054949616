// A long work in chunks that follow one another, done by several threads and written by one.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
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

}  // namespace achilles
