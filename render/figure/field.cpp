#include "figure/field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace achilles {

namespace {

// Zero of the linear interpolation between two corners with different signs.
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

ScalarField::ScalarField(const Drawing& limits, const PlaneFunction& value, int columns, int rows)
    : value_(value), limits_(limits), columns_(columns), rows_(rows) {
    limits_.shapes.clear();
    values_.resize(static_cast<std::size_t>((columns_ + 1) * (rows_ + 1)));
    for (int j = 0; j <= rows_; ++j)
        for (int i = 0; i <= columns_; ++i)
            values_[static_cast<std::size_t>(j * (columns_ + 1) + i)] = value(corner(i, j).at);
}

ScalarField::Corner ScalarField::corner(int column, int row) const {
    return {{limits_.x_low + (limits_.x_high - limits_.x_low) * column / columns_,
             limits_.y_low + (limits_.y_high - limits_.y_low) * row / rows_},
            values_[static_cast<std::size_t>(row * (columns_ + 1) + column)]};
}

ScalarField ScalarField::least(std::span<const ScalarField> fields) {
    ScalarField result = fields[0];
    for (const ScalarField& field : fields)
        for (std::size_t i = 0; i < field.values_.size(); ++i)
            result.values_[i] = std::min(result.values_[i], field.values_[i]);
    std::vector<PlaneFunction> all;
    for (const ScalarField& field : fields) all.push_back(field.value_);
    result.value_ = [all](const Point& p) {
        double least = all[0](p);
        for (std::size_t i = 1; i < all.size(); ++i) least = std::min(least, all[i](p));
        return least;
    };
    return result;
}

ScalarField::Square ScalarField::cell(int column, int row) const {
    return {corner(column, row), corner(column + 1, row), corner(column + 1, row + 1), corner(column, row + 1)};
}

// Whether the zero line may cross a cell. Either the values at its corners change sign, or they are so close to zero
// compared with their curvature over a cell that a crest may reach into the cell.
bool ScalarField::may_be_crossed(int column, int row) const {
    const auto at = [&](int i, int j) { return values_[static_cast<std::size_t>(j * (columns_ + 1) + i)]; };
    double low = std::numeric_limits<double>::infinity(), high = -low, bend = 0.0;
    for (int j = row; j <= row + 1; ++j)
        for (int i = column; i <= column + 1; ++i) {
            const double here = at(i, j);
            if (!std::isfinite(here)) return true;
            low = std::min(low, here), high = std::max(high, here);
            const double across = i > 0 && i < columns_ ? std::abs(at(i - 1, j) - 2.0 * here + at(i + 1, j)) : 0.0;
            const double upwards = j > 0 && j < rows_ ? std::abs(at(i, j - 1) - 2.0 * here + at(i, j + 1)) : 0.0;
            bend = std::max(bend, across + upwards);
        }
    constexpr double share = 0.25;  // 1/8 for a parabola
    return low <= share * bend && high >= -share * bend;
}

std::vector<ScalarField::Square> ScalarField::parts_of(const Square& cell) const {
    constexpr int n = 4;
    std::array<std::array<Corner, n + 1>, n + 1> grid;
    const Point &from = cell[0].at, &to = cell[2].at;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            // The corners themselves, so that lines in adjacent cells meet.
            const bool is_corner = (i == 0 || i == n) && (j == 0 || j == n);
            const std::size_t which = j == 0 ? (i == 0 ? 0 : 1) : (i == 0 ? 3 : 2);
            Corner& corner = grid[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
            corner = is_corner ? cell[which]
                               : corner_at({i == n ? to.x : from.x + (to.x - from.x) * i / n,
                                            j == n ? to.y : from.y + (to.y - from.y) * j / n});
        }
    std::vector<Square> parts;
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
            parts.push_back({grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]});
    return parts;
}

