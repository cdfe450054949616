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

std::string power_of_ten(int exponent) { return "10" + superscript(exponent); }

std::string tick_label(double value, double step, double largest) {
    const double size = std::max({std::abs(value), step, largest});
    if (size < 1e6 && (step >= 1e-4 || size >= 1e-2))
        return with_minus(fmt::format("{:.{}f}", value, decimals_of(step)));
    if (value == 0.0) return "0";
    const double scale = std::max(std::abs(value), largest);
    const int finest = static_cast<int>(std::floor(std::log10(step) + 1e-9));
    int exponent = static_cast<int>(std::floor(std::log10(scale) + 1e-12));
    // 2, 4, ... 10 times a power reads better than 0.2, 0.4, ... 1.0 times the next.
    if (exponent == finest + 1) exponent = finest;
    const double mantissa = value / std::pow(10.0, exponent);
    const int decimals = std::max(0, exponent - finest);
    return with_minus(fmt::format("{:.{}f}", mantissa, std::min(decimals, 12))) + "\u00D710" + superscript(exponent);
}

namespace {

// 10^exponent, as exact as a number can be.
double decade(int exponent) { return std::pow(10.0, exponent); }

void set_linear(Axis& axis, double low, double high, double margin, int most) {
    // Beyond these sizes the width of the range, or a step, would overflow or vanish.
    low = std::clamp(low, -1e300, 1e300);
    high = std::clamp(high, -1e300, 1e300);
    // A range below the resolution of its numbers is a constant: it gets room to be seen as one.
    const double size = std::max(std::abs(low), std::abs(high));
    double room = margin * (high - low);
    if (high - low <= std::max(1e-9 * size, 1e-300)) room = size > 1e-290 ? 0.1 * size : 1.0;
    axis.low = low -= room;
    axis.high = high += room;
    const Step step = nice_step(low, high, most);
    const double minor = step.size / step.minor, slack = 1e-9 * (high - low);
    const double first = std::ceil((low - slack) / step.size), last = std::floor((high + slack) / step.size);
    const double largest = step.size * std::max(std::abs(first), std::abs(last));
    for (double i = std::ceil((low - slack) / minor); i * minor <= high + slack; ++i) {
        const bool major = std::fmod(std::abs(i), step.minor) == 0.0;
        const double value = major ? multiple(i / step.minor, step.size) : i * minor;
        axis.ticks.push_back({value, major ? tick_label(value, step.size, largest) : ""});
    }
}

// The label of 10^exponent; `plain` where a whole axis is short enough to write out.
std::string decade_label(int exponent, bool plain) {
    if (plain) return fmt::format("{:.{}f}", decade(exponent), std::max(0, -exponent));
    return power_of_ten(exponent);
}

// Powers of ten, every k-th one labelled, and 2 to 9 between them. Few powers of ten say little: 2 and 5 are labelled
// as well where there is room.
void set_decades(Axis& axis, int first, int last, int most) {
    const double least = axis.low * (1.0 - 1e-12), greatest = axis.high * (1.0 + 1e-12);
    const auto inside = [&](double value) { return value >= least && value <= greatest; };
    const auto at = [](int digit, int k) { return k < 0 ? digit / decade(-k) : digit * decade(k); };
    const int every = std::max(1, static_cast<int>(std::ceil(static_cast<double>(last - first + 1) / most)));
    int fine = 0;
    for (int k = first; k <= last; ++k)
        for (const int digit : {1, 2, 5}) fine += inside(at(digit, k)) ? 1 : 0;
    const bool plain = first >= -4 && last <= 5;
    for (int k = first; k <= last; ++k) {
        for (int digit = 1; digit <= (every > 1 ? 1 : 9); ++digit) {
            if (!inside(at(digit, k))) continue;
            std::string label;
            if (digit == 1 && k % every == 0) label = decade_label(k, plain);
            if (fine <= most && (digit == 2 || digit == 5)) label = tick_label(at(digit, k), decade(k));
            axis.ticks.push_back({at(digit, k), label});
        }
    }
}

void set_logarithmic(Axis& axis, double low, double high, double margin, int most) {
    high = high > 1e-290 ? std::min(high, 1e300) : 1.0;
    // What is not positive has no place on this axis.
    low = low > 0.0 ? std::clamp(low, std::min(1e-300, high), high) : 1e-6 * high;
    double from = std::log10(low), to = std::log10(high);
    const double room = to - from < 1e-9 ? 0.5 : margin * (to - from);
    from -= room;
    to += room;
    axis.low = room == 0.0 ? low : std::pow(10.0, from);
    axis.high = room == 0.0 ? high : std::pow(10.0, to);
    set_decades(axis, static_cast<int>(std::floor(from)), static_cast<int>(std::ceil(to)), most);
    const auto labels =
        std::count_if(axis.ticks.begin(), axis.ticks.end(), [](const Tick& t) { return !t.label.empty(); });
    if (labels >= 2) return;
    // Less than a factor of three or so: the ticks of a linear axis.
    Axis linear;
    set_linear(linear, axis.low, axis.high, 0.0, most);
    axis.ticks = linear.ticks;
}

}  // namespace

void set_ticks(Axis& axis, double low, double high, double margin, int most) {
    if (!std::isfinite(low) || !std::isfinite(high) || low > high) low = 0.0, high = 1.0;
    most = std::max(2, most);
    axis.ticks.clear();
    if (axis.logarithmic)
        set_logarithmic(axis, low, high, margin, most);
    else
        set_linear(axis, low, high, margin, most);
}

}  // namespace achilles
