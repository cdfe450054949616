#include "session/mechanism_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "figure/label.hpp"
#include "figure/mechanism_scene.hpp"
#include "session/number_text.hpp"

namespace achilles {

namespace {

CameraPicture picture_in(const Session& session, const Rectangle& area) {
    const double arrow = longest_arrow * std::min(double{area.width}, double{area.height});
    const auto length = [&](const char* layer) { return session.scene().shows(layer) ? arrow : 0.0; };
    return {double{area.width}, double{area.height}, length("velocity"), length("force")};
}

// "24 000", with two digits.
std::string rounded_count(double value) {
    const int power = std::max(0, static_cast<int>(std::floor(std::log10(value))));
    const double digits = std::round(value / std::pow(10.0, power - 1));
    if (power > 5) return fmt::format("{:.1f}\u00b7{}", 0.1 * digits, power_of_ten(power));
    std::string text = fmt::format("{:.0f}", digits * std::pow(10.0, power - 1));
    for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), "\u00a0");
    return text;
}

}  // namespace

// What the Zeno camera shows, since a picture of two lines does not say it: how much it enlarges, and the bounce.
std::array<std::string, 2> zeno_words(const Session& session, const Rectangle& world) {
    const auto view = session.mechanism_scene().camera().zeno_view(session.now(), picture_in(session, world));
    if (!view) return {"no bounces now: the whole run", ""};
    const auto length = [&](double value) {
        return number_with_unit(number(value, "{:.2g}"), session.mechanism_scene().unit());
    };
    return {fmt::format("{}{} times enlarged", view->is_inside_body ? "inside the body, " : "",
                        rounded_count(view->enlargement)),
            view->is_cut ? fmt::format("the bounces are cut; the last was about {} high", length(view->bounce))
                         : fmt::format("gap {} in a bounce about {} high", length(view->gap), length(view->bounce))};
}

Drawing seen_world(const Session& session, const Rectangle& area) {
    const Scene& scene = session.scene();
    const double width = double{area.width}, height = double{area.height};
    if (const auto look = scene.look()) {
        Drawing drawing = session.limits();
        const double high = look->width * height / width;
        drawing.x_low = look->x - 0.5 * look->width, drawing.x_high = look->x + 0.5 * look->width;
        drawing.y_low = look->y - 0.5 * high, drawing.y_high = look->y + 0.5 * high;
        return drawing;
    }
    const CameraPicture picture = picture_in(session, area);
    return widened(session.mechanism_scene().camera().at(scene.camera(), session.now(), picture), width, height);
}

bool shows_plane(const Session& session) { return session.scene().shows("plane") || session.mechanism().is_empty(); }

bool shows_sides(const Session& session) {
    return session.scene().shows("sides") && TwoViews(session.trajectory(), session.samples()).exist();
}

std::vector<const char*> layers_of(const Session& session, bool can_show_contours) {
    const bool plane = shows_plane(session), sides = !plane && shows_sides(session);
    const bool has_sides = TwoViews(session.trajectory(), session.samples()).exist();
    std::vector<const char*> layers;
    for (const char* what : {"plane", "contours", "sides", "force", "velocity", "strobe", "trail"}) {
        const std::string_view word = what;
        if (word == "plane" ? session.mechanism().is_empty() : plane != (word == "contours")) continue;
        if (word == "contours" && !can_show_contours) continue;
        if (word == "sides" ? !has_sides : sides && word != "trail" && word != "plane") continue;
        layers.push_back(what);
    }
    return layers;
}

command::SetStart start_of(const Session& session, const Vector* q, const Vector* v) {
    command::SetStart start;
    const auto& coordinates = session.description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        if (q != nullptr) start.values.emplace_back(coordinates[i].name, (*q)[at]);
        if (v != nullptr) start.values.emplace_back(coordinates[i].name + "'", (*v)[at]);
    }
    return start;
}

void turn_by_hand(const Session& session, const ViewAngles& from, double right, double down, Commands& commands) {
    constexpr double share = 0.5;
    const ViewAngles to = rounded({from.about + share * right, from.tilt + share * down}), now = session.direction();
    if (to == now && session.scene().direction()) return;
    commands.emplace_back(command::Turn{to.about, to.tilt});
    const auto look = session.scene().look();
    if (!look) return;
    const Model& model = *session.model();
    const SpaceView before(model, now), after(model, to);
    const double depth = before.seen(before.place(session.now().state.q)).z();
    const SpaceView::Place middle = after.seen(before.unseen({look->x, look->y, depth}));
    commands.emplace_back(command::LookAt{middle.x(), middle.y(), look->width});
}

}  // namespace achilles
