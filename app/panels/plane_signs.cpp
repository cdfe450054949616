// Words and arrows over the plot of the configuration plane.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "figure/palette.hpp"
#include "paint/label.hpp"
#include "panels/plane.hpp"
#include "panels/print.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

struct Box {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
    bool meets(const Box& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};
Box around(const Point& p, double width, double height) {
    return {p.x - 0.5 * width, p.y - 0.5 * height, p.x + 0.5 * width, p.y + 0.5 * height};
}

// Which little squares of the plot hold something of the run: all of it, or the signs of its events alone.
class Trodden {
 public:
    Trodden(const Panel& panel, const PanelMap& map, const Rectangle& plot, bool by_signs_alone)
        : plot_(plot),
          side_(double{units(9.0F)}),
          columns_(static_cast<int>(double{plot.width} / side_) + 1),
          rows_(static_cast<int>(double{plot.height} / side_) + 1),
          squares_(static_cast<std::size_t>(columns_ * rows_)) {
        for (const Curve& curve : by_signs_alone ? std::span<const Curve>() : std::span(panel.curves))
            for (std::size_t i = 0; i < curve.points.size(); ++i) {
                const Point to = map(curve.points[i]), from = i > 0 ? map(curve.points[i - 1]) : to;
                const double length = std::hypot(to.x - from.x, to.y - from.y) / side_;
                const int steps = length < 1.0 ? 1 : length < 400.0 ? static_cast<int>(length) + 1 : 0;
                for (int k = 0; k < steps; ++k)
                    tread(to.x + (from.x - to.x) * k / steps, to.y + (from.y - to.y) * k / steps);
            }
        for (const Markers& markers : panel.markers)
            for (const Point& point : markers.points) {
                const Point at = map(point);
                tread(at.x, at.y);
            }
    }
    bool is_free(const Box& box) const {
        for (double y = box.top; y < box.bottom + side_; y += side_)
            for (double x = box.left; x < box.right + side_; x += side_) {
                const auto at = square(std::min(x, box.right), std::min(y, box.bottom));
                if (at && squares_[*at]) return false;
            }
        return true;
    }

 private:
    std::optional<std::size_t> square(double x, double y) const {
        const double column = std::floor((x - double{plot_.x}) / side_),
                     row = std::floor((y - double{plot_.y}) / side_);
        if (!(column >= 0.0 && column < columns_ && row >= 0.0 && row < rows_)) return std::nullopt;
        return static_cast<std::size_t>(static_cast<int>(row) * columns_ + static_cast<int>(column));
    }
    void tread(double x, double y) {
        if (const auto at = square(x, y)) squares_[*at] = true;
    }
    Rectangle plot_;
    double side_;
    int columns_, rows_;
    std::vector<bool> squares_;
};

// Where a word stands on one of these lines, or beside it (1 or -1): far from the others, and where the run does not go.
std::optional<Point> room_for(const std::vector<Point>& line, double beside, const PanelMap& map, const Box& inside,
                              double width, double height, const std::vector<Box>& taken, const Trodden& run) {
    constexpr double far = 1e3;
    constexpr std::size_t looked_at = 60;
    const std::size_t segments = line.size() / 3, step = std::max<std::size_t>(1, segments / looked_at);
    double best = -1.0;
    std::optional<Point> found;
    for (std::size_t k = step / 2; k < segments; k += step) {
        const Point a = map(line[3 * k]), b = map(line[3 * k + 1]);
        Point middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
        if (const double length = std::hypot(b.x - a.x, b.y - a.y); length > 0.0) {
            const double u = (b.y - a.y) / length, v = (a.x - b.x) / length;  // across the line
            const double clear = beside * (0.5 * (std::abs(u) * width + std::abs(v) * height) + double{units(6.0F)});
            middle = {middle.x + clear * u, middle.y + clear * v};
        }
        const Box box = around(middle, width, height);
        if (!(box.left > inside.left && box.right < inside.right && box.top > inside.top && box.bottom < inside.bottom))
            continue;
        double nearest = far;
        bool is_taken = false;
        for (const Box& other : taken) {
            is_taken = is_taken || box.meets(other);
            nearest = std::min(nearest, std::hypot(middle.x - 0.5 * (other.left + other.right),
                                                   middle.y - 0.5 * (other.top + other.bottom)));
        }
        if (is_taken || nearest <= best || !run.is_free(box)) continue;
        best = nearest;
        found = middle;
    }
    return found;
}

}  // namespace

