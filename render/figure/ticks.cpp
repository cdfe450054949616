#include "figure/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

struct Step {
    double size = 1.0;
    int minor = 5;  // the parts it is cut into by minor ticks
};

// The finest of 1, 2, 5 times a power of ten that puts at most `most` multiples between the limits.
Step nice_step(double low, double high, int most) {
    const double slack = 1e-9 * (high - low);
    double power = std::pow(10.0, std::floor(std::log10((high - low) / most)));
    for (;; power *= 10.0) {
        for (const Step& step : {Step{power, 5}, Step{2.0 * power, 4}, Step{5.0 * power, 5}}) {
            const double first = std::ceil((low - slack) / step.size), last = std::floor((high + slack) / step.size);
            if (last - first + 1.0 <= most) return step;
        }
    }
}

// i * step without the error of the product: 3 * 0.1 is 0.3.
double multiple(double i, double step) {
    if (step >= 1.0) return i * step;
    return i / std::round(1.0 / step);
}

std::string superscript(int exponent) {
    const char* digits[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                            "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    std::string text = exponent < 0 ? "\u207B" : "";
    for (const char digit : std::to_string(std::abs(exponent))) text += digits[digit - '0'];
    return text;
}

std::string with_minus(std::string text) {
    if (text[0] != '-') return text;
    const bool zero = text.find_first_of("123456789") == std::string::npos;
    return zero ? text.substr(1) : "\u2212" + text.substr(1);
}

int decimals_of(double step) { return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9))); }

}  // namespace

std::string tick_label(double value, double step) {
    const double size = std::max(std::abs(value), step);
    if (size < 1e5 && (step >= 1e-4 || size >= 1e-2))
        return with_minus(fmt::format("{:.{}f}", value, decimals_of(step)));
    if (value == 0.0) return "0";
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-12));
    const double mantissa = value / std::pow(10.0, exponent);
    const int decimals = std::max(0, exponent - static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    return with_minus(fmt::format("{:.{}f}", mantissa, std::min(decimals, 12))) + "\u00D710" + superscript(exponent);
}

void set_ticks(Axis& axis, double low, double high, double margin, int most) {
    if (!std::isfinite(low) || !std::isfinite(high) || low > high) low = 0.0, high = 1.0;
    // A range below the resolution of its numbers is a constant: it gets room to be seen as one.
    const double size = std::max(std::abs(low), std::abs(high));
    if (high - low <= 1e-9 * size || high == low) {
        const double room = size > 0.0 ? 0.1 * size : 1.0;
        low -= room;
        high += room;
    } else {
        const double room = margin * (high - low);
        low -= room;
        high += room;
    }
    axis.low = low;
    axis.high = high;
    axis.ticks.clear();
    const Step step = nice_step(low, high, std::max(2, most));
    const double minor = step.size / step.minor, slack = 1e-9 * (high - low);
    for (double i = std::ceil((low - slack) / minor); i * minor <= high + slack; ++i) {
        const bool major = std::fmod(std::abs(i), step.minor) == 0.0;
        const double value = major ? multiple(i / step.minor, step.size) : i * minor;
        axis.ticks.push_back({value, major ? tick_label(value, step.size) : ""});
    }
}

}  // namespace achilles
