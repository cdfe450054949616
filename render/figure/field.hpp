// A function over a part of a plane, sampled on a grid: its zero line, and where it is not negative.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "figure/drawing.hpp"

namespace achilles {

using PlaneFunction = std::function<double(const Point&)>;

class Field {
 public:
    // Samples over the limits.
    Field(const Drawing& limits, const PlaneFunction& value);

    // By marching squares: segments, separated by NaN points.
    std::vector<Point> zero_line() const;
    // Convex polygons that fill the part where the function is zero or above; none covers another.
    std::vector<std::vector<Point>> not_negative() const;
    double largest() const;  // size of a value

 private:
    static constexpr int columns = 160, rows = 120;
    struct Corner {
        Point at;
        double value;
    };
    Corner corner(int column, int row) const;

    Drawing limits_;
    std::vector<double> values_;  // row by row
};

// The border of where none of several functions is negative: the zero line of each, less where another is negative.
std::vector<Point> border(const Drawing& limits, std::span<const PlaneFunction> functions);

}  // namespace achilles
