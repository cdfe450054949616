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

Field::Field(const Drawing& limits, const PlaneFunction& value) : limits_(limits) {
    limits_.shapes.clear();
    values_.resize(static_cast<std::size_t>((columns + 1) * (rows + 1)));
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            values_[static_cast<std::size_t>(j * (columns + 1) + i)] = value(corner(i, j).at);
}

Field::Corner Field::corner(int column, int row) const {
    return {{limits_.x_low + (limits_.x_high - limits_.x_low) * column / columns,
             limits_.y_low + (limits_.y_high - limits_.y_low) * row / rows},
            values_[static_cast<std::size_t>(row * (columns + 1) + column)]};
}

std::vector<Point> Field::zero_line() const {
    std::vector<Point> line;
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const std::array cell{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
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
    for (int j = 0; j < rows; ++j) {
        int begin = 0;  // of whole cells side by side, which are one rectangle
        const auto close = [&](int end) {
            if (begin < end)
                parts.push_back(
                    {corner(begin, j).at, corner(end, j).at, corner(end, j + 1).at, corner(begin, j + 1).at});
        };
        for (int i = 0; i < columns; ++i) {
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
        close(columns);
    }
    return parts;
}

double Field::largest() const {
    double size = 0.0;
    for (const double value : values_)
        if (std::isfinite(value)) size = std::max(size, std::abs(value));
    return size;
}

std::vector<Point> border(const Drawing& limits, std::span<const PlaneFunction> functions) {
    constexpr double rounding = 1e-3;  // of a line made of chords: where functions touch, or are the same, both count
    std::vector<Field> fields;
    std::vector<double> below;
    for (const PlaneFunction& function : functions) {
        fields.emplace_back(limits, function);
        below.push_back(-rounding * fields.back().largest());
    }
    std::vector<Point> all;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const std::vector<Point> line = fields[i].zero_line();
        for (std::size_t k = 0; k + 2 < line.size(); k += 3) {
            const Point middle{0.5 * (line[k].x + line[k + 1].x), 0.5 * (line[k].y + line[k + 1].y)};
            bool seen = true;
            for (std::size_t j = 0; j < functions.size() && seen; ++j)
                seen = j == i || !(functions[j](middle) < below[j]);
            if (seen)
                all.insert(all.end(), line.begin() + static_cast<std::ptrdiff_t>(k),
                           line.begin() + static_cast<std::ptrdiff_t>(k + 3));
        }
    }
    return all;
}

}  // namespace achilles
