#include "golden/mutated_figures.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "cli/assets.hpp"
#include "figure/layout.hpp"
#include "golden/pictures.hpp"
#include "paint/paint.hpp"

namespace achilles::golden {

namespace {

// The digit that looks most similar: the change that is hardest to see.
char lookalike(char digit) {
    constexpr std::string_view others = "8738168138";
    return others[static_cast<std::size_t>(digit - '0')];
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// The color with its hue turned by a tenth of the color wheel, at the same brightness.
Color turned(const Color& color) {
    const double high = std::max({color.r, color.g, color.b}), low = std::min({color.r, color.g, color.b});
    if (high == low) return color;
    const double span = high - low;
    const double hue = high == color.r   ? (color.g - color.b) / span
                       : high == color.g ? (color.b - color.r) / span + 2.0
                                         : (color.r - color.g) / span + 4.0;
    const auto channel = [&](double offset) {
        const double k = std::fmod(hue + 0.6 + offset + 12.0, 6.0);
        return static_cast<std::uint8_t>(std::lround(high - span * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0)));
    };
    return {channel(5.0), channel(3.0), channel(1.0), color.a};
}

// A nearly gray color has no hue to change.
bool has_hue(const Color& color) {
    return std::max({color.r, color.g, color.b}) - std::min({color.r, color.g, color.b}) > 40;
}

// Whether no other marker covers this one.
bool stands_alone(const Sheet& sheet, std::size_t item) {
    const auto& mark = std::get<Mark>(sheet[item]);
    for (std::size_t i = 0; i < sheet.size(); ++i) {
        const auto* other = std::get_if<Mark>(&sheet[i]);
        if (other == nullptr || i == item) continue;
        if (std::hypot(other->at.x - mark.at.x, other->at.y - mark.at.y) < mark.size) return false;
    }
    return true;
}

// Horizontal and vertical extent of a curve, summed over separate parts.
Point extent(const Path& path) {
    Point sum;
    for (std::size_t i = 1; i < path.points.size(); ++i) {
        const double x = std::abs(path.points[i].x - path.points[i - 1].x);
        const double y = std::abs(path.points[i].y - path.points[i - 1].y);
        if (std::isfinite(x) && std::isfinite(y)) sum = {sum.x + x, sum.y + y};
    }
    return sum;
}

void move(Path& path, double x, double y) {
    for (Point& point : path.points) point = {point.x + x, point.y + y};
}

SurfaceOptions page() {
    SurfaceOptions options;
    options.width = figure_width;
    options.height = figure_height;
    options.scale = figure_scale;
    options.text_size = options.figure_text_size = Figure().text_size;
    options.curve_fineness = 2;
    options.fonts = assets() / "fonts";
    return options;
}

}  // namespace

std::string to_text(const FigureMutation& lie, const Sheet& truth) {
    switch (lie.kind) {
        case FigureMutation::Kind::moved_right:
            return fmt::format("curve {} one pixel to the right", lie.item);
        case FigureMutation::Kind::moved_up:
            return fmt::format("curve {} one pixel up", lie.item);
        case FigureMutation::Kind::other_hue:
            return fmt::format("curve {} in another hue", lie.item);
        case FigureMutation::Kind::thicker:
            return fmt::format("curve {} thicker by a fifth", lie.item);
        case FigureMutation::Kind::no_marker:
            return fmt::format("marker {} missing", lie.item);
        case FigureMutation::Kind::other_digit:
            break;
    }
    return fmt::format("\"{}\" for \"{}\"", std::get<TextRun>(told(lie, truth)[lie.item]).label,
                       std::get<TextRun>(truth[lie.item]).label);
}

std::vector<FigureMutation> lies_about(const Sheet& truth) {
    constexpr double visible = 8.0;  // pixels: markers at the ends cover shorter curves
    std::vector<FigureMutation> lies;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (const auto* path = std::get_if<Path>(&truth[i])) {
            const Point goes = extent(*path);
            // A straight line moved along itself does not change.
            if (goes.y > visible) lies.push_back({FigureMutation::Kind::moved_right, i, 0});
            if (goes.x > visible) lies.push_back({FigureMutation::Kind::moved_up, i, 0});
            if (goes.x + goes.y > visible && has_hue(path->stroke.color))
                lies.push_back({FigureMutation::Kind::other_hue, i, 0});
            if (goes.x + goes.y > visible) lies.push_back({FigureMutation::Kind::thicker, i, 0});
        }
        if (std::holds_alternative<Mark>(truth[i]) && stands_alone(truth, i))
            lies.push_back({FigureMutation::Kind::no_marker, i, 0});
        if (const auto* words = std::get_if<TextRun>(&truth[i]))
            for (std::size_t k = 0; k < words->label.size(); ++k)
                if (is_digit(words->label[k])) lies.push_back({FigureMutation::Kind::other_digit, i, k});
    }
    return lies;
}

Sheet told(const FigureMutation& lie, Sheet sheet) {
    auto& item = sheet[lie.item];
    switch (lie.kind) {
        case FigureMutation::Kind::moved_right:
            move(std::get<Path>(item), 1.0, 0.0);
            break;
        case FigureMutation::Kind::moved_up:
            move(std::get<Path>(item), 0.0, -1.0);
            break;
        case FigureMutation::Kind::other_hue:
            std::get<Path>(item).stroke.color = turned(std::get<Path>(item).stroke.color);
            break;
        case FigureMutation::Kind::thicker:
            std::get<Path>(item).stroke.width *= 1.2;
            break;
        case FigureMutation::Kind::no_marker:
            sheet.erase(sheet.begin() + static_cast<std::ptrdiff_t>(lie.item));
            break;
        case FigureMutation::Kind::other_digit: {
            char& letter = std::get<TextRun>(item).label[lie.letter];
            letter = lookalike(letter);
            break;
        }
    }
    return sheet;
}

Easel::Easel(const std::string& system) : surface_(page()) {
    PublicationStyle style;
    style.size = {figure_width, figure_height};
    const Figure figure = gallery_figure(gallery_run(system), style);
    const Rectangle area{0.0F, 0.0F, static_cast<float>(figure_width), static_cast<float>(figure_height)};
    surface_.step([&] { truth_ = layout(figure, label_width, area, figure_scale); });
}

Image Easel::draw(const Sheet& sheet) {
    return surface_.frame([&] { paint(sheet, ImGui::GetBackgroundDrawList()); });
}

}  // namespace achilles::golden
