// The panels that figures of a sweep are made of.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "figure/palette.hpp"
#include "figure/sweep_figure.hpp"

namespace achilles {

// What a legend says.
inline constexpr const char *sequence_changes = "the sequence of events changes", *no_value = "no value";
// In place of lines at each change, where there are so many that they would hide what they divide.
inline constexpr const char *broken_at_changes = "broken where the sequence of events changes",
                            *changes_too_often = "the sequence of events changes too often to draw";

// One column of the data, whatever it holds.
class SweepColumn {
 public:
    SweepColumn(const SweepData& data, std::size_t column);

    bool is_number() const { return number_.has_value(); }
    // Of whole numbers, between which there is nothing.
    bool is_count() const;
    // As it is read in a label, and with its unit.
    std::string name() const;
    std::string label() const;
    const ShownUnit& unit() const { return unit_; }
    // In that unit.
    double number(std::size_t row) const { return unit_.factor * data_->number(row, *number_); }
    // All that there are, in no order.
    std::vector<double> numbers() const;
    // The least and the greatest number; [nan, nan] without any.
    std::array<double, 2> range() const;
    // Of a class, what is the same for rows of one; nothing: it has no value.
    std::optional<std::uint64_t> code(std::size_t row) const;
    bool has_value(std::size_t row) const;
    // The classes that occur, most important first, with their names: contacts as in the file, outcomes and sequences by how
    // many rows they have.
    std::vector<std::pair<std::uint64_t, std::string>> classes() const;

 private:
    enum class Kind { number, held, outcome, sequence };
    std::string class_name(std::uint64_t code, std::size_t place, double share) const;
    const SweepData* data_;
    Kind kind_;
    std::string name_;
    std::string quantity_, by_;  // of a derivative
    ShownUnit unit_;
    std::optional<std::size_t> number_;
};

// The classes of a column, each with its colour: those beyond the palette share one.
struct SweepClasses {
    SweepClasses(const SweepColumn& column, const Theme& theme);
    struct One {
        std::uint64_t code;
        std::string name;
        Color color;
    };
    std::vector<One> all;
    Color color(std::uint64_t code) const;
    std::size_t place(std::uint64_t code) const;
    // Keys of a legend: markers without points.
    std::vector<Markers> keys() const;
    std::size_t named = 0;  // the others share a key
};

// The colours of a column's numbers, and the bar that tells what they mean; without numbers there is no bar.
struct NumberColors {
    NumberColors(const SweepColumn& column, const SweepLook& look);
    Color operator()(double value) const;
    std::vector<Color> table;
    ColorBar bar;
};

// The colours of a column, whatever it holds.
struct ColumnColors {
    ColumnColors(const SweepColumn& column, const Theme& theme, const SweepLook& look);
    Color operator()(std::size_t row) const;  // of one that has a value
    void explain(Panel& panel) const;
    // One of them.
    std::optional<NumberColors> numbers;
    std::optional<SweepClasses> classes;

 private:
    const SweepColumn* column_;
};

// An axis of the sweep in the unit that is shown.
SweepAxis shown_axis(const SweepData& data, std::size_t axis);
// The same along one of a panel, with its limits.
Axis axis_of(const SweepData& data, std::size_t axis);
// The row of every point of a grid; no_row where it is not there yet.
inline constexpr std::uint32_t no_row = ~std::uint32_t{0};
std::vector<std::uint32_t> rows_of_points(const SweepData& data);
// Where value i of an axis of the sweep begins and ends: half of the way to its neighbours, on a logarithmic axis as factors.
double edge_of(const SweepAxis& axis, double i);

// "no value": where it occurs.
Hatch nothing(const Theme& theme);
// Without any numbers it has none along it: they would be invented.
void set_limits(Axis& axis, const std::array<double, 2>& range, double margin);

Panel curves_panel(const SweepData& data, std::span<const SweepColumn> columns, const Theme& theme,
                   const SweepLook& look);
Panel classes_panel(const SweepData& data, const SweepColumn& column, const Theme& theme);
Panel map_panel(const SweepData& data, const SweepColumn& column, const Theme& theme, const SweepLook& look);
Panel diagram_panel(const SweepData& data, const SweepColumn& column, const Theme& theme, const SweepLook& look);
Panel section_panel(const SweepData& data, const SweepColumn& x, const SweepColumn& y, const Theme& theme);
Panel samples_panel(const SweepData& data, const SweepColumn& column, const Theme& theme, const SweepLook& look);

}  // namespace achilles
