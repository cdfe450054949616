#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "cli/write_files.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/proof.hpp"
#include "output/sampling.hpp"
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
    bool verbose = false;
};

// NAME=LOW..HIGH as the two settings that it consists of; nothing where it is one number.
std::optional<std::array<std::string, 2>> ends_of(const std::string& setting) {
    const std::size_t dots = setting.find(".."), equals = setting.find('=');
    if (dots == setting.npos || equals == setting.npos || dots < equals) return std::nullopt;
    return std::array{setting.substr(0, dots), setting.substr(0, equals + 1) + setting.substr(dots + 2)};
}

// Where a claim keeps the interval of a name that a run has a value of.
Interval& place_of(Claim& claim, const SystemDescription& description, const std::string& name) {
    Run marked = claim.run;
    for (auto* values : {&marked.q, &marked.v}) values->setZero();
    for (double& value : marked.parameters) value = 0.0;
    *find_value(description, marked, name) = 1.0;
    for (std::size_t i = 0; i < claim.q.size(); ++i) {
        if (marked.q[static_cast<Eigen::Index>(i)] != 0.0) return claim.q[i];
        if (marked.v[static_cast<Eigen::Index>(i)] != 0.0) return claim.v[i];
    }
    std::size_t at = 0;
    while (marked.parameters[at] == 0.0) ++at;
    return claim.parameters[at];
}

// The start and the parameters as boxes. `points` becomes the settings with the middle of each interval.
Claim claim_of(const ProveArguments& arguments, const SystemDescription& description,
               std::vector<std::string>& points) {
    std::vector<std::pair<std::string, Interval>> intervals;
    for (const std::string& setting : arguments.settings) {
        const auto ends = ends_of(setting);
        if (!ends) {
            points.push_back(setting);
            continue;
        }
        std::string name = setting.substr(0, setting.find('='));
        name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
        std::array<double, 2> values{};
        for (std::size_t i = 0; i < 2; ++i) {
            Run run = default_run(description);
            assign(run, description, (*ends)[i]);
            values[i] = *find_value(description, run, name);
        }
        if (!(values[0] <= values[1]))
            throw InputError("--set " + shown(setting), {}, "the interval ends before it begins",
                             fmt::format("write --set {}={}..{}", name, values[1], values[0]));
        intervals.emplace_back(name, hull(as_written(values[0]), as_written(values[1])));
        points.push_back(fmt::format("{}={}", name, 0.5 * values[0] + 0.5 * values[1]));
    }
    Claim claim = claim_as_written(asked_run(description, points, arguments.overrides));
    for (const auto& [name, interval] : intervals) place_of(claim, description, name) = interval;
    widen(claim, arguments.width);
    if (const auto* given = arguments.overrides.given(option("eps_t"))) claim.eps_t = std::get<double>(given->second);
    return claim;
}

// Inside the run: the end is told anyway.
std::vector<double> times_of(const ProveArguments& arguments, const Run& run) {
    const double start = run.options.start_time, end = run.options.end_time;
    if (arguments.samples && !arguments.times.empty())
        throw InputError("--samples", {}, "the instants are those of --times already");
    if (arguments.samples) return equidistant(*arguments.samples, start, end);
    if (arguments.times.empty()) return {};
    return read_instants(read_text(arguments.times), arguments.times, start, end);
}

int run(const ProveArguments& arguments) {
    const SystemDescription description = read_system(find_system(arguments.system));
    std::vector<std::string> points;
    Claim claim = claim_of(arguments, description, points);
    const auto model = std::make_shared<const Model>(description);
    check(*model, claim);
    check_asked(*model, claim.run, points);
    claim.times = times_of(arguments, claim.run);
    warn(description, claim.run);
    OutputFiles files;
    files.spare(find_system(arguments.system));
    if (!arguments.times.empty()) files.spare(arguments.times);
    const std::string out = arguments.json.empty() ? "-" : arguments.json;
    files.add(out);
    const Enclosure proof = arguments.parts > 1 ? prove_in_parts(model, claim, arguments.parts) : prove(model, claim);
    files.put(out,
              arguments.json.empty() ? printable(proof_text(*model, claim, proof)) : to_json(*model, claim, proof));
    files.commit();
    if (arguments.verbose) print_clean(stderr, "achilles: {:.3g} s\n", proof.statistics.seconds);
    if (proof.end) return reached_end;
    print_clean(stderr, "achilles: undecided at t = {}: {}\n", proof.proved_until, proof.outcome.message);
    return stopped_early;
}

}  // namespace

void add_prove(CLI::App& program, int& status) {
    const auto arguments = std::make_shared<ProveArguments>();
    CLI::App* command =
        program.add_subcommand("prove", "A whole run as a theorem: boxes around every member of a set of runs");
    add_system_argument(*command, arguments->system);
    command
        ->add_option_function<std::string>(
            "--width",
            [arguments](const std::string& text) {
                arguments->width = number_from("--width", text);
                if (!(arguments->width >= 0.0)) throw InputError("--width " + text, {}, "a half width is not negative");
            },
            "a half width for all coordinates and rates of the start (default 0)")
        ->type_name("W");
    command
        ->add_option_function<std::string>(
            "--split",
            [arguments](const std::string& text) {
                const double parts = number_from("--split", text);
                if (!(parts >= 1.0 && parts <= 1000.0 && parts == std::floor(parts)))
                    throw InputError("--split " + text, {}, "a whole number from 1 to 1000 is expected");
                arguments->parts = static_cast<int>(parts);
            },
            "parts that each side of the box is cut into, proved on all cores (default 1)")
        ->type_name("K");
    command
        ->add_option("--json", arguments->json,
                     "where to write the proof as JSON, instead of text; - is standard output")
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
            "instants at equal distances, both ends included, at which the state is enclosed")
        ->type_name("N");
    command->add_option("--times", arguments->times, "the same for the instants in a file, one a line")->type_name("F");
    command->add_flag("--verbose", arguments->verbose, "tell on standard error how long it took");
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->get_option("--set")->description(
        "a parameter, a coordinate x=0.3 or a rate x'=1.5, or an interval of it: x=0.1..0.2; may be given again");
    // How a run is computed means nothing to a proof.
    for (const char* idle : {"--tolerance", "--method", "--memory", "--simultaneous", "--conditions",
                             "--reinitialization", "--eps", "--eps-q", "--eps-v"})
        command->get_option(idle)->group("");
    command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace achilles
