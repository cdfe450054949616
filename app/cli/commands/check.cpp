#include "check/check.hpp"
#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "cli/write_files.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>

namespace achilles {

namespace {

struct CheckArguments {
    std::string system;
    bool latex = false, verbose = false, expand = false;
    std::vector<std::string> settings;
    OptionOverrides overrides;
};

int check(const CheckArguments& arguments) {
    const std::string text = read_text(find_system(arguments.system));
    OutputFiles files;
    files.add("-");
    const SystemDescription description = parse_system(text, arguments.system);
    const Run run = requested_run(description, arguments.settings, arguments.overrides);
    const auto before = std::chrono::steady_clock::now();
    const Model model(description);
    const std::chrono::duration<double> deriving = std::chrono::steady_clock::now() - before;
    validate_overrides(model, run, arguments.settings);
    warn(description, run);
    if (arguments.expand) {
        files.put("-", printable(expand_system(text, arguments.system)));
        files.commit();
        return reached_end;
    }
    double disagreement = 0.0;
    const Notation notation = arguments.latex ? Notation::latex : Notation::text;
    const bool is_whole = arguments.latex || arguments.verbose;
    files.put("-", printable(is_whole ? check_report(model, run, deriving.count(), notation, disagreement)
                                      : check_answer(model, run, disagreement)));
    files.commit();
    if (disagreement <= max_disagreement) return reached_end;
    print_clean(stderr, "achilles: the derived equations differ from finite differences of L by {:.1e}\n",
                disagreement);
    return stopped_early;
}

}  // namespace

void add_check(CLI::App& program, int& status) {
    const auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command =
        program.add_subcommand("check", "Checks a system file and prints its equations of motion and Zeno condition");
    command->add_option("SYSTEM", arguments->system, "the path of a .toml file, or a name from 'achilles list'")
        ->required()
        ->type_name("");
    command->add_flag("--latex", arguments->latex, "print a LaTeX document");
    command->add_flag("--verbose", arguments->verbose,
                      "print parameters, energies, contact equations and each check, too");
    command->add_flag("--expand", arguments->expand,
                      "print the file with energies, gaps and drawings in place of bodies, and nothing else");
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status] { status = check(*arguments); });
}

}  // namespace achilles
