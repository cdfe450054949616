#include "analysis/chunks.hpp"

#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>

namespace achilles {

int threads_for(int requested) { return requested > 0 ? requested : std::max(1, tbb::info::default_concurrency()); }

bool do_chunks(std::uint64_t first, std::uint64_t end, int threads, const ChunkTask& task, const ChunkWriter& write,
               const std::atomic<bool>& stop) {
    ChunkQueue queue(first, end, write, stop);
    threads = threads_for(threads);
    queue.add_threads(threads);
    work_on(queue, threads, task);
    return queue.finish();
}

void work_on(ChunkSource& source, int threads, const ChunkTask& task) {
    const auto work = [&] {
        try {
            while (const std::optional<Chunk> chunk = source.take()) {
                const auto clock = std::chrono::steady_clock::now();
                std::string bytes = task(*chunk);
                const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - clock;
                source.put(*chunk, std::move(bytes), taken.count());
            }
        } catch (...) {
            source.fail(std::current_exception());
        }
    };
    std::vector<std::jthread> others;
    try {
        while (static_cast<int>(others.size()) + 1 < threads) others.emplace_back(work);
    } catch (const std::system_error&) {  // continue with fewer threads
    }
    work();
}

ChunkQueue::ChunkQueue(std::uint64_t first, std::uint64_t end, const ChunkWriter& write, const std::atomic<bool>& stop)
    : write_(write), stop_(stop), next_(first), written_(first), end_(end) {}

void ChunkQueue::add_threads(int threads) {
    const std::scoped_lock lock(mutex_);
    threads_ += static_cast<std::uint64_t>(threads);
    changed_.notify_all();
}

bool ChunkQueue::is_over() const { return problem_ != nullptr || stop_ || next_ >= end_; }

bool ChunkQueue::has_room() const { return started_ < (threads_ > 1 ? 3 * threads_ : 1); }

std::optional<Chunk> ChunkQueue::take() {
    std::unique_lock lock(mutex_);
    // Wait with a timeout, because setting stop_ sends no notification.
    while (!is_over() && !has_room()) changed_.wait_for(lock, std::chrono::milliseconds(50));
    if (is_over()) return {};
    return cut();
}

std::optional<Chunk> ChunkQueue::take_at_once() {
    const std::scoped_lock lock(mutex_);
    if (is_over() || !has_room()) return {};
    return cut();
}

std::uint64_t ChunkQueue::next_length() const {
    constexpr double seconds = 0.25;
    constexpr std::uint64_t least = 1, at_first = 32, most = 4096, few = 32;
    const std::uint64_t left = end_ - next_, length = rate_ > 0.0 ? static_cast<std::uint64_t>(std::clamp(
                                                                        rate_ * seconds, double{least}, double{most}))
                                                                  : at_first;
    // Toward the end, chunks are shorter, so that no thread waits long for the last one.
    const std::uint64_t share = std::max(few, left / (2 * std::max<std::uint64_t>(1, threads_)));
    return std::min({length, share, left});
}

Chunk ChunkQueue::cut() {
    const Chunk chunk{next_, next_length()};
    next_ += chunk.count;
    ++started_;
    return chunk;
}

void ChunkQueue::put(Chunk chunk, std::string bytes, double seconds) {
    std::unique_lock lock(mutex_);
    rate_ = static_cast<double>(chunk.count) / std::max(seconds, 1e-6);
    waiting_.emplace(chunk.first, CompletedChunk{chunk, std::move(bytes)});
    if (!is_writing_) write_waiting(lock);
}

void ChunkQueue::write_waiting(std::unique_lock<std::mutex>& lock) {
    is_writing_ = true;
    while (!problem_ && !waiting_.empty() && waiting_.begin()->first == written_) {
        const CompletedChunk done = std::move(waiting_.extract(waiting_.begin()).mapped());
        lock.unlock();
        std::exception_ptr problem;
        try {
            write_(done.chunk, done.bytes);
        } catch (...) {
            problem = std::current_exception();
        }
        lock.lock();
        if (problem && !problem_) problem_ = problem;
        if (!problem) written_ += done.chunk.count;
        --started_;
        changed_.notify_all();
    }
    is_writing_ = false;
}

void ChunkQueue::fail(std::exception_ptr problem) {
    const std::scoped_lock lock(mutex_);
    if (!problem_) problem_ = std::move(problem);
    changed_.notify_all();
}

bool ChunkQueue::has_failed() const {
    const std::scoped_lock lock(mutex_);
    return problem_ != nullptr;
}

bool ChunkQueue::finish() {
    const std::scoped_lock lock(mutex_);
    if (problem_) std::rethrow_exception(problem_);
    return written_ >= end_;
}

}  // namespace achilles
