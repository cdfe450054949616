#include "figure/grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace achilles {

std::vector<Cell> cells_of(const Figure& figure) {
    const auto columns = static_cast<std::size_t>(std::max(figure.columns, 1));
    std::vector<std::size_t> free_from(columns, 0);  // the first free row of each column
    std::vector<Cell> cells;
    std::size_t next = 0;  // cell index, row by row
    for (const Panel& panel : figure.panels) {
        while (free_from[next % columns] > next / columns) ++next;
        const Cell cell{next / columns, next % columns, static_cast<std::size_t>(std::max(panel.rows, 1))};
        free_from[cell.column] = cell.row + cell.rows;
        cells.push_back(cell);
    }
    return cells;
}

double shape_of(const Panel& panel) {
    const double shape = (panel.x.high - panel.x.low) / (panel.y.high - panel.y.low);
    return panel.equal_axes && std::isfinite(shape) ? std::max(shape, 0.0) : 0.0;
}

Grid::Grid(const Figure& figure, Rectangle area, const Metrics& m, const LegendRoom& legend_room)
    : cells_(cells_of(figure)), across_(static_cast<std::size_t>(std::max(figure.columns, 1))), between_(m.text) {
    const std::vector<Panel>& panels = figure.panels;
    add_margins(panels, m);
    const float pad = std::round(m.text * 0.7F);
    float width = area.width - 2.0F * pad - between_ * static_cast<float>(across_.size() - 1);
    for (const Margins& room : across_) width -= room.left + room.right;
    const auto height = [&] {
        float rest = area.height - 2.0F * pad - between_ * static_cast<float>(down_.size() - 1);
        for (const Margins& room : down_) rest -= room.top + room.bottom;
        return rest;
    };
    widths_.assign(across_.size(), std::floor(width / static_cast<float>(across_.size())));
    set_heights(panels, height());
    set_widths(panels, width);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        Margins& room = down_[cells_[i].row];
        room.top = std::max(room.top, needed_[i].top + legend_room(panels[i], widths_[cells_[i].column]));
    }
    set_heights(panels, height());
    float x = area.x + pad, y = area.y + pad;
    for (std::size_t i = 0; i < across_.size(); ++i) {
        xs_.push_back(x + across_[i].left);
        x += across_[i].left + widths_[i] + across_[i].right + between_;
    }
    for (std::size_t i = 0; i < down_.size(); ++i) {
        ys_.push_back(y + down_[i].top);
        y += down_[i].top + heights_[i] + down_[i].bottom + between_;
    }
}

void Grid::add_margins(const std::vector<Panel>& panels, const Metrics& m) {
    std::size_t rows = 0;
    for (const Cell& cell : cells_) rows = std::max(rows, cell.row + cell.rows);
    down_.resize(rows);
    bool any_tall = false;
    std::size_t in_last = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Cell& cell = cells_[i];
        needed_.push_back(margins(panels[i], m));
        const std::size_t last = cell.row + cell.rows - 1;
        across_[cell.column] = both(across_[cell.column], needed_[i]);
        down_[cell.row].top = std::max(down_[cell.row].top, needed_[i].top);
        if (!is_tall(i) || last + 1 == rows) down_[last].bottom = std::max(down_[last].bottom, needed_[i].bottom);
        any_tall = any_tall || is_tall(i);
        in_last += last + 1 == rows ? 1 : 0;
    }
    if (!any_tall && in_last < across_.size()) short_row_ = in_last;
    if (!panels.empty() && !panels.back().color_bar.colors.empty()) last_bar_ = needed_.back().right;
}

