#include "analysis/distributed_chunks.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <thread>

#include "analysis/chunks.hpp"

namespace achilles {

namespace {

using Clock = std::chrono::steady_clock;
// Polling interval: long compared with the cost of polling, short compared with a chunk.
constexpr std::chrono::microseconds pause(1000);

// The first byte of a message. From rank 0: the order, a chunk, dismissal. To rank 0: ready with a number of threads,
// the result of a chunk, a failure.
enum class MessageKind : char { order = 'o', chunk = 'c', dismissed = 'x', ready = 'r', done = 'd', failed = 'f' };

MessageKind kind_of(const Messages::RankMessage& letter) {
    return static_cast<MessageKind>(letter.bytes.empty() ? 'x' : letter.bytes[0]);
}

std::string_view content_of(const Messages::RankMessage& letter) { return std::string_view(letter.bytes).substr(1); }

std::string message(MessageKind kind, std::string_view content = {}) {
    std::string bytes(1, static_cast<char>(kind));
    bytes += content;
    return bytes;
}

template <class Value>
std::string_view as_bytes(const Value& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

// Removes a value from the front of the bytes.
template <class Value>
Value take(std::string_view& bytes) {
    Value value{};
    if (bytes.size() < sizeof value) throw std::runtime_error("a message between processes is incomplete");
    std::memcpy(&value, bytes.data(), sizeof value);
    bytes.remove_prefix(sizeof value);
    return value;
}

// The other ranks, as seen by rank 0.
class Crew {
 public:
    Crew(Messages& messages, ChunkQueue& queue, const std::string& order)
        : messages_(messages),
          queue_(queue),
          requested_(static_cast<std::size_t>(messages.size())),
          in_progress_(requested_) {
        for (int rank = 1; rank < messages.size(); ++rank) messages.send(rank, message(MessageKind::order, order));
    }

    // Receives all messages that have arrived, and sends chunks to ranks that can take them.
    void serve() {
        while (const auto letter = messages_.receive()) read(*letter);
        for (bool goes_on = true; goes_on;) {  // in turn: each rank gets one chunk before any gets two
            goes_on = false;
            for (std::size_t rank = 1; rank < requested_.size(); ++rank) goes_on = send_chunk(rank) || goes_on;
        }
    }
    bool has_chunks_in_progress() const {
        for (const int out : in_progress_)
            if (out > 0) return true;
        return false;
    }

 private:
    void read(const Messages::RankMessage& letter) {
        const auto from = static_cast<std::size_t>(letter.from);
        std::string_view content = content_of(letter);
        switch (kind_of(letter)) {
            case MessageKind::ready: {
                const int threads = take<int>(content);
                requested_[from] = 2 * threads;
                return queue_.add_threads(threads);
            }
            case MessageKind::done: {
                const auto chunk = take<Chunk>(content);
                const auto taken = take<double>(content);
                --in_progress_[from];
                ++requested_[from];
                return queue_.put(chunk, std::string(content), taken);
            }
            default:
                queue_.fail(std::make_exception_ptr(std::runtime_error(fmt::format("rank {} {}", from, content))));
        }
    }

    bool send_chunk(std::size_t rank) {
        if (requested_[rank] == 0) return false;
        const std::optional<Chunk> chunk = queue_.take_at_once();
        if (!chunk) return false;
        messages_.send(static_cast<int>(rank), message(MessageKind::chunk, as_bytes(*chunk)));
        --requested_[rank];
        ++in_progress_[rank];
        return true;
    }

    Messages& messages_;
    ChunkQueue& queue_;
    std::vector<int> requested_, in_progress_;  // numbers of chunks: that each rank could take, and that it has
};

// The chunks received by another rank for its threads, and their results to be sent.
class Inbox final : public ChunkSource {
 public:
    void add(Chunk chunk) {
        const std::scoped_lock lock(mutex_);
        chunks_.push_back(chunk);
        changed_.notify_one();
    }
    // Chunks that have not started are discarded.
    void close() {
        const std::scoped_lock lock(mutex_);
        is_closed_ = true;
        changed_.notify_all();
    }

    std::optional<Chunk> take() override {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return is_closed_ || !chunks_.empty(); });
        if (is_closed_) return {};
        const Chunk chunk = chunks_.front();
        chunks_.pop_front();
        return chunk;
    }
    void put(Chunk chunk, std::string bytes, double seconds) override {
        std::string header(as_bytes(chunk));
        header += as_bytes(seconds);
        const std::scoped_lock lock(mutex_);
        outbox_.push_back(message(MessageKind::done, header + bytes));
    }
    void fail(std::exception_ptr problem) override {
        std::string text = "stopped with an unknown error";
        try {
            std::rethrow_exception(problem);
        } catch (const std::exception& error) {
            text = error.what();
        } catch (...) {
        }
        std::array<char, 256> host{};
        if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
        const std::scoped_lock lock(mutex_);
        outbox_.push_back(message(MessageKind::failed, fmt::format("on {}: {}", host.data(), text)));
        is_closed_ = true;
        changed_.notify_all();
    }

