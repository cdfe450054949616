#include "expression/read_number.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>

#include "expression/functions.hpp"
#include "expression/nearest.hpp"
#include "expression/parse.hpp"
#include "number/ground.hpp"

namespace achilles {

namespace {

constexpr std::string_view spaces = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(spaces);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(spaces) + 1 - first);
}

// A decimal number, all of it; what is too large is infinite.
std::optional<double> plain_number(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || problem == std::errc::invalid_argument) return std::nullopt;
    return problem == std::errc() ? value : HUGE_VAL;
}

// "0.4" for 0,4; "" where the comma is not what is wrong.
std::string with_a_point(std::string_view text) {
    std::string other(text);
    std::replace(other.begin(), other.end(), ',', '.');
    return other != text && plain_number(other) ? other : "";
}

// What a person sees of a text in a message.
std::string shown(std::string_view text) {
    constexpr std::size_t most = 60;
    std::string result;
    for (const char c : text.substr(0, most)) result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    while (text.size() > most && !result.empty() && (static_cast<unsigned char>(result.back()) & 0x80) != 0)
        result.pop_back();  // half a character
    return "'" + result + (text.size() > most ? "...'" : "'");
}

[[noreturn]] void fail(std::string_view text, std::size_t offset, const std::string& why, std::string_view name = {},
                       std::string_view hint = {}) {
    throw ParseError(offset, shown(text) + " is not a finite number" + (why.empty() ? "" : ": " + why), name, hint);
}

}  // namespace

void allow_units(Scope& scope, std::string_view unit, Graph& graph) {
    const Expression degree = graph.pi() / graph.number(180);
    const bool is_rate = unit == "rad/s" && scope.allowed.find("s") == scope.allowed.end();  // else it is divided by s
    for (const std::string word : {"deg", "\u00b0", "rad"}) {
        const Expression factor = word == "rad" ? graph.number(1) : degree;
        if (unit == "rad" || unit == "rad/s")
            scope.units.emplace(word, factor);
        else
            scope.forbidden.emplace(word, in_quotes(word) + " is allowed only where the unit is rad, and here it " +
                                              (unit.empty() ? "is not" : "is " + std::string(unit)));
        if (is_rate) scope.units.emplace(word + "/s", factor);
    }
}

bool has_names(std::string_view text) {
    const std::vector<std::string> names = names_in(text);
    return std::any_of(names.begin(), names.end(), [](const std::string& name) {
        const auto is_it = [&](const Function& function) { return function.name == name; };
        constexpr std::string_view of_numbers[] = {"pi", "deg", "rad", "inf", "nan"};
        return std::find(std::begin(of_numbers), std::end(of_numbers), name) == std::end(of_numbers) &&
               std::none_of(functions.begin(), functions.end(), is_it);
    });
}

GivenNumber read_number(std::string_view whole, std::string_view unit) {
    const Ground ground;
    const std::string_view text = trimmed(whole);
    const auto begin = text.empty() ? 0 : static_cast<std::size_t>(text.data() - whole.data());
    if (text.empty()) throw ParseError(0, "a number is missing");
    GivenNumber given;
    if (const auto plain = plain_number(text)) {
        if (!std::isfinite(*plain)) fail(text, begin, "");
        given.value = *plain;
        return given;
    }
    if (const std::string better = with_a_point(text); !better.empty())
        fail(text, begin, "write a decimal point, " + better);
    Graph graph;
    Scope scope;
    allow_units(scope, unit, graph);
    try {
        given.value = value_of_constant(parse(text, scope, graph));
    } catch (const ParseError& error) {
        const bool is_unknown = !error.name.empty() && !scope.forbidden.contains(error.name);
        // No functions: a word without parentheses is none, and ten was not meant to be tan.
        const std::vector<std::string> known{"pi"};
        fail(text, begin + error.offset,
             is_unknown ? "pi is the only name allowed here" + did_you_mean(error.name, known) : error.what(),
             error.name, error.hint);
    }
    if (!std::isfinite(given.value)) fail(text, begin, "");
    // No name of the language but theirs has these letters.
    given.has_pi = text.find("pi") != text.npos;
    for (const auto& [word, factor] : scope.units) given.has_unit = given.has_unit || text.find(word) != text.npos;
    return given;
}

}  // namespace achilles
