#include "session/number_text.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include "output/precision.hpp"

namespace achilles {

std::string typeset_sentence(std::string text) {
    for (const auto& [plain, symbol] :
         {std::pair{"tau_inf", "\u03c4\u221e"}, std::pair{"tau_k", "\u03c4\u2096"}, std::pair{"_inf", "\u221e"},
          std::pair{" - ", " \u2212 "}, std::pair{" deg/s", "\u00b0/s"}, std::pair{"^2", "\u00b2"},
          std::pair{"^3", "\u00b3"}})
        for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at + 1))
            text.replace(at, std::string_view(plain).size(), symbol);
    // Only in powers of ten, not in compound words.
    for (std::size_t at = text.find("e-"); at != std::string::npos; at = text.find("e-", at + 1))
        if (at + 2 < text.size() && std::isdigit(static_cast<unsigned char>(text[at + 2])) != 0)
            text.replace(at + 1, 1, "\u2212");
    return text;
}

std::string number(double value, const char* format) {
    std::string text = fmt::format(fmt::runtime(format), value + 0.0);
    // A value rounded to zero gets no sign.
    if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
    return with_minus(std::move(text));
}

std::string with_minus(std::string text) {
    for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at + 1))
        text.replace(at, 1, "\u2212");
    return text;
}

std::string number(double value, double error, int digits) { return with_minus(known_digits(value, error, digits)); }

std::string number_with_decimals(double value, double error, int decimals) {
    if (!std::isfinite(error)) return unknown_number;
    return number(value, fmt::format("{{:.{}f}}", known_decimals(error, decimals)).c_str());
}

std::string number_of_size(double value, double size, int decimals, double error) {
    const bool fits = size == 0.0 || (size >= std::pow(10.0, 1 - decimals) && size < 1e6);
    if (fits) return number_with_decimals(value, error, decimals);
    if (!std::isfinite(error)) return unknown_number;
    const int digits = count_of_known_digits(value, error, decimals + 1);
    return digits == 0 ? "0" : number(value, fmt::format("{{:.{}e}}", digits - 1).c_str());
}

std::string number_with_unit(const std::string& number, const std::string& unit) {
    const bool is_joined = unit.empty() || unit[0] == '\xc2';  // degree sign
    return is_joined ? number + unit : number + "\u00a0" + unit;
}

}  // namespace achilles
