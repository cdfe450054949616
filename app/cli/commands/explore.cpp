#include "cli/explore.hpp"

#include <CLI/CLI.hpp>

#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"

namespace achilles {

namespace {

void add_options(CLI::App& command, ExploreOptions& options) {
    command.add_option("SYSTEM", options.system, "the path of a .toml file, or a name from 'achilles list'")
        ->type_name("");
    command.add_option("--journal", options.journal, "journal to replay first: a path, or the name of a tour")
        ->type_name("F");
    add_step_option(command, options.steps, options.allow_files);
    command.add_option("--record", options.record, "record this session as a journal")->type_name("F");
    add_size_options(command, options.width, options.height, options.scale);
    add_run_options(command, options.settings, options.overrides);
}

}  // namespace

void add_explore(CLI::App& program, int& status) {
    const auto options = std::make_shared<ExploreOptions>();
    CLI::App* command = program.add_subcommand("explore", "Opens the explorer window (the default command)");
    add_options(*command, *options);
    command->callback([options, &status] { status = explore(*options); });
}

void add_screenshot(CLI::App& program, int& status, PictureJob& job) {
    const auto options = std::make_shared<ScreenshotOptions>();
    CLI::App* command = program.add_subcommand("screenshot", "Draws the whole explorer as a PNG, without a display");
    add_options(*command, *options);
    command->add_option("--out", options->out, "the PNG to write")->required()->type_name("F.png");
    command->callback([options, &status, &job] { status = screenshot(*options, job); });
}

}  // namespace achilles
