// The name a person probably meant.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace achilles {

// The candidate nearest to `word` in edit distance (insert, delete, replace, swap of neighbours), or "" if none is near
// enough to be a likely misspelling: at most one edit for words up to 3 letters, a third of the length beyond. Capital
// letters count as small ones. Where no candidate is near, the only one that begins with the word (3 letters or more).
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// A name as messages show it: 'x', but x' without quotes, which look like primes.
std::string in_quotes(std::string_view name);

// Greek letters by their names: theta1 for θ1, and 2*theta for 2*θ.
std::string spelled_out(std::string_view text);

// x' where a word stands for that rate as other programs write it: xdot, x_dot, dx, dxdt, vx, v_x, x_t of an x whose x' is
// one of the names, or v alone; else "".
std::string rate_meant(std::string_view word, std::span<const std::string> names);
// "; rates are written x'" for such a word; else "".
std::string rates_are_written(std::string_view word, std::span<const std::string> names);

// "; did you mean 'x'?", or how a rate is written, or "".
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

// Whether a word stands in a list of words with spaces between.
bool has_word(std::string_view list, std::string_view word);

// Greek letters: their names, which is how a person writes them in a system file, and how they are shown.

inline constexpr std::array<std::pair<std::string_view, std::string_view>, 33> greek_letters{
    {{"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"},   {"epsilon", "ε"}, {"zeta", "ζ"},   {"eta", "η"},
     {"theta", "θ"}, {"iota", "ι"},  {"kappa", "κ"}, {"lambda", "λ"},  {"mu", "μ"},      {"nu", "ν"},     {"xi", "ξ"},
     {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},   {"upsilon", "υ"}, {"phi", "φ"},     {"chi", "χ"},    {"psi", "ψ"},
     {"omega", "ω"}, {"pi", "π"},    {"Gamma", "Γ"}, {"Delta", "Δ"},   {"Theta", "Θ"},   {"Lambda", "Λ"}, {"Xi", "Ξ"},
     {"Pi", "Π"},    {"Sigma", "Σ"}, {"Phi", "Φ"},   {"Psi", "Ψ"},     {"Omega", "Ω"}}};

}  // namespace achilles
