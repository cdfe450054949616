// A scalar function sampled on a grid over a rectangle of a plane: its level lines, and the region where it is
// nonnegative.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "figure/figure.hpp"

namespace achilles {

using PlaneFunction = std::function<double(const Point&)>;

class ScalarField {
 public:
    // Samples the function at the corners of columns x rows cells over the limits.
    ScalarField(const Drawing& limits, const PlaneFunction& value, int columns = 160, int rows = 120);

    // Pointwise minimum of one or more fields over the same rectangle and grid.
    static ScalarField least(std::span<const ScalarField> fields);

    // Level line by marching squares: segments, separated by NaN points.
    std::vector<Point> level_line(double level) const;
    // Zero line on a grid that is refined wherever the line may pass. Its points lie on the zero itself.
    std::vector<Point> zero_line() const;
    // Disjoint convex polygons that fill the region where the function is nonnegative.
    std::vector<std::vector<Point>> not_negative() const;
    double largest() const;  // largest absolute value
    // Range of the values without outliers: extreme values far from all others are left out. low > high if no value is
    // finite.
    std::array<double, 2> range() const;

 private:
    struct Corner {
        Point at;
        double value = 0.0;
    };
    Corner corner(int column, int row) const;
    using Square = std::array<Corner, 4>;  // counterclockwise from the lower left
    Square cell(int column, int row) const;
    Corner corner_at(const Point& at) const { return {at, value_(at)}; }
    bool may_be_crossed(int column, int row) const;
    std::vector<Square> parts_of(const Square& cell) const;
    Point zero_between(const Corner& a, const Corner& b) const;

    PlaneFunction value_;
    Drawing limits_;
    int columns_, rows_;
    std::vector<double> values_;  // row by row
};

// Border of the region where all functions are nonnegative: the zero line of each function, without the parts where
// another is negative. Lines, separated by NaN points.
std::vector<std::vector<Point>> borders(std::span<const ScalarField> fields, std::span<const PlaneFunction> functions);
std::vector<Point> border(const Drawing& limits, std::span<const PlaneFunction> functions, int columns = 160,
                          int rows = 120);
// Joins segments that share an end into lines. Both formats are separated by NaN points.
std::vector<Point> joined(const std::vector<Point>& segments);

}  // namespace achilles
