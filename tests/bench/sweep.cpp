// bench_sweep: the cost of a sweep relative to its runs, and the agreement of its map with single runs.
//
// The map shows the valley of the ball on the sine at t = 20 for 512 x 512 starts. The rate of simulate_ends() alone
// and the rate with files written are measured in turn. Then single runs at random points of the map are compared with
// its rows.
//
// usage: bench_sweep [points along an axis, 512] [rounds, 5] [single runs, 2000] [threads, 1]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "analysis/chunks.hpp"
#include "bench/measure.hpp"
#include "model/read_system.hpp"
#include "output/sweep_files.hpp"

namespace achilles::bench {
namespace {

constexpr const char* prints = " --print x --print \"x'\" --print impacts --print zeno_points --print releases";

// Processor time if one thread works, else wall time, s.
template <class Work>
double seconds_of(int threads, const Work& work) {
    if (threads == 1) return seconds(work);
    const auto clock = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
}

// Writes files as the command does: rows and their text in chunks into a log, and from there into the file.
void write_files(const SweepTable& table, int threads, const std::string& path) {
    std::remove((path + ".part").c_str());
    SweepLog log(path + ".part", {}, false, ~std::uint64_t{0});
    const std::atomic<bool> stop{false};
    const auto task = [&](Chunk chunk) { return sweep_csv(table, table.rows(chunk.first, chunk.count)); };
    do_chunks(
        0, table.sweep().count(), threads, task,
        [&](Chunk chunk, const std::string& bytes) { log.append(chunk, bytes); }, stop);
    std::FILE* const file = std::fopen(path.c_str(), "w");
    if (file == nullptr) std::abort();
    const std::string heading = sweep_csv_heading(table, false);
    std::fwrite(heading.data(), 1, heading.size(), file);
    log.each([&](Chunk, std::string_view bytes) { std::fwrite(bytes.data(), 1, bytes.size(), file); });
    std::fclose(file);
    log.remove();
}

void compare(const std::shared_ptr<const Model>& model, const SweepTable& table, int count) {
    std::mt19937_64 random(5);
    const SweepPoints points(table.sweep(), model->description());
    int other_sequences = 0, other_values = 0;
    double largest = 0.0;
    for (int i = 0; i < count; ++i) {
        const std::uint64_t point = random() % table.sweep().count();
        const Rows row = table.rows(point, 1);
        const Trajectory alone = simulate(model, points.run(point));
        std::vector<EventRecord> of_lanes;
        simulate_ends(
            model, 1, [&](std::size_t) { return points.run(point); },
            [&](std::size_t, RunResult&& attempt) { of_lanes = sequence_of(std::get<Trajectory>(attempt)); }, 1);
        const std::vector<EventRecord> sequence = sequence_of(alone);
        const auto same = [](const EventRecord& a, const EventRecord& b) {
            return a.kind == b.kind && a.contacts == b.contacts;
        };
        if (!std::equal(sequence.begin(), sequence.end(), of_lanes.begin(), of_lanes.end(), same)) ++other_sequences;
        const double error =
            std::max(std::abs(row.numbers[0] - alone.end.q[0]), std::abs(row.numbers[1] - alone.end.v[0]));
        largest = std::max(largest, error);
        if (!(error <= 1e-8)) ++other_values;
    }
    fmt::print("  {} single runs: {} with another sequence of events, {} off by more than 1e-8; the largest {:.1e}\n",
               count, other_sequences, other_values, largest);
}

}  // namespace
}  // namespace achilles::bench

int main(int argc, char** argv) {
    using namespace achilles;
    using namespace achilles::bench;
    const auto argument = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
    const int along = argument(1, 512), rounds = argument(2, 5), singles = argument(3, 2000), threads = argument(4, 1);
    const auto model =
        std::make_shared<const Model>(read_system(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml"));
    for (const char* tolerance : {"", " --tolerance 1e-12"}) {
        const std::string text =
            fmt::format("--over x=-3:3:{0} --over \"x'=-2:2:{0}\"{1}{2}", along, prints, tolerance);
        const SweepTable table(model, read_sweep(text, model->description()));
        const SweepPoints points(table.sweep(), model->description());
        const std::size_t count = table.sweep().count();
        std::vector<double> alone, written;
        const std::string path = std::filesystem::temp_directory_path() / "bench_sweep.csv";
        for (int round = 0; round < rounds; ++round) {
            alone.push_back(seconds_of(threads, [&] {
                simulate_ends(
                    model, count, [&](std::size_t i) { return points.run(i); }, [](std::size_t, RunResult&&) {},
                    threads);
            }));
            written.push_back(seconds_of(threads, [&] { write_files(table, threads, path); }));
        }
        const auto runs = static_cast<double>(count);
        std::vector<double> ratios;
        for (std::size_t i = 0; i < alone.size(); ++i) ratios.push_back(alone[i] / written[i]);
        fmt::print(
            "{} x {} balls, {} prints, {} thread(s){}\n  ends alone {:.0f} runs/s, with files {:.0f} runs/s: {:.3f}\n",
            along, along, table.measures().numbers(), threads, tolerance, runs / median(alone), runs / median(written),
            median(ratios));
        std::filesystem::remove(path);
        compare(model, table, singles);
    }
}
