#include "figure/color_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace achilles {

Color oklab(double lightness, double a, double b) {
    const auto cube = [](double x) { return x * x * x; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b),
                 m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b),
                 s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    const auto byte = [](double x) {
        const double x_in_gamut = std::clamp(x, 0.0, 1.0);
        const double shown =
            x_in_gamut <= 0.0031308 ? 12.92 * x_in_gamut : 1.055 * std::pow(x_in_gamut, 1.0 / 2.4) - 0.055;
        return static_cast<std::uint8_t>(std::lround(255.0 * shown));
    };
    return {byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 255};
}

Color number_color(double share) {
    constexpr double chroma = 0.125, turn = 190.0 / 180.0 * std::numbers::pi;
    const double s = std::clamp(share, 0.0, 1.0);
    return oklab(0.25 + 0.67 * s, chroma * std::sin(turn * s), -chroma * std::cos(turn * s));
}

std::vector<Color> number_colors(std::size_t count) {
    std::vector<Color> colors;
    for (std::size_t i = 0; i < count; ++i)
        colors.push_back(
            number_color(static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(count, 2) - 1)));
    return colors;
}

}  // namespace achilles
