#include "simulate/simulate.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <tuple>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "cli/write_files.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "pictures/origin.hpp"
#include "sensitivity/chain.hpp"
#include "sensitivity/error_estimate.hpp"
#include "sensitivity/quantities.hpp"

namespace achilles {

namespace {

struct SimulateArguments {
    std::string system, json, csv;
    std::vector<std::string> settings;
    OptionOverrides overrides;
    std::string times;
    std::optional<int> samples;
    std::vector<std::string> of;
    bool verbose = false, timing = false, plain_names = false, units = false, derivatives = false;
    int width = 0, height = 0;  // common options without effect here
    double scale = 1.0;
};

int samples_from(const std::string& text) {
    constexpr int least = 2, most = 1'000'000;
    const double count = number_from("--samples", text);
    if (!(count >= least && count <= most && count == std::floor(count)))
        throw InputError("--samples " + text, {}, fmt::format("a whole number from {} to {} is expected", least, most));
    return static_cast<int>(count);
}

// Rejects options that have no effect without a data file.
void check_files(const SimulateArguments& arguments) {
    const bool no_csv = arguments.csv.empty(), no_data = no_csv && arguments.json.empty();
    for (const auto& [flag, is_given, is_useless, needs] :
         {std::tuple{"--samples", arguments.samples.has_value(), no_data, "--csv F or --json F"},
          std::tuple{"--times", !arguments.times.empty(), no_data, "--csv F or --json F"},
          std::tuple{"--plain-names", arguments.plain_names, no_csv, "--csv F"},
          std::tuple{"--units", arguments.units, no_csv, "--csv F"},
          std::tuple{"--of", !arguments.of.empty(), !arguments.derivatives, "--derivatives"}})
        if (is_given && is_useless) throw InputError(flag, {}, fmt::format("this needs {}", needs));
    if (arguments.samples && !arguments.times.empty())
        throw InputError("--samples", {}, "the instants are already given by --times");
}

// Warns if a file extension contradicts the content, which is probably a mistake.
void warn_of_endings(const SimulateArguments& arguments) {
    for (const auto& [flag, path, other] :
         {std::tuple{"--json", &arguments.json, ".csv"}, std::tuple{"--csv", &arguments.csv, ".json"}})
        if (path->ends_with(other))
            print_clean(stderr, "achilles: warning: {} {}: the output is not {}, although the name says so\n", flag,
                        *path, other + 1);
}

Instants instants_of(const SimulateArguments& arguments, const Run& run) {
    const double start = run.options.start_time, end = run.options.end_time;
    if (arguments.samples) return equidistant(*arguments.samples, start, end);
    if (arguments.times.empty()) return {};
    const std::string text = read_text(arguments.times);
    if (text.size() > largest_file)
        throw InputError(arguments.times, {}, fmt::format("the file is larger than {} MB", largest_file >> 20));
    return read_instants(text, arguments.times, start, end);
}

int run(const SimulateArguments& arguments) {
    check_files(arguments);
    const SystemDescription description = parse_system(read_text(find_system(arguments.system)), arguments.system);
    const Run run = requested_run(description, arguments.settings, arguments.overrides);
    const auto model = std::make_shared<const Model>(description);
    validate_overrides(*model, run, arguments.settings);
    const Instants instants = instants_of(arguments, run);
    const Quantities quantities(model, arguments.of);
    if (arguments.derivatives) Chain::check(run);
    warn(description, run);
    warn_of_endings(arguments);
    // Checked before the work, so that a path that cannot be written does not lose results at the end.
    OutputFiles files;
    files.protect_input(find_system(arguments.system));
    if (!arguments.times.empty()) files.protect_input(arguments.times);
    if (!arguments.json.empty()) files.add(arguments.json);
    if (!arguments.csv.empty()) files.add(arguments.csv);

    const Trajectory trajectory = simulate(model, run);
    std::optional<Dependence> dependence;
    if (arguments.derivatives) {
        dependence.emplace(Dependence{differentiate(trajectory), {}});
        dependence->quantities = quantities.of(trajectory, dependence->derivatives);
    }
    const bool is_summed_up = arguments.json.empty() && arguments.csv.empty();
    // The estimate takes longer than the run, so it is left out if only CSV is written.
    std::optional<ErrorEstimate> estimate;
    if (is_summed_up || !arguments.json.empty()) estimate = estimate_error(trajectory);
    const ErrorEstimate* const known = estimate ? &*estimate : nullptr;
    if (!arguments.json.empty())
        files.put(arguments.json, to_json(trajectory, instants, dependence ? &*dependence : nullptr, known));
    if (!arguments.csv.empty())
        files.put(arguments.csv, to_csv(trajectory, {instants, arguments.plain_names, arguments.units}));
    if (is_summed_up) {
        files.add("-");
        const std::string text =
            arguments.verbose
                ? summary(trajectory, known)
                : answer(trajectory, *known, prove_line(arguments.system, arguments.settings, arguments.overrides));
        files.put("-", printable(text + (dependence ? summary(trajectory, *dependence) : "")));
    }
    files.commit();
    // Not written to the files, so that the same run gives the same bytes.
    if (arguments.verbose || arguments.timing)
        print_clean(stderr, "achilles: {:.3g} s, of these {:.3g} s for certificates\n", trajectory.statistics.seconds,
                    trajectory.statistics.certificate_seconds);
    return print_notes(trajectory, !is_summed_up, known);
}

}  // namespace

void add_simulate(CLI::App& program, int& status) {
    const auto arguments = std::make_shared<SimulateArguments>();
    CLI::App* command = program.add_subcommand("simulate", "Simulates one run: a summary, JSON or CSV");
    command->add_option("SYSTEM", arguments->system, "the path of a .toml file, or a name from 'achilles list'")
        ->required()
        ->type_name("");
    command
        ->add_option("--json", arguments->json,
                     "write the trajectory as JSON instead of the summary; - is standard output")
        ->type_name("F");
    command->add_option("--csv", arguments->csv, "write the trajectory as CSV: times in s, angles in rad")
        ->type_name("F");
    command
        ->add_option_function<std::string>(
            "--samples", [arguments](const std::string& text) { arguments->samples = samples_from(text); },
            "number of equidistant instants, both ends included, for the rows of --csv and `samples` of --json")
        ->type_name("N");
    command->add_option("--times", arguments->times, "file of instants instead of --samples, one per line, s")
        ->type_name("F");
    command->add_flag("--plain-names", arguments->plain_names,
                      "use column names in --csv that are valid in Python: theta1_rate for theta1'");
    command->add_flag("--units", arguments->units, "add a second line with the units of the columns to --csv");
    command->add_flag("--derivatives", arguments->derivatives,
                      "also compute derivatives of every event and of the final state with respect to the initial "
                      "values and the parameters");
    command
        ->add_option("--of", arguments->of,
                     "with --derivatives: expression to differentiate, as for --print of a sweep; repeatable")
        ->type_name("EXPRESSION")
        ->allow_extra_args(false);
    command->add_flag("--verbose", arguments->verbose,
                      "print everything: impacts, certificates, assumptions, statistics, wall time");
    command->add_flag("--timing", arguments->timing, "print the wall time on standard error");
    add_size_options(*command, arguments->width, arguments->height, arguments->scale, "for pictures");
    // Common options are accepted; those without effect are hidden from the help.
    for (const char* idle : {"--size", "--scale"}) command->get_option(idle)->group("");
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace achilles