// Zero on the edge between two corners with different signs, by regula falsi (Illinois). The direction is independent
// of the cell.
Point ScalarField::zero_between(const Corner& a, const Corner& b) const {
    constexpr int rounds = 6;
    const bool turned = a.at.x > b.at.x || (a.at.x == b.at.x && a.at.y > b.at.y);
    Corner low = turned ? b : a, high = turned ? a : b;
    const double small = 1e-9 * (std::abs(a.value) + std::abs(b.value));
    Point at = crossing(low, high);
    for (int round = 0; round < rounds; ++round) {
        const Corner middle = corner_at(at);
        if (!std::isfinite(middle.value) || std::abs(middle.value) <= small) break;
        Corner& other = crosses(low, middle) ? low : high;
        (crosses(low, middle) ? high : low) = middle;
        other.value *= 0.5;
        at = crossing(low, high);
    }
    return at;
}

std::vector<Point> ScalarField::zero_line() const {
    std::vector<Point> line;
    for (int j = 0; j < rows_; ++j)
        for (int i = 0; i < columns_; ++i) {
            if (!may_be_crossed(i, j)) continue;
            for (const Square& part : parts_of(cell(i, j))) {
                std::vector<Point> zeros;
                for (std::size_t k = 0; k < 4; ++k)
                    if (crosses(part[k], part[(k + 1) % 4])) zeros.push_back(zero_between(part[k], part[(k + 1) % 4]));
                // Two zeros, or four in a saddle, which form two segments.
                for (std::size_t k = 0; k + 1 < zeros.size(); k += 2)
                    line.insert(line.end(), {zeros[k], zeros[k + 1], break_of_curve});
            }
        }
    return line;
}

std::vector<Point> ScalarField::level_line(double level) const {
    std::vector<Point> line;
    for (int j = 0; j < rows_; ++j) {
        const double* const low = values_.data() + static_cast<std::ptrdiff_t>(j) * (columns_ + 1);
        const double* const high = low + columns_ + 1;
        for (int i = 0; i < columns_; ++i) {
            const bool is_below = low[i] < level;  // the other three corners are alike in nearly all cells
            if ((low[i + 1] < level) == is_below && (high[i] < level) == is_below && (high[i + 1] < level) == is_below)
                continue;
            std::array cell{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
            for (Corner& corner : cell) corner.value -= level;
            std::vector<Point> crossings;
            for (std::size_t k = 0; k < 4; ++k)
                if (crosses(cell[k], cell[(k + 1) % 4])) crossings.push_back(crossing(cell[k], cell[(k + 1) % 4]));
            // Two crossings, or four in a saddle, which form two segments.
            for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
                line.insert(line.end(), {crossings[k], crossings[k + 1], break_of_curve});
        }
    }
    return line;
}

std::vector<std::vector<Point>> ScalarField::not_negative() const {
    std::vector<std::vector<Point>> parts;
    // Adjacent squares that are entirely inside are merged into one rectangle.
    std::optional<std::pair<Square, Square>> run;  // the first and the last square of a row
    const auto close = [&] {
        if (run) parts.push_back({run->first[0].at, run->second[1].at, run->second[2].at, run->first[3].at});
        run.reset();
    };
    const auto add = [&](const Square& square) {
        std::vector<Point> part;
        int inside = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const Corner &a = square[k], &b = square[(k + 1) % 4];
            if (a.value >= 0.0) part.push_back(a.at), ++inside;
            if (crosses(a, b)) part.push_back(zero_between(a, b));
        }
        if (inside == 4) {
            run = std::pair{run ? run->first : square, square};
            return;
        }
        close();
        if (part.size() >= 3) parts.push_back(part);
    };
    const auto is_inside = [](const Square& square) {
        return std::all_of(square.begin(), square.end(), [](const Corner& c) { return c.value >= 0.0; });
    };
    for (int j = 0; j < rows_; ++j) {
        for (int i = 0; i < columns_; ++i) {
            const Square square = cell(i, j);
            const std::vector<Square> fine = may_be_crossed(i, j) ? parts_of(square) : std::vector<Square>{};
            if (std::all_of(fine.begin(), fine.end(), is_inside)) {
                add(square);
                continue;
            }
            close();
            const std::size_t side = fine.size() / 4;
            for (std::size_t k = 0; k < fine.size(); ++k) {
                add(fine[k]);
                if ((k + 1) % side == 0) close();
            }
        }
        close();
    }
    return parts;
}

