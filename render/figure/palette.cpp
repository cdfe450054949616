#include "figure/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/model.hpp"
#include "output/contacts.hpp"

namespace achilles {

namespace {

constexpr Color blue{0, 114, 178, 255}, vermilion{213, 94, 0, 255}, green{0, 158, 115, 255}, purple{170, 68, 153, 255};
constexpr Color sky{86, 180, 233, 255}, orange{240, 165, 40, 255}, mint{70, 200, 160, 255}, pink{225, 135, 190, 255};
// Hues of several curves in a panel. None is the hue of a phase, which the dash shows there, and the first few are not
// used for events.
constexpr Color wine{136, 34, 85, 255}, olive{130, 135, 0, 255}, slate{95, 102, 112, 255}, rose{216, 73, 131, 255},
    forest{17, 91, 15, 255}, lilac{129, 128, 238, 255}, navy{3, 17, 84, 255}, leaf{4, 153, 81, 255};
constexpr Color blush{255, 130, 150, 255}, straw{220, 220, 110, 255}, silver{185, 192, 200, 255},
    lime{119, 225, 52, 255}, violet{144, 49, 243, 255}, grass{64, 162, 88, 255}, brick{171, 89, 103, 255},
    steel{111, 123, 169, 255};
// Phases with dry friction: warm as contact, darker where it sticks and lighter where it slips.
constexpr Color brown{148, 44, 0, 255}, ocher{182, 136, 0, 255}, coral{236, 112, 66, 255}, cream{250, 228, 130, 255};

}  // namespace

Theme light_theme() {
    Theme theme;
    theme.background = {255, 255, 255, 255};
    theme.ink = theme.body = {35, 38, 43, 255};
    theme.grid = {228, 230, 233, 255};
    theme.surface = {120, 126, 134, 255};
    theme.ground = {236, 235, 231, 255};
    theme.page = {244, 245, 247, 255};
    theme.frame = {229, 231, 235, 255};
    theme.border = {203, 207, 213, 255};
    theme.faint = {98, 104, 112, 255};
    theme.accent = {33, 102, 184, 255};
    theme.selected = {223, 233, 245, 255};
    theme.error = {178, 34, 34, 255};
    theme.error_card = {253, 236, 234, 255};
    return theme;
}

Theme dark_theme() {
    Theme theme;
    theme.dark = true;
    theme.background = {27, 29, 33, 255};
    theme.ink = theme.body = {222, 225, 230, 255};
    theme.grid = {50, 54, 61, 255};
    theme.surface = {128, 135, 145, 255};
    theme.ground = {40, 42, 46, 255};
    theme.page = {18, 19, 22, 255};
    theme.frame = {44, 47, 54, 255};
    theme.border = {66, 71, 80, 255};
    theme.faint = {150, 156, 166, 255};
    theme.accent = {92, 156, 235, 255};
    theme.selected = {36, 48, 66, 255};
    theme.error = {255, 138, 128, 255};
    theme.error_card = {62, 28, 28, 255};
    return theme;
}

namespace {

// Relative luminance of a color, 0 to 1.
double luminance(const Color& color) {
    const auto linear = [](std::uint8_t byte) {
        const double x = byte / 255.0;
        return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(color.r) + 0.7152 * linear(color.g) + 0.0722 * linear(color.b);
}

}  // namespace

double contrast(const Color& a, const Color& b) {
    const double x = luminance(a), y = luminance(b);
    return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

// Moves a color toward white or black until the contrast is the original one. Gray stays gray, and the hue is kept.
Color on_theme(const Color& color, const Theme& theme) {
    if (!theme.dark) return color;
    const double wanted = contrast(color, {255, 255, 255, 255});
    const auto mixed = [&](double share) {  // -1: black, 0: the color, 1: white
        const auto part = [&](std::uint8_t x) {
            return static_cast<std::uint8_t>(std::lround(share < 0.0 ? x * (1.0 + share) : x + share * (255.0 - x)));
        };
        return Color{part(color.r), part(color.g), part(color.b), color.a};
    };
    double low = -1.0, high = 1.0;
    for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (low + high);
        const Color here = mixed(middle);
        const bool bright = luminance(here) > luminance(theme.background);
        (bright && contrast(here, theme.background) > wanted ? high : low) = middle;
    }
    return mixed(0.5 * (low + high));
}

namespace {

// Marker of each kind of event; the names are in run/trajectory.hpp. An impact has the color of flight.
struct EventSign {
    Event::Kind kind;
    Markers::MarkerShape shape;
    double size;
    Color light, dark;
    bool is_hollow = false;
};
constexpr std::array<EventSign, event_names.size()> event_signs{{
    {Event::Kind::impact, Markers::MarkerShape::square, 6.0, blue, sky},
    {Event::Kind::zeno, Markers::MarkerShape::diamond, 11.0, purple, pink},
    {Event::Kind::release, Markers::MarkerShape::triangle, 10.0, green, mint},
    {Event::Kind::stick, Markers::MarkerShape::circle, 9.0, wine, blush},
    {Event::Kind::slip, Markers::MarkerShape::circle, 9.0, wine, blush, true},
    {Event::Kind::reversal, Markers::MarkerShape::diamond, 10.0, wine, blush, true},
    {Event::Kind::collapse, Markers::MarkerShape::square, 10.0, purple, pink, true},
    {Event::Kind::jump, Markers::MarkerShape::hexagon, 9.0, navy, lilac},
    {Event::Kind::pass, Markers::MarkerShape::inverted_triangle, 9.0, blue, sky, true},
}};
static_assert(has_all_event_kinds(event_signs));

}  // namespace

PhaseLook look_of(const Model& model, ContactSet which, Mode mode) {
    if (!model.has_friction()) return PhaseLook::contact;
    const ContactSet rough = which.within(rough_in(model, mode));
    if (rough.empty()) return PhaseLook::contact;
    return rough.within(mode.slipping()).empty() ? PhaseLook::stick : PhaseLook::slip;
}

PhaseLook look_of(const Model& model, Phase::Kind kind, Mode mode) {
    // Between a cut and its Zeno point the phase is still one of flight, but its mode is the next one.
    const bool is_cut = kind == Phase::Kind::hybrid && !mode.is_free();
    if (!model.has_friction() || is_cut || rough_in(model, mode).empty()) return look_of(kind);
    return look_of(model, mode.held().with(mode.joints()), mode);
}

std::size_t look_count(const Model& model) { return model.has_friction() ? phase_looks.size() : 2; }

std::vector<PhaseLook> possible_looks(const Model& model) {
    const auto& friction = model.equations().friction;
    if (friction.empty()) return {PhaseLook::flight, PhaseLook::contact};
    const auto is_rough = [&](std::size_t contact) { return friction.contains(contact); };
    std::size_t smooth = 0;
    for (std::size_t i = 0; i < model.contacts(); ++i) smooth += is_rough(i) ? 0 : 1;
    // Joints with friction never fly.
    const bool has_joints = is_joint(friction.rbegin()->first);
    std::vector<PhaseLook> looks;
    if (!has_joints) looks.push_back(PhaseLook::flight);
    if (!has_joints && smooth > 0) looks.push_back(PhaseLook::contact);
    looks.insert(looks.end(), {PhaseLook::stick, PhaseLook::slip});
    return looks;
}

Color phase_color(const Theme& theme, PhaseLook look) {
    switch (look) {
        case PhaseLook::flight:
            return theme.dark ? sky : blue;
        case PhaseLook::contact:
            return theme.dark ? orange : vermilion;
        case PhaseLook::stick:
            return theme.dark ? coral : brown;
        case PhaseLook::slip:
            break;
    }
    return theme.dark ? cream : ocher;
}

Stroke phase_stroke(const Theme& theme, PhaseLook look, std::size_t curve, std::size_t curves) {
    const std::array<Color, 8> light{wine, olive, slate, rose, forest, lilac, navy, leaf},
        dark{blush, straw, silver, lime, violet, grass, brick, steel};
    Stroke stroke;
    stroke.color = curves == 1 ? phase_color(theme, look) : (theme.dark ? dark : light)[curve % light.size()];
    stroke.width = look == PhaseLook::flight ? 1.6 : 2.0;
    if (look == PhaseLook::flight) stroke.dash = {6.0, 3.5};
    if (look == PhaseLook::slip) stroke.dash = {7.0, 2.5, 1.5, 2.5};
    return stroke;
}

Color run_color(const Theme& theme, int place) {
    // None of these colors has the hue of a phase, an event marker or an error.
    const std::array<Color, max_pinned> light{{{118, 52, 200, 255},
                                               {140, 84, 12, 255},
                                               {225, 30, 180, 255},
                                               {0, 140, 165, 255},
                                               {92, 122, 0, 255},
                                               {176, 20, 52, 255}}},
        dark{{{170, 130, 255, 255},
              {205, 150, 85, 255},
              {245, 105, 215, 255},
              {50, 200, 220, 255},
              {165, 195, 60, 255},
              {255, 100, 110, 255}}};
    return (theme.dark ? dark : light)[static_cast<std::size_t>(std::max(place, 1) - 1) % light.size()];
}

Stroke pinned_stroke(const Theme& theme, const Stroke& stroke, int place) {
    constexpr double share = 0.6;  // of the width of the present run
    return {run_color(theme, place), share * stroke.width, stroke.dash};
}

Markers event_markers(const Theme& theme, Event::Kind kind) {
    const EventSign& sign = event_signs[static_cast<std::size_t>(kind)];
    Markers markers;
    markers.label = names_of(kind).name;
    markers.shape = sign.shape;
    markers.fill = theme.dark ? sign.dark : sign.light;
    markers.edge = theme.background;
    if (sign.is_hollow) std::swap(markers.fill, markers.edge);
    markers.size = sign.size;
    markers.apart = event_marker_distance;
    return markers;
}

Markers opened_markers(const Theme& theme) {
    Markers markers = event_markers(theme, Event::Kind::release);
    markers.label = "opened by an impact";
    markers.edge = markers.fill;
    markers.fill = theme.background;
    markers.lift = markers.size;
    return markers;
}

std::string legend_text(PhaseLook look) {
    constexpr std::array<const char*, phase_looks.size()> texts{"in flight", "in contact", "sticking", "sliding"};
    return texts[static_cast<std::size_t>(look)];
}

std::string events_name(std::span<const Trajectory* const> runs, Event::Kind kind) {
    std::string names;
    for (const Trajectory* run : runs) {
        if (kind != Event::Kind::zeno) break;  // other kinds have one name only, and there may be very many impacts
        for (const Event& event : run->events) {
            if (event.kind != kind) continue;
            const std::string name(names_of(event).name);
            if (names.find(name) == std::string::npos) names += (names.empty() ? "" : ", ") + name;
        }
    }
    return names.empty() ? std::string(names_of(kind).name) : names;
}

// ---- colors for numbers ----

Color oklab(double lightness, double a, double b) {
    const auto cube = [](double x) { return x * x * x; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b),
                 m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b),
                 s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    const auto byte = [](double x) {
        const double x_in_gamut = std::clamp(x, 0.0, 1.0);
        const double shown =
            x_in_gamut <= 0.0031308 ? 12.92 * x_in_gamut : 1.055 * std::pow(x_in_gamut, 1.0 / 2.4) - 0.055;
        return static_cast<std::uint8_t>(std::lround(255.0 * shown));
    };
    return {byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 255};
}

Color number_color(double share) {
    constexpr double chroma = 0.125, turn = 190.0 / 180.0 * std::numbers::pi;
    const double s = std::clamp(share, 0.0, 1.0);
    return oklab(0.25 + 0.67 * s, chroma * std::sin(turn * s), -chroma * std::cos(turn * s));
}

std::vector<Color> number_colors(std::size_t count) {
    std::vector<Color> colors;
    for (std::size_t i = 0; i < count; ++i)
        colors.push_back(
            number_color(static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(count, 2) - 1)));
    return colors;
}

}  // namespace achilles
