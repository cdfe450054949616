#include <CLI/CLI.hpp>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/write_files.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/player.hpp"
#include "sensitivity/error_estimate.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

struct HtmlArguments {
    std::string system, out;
    std::vector<std::string> views, settings;
    OptionOverrides overrides;
};

int write_page(const HtmlArguments& arguments) {
    if (const std::string format = ending_of_picture(arguments.out); !format.empty())
        throw InputError("--out " + arguments.out, {}, "this command writes a page for a browser, not a picture",
                         "write --out run.html; for a picture: achilles figure SYSTEM --out F." + format);
    const std::filesystem::path file = find_system(arguments.system);
    const SystemDescription description = parse_system(read_text(file), arguments.system);
    const Run run = requested_run(description, arguments.settings, arguments.overrides);
    const auto model = std::make_shared<const Model>(description);
    const std::vector<ViewDescription> views = views_of(description, arguments.views);
    validate_overrides(*model, run, arguments.settings);
    warn(description, run);
    OutputFiles files;
    files.protect_input(file);
    files.add(arguments.out);

    const Trajectory trajectory = simulate(model, run);
    const ErrorEstimate estimate = estimate_error(trajectory);
    const std::string prove = prove_line(arguments.system, arguments.settings, arguments.overrides);
    files.put(arguments.out, player_page(trajectory, estimate, views,
                                         {answer(trajectory, estimate, prove),
                                          player_command(trajectory, arguments.system, arguments.views)}));
    files.commit();
    return print_notes(trajectory, true, &estimate);
}

}  // namespace

void add_html(CLI::App& program, int& status) {
    const auto arguments = std::make_shared<HtmlArguments>();
    CLI::App* command = program.add_subcommand(
        "html", "Writes a run as one page for a browser: the mechanism in motion, plots, events");
    add_system_argument(*command, arguments->system);
    command->add_option("--out", arguments->out, "page to write; - is standard output")
        ->required()
        ->type_name("F.html");
    add_view_option(*command, arguments->views, "view of the system; repeatable (default: all)");
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status] { status = write_page(*arguments); });
}

}  // namespace achilles
