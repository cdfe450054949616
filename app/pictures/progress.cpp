#include "pictures/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace achilles {

std::string progress_line(std::size_t done, std::size_t count, double seconds, const std::string& things) {
    constexpr std::size_t width = 30;
    const std::size_t filled = count == 0 ? width : width * done / count;
    const std::size_t percent = count == 0 ? 100 : 100 * done / count;
    std::string line = fmt::format("[{}{}] {:3}%  {}/{} {}", std::string(filled, '#'), std::string(width - filled, '.'),
                                   percent, done, count, things);
    if (done == 0 || !(seconds > 0.0)) return line;
    const double rate = static_cast<double>(done) / seconds;
    const auto left = static_cast<long>(std::ceil(static_cast<double>(count - done) / rate));
    return line + fmt::format("  {:.1f}/s  {}:{:02} left", rate, left / 60, left % 60);
}

Progress::Progress(std::size_t count, std::string things, bool lines)
    : count_(count),
      things_(std::move(things)),
      on_terminal_(::isatty(STDERR_FILENO) == 1),
      lines_(lines && !on_terminal_),
      begin_(std::chrono::steady_clock::now()) {
    show(0);
}

Progress::~Progress() { end(); }

void Progress::end() {
    if (on_terminal_) std::fputs("\r\x1b[K", stderr);
    on_terminal_ = false;
}

void Progress::show(std::size_t done) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    if (!on_terminal_ && !lines_) {
        if (seconds < next_line_) return;
        next_line_ = 2.0 * seconds;
    }
    const std::string line = progress_line(done, count_, seconds, things_);
    fmt::print(stderr, fmt::runtime(on_terminal_ ? "\r\x1b[K{}" : "{}\n"), line);
    std::fflush(stderr);
}

}  // namespace achilles
