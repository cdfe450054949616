#include "figure/label.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace achilles {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 34> letters{
    {{"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"},   {"epsilon", "ε"}, {"zeta", "ζ"},   {"eta", "η"},
     {"theta", "θ"}, {"iota", "ι"},  {"kappa", "κ"}, {"lambda", "λ"},  {"mu", "μ"},      {"nu", "ν"},     {"xi", "ξ"},
     {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},   {"upsilon", "υ"}, {"phi", "φ"},     {"chi", "χ"},    {"psi", "ψ"},
     {"omega", "ω"}, {"pi", "π"},    {"Gamma", "Γ"}, {"Delta", "Δ"},   {"Theta", "Θ"},   {"Lambda", "Λ"}, {"Xi", "Ξ"},
     {"Pi", "Π"},    {"Sigma", "Σ"}, {"Phi", "Φ"},   {"Psi", "Ψ"},     {"Omega", "Ω"},   {"gap", "h"}}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_part(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Where the number ends that begins at i. Its exponent is part of it: the e of 1e3 is no name with an index.
std::size_t end_of_number(std::string_view text, std::size_t i) {
    while (i < text.size() && (is_digit(text[i]) || text[i] == '.')) ++i;
    std::size_t exponent = i;
    if (exponent < text.size() && (text[exponent] == 'e' || text[exponent] == 'E')) ++exponent;
    if (exponent == i) return i;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    if (exponent == text.size() || !is_digit(text[exponent])) return i;
    while (exponent < text.size() && is_digit(text[exponent])) ++exponent;
    return exponent;
}

}  // namespace

std::string typeset_name(std::string_view name) {
    const std::size_t primes_at = std::min(name.find('\''), name.size());
    const std::size_t primes = name.size() - primes_at;
    std::string_view word = name.substr(0, primes_at);
    std::size_t digits_at = word.size();
    while (digits_at > 1 && is_digit(word[digits_at - 1])) --digits_at;
    const std::string_view digits = word.substr(digits_at);
    word = word.substr(0, digits_at);
    while (!digits.empty() && word.size() > 1 && word.back() == '_') word.remove_suffix(1);
    const auto found =
        std::find_if(letters.begin(), letters.end(), [&](const auto& entry) { return entry.first == word; });
    std::string text(found == letters.end() ? word : found->second);
    if (primes == 1) text += "\u0307";
    if (primes == 2) text += "\u0308";
    for (const char digit : digits)
        text += std::string("\u2080").replace(2, 1, 1, static_cast<char>(0x80 + (digit - '0')));
    return text;
}

std::string typeset(std::string_view expression) {
    std::string text;
    for (std::size_t i = 0; i < expression.size();) {
        const char c = expression[i];
        std::size_t end = i;
        if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
            while (end < expression.size() && is_name_part(expression[end])) ++end;
            while (end < expression.size() && expression[end] == '\'') ++end;
            text += typeset_name(expression.substr(i, end - i));
        } else if (is_digit(c) || c == '.') {
            end = end_of_number(expression, i);
            for (const char part : expression.substr(i, end - i)) text += part == '-' ? "\u2212" : std::string(1, part);
        } else {
            ++end;
            text += c == '*' ? "\u00B7" : c == '-' ? "\u2212" : std::string(1, c);
        }
        i = end;
    }
    return text;
}

std::string with_unit(const std::string& label, const std::string& unit) {
    return unit.empty() ? label : label + " [" + unit + "]";
}

}  // namespace achilles
