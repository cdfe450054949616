#include <CLI/CLI.hpp>

#include "commands/commands.hpp"
#include "model/description.hpp"

namespace achilles {

void add_paper(CLI::App& program, int& status) {
    program.add_subcommand("paper", "Figure 4 (a)-(f) of the paper, and its numbers beside ours")->callback([&status] {
        status = bad_input;
        throw InputError({}, {}, "'paper' is not available in this build");
    });
}

}  // namespace achilles
