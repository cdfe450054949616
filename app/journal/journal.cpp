#include "journal/journal.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "cli/assets.hpp"
#include "expression/parse.hpp"
#include "journal/link.hpp"

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
    if (replay != nullptr && !is_link(replay->journal) && is_journal_path(replay->journal)) return {replay->journal};
    return {};
}

bool is_named(const std::string& path, const FilePolicy& trust) {
    return std::any_of(trust.named.begin(), trust.named.end(), [&](const fs::path& file) {
        std::error_code problem;
        return fs::equivalent(file, path, problem);
    });
}

// Whether this use is allowed. While a picture is reproduced everything is: it supplies all inputs and nothing is
// written.
bool is_allowed(const FileUse& use, const FilePolicy& trust) {
    if (use.path.empty() || trust.files != FilePolicy::Files::refused || (is_named(use.path, trust) && !use.writes))
        return true;
    const auto answer = trust.answered.find(access_request(use.path, use.writes));
    return answer != trust.answered.end() && answer->second;
}

bool would_overwrite(const FileUse& use, const FilePolicy& trust) {
    std::error_code problem;
    return use.writes && trust.files != FilePolicy::Files::virtual_only && fs::exists(use.path, problem);
}

// Throws PermissionDenied if the command sets an option beyond the budget.
void check_work(const Command& command, const Budget* budget) {
    const auto* use = std::get_if<command::SetOption>(&command);
    if (use == nullptr || budget == nullptr) return;
    Options options;
    const std::span<const Option> rows = options_set_by(use->name);
    for (std::size_t i = 0; i < use->values.size(); ++i)
        if (is_valid_value(rows[i], use->values[i])) rows[i].set(options, use->values[i]);
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

FilePolicy trust_of(bool allow_files, std::vector<fs::path> named, const Options& typed, const char* how_to_allow) {
    FilePolicy trust{allow_files ? FilePolicy::Files::allowed : FilePolicy::Files::refused, std::move(named)};
    if (allow_files) return trust;
    trust.budget = std::make_shared<Budget>(how_to_allow);
    trust.budget->allow(typed);
    return trust;
}

std::string access_request(const std::string& file, bool writes) {
    std::error_code problem;
    return (writes ? "write " : "read ") + fs::absolute(file, problem).lexically_normal().string();
}

std::optional<bool> may_read(const std::string& file, const FilePolicy& trust) {
    if (is_allowed({file}, trust)) return true;
    return trust.answered.contains(access_request(file, false)) ? std::optional(false) : std::nullopt;
}

std::vector<Command> parse_trusted(std::string_view text, const std::string& name, const FilePolicy& trust) {
    std::vector<Command> commands;
    std::optional<PermissionDenied> refused;
    std::set<std::string> requested;
    if (trust.budget) trust.budget->limit();
    for_each_command(text, name, [&](Command command, int number, std::string_view line) {
        const Location at{number, static_cast<int>(line.find_first_not_of(" \t")) + 1};
        if (commands.size() == max_replayed)
            throw PermissionDenied(name, at, fmt::format("a session replays at most {} commands", max_replayed));
        const FileUse use = file_use(command);
        const auto refuse = [&](const std::string& reason, const char* hint) {
            if (!refused) refused.emplace(name, at, reason, hint, std::string(line));
        };
        if (!is_allowed(use, trust)) {
            refuse(fmt::format("this journal would {} {}", use.writes ? "write" : "read", use.path),
                   "if you trust it: --allow-files");
            if (requested.insert(access_request(use.path, use.writes)).second)
                refused->requests.push_back(access_request(use.path, use.writes));
        } else if (would_overwrite(use, trust)) {
            refuse(fmt::format("the file {} already exists, and a journal never overwrites files", use.path),
                   "save or export to another file");
        }
        try {
            check_work(command, trust.budget.get());
        } catch (const PermissionDenied& problem) {
            refuse(problem.message, problem.hint.c_str());
        }
        drop_overwrite(command);
        commands.push_back(std::move(command));
    });
    if (refused) throw PermissionDenied(*refused);
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

namespace {

bool says(const Command& command) {
    const auto* say = std::get_if<command::Say>(&command);
    return say != nullptr && !say->text.empty();
}

template <class Commands>
std::size_t sentences_in(const Commands& commands) {
    return static_cast<std::size_t>(std::count_if(commands.begin(), commands.end(), says));
}

bool is_repeatable(const Command& command) {
    return !std::holds_alternative<command::Save>(command) && !std::holds_alternative<command::Export>(command) &&
           !std::holds_alternative<command::Copy>(command) && !std::holds_alternative<command::Replay>(command);
}

}  // namespace

void Tour::keep(const Command& command) {
    const auto* wait = std::get_if<command::Wait>(&command);
    auto* const last = done_.empty() ? nullptr : std::get_if<command::Wait>(&done_.back());
    if (wait != nullptr && last != nullptr)
        last->seconds += wait->seconds;
    else
        done_.push_back(command);
}

std::vector<Command> Tour::advance(double seconds) {
    std::vector<Command> due;
    while (!left_.empty()) {
        auto* const wait = std::get_if<command::Wait>(&left_.front());
        if (wait == nullptr) {
            due.push_back(left_.front());
            keep(left_.front());
            left_.pop_front();
            if (std::holds_alternative<command::Replay>(due.back())) break;  // the commands of that journal come first
            continue;
        }
        const double passed = std::min(wait->seconds, seconds);
        if (passed > 0.0) keep(due.emplace_back(command::Wait{passed}));
        seconds -= passed;
        wait->seconds -= passed;
        if (wait->seconds > 0.0) break;
        left_.pop_front();
    }
    return due;
}

std::vector<Command> Tour::next() {
    if (left_.empty() || !std::holds_alternative<command::Wait>(left_.front())) return {};
    const Command rest = left_.front();
    keep(rest);
    left_.pop_front();
    return {rest};
}

std::size_t Tour::captions_shown() const { return sentences_in(done_); }
std::size_t Tour::sentences() const { return captions_shown() + sentences_in(left_); }

void Tour::begin(const std::vector<Command>& journal) {
    const bool is_named = !done_.empty() && std::holds_alternative<command::Replay>(done_.back());
    if (is_named)
        done_.pop_back();
    else if (left_.empty())
        done_.clear();  // those of a finished tour
    left_.insert(left_.begin(), journal.begin(), journal.end());
}

std::vector<Command> Tour::back() {
    const std::size_t now = captions_shown();
    if (now < 2) return {};
    auto from = done_.begin();
    for (std::size_t count = 0; from != done_.end(); ++from)
        if (says(*from) && ++count == now - 1) break;
    // Restore a wait that had partly elapsed.
    auto* const rest = left_.empty() ? nullptr : std::get_if<command::Wait>(&left_.front());
    auto* const passed = std::get_if<command::Wait>(&done_.back());
    if (rest != nullptr && passed != nullptr) {
        passed->seconds += rest->seconds;
        left_.pop_front();
    }
    left_.insert(left_.begin(), from, done_.end());
    done_.erase(from, done_.end());
    std::vector<Command> again;
    std::copy_if(done_.begin(), done_.end(), std::back_inserter(again), is_repeatable);
    return again;
}

namespace {

constexpr std::string_view spaces = " \t\r";

// Characters that would end the line or the word, and their escape letters (\n).
constexpr std::array<std::pair<char, char>, 3> escapes{{{'n', '\n'}, {'t', '\t'}, {'r', '\r'}}};

char escaped_character(char letter) {
    for (const auto& [written, meant] : escapes)
        if (written == letter) return meant;
    return letter;
}

std::size_t skip_space(std::string_view text, std::size_t at) {
    return std::min(text.find_first_not_of(spaces, at), text.size());
}

}  // namespace

JournalLine::JournalLine(std::string_view text, const std::string& file, int number)
    : text_(text), file_(file), number_(number) {
    for (std::size_t at = skip_space(text, 0); at < text.size() && text[at] != '#'; at = skip_space(text, at)) {
        const int column = static_cast<int>(at) + 1;
        words_.push_back({text[at] == '"' ? quoted(at) : plain(at), column});
    }
}

InputError JournalLine::error(int column, const std::string& message, const std::string& hint) const {
    return {file_, {number_, column}, message, hint, std::string(text_)};
}

void JournalLine::expect_arguments(std::size_t least, std::size_t most, const std::string& usage) const {
    const int end = static_cast<int>(text_.find_last_not_of(spaces)) + 2;
    if (count() < least + 1) throw error(end, fmt::format("'{}' needs more arguments", words_[0].text), usage);
    if (count() > most + 1)
        throw error(words_[most + 1].column, fmt::format("unexpected argument '{}'", words_[most + 1].text), usage);
}

double JournalLine::number(std::size_t i) const {
    try {
        return read_number(words_[i].text).value;
    } catch (const ParseError& problem) {
        throw error(words_[i].column, problem.what());
    }
}

int JournalLine::whole_number(std::size_t i) const {
    const double value = number(i);
    if (value != std::floor(value) || std::abs(value) > 1e9)
        throw error(words_[i].column, fmt::format("'{}' is not a whole number", words_[i].text));
    return static_cast<int>(value);
}

std::string JournalLine::plain(std::size_t& at) const {
    const std::size_t begin = at;
    at = std::min(text_.find_first_of(spaces, at), text_.size());
    return std::string(text_.substr(begin, at - begin));
}

std::string JournalLine::quoted(std::size_t& at) const {
    const int column = static_cast<int>(at) + 1;
    std::string result;
    for (++at; at < text_.size() && text_[at] != '"'; ++at) {
        const bool escaped = text_[at] == '\\' && at + 1 < text_.size();
        if (escaped) ++at;
        result += escaped ? escaped_character(text_[at]) : text_[at];
    }
    if (at == text_.size()) throw error(column, "the quotes are not closed");
    ++at;
    return result;
}

std::string quoted(const std::string& word) {
    std::string text = "\"";
    for (const char c : word) {
        const auto* special =
            std::find_if(escapes.begin(), escapes.end(), [c](const auto& e) { return e.second == c; });
        if (special != escapes.end() || c == '"' || c == '\\') text += '\\';
        text += special != escapes.end() ? special->first : c;
    }
    return text + '"';
}

std::string quoted_where_needed(const std::string& word) {
    const bool is_plain = !word.empty() && word[0] != '#' && word.find_first_of(" \t\r\n\"\\") == std::string::npos;
    return is_plain ? word : quoted(word);
}

bool is_blank(std::string_view line) {
    const std::size_t first = skip_space(line, 0);
    return first == line.size() || line[first] == '#';
}

}  // namespace achilles