double ScalarField::largest() const {
    double size = 0.0;
    for (const double value : values_)
        if (std::isfinite(value)) size = std::max(size, std::abs(value));
    return size;
}

std::array<double, 2> ScalarField::range() const {
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

std::vector<std::vector<Point>> borders(std::span<const ScalarField> fields, std::span<const PlaneFunction> values) {
    constexpr double rounding = 1e-3;  // chord error relative to the largest value: where zero lines touch or coincide,
                                       // both are kept
    std::vector<double> below;
    for (const ScalarField& field : fields) below.push_back(-rounding * field.largest());
    std::vector<std::vector<Point>> all(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const std::vector<Point> line = fields[i].zero_line();
        for (std::size_t k = 0; k + 2 < line.size(); k += 3) {
            const Point middle{0.5 * (line[k].x + line[k + 1].x), 0.5 * (line[k].y + line[k + 1].y)};
            bool seen = true;
            for (std::size_t j = 0; j < values.size() && seen; ++j) seen = j == i || !(values[j](middle) < below[j]);
            if (seen)
                all[i].insert(all[i].end(), line.begin() + static_cast<std::ptrdiff_t>(k),
                              line.begin() + static_cast<std::ptrdiff_t>(k + 3));
        }
        all[i] = joined(all[i]);
    }
    return all;
}

namespace {

// Joins segments by their ends.
class Chains {
 public:
    explicit Chains(const std::vector<Point>& segments) {
        for (std::size_t k = 0; k + 1 < segments.size(); k += 3) {
            for (const std::size_t end : {k, k + 1}) at_[key(segments[end])].push_back(ends_.size());
            ends_.push_back({segments[k], segments[k + 1]});
        }
        used_.assign(ends_.size(), false);
    }
    std::vector<Point> lines() {
        for (std::size_t i = 0; i < ends_.size(); ++i)  // starting at the ends of open lines
            for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
                if (!used_[i] && at_[key(ends_[i][end])].size() != 2) follow(i, end);
        for (std::size_t i = 0; i < ends_.size(); ++i)
            if (!used_[i]) follow(i, 0);
        return std::move(lines_);
    }

 private:
    static std::pair<double, double> key(const Point& p) { return {p.x, p.y}; }
    void follow(std::size_t segment, std::size_t from) {
        lines_.push_back(ends_[segment][from]);
        for (;;) {
            used_[segment] = true;
            const Point& end = ends_[segment][1 - from];
            lines_.push_back(end);
            const std::vector<std::size_t>& here = at_[key(end)];
            const auto next = std::find_if(here.begin(), here.end(), [&](std::size_t i) { return !used_[i]; });
            if (here.size() != 2 || next == here.end()) break;
            segment = *next;
            from = key(ends_[segment][0]) == key(end) ? 0 : 1;
        }
        lines_.push_back(break_of_curve);
    }
    std::vector<std::array<Point, 2>> ends_;
    std::map<std::pair<double, double>, std::vector<std::size_t>> at_;
    std::vector<bool> used_;
    std::vector<Point> lines_;
};

}  // namespace

std::vector<Point> joined(const std::vector<Point>& segments) { return Chains(segments).lines(); }

std::vector<Point> border(const Drawing& limits, std::span<const PlaneFunction> values, int columns, int rows) {
    std::vector<ScalarField> fields;
    for (const PlaneFunction& function : values) fields.emplace_back(limits, function, columns, rows);
    std::vector<Point> all;
    for (const std::vector<Point>& line : borders(fields, values)) all.insert(all.end(), line.begin(), line.end());
    return all;
}

}  // namespace achilles
