#include "golden/comparer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "golden/tolerance.hpp"

namespace achilles::golden {

namespace {

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

// Removes a number from the front of the text.
std::optional<double> take_number(std::string_view& text) {
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || !std::isfinite(value)) return {};
    text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
    return value;
}

bool same_number(double a, double b) {
    const double larger = std::max(std::abs(a), std::abs(b)), apart = std::abs(a - b);
    if (apart <= absolute_allowed) return true;
    const double unit = std::pow(10.0, std::floor(std::log10(larger)) - (digits_compared - 1));
    return apart < 1.5 * unit;
}

// The column at which two lines first differ, if they do.
std::optional<std::size_t> parting(std::string_view golden, std::string_view actual) {
    const std::size_t length = golden.size();
    bool in_word = false;  // digits in a name or a color are not a number
    while (!golden.empty() && !actual.empty()) {
        std::string_view a = golden, b = actual;
        const std::optional<double> x = in_word ? std::nullopt : take_number(a), y = x ? take_number(b) : x;
        if (x && y) {
            if (!same_number(*x, *y)) break;
            golden = a, actual = b;
            in_word = true;
            continue;
        }
        if (golden[0] != actual[0]) break;
        in_word = std::isalnum(static_cast<unsigned char>(golden[0])) != 0 || golden[0] == '#';
        golden.remove_prefix(1);
        actual.remove_prefix(1);
    }
    if (golden.empty() && actual.empty()) return {};
    return length - golden.size();
}

// The part of a long line around a column.
std::string shown(std::string_view line, std::size_t column) {
    constexpr std::size_t before = 60, most = 150;
    std::size_t begin = column > before && line.size() > most ? std::min(column - before, line.size()) : 0;
    std::size_t end = std::min(begin + most, line.size());
    // Does not cut a UTF-8 character.
    const auto in_letter = [&](std::size_t i) {
        return i < line.size() && (static_cast<unsigned char>(line[i]) & 0xC0U) == 0x80U;
    };
    while (in_letter(begin)) ++begin;
    while (in_letter(end)) ++end;
    return fmt::format("{}{}{}", begin > 0 ? "..." : "", line.substr(begin, end - begin),
                       end < line.size() ? "..." : "");
}

}  // namespace

std::string difference(std::string_view golden, std::string_view actual) {
    constexpr std::size_t most = 5;  // lines of each kind
    std::vector<std::string_view> a = lines_of(golden), b = lines_of(actual);
    std::size_t line = 0;
    for (; line < std::min(a.size(), b.size()) && !parting(a[line], b[line]); ++line) {
    }
    // Skips equal lines at the end: an added or removed line must not make all following lines differ.
    while (a.size() > line && b.size() > line && !parting(a.back(), b.back())) a.pop_back(), b.pop_back();
    const std::size_t lost = a.size() - line, found = b.size() - line;
    if (lost == 0 && found == 0) return {};
    const std::size_t column = lost > 0 && found > 0 ? parting(a[line], b[line]).value_or(0) : 0;
    std::string text = fmt::format("line {}: {} of the golden lines, {} of the new ones\n", line + 1, lost, found);
    for (std::size_t i = line; i < line + std::min(lost, most); ++i)
        text += "- " + shown(a[i], i == line ? column : parting(a[i], i < b.size() ? b[i] : "").value_or(0)) + "\n";
    for (std::size_t i = line; i < line + std::min(found, most); ++i)
        text += "+ " + shown(b[i], i == line ? column : parting(i < a.size() ? a[i] : "", b[i]).value_or(0)) + "\n";
    return text;
}

}  // namespace achilles::golden
