#include "figure/sweep_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "figure/grid.hpp"
#include "figure/label.hpp"
#include "figure/layout.hpp"
#include "figure/marks.hpp"
#include "figure/publication.hpp"
#include "figure/sweep_panels.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

enum class Form { curves, map, diagram, section, samples };

Form form_of(const SweepData& data) {
    const std::size_t axes = data.sweep.axes.size();
    if (data.is_section()) return axes == 0 ? Form::section : Form::diagram;
    if (data.sweep.random) return Form::samples;
    return axes == 1 ? Form::curves : Form::map;
}

std::vector<std::size_t> columns_of(const SweepData& data, const SweepLook& look) {
    if (!look.columns.empty()) return look.columns;
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < data.columns.size(); ++i) all.push_back(i);
    if (all.empty()) all.push_back(sequence_column);
    return all;
}

[[noreturn]] void refuse(const std::string& why, const std::string& hint) {
    throw InputError("--out", {}, why, hint + "; --csv and --hdf5 write any table");
}

}  // namespace

void check_drawn(const SweepData& data, const SweepLook& look) {
    const std::size_t axes = data.sweep.axes.size();
    const Form form = form_of(data);
    std::size_t numbers = 0, classes = 0;
    for (const std::size_t column : columns_of(data, look))
        ++(ColumnView(data, column).is_number() ? numbers : classes);
    if (form == Form::section && (numbers != 2 || classes > 0))
        refuse("the figure of a section without an axis needs exactly two numeric quantities",
               "give --print twice, or one --over");
    if (form == Form::diagram && axes > 1)
        refuse(fmt::format("a section over {} axes cannot be drawn", axes), "use one --over for a diagram");
    if (form == Form::diagram && numbers == 0)
        refuse("the diagram of a section needs a numeric quantity", "use --print with an expression");
    if (axes > 2 || (axes == 0 && form != Form::section))
        refuse(fmt::format("a sweep over {} axes cannot be drawn", axes),
               "one --over is drawn as curves, two as a map");
    if (!data.is_section() && data.sweep.count() > max_drawn_rows)
        refuse(fmt::format("{} runs are too many for a figure", data.sweep.count()),
               fmt::format("at most {} can be drawn", max_drawn_rows));
    if (form != Form::map) return;
    for (const SweepAxis& axis : data.sweep.axes)
        if (axis.count > max_map_side)
            refuse(fmt::format("{} values of {} are too many for one side of a map", axis.count, axis.name),
                   fmt::format("at most {} can be drawn", max_map_side));
}

std::vector<std::string> left_out(const SweepData& data, const SweepLook& look) {
    std::vector<std::string> names;
    if (form_of(data) != Form::diagram) return names;
    for (const std::size_t column : columns_of(data, look))
        if (const ColumnView one(data, column); !one.is_number()) names.push_back(one.name());
    return names;
}

std::vector<std::size_t> columns_with_values(const SweepData& data, const SweepLook& look) {
    std::vector<std::size_t> found;
    for (const std::size_t column : columns_of(data, look)) {
        const ColumnView one(data, column);
        bool has_value = false;
        for (std::size_t row = 0; row < data.count() && !has_value; ++row) has_value = one.has_value(row);
        if (has_value && (one.is_number() || !data.is_section())) found.push_back(column);
    }
    return found;
}