void name_plane_lines(const Session& session, const Panel& panel, const PanelMap& map, const Rectangle& plot,
                      const PlaneView& plane, const std::vector<Point>& places) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Theme& theme = session.theme();
    const float size = 0.85F * ImGui::GetFontSize();
    const double edge = double{units(4.0F)}, height = 1.2 * double{size};
    const Box inside{double{plot.x} + edge, double{plot.y} + edge, double{plot.x} + double{plot.width} - edge,
                     double{plot.y} + double{plot.height} - edge};
    std::vector<Box> taken;
    for (const Point& place : places) taken.push_back(around(place, 5.0 * edge, 5.0 * edge));
    const Trodden run(panel, map, plot, false), signs(panel, map, plot, true);
    const auto name = [&](const std::vector<Point>& line, const std::string& text, const Color& color, bool always) {
        const double width = double{label_width(text, size)} + 2.0 * edge;
        const auto room = [&](double beside, const Trodden& clear) {
            return room_for(line, beside, map, inside, width, height, taken, clear);
        };
        std::optional<Point> at = room(0.0, run);
        for (const double beside : {1.0, -1.0})
            if (!at && always) at = room(beside, run);
        if (!at && always) at = room(0.0, signs);
        if (!at) return;
        const Box box = around(*at, width, height);
        const auto left = static_cast<float>(box.left), top = static_cast<float>(box.top);
        list->AddRectFilled({left, top}, {static_cast<float>(box.right), static_cast<float>(box.bottom)},
                            packed(theme.background, 0.8F), units(2.0F));
        paint_label(list, std::floor(left + static_cast<float>(edge)), std::floor(top + 0.1F * size), text, color,
                    size);
        taken.push_back(box);
    };
    const auto& constraints = session.description().constraints;
    if (constraints.size() > 1)
        for (const Plane::Surface& surface : plane.surfaces.lines)
            name(surface.points, constraints[surface.contact].name, text_color(), true);
    for (const Plane::Level& level : plane.levels) name(level.points, level.label, faint_color(), false);
}

void paint_impacts(const Session& session, const PanelMap& map, const PlaneView& plane) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Color color = event_markers(session.theme(), Event::Kind::impact).fill;
    const double unit = double{units(1.0F)};
    const ImVec2 low = list->GetClipRectMin(), high = list->GetClipRectMax();
    const auto pixel = [](const Point& p) { return ImVec2{static_cast<float>(p.x), static_cast<float>(p.y)}; };
    for (const ImpactArrow& arrow : plane.arrows) {
        const Point a = map(arrow.from), b = map(arrow.to), coming = map(arrow.coming);
        const double x = b.x - a.x, y = b.y - a.y, length = std::hypot(x, y);
        // A bow away from where the motion comes from, so that it crosses nothing of it; the longer the flatter.
        constexpr double deepest = 30.0, bend = 80.0;
        const double side = x * (coming.y - a.y) - y * (coming.x - a.x) > 0.0 ? 1.0 : -1.0;
        const double across_x = side * y / length, across_y = -side * x / length;
        const Point middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
        const auto room = [&](double at, double way, double from, double to) {
            return way == 0.0 ? deepest * unit : ((way > 0.0 ? to : from) - at) / way - 2.0 * unit;
        };
        const double deep = std::min({deepest * unit * length / (length + bend * unit),
                                      room(middle.x, across_x, double{low.x}, double{high.x}),
                                      room(middle.y, across_y, double{low.y}, double{high.y})});
        const double depth = 2.0 * std::max(deep, 0.0);  // of the point that the bow bends towards
        const Point top{middle.x + depth * across_x, middle.y + depth * across_y};
        const double end = std::hypot(b.x - top.x, b.y - top.y);
        const double u = (b.x - top.x) / end, v = (b.y - top.y) / end;  // the way it arrives
        const double head = std::min(8.0 * unit, 0.5 * length), half = 0.4 * head;
        const Point tip{b.x - 3.0 * unit * u, b.y - 3.0 * unit * v};  // at the edge of the event's sign
        const Point neck{tip.x - head * u, tip.y - head * v};
        std::vector<Point> bow;
        constexpr int parts = 16;
        for (int i = 0; i <= parts; ++i) {
            const double s = static_cast<double>(i) / parts, r = 1.0 - s;
            bow.push_back({r * r * a.x + 2.0 * r * s * top.x + s * s * neck.x,
                           r * r * a.y + 2.0 * r * s * top.y + s * s * neck.y});
        }
        add_curve(list, bow, screen_stroke({color, 1.3, {}}, unit));
        list->AddTriangleFilled(pixel(tip), pixel({neck.x - half * v, neck.y + half * u}),
                                pixel({neck.x + half * v, neck.y - half * u}), packed(color));
    }
}

}  // namespace achilles
