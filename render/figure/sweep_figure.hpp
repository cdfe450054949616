// Figures of a sweep: curves over one axis, maps over two axes, diagrams of sections, random samples.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/table.hpp"
#include "figure/figure.hpp"
#include "figure/label.hpp"

namespace achilles {

// Pseudo column: the sequences of events, as classes.
inline constexpr std::size_t sequence_column = ~std::size_t{0};
// Limits of a figure: rows of the table, and values on an axis of a map.
inline constexpr std::uint64_t max_drawn_rows = std::uint64_t{1} << 24, max_map_side = 4096;

struct SweepLook {
    std::vector<std::size_t> columns;  // of the data; empty: all columns, or the outcome if there are none
    bool dark = false, transparent = false;
    bool contours = true;  // of a map: lines between cells with different sequences of events
    // Limits of the axis of the numbers, or of their color scale. Without limits they fit the data.
    std::optional<std::array<double, 2>> range;
    // Size of the picture in layout points. Maps too narrow side by side are placed below one another. Height 0: it
    // follows from the panels. Width 0: the panels are side by side.
    double width = 0.0, height = 0.0;
};

// Displayed unit of an axis. A parameter is shown in degrees exactly if its slider is: angles are, the frequency of a
// drive is not.
ShownUnit shown_unit_of_axis(const SweepData& data, std::size_t axis);

// Throws InputError if such a sweep has no figure, and says which choice would have one. Independent of the rows.
void check_drawn(const SweepData& data, const SweepLook& look);

// Columns left out of the figure: non-numeric columns of a section.
std::vector<std::string> left_out(const SweepData& data, const SweepLook& look);

// Columns of the figure in which some row has a value, as selected by `look`; for a section the numeric ones.
std::vector<std::size_t> columns_with_values(const SweepData& data, const SweepLook& look);

// Composes the figure of a sweep. Throws InputError as check_drawn() does.
// Grid over one axis: columns with the same unit are curves of one panel, with a gap at missing values. A curve is
// broken where the sequence of events changes, because the quantity may jump there.
// Grid over two axes: every column is a map. Numbers have colors of number_color() with a color scale; classes have the
// hues of phases and events. A thin line separates cells with different sequences.
// Section: every column is a diagram over the axis; without an axis, the second quantity is plotted over the first.
// Random points are drawn at their positions. Missing values are hatched and named in the legend. Rows that are not
// computed yet are left blank.
Figure compose_sweep(const SweepData& data, const SweepLook& look = {});

// Picture height (pixels) at which every panel is readable; at least `height`.
int readable_height(const Figure& figure, int width, int height, double scale);

}  // namespace achilles
