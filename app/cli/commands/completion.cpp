// Completion of a command line in bash. A short script asks this program, which answers from its own tables: commands,
// options and their values, the gallery, and the names of the system that was typed.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/manual.hpp"
#include "system/description.hpp"

namespace achilles {

namespace {

// The program answers with the endings of files that fit ("*": any file), the word to complete without quotes, and the
// other words that fit, quoted for the shell.
constexpr const char* bash_script =
    R"(# Completion of achilles in bash; installed by the package, or: source <(achilles completion)
_achilles() {
    local answer file
    COMPREPLY=()
    mapfile -t answer < <("$1" completion -- "${COMP_LINE:0:COMP_POINT}" "$2" 2>/dev/null)
    [ "${#answer[@]}" -ge 2 ] || return 0
    COMPREPLY=("${answer[@]:2}")
    [[ ${COMPREPLY[0]:-} != *= ]] || compopt -o nospace
    [ -n "${answer[0]}" ] || return 0
    compopt -o filenames
    while IFS= read -r file; do
        if [ -d "${file/#\~\//$HOME/}" ] || [[ " ${answer[0]} " == *" * "* ]] ||
            [[ " ${answer[0]} " == *" ${file##*.} "* ]]; then
            COMPREPLY+=("$file")
        fi
    done < <(compgen -f -- "${answer[1]}")
}
complete -F _achilles achilles
)";

// The words of a command line up to the cursor, without quotes; the last one is to be completed.
struct TypedLine {
    std::vector<std::string> words{""};
    char quote = 0;  // the quotation mark that is open at the end, or 0
};

TypedLine typed_line(std::string_view text) {
    TypedLine line;
    bool is_word = false;  // after spaces a new word begins
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        std::string& word = line.words.back();
        if (line.quote == 0 && (c == ' ' || c == '\t')) {
            if (is_word) line.words.emplace_back();
            is_word = false;
            continue;
        }
        is_word = true;
        if (c == '\\' && line.quote != '\'' && i + 1 < text.size())
            word += text[++i];
        else if (c == line.quote)
            line.quote = 0;
        else if (line.quote == 0 && (c == '"' || c == '\''))
            line.quote = c;
        else
            word += c;
    }
    return line;
}

struct Completions {
    std::vector<std::string> words;
    std::string endings;  // of files, separated by spaces
    void add(const std::vector<std::string>& more) { words.insert(words.end(), more.begin(), more.end()); }
};

std::vector<std::string> journal_names() {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : journal_files()) names.push_back(file.stem().string());
    return names;
}

// What stands for a value in --help: NAME=VALUE, png|svg|pdf, F.png|DIR; of an argument its name.
std::string value_kind(const CLI::Option& option) {
    const std::string type = option.get_positional() ? option.get_name() : option.get_type_name();
    return type.substr(0, type.find(":{"));  // CLI11 appends the choices
}

void add_names(const std::string& kind, const std::vector<std::string>& words, Completions& found) {
    const std::optional<SystemDescription> system = named_system(words);
    if (!system) return;
    if (kind == "NAME")
        for (const ViewDescription& view : system->views) found.words.push_back(view.name);
    else
        for (const std::string& name : settable_names(*system)) found.words.push_back(name + "=");
}

void add_values(const CLI::Option& option, const CLI::App& program, const std::vector<std::string>& words,
                Completions& found) {
    const std::string kinds = value_kind(option);
    for (std::size_t begin = 0; begin <= kinds.size();) {
        const std::size_t end = std::min(kinds.find('|', begin), kinds.size());
        const std::string kind = kinds.substr(begin, end - begin);
        begin = end + 1;
        if (kind == "SYSTEM") {
            found.add(system_names());
            found.endings += "toml ";
        } else if (kind == "TOPIC") {
            for (const ManualTopic& topic : manual_topics()) found.words.push_back(topic.name);
            found.add(command_names(program));
        } else if (kind == "TOUR") {
            found.add(journal_names());
        } else if (kind == "PICTURE") {
            found.endings += "png svg pdf ";
        } else if (kind == "BEFORE" || kind == "AFTER") {
            found.endings += "png ";
        } else if (kind == "F" || kind == "FILE") {
            found.endings += "* ";
        } else if (kind.starts_with("F.")) {
            found.endings += kind.substr(2) + " ";
        } else if (kind == "DIR") {
            found.endings += "/ ";  // folders always fit
        } else if (kind.starts_with("NAME=") || (kind == "NAME" && !option.get_positional())) {
            add_names(kind, words, found);
        } else if (!kind.empty() && std::islower(static_cast<unsigned char>(kind[0])) != 0) {
            found.words.push_back(kind);  // a choice
        }
    }
}

