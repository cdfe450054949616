// The table of a sweep, or what is there of it, as a value: what its figures are made from. A coarse grid is the data of a
// sweep with fewer points.
#pragma once

#include <string>
#include <vector>

#include "study/table.hpp"

namespace achilles {

struct SweepData {
    SweepData() = default;
    // Without rows.
    explicit SweepData(const SweepTable& table);

    // Rows of points that are not there yet, in any order.
    void add(const Rows& more);
    // One of them.
    void add(const Rows& more, std::size_t row);

    bool is_section() const { return sweep.at.has_value(); }
    std::size_t count() const { return rows.count(); }
    double number(std::size_t row, std::size_t number) const { return rows.numbers[row * numbers + number]; }
    // What an axis is in a row.
    double value(std::size_t axis, std::size_t row) const { return sweep.value(axis, rows.points[row]); }

    Sweep sweep;
    std::vector<std::string> names, units;  // of its axes: x(0) where x is of the start; "" where no unit is known
    std::vector<RunMeasures::Column> columns;
    std::size_t numbers = 0;  // in a row: of the columns, those with numbers
    std::vector<std::string> contacts;
    Rows rows;
};

}  // namespace achilles