namespace {

// Panels of a grid over one axis. Numbers with the same unit share a panel.
std::vector<Panel> curve_panels(const SweepData& data, const std::vector<std::size_t>& columns, const Theme& theme,
                                const SweepLook& look) {
    std::vector<std::vector<ColumnView>> groups;
    for (const std::size_t column : columns) {
        const ColumnView one(data, column);
        const auto fits = [&](const std::vector<ColumnView>& group) {
            constexpr std::size_t most = 8;  // number of hues
            return one.is_number() && group.front().is_number() && group.front().unit().text == one.unit().text &&
                   !one.unit().text.empty() && group.size() < most;
        };
        const auto group = std::find_if(groups.begin(), groups.end(), fits);
        if (group != groups.end())
            group->push_back(one);
        else
            groups.push_back({one});
    }
    std::vector<Panel> panels;
    for (const std::vector<ColumnView>& group : groups)
        panels.push_back(group.front().is_number() ? curves_panel(data, group, theme, look)
                                                   : classes_panel(data, group.front(), theme));
    return panels;
}

std::vector<Panel> panels_of(const SweepData& data, const Theme& theme, const SweepLook& look) {
    const std::vector<std::size_t> columns = columns_of(data, look);
    const Form form = form_of(data);
    if (form == Form::curves) return curve_panels(data, columns, theme, look);
    if (form == Form::section)
        return {section_panel(data, ColumnView(data, columns[0]), ColumnView(data, columns[1]), theme)};
    std::vector<Panel> panels;
    for (const std::size_t column : columns) {
        const ColumnView one(data, column);
        if (form == Form::map) panels.push_back(map_panel(data, one, theme, look));
        if (form == Form::samples) panels.push_back(samples_panel(data, one, theme, look));
        if (form == Form::diagram && one.is_number()) panels.push_back(diagram_panel(data, one, theme, look));
    }
    return panels;
}

// Moves legend entries that two panels share into one legend above all panels. Lines between cells are named by the
// first panel that has them, since the layout may leave them out.
void share_keys(Figure& figure) {
    const auto is_said_twice = [&](const std::string& label) {
        const auto says = [&](const Panel& panel) {
            const auto has = [&](const auto& one) { return one.label == label; };
            return (panel.hatch.label == label && !has_no_fill(panel)) ||
                   std::any_of(panel.curves.begin(), panel.curves.end(), has) ||
                   std::any_of(panel.markers.begin(), panel.markers.end(), has);
        };
        return !label.empty() && std::count_if(figure.panels.begin(), figure.panels.end(), says) > 1;
    };
    std::vector<std::string> shared;
    const auto add = [&](const std::string& label, const auto& sign) {
        if (!is_said_twice(label) || std::find(shared.begin(), shared.end(), label) != shared.end()) return;
        shared.push_back(label);
        figure.keys.push_back({label, sign});
    };
    for (const Panel& panel : figure.panels) {
        for (const Curve& curve : panel.curves)
            if (!curve.is_between_cells) add(curve.label, curve.stroke);
        for (const Markers& markers : panel.markers)
            if (!markers.points.empty() || panel.raster.cells == nullptr) add(markers.label, markers);
        if (!has_no_fill(panel)) add(panel.hatch.label, panel.hatch);
    }
    const auto clear = [&](auto& one) {
        if (std::find(shared.begin(), shared.end(), one.label) != shared.end()) one.label.clear();
    };
    bool is_named = false;
    for (Panel& panel : figure.panels) {
        for (Curve& curve : panel.curves) {
            clear(curve);
            if (curve.is_between_cells && !curve.label.empty() && std::exchange(is_named, true)) curve.label.clear();
        }
        for (Markers& markers : panel.markers) clear(markers);
        if (!has_no_fill(panel)) clear(panel.hatch);
    }
}

// In layout points: 300 and 110 pixels of a picture 1200 pixels wide, the width of a page.
constexpr double min_map_width = 300.0 / publication_scale, min_panel_height = 110.0 / publication_scale;

// Minimum width and height over all panels.
std::array<double, 2> min_sides(const Figure& figure, double width, double height, double scale) {
    const auto measure = [](const std::string& label, float size) {
        return 0.5F * size * static_cast<float>(letters(label).size());
    };
    std::array<double, 2> least{width, height};
    const Rectangle page{0.0F, 0.0F, static_cast<float>(width), static_cast<float>(height)};
    for (const PlotArea& at : plot_areas(figure, measure, page, scale))
        least = {std::min(least[0], double{at.place.width}), std::min(least[1], double{at.place.height})};
    return least;
}

void set_columns(Figure& figure, int columns) {
    figure.columns = columns;
    share_axes(figure);
}

// Places maps below one another if they would be narrow side by side; with a given height, only if they become larger.
void fit_columns(Figure& figure, const SweepLook& look) {
    if (figure.columns < 2 || look.width <= 0.0) return;
    const bool is_free = look.height <= 0.0;
    const double height = is_free ? look.width * static_cast<double>(figure.panels.size()) : look.height;
    const auto beside = min_sides(figure, look.width, height, 1.0);
    if (beside[0] >= min_map_width) return;
    set_columns(figure, 1);
    if (is_free) return;
    const auto below = min_sides(figure, look.width, height, 1.0);
    if (std::min(below[0], below[1]) < std::min(beside[0], beside[1])) set_columns(figure, 2);
}

}  // namespace

int readable_height(const Figure& figure, int width, int height, double scale) {
    constexpr int most = 16384;
    std::size_t rows = 1;
    for (const Cell& cell : cells_of(figure)) rows = std::max(rows, cell.row + cell.rows);
    // For a panel without any height the deficit is only approximate, hence the iteration.
    for (int i = 0; i < 4 && height < most; ++i) {
        const double lack = min_panel_height * scale - min_sides(figure, width, height, scale)[1];
        if (lack < 0.5) break;
        height = std::min(height + static_cast<int>(std::ceil(lack * static_cast<double>(rows))), most);
    }
    return height;
}

Figure compose_sweep(const SweepData& data, const SweepLook& look) {
    check_drawn(data, look);
    const Theme theme = look.dark ? dark_theme() : light_theme();
    Figure figure;
    figure.background = theme.background;
    if (look.transparent) figure.background.a = 0;
    figure.ink = theme.ink;
    figure.grid.a = 0;
    figure.smallest_text = 0.9;
    figure.panels = panels_of(data, theme, look);
    const bool one_column =
        figure.panels.size() == 1 || form_of(data) == Form::curves || form_of(data) == Form::diagram;
    set_columns(figure, one_column ? 1 : 2);
    if (figure.panels.size() > 1) share_keys(figure);
    for (std::size_t i = 0; i < figure.panels.size() && figure.panels.size() > 1; ++i)
        figure.panels[i].title = lettered(i, figure.panels[i].title);
    fit_columns(figure, look);
    return figure;
}

}  // namespace achilles
