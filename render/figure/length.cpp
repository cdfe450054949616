// Round lengths for a scale bar, and their unit.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "expression/parse.hpp"
#include "figure/camera.hpp"
#include "figure/label.hpp"
#include "figure/ticks.hpp"

namespace achilles {

double round_length(double most) {
    if (!(most > 0.0) || !std::isfinite(most)) return 0.0;
    const double decade = std::pow(10.0, std::floor(std::log10(most)));
    for (const double digit : {5.0, 2.0, 1.0})
        if (digit * decade <= most * (1.0 + 1e-12)) return digit * decade;
    return 0.5 * decade;
}

std::string length_unit(const SystemDescription& description) {
    constexpr std::array<std::string_view, 8> lengths{"m", "km", "cm", "mm", "um", "nm", "ft", "in"};
    std::set<std::string> found;
    for (const DrawingDescription& drawing : drawings_of(description))
        for (const Text& text : texts_of(drawing))
            for (const std::string& name : names_in(text.text)) {
                const std::string unit = unit_of(description, name);
                if (std::find(lengths.begin(), lengths.end(), unit) != lengths.end()) found.insert(unit);
            }
    if (drawings_of(description).empty())
        for (const CoordinateDescription& coordinate : description.coordinates)
            if (std::find(lengths.begin(), lengths.end(), coordinate.unit) != lengths.end())
                found.insert(coordinate.unit);
    return found.size() == 1 ? *found.begin() : "";
}

std::string length_label(double length, const std::string& unit) {
    const int exponent = static_cast<int>(std::floor(std::log10(length) + 1e-9));
    std::string text;
    if (exponent >= -3 && exponent <= 4) {
        text = fmt::format("{:.{}f}", length, std::max(0, -exponent));
    } else {
        const double digit = std::round(length / std::pow(10.0, exponent));
        text = (digit == 1.0 ? "" : fmt::format("{:.0f}\u00b7", digit)) + power_of_ten(exponent);
    }
    return unit.empty() ? text : text + " " + typeset_unit(unit);
}

}  // namespace achilles
