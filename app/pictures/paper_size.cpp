#include "pictures/paper_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "figure/grid.hpp"
#include "pictures/pdf.hpp"
#include "system/description.hpp"

namespace achilles {

namespace {

constexpr double inch = 25.4, point = inch / 72.0;  // mm
constexpr int most_pixels = 16384;                  // along a side, as --size has it

void need(bool is_good, const std::string& what, const char* name, double value, double low, double high,
          const char* unit) {
    if (is_good) return;
    throw InputError(what, {}, fmt::format("the {} of a picture cannot be {} {}", name, value, unit),
                     fmt::format("use {} to {} {}", low, high, unit));
}

double pixels_per_mm(const PaperSize& page, const std::string& format) {
    return format == "png" ? (page.dpi > 0.0 ? page.dpi : default_dpi) / inch : 1.0 / page_mm(1);
}

double shape_of_grid(std::size_t rows, int columns) {
    return 1.5 * std::max(1, columns) / static_cast<double>(std::max<std::size_t>(1, rows));
}

}  // namespace

void check(const PaperSize& page, const std::string& what) {
    const auto within = [](double x, double low, double high) { return x == 0.0 || (x >= low && x <= high); };
    need(within(page.width, least_width, most_width), what, "width", page.width, least_width, most_width, "mm");
    need(within(page.height, least_width, most_width), what, "height", page.height, least_width, most_width, "mm");
    need(within(page.font, least_font, most_font), what, "font", page.font, least_font, most_font, "pt");
    need(within(page.dpi, least_dpi, most_dpi), what, "resolution", page.dpi, least_dpi, most_dpi, "dpi");
    if (page.width == 0.0 && (page.height != 0.0 || page.font != 0.0 || page.dpi != 0.0))
        throw InputError(what, {}, "a height, a font size or a resolution needs a width in mm");
}

// No picture is a strip.
double height_of(const PaperSize& page, double shape) {
    return page.height > 0.0 ? page.height : page.width / std::clamp(shape, tallest_shape, 3.0);
}

PictureSize on_page(const PaperSize& page, const std::string& format, double text_size, double shape) {
    const double per_mm = pixels_per_mm(page, format), height = height_of(page, shape);
    const double longest = std::max(page.width, height) * per_mm;
    if (longest > most_pixels)
        throw InputError({}, {}, fmt::format("a side of this picture would be {:.0f} pixels long", longest),
                         fmt::format("at most {} are possible: use fewer dots per inch", most_pixels));
    PictureSize size;
    size.width = static_cast<int>(std::lround(page.width * per_mm));
    size.height = static_cast<int>(std::lround(height * per_mm));
    size.scale = (page.font > 0.0 ? page.font : default_font) * point * per_mm / text_size;
    size.width_mm = page.width;
    return size;
}

PaperSize page_for(PaperSize page, const std::string& format) {
    if (format != "png" && page.width > 0.0) page.dpi = 0.0;
    return page;
}

std::string told(const PaperSize& page, const std::string& format, double shape) {
    const PictureSize size = on_page(page, format, 1.0, shape);
    const std::string mm = fmt::format("{:.4g} \u00d7 {:.4g} mm", page.width, height_of(page, shape));
    if (format != "png") return mm;
    return fmt::format("{}, {} \u00d7 {} px at {:g} dpi", mm, size.width, size.height,
                       page.dpi > 0.0 ? page.dpi : default_dpi);
}

double shape_of(const Figure& figure) {
    std::size_t rows = 0;
    for (const Cell& cell : cells_of(figure)) rows = std::max(rows, cell.row + cell.rows);
    return shape_of_grid(rows, figure.columns);
}

double shape_of(int panels, int columns) {
    const int across = std::max(1, columns);
    return shape_of_grid(static_cast<std::size_t>((panels + across - 1) / across), across);
}

double shape_of(const Drawing& world) { return (world.x_high - world.x_low) / (world.y_high - world.y_low); }

std::span<const ColumnWidth> column_widths() {
    static constexpr std::array widths{
        ColumnWidth{"one of two columns (85 mm)", 85.0, 8.0},   ColumnWidth{"APS, one column (86 mm)", 86.0, 8.0},
        ColumnWidth{"IEEE, one column (88.9 mm)", 88.9, 8.0},   ColumnWidth{"Elsevier, one column (90 mm)", 90.0, 8.0},
        ColumnWidth{"thesis, text width (140 mm)", 140.0, 9.0}, ColumnWidth{"a page (170 mm)", 170.0, 8.0},
        ColumnWidth{"IEEE, two columns (182 mm)", 182.0, 8.0},  ColumnWidth{"a slide (320 mm)", 320.0, 18.0}};
    return widths;
}

}  // namespace achilles
