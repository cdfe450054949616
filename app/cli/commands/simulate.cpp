#include "simulate/simulate.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/write_files.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"

namespace achilles {

namespace {

struct SimulateArguments {
    std::string system, json, csv;
    std::vector<std::string> settings;
    OptionOverrides overrides;
    bool verbose = false;
    int width = 0, height = 0;  // common options that mean nothing here
    double scale = 1.0;
};

int run(const SimulateArguments& arguments) {
    const SystemDescription description = read_system(find_system(arguments.system));
    const Run run = asked_run(description, arguments.settings, arguments.overrides);
    const auto model = std::make_shared<const Model>(description);
    model->check(run);
    warn(description, run);
    // Tried before the work: a path that cannot be written is bad input, not a loss at the end.
    OutputFiles files;
    if (!arguments.json.empty()) files.add(arguments.json);
    if (!arguments.csv.empty()) files.add(arguments.csv);

    const Trajectory trajectory = simulate(model, run);
    if (!arguments.json.empty()) files.put(arguments.json, to_json(trajectory));
    if (!arguments.csv.empty()) files.put(arguments.csv, to_csv(trajectory));
    if (arguments.json.empty() && arguments.csv.empty()) {
        files.add("-");
        files.put("-", summary(trajectory));
    }
    files.commit();
    // Not in the files: the same run gives the same bytes.
    if (arguments.verbose)
        fmt::print(stderr, "achilles: {:.3g} s, of these {:.3g} s for certificates\n", trajectory.statistics.seconds,
                   trajectory.statistics.certificate_seconds);
    if (trajectory.outcome.kind == Outcome::Kind::end_time) return reached_end;
    fmt::print(stderr, "achilles: the run stopped early: {}\n", trajectory.outcome.message);
    return stopped_early;
}

}  // namespace

void add_simulate(CLI::App& program, int& status) {
    const auto arguments = std::make_shared<SimulateArguments>();
    CLI::App* command = program.add_subcommand("simulate", "One completed execution, as a summary, JSON or CSV");
    command->add_option("SYSTEM", arguments->system, "a path to a .toml file, or a name from 'achilles list'")
        ->required()
        ->type_name("");
    command->add_option("--json", arguments->json, "where to write the trajectory as JSON; - is standard output")
        ->type_name("F");
    command->add_option("--csv", arguments->csv, "where to write it as CSV")->type_name("F");
    command->add_flag("--verbose", arguments->verbose, "tell on standard error how long it took");
    add_size_options(*command, arguments->width, arguments->height, arguments->scale, "for pictures; no effect here");
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace achilles
