// Tests that figures show the whole motion, with many random runs of the gallery, and measures the cost of their
// curves.     bench_curves [N [SEED]]        N runs (1000), end times from 1 to 2000 s: the error of each figure in
// pixels (limit 0.7)     bench_curves draws SEED K...   only the runs of these draws, with the numbers of the report
// bench_curves cost              a phase plane and a gap over time of one system, for several end times
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string_view>

#include "bench/measure.hpp"
#include "paint/svg.hpp"
#include "render/drawn.hpp"

namespace achilles {
namespace {

struct Tally {
    int count = 0, bad = 0;
    double worst = 0.0, composing = 0.0;  // pixels; s
    void add(const drawn::RandomRun& run) {
        const double begin = bench::thread_seconds();
        const drawn::Picture picture(run.trajectory, run.view);
        composing += bench::thread_seconds() - begin;
        const double off = drawn::worst(run.trajectory, picture);
        worst = std::max(worst, off);
        ++count;
        if (off <= 0.7 && !drawn::is_empty(picture)) return;
        ++bad;
        fmt::print("{:6.2f} px, draw {}: {}{}\n", off, run.draw, run.about, drawn::is_empty(picture) ? " EMPTY" : "");
        std::fflush(stdout);
    }
    int report() const {
        fmt::print(
            "{} figures, {} of them off by more than 0.7 px or empty; the worst {:.2f} px; {:.2f} ms each to compose\n",
            count, bad, worst, 1e3 * composing / count);
        return bad == 0 ? 0 : 1;
    }
};

constexpr double longest = 2000.0;  // s

int figures(int count, unsigned seed) {
    drawn::RandomRuns runs(seed, longest);
    Tally tally;
    while (tally.count < count) tally.add(runs.next());
    return tally.report();
}

int figures_of(unsigned seed, std::span<char*> draws) {
    Tally tally;
    for (const char* draw : draws) tally.add(drawn::RandomRuns(seed, longest, std::strtoull(draw, nullptr, 10)).next());
    return tally.report();
}

void cost() {
    const auto model = test::load("ball_on_vibrating_table");
    ViewDescription gap, plane;
    gap.x.text = "t", gap.y.push_back({"gap", {}});
    plane.x.text = "sin(om*t)", plane.y.push_back({"y'", {}});
    for (const double end : {10.0, 100.0, 500.0, 2000.0}) {
        Run run = model->default_run();
        run.options.end_time = end;
        const double before = bench::thread_seconds();
        const Trajectory trajectory = simulate(model, run);
        const double simulated = bench::thread_seconds() - before;
        for (const ViewDescription* view : {&gap, &plane}) {
            const double begin = bench::thread_seconds();
            const drawn::Picture picture(trajectory, *view, {1200, 800});
            const double composed = bench::thread_seconds() - begin;
            std::size_t points = 0;
            for (const Curve& curve : picture.panel().curves) points += curve.points.size();
            SvgSize size;
            size.width = 1200, size.height = 800;
            const std::string file = svg(picture.figure, size, ACHILLES_BINARY_DIR "/assets/fonts", {});
            fmt::print(
                "end {:6g} s, {:<16} {:6} steps: the run {:7.1f} ms, the figure {:6.1f} ms, {:6} points, SVG {:5} kB\n",
                end, view->y[0].text + " over " + view->x.text, trajectory.pieces.size(), 1e3 * simulated,
                1e3 * composed, points, file.size() / 1000);
        }
    }
}

}  // namespace
}  // namespace achilles

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "cost") return achilles::cost(), 0;
    const auto seed = [&] { return argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1U; };
    if (argc > 3 && std::string_view(argv[1]) == "draws")
        return achilles::figures_of(seed(), std::span(argv, static_cast<std::size_t>(argc)).subspan(3));
    return achilles::figures(argc > 1 ? std::atoi(argv[1]) : 1000, seed());
}
