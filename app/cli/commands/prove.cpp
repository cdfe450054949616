#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "cli/write_files.hpp"
#include "enclose/initial_uncertainty.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "output/proof.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

struct ProveArguments {
    std::string system, json;
    std::vector<std::string> settings;
    OptionOverrides overrides;
    double width = 0.0;
    int parts = 1;
    std::string times;
    std::optional<int> samples;
    bool verbose = false, timing = false;
};

// The boxes of initial states and parameters. `points` receives the settings with the midpoint of each interval.
EnclosureProblem problem_of(const ProveArguments& arguments, const SystemDescription& description,
                            std::vector<std::string>& points) {
    const InitialUncertainty spread = parse_uncertainty(arguments.settings, arguments.width, description, points);
    EnclosureProblem claim = problem_of(description, requested_run(description, points, arguments.overrides), spread);
    if (const auto* given = arguments.overrides.find(option("eps_t"))) claim.eps_t = std::get<double>(given->second);
    return claim;
}

// Times strictly inside the run; its end is always printed.
std::vector<double> times_of(const ProveArguments& arguments, const Run& run) {
    const double start = run.options.start_time, end = run.options.end_time;
    if (arguments.samples && !arguments.times.empty())
        throw InputError("--samples", {}, "the instants are already given by --times");
    if (arguments.samples) return equidistant(*arguments.samples, start, end);
    if (arguments.times.empty()) return {};
    return read_instants(read_text(arguments.times), arguments.times, start, end);
}

int run(const ProveArguments& arguments) {
    const SystemDescription description = parse_system(read_text(find_system(arguments.system)), arguments.system);
    std::vector<std::string> points;
    EnclosureProblem claim = problem_of(arguments, description, points);
    const auto model = std::make_shared<const Model>(description);
    validate_overrides(*model, claim.run, points);
    check(*model, claim);
    claim.times = times_of(arguments, claim.run);
    warn(description, claim.run);
    OutputFiles files;
    files.protect_input(find_system(arguments.system));
    if (!arguments.times.empty()) files.protect_input(arguments.times);
    const std::string out = arguments.json.empty() ? "-" : arguments.json;
    files.add(out);
    const Enclosure proof = arguments.parts > 1 ? prove_in_parts(model, claim, arguments.parts) : prove(model, claim);
    const auto text = [&] { return (arguments.verbose ? proof_text : proof_answer)(*model, claim, proof); };
    files.put(out, arguments.json.empty() ? printable(text()) : to_json(*model, claim, proof));
    files.commit();
    if (arguments.verbose || arguments.timing) print_clean(stderr, "achilles: {:.3g} s\n", proof.statistics.seconds);
    return print_notes(proof, !arguments.json.empty());
}

}  // namespace

void add_prove(CLI::App& program, int& status) {
    const auto arguments = std::make_shared<ProveArguments>();
    CLI::App* command =
        program.add_subcommand("prove", "Encloses every run from a box of initial states and parameters, with proof");
    add_system_argument(*command, arguments->system);
    add_width_option(*command, arguments->width, "");
    command
        ->add_option_function<std::string>(
            "--split",
            [arguments](const std::string& text) {
                const double parts = number_from("--split", text);
                if (!(parts >= 1.0 && parts <= 1000.0 && parts == std::floor(parts)))
                    throw InputError("--split " + text, {}, "a whole number from 1 to 1000 is expected");
                arguments->parts = static_cast<int>(parts);
            },
            "number of parts each side of the box is cut into; the parts are proved on all cores (default 1)")
        ->type_name("K");
    command->add_option("--json", arguments->json, "write the proof as JSON instead of text; - is standard output")
        ->type_name("F");
    command
        ->add_option_function<std::string>(
            "--samples",
            [arguments](const std::string& text) {
                const double count = number_from("--samples", text);
                if (!(count >= 2.0 && count <= 100000.0 && count == std::floor(count)))
                    throw InputError("--samples " + text, {}, "a whole number from 2 to 100000 is expected");
                arguments->samples = static_cast<int>(count);
            },
            "number of equidistant instants, both ends included, at which the state is enclosed")
        ->type_name("N");
    command->add_option("--times", arguments->times, "file of instants instead of --samples, one per line, s")
        ->type_name("F");
    command->add_flag("--verbose", arguments->verbose,
                      "print the first impacts, the full assumptions and the wall time; --json has every impact");
    command->add_flag("--timing", arguments->timing, "print the wall time on standard error");
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->get_option("--set")->description(
        "value of a parameter, a start x=0.3 or a rate x'=1.5, or an interval x=0.1..0.2; repeatable");
    // Hide integration options, which do not affect a proof.
    for (const char* idle : {"--tolerance", "--method", "--memory", "--simultaneous", "--energy-gain", "--max-events",
                             "--conditions", "--reinitialization", "--eps", "--eps-q", "--eps-v"})
        command->get_option(idle)->group("");
    command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace achilles