// A last row with paths only is higher, up to 1.5 times the height of the others.
void Grid::set_heights(const std::vector<Panel>& panels, float all) {
    constexpr float most = 1.5F;
    const auto rows = static_cast<float>(down_.size());
    const float even = std::floor(all / rows);
    heights_.assign(down_.size(), even);
    if (short_row_ == 0 || down_.size() < 2) return;
    float wanted = 0.0F;
    for (std::size_t i = panels.size() - short_row_; i < panels.size(); ++i) {
        const double shape = shape_of(panels[i]);
        if (!(shape > 0.0)) return;
        wanted = std::max(wanted, short_row_width() / static_cast<float>(shape));
    }
    const float last = std::floor(std::clamp(wanted, even, most * all / (rows - 1.0F + most)));
    heights_.assign(down_.size(), std::floor((all - last) / (rows - 1.0F)));
    heights_.back() = last;
}

// A path over several rows gets the width that its height allows. It may be narrow if it is alone in its column;
// otherwise the panels below it have the same width.
void Grid::set_widths(const std::vector<Panel>& panels, float all) {
    const float even = widths_.front(), columns = static_cast<float>(widths_.size());
    constexpr float least_alone = 0.4F, least = 0.84F, most = 1.24F;  // fractions of the width of equal columns
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const double shape = shape_of(panels[i]);
        if (!is_tall(i) || !(shape > 0.0) || widths_.size() < 2) continue;
        const bool alone = cells_[i].rows == down_.size();
        const float wanted = tall_height(i) * static_cast<float>(shape);
        const float width = std::floor(std::clamp(wanted, (alone ? least_alone : least) * even, most * even));
        widths_.assign(widths_.size(), std::floor((all - width) / (columns - 1.0F)));
        widths_[cells_[i].column] = width;
        return;
    }
}

float Grid::tall_height(std::size_t i) const {
    const std::size_t first = cells_[i].row, end = first + cells_[i].rows;
    float height = heights_[first];
    for (std::size_t row = first + 1; row < end; ++row)
        height += down_[row - 1].bottom + between_ + down_[row].top + heights_[row];
    return end == down_.size() ? height : height + down_[end - 1].bottom - needed_[i].bottom;
}

float Grid::short_row_gap() const {
    Margins widest;
    for (const Margins& room : across_) widest = both(widest, room);
    float gap = widest.left + widest.right;
    if (across_.size() < 2) return gap;
    float apart = 0.0F;  // average
    for (std::size_t i = 1; i < across_.size(); ++i) apart += across_[i - 1].right + between_ + across_[i].left;
    return std::max(gap, apart / static_cast<float>(across_.size() - 1));
}

float Grid::short_row_width() const {
    float whole = std::accumulate(widths_.begin(), widths_.end(), 0.0F);
    for (std::size_t i = 1; i < across_.size(); ++i) whole += across_[i - 1].right + between_ + across_[i].left;
    const auto shared = static_cast<float>(short_row_);
    whole -= std::max(last_bar_ - across_.back().right, 0.0F);
    return (whole - (shared - 1.0F) * short_row_gap()) / shared;
}

Rectangle Grid::plot(std::size_t i) const {
    const Cell& cell = cells_[i];
    const float height = is_tall(i) ? tall_height(i) : heights_[cell.row];
    if (!is_in_short_row(i)) return {xs_[cell.column], ys_[cell.row], widths_[cell.column], height};
    const float width = short_row_width();
    return {xs_.front() + static_cast<float>(cell.column) * (width + short_row_gap()), ys_[cell.row], width, height};
}

Margins Grid::room(std::size_t i) const {
    const Cell& cell = cells_[i];
    const std::size_t end = cell.row + cell.rows;
    const float bottom = is_tall(i) && end < down_.size() ? needed_[i].bottom : down_[end - 1].bottom;
    // The last panel of a short row ends where the last column does, whose margin has no space for its color scale.
    const bool ends_in_bar = last_bar_ > 0.0F && is_in_short_row(i) && i + 1 == cells_.size();
    const float right = ends_in_bar ? std::max(across_.back().right, last_bar_) : across_[cell.column].right;
    return {across_[cell.column].left, right, down_[cell.row].top, bottom};
}

float Grid::min_side() const {
    return std::min(*std::min_element(widths_.begin(), widths_.end()),
                    *std::min_element(heights_.begin(), heights_.end()));
}

}  // namespace achilles
