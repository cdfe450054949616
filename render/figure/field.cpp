#include "figure/field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

// Where a straight line between two corners of different signs is zero.
template <class Corner>
Point crossing(const Corner& a, const Corner& b) {
    const double s = a.value / (a.value - b.value);
    return {a.at.x + s * (b.at.x - a.at.x), a.at.y + s * (b.at.y - a.at.y)};
}

template <class Corner>
bool crosses(const Corner& a, const Corner& b) {
    return (a.value < 0.0) != (b.value < 0.0) && std::isfinite(a.value) && std::isfinite(b.value);
}

}  // namespace

Field::Field(const Drawing& limits, const PlaneFunction& value, int columns, int rows)
    : limits_(limits), columns_(columns), rows_(rows) {
    limits_.shapes.clear();
    values_.resize(static_cast<std::size_t>((columns_ + 1) * (rows_ + 1)));
    for (int j = 0; j <= rows_; ++j)
        for (int i = 0; i <= columns_; ++i)
            values_[static_cast<std::size_t>(j * (columns_ + 1) + i)] = value(corner(i, j).at);
}

Field::Corner Field::corner(int column, int row) const {
    return {{limits_.x_low + (limits_.x_high - limits_.x_low) * column / columns_,
             limits_.y_low + (limits_.y_high - limits_.y_low) * row / rows_},
            values_[static_cast<std::size_t>(row * (columns_ + 1) + column)]};
}

Field Field::least(std::span<const Field> fields) {
    Field result = fields[0];
    for (const Field& field : fields)
        for (std::size_t i = 0; i < field.values_.size(); ++i)
            result.values_[i] = std::min(result.values_[i], field.values_[i]);
    return result;
}

std::vector<Point> Field::level_line(double level) const {
    std::vector<Point> line;
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    for (int j = 0; j < rows_; ++j) {
        const double* const low = values_.data() + static_cast<std::ptrdiff_t>(j) * (columns_ + 1);
        const double* const high = low + columns_ + 1;
        for (int i = 0; i < columns_; ++i) {
            const bool is_below = low[i] < level;  // as the three others, nearly everywhere
            if ((low[i + 1] < level) == is_below && (high[i] < level) == is_below && (high[i + 1] < level) == is_below)
                continue;
            std::array cell{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
            for (Corner& corner : cell) corner.value -= level;
            std::vector<Point> crossings;
            for (std::size_t k = 0; k < 4; ++k)
                if (crosses(cell[k], cell[(k + 1) % 4])) crossings.push_back(crossing(cell[k], cell[(k + 1) % 4]));
            // Two of them, or four in a saddle, which is two segments.
            for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
                line.insert(line.end(), {crossings[k], crossings[k + 1], {nothing, nothing}});
        }
    }
    return line;
}

std::vector<std::vector<Point>> Field::not_negative() const {
    std::vector<std::vector<Point>> parts;
    for (int j = 0; j < rows_; ++j) {
        int begin = 0;  // of whole cells side by side, which are one rectangle
        const auto close = [&](int end) {
            if (begin < end)
                parts.push_back(
                    {corner(begin, j).at, corner(end, j).at, corner(end, j + 1).at, corner(begin, j + 1).at});
        };
        for (int i = 0; i < columns_; ++i) {
            const std::array cell{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
            std::vector<Point> part;
            int inside = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const Corner &a = cell[k], &b = cell[(k + 1) % 4];
                if (a.value >= 0.0) part.push_back(a.at), ++inside;
                if (crosses(a, b)) part.push_back(crossing(a, b));
            }
            if (inside == 4) continue;
            close(i);
            begin = i + 1;
            if (part.size() >= 3) parts.push_back(part);
        }
        close(columns_);
    }
    return parts;
}

double Field::largest() const {
    double size = 0.0;
    for (const double value : values_)
        if (std::isfinite(value)) size = std::max(size, std::abs(value));
    return size;
}

std::array<double, 2> Field::range() const {
    std::vector<double> values;
    for (const double value : values_)
        if (std::isfinite(value)) values.push_back(value);
    if (values.empty()) return {1.0, -1.0};
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const std::array<double, 2> all{*low, *high};
    const auto share = [&](double part) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        return *at;
    };
    constexpr double few = 0.05, far = 4.0;
    const std::array<double, 2> most{share(few), share(1.0 - few)};
    return all[1] - all[0] > far * (most[1] - most[0]) && most[1] > most[0] ? most : all;
}

std::vector<std::vector<Point>> borders(std::span<const Field> fields, std::span<const PlaneFunction> functions) {
    constexpr double rounding = 1e-3;  // of a line made of chords: where functions touch, or are the same, both count
    std::vector<double> below;
    for (const Field& field : fields) below.push_back(-rounding * field.largest());
    std::vector<std::vector<Point>> all(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const std::vector<Point> line = fields[i].zero_line();
        for (std::size_t k = 0; k + 2 < line.size(); k += 3) {
            const Point middle{0.5 * (line[k].x + line[k + 1].x), 0.5 * (line[k].y + line[k + 1].y)};
            bool seen = true;
            for (std::size_t j = 0; j < functions.size() && seen; ++j)
                seen = j == i || !(functions[j](middle) < below[j]);
            if (seen)
                all[i].insert(all[i].end(), line.begin() + static_cast<std::ptrdiff_t>(k),
                              line.begin() + static_cast<std::ptrdiff_t>(k + 3));
        }
    }
    return all;
}

std::vector<Point> border(const Drawing& limits, std::span<const PlaneFunction> functions) {
    std::vector<Field> fields;
    for (const PlaneFunction& function : functions) fields.emplace_back(limits, function);
    std::vector<Point> all;
    for (const std::vector<Point>& line : borders(fields, functions)) all.insert(all.end(), line.begin(), line.end());
    return all;
}

}  // namespace achilles
