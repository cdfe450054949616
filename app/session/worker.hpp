// Workers for computations that take longer than a frame. Only the newest request counts.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

// Worker<Result> runs one job after the other:
//
//     start(job)       Starts a job. The job under way is asked to stop, and a result not taken yet is dropped.
//     take(patience)   The result of the newest job. Empty if it is not ready in time, or was already taken. Rethrows
//                      an exception of the job.
//     on_ready(f)      f is called each time a result has become ready.
//
// A job must poll its stop token: after a stop request its result or exception is discarded.
#if defined(__EMSCRIPTEN__)
#include "web/page_worker.hpp"
#else
#include "session/threaded_worker.hpp"
#endif

namespace achilles {

#if defined(__EMSCRIPTEN__)
template <class Result>
using Worker = PageWorker<Result>;
#else
template <class Result>
using Worker = ThreadedWorker<Result>;
#endif

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
    void on_ready(std::function<void()> ready) { worker_.on_ready(std::move(ready)); }

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
