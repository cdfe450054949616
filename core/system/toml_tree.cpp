#include "system/toml_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <tuple>

#include <toml++/toml.h>

#include "expression/parse.hpp"
#include "system/input_error.hpp"
#include "system/keys.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

Location location(const toml::source_position& position) {
    return {static_cast<int>(position.line), static_cast<int>(position.column)};
}

// Skips the string or comment that starts at i; returns the index of its last character.
std::size_t skip(const std::string& text, std::size_t i) {
    if (text[i] == '#') return std::min(text.find('\n', i), text.size()) - 1;
    const char quote = text[i];
    const bool multi = text.compare(i, 3, std::string(3, quote)) == 0;
    for (std::size_t j = i + (multi ? 3 : 1); j < text.size(); ++j) {
        if (text[j] == '\\' && quote == '"') {
            ++j;
        } else if (multi ? text.compare(j, 3, std::string(3, quote)) == 0 : text[j] == quote || text[j] == '\n') {
            if (!multi) return j;
            j += 2;
            for (int extra = 0; extra < 2 && j + 1 < text.size() && text[j + 1] == quote; ++extra) ++j;  // """a""""
            return j;
        }
    }
    return text.size() - 1;
}

// Rejects keys with very many dotted parts: toml++ would nest tables so deeply that freeing them overflows the stack.
void refuse_deep_keys(const std::string& text, const std::string& name) {
    constexpr int max_parts = 16;
    int dots = 0, line = 1;
    std::size_t line_start = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"' || c == '\'' || c == '#') {
            const std::size_t end = skip(text, i);
            for (; i < end; ++i) {
                if (text[i] != '\n') continue;
                ++line;
                line_start = i + 1;
            }
        } else if (c == '.') {
            if (++dots > max_parts) {
                const Location at{line, static_cast<int>(i - line_start) + 1};
                throw InputError(name, at, fmt::format("a key with more than {} parts", max_parts), {},
                                 line_of(text, line));
            }
        } else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}') {
            dots = 0;
        }
        if (i < text.size() && text[i] == '\n') {
            dots = 0;
            ++line;
            line_start = i + 1;
        }
    }
}

// Finds the rest of a text from a line and column on, without a search from its start: a file may have a million
// strings, all in one line.
class Places {
 public:
    explicit Places(std::string_view text) : text_(text) {
        lines_.push_back(0);
        marks_.push_back(0);
        int characters = 0;
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (text[i] == '\n') {
                lines_.push_back(marks_.size());
                marks_.push_back(i + 1);
                characters = 0;
            } else if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80 && ++characters > stride) {
                marks_.push_back(i);
                characters = 1;
            }
        }
        lines_.push_back(marks_.size());
    }

    std::string_view from(Location at) const {
        const auto line = static_cast<std::size_t>(at.line - 1),
                   skipped = static_cast<std::size_t>(at.column - 1) / stride;
        if (at.line < 1 || at.column < 1 || line + 1 >= lines_.size() || lines_[line] + skipped >= lines_[line + 1])
            return {};
        const std::string_view rest = text_.substr(marks_[lines_[line] + skipped]);
        return rest.substr(byte_of_column(rest, 1 + (at.column - 1) % stride));
    }

 private:
    static constexpr int stride = 64;
    std::string_view text_;
    std::vector<std::size_t> marks_;  // byte offset of every 64th character of each line
    std::vector<std::size_t> lines_;  // index of the first mark of each line, and the end
};

// Context of a conversion.
struct ConversionContext {
    const std::string& text;
    const std::string& name;
    const Places& places;
    int depth = 0;
};

// Location of a string's first character: after its quotes, and after a first line break that TOML removes.
Location inside(const Places& places, Location at) {
    std::string_view rest = places.from(at);
    for (const std::string_view quotes : {"\"\"\"", "'''"}) {
        if (!rest.starts_with(quotes)) continue;
        rest.remove_prefix(3);
        const bool line_ends = rest.empty() || rest.starts_with("\n") || rest.starts_with("\r\n");
        return line_ends ? Location{at.line + 1, 1} : Location{at.line, at.column + 3};
    }
    return {at.line, at.column + 1};
}

TomlValue convert(const toml::node& node, ConversionContext source);

TomlValue convert_table(const toml::table& table, const ConversionContext& source) {
    TomlValue value;
    for (const auto& [key, node] : table) {
        value.entries.push_back({std::string(key.str()), location(key.source().begin), convert(node, source)});
    }
    const auto place = [](const TomlEntry& entry) { return std::tuple(entry.at.line, entry.at.column); };
    std::sort(value.entries.begin(), value.entries.end(),
              [&](const TomlEntry& a, const TomlEntry& b) { return place(a) < place(b); });
    return value;
}

