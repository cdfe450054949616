// Spelling suggestions for error messages, and the Greek letters.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace achilles {

// The candidate closest to `word` in edit distance (insert, delete, replace, swap adjacent letters), ignoring case.
// Allows one edit for words of up to 3 letters, and a third of the length for longer ones. If none is close enough,
// returns the only candidate that starts with the word (3 letters or more), or "".
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// A name in quotes for messages: 'x'. A rate x' gets no quotes, because they look like primes.
std::string in_quotes(std::string_view name);

// Replaces Greek letters by their names: θ1 becomes theta1, and 2*θ becomes 2*theta.
std::string spelled_out(std::string_view text);

// The rate x' that a word in another program's notation stands for: xdot, x_dot, dx, dxdt, vx, v_x, x_t, or v alone.
// Here x' must be one of the names. Returns "" for any other word.
std::string rate_meant(std::string_view word, std::span<const std::string> names);
// For such a word "; rates are written x'", else "".
std::string rates_are_written(std::string_view word, std::span<const std::string> names);

// "; did you mean 'x'?", or the hint of rates_are_written(), or "".
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

// True if `list`, words separated by spaces, contains the word.
bool has_word(std::string_view list, std::string_view word);

// Greek letters: the name used in a system file, and the character shown.

inline constexpr std::array<std::pair<std::string_view, std::string_view>, 33> greek_letters{
    {{"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"},   {"epsilon", "ε"}, {"zeta", "ζ"},   {"eta", "η"},
     {"theta", "θ"}, {"iota", "ι"},  {"kappa", "κ"}, {"lambda", "λ"},  {"mu", "μ"},      {"nu", "ν"},     {"xi", "ξ"},
     {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},   {"upsilon", "υ"}, {"phi", "φ"},     {"chi", "χ"},    {"psi", "ψ"},
     {"omega", "ω"}, {"pi", "π"},    {"Gamma", "Γ"}, {"Delta", "Δ"},   {"Theta", "Θ"},   {"Lambda", "Λ"}, {"Xi", "Ξ"},
     {"Pi", "Π"},    {"Sigma", "Σ"}, {"Phi", "Φ"},   {"Psi", "Ψ"},     {"Omega", "Ω"}}};

}  // namespace achilles
