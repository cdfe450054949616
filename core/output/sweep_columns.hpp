// A sweep as a table in memory, column by column.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "../study/sweep.hpp"

namespace achilles {

class Model;
class SweepTable;

// Of one quantity, row by row: numbers, in which what does not exist is not a number, or words (contact, held, outcome).
struct SweepColumn {
    std::string name, unit;  // as the CSV has them; unit: "" where it is not known
    std::vector<double> numbers;
    std::vector<std::string> words;
};

// The columns of a sweep, as its CSV has them: the axes, of a section t and contact, the prints, outcome. A row for each point,
// or for each moment of a section, in the order of the points, of which the last axis is fastest.
struct SweepColumns {
    std::vector<SweepColumn> all;
    std::size_t rows() const { return all.empty() ? 0 : all.back().words.size(); }
    // The first of that name. Throws InputError where there is none, with what was probably meant.
    const SweepColumn& operator[](std::string_view name) const;
};

// Makes the runs of a sweep, on so many threads (0: one for every core): the same numbers for any of them. `go_on`, where it
// is given, is told how many points are done, now and then, and stops the sweep by false: the columns have the points until
// then. Throws InputError where an expression means nothing.
SweepColumns sweep_columns(const std::shared_ptr<const Model>& model, const Sweep& sweep, int threads = 0,
                           const std::function<bool(std::uint64_t done)>& go_on = {});

}  // namespace achilles