TomlValue convert(const toml::node& node, ConversionContext source) {
    constexpr int deepest = 64;
    const Location at = location(node.source().begin);
    if (++source.depth > deepest) {
        throw InputError(source.name, at, fmt::format("more than {} levels of nesting", deepest), {},
                         line_of(source.text, at.line));
    }
    TomlValue value;
    if (const toml::table* table = node.as_table()) value = convert_table(*table, source);
    value.at = at;
    value.text.at = at;
    if (const auto* string = node.as_string()) {
        value.kind = TomlValue::Kind::string;
        value.text = {string->get(), inside(source.places, at)};
    } else if (const auto* integer = node.as_integer()) {
        value.kind = TomlValue::Kind::number;
        value.integer = true;
        value.number = static_cast<double>(integer->get());
        value.text.text = fmt::format("{}", integer->get());
    } else if (const auto* number = node.as_floating_point()) {
        value.kind = TomlValue::Kind::number;
        value.number = number->get();
        value.text.text = fmt::format("{}", number->get());
    } else if (const auto* boolean = node.as_boolean()) {
        value.kind = TomlValue::Kind::boolean;
        value.boolean = boolean->get();
    } else if (const toml::array* array = node.as_array()) {
        value.kind = TomlValue::Kind::array;
        value.items.reserve(array->size());
        for (const toml::node& item : *array) value.items.push_back(convert(item, source));
    } else if (!node.is_table()) {
        value.kind = TomlValue::Kind::date;
    }
    return value;
}

std::string trimmed(std::string part) {
    part.erase(0, std::min(part.find_first_not_of(" \t"), part.size()));
    part.erase(part.find_last_not_of(" \t\r") + 1);
    return part;
}

// The number that a text was meant to be, in TOML notation: 0,4 is 0.4, .5 is 0.5, 1. is 1, −1 has a Unicode minus; ""
// for anything else.
std::string number_meant(std::string text) {
    constexpr std::string_view other_minus = "\u2212";
    if (text.starts_with(other_minus)) text.replace(0, other_minus.size(), "-");
    if (text.ends_with(';') || text.ends_with(',')) text.pop_back();
    std::replace(text.begin(), text.end(), ',', '.');
    if (text.find_first_not_of("+-.0123456789eE") != text.npos || text.find_first_of("0123456789") == text.npos)
        return "";
    const std::size_t first = text.find_first_not_of("+-");
    if (text[first] == '.') text.insert(first, "0");
    if (text.ends_with('.')) text.pop_back();
    return text;
}

// Advice on a value with wrong quotes; "" if the quotes are right.
std::string right_quotes(const std::string& key, const std::string& value) {
    const auto count = std::count(value.begin(), value.end(), '"');
    if (value[0] == '\'' && value.find('\'', 1) < value.size() - 1)
        return fmt::format("put text with a prime in double quotes: {} = \"{}\"", key,
                           shown(value.substr(1, value.size() - (value.ends_with('\'') ? 2 : 1))));
    for (const std::string_view curly : {"\u201c", "\u201d", "\u201e"})
        if (value.find(curly) != value.npos) return "write plain double quotes, \"";
    if (count == 1)
        return fmt::format("put text in two quotes: {} = \"{}\"", key,
                           shown(value.substr(value[0] == '"' ? 1 : 0, value.size() - 1)));
    if (count > 2 && value[0] == '"') return "write \\\" for a quote inside text";
    return "";
}

bool has_heading(const std::string& heading) {
    const auto all = file_tables();
    return std::any_of(all.begin(), all.end(), [&](const FileTable& table) { return table.heading == heading; });
}

// "[lagrangian]", or "[[coordinate]]" for tables that may be repeated.
std::string heading_of(const std::string& name) {
    for (const std::string& heading : {"[" + name + "]", "[[" + name + "]]"})
        if (has_heading(heading)) return "write " + heading;
    return name == "run" || name == "truncation" ? fmt::format("write [{}]", name) : "";
}

// Completes the brackets of [lagrangian and [[constraint].
std::string right_brackets(const std::string& line) {
    const std::size_t begin = std::min(line.find_first_not_of("[ "), line.size());
    return heading_of(line.substr(begin, std::min(line.find_first_of("] #", begin), line.size()) - begin));
}

