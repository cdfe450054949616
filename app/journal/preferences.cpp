#include "journal/preferences.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "cli/write_files.hpp"
#include "journal/journal.hpp"
#include "session/replay_script.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_recent = 8;

// $XDG_CONFIG_HOME/achilles, else ~/.config/achilles; empty without a home folder.
fs::path config_folder() {
    const char* const given = std::getenv("XDG_CONFIG_HOME");
    if (given != nullptr && fs::path(given).is_absolute()) return fs::path(given) / "achilles";
    const char* const home = std::getenv("HOME");
    return home == nullptr || *home == '\0' ? fs::path() : fs::path(home) / ".config/achilles";
}

bool is_appearance_command(const Command& command) {
    return std::holds_alternative<command::SetTheme>(command) || std::holds_alternative<command::Enlarge>(command) ||
           std::holds_alternative<command::SetPanelSize>(command);
}

std::string content_of(const fs::path& file) {
    std::error_code problem;
    if (file.empty() || !fs::is_regular_file(file, problem)) return {};
    try {
        return read_text(file);
    } catch (const InputError&) {
        return {};
    }
}

}  // namespace

std::vector<Command> appearance_of(const Session& session) {
    std::vector<Command> appearance;
    if (session.theme().dark) appearance.emplace_back(command::SetTheme{true});
    for (const Command& step : steps_to(session.scene()))
        if (is_appearance_command(step)) appearance.push_back(step);
    return appearance;
}

Preferences::Preferences() {
    const fs::path folder = config_folder();
    if (!folder.empty()) file_ = folder / "preferences.journal";
    text_ = content_of(file_);
    std::istringstream lines(text_);
    for (std::string line; std::getline(lines, line);) {
        try {
            const Command command = parse_command(line);
            const auto* open = std::get_if<command::Open>(&command);
            if (open != nullptr && recent_.size() < max_recent) recent_.push_back(open->system);
            if (is_appearance_command(command)) appearance_.push_back(command);
        } catch (const InputError&) {
            continue;
        }
    }
}

void Preferences::keep(const Session& session) {
    if (file_.empty()) return;
    if (const std::string& file = session.document().file; !file.empty()) {
        const std::string path = name_anywhere(file);
        recent_.erase(std::remove(recent_.begin(), recent_.end(), path), recent_.end());
        recent_.insert(recent_.begin(), path);
        recent_.resize(std::min(recent_.size(), max_recent));
    }
    std::vector<Command> steps = appearance_of(session);
    for (const std::string& file : recent_) steps.emplace_back(command::Open{file});
    const std::string text = steps.empty() ? "" : journal_text(steps);
    if (text == text_) return;
    text_ = text;
    std::error_code problem;
    fs::create_directories(file_.parent_path(), problem);
    try {
        OutputFiles files;
        files.add(file_);
        files.put(file_, text);
        files.commit(OutputFiles::Durability::fast);
    } catch (const InputError&) {
        return;  // disk full or read-only folder: the settings still apply to this window
    }
}

}  // namespace achilles
