// The man pages, made from the tables that --help prints.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "cli/commands/commands.hpp"
#include "cli/manual.hpp"
#include "output/output.hpp"

namespace achilles {

namespace {

// Text for troff: no character has a special meaning, and those that are typed stay ASCII.
std::string troff(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '\\':
                result += "\\(rs";
                break;
            case '-':
                result += "\\-";
                break;
            case '\'':
                result += "\\(aq";
                break;
            case '"':
                result += "\\(dq";
                break;
            case '`':
                result += "\\(ga";
                break;
            case '^':
                result += "\\(ha";
                break;
            case '~':
                result += "\\(ti";
                break;
            default:
                result += c;
        }
    }
    return text.starts_with('.') ? "\\&" + result : result;
}

std::string bold(std::string_view text) { return "\\fB" + troff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + troff(text) + "\\fR"; }
std::string entry(const std::string& head, std::string_view text) { return ".TP\n" + head + "\n" + troff(text) + "\n"; }

std::string page_name(const CLI::App& app) {
    return app.get_parent() == nullptr ? "achilles" : "achilles-" + app.get_name();
}

std::string start_of_page(const CLI::App& app) {
    std::string about = app.get_description();
    about.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(about.front())));
    std::string title = page_name(app);
    std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
    return fmt::format(".TH {} 1 \"\" \"Achilles {}\" \"Achilles\"\n.ad l\n.nh\n.SH NAME\n{} \\- {}\n", troff(title),
                       version(), troff(page_name(app)), troff(about));
}

// "SYSTEM", "[TOPIC]".
std::string argument(const CLI::Option& option) {
    return option.get_required() ? italic(option.get_name()) : fmt::format("[{}]", italic(option.get_name()));
}

std::string option_entry(const CLI::Option& option) {
    std::string head = bold(option.get_name(false, true));
    const std::string type = option.get_type_name();
    if (option.get_items_expected_max() > 0) head += " " + italic(type.substr(0, type.find(":{")));
    return entry(head, option.get_description() + (option.get_required() ? " (required)" : ""));
}

// Arguments first, then the options under the headings of --help.
std::string options_section(const CLI::App& app) {
    std::string text, arguments;
    for (const CLI::Option* option : app.get_options())
        if (option->get_positional()) arguments += entry(argument(*option), option->get_description());
    if (!arguments.empty()) text += ".SH ARGUMENTS\n" + arguments;
    text += ".SH OPTIONS\n";
    bool is_first = true;
    for (const std::string& group : app.get_groups()) {
        if (group.empty()) continue;  // hidden
        std::string entries;
        for (const CLI::Option* option : app.get_options())
            if (!option->get_positional() && option->get_group() == group) entries += option_entry(*option);
        if (entries.empty()) continue;
        text += (is_first ? "" : ".SS " + troff(group) + "\n") + entries;
        is_first = false;
    }
    return text;
}

// The table of the manual page `cli`.
std::string exit_status_section() {
    const std::string page = manual_page("cli");
    std::string text = ".SH EXIT STATUS\n";
    for (std::size_t at = page.find("## Exit status"); at != page.npos; at = page.find('\n', at + 1)) {
        const std::string row = page.substr(at + 1, page.find('\n', at + 1) - at - 1);
        const std::size_t bar = row.find(" | ");
        if (!row.starts_with("| ") || bar == row.npos || std::isdigit(static_cast<unsigned char>(row[2])) == 0)
            continue;
        std::string meaning = row.substr(bar + 3, row.rfind(" |") - bar - 3);
        meaning.erase(std::remove(meaning.begin(), meaning.end(), '`'), meaning.end());
        text += entry(bold(row.substr(2, bar - 2)), meaning);
    }
    return text;
}

std::string program_page(const CLI::App& program) {
    std::string text = start_of_page(program);
    text += fmt::format(".SH SYNOPSIS\n{} [{}] [options]\n.br\n{} {} [options]\n", bold("achilles"), italic("SYSTEM"),
                        bold("achilles"), italic("COMMAND"));
    text += ".SH COMMANDS\nEach has a page: " + bold("man achilles-simulate") + ".\n";
    for (const CLI::App* command : program.get_subcommands({}))
        text += entry(bold(command->get_name()), command->get_description());
    text += options_section(program) + exit_status_section() + ".SH MANUAL\n";
    text += bold("achilles help") + " " + italic("TOPIC") + " prints a page:\n";
    for (const ManualTopic& topic : manual_topics()) text += entry(bold(topic.name), topic.title);
    return text;
}

std::string command_page(const CLI::App& command) {
    std::string text = start_of_page(command) + ".SH SYNOPSIS\n" + bold("achilles " + command.get_name());
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional()) text += " " + argument(*option);
    text += " [options]\n" + options_section(command) + exit_status_section();
    const std::vector<ManualTopic> topics = manual_topics();
    const bool has_topic = std::any_of(topics.begin(), topics.end(),
                                       [&](const ManualTopic& topic) { return topic.name == command.get_name(); });
    text += ".SH SEE ALSO\n" + bold("achilles") + "(1)";
    if (has_topic) text += "; the manual: " + bold("achilles help " + command.get_name());
    return text + "\n";
}

}  // namespace

std::vector<ManPage> man_pages(const CLI::App& program) {
    std::vector<ManPage> pages{{"achilles.1", program_page(program)}};
    for (const CLI::App* command : program.get_subcommands({}))
        pages.push_back({page_name(*command) + ".1", command_page(*command)});
    return pages;
}

}  // namespace achilles