// The entry of an inline table at this byte of a line, such as "value = 9,81"; the whole line if there is none.
std::string entry_at(const std::string& line, std::size_t byte) {
    std::size_t begin = 0, end = line.size();
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' || line[i] == '\'' || line[i] == '#') i = skip(line, i);
        if (line[i] != '{' && line[i] != ',' && line[i] != '}') continue;
        const std::size_t next = std::min(line.find_first_of("={},\"'#", i + 1), line.size());
        const bool is_start =
            next < line.size() && line[next] == '=' && is_name(trimmed(line.substr(i + 1, next - i - 1)));
        if (is_start && i < byte) begin = i + 1;
        if (i < byte || (!is_start && line[i] != '}')) continue;
        end = i;
        break;
    }
    if (begin == 0) return line;
    const std::string entry = line.substr(begin, end - begin);
    return std::count(entry.begin(), entry.end(), '"') % 2 == 0 ? entry : "";
}

// True if the value is followed by a comment of another language.
bool has_other_comment(const std::string& value) {
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (value[i] == '"' || value[i] == '\'') i = skip(value, i);
        const std::string_view rest = std::string_view(value).substr(i);
        if (i > 0 && ((rest.starts_with("//") && value[i - 1] == ' ') || (rest.starts_with("%") && rest.size() > 1)))
            return true;
    }
    return false;
}

// Advice on a line such as gap = y - sin(x) or start = 0,4; "" if there is none.
std::string right_value(const std::string& line) {
    const std::size_t equals = line.find('=');
    const std::string begin = trimmed(line);
    for (const char* const sign : {"//", "/*", "%", ";", "--", "!"})
        if (begin.starts_with(sign)) return "a comment begins with #";
    for (const std::string_view assign : {":=", "->", "==", "<-"})
        if (const std::size_t at = line.find(assign); at != line.npos && is_name(trimmed(line.substr(0, at))))
            return fmt::format("write an equals sign: {} = {}", trimmed(line.substr(0, at)),
                               shown(trimmed(line.substr(at + assign.size()))));
    if (begin.starts_with("[") && (equals == line.npos || begin.find(']') == begin.npos)) return right_brackets(begin);
    if (begin.ends_with(':') && is_name(begin.substr(0, begin.size() - 1)))
        return heading_of(begin.substr(0, begin.size() - 1));
    if (equals == std::string::npos) {
        const std::string words = trimmed(line.substr(0, line.find('#')));
        const std::size_t end = std::min(words.find_first_of(" \t:"), words.size());
        const std::string value = trimmed(words.substr(std::min(words.find_first_not_of(" \t:", end), words.size())));
        return is_name(words.substr(0, end)) && !value.empty()
                   ? fmt::format("write an equals sign: {} = {}", words.substr(0, end), shown(value))
                   : "";
    }
    const std::string key = trimmed(line.substr(0, equals)), rest = line.substr(equals + 1);
    const std::string value = trimmed(rest.substr(0, rest.find('#')));
    if (!is_name(key) || value.empty()) return "";
    if (has_other_comment(value)) return "a comment begins with #";
    if (const std::string quotes = right_quotes(key, value); !quotes.empty()) return quotes;
    if (value.find('"') != std::string::npos) return "";
    if (value.find("''") != value.npos && value.find("\'\'\'") == value.npos)
        return "put text with a prime in double quotes, \"x'\"";
    if (value[0] == '(' || (value[0] == '[' && value.find(';') != value.npos)) {
        std::string list = value;
        std::replace(list.begin(), list.end(), ';', ',');
        list.front() = '[';
        if (list.ends_with(')')) list.back() = ']';
        return fmt::format("put a list in square brackets: {} = {}", key, shown(list));
    }
    if (const std::size_t dots = value.find("..");
        dots != value.npos && value.find_first_not_of("+-.0123456789eE") == value.npos)
        return fmt::format("put two numbers in square brackets: {} = [{}, {}]", key, value.substr(0, dots),
                           value.substr(std::min(value.find_first_not_of('.', dots), value.size())));
    if (value[0] == '[' || value[0] == '{') {
        const std::vector<std::string> names = names_in(value);
        const bool has_names = std::any_of(names.begin(), names.end(), [](const std::string& name) {
            return name != "true" && name != "false" && name != "inf" && name != "nan";
        });
        return has_names ? "put names and expressions in quotes, at = [\"x\", \"y\"]" : "";
    }
    if (const std::string number = number_meant(value); !number.empty()) {
        if (number == value) return "";
        return fmt::format("{}: {} = {}",
                           value.find(',') < value.size() - 1 ? "write a decimal point" : "write the number alone", key,
                           number);
    }
    if (const std::string percent = number_meant(trimmed(value.substr(0, value.size() - 1)));
        value.ends_with('%') && !percent.empty())
        return fmt::format("write {} = {}", key, std::strtod(percent.c_str(), nullptr) / 100.0);
    const std::size_t end = std::min(value.find(' '), value.size());
    const std::string number = value.substr(0, end), unit = trimmed(value.substr(end));
    std::optional<ValueWithUnit> apart = measured(value);
    if (!unit.empty() && number_meant(number) == number && !unit.starts_with("deg") &&
        std::isalpha(static_cast<unsigned char>(unit[0])) != 0)
        apart = {number, unit};
    if (apart)
        return fmt::format("write the number alone: {} = {} if the unit is {}, else convert it", key, apart->number,
                           shown(apart->unit));
    return fmt::format("put it in quotes: {} = \"{}\"", key, shown(value));
}

