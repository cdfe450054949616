#include "session/command_search.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "journal/journal.hpp"
#include "session/command.hpp"

namespace achilles {

namespace {

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool begins_word(const std::string& text, std::size_t at) {
    return at == 0 || std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0;
}

std::string first_word(const std::string& line) { return line.substr(0, line.find(' ')); }

// Matches sorted by rank; non-matches are left out.
class MatchRanking {
 public:
    void offer(int match_rank, CommandMatch found) {
        if (match_rank >= 0) all_.emplace_back(match_rank, std::move(found));
    }
    std::vector<CommandMatch> take() {
        std::stable_sort(all_.begin(), all_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<CommandMatch> result;
        for (auto& [match_rank, found] : all_) result.push_back(std::move(found));
        return result;
    }

 private:
    std::vector<std::pair<int, CommandMatch>> all_;
};

int match_rank(const std::string& typed, const std::string& name, const std::string& more) {
    constexpr int apart = 4, around = 1000;
    const int in_name = achilles::match_rank(typed, name), in_more = achilles::match_rank(typed, more);
    return in_name >= 0 ? in_name : in_more >= 0 && in_more < apart ? around + in_more : -1;
}

// Whether a line is a complete command.
bool is_command(const std::string& line) {
    try {
        parse_command(line);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace

int match_rank(const std::string& typed, const std::string& text) {
    const std::string a = lower(typed), b = lower(text);
    if (a == b) return 0;
    const std::size_t at = b.find(a);
    if (at == 0) return 1;
    for (std::size_t i = at; i != std::string::npos; i = b.find(a, i + 1))
        if (begins_word(b, i)) return 2;
    if (at != std::string::npos) return 3;
    std::size_t from = 0, first = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        from = b.find(a[i], from);
        if (from == std::string::npos) return -1;
        if (i == 0) first = from;
        ++from;
    }
    return static_cast<int>(4 + from - first - a.size());
}

int words_rank(const std::string& typed, const std::string& text) {
    const std::string all = lower(text);
    int rank = 0;
    std::istringstream words(lower(typed));
    for (std::string word; words >> word;) {
        std::size_t at = all.find(word);
        while (at != std::string::npos && !begins_word(all, at)) at = all.find(word, at + 1);
        if (at == std::string::npos) return -1;
        if (at > 0) ++rank;
    }
    return rank;
}

std::vector<CommandMatch> find_commands(const std::string& typed, const std::vector<Completions>& completions) {
    MatchRanking best;
    const std::size_t space = typed.find(' ');
    const std::string name = typed.substr(0, space);
    if (space == std::string::npos) {
        for (const std::string& usage : command_usages()) {
            const std::string its_name = first_word(usage);
            // Whether or not arguments are possible: a command that needs none is complete.
            const std::string line = is_command(usage) ? usage : its_name;
            const bool alone = is_command(line);
            best.offer(typed.empty() ? 0 : match_rank(typed, its_name, usage),
                       {usage, alone ? line : line + " ", alone});
        }
        return best.take();
    }
    const std::string value = typed.substr(space + 1);
    if (value.find(' ') != std::string::npos) return {};
    for (const Completions& some : completions) {
        if (some.command != name) continue;
        for (const auto& [word, about] : some.values) {
            std::string line = name + " " + quoted_where_needed(word);
            std::string shown = line;
            if (!about.empty()) shown.append("    ").append(about);
            if (!some.is_last) line += ' ';
            best.offer(value.empty() ? 0 : match_rank(value, word, about), {shown, line, some.is_last});
        }
    }
    return best.take();
}

std::vector<CommandMatch> find_anything(const std::string& typed, const std::vector<NamedEntry>& entries,
                                        const std::vector<Completions>& completions) {
    const bool has_arguments = typed.find(' ') != std::string::npos;
    std::vector<CommandMatch> commands = find_commands(typed, completions), found;
    if (has_arguments) found = std::move(commands);  // arguments that complete the line
    MatchRanking titles, best;                       // entries that begin with what was typed, and the others
    constexpr int after_label = 100;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const NamedEntry& entry = entries[i];
        const int by_label = words_rank(typed, entry.label), by_words = words_rank(typed, entry.words);
        const CommandMatch match{entry.syntax, entry.line, entry.runs, entry.label, static_cast<int>(i)};
        const int beginning = match_rank(typed, entry.label);
        if (has_arguments && (beginning == 0 || beginning == 1))
            titles.offer(0, match);
        else
            best.offer(by_label >= 0 ? by_label : by_words >= 0 ? after_label + by_words : -1, match);
    }
    const auto add = [&](std::vector<CommandMatch> more) {
        for (CommandMatch& match : more) found.push_back(std::move(match));
    };
    add(titles.take());
    const bool is_there = std::any_of(found.begin(), found.end(), [&](const auto& one) { return one.line == typed; });
    if (has_arguments && !is_there && is_command(typed)) found.push_back({usage_of(typed), typed, true, typed});
    add(best.take());
    if (!has_arguments) add(std::move(commands));
    return found;
}

std::string usage_of(const std::string& line) {
    const std::string name = first_word(line);
    for (const std::string& usage : command_usages())
        if (first_word(usage) == name) return usage;
    return {};
}

}  // namespace achilles
