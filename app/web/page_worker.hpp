// Worker (session/worker.hpp) on a page, which has one thread: take() does the job.
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include "web/page_work.hpp"

namespace achilles {

template <class Result>
class PageWorker {
 public:
    using Job = std::function<Result(std::stop_token)>;

    PageWorker() = default;
    PageWorker(const PageWorker&) = delete;
    PageWorker& operator=(const PageWorker&) = delete;

    // Never called: a result is ready only when it is taken.
    void on_ready(const std::function<void()>&) {}

    void start(Job job) {
        job_ = std::move(job);
        waiting_.emplace();
    }

    // A job for which nothing waits (patience 0) is left to a later frame if this one has no time.
    std::optional<Result> take(std::optional<double> patience) {
        if (!job_ || (patience && *patience == 0.0 && !frame_has_time())) return std::nullopt;
        const Job job = std::exchange(job_, nullptr);
        waiting_.reset();
        std::optional<Result> result;
        do_page_work([&] { result = job(std::stop_token()); });
        return result;
    }

 private:
    Job job_;  // not done yet
    std::optional<WaitingWork> waiting_;
};

}  // namespace achilles
