#include "pictures/picture_job.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "cli/assets.hpp"
#include "expression/name_suggestions.hpp"
#include "image/notes.hpp"
#include "output/output.hpp"
#include "paint/paint.hpp"
#include "paint/svg.hpp"
#include "pictures/picture_format.hpp"

namespace achilles {

PictureJob::PictureJob(const std::vector<std::string>& words) : command_(command_line(words)) {}

PictureJob::PictureJob(const Origin& origin)
    : inputs_(origin.sources, origin.command), command_(origin.command), wanted_(origin.picture), reproduces_(true) {}

void PictureJob::check_size(int width, int height) const {
    constexpr double max_pixels = 32e6;  // takes a few seconds and 400 MB
    if (reproduces_ && double{1} * width * height > max_pixels)
        throw InputError({}, {}, fmt::format("a picture of {} x {} pixels is too large to reproduce", width, height),
                         fmt::format("at most {:.0f} million pixels are drawn for a picture of unknown source; to make "
                                     "it without this limit, run:\n{}",
                                     max_pixels / 1e6, command_));
}

void PictureJob::check(const Options& options) const {
    if (inputs_.budget()) inputs_.budget()->check(options);
}

void PictureJob::check(const SweepSpec& sweep) const {
    if (inputs_.budget()) inputs_.budget()->check(sweep);
}

void PictureJob::check_rows(std::uint64_t rows) const {
    if (inputs_.budget()) inputs_.budget()->check_rows(rows);
}

void PictureJob::add(const std::string& path) {
    if (reproduces_) return;
    for (const auto& file : inputs_.files_read()) files_.protect_input(file);
    files_.add(path);
}

Notes PictureJob::notes_of(const std::string& picture, const std::vector<PictureRun>& runs) const {
    return notes({"Achilles " + version(), command_, picture, inputs_.stored_sources()}, runs);
}

void PictureJob::put(const std::string& path, const std::string& picture, const std::vector<PictureRun>& runs,
                     const Make& make) {
    if (reproduces_ && picture != wanted_) return;
    const std::string bytes = make(notes_of(picture, runs));
    if (reproduces_)
        made_ = bytes;
    else
        files_.put(path, bytes);
}

void PictureJob::put_text(const std::string& path, const std::string& text) {
    if (!reproduces_) files_.put(path, text);
}

void PictureJob::commit() {
    inputs_.end_time_limit();
    if (reproduces_) return;
    for (const auto& file : inputs_.files_read()) files_.protect_input(file);
    files_.commit();
}

void PictureJob::refuse_output(const std::string& path) const { files_.refuse_output(path); }

namespace {

SurfaceOptions with_fonts(SurfaceOptions options) {
    options.fonts = assets() / "fonts";
    return options;
}

}  // namespace

PictureSurface::PictureSurface(const SurfaceOptions& options) : surface_(with_fonts(options)) {}

std::string PictureSurface::png(const FrameFunction& draw, const Notes& notes) {
    return with_notes(png_bytes(surface_.frame(draw)), notes);
}

namespace {

// Print quality: curves are sampled twice as finely as on a screen.
SurfaceOptions surface_for(const PictureSize& size, double text_size, const Color& background) {
    SurfaceOptions options;
    options.width = size.width;
    options.height = size.height;
    options.scale = size.scale;
    options.text_size = options.figure_text_size = text_size;
    options.curve_fineness = 2;
    options.transparent = background.a < 255;
    return options;
}

Rectangle area_of(const PictureSize& size) {
    return {0.0F, 0.0F, static_cast<float>(size.width), static_cast<float>(size.height)};
}

// Stores the resolution in a PNG that has a size on paper.
std::string on_paper(const std::string& png, const PictureSize& size) {
    return size.width_mm > 0.0 ? with_resolution(png, size.width / size.width_mm) : png;
}

std::string pdf_of(const std::string& svg, const PictureSize& size, const Notes& notes) {
    return with_pdf_notes(pdf_of_svg(svg, size.width_mm > 0.0 ? size.width_mm : page_mm(size.width)), notes);
}

}  // namespace

std::string png_of(const Figure& figure, const PictureSize& size, const Notes& notes) {
    PictureSurface surface(surface_for(size, figure.text_size, figure.background));
    const auto draw = [&] { paint(figure, ImGui::GetBackgroundDrawList(), area_of(size), size.scale); };
    return on_paper(surface.png(draw, notes), size);
}

std::string svg_of(const Figure& figure, const PictureSize& size, const Notes& notes) {
    return svg(figure, {size.width, size.height, size.scale, size.width_mm}, assets() / "fonts", notes);
}

std::string picture_of(const Figure& figure, const PictureSize& size, const Notes& notes, const std::string& format) {
    if (format == "png") return png_of(figure, size, notes);
    if (format == "svg") return svg_of(figure, size, notes);
    return pdf_of(svg_of(figure, size, {}), size, notes);
}

std::string picture_of(const Drawing& world, const Color& background, const PictureSize& size, const Notes& notes,
                       const std::string& format) {
    if (format == "png") {
        PictureSurface surface(surface_for(size, world_text_size, background));
        const auto draw = [&] {
            paint(Sheet{Fill{area_of(size), background}}, ImGui::GetBackgroundDrawList());
            paint(world, ImGui::GetBackgroundDrawList(), area_of(size), size.scale);
        };
        return on_paper(surface.png(draw, notes), size);
    }
    const auto drawn = [&](const Notes& carried) {
        return svg(world, background, {size.width, size.height, size.scale, size.width_mm}, assets() / "fonts",
                   carried);
    };
    return format == "svg" ? drawn(notes) : pdf_of(drawn({}), size, notes);
}

std::vector<ViewDescription> views_of(const SystemDescription& description, const std::vector<std::string>& names) {
    std::vector<ViewDescription> views;
    if (names.empty()) {
        views = description.views;
        std::stable_partition(views.begin(), views.end(),
                              [](const ViewDescription& view) { return view.x.text == "t"; });
        return views;
    }
    std::vector<std::string> known;
    for (const ViewDescription& view : description.views) known.push_back(view.name);
    for (const std::string& name : names) {
        const auto at = std::find(known.begin(), known.end(), name);
        if (at == known.end()) {
            std::string all;
            for (const std::string& view : known) all += (all.empty() ? "" : ", ") + view;
            throw InputError("--view " + name, {},
                             fmt::format("this system has no view '{}'{}", name, did_you_mean(name, known)),
                             "its views are: " + all);
        }
        views.push_back(description.views[static_cast<std::size_t>(at - known.begin())]);
    }
    return views;
}

}  // namespace achilles
