#include "cli/inputs.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "cli/assets.hpp"
#include "cli/commands/common.hpp"
#include "journal/journal.hpp"
#include "journal/link.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/picture_job.hpp"

namespace achilles {

namespace {

InputError not_carried(const std::string& name) {
    return {name, {}, "the picture does not contain this file", "the files stored in it are incomplete"};
}

}  // namespace

Inputs::Inputs(std::vector<InputSource> stored, const std::string& command)
    : stored_(std::move(stored)),
      from_picture_(true),
      trust_{FilePolicy::Files::virtual_only,
             {},
             {},
             std::make_shared<Budget>("to make it without this limit, run:\n" + command)} {
    trust_.budget->limit();
    time_limit_.arm(trust_.budget->how_to_allow());
}

// For a picture: the text that this name had at this request; after the last stored text, that one again.
const InputSource& Inputs::next(const std::string& name, bool is_journal) {
    const std::size_t number = request_counts_[{name, is_journal}]++;
    const InputSource* found = nullptr;
    std::size_t count = 0;
    for (const InputSource& source : stored_)
        if (source.name == name && (source.kind == InputSource::Kind::journal) == is_journal && count++ <= number)
            found = &source;
    if (found == nullptr) throw not_carried(name);
    return *found;
}

std::string Inputs::text(const std::string& name) {
    if (from_picture_) return next(name, false).text;
    stored_.push_back({InputSource::Kind::system, name, read_text(files_read_.emplace_back(find_system(name)))});
    return stored_.back().text;
}

std::string Inputs::data(const std::string& path) {
    if (from_picture_) return next(path, false).text;
    stored_.push_back({InputSource::Kind::system, path, read_text(files_read_.emplace_back(path))});
    return stored_.back().text;
}

// Messages use the name as given. A picture of the explorer shows them, and must not depend on the location of the
// assets.
SystemDescription Inputs::system(const std::string& name) { return parse_system(text(name), name); }

std::string Inputs::journal_text(const std::string& path) {
    if (from_picture_) return next(path, true).text;
    if (!is_link(path)) files_read_.emplace_back(find_journal(path));
    stored_.push_back({InputSource::Kind::journal, path, text_of_journal(path)});
    return stored_.back().text;
}

std::vector<Command> Inputs::journal(const std::string& path) {
    if (trust_.budget) time_limit_.arm(trust_.budget->how_to_allow());
    std::vector<Command> commands =
        parse_trusted(journal_text(path), is_link(path) ? name_in_messages(path) : path, trust_);
    count(path, commands);
    return commands;
}

std::vector<Command> Inputs::steps(const std::vector<std::string>& lines) {
    std::vector<Command> commands = parse_steps(lines);
    if (from_picture_) count("--do", commands);
    return commands;
}

// Counts commands as they are read, so that journals which replay each other are stopped.
void Inputs::count(const std::string& name, const std::vector<Command>& commands) {
    replayed_ += commands.size();
    if (replayed_ > max_replayed)
        throw PermissionDenied(name, {}, fmt::format("a session replays at most {} commands", max_replayed));
    changes_ += static_cast<std::size_t>(std::count_if(commands.begin(), commands.end(), [](const Command& command) {
        return undo_policy_of(command) == command::UndoPolicy::merge_with_previous ||
               undo_policy_of(command) == command::UndoPolicy::own_step;
    }));
    if (from_picture_ && changes_ > max_changes)
        throw PermissionDenied(name, {}, fmt::format("a picture is reproduced with at most {} changes", max_changes));
}

std::string Inputs::first_system() const {
    const auto first = std::find_if(stored_.begin(), stored_.end(),
                                    [](const InputSource& source) { return source.kind == InputSource::Kind::system; });
    if (first == stored_.end()) throw not_carried("SYSTEM");
    return first->name;
}

namespace {

constexpr std::size_t largest_picture = std::size_t{1} << 28;  // bytes

// The parts of a picture's command line that determine its session; its size is ignored.
struct DroppedOptions {
    std::string kind, system, journal, at;
    bool dark = false;
    std::vector<std::string> settings, views, steps;
    OptionOverrides overrides;
};

DroppedOptions parsed(const std::string& command_line) {
    std::vector<std::string> words = words_of(command_line);
    DroppedOptions dropped;
    if (words.empty()) throw std::runtime_error("the picture does not contain the command that made it");
    dropped.kind = words.front();
    words.erase(words.begin());
    CLI::App command;
    command.allow_extras();
    command.add_option("SYSTEM", dropped.system);
    command.add_option("--journal", dropped.journal);
    add_view_option(command, dropped.views, "");
    bool allowed = false;  // ignored: this replay writes nothing, and the window decides what may be read
    add_step_option(command, dropped.steps, allowed);
    add_run_options(command, dropped.settings, dropped.overrides);
    // Declared so that their values are not taken for the system.
    std::string ignored;
    command.add_option("--at", dropped.at);
    command.add_flag("--dark", dropped.dark);
    for (const char* flag : {"--width-mm", "--height-mm", "--font-pt", "--dpi", "--size", "--scale", "--columns",
                             "--format", "--fps", "--speed", "--camera", "--turn", "--record"})
        command.add_option(flag, ignored);
    std::reverse(words.begin(), words.end());  // CLI11 expects reverse order
    try {
        command.parse(words);
    } catch (const CLI::ParseError& error) {
        throw std::runtime_error(std::string("the command in this picture cannot be read: ") + error.what());
    }
    return dropped;
}

const InputSource* stored_source(const Origin& origin, InputSource::Kind kind, const std::string& name) {
    for (const InputSource& source : origin.sources)
        if (source.kind == kind && (name.empty() || source.name == name)) return &source;
    return nullptr;
}

// The commands collected so far, and the permission to read files.
struct DroppedCommands {
    const std::string& picture;
    const FilePolicy& trust;
    std::vector<Command> commands{};
};

// Whether the file of that name still has the same text. The name comes from an untrusted picture, so a path is read
// only with permission. Throws PermissionDenied if the user must be asked.
bool is_held(const InputSource& source, const DroppedCommands& opening) {
    std::error_code problem;
    if (is_system_path(source.name)) {
        if (!std::filesystem::is_regular_file(source.name, problem)) return false;
        const std::optional<bool> may = may_read(source.name, opening.trust);
        if (!may) {
            PermissionDenied question(opening.picture, {}, fmt::format("this picture would read {}", source.name));
            question.requests = {access_request(source.name, false)};
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

// Opens the system that the picture stores under this name.
void open(const InputSource& source, DroppedCommands& opening) {
    if (is_held(source, opening)) {
        opening.commands.emplace_back(command::Open{source.name});
        return;
    }
    opening.commands.emplace_back(command::New{});
    opening.commands.emplace_back(command::SetText{source.text});
}

// The run and the plots that a command line specifies.
void add_option_commands(const DroppedOptions& dropped, const InputSource& source, std::vector<Command>& commands) {
    const SystemDescription description = parse_system(source.text, source.name);
    Run run = requested_run(description, dropped.settings, dropped.overrides);
    command::SetStart start;
    for (const std::string& setting : dropped.settings) {
        std::string name = setting.substr(0, setting.find('='));
        name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
        if (const double* value = find_value(description, run, name)) start.values.emplace_back(name, *value);
    }
    if (!start.values.empty()) commands.emplace_back(start);
    for (const auto group : options_by_command(description.options, run.options))
        if (std::any_of(group.begin(), group.end(),
                        [&](const Option& option) { return dropped.overrides.find(option) != nullptr; }))
            commands.emplace_back(command::SetOption(group[0], run.options));
    if (dropped.views.empty()) return;
    const std::vector<ViewDescription> views = views_of(description, dropped.views);
    const int columns = views.size() > 2 ? 2 : 1;
    commands.emplace_back(command::SetGrid{columns, (static_cast<int>(views.size()) + columns - 1) / columns});
    for (std::size_t i = 0; i < views.size(); ++i) {
        command::PlotView plot{static_cast<int>(i) + 1, views[i].x.text, {}};
        for (const ::achilles::Text& y : views[i].y) plot.y.push_back(y.text);
        commands.emplace_back(plot);
    }
}

// The commands of a journal, with their inputs taken from the picture. Commands that write files or start playback are
// left out.
void replay(const std::vector<Command>& journal, const Origin& origin, DroppedCommands& opening) {
    for (const Command& command : journal) {
        if (const auto* opened = std::get_if<command::Open>(&command)) {
            if (const InputSource* source = stored_source(origin, InputSource::Kind::system, opened->system))
                open(*source, opening);
            continue;
        }
        if (std::holds_alternative<command::Save>(command) || std::holds_alternative<command::Export>(command) ||
            std::holds_alternative<command::Replay>(command) || std::holds_alternative<command::Copy>(command))
            continue;
        opening.commands.push_back(command);
    }
}

std::vector<Command> session_of(const Origin& origin, DroppedCommands& opening) {
    const DroppedOptions dropped = parsed(origin.command);
    if (dropped.kind == "paper")
        throw std::runtime_error("a picture made by achilles paper cannot be opened as a session");
    const InputSource* source = stored_source(origin, InputSource::Kind::system, dropped.system);
    if (source == nullptr) throw std::runtime_error("the picture does not contain its system");
    open(*source, opening);
    add_option_commands(dropped, *source, opening.commands);
    if (const InputSource* journal = stored_source(origin, InputSource::Kind::journal, dropped.journal);
        !dropped.journal.empty() && journal != nullptr)
        replay(parse_journal(journal->text, journal->name), origin, opening);
    replay(parse_steps(dropped.steps), origin, opening);
    if (!dropped.at.empty()) opening.commands.push_back(parse_command("seek " + dropped.at, opening.picture));
    if (dropped.dark) opening.commands.emplace_back(command::SetTheme{true});
    return opening.commands;
}

}  // namespace

bool is_picture(const std::string& path) { return !ending_of_picture(path).empty(); }

std::vector<Command> session_in(const std::string& picture, const FilePolicy& trust) {
    DroppedCommands opening{picture, trust};
    try {
        return session_of(origin_of(read_text(picture, largest_picture)), opening);
    } catch (const InputError&) {
        throw;
    } catch (const std::runtime_error& problem) {
        throw InputError(picture, {}, problem.what());
    }
}

}  // namespace achilles