// Advice on a list without a closing bracket or with a missing comma.
std::string right_list(std::string_view message, const std::string& line, std::size_t byte) {
    if (message.starts_with("encountered end-of-file"))
        return "a list or a table in the file is not closed: ] or } is missing";
    const auto begins_with_key = [](std::string entry) {
        std::erase(entry, '.');
        const std::size_t equals = entry.find('=');
        return equals != entry.npos && is_name(trimmed(entry.substr(0, equals)));
    };
    const bool wants_comma = message.starts_with("expected comma or closing");
    const std::string_view of_values[] = {"could not determine value type", "expected 'true'", "expected 'false'",
                                          "expected 'inf'", "expected 'nan'"};
    if (!wants_comma && std::none_of(std::begin(of_values), std::end(of_values),
                                     [&](std::string_view one) { return message.starts_with(one); }))
        return "";
    const bool is_heading = line.starts_with('[') && "write " + trimmed(line) == right_brackets(line);
    if (is_heading || (begins_with_key(line) && byte < line.find('=')))
        return "the list above is not closed: ] is missing";
    const std::string rest = line.substr(byte);
    return wants_comma && (begins_with_key(rest) || rest.starts_with('{')) ? "a comma is missing here" : "";
}

// Advice on a repeated table, or on one that may be repeated.
std::string right_heading(std::string_view message, const std::string& line) {
    if (!message.starts_with("cannot redefine existing")) return "";
    const std::string heading = trimmed(line.substr(0, line.find('#')));
    if (heading.starts_with("[[")) {
        const std::string single = heading.substr(1, heading.size() - 2);
        if (has_heading(single) || single == "[run]" || single == "[truncation]")
            return fmt::format("write {} once, with all of its keys", shown(single));
        return fmt::format("write {} each time: one above has single brackets", shown(heading));
    }
    if (heading.starts_with("[")) {
        if (has_heading("[" + heading + "]")) return fmt::format("write [{}] each time: there may be several", heading);
        return fmt::format("write all keys under the first {}", shown(heading));
    }
    return "a key may appear only once in a table: remove one of the two";
}

}  // namespace

const TomlValue* find_entry(const TomlValue& table, std::string_view key) {
    for (const TomlEntry& entry : table.entries)
        if (entry.key == key) return &entry.value;
    return nullptr;
}

std::string_view kind_name(TomlValue::Kind kind) {
    switch (kind) {
        case TomlValue::Kind::string:
            return "a string";
        case TomlValue::Kind::number:
            return "a number";
        case TomlValue::Kind::boolean:
            return "true or false";
        case TomlValue::Kind::date:
            return "a date";
        case TomlValue::Kind::array:
            return "an array";
        case TomlValue::Kind::table:
            return "a table";
    }
    return "";
}

TomlValue read_toml(const std::string& text, const std::string& name) {
    refuse_deep_keys(text, name);
    try {
        const toml::table table = toml::parse(text);
        const Places places(text);
        return convert(table, ConversionContext{text, name, places});
    } catch (const toml::parse_error& error) {
        std::string_view message = error.description();
        const std::string_view preamble = "Error while parsing ";  // "... key-value pair: expected '='"
        if (message.substr(0, preamble.size()) == preamble) {
            if (const auto colon = message.find(": "); colon != message.npos) message.remove_prefix(colon + 2);
        }
        const Location at = location(error.source().begin);
        const std::string line = line_of(text, at.line);
        const std::size_t byte = byte_of_column(line, at.column);
        std::string hint = right_heading(message, line);
        if (hint.empty()) hint = right_list(message, line, byte);
        if (hint.empty()) hint = right_value(entry_at(line, byte));
        if (hint.empty() && message.find("escape sequence") != message.npos)
            hint = "expressions are not LaTeX: write x' for \\dot{x}, (a)/(b) for \\frac{a}{b}, sin(x) for \\sin x";
        // toml++ shows a line break where the text ends: "saw 't\n'".
        std::string plain(message);
        std::erase_if(plain, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
        throw InputError(name, at, fmt::format("not valid TOML: {}", plain), hint, line);
    }
}

}  // namespace achilles
