#include "pictures/process_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "surface/offscreen.hpp"
#include "system/description.hpp"

namespace achilles {

namespace {

// Protocol of the pipe from a worker: one `task_done` per task. After `task_failed`: the kind of error, then the file
// and the message, each terminated by a zero byte, until the end of the pipe.
constexpr char task_done = '.', task_failed = '!';
constexpr char of_input = 'i', of_memory = 'm';

using Counter = std::atomic<std::size_t>;
static_assert(Counter::is_always_lock_free);  // required, since processes share it

// The number of the next task, in memory shared by all processes.
class SharedCounter {
 public:
    SharedCounter()
        : memory_(::mmap(nullptr, sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
        if (memory_ == MAP_FAILED) throw std::bad_alloc();
        new (memory_) Counter(0);
    }
    ~SharedCounter() { ::munmap(memory_, sizeof(Counter)); }
    SharedCounter(const SharedCounter&) = delete;
    SharedCounter& operator=(const SharedCounter&) = delete;
    Counter& operator*() const { return *static_cast<Counter*>(memory_); }

 private:
    void* memory_;
};

// Writes to the pipe. Returns false if the reader has closed it.
bool say(int pipe, const char* text, std::size_t size) {
    while (size > 0) {
        const ssize_t count = ::write(pipe, text, size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        text += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

void say_problem(int pipe, char kind, const std::string& file, const std::string& message) {
    const std::string text = std::string{task_failed, kind} + file + '\0' + message + '\0';
    say(pipe, text.data(), text.size());
}

// Main function of a worker process.
void work(std::size_t count, Counter& next, int pipe, const std::function<std::function<void(std::size_t)>()>& begin) {
    try {
        std::function<void(std::size_t)> task;
        for (std::size_t i = next++; i < count; i = next++) {
            if (!task) task = begin();
            task(i);
            if (!say(pipe, &task_done, 1)) return;
        }
        return;
    } catch (const InputError& error) {
        const std::string message = error.what(), place = error.file + ": ";
        const bool has_place = !error.file.empty() && message.rfind(place, 0) == 0;
        say_problem(pipe, of_input, has_place ? error.file : "", has_place ? message.substr(place.size()) : message);
    } catch (const NotEnoughMemory& error) {
        say_problem(pipe, of_memory, "", error.what());
    } catch (const std::bad_alloc&) {
        say_problem(pipe, of_memory, "", "there is not enough memory for this");
    } catch (const std::exception& error) {
        say_problem(pipe, of_input, "", error.what());
    }
    next = count;
}

struct Process {
    pid_t id = 0;
    int pipe = -1;
    std::string message;  // text after task_failed
    bool failed = false;
};

Process fork_process(std::size_t count, Counter& next, const std::vector<Process>& others,
                     const std::function<std::function<void(std::size_t)>()>& begin) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::bad_alloc();
    std::fflush(nullptr);  // otherwise both processes would write the buffered output
    const pid_t id = ::fork();
    if (id == 0) {
        ::close(ends[0]);
        for (const Process& other : others) ::close(other.pipe);
        work(count, next, ends[1], begin);
        ::_exit(0);  // skip cleanup: open resources belong to the parent
    }
    ::close(ends[1]);
    if (id < 0) {
        ::close(ends[0]);
        throw std::bad_alloc();
    }
    return {id, ends[0], {}, false};
}

// Reads the output of a worker and counts finished tasks. Returns false at its end.
bool listen(Process& process, std::size_t& done) {
    char buffer[4096];
    const ssize_t count = ::read(process.pipe, buffer, sizeof buffer);
    if (count < 0) return errno == EINTR;
    for (ssize_t i = 0; i < count; ++i) {
        if (process.failed)
            process.message += buffer[i];
        else if (buffer[i] == task_failed)
            process.failed = true;
        else
            ++done;
    }
    return count > 0;
}

// Reads from all workers until they have ended.
std::size_t read_from_workers(std::vector<Process>& processes, const std::function<void(std::size_t)>& report) {
    std::size_t done = 0;
    std::vector<pollfd> pipes;
    for (const Process& process : processes) pipes.push_back({process.pipe, POLLIN, 0});
    for (std::size_t open_pipes = pipes.size(); open_pipes > 0;) {
        if (::poll(pipes.data(), pipes.size(), -1) < 0 && errno != EINTR) break;
        const std::size_t before = done;
        for (std::size_t i = 0; i < pipes.size(); ++i) {
            if (pipes[i].fd < 0 || pipes[i].revents == 0 || listen(processes[i], done)) continue;
            pipes[i].fd = -1;  // poll ignores it
            --open_pipes;
        }
        if (done > before) report(done);
    }
    return done;
}

// Closes the pipes and waits until all workers have ended. Returns a signal that killed one of them, or 0.
int wait_for(const std::vector<Process>& processes) {
    int signal = 0;
    for (const Process& process : processes) {
        ::close(process.pipe);
        int status = 0;
        while (::waitpid(process.id, &status, 0) < 0 && errno == EINTR) {
        }
        if (WIFSIGNALED(status)) signal = WTERMSIG(status);
    }
    return signal;
}

}  // namespace

CrewOutcome share_work(std::size_t count, int jobs, const std::function<std::function<void(std::size_t)>()>& begin,
                       const std::function<void(std::size_t)>& done) {
    const SharedCounter next;
    std::vector<Process> processes;
    try {
        for (int i = 0; i < jobs && static_cast<std::size_t>(i) < count; ++i)
            processes.push_back(fork_process(count, *next, processes, begin));
    } catch (const std::bad_alloc&) {
        // Fewer workers than requested only make it slower.
        if (processes.empty()) throw;
    }
    CrewOutcome outcome;
    outcome.done = read_from_workers(processes, done);
    outcome.signal = wait_for(processes);
    for (const Process& process : processes) {
        if (!process.failed) continue;
        const char kind = process.message.empty() ? of_input : process.message.front();
        const std::string text = process.message.empty() ? "" : process.message.substr(1);
        const std::size_t end = text.find('\0');
        const std::string file = text.substr(0, end);
        std::string message = end == std::string::npos ? "" : text.substr(end + 1);
        if (!message.empty() && message.back() == '\0') message.pop_back();
        if (kind == of_memory) throw NotEnoughMemory(message);
        throw InputError(file, {}, message);
    }
    return outcome;
}

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
