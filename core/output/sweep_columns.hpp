// The results of a sweep as columns in memory.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "../analysis/sweep.hpp"

namespace achilles {

class Model;
class SweepTable;

// One quantity by rows: numbers, where NaN means that it does not exist, or words (contact, held, outcome).
struct SweepColumn {
    std::string name, unit;  // as in the CSV; unit: "" if unknown
    std::vector<double> numbers;
    std::vector<std::string> words;
};

// The columns of a sweep, as in its CSV: the axes, for a section t and contact, the prints, outcome. There is one row
// per point, or per crossing of a section, in the order of the points; the last axis varies fastest.
struct SweepColumns {
    std::vector<SweepColumn> all;
    std::size_t rows() const { return all.empty() ? 0 : all.back().words.size(); }
    // The first column with this name. Throws InputError, with a suggestion, if there is none.
    const SweepColumn& operator[](std::string_view name) const;
};

// Computes the runs of a sweep on `threads` threads (0: one per core); the result does not depend on this number.
// `go_on`, if given, is called from time to time with the number of points done. If it returns false, the sweep stops
// and the columns have only the points up to there. Throws InputError for an invalid expression.
SweepColumns sweep_columns(const std::shared_ptr<const Model>& model, const SweepSpec& sweep, int threads = 0,
                           const std::function<bool(std::uint64_t done)>& go_on = {});

}  // namespace achilles
