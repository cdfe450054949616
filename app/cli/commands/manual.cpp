// The commands help, show and new: the manual, a gallery file, and a template of a system.

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/manual.hpp"
#include "cli/terminal.hpp"
#include "cli/write_files.hpp"
#include "model/read_system.hpp"
#include "pictures/origin.hpp"
#include "system/description.hpp"

namespace achilles {

namespace {

std::string contents() {
    std::string text = "achilles help TOPIC prints a page of the manual:\n\n";
    const std::vector<ManualTopic> topics = manual_topics();
    std::size_t width = 0;
    for (const ManualTopic& topic : topics) width = std::max(width, topic.name.size());
    for (const ManualTopic& topic : topics) text += fmt::format("  {:<{}}  {}\n", topic.name, width, topic.title);
    return text + "\nachilles COMMAND --help lists the options of a command, achilles --help the commands.\n";
}

// Writes `text` to NAME.toml, which must not exist.
void write_new(const std::string& name, const std::string& text) {
    if (name.find_first_not_of(' ') == std::string::npos)
        throw InputError("new", {}, "the name is empty", "for example, achilles new mine writes mine.toml");
    std::filesystem::path file = name;
    if (file.extension() != ".toml") file += ".toml";
    std::error_code problem;
    if (std::filesystem::symlink_status(file, problem).type() != std::filesystem::file_type::not_found)
        throw InputError(file.string(), {}, "this file already exists", "choose another name");
    OutputFiles files;
    files.add(file.string());
    files.put(file.string(), text);
    files.commit();
    const std::string path = (file.has_parent_path() ? "" : "./") + file.string();
    fmt::print("wrote {}; to run it: {}\n", file.string(), shell_line({"simulate", path}));
}

}  // namespace

void add_manual(CLI::App& program, int& status) {
    CLI::App* help = program.add_subcommand("help", "Prints the manual, one page per topic");
    const auto topic = std::make_shared<std::string>();
    help->add_option("TOPIC", *topic, "page or command (default: the list of pages)")->type_name("");
    const auto man_folder = std::make_shared<std::string>();
    help->add_option("--man", *man_folder, "write the man pages of all commands into this folder")->type_name("DIR");
    help->callback([topic, man_folder, &program, &status] {
        if (!man_folder->empty()) {
            OutputFiles files;
            for (const ManPage& page : man_pages(program)) {
                const std::string file = (std::filesystem::path(*man_folder) / page.file).string();
                files.add(file);
                files.put(file, page.text);
            }
            files.commit(OutputFiles::Durability::fast);
            status = reached_end;
            return;
        }
        // Some commands have a manual page, which says more than their options.
        const auto pages = manual_topics();
        const bool has_page =
            std::any_of(pages.begin(), pages.end(), [&](const auto& page) { return page.name == *topic; });
        const auto commands = program.get_subcommands([&](const CLI::App* one) { return one->get_name() == *topic; });
        const std::string text = topic->empty()                 ? contents()
                                 : has_page || commands.empty() ? manual_page(*topic)
                                                                : commands.front()->help("achilles");
        std::fwrite(text.data(), 1, text.size(), stdout);
        status = reached_end;
    });
    CLI::App* show = program.add_subcommand("show", "Prints a system file, such as one of the gallery");
    const auto shown_system = std::make_shared<std::string>();
    show->add_option("SYSTEM", *shown_system, "the path of a .toml file, or a name from 'achilles list'")
        ->required()
        ->type_name("");
    show->callback([shown_system, &status] {
        const std::string text = read_text(find_system(*shown_system));
        std::fwrite(text.data(), 1, text.size(), stdout);
        status = reached_end;
    });
    CLI::App* create = program.add_subcommand("new", "Writes NAME.toml, a system file to start from");
    const auto name = std::make_shared<std::string>(), from = std::make_shared<std::string>();
    create->add_option("NAME", *name, "file to write, with or without .toml")->required()->type_name("");
    CLI::Option* copied =
        create->add_option("--from", *from, "system to copy (default: a ball on a floor, with every key explained)")
            ->type_name("SYSTEM");
    const auto of_bodies = std::make_shared<bool>(false);
    create->add_flag("--body", *of_bodies, "the ball as a body, with what can be typed in place of energies")
        ->excludes(copied);
    create->callback([name, from, of_bodies, &status] {
        const std::string text = *of_bodies      ? skeleton_of_bodies()
                                 : from->empty() ? skeleton_system()
                                                 : read_text(find_system(*from));
        write_new(*name, text);
        status = reached_end;
    });
}

namespace {

// Prints names and titles. A file that cannot be read is listed with its error.
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
