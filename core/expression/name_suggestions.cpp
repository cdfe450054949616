#include "expression/name_suggestions.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

namespace achilles {

namespace {

// Edit distance from a to b: insert, delete, replace, swap adjacent letters.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

std::string lower(std::string_view word) {
    std::string result(word);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

}  // namespace

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
    constexpr std::size_t longest = 100;  // longer words get no suggestion
    constexpr std::size_t least_beginning = 3;
    if (word.size() > longest) return {};
    const std::string small = lower(word);
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    std::string best, begun;
    int beginnings = 0;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > longest || candidate == word) continue;
        const std::string other = lower(candidate);
        const std::size_t edits = distance(small, other);
        if (edits < least && edits < std::max(small.size(), other.size())) {
            least = edits;
            best = candidate;
        }
        if (small.size() >= least_beginning && other.starts_with(small)) {
            begun = candidate;
            ++beginnings;
        }
    }
    return best.empty() && beginnings == 1 ? begun : best;
}

std::string in_quotes(std::string_view name) {
    return name.ends_with('\'') ? std::string(name) : "'" + std::string(name) + "'";
}

std::string spelled_out(std::string_view text) {
    std::string result(text);
    for (const auto& [name, letter] : greek_letters)
        for (std::size_t at = result.find(letter); at != std::string::npos; at = result.find(letter, at))
            result.replace(at, letter.size(), name);
    return result;
}

std::string rate_meant(std::string_view word, std::span<const std::string> names) {
    for (const std::string& rate : names) {
        if (!rate.ends_with('\'') || rate.ends_with("\'\'") || rate.starts_with("gap")) continue;
        const std::string x = rate.substr(0, rate.size() - 1);
        const std::string others[] = {x + "dot", x + "_dot", "d" + x, "d" + x + "dt", "v" + x, "v_" + x, x + "_t"};
        if (word == "v" || std::find(std::begin(others), std::end(others), word) != std::end(others)) return rate;
    }
    return "";
}

std::string rates_are_written(std::string_view word, std::span<const std::string> names) {
    const std::string rate = rate_meant(word, names);
    return rate.empty() ? "" : "; rates are written " + rate;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
    if (std::string rates = rates_are_written(word, candidates); !rates.empty()) return rates;
    const std::string latin = spelled_out(word);
    if (latin != word)
        return std::find(candidates.begin(), candidates.end(), latin) == candidates.end()
                   ? "; spell out Greek letters: " + latin
                   : "; did you mean " + in_quotes(latin) + "?";
    const std::string best = nearest(word, candidates);
    return best.empty() ? "" : "; did you mean " + in_quotes(best) + "?";
}

bool has_word(std::string_view list, std::string_view word) {
    while (!list.empty()) {
        const std::size_t end = std::min(list.find(' '), list.size());
        if (list.substr(0, end) == word) return true;
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
}

}  // namespace achilles
