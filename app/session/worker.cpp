#include "session/worker.hpp"

#include <fmt/format.h>

#include <deque>
#include <limits>
#include <thread>

#include "system/input_error.hpp"

namespace achilles {

namespace {

// The threads of all workers and their tasks.
class WorkerThreads {
 public:
    void run(std::function<void()> task) {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
        if (idle_ >= tasks_.size())
            task_waits_.notify_one();
        else if (threads_ < most_threads)
            start_thread();
    }

 private:
#if defined(ACHILLES_MOST_THREADS)
    static constexpr std::size_t most_threads = ACHILLES_MOST_THREADS;
#else
    static constexpr std::size_t most_threads = std::numeric_limits<std::size_t>::max();
#endif

    void start_thread() {
        std::thread([this] { work(); }).detach();
        ++threads_;
    }

    void work() {
        std::unique_lock lock(mutex_);
        for (;;) {
            ++idle_;
            task_waits_.wait(lock, [this] { return !tasks_.empty(); });
            --idle_;
            const std::function<void()> task = std::move(tasks_.front());
            tasks_.pop_front();
            lock.unlock();
            task();
            lock.lock();
        }
    }

    std::mutex mutex_;
    std::condition_variable task_waits_;
    std::deque<std::function<void()>> tasks_;  // not begun yet
    std::size_t threads_ = 0, idle_ = 0;
};

}  // namespace

void run_on_a_thread(std::function<void()> task) {
    // Never destroyed, since a thread may still work when the program ends.
    static WorkerThreads& threads = *new WorkerThreads;
    threads.run(std::move(task));
}

void give_up_waiting() {
    throw InputError(
        {}, {}, fmt::format("this takes longer than {} s, for which a page does not wait", longest_wait.value_or(0.0)),
        "use the window: achilles explore");
}

}  // namespace achilles
