#include "expression/nearest.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace achilles {

namespace {

// Edit distance with insertions, deletions, replacements and swaps of neighbours (optimal string alignment).
std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

}  // namespace

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
    const std::size_t allowed = std::max<std::size_t>(1, word.size() / 3);
    std::size_t least = allowed + 1;
    std::string best;
    for (const std::string& candidate : candidates) {
        // Lengths that differ by more are further apart than that: a megabyte word costs nothing.
        const std::size_t shorter = std::min(word.size(), candidate.size());
        if (std::max(word.size(), candidate.size()) - shorter >= least || shorter == 0) continue;
        const std::size_t distance = edits(word, candidate);
        // Replacing every letter is no misspelling: "q" is not near "m".
        if (distance < least && distance < std::max(word.size(), candidate.size())) {
            least = distance;
            best = candidate;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
    const std::string candidate = nearest(word, candidates);
    return candidate.empty() ? std::string() : "; did you mean '" + candidate + "'?";
}

}  // namespace achilles
