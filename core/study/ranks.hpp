// Chunks done by several processes: the first hands them out, does some itself, and is the only one that writes.
#pragma once

#include <optional>
#include <string_view>

#include "study/chunks.hpp"

namespace achilles {

// Messages between the processes, called ranks, 0 to size - 1. All are sent and taken by one thread of each.
class Messages {
 public:
    virtual ~Messages() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    // How many threads this rank may use, so that all ranks of its machine share the cores.
    virtual int cores() const = 0;
    virtual void send(int to, std::string_view bytes) = 0;
    struct Letter {
        int from = 0;
        std::string bytes;
    };
    // One that has come, if there is one.
    virtual std::optional<Letter> receive() = 0;
    // All are being ended: this process ends without waiting for the others.
    virtual void leave() = 0;
};

// What a rank does of a work: the same bytes of a chunk as the first's own task.
struct Share {
    int threads = 0;  // 0: as many as the rank has cores
    ChunkTask task;
};

// For the other ranks: does chunks of the work that an order tells, which `begin` reads, until rank 0 dismisses it. What `begin`
// or the task throws ends the work there.
void help_with_chunks(Messages& messages, const std::function<Share(std::string_view order)>& begin);
// By rank 0: nothing more is wanted of the others.
void dismiss(Messages& messages);

// do_chunks() with the other ranks, which are told `order`: once, before they are dismissed. What is written is the same. A chunk waits at every thread of the others beside the one that it does, so that
// none waits for the way to and fro. Once `stop` is set the others have half a second for what is under way: who
// stops them may be about to end them all. What a task of theirs throws is thrown here as std::runtime_error, with the rank.
bool do_chunks(Messages& messages, const std::string& order, std::uint64_t first, std::uint64_t end, int threads,
               const ChunkTask& task, const ChunkWriter& write, const std::atomic<bool>& stop);

}  // namespace achilles
