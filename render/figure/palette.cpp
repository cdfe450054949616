#include "figure/palette.hpp"

#include <array>

namespace achilles {

namespace {

constexpr Color blue{0, 114, 178, 255}, vermilion{213, 94, 0, 255}, green{0, 158, 115, 255}, purple{170, 68, 153, 255};
constexpr Color sky{86, 180, 233, 255}, orange{240, 165, 40, 255}, mint{70, 200, 160, 255}, pink{225, 135, 190, 255};
constexpr Color olive{165, 150, 20, 255}, slate{110, 116, 124, 255}, wine{136, 34, 85, 255};
constexpr Color yellow{235, 235, 120, 255}, silver{170, 180, 180, 255}, coral{255, 120, 110, 255},
    lavender{150, 140, 255, 255};

}  // namespace

Theme light_theme() {
    return {
        false, {255, 255, 255, 255}, {35, 38, 43, 255}, {228, 230, 233, 255}, {120, 126, 134, 255}, {35, 38, 43, 255}};
}

Theme dark_theme() {
    return {
        true, {24, 26, 30, 255}, {222, 225, 230, 255}, {52, 56, 63, 255}, {128, 135, 145, 255}, {222, 225, 230, 255}};
}

Color phase_color(const Theme& theme, Phase::Kind kind) {
    if (kind == Phase::Kind::hybrid) return theme.dark ? sky : blue;
    return theme.dark ? orange : vermilion;
}

Stroke phase_stroke(const Theme& theme, Phase::Kind kind, std::size_t curve, std::size_t curves) {
    const std::array<Color, 8> light{blue, vermilion, green, purple, olive, sky, slate, wine},
        dark{sky, orange, mint, pink, yellow, lavender, silver, coral};
    Stroke stroke;
    stroke.color = curves == 1 ? phase_color(theme, kind) : (theme.dark ? dark : light)[curve % light.size()];
    stroke.width = kind == Phase::Kind::hybrid ? 1.6 : 2.0;
    if (kind == Phase::Kind::hybrid) stroke.dash = {6.0, 3.5};
    return stroke;
}

Markers event_markers(const Theme& theme, Event::Kind kind) {
    Markers markers;
    markers.edge = theme.background;
    switch (kind) {
        case Event::Kind::impact:
            markers.label = "impact";
            markers.shape = Markers::Shape::square;
            markers.fill = phase_color(theme, Phase::Kind::hybrid);
            markers.size = 6.0;
            break;
        case Event::Kind::zeno:
            markers.label = "Zeno point";
            markers.shape = Markers::Shape::diamond;
            markers.fill = theme.dark ? pink : purple;
            markers.size = 11.0;
            break;
        case Event::Kind::release:
            markers.label = "release";
            markers.shape = Markers::Shape::triangle;
            markers.fill = theme.dark ? mint : green;
            markers.size = 10.0;
            break;
    }
    return markers;
}

std::string legend_text(Phase::Kind kind) { return kind == Phase::Kind::hybrid ? "hybrid" : "constrained"; }

}  // namespace achilles
