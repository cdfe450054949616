// Workers for computations that take longer than a frame. Only the newest request counts.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace achilles {

// Does the task on a thread that is idle, or on a new one. A page has ACHILLES_MOST_THREADS of them, which the browser
// starts with the page, since it starts none while the page waits: if all are busy, the task waits for one of them.
void run_on_a_thread(std::function<void()> task);

// While a page waits for a job it stands still, so it waits for this time, s, and then gives up: throws InputError.
#if defined(ACHILLES_MOST_THREADS)
constexpr std::optional<double> longest_wait = 10.0;
#else
constexpr std::optional<double> longest_wait;
#endif
[[noreturn]] void give_up_waiting();

// Runs one job after the other, each on another thread.
template <class Result>
class Worker {
 public:
    // Must poll the token: after a stop request its result or exception is discarded.
    using Job = std::function<Result(std::stop_token)>;

    Worker() = default;
    // Requests a stop of the job under way and waits for it.
    ~Worker() {
        std::unique_lock lock(state_->mutex);
        state_->current.request_stop();
        state_->job = nullptr;
        state_->changed.wait(lock, [this] { return !state_->at_work; });
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    // `ready` is called on the job's thread each time a result has become ready.
    void on_ready(const std::function<void()>& ready) {
        const std::lock_guard lock(state_->mutex);
        state_->ready = ready;
    }

    // Starts a job. The job under way is asked to stop, and a result not taken yet is dropped.
    void start(Job job) {
        const std::lock_guard lock(state_->mutex);
        state_->current.request_stop();
        state_->current = std::stop_source();
        state_->job = std::move(job);
        state_->answer.reset();
        state_->busy = true;
        if (!std::exchange(state_->has_thread, true)) run_on_a_thread([state = state_] { state->work(); });
    }

    // The result of the newest job. Empty if it is not ready within `patience` seconds (without one: longest_wait), or
    // was already taken. Rethrows an exception of the job.
    std::optional<Result> take(std::optional<double> patience) {
        std::unique_lock lock(state_->mutex);
        const auto ready = [this] { return !state_->busy; };
        if (const std::optional<double> limit = patience ? patience : longest_wait)
            state_->changed.wait_for(lock, std::chrono::duration<double>(*limit), ready);
        else
            state_->changed.wait(lock, ready);
        if (state_->busy && !patience) {
            state_->current.request_stop();
            state_->busy = false;
            give_up_waiting();
        }
        if (!state_->answer) return std::nullopt;
        const Answer answer = *std::exchange(state_->answer, std::nullopt);
        if (answer.problem) std::rethrow_exception(answer.problem);
        return answer.result;
    }

 private:
    struct Answer {
        std::optional<Result> result;
        std::exception_ptr problem;
    };

    static Answer done(const Job& job, const std::stop_token& stop) {
        try {
            return {job(stop), nullptr};
        } catch (...) {
            return {std::nullopt, std::current_exception()};
        }
    }

    // Shared with the thread, which may begin after the worker has ended.
    struct State {
        std::mutex mutex;
        std::condition_variable changed;
        std::function<void()> ready;
        Job job;                       // not begun yet
        std::stop_source current;      // stops the newest job
        std::optional<Answer> answer;  // what the newest job gave, until it is taken
        bool busy = false;             // the newest job has no answer yet
        bool has_thread = false;       // work() is under way, or waits for a thread
        bool at_work = false;          // a job is under way

        // Does jobs until there is none.
        void work() {
            std::unique_lock lock(mutex);
            while (job) {
                at_work = true;
                do_job(lock);
                at_work = false;
                changed.notify_all();
            }
            has_thread = false;
        }

        void do_job(std::unique_lock<std::mutex>& lock) {
            Job begun = std::exchange(job, nullptr);
            const std::stop_token stop = current.get_token();
            lock.unlock();
            Answer given = done(begun, stop);
            begun = nullptr;
            lock.lock();
            if (stop.stop_requested()) {
                lock.unlock();
                given = {};  // releasing a long run takes time; do it without the lock
                lock.lock();
                return;
            }
            answer = std::move(given);
            busy = false;
            changed.notify_all();
            const std::function<void()> tell = ready;
            lock.unlock();
            if (tell) tell();
            lock.lock();
        }
    };
    const std::shared_ptr<State> state_ = std::make_shared<State>();
};

// Timeout in seconds; nullopt waits indefinitely.
using Timeout = std::optional<double>;

// The monitor of work that reports no progress.
struct StopMonitor {
    std::stop_token stop;
};

// Runs one study at a time on its own thread and keeps the last result. A Monitor has a stop token and the progress of
// the work.
template <class Result, class Monitor = StopMonitor>
class Job {
 public:
    using Work = std::function<Result(Monitor&)>;

    // Starts the work. Work under way is stopped, and its result or exception is dropped.
    void start(Work work, std::shared_ptr<Monitor> monitor = std::make_shared<Monitor>()) {
        monitor_ = monitor;
        worker_.start([work = std::move(work), monitor = std::move(monitor)](const std::stop_token& stop) {
            monitor->stop = stop;
            return std::make_shared<const Result>(work(*monitor));
        });
    }
    // Stops work under way. The last result stays.
    void stop() {
        if (monitor_ == nullptr) return;
        monitor_.reset();
        worker_.start([](const std::stop_token&) { return std::shared_ptr<const Result>(); });
    }
    // Forgets the last result. Work under way goes on.
    void drop() { result_.reset(); }
    void forget() {
        stop();
        drop();
    }
    // Receives a result: true if there was one. Rethrows an exception of the work; the last result is kept then.
    bool update(Timeout patience) {
        if (monitor_ == nullptr) return false;
        try {
            const auto made = worker_.take(patience);
            if (!made) return false;
            result_ = *made;
        } catch (...) {
            monitor_.reset();
            throw;
        }
        monitor_.reset();
        return true;
    }
    // `ready` is called on another thread when update() would receive a result.
    void on_ready(const std::function<void()>& ready) { worker_.on_ready(ready); }

    // Monitor of the work under way; null if there is none.
    const Monitor* under_way() const { return monitor_.get(); }
    // The last result; null before the first.
    const std::shared_ptr<const Result>& result() const { return result_; }

 private:
    std::shared_ptr<Monitor> monitor_;
    std::shared_ptr<const Result> result_;
    Worker<std::shared_ptr<const Result>> worker_;
};

}  // namespace achilles
