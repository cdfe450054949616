// A sweep as a table: which columns it has, and the rows of some of its points.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "study/measures.hpp"

namespace achilles {

// Rows of points that follow one another: one each, or of a section as many as it has moments, and one with nothing in it
// where it has none. Column by column.
struct Rows {
    std::vector<std::uint64_t> points;
    std::vector<double> numbers;  // the measures, row by row
    std::vector<ContactSet> held;
    std::vector<RunEnd> ends;
    std::vector<std::uint64_t> signatures;  // of the whole run, in each of its rows (signature_of)
    std::vector<double> times;              // of a section; no number in a row without a moment
    std::vector<ContactSet> contacts;       // of a section, the event's
    std::size_t count() const { return points.size(); }
    friend bool operator==(const Rows&, const Rows&) = default;
};

class SweepTable {
 public:
    // Throws InputError where an expression means nothing.
    SweepTable(std::shared_ptr<const Model> model, Sweep sweep);
    SweepTable(const SweepTable&) = delete;
    SweepTable& operator=(const SweepTable&) = delete;
    ~SweepTable();

    const Model& model() const { return *model_; }
    const Sweep& sweep() const { return sweep_; }
    const RunMeasures& measures() const { return measures_; }
    bool is_section() const { return sweep_.at.has_value(); }

    // The rows of points first, ..., first + count - 1: the same whatever others are asked for, before or at once on other
    // threads. `before_each` run it is called, and may throw: that is how a caller cancels.
    Rows rows(std::uint64_t first, std::uint64_t count, const std::function<void()>& before_each = {}) const;

 private:
    struct Worker;  // what one thread keeps from one question to the next
    struct Workers;
    // run_of(i): the run at point first + i.
    using RunOf = std::function<Run(std::size_t)>;
    Rows ends(Worker& worker, std::uint64_t first, std::uint64_t count, const RunOf& run_of) const;
    Rows one_by_one(Worker& worker, std::uint64_t first, std::uint64_t count, const RunOf& run_of) const;
    void add_sections(Measuring& measuring, const Trajectory& trajectory, std::uint64_t point, Rows& rows) const;
    void add_nothing(std::uint64_t point, RunEnd end, std::uint64_t signature, Rows& rows) const;

    std::shared_ptr<const Model> model_;
    Sweep sweep_;
    SweepPoints points_;
    RunMeasures measures_;
    std::unique_ptr<Workers> workers_;
};

// The table of a sweep, or what is there of it, as a value: what its figures are made from. A coarse grid is the data of a
// sweep with fewer points.
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
