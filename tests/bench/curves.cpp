// Whether figures show the whole motion, of very many random runs of the gallery, and what their curves cost.
//     bench_curves [N [SEED]]   N runs (1000) with ends from 1 to 2000 s: how far each figure is off, in pixels (bar 0.7)
//     bench_curves cost         a phase plane and a gap over time of one system, by the end of the run
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <string_view>

#include "bench/measure.hpp"
#include "paint/svg.hpp"
#include "render/drawn.hpp"

namespace achilles {
namespace {

int figures(int count, unsigned seed) {
    drawn::RandomRuns runs(seed, 2000.0);
    int bad = 0;
    double most = 0.0, drawing = 0.0;
    for (int i = 0; i < count; ++i) {
        const drawn::RandomRun run = runs.next();
        const double begin = bench::thread_seconds();
        const drawn::Picture picture(run.trajectory, run.view);
        drawing += bench::thread_seconds() - begin;
        const double off = drawn::worst(run.trajectory, picture);
        most = std::max(most, off);
        if (off <= 0.7 && !drawn::is_empty(picture)) continue;
        ++bad;
        fmt::print("{:6.2f} px {}{}\n", off, run.about, drawn::is_empty(picture) ? " EMPTY" : "");
    }
    fmt::print(
        "{} figures, {} of them off by more than 0.7 px or empty; the worst {:.2f} px; {:.2f} ms each to compose\n",
        count, bad, most, 1e3 * drawing / count);
    return bad == 0 ? 0 : 1;
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
    return achilles::figures(argc > 1 ? std::atoi(argv[1]) : 1000,
                             argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1U);
}
