// A function over a part of a plane, sampled on a grid: its zero line, and where it is not negative.
#pragma once

#include <functional>
#include <vector>

#include "figure/drawing.hpp"

namespace achilles {

class Field {
 public:
    // Samples over the limits.
    Field(const Drawing& limits, const std::function<double(const Point&)>& value);

    // By marching squares: segments, separated by NaN points.
    std::vector<Point> zero_line() const;
    // Convex polygons that fill the part where the function is zero or above; none covers another.
    std::vector<std::vector<Point>> not_negative() const;

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

}  // namespace achilles
