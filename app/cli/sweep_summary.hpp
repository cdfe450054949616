// What a sweep came to, in a few lines: how many runs reached their end, and the range of each quantity.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "study/table.hpp"

namespace achilles {

// Counts and ranges over rows, chunk by chunk, in whichever process: they travel as bytes behind those of a chunk.
class SweepSummary {
 public:
    explicit SweepSummary(const SweepTable& table) : table_(&table), columns_(table.measures().numbers()) {}

    void note(const Rows& rows);
    // As bytes behind others, and taken away from there again: added to these.
    std::string behind(std::string bytes) const;
    std::string take(std::string bytes);

    // "Ball on a sine: 9 runs, all reached the end time", and a line for each quantity: its range, and where it does not exist.
    std::string text() const;
    // A sentence for each quantity that exists in no run.
    std::vector<std::string> nowhere() const;

 private:
    struct Column {
        std::uint64_t count = 0, missing = 0;
        std::uint64_t first = most_points, last = 0, first_missing = most_points, last_missing = 0;  // points
        double low = 0.0, high = 0.0;
    };
    struct Totals {
        std::uint64_t runs = 0, whole = 0, rows = 0, last_point = most_points;
    };
    static void add(Column& column, const Column& more);
    std::string where_missing(const Column& column) const;
    std::string name_of(std::size_t number) const;
    std::string unit_of(std::size_t number) const;
    const RunMeasures::Column& column_of(std::size_t number) const;

    const SweepTable* table_;
    Totals totals_;
    std::vector<Column> columns_;
};

}  // namespace achilles
