// Reading and printing of commands, and the rule for merging undo steps, derived from the self-descriptions.
#include "session/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <concepts>
#include <optional>
#include <utility>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "journal/journal.hpp"

namespace achilles {

Command::Command(const Command& other) = default;
Command::Command(Command&& other) noexcept = default;
Command& Command::operator=(const Command& other) = default;
Command& Command::operator=(Command&& other) noexcept = default;
Command::~Command() = default;

namespace command {

SetOption::SetOption(std::string_view command, std::vector<OptionValue> for_each)
    : name(command), values(std::move(for_each)) {}

SetOption::SetOption(const Option& option, const Options& as_there) : name(option.command) {
    for (const Option& o : options_set_by(name)) values.push_back(o.get(as_there));
}

bool SetOption::sets_single_value() const {
    return std::all_of(values.begin(), values.end(), [&](const OptionValue& value) { return value == values[0]; });
}

namespace {

template <class... Values>
std::string filled(std::string_view text, const Values&... values) {
    return fmt::format(fmt::runtime(text), values...);
}

// ---- one value of a line ----

using Words = std::vector<std::string>;
using Values = std::vector<std::pair<std::string, ValueArgument>>;

// Parser position: the current word, and the error text for a malformed line.
struct WordReader {
    const JournalLine& line;
    std::string usage;
    std::size_t at = 1;

