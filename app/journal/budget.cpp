#include "journal/budget.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <string>

#include "analysis/sweep.hpp"
#include "journal/journal.hpp"
#include "run/trajectory.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// The message printed by the signal handler, which must not format text itself.
std::string time_message;

}  // namespace

void Budget::lift() {
    is_limited_ = false;
    full_runs_ = 0.0;
}

void Budget::allow(const Options& typed) {
    allowed_.memory = std::max(allowed_.memory, typed.memory);
    allowed_.max_steps = std::max(allowed_.max_steps, typed.max_steps);
}

void Budget::check(const Options& options) const {
    if (!is_limited_) return;
    if (options.memory > allowed_.memory)
        throw PermissionDenied(
            {}, {},
            fmt::format("a run would keep up to {:.4g} MB; a run of a journal or a picture may keep at most {:.4g} MB",
                        options.memory / 1e6, allowed_.memory / 1e6),
            how_to_allow_);
    if (options.max_steps > allowed_.max_steps)
        throw PermissionDenied(
            {}, {},
            fmt::format("a run would take up to {} steps; a run of a journal or a picture may take at most {}",
                        options.max_steps, allowed_.max_steps),
            how_to_allow_);
}

void Budget::check(const SweepSpec& sweep) const {
    if (!is_limited_) return;
    check(sweep.base.options);
    for (const SweepAxis& axis : sweep.axes)
        for (const double end : {axis.low, axis.high}) {
            Options options = sweep.base.options;
            for (const Option* option : options_of_axis(axis.name)) option->set(options, end);
            check(options);
        }
    if (sweep.count() > max_points)
        throw PermissionDenied(
            {}, {},
            fmt::format("the sweep has {} points; a sweep of a journal or a picture may have at most {}", sweep.count(),
                        max_points),
            how_to_allow_);
}

void Budget::check_rows(std::uint64_t rows) const {
    if (is_limited_ && rows > max_points)
        throw PermissionDenied({}, {},
                               fmt::format("the table of the sweep has more than {} rows; a sweep of a journal or a "
                                           "picture may have at most that many",
                                           max_points),
                               how_to_allow_);
}

void Budget::charge(const Trajectory& run) {
    if (!is_limited_) return;
    full_runs_ +=
        std::max(static_cast<double>(run.statistics.steps) / allowed_.max_steps, bytes_of(run) / allowed_.memory);
    if (full_runs_ > max_full_runs)
        throw PermissionDenied(
            {}, {},
            fmt::format("the runs of this journal or picture together take more than {} steps or {:.4g} MB",
                        max_full_runs * allowed_.max_steps, max_full_runs * allowed_.memory / 1e6),
            how_to_allow_);
}

void TimeLimit::arm(const std::string& how_to_allow, unsigned seconds) {
    if (is_armed_) return;
    is_armed_ = true;
    time_message = printable(fmt::format(
        "achilles: this journal or picture takes longer than {} s; nothing is written\n{}\n", seconds, how_to_allow));
    struct sigaction action {};
    action.sa_handler = [](int) {
        [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, time_message.data(), time_message.size());
        ::_exit(2);
    };
    ::sigaction(SIGALRM, &action, nullptr);
    ::alarm(seconds);
}

void TimeLimit::disarm() {
    if (is_armed_) ::alarm(0);
    is_armed_ = false;
}

}  // namespace achilles
