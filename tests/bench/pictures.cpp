// Times of pictures: from the start of the program to the first PNG, animations with encoding, and the compression of a
// PNG with the resulting sizes. To be run by hand on an idle machine.
//
//     ninja -C build/release bench_pictures && build/release/bench_pictures
//
// Measured on two cores (AMD EPYC, 2.6 GHz) of a machine with a load of 9, GCC 12, Mesa 22.3.6:
//
//     from the start of the program to a PNG on the disk, median of 11:                          (limit: 0.4 s)
//       figure, one view, 1200x800       0.283 s (fastest 0.225, processor 0.190)
//       figure, all views, 1200x800      0.306 s (fastest 0.244, processor 0.195)
//       the same as SVG                  0.019 s (fastest 0.012, processor 0.013)
//       screenshot, 1600x1000            0.276 s (fastest 0.248, processor 0.193)
//     animations of 1600x1000, start of the program included:                 (goal: 10 frames/s for two cores)
//                           jobs   frames/s   for two processors   processor, ms   kB a frame
//       ball_on_sine           2        9.2                 19.9             101          110
//       double_pendulum        2        8.5                 18.0             111          113
//     compression of a frame by stb, whose lowest level is 5; figures and the explorer are similar:
//       level                      5              8             12
//       no filter         38 ms 108 kB   53 ms 108 kB   75 ms 107 kB
//       left              39 ms 124 kB   55 ms 124 kB   77 ms 123 kB
//       up                43 ms 118 kB   71 ms 118 kB  104 ms 118 kB
//       average           41 ms 137 kB   56 ms 137 kB   80 ms 137 kB
//       Paeth             51 ms 121 kB   65 ms 121 kB   92 ms 121 kB
//       least sum         57 ms 118 kB   77 ms 118 kB   90 ms 118 kB
//
// Uniform color compresses best without a filter, at level 5. Frames per second for two processors are computed from
// processor time, which other load on the machine changes little. Encoding is a third of it, the rest is Mesa.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.hpp"
#include "image/image.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Processor time of all ended child processes, s.
double spent() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void run(const std::string& arguments) {
    const std::string command = "'" ACHILLES_BINARY_DIR "/achilles' " + arguments + " >/dev/null";
    if (std::system(command.c_str()) != 0) {
        fmt::print(stderr, "failed: {}\n", command);
        std::exit(1);
    }
}

// Prints the median time of several runs and the processor time of one.
void first_picture(const std::string& what, const std::string& arguments) {
    constexpr int runs = 11;
    std::vector<double> seconds;
    const double before = spent();
    for (int i = 0; i < runs; ++i) {
        const double begin = now();
        run(arguments);
        seconds.push_back(now() - begin);
    }
    std::sort(seconds.begin(), seconds.end());
    fmt::print("  {:<46} {:6.3f} s (fastest {:.3f}, processor {:.3f})\n", what, seconds[runs / 2], seconds.front(),
               (spent() - before) / runs);
}

void animation(const std::string& system, int jobs, const fs::path& folder) {
    const fs::path film = folder / fmt::format("{}_{}", system, jobs);
    const double before = spent(), begin = now();
    run(fmt::format("frames {} --end 10 --fps 12 --jobs {} --out '{}'", system, jobs, film.string()));
    const double wall = now() - begin, processor = spent() - before;
    constexpr int frames = 121;
    std::uintmax_t bytes = 0;
    for (const auto& file : fs::directory_iterator(film)) bytes += file.file_size();
    fmt::print("  {:<24} {:>2} {:>12.1f} {:>14.1f} {:>14.1f} {:>12.0f}\n", system, jobs, frames / wall,
               2.0 * frames / processor, 1e3 * processor / frames, static_cast<double>(bytes) / frames / 1e3);
}

void compression(const std::string& what, const Image& image) {
    fmt::print("\n  {} ({} x {})\n    level          ", what, image.width, image.height);
    const int levels[] = {5, 8, 12};
    for (const int level : levels) fmt::print("{:>16}", level);
    fmt::print("\n");
    const char* filters[] = {"none", "left", "up", "average", "Paeth", "least sum"};
    for (int filter = 0; filter <= 5; ++filter) {
        fmt::print("    {:<14} ", filters[filter]);
        for (const int level : levels) {
            double least = 1e9;
            std::size_t size = 0;
            for (int i = 0; i < 3; ++i) {
                const auto compress = [&] { size = png_bytes(image, {level, filter == 5 ? -1 : filter}).size(); };
                least = std::min(least, bench::seconds(compress));
            }
            fmt::print("{:>7.0f} ms{:>4} kB", 1e3 * least, size / 1000);
        }
        fmt::print("\n");
    }
}

void measure() {
    const fs::path folder = fs::temp_directory_path() / fmt::format("bench_pictures{}", ::getpid());
    fs::create_directories(folder);
    const std::string out = (folder / "a.png").string();
    fmt::print("from the start of the program to a PNG on the disk, median of 11:\n");
    first_picture("figure, one view, 1200x800", "figure ball_on_sine --view height --out '" + out + "'");
    first_picture("figure, all views, 1200x800", "figure ball_on_sine --out '" + out + "'");
    first_picture("the same as SVG", "figure ball_on_sine --out '" + out + ".svg'");
    first_picture("screenshot, 1600x1000", "screenshot ball_on_sine --out '" + out + "'");
    fmt::print("\nanimations of 1600x1000:\n  {:<24} {:>2} {:>12} {:>14} {:>14} {:>12}\n", "", "jobs", "frames/s",
               "per core pair", "processor, ms", "kB a frame");
    for (const char* system : {"ball_on_sine", "double_pendulum"})
        for (const int jobs : {1, 2}) animation(system, jobs, folder);
    fmt::print("\ncompression, by filter:\n");
    run("figure ball_on_sine --size 1600x1000 --out '" + out + "'");
    compression("figure", read_png(out));
    run("screenshot ball_on_sine --out '" + out + "'");
    compression("explorer", read_png(out));
    compression("frame", read_png(folder / "double_pendulum_2/frame_00060.png"));
    fs::remove_all(folder);
}

}  // namespace
}  // namespace achilles

int main() { achilles::measure(); }
