// A thread of its own for what takes longer than a frame. Only the newest request counts.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace achilles {

// How many seconds somebody waits; nothing: as long as it takes.
using Patience = std::optional<double>;

template <class Result>
class Worker {
 public:
    // Looks at the token now and then: once a stop is requested, nobody will see what it returns or throws.
    using Job = std::function<Result(std::stop_token)>;

    Worker() : thread_([this](const std::stop_token& end) { work(end); }) {}
    // Stops what is under way and waits until it has.
    ~Worker() {
        const std::lock_guard lock(mutex_);
        current_.request_stop();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    // Called on the worker's thread each time a result has become ready.
    void on_ready(std::function<void()> ready) {
        const std::lock_guard lock(mutex_);
        ready_ = std::move(ready);
    }

    // Begins this; what is under way is told to stop, and a result nobody took is dropped.
    void start(Job job) {
        const std::lock_guard lock(mutex_);
        current_.request_stop();
        current_ = std::stop_source();
        job_ = std::move(job);
        answer_.reset();
        busy_ = true;
        changed_.notify_all();
    }

    // The result of the newest job, once; nothing if it is not ready in time, or was taken. Rethrows what the job
    // threw.
    std::optional<Result> take(Patience patience) {
        std::unique_lock lock(mutex_);
        const auto ready = [this] { return !busy_; };
        if (patience)
            changed_.wait_for(lock, std::chrono::duration<double>(*patience), ready);
        else
            changed_.wait(lock, ready);
        if (!answer_) return std::nullopt;
        const Answer answer = *std::exchange(answer_, std::nullopt);
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

    void work(const std::stop_token& end) {
        std::unique_lock lock(mutex_);
        while (changed_.wait(lock, end, [this] { return static_cast<bool>(job_); })) {
            const Job job = std::exchange(job_, nullptr);
            const std::stop_token stop = current_.get_token();
            lock.unlock();
            Answer answer = done(job, stop);
            lock.lock();
            if (stop.stop_requested()) {
                lock.unlock();
                answer = {};  // a long run takes a while to forget, and nobody shall wait for that
                lock.lock();
                continue;
            }
            answer_ = std::move(answer);
            busy_ = false;
            changed_.notify_all();
            const std::function<void()> ready = ready_;
            lock.unlock();
            if (ready) ready();
            lock.lock();
        }
    }

    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::function<void()> ready_;
    Job job_;                       // not begun yet
    std::stop_source current_;      // of the newest job
    std::optional<Answer> answer_;  // of the newest job
    bool busy_ = false;             // the newest job has no answer yet
    std::jthread thread_;           // the last: it uses all the others
};

// The monitor of work that reports no progress.
struct StopMonitor {
    std::stop_token stop;
};

// One study at a time, on a thread of its own, and the last result. A Monitor has a stop token, and what the work
// reports while it goes on.
template <class Result, class Monitor = StopMonitor>
class Job {
 public:
    using Work = std::function<Result(Monitor&)>;

    // Begins this. Work under way is stopped, and what it returns or throws is dropped.
    void start(Work work, std::shared_ptr<Monitor> monitor = std::make_shared<Monitor>()) {
        monitor_ = monitor;
        worker_.start([work = std::move(work), monitor = std::move(monitor)](std::stop_token stop) {
            monitor->stop = std::move(stop);
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
    // Takes a result that is ready: true if there was one. Rethrows what the work threw; the last result stays then.
    bool update(Patience patience) {
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
    // Called on another thread when update() would take a result.
    void on_ready(std::function<void()> ready) { worker_.on_ready(std::move(ready)); }

    // Of the work under way; null without any.
    const Monitor* under_way() const { return monitor_.get(); }
    // The last result; null before the first.
    const std::shared_ptr<const Result>& result() const { return result_; }

 private:
    std::shared_ptr<Monitor> monitor_;
    std::shared_ptr<const Result> result_;
    Worker<std::shared_ptr<const Result>> worker_;
};

}  // namespace achilles
