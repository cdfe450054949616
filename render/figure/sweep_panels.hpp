// The panels of which figures of a sweep consist.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "figure/palette.hpp"
#include "figure/sweep_figure.hpp"

namespace achilles {

// Texts of the legend.
inline constexpr const char *sequence_changes = "the sequence of events changes", *no_value = "no value";
// Replace lines at each change, if there are so many changes that the lines would hide the data.
inline constexpr const char *broken_at_changes = "broken where the sequence of events changes",
                            *changes_too_often = "the sequence of events changes too often to draw";

// One column of the data, of any kind.
class ColumnView {
 public:
    ColumnView(const SweepData& data, std::size_t column);

    bool is_number() const { return number_.has_value(); }
    // Whether the values are integers, between which nothing is defined.
    bool is_count() const;
    // Name in a label, without and with the unit.
    std::string name() const;
    std::string label() const;
    const ShownUnit& unit() const { return unit_; }
    // Value in the displayed unit.
    double number(std::size_t row) const { return unit_.factor * data_->number(row, *number_); }
    // All values, in no particular order.
    std::vector<double> numbers() const;
    // Minimum and maximum; [nan, nan] without values.
    std::array<double, 2> range() const;
    // Class of a row as a number, equal for rows of the same class; nullopt without a value.
    std::optional<std::uint64_t> code(std::size_t row) const;
    bool has_value(std::size_t row) const;
    // The classes that occur, most important first, with their names: sets of held contacts by size and then in the
    // order of the file, outcomes and sequences by their number of rows.
    std::vector<std::pair<std::uint64_t, std::string>> classes() const;

 private:
    enum class Kind { number, held, outcome, modes, sequence };
    std::string class_name(std::uint64_t code, std::size_t place, double share) const;
    const SweepData* data_;
    Kind kind_;
    std::string name_;
    std::string quantity_, by_;  // of a derivative
    ShownUnit unit_;
    std::optional<std::size_t> number_;
    std::vector<Mode> modes_;  // those that occur; the class of a row is its place
};

// The classes of a column with their colors. Classes beyond the palette share one color.
struct SweepClasses {
    SweepClasses(const ColumnView& column, const Theme& theme);
    struct ClassStyle {
        std::uint64_t code;
        std::string name;
        Color color;
    };
    std::vector<ClassStyle> all;
    Color color(std::uint64_t code) const;
    std::size_t place(std::uint64_t code) const;
    // Entries of the legend: markers without points.
    std::vector<Markers> keys() const;
    std::size_t named = 0;  // number of classes with an entry of their own; the others share one
};

// Colors of a column's numbers, and the color scale. Without numbers there is no scale.
struct NumberColors {
    NumberColors(const ColumnView& column, const SweepLook& look);
    Color operator()(double value) const;
    std::vector<Color> table;
    ColorBar bar;
};

// Colors of a column of any kind.
struct ColumnColors {
    ColumnColors(const ColumnView& column, const Theme& theme, const SweepLook& look);
    Color operator()(std::size_t row) const;  // of a row that has a value
    void explain(Panel& panel) const;
    // Exactly one of these is set.
    std::optional<NumberColors> numbers;
    std::optional<SweepClasses> classes;

 private:
    const ColumnView* column_;
};

// An axis of the sweep in its displayed unit.
SweepAxis shown_axis(const SweepData& data, std::size_t axis);
// The same as an axis of a panel, with its limits.
Axis axis_of(const SweepData& data, std::size_t axis);
// The row of every grid point; no_row if it is not computed yet.
inline constexpr std::uint32_t no_row = ~std::uint32_t{0};
std::vector<std::uint32_t> rows_of_points(const SweepData& data);
// Boundary between values i - 1 and i of an axis: their mean, geometric on a logarithmic axis.
double edge_of(const SweepAxis& axis, double i);

// Hatching with the legend text "no value".
Hatch nothing(const Theme& theme);
// Sets limits and ticks. Without any numbers the axis gets no ticks, which would be invented.
void set_limits(Axis& axis, const std::array<double, 2>& range, double margin);

Panel curves_panel(const SweepData& data, std::span<const ColumnView> columns, const Theme& theme,
                   const SweepLook& look);
Panel classes_panel(const SweepData& data, const ColumnView& column, const Theme& theme);
Panel map_panel(const SweepData& data, const ColumnView& column, const Theme& theme, const SweepLook& look);
Panel diagram_panel(const SweepData& data, const ColumnView& column, const Theme& theme, const SweepLook& look);
Panel section_panel(const SweepData& data, const ColumnView& x, const ColumnView& y, const Theme& theme);
Panel samples_panel(const SweepData& data, const ColumnView& column, const Theme& theme, const SweepLook& look);

}  // namespace achilles
