#include "cli/dropped.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "cli/assets.hpp"
#include "cli/commands/common.hpp"
#include "journal/journal.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_ending.hpp"
#include "pictures/views.hpp"

namespace achilles {

namespace {

constexpr std::size_t largest_picture = std::size_t{1} << 28;  // bytes

// What of a picture's command line leads to what it shows; how large it was drawn does not.
struct Asked {
    std::string kind, system, journal, at;
    bool dark = false;
    std::vector<std::string> settings, views, steps;
    OptionOverrides overrides;
};

Asked parsed(const std::string& command_line) {
    std::vector<std::string> words = words_of(command_line);
    Asked asked;
    if (words.empty()) throw std::runtime_error("the picture does not contain the command that made it");
    asked.kind = words.front();
    words.erase(words.begin());
    CLI::App command;
    command.allow_extras();
    command.add_option("SYSTEM", asked.system);
    command.add_option("--journal", asked.journal);
    add_view_option(command, asked.views, "");
    bool allowed = false;  // of no account: what is replayed here writes nothing, and reads what the window allows
    add_step_option(command, asked.steps, allowed);
    add_run_options(command, asked.settings, asked.overrides);
    // Known, so that their values are not taken for the system.
    std::string ignored;
    command.add_option("--at", asked.at);
    command.add_flag("--dark", asked.dark);
    for (const char* flag : {"--width-mm", "--height-mm", "--font-pt", "--dpi", "--size", "--scale", "--columns",
                             "--format", "--fps", "--speed", "--camera", "--record"})
        command.add_option(flag, ignored);
    std::reverse(words.begin(), words.end());  // CLI11 takes them from the back
    try {
        command.parse(words);
    } catch (const CLI::ParseError& error) {
        throw std::runtime_error(std::string("the command in this picture cannot be read: ") + error.what());
    }
    return asked;
}

const Source* carried(const Origin& origin, Source::Kind kind, const std::string& name) {
    for (const Source& source : origin.sources)
        if (source.kind == kind && (name.empty() || source.name == name)) return &source;
    return nullptr;
}

// Where the commands go, and who says which files they may come from.
struct Opening {
    const std::string& picture;
    const Trust& trust;
    std::vector<Command> commands{};
};

// Whether the file of that name still holds the text. The name is the picture's, and so a stranger's: a path is looked
// into only where the user lets it. Throws Forbidden where that is to be asked.
bool is_held(const Source& source, const Opening& opening) {
    std::error_code problem;
    if (is_system_path(source.name)) {
        if (!std::filesystem::is_regular_file(source.name, problem)) return false;
        const std::optional<bool> may = may_read(source.name, opening.trust);
        if (!may) {
            Forbidden question(opening.picture, {}, fmt::format("this picture would read {}", source.name));
            question.wants = {want(source.name, false)};
            throw question;
        }
        if (!*may) return false;
    }
    try {
        return read_text(find_system(source.name)) == source.text;
    } catch (const InputError&) {
        return false;
    }
}

// Opens what the picture knows under this name.
void open(const Source& source, Opening& opening) {
    if (is_held(source, opening)) {
        opening.commands.emplace_back(command::Open{source.name});
        return;
    }
    opening.commands.emplace_back(command::New{});
    opening.commands.emplace_back(command::Text{source.text});
}

// The run and the plots that a command line asks for.
void ask(const Asked& asked, const Source& source, std::vector<Command>& commands) {
    const SystemDescription description = parse_system(source.text, source.name);
    Run run = asked_run(description, asked.settings, asked.overrides);
    command::Start start;
    for (const std::string& setting : asked.settings) {
        std::string name = setting.substr(0, setting.find('='));
        name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
        if (const double* value = find_value(description, run, name)) start.values.emplace_back(name, *value);
    }
    if (!start.values.empty()) commands.emplace_back(start);
    for (const auto group : options_by_command(description.options, run.options))
        if (std::any_of(group.begin(), group.end(),
                        [&](const Option& option) { return asked.overrides.given(option) != nullptr; }))
            commands.emplace_back(command::UseOption(group[0], run.options));
    if (asked.views.empty()) return;
    const std::vector<ViewDescription> views = views_of(description, asked.views);
    const int columns = views.size() > 2 ? 2 : 1;
    commands.emplace_back(command::Grid{columns, (static_cast<int>(views.size()) + columns - 1) / columns});
    for (std::size_t i = 0; i < views.size(); ++i) {
        command::PlotView plot{static_cast<int>(i) + 1, views[i].x.text, {}};
        for (const ::achilles::Text& y : views[i].y) plot.y.push_back(y.text);
        commands.emplace_back(plot);
    }
}

// The commands of a journal, with what they read taken from the picture. They write nothing, and play nothing again.
void replay(const std::vector<Command>& journal, const Origin& origin, Opening& opening) {
    for (const Command& command : journal) {
        if (const auto* opened = std::get_if<command::Open>(&command)) {
            if (const Source* source = carried(origin, Source::Kind::system, opened->system)) open(*source, opening);
            continue;
        }
        if (std::holds_alternative<command::Save>(command) || std::holds_alternative<command::Export>(command) ||
            std::holds_alternative<command::Replay>(command) || std::holds_alternative<command::Copy>(command))
            continue;
        opening.commands.push_back(command);
    }
}

std::vector<Command> session_of(const Origin& origin, Opening& opening) {
    const Asked asked = parsed(origin.command);
    if (asked.kind == "paper")
        throw std::runtime_error("a picture made by achilles paper cannot be opened as a session");
    const Source* source = carried(origin, Source::Kind::system, asked.system);
    if (source == nullptr) throw std::runtime_error("the picture does not contain its system");
    open(*source, opening);
    ask(asked, *source, opening.commands);
    if (const Source* journal = carried(origin, Source::Kind::journal, asked.journal);
        !asked.journal.empty() && journal != nullptr)
        replay(parse_journal(journal->text, journal->name), origin, opening);
    replay(parse_steps(asked.steps), origin, opening);
    if (!asked.at.empty()) opening.commands.push_back(parse_command("seek " + asked.at, opening.picture));
    if (asked.dark) opening.commands.emplace_back(command::UseTheme{true});
    return opening.commands;
}

}  // namespace

bool is_picture(const std::string& path) { return !ending_of_picture(path).empty(); }

std::vector<Command> session_in(const std::string& picture, const Trust& trust) {
    Opening opening{picture, trust};
    try {
        return session_of(origin_of(read_text(picture, largest_picture)), opening);
    } catch (const InputError&) {
        throw;
    } catch (const std::runtime_error& problem) {
        throw InputError(picture, {}, problem.what());
    }
}

}  // namespace achilles