    bool at_end() const { return at == line.count(); }
    const std::string& word() const { return line.word(at).text; }
    InputError error(const std::string& message, const std::string& hint) const {
        return line.error(line.word(at).column, message, hint);
    }
    InputError error(const std::string& message) const { return error(message, usage); }
};

void read(std::string& word, const FieldFormat& how, WordReader& from) {
    if (how.may_lack && from.at_end()) return;
    if (how.one_of && std::find(how.one_of->begin(), how.one_of->end(), from.word()) == how.one_of->end())
        throw from.error(filled(how.complaint, from.word(), did_you_mean(from.word(), *how.one_of)),
                         how.known.empty() ? from.usage : filled(how.known, fmt::join(*how.one_of, ", ")));
    word = from.line.word(from.at++).text;
}
void read(bool& value, const FieldFormat& how, WordReader& from) {
    const std::size_t at = how.is_name ? 0 : from.at;
    value = at < from.line.count() && from.line.word(at).text == how.yes;
    if (how.is_name || from.at_end()) return;
    if (!value && how.may_lack) return;
    if (!value && (from.word() != how.no || how.no.empty())) throw from.error(filled(how.complaint, from.word()));
    ++from.at;
}
// Whether the keyword before a number is present; consumes it.
bool is_there(const FieldFormat& how, WordReader& from) {
    if (how.after.empty()) return true;
    if (from.at_end() || from.word() != how.after) return false;
    if (++from.at; from.at_end()) throw from.line.error(from.line.word(from.at - 1).column, from.usage);
    return true;
}
void read(int& value, const FieldFormat& how, WordReader& from) {
    if (!is_there(how, from) || (how.may_lack && from.at_end())) return;
    value = from.line.whole_number(from.at);
    if ((!how.after.empty() || how.may_lack) && value < 1) throw from.error(filled(how.complaint, value));
    ++from.at;
}
void read(double& value, const FieldFormat& how, WordReader& from) {
    if (!is_there(how, from)) return;
    const bool is_zero = !how.zero.empty() && from.word() == how.zero;
    value = is_zero ? 0.0 : from.line.number(from.at);
    if (!is_zero && how.fits && !how.fits(value)) throw from.error(filled(how.complaint, value));
    ++from.at;
}
// One word or, with its unit, two.
void read(ValueArgument& value, const FieldFormat&, WordReader& from) {
    const WordReader begin = from;
    std::string text = from.word();
    ++from.at;
    const auto is_unit = [](const std::string& word) {
        return word == "deg" || word == "rad" || word == "deg/s" || word == "rad/s";
    };
    if (!from.at_end() && is_unit(from.word())) text += " " + from.line.word(from.at++).text;
    try {
        const ParsedNumber number = read_number(text, "rad/s");  // Session checks whether the unit fits the name
        value = {number.value, number.has_unit ? text : ""};
    } catch (const ParseError& problem) {
        throw begin.error(problem.what());
    }
}
void read(Words& words, const FieldFormat& how, WordReader& from) {
    while (!from.at_end()) read(words.emplace_back(), how, from);
}
void read(Values& values, const FieldFormat& how, WordReader& from) {
    while (!from.at_end()) {
        if (from.at + 1 == from.line.count()) throw from.error("this name has no value");
        auto& [name, value] = values.emplace_back();
        read(name, how, from);
        read(value, how, from);
    }
}

// The form that read() accepts, with a space before every word.
std::string written(const std::string& word, const FieldFormat& how) {
    if (how.may_lack && word.empty()) return "";
    return " " + (how.in_quotes ? quoted(word) : quoted_where_needed(word));
}
std::string written(bool value, const FieldFormat& how) {
    const std::string_view word = value ? how.yes : how.no;
    return how.is_name || word.empty() ? "" : fmt::format(" {}", word);
}
std::string written(int value, const FieldFormat& how) {
    if (value == 0 && (!how.after.empty() || how.may_lack)) return "";
    return how.after.empty() ? fmt::format(" {}", value) : fmt::format(" {} {}", how.after, value);
}
std::string written(double value, const FieldFormat& how) {
    if (!how.after.empty()) return value == 0.0 ? "" : fmt::format(" {} {}", how.after, value);
    return value == 0.0 && !how.zero.empty() ? fmt::format(" {}", how.zero) : fmt::format(" {}", value);
}
std::string written(const ValueArgument& given, const FieldFormat& how) {
    return given.text.empty() ? written(given.value, how) : written(given.text, FieldFormat{});
}
std::string written(const Words& words, const FieldFormat& how) {
    std::string text;
    for (const std::string& word : words) text += written(word, how);
    return text;
}
std::string written(const Values& values, const FieldFormat& how) {
    std::string text;
    for (const auto& [name, value] : values) text += written(name, how) + written(value, how);
    return text;
}

// Least and greatest number of words of a value.
template <class Value>
std::pair<std::size_t, std::size_t> count(const FieldFormat& how) {
    if (how.is_name) return {0, 0};
    if (std::same_as<Value, Words>) return {how.may_lack ? 0 : 1, 10};
    if (std::same_as<Value, ValueArgument>) return {1, 2};
    if (std::same_as<Value, Values>) return {2, 96};
    if (!how.after.empty()) return {0, 2};
    if (how.may_lack) return {0, 1};
    return {std::same_as<Value, bool> && how.no.empty() ? 0 : 1, 1};
}

// ---- commands ----

// The first words of the command: its name, or one name per value of a field that is part of the name. Names of two
// words are excluded: they share the first word with another command.
template <HasCommandSpec Kind>
std::vector<std::string_view> names_of() {
    if (Kind::spec.name.find(' ') != Kind::spec.name.npos) return {};
    std::vector<std::string_view> names{Kind::spec.name};
    for_each_field<Kind>([&](const auto& field) {
        if (field.how.is_name) names = {field.how.yes, field.how.no};
    });
    return names;
}

// Parses a line if its name matches; otherwise returns nothing. A two-word name must be the whole line.
template <HasCommandSpec Kind>
std::optional<Command> read_as(const JournalLine& line) {
    const std::string& name = line.word(0).text;
    if (line.count() == 2 && fmt::format("{} {}", name, line.word(1).text) == Kind::spec.name) return Kind{};
    const auto names = names_of<Kind>();
    if (std::find(names.begin(), names.end(), name) == names.end()) return std::nullopt;
    Kind kind;
    WordReader from{line, filled(Kind::spec.usage, name)};
    std::size_t least = 0, most = 0;
    for_each_field<Kind>([&](const auto& field) {
        const auto words = count<std::remove_cvref_t<decltype(kind.*field.member)>>(field.how);
        least += words.first;
        most += words.second;
    });
    line.expect_arguments(least, most, from.usage);
    for_each_field<Kind>([&](const auto& field) { read(kind.*field.member, field.how, from); });
    if (!from.at_end()) throw from.error(fmt::format("unexpected argument '{}'", from.word()));
    return kind;
}

template <HasCommandSpec Kind>
std::string text_of(const Kind& kind) {
    std::string_view name = Kind::spec.name;
    std::string words;
    for_each_field<Kind>([&](const auto& field) {
        if constexpr (std::same_as<decltype(kind.*field.member), const bool&>)
            if (field.how.is_name) name = kind.*field.member ? field.how.yes : field.how.no;
        words += written(kind.*field.member, field.how);
    });
    return std::string(name) + words;
}

template <HasCommandSpec Kind>
void list_names(std::vector<std::string>& names) {
    for (const std::string_view name : names_of<Kind>()) names.emplace_back(name);
}

// The usage without the leading "write: ": "range NUMBER x LOW HIGH, or: ...".
std::string without_request(const std::string& usage) {
    constexpr std::string_view request = "write: ";
    return usage.starts_with(request) ? usage.substr(request.size()) : usage;
}
template <HasCommandSpec Kind>
void list_usages(std::vector<std::string>& lines) {
    std::vector<std::string_view> names = names_of<Kind>();
    if (names.empty()) names = {Kind::spec.name};
    for (const std::string_view name : names)
        lines.push_back(Kind::spec.usage == alone ? std::string(name)
                                                  : without_request(filled(Kind::spec.usage, name)));
}

template <HasCommandSpec Kind>
UndoPolicy undo_policy_of(const Kind&) {
    return Kind::spec.change;
}

// Whether two commands of one type concern the same thing: their first fields are equal.
template <HasCommandSpec Kind>
bool is_about_same(const Kind& a, const Kind& b) {
    if constexpr (std::tuple_size_v<decltype(Kind::spec.fields)> < 2) {
        return true;
    } else {
        const Field first(std::get<0>(Kind::spec.fields));
        return a.*first.member == b.*first.member;
    }
}

// ---- options: described by the option table ----

OptionValue read_value(const Option& option, const JournalLine& line, std::size_t i) {
    if (std::holds_alternative<double>(option.get({}))) return line.number(i);
    if (std::holds_alternative<int>(option.get({}))) return line.whole_number(i);
    const std::string& text = line.word(i).text;
    const auto found = std::find(option.words.begin(), option.words.end(), text);
    if (found != option.words.end()) return *found;
    throw line.error(line.word(i).column, filled(option.error_text, text), std::string(option.usage));
}

// One value for all options that the command sets, or one for each of them.
template <std::same_as<SetOption>>
std::optional<Command> read_as(const JournalLine& line) {
    const std::string& name = line.word(0).text;
    const auto options = options_set_by(name);
    if (options.empty()) return std::nullopt;
    line.expect_arguments(1, options.size(), std::string(options[0].usage));
    if (line.count() != 2 && line.count() != options.size() + 1)
        throw line.error(line.word(2).column, fmt::format("{} takes one number or three", name),
                         fmt::format("write: {} 1e-6", name));
    std::vector<OptionValue> values;
    for (std::size_t i = 0; i < options.size(); ++i)
        values.push_back(read_value(options[i], line, line.count() == 2 ? 1 : i + 1));
    return SetOption(name, values);
}

std::string text_of(const SetOption& use) {
    std::string text = use.name;
    for (std::size_t i = 0; i < (use.sets_single_value() ? 1 : use.values.size()); ++i)
        text += " " + to_text(use.values[i]);
    return text;
}

template <std::same_as<SetOption>>
void list_names(std::vector<std::string>& names) {
    for (const auto group : options_by_command()) names.emplace_back(group[0].command);
}

template <std::same_as<SetOption>>
void list_usages(std::vector<std::string>& lines) {
    for (const auto group : options_by_command()) lines.push_back(without_request(std::string(group[0].usage)));
}

// A number has a slider, so its edits are merged.
UndoPolicy undo_policy_of(const SetOption& use) {
    return std::holds_alternative<double>(use.values[0]) ? UndoPolicy::merge_with_previous : UndoPolicy::own_step;
}

bool is_about_same(const SetOption& a, const SetOption& b) { return a.name == b.name; }

// ---- all of them ----

template <class... Kinds>
std::optional<Command> read_as_any(const JournalLine& line, const std::variant<Kinds...>*) {
    std::optional<Command> command;
    ((command = read_as<Kinds>(line)) || ...);
    return command;
}

template <class... Kinds>
std::vector<std::string> names_of_all(const std::variant<Kinds...>*) {
    std::vector<std::string> names;
    (list_names<Kinds>(names), ...);
    return names;
}

template <class... Kinds>
std::vector<std::string> usages_of_all(const std::variant<Kinds...>*) {
    std::vector<std::string> lines;
    (list_usages<Kinds>(lines), ...);
    return lines;
}

constexpr const AnyCommand* any = nullptr;

}  // namespace

}  // namespace command

std::string to_text(const Command& command) {
    return std::visit([](const auto& what) { return command::text_of(what); }, static_cast<const AnyCommand&>(command));
}

Command parse_command(std::string_view text, const std::string& file, int line_number) {
    const JournalLine line(text, file, line_number);
    if (line.count() == 0) throw line.error(1, "there is no command here");
    if (auto command = command::read_as_any(line, command::any)) return *std::move(command);
    const std::vector<std::string> names = command::names_of_all(command::any);
    const std::string meant = did_you_mean(line.word(0).text, names);
    throw line.error(line.word(0).column, fmt::format("there is no command '{}'{}", line.word(0).text, meant),
                     meant.empty() ? fmt::format("the commands are: {}", fmt::join(names, ", ")) : "");
}

std::vector<std::string> command_usages() { return command::usages_of_all(command::any); }

command::UndoPolicy undo_policy_of(const Command& command) {
    return std::visit([](const auto& what) { return command::undo_policy_of(what); },
                      static_cast<const AnyCommand&>(command));
}

bool continues_edit(const Command& last, const Command& next) {
    if (last.index() != next.index() || undo_policy_of(next) != command::UndoPolicy::merge_with_previous) return false;
    return std::visit(
        [&](const auto& what) {
            return command::is_about_same(std::get<std::remove_cvref_t<decltype(what)>>(last), what);
        },
        static_cast<const AnyCommand&>(next));
}

}  // namespace achilles