// The option that a word names; null for another word, even if it is the name of an option without dashes.
const CLI::Option* typed_option(const CLI::App& command, const std::string& word) {
    return word.starts_with("--") ? option_of(command, std::string_view(word).substr(2)) : nullptr;
}

// The argument that follows these words of a command; null if it has all.
const CLI::Option* next_argument(const CLI::App& command, const std::vector<std::string>& words) {
    std::vector<const CLI::Option*> arguments;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional()) arguments.push_back(option);
    std::size_t given = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const CLI::Option* option = typed_option(command, words[i]);
        if (option != nullptr)
            i += option->get_items_expected_max() > 0 ? 1 : 0;
        else
            given += words[i].starts_with("-") ? 0 : 1;  // --end=5 has its value
    }
    return given < arguments.size() ? arguments[given] : nullptr;
}

Completions find_completions(const CLI::App& program, std::vector<std::string> words) {
    Completions found;
    const std::string current = words.back();
    words.pop_back();
    const std::vector<std::string> commands = command_names(program);
    const CLI::App* command = &program;
    if (!words.empty() && std::find(commands.begin(), commands.end(), words.front()) != commands.end())
        command = program.get_subcommand(words.front());
    else if (!words.empty() || current.starts_with("-"))
        command = program.get_subcommand(default_command);
    const bool is_named = !words.empty() && command->get_name() == words.front();
    const std::vector<std::string> rest(words.begin() + (is_named ? 1 : 0), words.end());
    const std::size_t equals = current.find('=');
    if (current.starts_with("--") && equals != current.npos) {
        if (const CLI::Option* option = typed_option(*command, current.substr(0, equals))) {
            add_values(*option, program, words, found);
            for (std::string& word : found.words) word.insert(0, current.substr(0, equals + 1));
        }
        return found;
    }
    const CLI::Option* before = rest.empty() ? nullptr : typed_option(*command, rest.back());
    if (before != nullptr && before->get_items_expected_max() > 0) {
        add_values(*before, program, words, found);
        return found;
    }
    if (current.starts_with("-")) {
        for (const CLI::App* one :
             words.empty() ? std::vector<const CLI::App*>{&program, command} : std::vector<const CLI::App*>{command})
            for (const CLI::Option* option : one->get_options())
                for (const std::string& name : option->get_lnames())
                    if (!option->get_group().empty()) found.words.push_back("--" + name);  // else it is hidden
        return found;
    }
    if (words.empty()) found.add(commands);
    const CLI::App* typed = words.empty() ? program.get_subcommand(default_command) : command;
    if (const CLI::Option* argument = next_argument(*typed, rest)) add_values(*argument, program, words, found);
    return found;
}

// Escapes what the shell would interpret; within quotation marks nothing that is completed has a meaning.
std::string quoted(const std::string& word, char quote) {
    std::string text;
    for (const char c : word) {
        if (quote == 0 && std::string_view(" \t'\"\\$`;|&<>()*?![]#~{}").find(c) != std::string_view::npos)
            text += '\\';
        text += c;
    }
    return text;
}

// The answer to the script. bash replaces only the part of a word behind its last '=' or ':', which is `part`.
std::string answer(const CLI::App& program, const std::string& text, const std::string& part) {
    TypedLine line = typed_line(text);
    if (line.words.size() < 2) return "";
    line.words.erase(line.words.begin());
    const std::string current = line.words.back(), behind = typed_line(part).words.back();
    const std::size_t kept = current.ends_with(behind) ? current.size() - behind.size() : 0;
    Completions found = find_completions(program, line.words);
    std::sort(found.words.begin(), found.words.end());
    found.words.erase(std::unique(found.words.begin(), found.words.end()), found.words.end());
    std::string result =
        fmt::format("{}\n{}\n", found.endings.substr(0, found.endings.find_last_not_of(' ') + 1), behind);
    for (const std::string& word : found.words) {
        // Within apostrophes a rate x' cannot be typed.
        if (line.quote == '\'' && word.find('\'') != word.npos) continue;
        if (word.starts_with(current) && word.size() > kept) result += quoted(word.substr(kept), line.quote) + "\n";
    }
    return result;
}

}  // namespace

void add_completion(CLI::App& program, int& status) {
    CLI::App* command =
        program.add_subcommand("completion", "Prints the completion script for bash: source <(achilles completion)");
    const auto line = std::make_shared<std::string>(), word = std::make_shared<std::string>();
    command->add_option("LINE", *line, "for the script: -- LINE WORD prints what completes WORD at the end of LINE")
        ->type_name("");
    command->add_option("WORD", *word, "the part of the last word of LINE that bash replaces")->type_name("");
    command->callback([line, word, &program, &status] {
        const std::string text = line->empty() ? bash_script : answer(program, *line, *word);
        std::fwrite(text.data(), 1, text.size(), stdout);
        status = reached_end;
    });
}

}  // namespace achilles
