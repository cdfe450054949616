// A sweep as a table: its columns, and the rows of its points.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/measures.hpp"

namespace achilles {

// Rows of consecutive points, column by column: one row per point. For a section, one row for each of its points in a
// run, and one empty row if there are none.
struct Rows {
    std::vector<std::uint64_t> points;
    std::vector<double> numbers;  // the measures, row by row
    std::vector<ContactSet> held;
    std::vector<RunEnd> ends;
    std::vector<std::uint64_t> signatures;  // of the whole run, repeated in each of its rows (signature_of)
    std::vector<double> times;              // for a section; NaN in an empty row
    std::vector<ContactSet> contacts;       // for a section: those of the event
    std::vector<Mode> modes;                // empty unless they are printed
    std::size_t count() const { return points.size(); }
    friend bool operator==(const Rows&, const Rows&) = default;
};

class SweepTable {
 public:
    // Throws InputError if an expression is invalid.
    SweepTable(std::shared_ptr<const Model> model, SweepSpec sweep);
    SweepTable(const SweepTable&) = delete;
    SweepTable& operator=(const SweepTable&) = delete;
    ~SweepTable();

    const Model& model() const { return *model_; }
    const SweepSpec& sweep() const { return sweep_; }
    const RunMeasures& measures() const { return measures_; }
    bool is_section() const { return sweep_.at.has_value(); }

    // The rows of points first, ..., first + count - 1. They do not depend on which other rows are computed, earlier or
    // concurrently on other threads. `before_each` is called before each run and may throw, to cancel.
    Rows rows(std::uint64_t first, std::uint64_t count, const std::function<void()>& before_each = {}) const;

 private:
    struct Worker;  // data that a thread keeps between calls
    struct Workers;
    // run_of(i): the run of point first + i.
    using RunProvider = std::function<Run(std::size_t)>;
    Rows ends(Worker& worker, std::uint64_t first, std::uint64_t count, const RunProvider& run_of) const;
    Rows one_by_one(Worker& worker, std::uint64_t first, std::uint64_t count, const RunProvider& run_of) const;
    void add_sections(MeasureEvaluator& measuring, const Trajectory& trajectory, std::uint64_t point, Rows& rows) const;
    void add_nothing(std::uint64_t point, RunEnd end, std::uint64_t signature, Rows& rows) const;

    std::shared_ptr<const Model> model_;
    SweepSpec sweep_;
    SweepPoints points_;
    RunMeasures measures_;
    std::unique_ptr<Workers> workers_;
};

// The table of a sweep, or a part of it, as plain data for figures. A coarse grid is the data of a sweep with fewer
// points.
struct SweepData {
    SweepData() = default;
    // Without rows.
    explicit SweepData(const SweepTable& table);

    // Adds rows of further points, in any order.
    void add(const Rows& more);
    // Adds one of them.
    void add(const Rows& more, std::size_t row);

    bool is_section() const { return sweep.at.has_value(); }
    std::size_t count() const { return rows.count(); }
    double number(std::size_t row, std::size_t number) const { return rows.numbers[row * numbers + number]; }
    // Value of an axis in a row.
    double value(std::size_t axis, std::size_t row) const { return sweep.value(axis, rows.points[row]); }

    SweepSpec sweep;
    std::vector<std::string> names, units;  // of its axes: x(0) for an initial coordinate x; "" for an unknown unit
    std::vector<RunMeasures::Column> columns;
    std::size_t numbers = 0;  // number of columns with numbers
    std::vector<std::string> contacts;
    std::vector<std::pair<std::size_t, std::string>> sliding;  // with friction: number in a Mode, and name
    Rows rows;
};

}  // namespace achilles
