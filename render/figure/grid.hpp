// Where the plot areas of a figure's panels stand.
#pragma once

#include <functional>
#include <vector>

#include "figure/axes.hpp"

namespace achilles {

// A panel's place: the row and column of its upper left corner, and how many rows it takes.
struct Cell {
    std::size_t row = 0, column = 0, rows = 1;
};
// Row by row, every panel in the first cell that is free.
std::vector<Cell> cells_of(const Figure& figure);

// How much longer than high a panel is that has one unit on both axes; 0 of any other.
double shape_of(const Panel& panel);

// In line, with the room that the fullest panel of each column and row needs. Columns are equally wide and rows equally
// high, but where a path that is true to shape would leave much empty: a column in which one takes several rows is as
// wide as it wants, and a last row of paths alone as high, both within bounds.
class Grid {
 public:
    // The room above a panel so wide for its legend.
    using LegendRoom = std::function<float(const Panel& panel, float width)>;
    Grid(const Figure& figure, Rectangle area, const Metrics& metrics, const LegendRoom& legend_room);

    // The plot area of a panel, before it is made true to shape, and the room around it.
    Rectangle plot(std::size_t i) const;
    Margins room(std::size_t i) const;
    float least_side() const;  // of all columns and rows

 private:
    void add_margins(const std::vector<Panel>& panels, const Metrics& metrics);
    void set_heights(const std::vector<Panel>& panels, float all);
    void set_widths(const std::vector<Panel>& panels, float all);
    bool is_tall(std::size_t i) const { return cells_[i].rows > 1; }
    bool is_in_short_row(std::size_t i) const { return short_row_ > 0 && cells_[i].row + 1 == down_.size(); }
    // Of a panel in a last row that is not full, which shares its whole width; and what lies between two of them.
    float short_row_width() const;
    float short_row_gap() const;
    // From the first row of a panel of several to its last, without its own labels where another panel follows.
    float tall_height(std::size_t i) const;

    std::vector<Cell> cells_;
    std::vector<Margins> needed_;         // by the panels
    std::vector<Margins> across_, down_;  // of columns, left and right count; of rows, top and bottom
    std::vector<float> widths_, heights_, xs_, ys_;
    float between_;              // panels
    float last_bar_ = 0.0F;      // what the last panel's colour bar needs at its right; 0: it has none
    std::size_t short_row_ = 0;  // panels in a last row that is not full; 0: it is full
};

}  // namespace achilles
