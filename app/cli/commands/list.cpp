#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "model/read_system.hpp"
#include "system/description.hpp"

namespace achilles {

namespace {

// The titles; a file that cannot be read is listed with what is wrong, and the others still are.
void list() {
    std::size_t width = 0;
    for (const std::string& name : system_names()) width = std::max(width, name.size());
    for (const auto& file : system_files()) {
        std::string title;
        try {
            title = read_system(file).title;
        } catch (const InputError& error) {
            title = fmt::format("(cannot be read: {})", error.message);
        }
        std::replace(title.begin(), title.end(), '\n', ' ');
        print_clean(stdout, "{:<{}}  {}\n", file.stem().string(), width, title);
    }
}

}  // namespace

void add_list(CLI::App& program, int& status) {
    program.add_subcommand("list", "Lists the systems of the gallery and their titles")->callback([&status] {
        list();
        status = reached_end;
    });
}

}  // namespace achilles
