#include "output/wrap.hpp"

#include <algorithm>
#include <cctype>

namespace achilles {

namespace {

// Where " + " and " - " stand, and how many brackets around each.
struct Place {
    std::size_t offset;
    int depth;
};

std::vector<Place> places(std::string_view formula) {
    constexpr int never = 1000;  // inside an argument of LaTeX, or what \left and \right hold together
    std::vector<Place> result;
    int depth = 0;
    std::vector<int> brackets;
    for (std::size_t i = 0; i < formula.size(); ++i) {
        const char c = formula[i];
        const auto follows = [&](std::string_view word) {
            return i >= word.size() && formula.substr(i - word.size(), word.size()) == word;
        };
        if (c == '(' || c == '{') {
            // A function's argument stays together as well.
            const bool function = i > 0 && std::isalnum(static_cast<unsigned char>(formula[i - 1])) != 0;
            brackets.push_back(c == '{' || follows("\\left") || function ? never : 1);
            depth += brackets.back();
        }
        if ((c == ')' || c == '}') && !brackets.empty()) {
            depth -= brackets.back();
            brackets.pop_back();
        }
        const std::string_view sign = formula.substr(i, 3);
        if ((sign == " + " || sign == " - ") && depth < never) result.push_back({i, depth});
    }
    return result;
}

}  // namespace

std::size_t visible_length(std::string_view formula, Notation notation) {
    if (notation == Notation::text) return formula.size();
    std::size_t length = 0;
    for (std::size_t i = 0; i < formula.size(); ++i) {
        const char c = formula[i];
        if (c == '\\') {
            while (i + 1 < formula.size() && std::isalpha(static_cast<unsigned char>(formula[i + 1])) != 0) ++i;
            ++length;
        } else if (c != '{' && c != '}' && c != '_' && c != '^' && c != ' ') {
            ++length;
        } else if (formula.substr(i, 3) == " + " || formula.substr(i, 3) == " - ") {
            length += 2;
        }
    }
    return length;
}

std::vector<std::string> wrap(const std::string& formula, std::size_t width, Notation notation) {
    if (visible_length(formula, notation) <= width) return {formula};
    const std::vector<Place> all = places(formula);
    // The least depth of brackets at which every part fits; the last otherwise.
    constexpr int deepest = 8;
    std::vector<std::string> parts;
    for (int depth = 0; depth <= deepest; ++depth) {
        parts.clear();
        std::size_t begin = 0;
        for (const Place& place : all) {
            if (place.depth > depth) continue;
            parts.push_back(formula.substr(begin, place.offset - begin));
            begin = place.offset + 1;
        }
        parts.push_back(formula.substr(begin));
        if (std::all_of(parts.begin(), parts.end(),
                        [&](const std::string& part) { return visible_length(part, notation) <= width; }))
            break;
    }
    std::vector<std::string> lines;
    for (const std::string& part : parts) {
        if (lines.empty() || visible_length(lines.back(), notation) + visible_length(part, notation) + 1 > width)
            lines.push_back(part);
        else
            lines.back() += " " + part;
    }
    return lines;
}

}  // namespace achilles
