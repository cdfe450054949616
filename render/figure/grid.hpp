// Positions of a figure's plot areas.
#pragma once

#include <functional>
#include <vector>

#include "figure/axes.hpp"

namespace achilles {

// Cell of a panel: row and column of its upper left corner, and the number of rows that it spans.
struct Cell {
    std::size_t row = 0, column = 0, rows = 1;
};
// Row by row, every panel in the first free cell.
std::vector<Cell> cells_of(const Figure& figure);

// Width / height of a panel with equal axes; 0 for any other panel.
double shape_of(const Panel& panel);

// Grid of aligned panels. Each column and row has the margins of its fullest panel.
// Columns have equal widths and rows equal heights, with two exceptions that would leave much space empty around paths
// with equal axes. A column with a path over several rows gets the width that the path needs, and a last row that has
// only paths the height they need, both within bounds.
class Grid {
 public:
    // Height of the legend above a panel of this width.
    using LegendRoom = std::function<float(const Panel& panel, float width)>;
    Grid(const Figure& figure, Rectangle area, const Metrics& metrics, const LegendRoom& legend_room);

    // Area inside the axes of a panel, before it is shrunk so that both axes have one scale.
    Rectangle plot(std::size_t i) const;
    // The margins around that area, for ticks, labels and a color scale.
    Margins room(std::size_t i) const;
    float min_side() const;  // smallest width of a column or height of a row

 private:
    void add_margins(const std::vector<Panel>& panels, const Metrics& metrics);
    void set_heights(const std::vector<Panel>& panels, float all);
    void set_widths(const std::vector<Panel>& panels, float all);
    bool is_tall(std::size_t i) const { return cells_[i].rows > 1; }
    bool is_in_short_row(std::size_t i) const { return short_row_ > 0 && cells_[i].row + 1 == down_.size(); }
    // In a last row that is not full: width of each panel, and distance between two of them. These panels share the
    // full width.
    float short_row_width() const;
    float short_row_gap() const;
    // Height of a panel from its first row to its last, without its own labels if another panel follows below.
    float tall_height(std::size_t i) const;

    std::vector<Cell> cells_;
    std::vector<Margins> needed_;         // margins of each panel
    std::vector<Margins> across_, down_;  // margins of columns (left and right) and of rows (top and bottom)
    std::vector<float> widths_, heights_, xs_, ys_;
    float between_;              // distance between panels
    float last_bar_ = 0.0F;      // margin that the last panel's color scale needs at the right; 0: it has none
    std::size_t short_row_ = 0;  // number of panels in a last row that is not full; 0: the row is full
};

}  // namespace achilles
