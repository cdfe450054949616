// Worker (session/worker.hpp) with a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace achilles {

template <class Result>
class ThreadedWorker {
 public:
    // Must poll the token: after a stop request its result or exception is discarded.
    using Job = std::function<Result(std::stop_token)>;

    ThreadedWorker() : thread_([this](const std::stop_token& end) { work(end); }) {}
    // Requests a stop of the job under way and waits for it.
    ~ThreadedWorker() {
        const std::lock_guard lock(mutex_);
        current_.request_stop();
    }
    ThreadedWorker(const ThreadedWorker&) = delete;
    ThreadedWorker& operator=(const ThreadedWorker&) = delete;

    // Called on the worker's thread each time a result has become ready.
    void on_ready(std::function<void()> ready) {
        const std::lock_guard lock(mutex_);
        ready_ = std::move(ready);
    }

    // Starts a job. The job under way is asked to stop, and a result not taken yet is dropped.
    void start(Job job) {
        const std::lock_guard lock(mutex_);
        current_.request_stop();
        current_ = std::stop_source();
        job_ = std::move(job);
        answer_.reset();
        busy_ = true;
        changed_.notify_all();
    }

    // The result of the newest job. Empty if it is not ready in time, or was already taken. Rethrows an exception of
    // the job.
    std::optional<Result> take(std::optional<double> patience) {
        std::unique_lock lock(mutex_);
        const auto ready = [this] { return !busy_; };
        if (patience)
            changed_.wait_for(lock, std::chrono::duration<double>(*patience), ready);
        else
            changed_.wait(lock, ready);
        if (!answer_) return std::nullopt;
        const JobResult answer = *std::exchange(answer_, std::nullopt);
        if (answer.problem) std::rethrow_exception(answer.problem);
        return answer.result;
    }

 private:
    struct JobResult {
        std::optional<Result> result;
        std::exception_ptr problem;
    };

    static JobResult done(const Job& job, const std::stop_token& stop) {
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
            JobResult answer = done(job, stop);
            lock.lock();
            if (stop.stop_requested()) {
                lock.unlock();
                answer = {};  // releasing a long run takes time; do it without the lock
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
    Job job_;                          // not started yet
    std::stop_source current_;         // stops the newest job
    std::optional<JobResult> answer_;  // what the newest job gave, until it is taken
    bool busy_ = false;                // the newest job has no answer yet
    std::jthread thread_;              // the last member, since the thread uses all others
};

}  // namespace achilles
