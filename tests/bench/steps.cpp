// What a step of the pointer costs a program in a window, as seen from outside: its processor time and the wall time
// until a part of the screen changes, and its processor time until it sleeps again.
//     bench_steps PROCESS WINDOW SCREEN X Y DX LEFT TOP WIDTH HEIGHT
// SCREEN: the file in which Xvfb keeps its pixels (-fbdir). The pointer goes from (X, Y) to the right, DX pixels at a
// time. Prints the medians of ten steps: "shown CPU WALL last WALL all CPU pictures N", ms. `last` is the last change
// of that part, N the number of its changes.
#include <X11/Xlib.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/measure.hpp"

namespace {

constexpr int bytes_per_pixel = 4, steps = 10;

double wall() {
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Processor time of all threads of another process, ms.
double spent(pid_t process) {
    clockid_t clock = 0;
    timespec time{};
    if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0)
        throw std::runtime_error("the process has ended");
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

bool is_asleep(pid_t process) {
    for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
        std::ifstream file(task.path() / "stat");
        const std::string text((std::istreambuf_iterator<char>(file)), {});
        const std::size_t name = text.rfind(") ");
        if (name != std::string::npos && text.compare(name + 2, 1, "S") != 0) return false;
    }
    return true;
}

// A rectangle of the screen, read from the file of Xvfb: a header and then rows of pixels.
class Part {
 public:
    Part(const char* file, int screen_width, int screen_height, int left, int top, int width, int height)
        : offset_(static_cast<std::size_t>(top * screen_width + left) * bytes_per_pixel),
          stride_(static_cast<std::size_t>(screen_width) * bytes_per_pixel),
          row_(static_cast<std::size_t>(width) * bytes_per_pixel),
          rows_(static_cast<std::size_t>(height)),
          before_(row_ * rows_) {
        const int opened = open(file, O_RDONLY);
        struct stat status {};
        if (opened < 0 || fstat(opened, &status) != 0) throw std::runtime_error(std::string("cannot read ") + file);
        const auto size = static_cast<std::size_t>(status.st_size);
        offset_ += size - stride_ * static_cast<std::size_t>(screen_height);
        void* const map = mmap(nullptr, size, PROT_READ, MAP_SHARED, opened, 0);
        if (map == MAP_FAILED) throw std::runtime_error(std::string("cannot map ") + file);
        pixels_ = static_cast<const char*>(map);
        take_change();
    }
    // Whether it has changed since the last call.
    bool take_change() {
        bool has_changed = false;
        for (std::size_t i = 0; i < rows_; ++i) {
            const char* const now = pixels_ + offset_ + i * stride_;
            char* const before = before_.data() + i * row_;
            if (std::memcmp(now, before, row_) == 0) continue;
            std::memcpy(before, now, row_);
            has_changed = true;
        }
        return has_changed;
    }

 private:
    std::size_t offset_, stride_, row_, rows_;
    std::vector<char> before_;
    const char* pixels_ = nullptr;
};

struct Cost {
    double shown = 0.0, shown_wall = 0.0, last_wall = 0.0, all = 0.0, pictures = 0.0;
};

// Nothing shown after ten seconds: nothing will be.
std::optional<Cost> follow(pid_t process, Part& part, double begin, double begin_wall) {
    constexpr double rest = 60.0, longest = 10000.0;
    Cost cost;
    for (double asleep_since = 0.0;;) {
        const double now = wall();
        if (part.take_change()) {
            if (cost.shown_wall == 0.0) cost.shown = spent(process) - begin, cost.shown_wall = now - begin_wall;
            cost.last_wall = now - begin_wall;
            cost.pictures += 1.0;
        }
        if (!is_asleep(process))
            asleep_since = 0.0;
        else if (asleep_since == 0.0)
            asleep_since = now;
        else if (now - asleep_since > rest && cost.shown_wall > 0.0)
            break;
        if (now - begin_wall > longest) return {};
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    cost.all = spent(process) - begin;
    return cost;
}

void measure(char** words) {
    const auto number = [&](int i) { return std::atoi(words[i]); };
    const pid_t process = number(1);
    setpriority(PRIO_PROCESS, 0, -10);  // if it may: who watches should not wait for the processor
    const Window window = std::strtoul(words[2], nullptr, 0);
    Display* const display = XOpenDisplay(nullptr);
    if (display == nullptr) throw std::runtime_error("there is no display");
    const int screen = DefaultScreen(display);
    Part part(words[3], DisplayWidth(display, screen), DisplayHeight(display, screen), number(7), number(8), number(9),
              number(10));
    std::vector<double> shown, shown_wall, last, all, pictures;
    for (int i = 1; i <= steps; ++i) {
        const double begin = spent(process), begin_wall = wall();
        XWarpPointer(display, None, window, 0, 0, 0, 0, number(4) + number(6) * i, number(5));
        XFlush(display);
        const auto cost = follow(process, part, begin, begin_wall);
        if (!cost) throw std::runtime_error("nothing changes on the screen");
        shown.push_back(cost->shown), shown_wall.push_back(cost->shown_wall);
        last.push_back(cost->last_wall), all.push_back(cost->all);
        pictures.push_back(cost->pictures);
    }
    using achilles::bench::median;
    std::printf("shown %.0f %.0f last %.0f all %.0f pictures %.0f\n", median(shown), median(shown_wall), median(last),
                median(all), median(pictures));
    XCloseDisplay(display);
}

}  // namespace

int main(int count, char** words) try {
    if (count != 11) throw std::runtime_error("usage: bench_steps PROCESS WINDOW SCREEN X Y DX LEFT TOP WIDTH HEIGHT");
    measure(words);
    return 0;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "bench_steps: %s\n", problem.what());
    return 2;
}
