// The command sweep: many runs as a table, and pictures of it.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <csignal>
#include <new>
#include <optional>
#include <system_error>

#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/sweep_output.hpp"
#include "cli/sweep_work.hpp"
#include "cli/terminal.hpp"
#include "output/output.hpp"
#include "pictures/picture_job.hpp"
#include "pictures/process_pool.hpp"

namespace achilles {

namespace {

struct SweepArguments {
    std::string system;
    SweepOptions typed;
    SweepOutputOptions output;
    SweepPictureOptions pictures;
    std::vector<std::string> settings;
    OptionOverrides overrides;
    int threads = 0;
};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// The first SIGINT or SIGTERM lets running chunks finish; a second one terminates at once.
void stop_on_signal() {
    struct sigaction action {};
    action.sa_handler = [](int) { stop_requested = true; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
}

int threads_from(const std::string& text) {
    constexpr int most = 1024;
    const double count = number_from("--threads", text);
    if (!(count >= 1 && count <= most && count == std::floor(count)))
        throw InputError("--threads " + text, {}, fmt::format("a whole number from 1 to {} is expected", most));
    return static_cast<int>(count);
}

// Prints warnings that concern all runs, once: for the base run, and for ends of axes outside the ranges of the file.
void warn_of(const SystemDescription& description, const SweepSpec& sweep) {
    warn(description, sweep.base);
    for (const SweepAxis& axis : sweep.axes) {
        Run file = default_run(description);
        for (const double end : {axis.low, axis.high}) {
            double* const place = find_value(description, file, axis.name);
            if (place == nullptr) continue;
            *place = end;
            for (const std::string& outside : outside_ranges(description, file))
                if (outside.starts_with(axis.name + " =")) print_clean(stderr, "achilles: warning: {}\n", outside);
        }
    }
}

// Prints the summary and the list of files to standard error if files hold the table or it is a terminal. Quantities
// that are undefined in every run are reported in any case.
void print_summary(const SweepSummary& summary, const SweepOutput& output) {
    const std::vector<std::string>& files = output.files();
    if (files.empty() && ::isatty(STDERR_FILENO) == 0) {
        for (const std::string& sentence : summary.undefined_everywhere())
            print_clean(stderr, "achilles: warning: {}\n", sentence);
        return;
    }
    print_clean(stderr, "{}", summary.text());
    for (const std::string& file : files) print_clean(stderr, "wrote {}\n", file);
}

// `ranks`: the other processes that share the sweep; may be null.
int run(const SweepArguments& arguments, PictureJob& job, Messages* ranks) {
    const SystemDescription description = job.inputs().system(arguments.system);
    const Run base = requested_run(description, arguments.settings, arguments.overrides);
    SweepOptions typed = arguments.typed;
    if (!job.reproduces()) typed.fixed = fixed_names(arguments.settings, arguments.overrides);
    const SweepSpec sweep = make_sweep(typed, base, description);
    job.check(sweep);
    const SweepTable table(std::make_shared<const Model>(description), sweep);
    if (job.reproduces()) {
        reproduce_sweep(table, arguments.pictures, job, arguments.threads);
        return reached_end;
    }
    warn_of(description, sweep);
    const SweepPictures pictures(table, arguments.pictures, job);
    SweepOutput output(table, arguments.output, pictures, job.inputs().files_read().front(), arguments.system);
    stop_on_signal();
    const std::uint64_t points = sweep.count();
    Progress progress(points - output.done(), "runs");
    const std::uint64_t before = output.done();
    RunFailures failures;
    SweepSummary summary(table);
    const auto task = [&](Chunk chunk) { return sweep_chunk(table, output.storage(), chunk); };
    const auto write = [&](Chunk chunk, const std::string& bytes) {
        output.append(chunk, failures.take(summary.take(bytes)));
        progress.show(chunk.first + chunk.count - before);
    };
    const auto do_all = [&] {
        if (ranks == nullptr) return do_chunks(before, points, arguments.threads, task, write, stop_requested);
        const std::string order = sweep_order(table, output.storage(), arguments.threads);
        return do_chunks(*ranks, order, before, points, arguments.threads, task, write, stop_requested);
    };
    try {
        if (do_all()) {
            const bool is_drawn = output.finish();
            progress.end();
            print_summary(summary, output);
            failures.tell(table);
            return is_drawn ? reached_end : stopped_early;
        }
    } catch (const std::system_error& problem) {
        progress.end();
        print_clean(stderr, "achilles: the file cannot be written: {}\n", problem.what());
    } catch (const std::runtime_error& problem) {
        progress.end();
        print_clean(stderr, "achilles: {}\n", problem.what());
    } catch (const std::bad_alloc&) {
        progress.end();
        print_clean(stderr, "achilles: there is not enough memory for this\n");
    }
    if (ranks != nullptr && stop_requested) ranks->leave();
    progress.end();
    const std::string how = output.how_to_continue();
    if (output.done() == points)
        print_clean(stderr, "achilles: all {} runs are done, but not all files are written{}\n", points, how);
    else
        print_clean(stderr, "achilles: the sweep stopped early, at {} of {} runs{}\n", output.done(), points, how);
    return stopped_early;
}

void add_texts(CLI::App& command, const char* flag, std::vector<std::string>& texts, const char* type,
               const char* about) {
    command.add_option(flag, texts, about)
        ->type_name(type)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

void add_sweep(CLI::App& program, int& status, PictureJob& job, Messages* ranks) {
    const auto arguments = std::make_shared<SweepArguments>();
    CLI::App* command = program.add_subcommand(
        "sweep", "Simulates many runs over parameters, initial values and options: a table, a curve, a map");
    add_system_argument(*command, arguments->system);
    SweepOptions& typed = arguments->typed;
    add_texts(
        *command, "--over", typed.over, "NAME=LOW:HIGH:COUNT",
        "axis of the sweep: a parameter, a start x, a rate x' or a numeric option such as end, with COUNT values from "
        "LOW to HIGH; log:LOW:HIGH:COUNT is logarithmic; repeatable, the first varies slowest");
    add_texts(
        *command, "--print", typed.prints, "WHAT",
        "quantity to tabulate: an expression at the end of the run, zeno_time(k), impact_time(k), impact_speed(k), "
        "release_time(k), zeno_points, impacts, releases, least_gap; with friction also heat, stick_time(k), "
        "slip_time(k), reversal_time(k), sticks, slips, reversals; with several contacts collapse_time(k), collapses; "
        "derivatives such as d(zeno_time(1), e); held, "
        "outcome, with friction modes; repeatable");
    const auto text_option = [&](const char* flag, std::optional<std::string>& place, const char* type,
                                 const char* about) {
        command
            ->add_option_function<std::string>(
                flag, [&place](const std::string& text) { place = text; }, about)
            ->type_name(type);
    };
    text_option(
        "--at", typed.at, "impact|zeno|release|EXPRESSION",
        "tabulate at every event of this kind (with friction also stick, slip or reversal), or where the expression "
        "crosses zero upward, instead of at the end");
    text_option("--after", typed.after, "T", "with --at: tabulate from this time on, s (default: the start)");
    text_option("--random", typed.random, "N",
                "number of random points instead of a grid; --over then takes NAME=LOW:HIGH");
    text_option("--seed", typed.seed, "S", "seed of the random points (default 1)");
    SweepOutputOptions& output = arguments->output;
    command->add_option("--csv", output.csv, "file for the table (default: standard output)")->type_name("F");
    command->add_option("--hdf5", output.hdf5, "HDF5 file for the table: /axes/NAME, /values/WHAT")->type_name("F");
    add_texts(*command, "--out", arguments->pictures.files, "F.png|F.svg|F.pdf",
              "picture: curves over one axis, a map over two, a diagram with --at; repeatable");
    command->add_flag("--units", output.units, "add a second line with the units of the columns to --csv");
    command->add_flag("--resume", output.resume, "continue an interrupted sweep");
    command
        ->add_option_function<std::string>(
            "--threads", [arguments](const std::string& text) { arguments->threads = threads_from(text); },
            "worker threads per process (default: one per core); does not change the output")
        ->type_name("N");
    SweepPictureOptions& pictures = arguments->pictures;
    command->add_flag("--transparent", pictures.look.transparent, "with --out: leave out the background");
    command->add_flag("--dark", pictures.look.dark, "with --out: draw light on dark, for a screen");
    add_page_options(*command, pictures.page);
    add_size_options(*command, pictures.size.width, pictures.size.height, pictures.size.scale);
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, command, &status, &job, ranks] {
        arguments->pictures.has_size = command->count("--size") > 0;
        status = run(*arguments, job, ranks);
    });
}

}  // namespace achilles