    std::optional<std::string> next_out() {
        const std::scoped_lock lock(mutex_);
        if (outbox_.empty()) return {};
        std::string bytes = std::move(outbox_.front());
        outbox_.pop_front();
        return bytes;
    }

 private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Chunk> chunks_;
    std::deque<std::string> outbox_;
    bool is_closed_ = false;
};

}  // namespace

void dismiss(Messages& messages) {
    for (int rank = 1; rank < messages.size(); ++rank) messages.send(rank, message(MessageKind::dismissed));
}

void help_with_chunks(Messages& messages, const std::function<RankTask(std::string_view order)>& begin) {
    Inbox inbox;
    RankTask share;
    std::jthread work;
    const auto read = [&](const Messages::RankMessage& letter) {
        std::string_view content = content_of(letter);
        if (kind_of(letter) == MessageKind::chunk) return inbox.add(take<Chunk>(content));
        try {
            share = begin(content);
        } catch (...) {
            return inbox.fail(std::current_exception());
        }
        if (share.threads <= 0) share.threads = messages.cores();
        work = std::jthread([&] { work_on(inbox, share.threads, share.task); });
        messages.send(0, message(MessageKind::ready, as_bytes(share.threads)));
    };
    for (;;) {
        bool is_idle = true;
        if (const auto letter = messages.receive()) {
            if (kind_of(*letter) == MessageKind::dismissed) break;
            read(*letter);
            is_idle = false;
        }
        if (const auto bytes = inbox.next_out()) {
            messages.send(0, *bytes);
            is_idle = false;
        }
        if (is_idle) std::this_thread::sleep_for(pause);
    }
    inbox.close();
}

bool do_chunks(Messages& messages, const std::string& order, std::uint64_t first, std::uint64_t end, int threads,
               const ChunkTask& task, const ChunkWriter& write, const std::atomic<bool>& stop) {
    constexpr std::chrono::milliseconds patience(500);
    ChunkQueue queue(first, end, write, stop);
    Crew crew(messages, queue, order);
    if (threads <= 0) threads = messages.cores();
    queue.add_threads(threads);
    std::atomic<bool> is_working{true};
    const std::jthread work([&] {
        work_on(queue, threads, task);
        is_working = false;
    });
    std::optional<Clock::time_point> stopped;
    while (is_working || (crew.has_chunks_in_progress() && !queue.has_failed())) {
        try {
            crew.serve();
        } catch (...) {
            queue.fail(std::current_exception());
        }
        if (stop && !stopped) stopped = Clock::now();
        if (stopped && !is_working && Clock::now() > *stopped + patience) break;
        std::this_thread::sleep_for(pause);
    }
    return queue.finish();
}

}  // namespace achilles
