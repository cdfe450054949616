#include "journal/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "cli/assets.hpp"
#include "journal/words.hpp"

namespace achilles {

namespace {

namespace fs = std::filesystem;

// Calls what(command, number, line) for every command of a journal.
template <class What>
void for_each_command(std::string_view text, const std::string& name, const What& what) {
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        if (!is_blank(line)) what(parse_command(line, name, number), number, line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

// The file that a command writes, or reads by its path; empty: none.
struct FileUse {
    std::string path;
    bool writes = false;
};

FileUse file_use(const Command& command) {
    if (const auto* save = std::get_if<command::Save>(&command)) return {save->file, true};
    if (const auto* taken = std::get_if<command::Export>(&command)) return {taken->file, true};
    if (const auto* open = std::get_if<command::Open>(&command); open != nullptr && is_system_path(open->system))
        return {open->system};
    const auto* replay = std::get_if<command::Replay>(&command);
    if (replay != nullptr && is_journal_path(replay->journal)) return {replay->journal};
    return {};
}

bool is_named(const std::string& path, const Trust& trust) {
    return std::any_of(trust.named.begin(), trust.named.end(), [&](const fs::path& file) {
        std::error_code problem;
        return fs::equivalent(file, path, problem);
    });
}

// Whether somebody allowed it. A picture that is made again carries what is read and writes nothing.
bool is_allowed(const FileUse& use, const Trust& trust) {
    if (use.path.empty() || trust.files != Trust::Files::refused || (is_named(use.path, trust) && !use.writes))
        return true;
    const auto answer = trust.answered.find(want(use.path, use.writes));
    return answer != trust.answered.end() && answer->second;
}

bool would_overwrite(const FileUse& use, const Trust& trust) {
    std::error_code problem;
    return use.writes && trust.files != Trust::Files::imagined && fs::exists(use.path, problem);
}

// Throws Forbidden where the command sets an option beyond the budget.
void check_work(const Command& command, const Budget* budget) {
    const auto* use = std::get_if<command::UseOption>(&command);
    if (use == nullptr || budget == nullptr) return;
    Options options;
    const std::span<const Option> rows = options_set_by(use->name);
    for (std::size_t i = 0; i < use->values.size(); ++i)
        if (allows(rows[i], use->values[i])) rows[i].set(options, use->values[i]);
    budget->check(options);
}

void drop_overwrite(Command& command) {
    if (auto* save = std::get_if<command::Save>(&command)) save->overwrite = false;
    if (auto* taken = std::get_if<command::Export>(&command)) taken->overwrite = false;
}

}  // namespace

std::vector<Command> parse_journal(std::string_view text, const std::string& name) {
    std::vector<Command> commands;
    for_each_command(text, name,
                     [&](Command command, int, std::string_view) { commands.push_back(std::move(command)); });
    return commands;
}

Trust trust_of(bool allow_files, std::vector<fs::path> named, const Options& typed) {
    Trust trust{allow_files ? Trust::Files::allowed : Trust::Files::refused, std::move(named)};
    if (allow_files) return trust;
    trust.budget = std::make_shared<Budget>("if you trust it: --allow-files");
    trust.budget->allow(typed);
    return trust;
}

std::string want(const std::string& file, bool writes) {
    std::error_code problem;
    return (writes ? "write " : "read ") + fs::absolute(file, problem).lexically_normal().string();
}

std::optional<bool> may_read(const std::string& file, const Trust& trust) {
    if (is_allowed({file}, trust)) return true;
    return trust.answered.contains(want(file, false)) ? std::optional(false) : std::nullopt;
}

std::vector<Command> parse_trusted(std::string_view text, const std::string& name, const Trust& trust) {
    std::vector<Command> commands;
    std::optional<Forbidden> refused;
    std::set<std::string> wanted;
    if (trust.budget) trust.budget->limit();
    for_each_command(text, name, [&](Command command, int number, std::string_view line) {
        const Location at{number, static_cast<int>(line.find_first_not_of(" \t")) + 1};
        if (commands.size() == most_replayed)
            throw Forbidden(name, at, fmt::format("a session replays at most {} commands", most_replayed));
        const FileUse use = file_use(command);
        const auto refuse = [&](const std::string& reason, const char* hint) {
            if (!refused) refused.emplace(name, at, reason, hint, std::string(line));
        };
        if (!is_allowed(use, trust)) {
            refuse(fmt::format("this journal would {} {}", use.writes ? "write" : "read", use.path),
                   "if you trust it: --allow-files");
            if (wanted.insert(want(use.path, use.writes)).second) refused->wants.push_back(want(use.path, use.writes));
        } else if (would_overwrite(use, trust)) {
            refuse(fmt::format("the file {} already exists, and a journal never overwrites files", use.path),
                   "save or export to another file");
        }
        try {
            check_work(command, trust.budget.get());
        } catch (const Forbidden& problem) {
            refuse(problem.message, problem.hint.c_str());
        }
        drop_overwrite(command);
        commands.push_back(std::move(command));
    });
    if (refused) throw Forbidden(*refused);
    return commands;
}

std::vector<Command> parse_steps(const std::vector<std::string>& lines) {
    std::vector<Command> commands;
    for (const std::string& line : lines)
        if (!is_blank(line)) commands.push_back(parse_command(line, "--do", 1));
    return commands;
}

std::string journal_file(const std::filesystem::path& file) {
    std::string text = read_text(file);
    if (text.size() > largest_file) throw InputError(file.string(), {}, "this file is too large for a journal");
    return text;
}

std::vector<Command> read_journal(const std::filesystem::path& file) {
    return parse_journal(journal_file(file), file.string());
}

std::string journal_text(const std::vector<Command>& commands) {
    std::string text;
    for (const Command& command : commands) text += to_text(command) + "\n";
    return text;
}

void refuse_record(const fs::path& file) {
    std::error_code problem;
    const fs::file_status there = fs::symlink_status(file, problem);
    if (fs::exists(there) && !fs::is_character_file(there))
        throw InputError(file.string(), {}, "the file already exists, and a recording never overwrites files",
                         "record to another file");
}

JournalFile::JournalFile(const fs::path& file) : path_(file) {
    refuse_record(file);
    stream_.open(file, std::ios::binary);
    if (!stream_) throw InputError(file.string(), {}, "the journal cannot be written");
}

void JournalFile::append(const Command& command) {
    before_ = stream_.tellp();
    stream_ << to_text(command) << '\n' << std::flush;
    if (!stream_) throw InputError(path_.string(), {}, "the journal cannot be written", "is the disk full?");
}

void JournalFile::take_back() {
    if (before_ < 0 || fs::is_character_file(path_)) return;
    fs::resize_file(path_, static_cast<std::uintmax_t>(before_));
    stream_.seekp(before_);
}

}  // namespace achilles
