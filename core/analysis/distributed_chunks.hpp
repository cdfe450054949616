// Chunks processed by several processes: the first one distributes them, processes some itself, and is the only one
// that writes.
#pragma once

#include <optional>
#include <string_view>

#include "analysis/chunks.hpp"

namespace achilles {

// Messages between the processes, called ranks, 0 to size - 1. Each process sends and receives on one thread only.
class Messages {
 public:
    virtual ~Messages() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    // Number of threads that this rank may use, so that all ranks of its machine share the cores.
    virtual int cores() const = 0;
    virtual void send(int to, std::string_view bytes) = 0;
    struct RankMessage {
        int from = 0;
        std::string bytes;
    };
    // A message that has arrived, if there is one.
    virtual std::optional<RankMessage> receive() = 0;
    // All ranks are being terminated: this process may exit without waiting for the others.
    virtual void leave() = 0;
};

// The task of a rank: it must return the same bytes for a chunk as the task of rank 0.
struct RankTask {
    int threads = 0;  // 0: as many as the rank has cores
    ChunkTask task;
};

// For ranks other than 0: processes chunks until rank 0 dismisses it. `begin` converts an order to the task. An
// exception from `begin` or the task ends the work at rank 0.
void help_with_chunks(Messages& messages, const std::function<RankTask(std::string_view order)>& begin);
// For rank 0: ends the work of the other ranks.
void dismiss(Messages& messages);

// do_chunks() together with the other ranks, which receive `order`; call it once before dismiss(). The written output
// is the same. For each of their threads, one chunk waits besides the one in progress, so that no thread waits for
// messages. Once `stop` is set, the others have half a second to finish their chunks, because all processes may be
// about to be terminated. An exception of their task is rethrown here as std::runtime_error, with the rank.
bool do_chunks(Messages& messages, const std::string& order, std::uint64_t first, std::uint64_t end, int threads,
               const ChunkTask& task, const ChunkWriter& write, const std::atomic<bool>& stop);

}  // namespace achilles
