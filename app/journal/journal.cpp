#include "journal/journal.hpp"

#include "journal/words.hpp"

namespace achilles {

std::vector<Command> parse_journal(std::string_view text, const std::string& name) {
    std::vector<Command> commands;
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        ++number;
        if (!is_blank(line)) commands.push_back(parse_command(line, name, number));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
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
    if (text.size() > largest_file) throw InputError(file.string(), {}, "this is too large for a journal");
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

JournalFile::JournalFile(const std::filesystem::path& file) : path_(file), stream_(file, std::ios::binary) {
    if (!stream_) throw InputError(file.string(), {}, "the journal cannot be written");
}

void JournalFile::append(const Command& command) {
    stream_ << to_text(command) << '\n' << std::flush;
    if (!stream_) throw InputError(path_.string(), {}, "the journal cannot be written", "is the disk full?");
}

}  // namespace achilles
