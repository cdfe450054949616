// The command orbit: a periodic orbit, its Floquet multipliers and its branch.
#include "analysis/orbit.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "figure/publication.hpp"
#include "output/output.hpp"
#include "pictures/export.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/picture_job.hpp"

namespace achilles {

namespace {

struct OrbitArguments {
    std::string system, json, out;
    OrbitOptions typed;
    std::vector<std::string> views;
    OptionOverrides overrides;
    PublicationStyle style;
    PictureSize size;
    PaperSize page;
    bool verbose = false;
};

int run(const OrbitArguments& arguments, PictureJob& job) {
    const SystemDescription description = job.inputs().system(arguments.system);
    const auto model = std::make_shared<const Model>(description);
    OrbitOptions typed = arguments.typed;
    const Run run = requested_run(description, typed.settings, arguments.overrides);
    job.check(run.options);
    validate_overrides(*model, run, typed.settings);
    warn(description, run);
    for (const Option& option : all_options())
        if (arguments.overrides.find(option) != nullptr) typed.options.insert(option.key);
    if (!typed.from.empty() && typed.from != "start" && typed.from != "end")
        typed.guess = orbit_guess(job.inputs().data(typed.from), typed.from, description.coordinates.size());
    const OrbitRequest question = parse_orbit_request(typed, run, model);
    const std::vector<ViewDescription> views = views_of(description, arguments.views);
    std::string format;
    if (!arguments.out.empty()) {
        format = format_for(arguments.out, "");
        if (format == "pdf") need_pdf_writer("--out " + arguments.out);
        check(arguments.page, "--width-mm");
        if (format == "png") job.check_size(arguments.size.width, arguments.size.height);
        job.add(arguments.out);
    }
    const std::string text = arguments.json.empty() ? "-" : arguments.json;
    if (text != arguments.out) job.add(text);
    const OrbitResult found = solve_orbit_request(question, model);
    if (!found.orbit) {
        print_clean(
            stderr,
            "achilles: no periodic orbit found: {}. Try another guess: --from end, --from FILE or --set NAME=VALUE\n",
            found.reason);
        return stopped_early;
    }
    const Branch* const followed = found.branch ? &*found.branch : nullptr;
    if (text != arguments.out)
        job.put_text(text, arguments.json.empty()
                               ? printable((arguments.verbose ? orbit_text : orbit_answer)(*found.orbit, followed))
                               : to_json(*found.orbit, followed));
    if (!arguments.out.empty()) {
        PublicationStyle style = arguments.style;
        style.ordered = !arguments.views.empty();
        style.size = resolution_of(arguments.page, arguments.size, format);
        style.shape = double{1} * arguments.size.width / arguments.size.height;
        const Figure figure = followed != nullptr ? compose_branch(*found.orbit, *followed, views, style)
                                                  : publication(found.orbit->run, views, style);
        job.put(arguments.out, "", {{arguments.system, &found.orbit->run}}, [&](const Notes& notes) {
            const PictureSize size = size_of(page_for(arguments.page, format), arguments.size, figure, format);
            job.check_size(size.width, size.height);
            return picture_of(figure, size, notes, format);
        });
    }
    job.commit();
    return reached_end;
}

}  // namespace

void add_orbit(CLI::App& program, int& status, PictureJob& job) {
    const auto arguments = std::make_shared<OrbitArguments>();
    CLI::App* command =
        program.add_subcommand("orbit", "Finds a periodic orbit, its multipliers, and its branch in a parameter");
    add_system_argument(*command, arguments->system);
    const auto add = [&](const char* flag, std::string& place, const char* type, const char* about) {
        command->add_option(flag, place, about)->type_name(type);
    };
    add("--from", arguments->typed.from, "start|end|FILE",
        "initial guess: the start of the run, its end, or the state in a file written by orbit --json or simulate "
        "--json (default: [orbit] of the system, else the start)");
    add("--period", arguments->typed.period, "EXPRESSION",
        "period in s, an expression in the parameters such as 2*pi/om: of the drive, or a guess if there is no drive");
    command
        ->add_option(
            "--shift", arguments->typed.shifts,
            "shift of a coordinate after one period, such as x=2*pi, or x=free if nothing depends on it; repeatable")
        ->type_name("NAME=EXPRESSION")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add("--continue", arguments->typed.along, "NAME=LOW:HIGH",
        "follow the orbit as a parameter varies, in both directions and around folds, until a Zeno point disappears");
    add("--json", arguments->json, "F", "write the results as JSON instead of text; - is standard output");
    add("--out", arguments->out, "F.png|F.svg|F.pdf", "picture of one period, or of the branch");
    add_view_option(*command, arguments->views, "with --out: view of the system; repeatable (default: all)");
    command->add_flag("--verbose", arguments->verbose, "print margins, impacts and options, too");
    command->add_flag("--transparent", arguments->style.transparent, "with --out: leave out the background");
    command->add_flag("--dark", arguments->style.dark, "with --out: draw light on dark, for a screen");
    add_page_options(*command, arguments->page);
    add_size_options(*command, arguments->size.width, arguments->size.height, arguments->size.scale);
    add_run_options(*command, arguments->typed.settings, arguments->overrides);
    command->callback([arguments, &status, &job] { status = run(*arguments, job); });
}

}  // namespace achilles
