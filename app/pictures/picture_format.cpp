#include "pictures/picture_format.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "figure/grid.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

extern char** environ;  // NOLINT: declared by POSIX

namespace achilles {

namespace {

constexpr std::string_view written_formats[] = {"png", "svg", "pdf"};
// Formats that are not supported. They are rejected, since files with a misleading extension would be a trap.
constexpr std::string_view other_formats[] = {"jpg", "jpeg", "gif", "mp4", "bmp", "webp", "tif", "tiff", "eps", "ps"};

template <std::size_t count>
bool is_among(const std::string& ending, const std::string_view (&endings)[count]) {
    return std::find(std::begin(endings), std::end(endings), ending) != std::end(endings);
}

template <class Change>
std::string each(std::string text, Change change) {
    for (char& c : text) c = static_cast<char>(change(static_cast<unsigned char>(c)));
    return text;
}
std::string large(const std::string& text) {
    return each(text, [](int c) { return std::toupper(c); });
}

}  // namespace

std::string ending_of(const std::string& file) {
    const std::string ending = std::filesystem::path(file).extension().string();
    return each(ending.substr(std::min<std::size_t>(1, ending.size())), [](int c) { return std::tolower(c); });
}

std::string ending_of_picture(const std::string& file) {
    const std::string ending = ending_of(file);
    return is_among(ending, written_formats) ? ending : "";
}

std::string format_for(const std::string& out, const std::string& wanted, const std::string& advice) {
    const std::string ending = ending_of(out), ending_format = ending_of_picture(out), option = "--out " + shown(out);
    if (wanted.empty() && out == "-") return "png";
    if (wanted.empty() && ending_format.empty())
        throw InputError(option, {}, "the file name must end in .png, .svg or .pdf",
                         is_among(ending, other_formats) ? "" : "or add --format png, svg or pdf");
    if (wanted.empty()) return ending_format;
    if (ending_format != wanted && (!ending_format.empty() || is_among(ending, other_formats)))
        throw InputError(option, {},
                         fmt::format("this name says {}, but the picture is {}", large(ending), large(wanted)),
                         fmt::format("end it in .{}{}", wanted, advice));
    return wanted;
}

std::string find_program(const std::string& name) {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (const std::string file = fmt::format("{}/{}", folder, name);
            !folder.empty() && ::access(file.c_str(), X_OK) == 0)
            return file;
    return {};
}

namespace {

constexpr const char* writer = "rsvg-convert";

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporary() {
    File file(std::tmpfile(), &std::fclose);
    if (!file) throw std::runtime_error("a temporary file cannot be created");
    return file;
}

std::string content(std::FILE* file) {
    std::string text;
    std::array<char, 65536> part{};
    std::rewind(file);
    for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), file)) > 0;) text.append(part.data(), n);
    return text;
}

// The caller's environment with a fixed PDF date, so that equal inputs give equal files.
std::vector<char*> environment() {
    static std::string date = "SOURCE_DATE_EPOCH=0";
    std::vector<char*> all;
    for (char** entry = environ; *entry != nullptr; ++entry)
        if (!std::string_view(*entry).starts_with("SOURCE_DATE_EPOCH=")) all.push_back(*entry);
    all.push_back(date.data());
    all.push_back(nullptr);
    return all;
}

struct ConverterResult {
    std::string pdf, problems;  // `pdf` is empty on failure
};

// Converts an SVG to the given format, `points` wide.
ConverterResult written(std::FILE* svg, const std::string& format, double points) {
    const File out = temporary(), problems = temporary();
    ::lseek(::fileno(svg), 0, SEEK_SET);  // an earlier call may have moved the file position
    std::string wide = fmt::format("--width={:.3f}pt", points), kind = "--format=" + format;
    std::string name = writer, ratio = "--keep-aspect-ratio", unlimited = "--unlimited";
    std::array<char*, 6> words{name.data(), kind.data(), ratio.data(), unlimited.data(), wide.data(), nullptr};
    std::vector<char*> variables = environment();
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ::fileno(svg), 0);
    ::posix_spawn_file_actions_adddup2(&actions, ::fileno(out.get()), 1);
    ::posix_spawn_file_actions_adddup2(&actions, ::fileno(problems.get()), 2);
    pid_t process = 0;
    const int problem = ::posix_spawnp(&process, writer, &actions, nullptr, words.data(), variables.data());
    ::posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    const bool is_done = problem == 0 && ::waitpid(process, &status, 0) == process && status == 0;
    std::string pdf = is_done ? content(out.get()) : "";
    if (!pdf.starts_with("%PDF")) pdf.clear();
    return {std::move(pdf), content(problems.get())};
}

}  // namespace

void need_pdf_writer(const std::string& file) {
    if (!find_program(writer).empty()) return;
    throw InputError(file, {}, fmt::format("a PDF needs {}, which is not installed", writer),
                     "install the package librsvg2-bin, or end the name in .svg");
}

std::string pdf_of_svg(const std::string& svg, double width_mm) {
    const File in = temporary();
    if (std::fwrite(svg.data(), 1, svg.size(), in.get()) != svg.size() || std::fflush(in.get()) != 0)
        throw std::runtime_error("a temporary file cannot be written");
    const double points = width_mm / 25.4 * 72.0;
    // Cairo 1.18 compresses the objects to which notes are appended, except in PDF 1.4. An rsvg-convert without that
    // option uses an older cairo, which does not.
    std::string pdf = written(in.get(), "pdf1.4", points).pdf;
    if (!pdf.empty()) return pdf;
    ConverterResult last = written(in.get(), "pdf", points);
    if (last.pdf.empty())
        throw std::runtime_error(fmt::format("{} could not write the PDF: {}", writer, last.problems));
    return std::move(last.pdf);
}

namespace {

constexpr double inch = 25.4, point = inch / 72.0;  // mm
constexpr int max_pixels = 16384;                   // per side, as for --size

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
    need(within(page.width, min_width, max_width), what, "width", page.width, min_width, max_width, "mm");
    need(within(page.height, min_width, max_width), what, "height", page.height, min_width, max_width, "mm");
    need(within(page.font, min_font, max_font), what, "font", page.font, min_font, max_font, "pt");
    need(within(page.dpi, min_dpi, max_dpi), what, "resolution", page.dpi, min_dpi, max_dpi, "dpi");
    if (page.width == 0.0 && (page.height != 0.0 || page.font != 0.0 || page.dpi != 0.0))
        throw InputError(what, {}, "a height, a font size or a resolution needs a width in mm");
}

// The shape is clamped to avoid very flat pictures.
double height_of(const PaperSize& page, double shape) {
    return page.height > 0.0 ? page.height : page.width / std::clamp(shape, tallest_shape, 3.0);
}

PictureSize on_page(const PaperSize& page, const std::string& format, double text_size, double shape) {
    const double per_mm = pixels_per_mm(page, format), height = height_of(page, shape);
    const double longest = std::max(page.width, height) * per_mm;
    if (longest > max_pixels)
        throw InputError({}, {}, fmt::format("a side of this picture would be {:.0f} pixels long", longest),
                         fmt::format("at most {} are possible: use fewer dots per inch", max_pixels));
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

std::string size_text(const PaperSize& page, const std::string& format, double shape) {
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
