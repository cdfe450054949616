// Figures of a sweep: curves over one axis, maps over two, diagrams of sections, samples.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "figure/figure.hpp"
#include "figure/label.hpp"
#include "study/table.hpp"

namespace achilles {

// In the place of a column: the sequences of events, as classes.
inline constexpr std::size_t sequence_column = ~std::size_t{0};
// More rows than these are not drawn, nor axes of a map with more values.
inline constexpr std::uint64_t most_drawn_rows = std::uint64_t{1} << 24, most_map_side = 4096;

struct SweepLook {
    std::vector<std::size_t> columns;  // of the data; none: all, and the outcome where there are none
    bool dark = false, transparent = false;
    bool contours = true;  // of a map: between cells of different sequences
    // Of the numbers: the limits of their axis, or of their colours. Without them what is there fits.
    std::optional<std::array<double, 2>> range;
    // Of the picture, in points of the layout. Maps that had too little of the width side by side stand below one another. A
    // height of 0 follows from the panels; without a width they are side by side.
    double width = 0.0, height = 0.0;
};

// Of an axis. A parameter is in degrees as it has its slider: an angle is, a drive's frequency is no angle's rate.
ShownUnit shown_unit_of_axis(const SweepData& data, std::size_t axis);

// Throws InputError where such a sweep has no figure, and says what would have. Rows do not matter.
void check_drawn(const SweepData& data, const SweepLook& look);

// The columns that are left out of the figure: the words of a section have no place in it.
std::vector<std::string> left_out(const SweepData& data, const SweepLook& look);

// The columns that the figure has and that some row has a value of, as `look` names them: of a section those of numbers.
std::vector<std::size_t> columns_with_values(const SweepData& data, const SweepLook& look);

// Of a grid over one axis, columns with one unit are curves of a panel: without a value they have a gap, and where the
// sequence of events changes a break, as what is plotted may jump there. Over two axes every column is a map: numbers in
// number_color() with their bar, classes in the hues of phases and events, a thin line between cells of different sequences.
// Of a section every column is a diagram over the axis; without an axis the second print stands over the first. Random
// points stand where they are. What has no value is hatched, and named. Rows that are not there yet are left free. Throws
// InputError as check_drawn().
Figure compose_sweep(const SweepData& data, const SweepLook& look = {});

// The height in pixels of such a picture in which every panel can be read, no less than that given.
int readable_height(const Figure& figure, int width, int height, double scale);

}  // namespace achilles
