// A function over a part of a plane, sampled on a grid: its lines of equal value, and where it is not negative.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "figure/figure.hpp"

namespace achilles {

using PlaneFunction = std::function<double(const Point&)>;

class Field {
 public:
    // Samples over the limits: at the corners of so many cells across and upwards.
    Field(const Drawing& limits, const PlaneFunction& value, int columns = 160, int rows = 120);

    // The least of several over the same part, of which there is one at least.
    static Field least(std::span<const Field> fields);

    // By marching squares on the grid: segments, separated by NaN points.
    std::vector<Point> level_line(double level) const;
    // The same for zero, with a finer grid wherever the line may be and its points on the zero itself.
    std::vector<Point> zero_line() const;
    // Convex polygons that fill the part where the function is zero or above; none covers another.
    std::vector<std::vector<Point>> not_negative() const;
    double largest() const;  // size of a value
    // Where its values lie, all of them but the highest and the lowest where these are far from the others; low > high where
    // there are none.
    std::array<double, 2> range() const;

 private:
    struct Corner {
        Point at;
        double value = 0.0;
    };
    Corner corner(int column, int row) const;
    using Square = std::array<Corner, 4>;  // against the clock, from the lower left
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

// The border of where none of several functions is negative: the zero line of each, less where another is negative. Lines,
// separated by NaN points.
std::vector<std::vector<Point>> borders(std::span<const Field> fields, std::span<const PlaneFunction> functions);
std::vector<Point> border(const Drawing& limits, std::span<const PlaneFunction> functions, int columns = 160,
                          int rows = 120);
// Segments, separated by NaN points, as lines: those that share an end follow one another.
std::vector<Point> joined(const std::vector<Point>& segments);

}  // namespace achilles
