#include "cli/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "cli/assets.hpp"
#include "expression/expression.hpp"
#include "expression/name_suggestions.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "panels/actions.hpp"
#include "session/command.hpp"
#include "session/glossary.hpp"
#include "simulate/simulate.hpp"
#include "system/input_error.hpp"
#include "system/keys.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

// A Markdown table with padded columns, so that it is readable as plain text.
std::string table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows[0].size(), 3);
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    const auto write = [&](const std::vector<std::string>& row) {
        text += "|";
        for (std::size_t i = 0; i < row.size(); ++i) text += fmt::format(" {:<{}} |", row[i], widths[i]);
        text += "\n";
    };
    write(rows[0]);
    std::vector<std::string> rule;
    for (const std::size_t width : widths) rule.emplace_back(width, '-');
    write(rule);
    std::for_each(rows.begin() + 1, rows.end(), write);
    return text;
}

std::string keys_table(std::string_view heading) {
    std::vector<std::vector<std::string>> rows{{"key", "allowed values", "meaning"}};
    for (const FileTable& keys : file_tables()) {
        if (keys.heading != heading) continue;
        for (const FileKey& key : keys.keys)
            rows.push_back({fmt::format("`{}`", key.name), std::string(key.value), std::string(key.about)});
    }
    return table(rows);
}

std::string shapes_table() {
    std::vector<std::vector<std::string>> rows{{"shape", "key", "allowed values", "meaning"}};
    for (const FileTable& keys : file_tables())
        if (!keys.heading.empty() && keys.heading.front() != '[')
            for (const FileKey& key : keys.keys)
                rows.push_back({fmt::format("`{}`", keys.heading), fmt::format("`{}`", key.name),
                                std::string(key.value), std::string(key.about)});
    return table(rows);
}

std::string options_table() {
    std::vector<std::vector<std::string>> rows{{"key", "table", "flag", "explorer command", "default", "meaning"}};
    for (const Option& option : all_options()) {
        const std::string choice = option.words.empty() ? "" : fmt::format(" ({})", fmt::join(option.words, " or "));
        const std::string unit = option.unit.empty() ? "" : fmt::format(", {}", option.unit);
        rows.push_back({fmt::format("`{}`", option.key), fmt::format("[{}]", option.table),
                        fmt::format("`{}`", option.flag), fmt::format("`{}`", option.command), to_text(option.get({})),
                        fmt::format("{}{}{}", option.help, unit, choice)});
    }
    return table(rows);
}

std::string functions_line() {
    std::vector<std::string_view> names;
    for (const Function& function : functions) names.push_back(function.name);
    return fmt::format("    {}\n", fmt::join(names, " "));
}

std::string commands_list() { return fmt::format("    {}\n", fmt::join(command_usages(), "\n    ")); }

std::string words_table() {
    std::vector<std::vector<std::string>> rows{{"word", "formula", "meaning", "source"}};
    for (const GlossaryTerm& term : glossary())
        rows.push_back({std::string(term.word), term.formula.empty() ? "" : fmt::format("`{}`", term.formula),
                        std::string(term.meaning), std::string(term.source)});
    return table(rows);
}

std::string shortcuts_table() {
    std::vector<std::vector<std::string>> rows{{"in", "keys, mouse", "action"}};
    for (const Shortcut& shortcut : shortcuts())
        rows.push_back({shortcut.group == "Keys" ? "" : std::string(shortcut.group), std::string(shortcut.keys),
                        std::string(shortcut.does)});
    return table(rows);
}

std::string csv_header() {
    const auto model = std::make_shared<const Model>(read_system(find_system("ball_on_sine")));
    Run run = model->default_run();
    run.options.end_time = 1e-3;
    const std::string csv = to_csv(simulate(model, run));
    return fmt::format("    {}\n", csv.substr(0, csv.find('\n')));
}

// The replacement of a line {{NAME}}.
std::string expanded(std::string_view name) {
    constexpr std::string_view keys = "keys ";
    if (name.starts_with(keys)) return keys_table(name.substr(keys.size()));
    if (name == "keys") return keys_table("");
    if (name == "shapes") return shapes_table();
    if (name == "options") return options_table();
    if (name == "functions") return functions_line();
    if (name == "commands") return commands_list();
    if (name == "words") return words_table();
    if (name == "shortcuts") return shortcuts_table();
    if (name == "csv") return csv_header();
    throw InputError("manual", {}, fmt::format("there is no table '{}'", name));
}

std::string title_of(const fs::path& page) {
    const std::string text = read_text(page);
    const std::size_t begin = text.find_first_not_of("# ");
    return begin == std::string::npos ? "" : text.substr(begin, text.find('\n') - begin);
}

// The two pages in which a word occurs most often, tables included, ignoring case.
std::vector<std::string> pages_about(std::string_view word) {
    constexpr std::size_t most = 2;
    const auto lower = [](std::string text) {
        for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return text;
    };
    const std::string wanted = lower(std::string(word));
    std::vector<std::pair<std::size_t, std::string>> counts;
    for (const fs::path& page : manual_files()) {
        const std::string name = page.stem().string(), text = lower(manual_page(name));
        std::size_t count = 0;
        for (std::size_t at = text.find(wanted); at != text.npos; at = text.find(wanted, at + wanted.size())) ++count;
        if (count > 0) counts.emplace_back(count, name);
    }
    std::sort(counts.rbegin(), counts.rend());
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(counts.size(), most); ++i) names.push_back(counts[i].second);
    return names;
}

}  // namespace

std::vector<ManualTopic> manual_topics() {
    std::vector<ManualTopic> topics;
    for (const fs::path& page : manual_files()) topics.push_back({page.stem().string(), title_of(page)});
    return topics;
}

std::string manual_page(std::string_view topic) {
    std::vector<std::string> known;
    for (const fs::path& page : manual_files()) {
        known.push_back(page.stem().string());
        if (known.back() != topic) continue;
        const std::string text = read_text(page);
        std::string result;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t end = std::min(text.find('\n', at), text.size());
            const std::string_view line(text.data() + at, end - at);
            at = end + 1;
            if (line.starts_with("{{") && line.ends_with("}}"))
                result += expanded(line.substr(2, line.size() - 4));
            else
                result += std::string(line) + "\n";
        }
        return result;
    }
    const std::vector<std::string> pages = pages_about(topic);
    const std::string meant = did_you_mean(topic, known);
    throw InputError({}, {},
                     fmt::format("there is no topic '{}'{}", shown(topic),
                                 !pages.empty()   ? fmt::format("; it is explained in achilles help {}",
                                                                fmt::join(pages, ", or achilles help "))
                                 : !meant.empty() ? meant
                                                  : fmt::format("; the topics are {}", fmt::join(known, ", "))));
}

std::string skeleton_system() { return read_text(assets() / "manual" / "skeleton.toml"); }
std::string skeleton_of_bodies() { return read_text(assets() / "manual" / "skeleton_body.toml"); }

}  // namespace achilles
