#include "paint/paint.hpp"

#include <imgui.h>

#include "figure/layout.hpp"
#include "paint/label.hpp"
#include "paint/marker.hpp"
#include "surface/curves.hpp"
#include "surface/tiles.hpp"

namespace achilles {

namespace {

class Brush {
 public:
    explicit Brush(ImDrawList* list) : list_(list) {}
    void operator()(const Fill& fill) const {
        const Rectangle& r = fill.area;
        const Color& c = fill.color;
        list_->AddRectFilled({r.x, r.y}, {r.x + r.width, r.y + r.height}, IM_COL32(c.r, c.g, c.b, c.a));
    }
    void operator()(const Path& path) const {
        const Rectangle& r = path.clip;
        list_->PushClipRect({r.x, r.y}, {r.x + r.width, r.y + r.height}, true);
        add_curve(list_, path.points, screen_stroke(path.stroke, 1.0));
        list_->PopClipRect();
    }
    // Pieces side by side, whose edges are not smoothed: they would be seen where they meet. Lines along it hide the rest.
    void operator()(const Strip& strip) const {
        const Rectangle& r = strip.clip;
        const Color& c = strip.color;
        list_->PushClipRect({r.x, r.y}, {r.x + r.width, r.y + r.height}, true);
        const ImDrawListFlags before = list_->Flags;
        list_->Flags &= ~ImDrawListFlags_AntiAliasedFill;
        const auto at = [](const Point& p) { return ImVec2(static_cast<float>(p.x), static_cast<float>(p.y)); };
        for (std::size_t i = 0; i + 1 < strip.upper.size(); ++i)
            list_->AddQuadFilled(at(strip.upper[i]), at(strip.upper[i + 1]), at(strip.lower[i + 1]), at(strip.lower[i]),
                                 IM_COL32(c.r, c.g, c.b, c.a));
        list_->Flags = before;
        list_->PopClipRect();
    }
    void operator()(const Tiles& tiles) const {
        const Rectangle& r = tiles.clip;
        list_->PushClipRect({r.x, r.y}, {r.x + r.width, r.y + r.height}, true);
        add_tiles(list_, tiles.area, *tiles.cells);
        list_->PopClipRect();
    }
    void operator()(const Mark& mark) const { paint_marker(list_, mark); }
    void operator()(const TextRun& words) const {
        const float before = words.anchor == 0.0F ? 0.0F : words.anchor * label_width(words.label, words.size);
        paint_label(list_, words.x - (words.upwards ? 0.0F : before), words.y + (words.upwards ? before : 0.0F),
                    words.label, words.color, words.size, words.upwards ? 90 : 0);
    }

 private:
    ImDrawList* list_;
};

}  // namespace

void paint(const Sheet& sheet, ImDrawList* list) {
    const Brush brush(list);
    for (const auto& item : sheet) std::visit(brush, item);
}

void paint(const Figure& figure, ImDrawList* list, Rectangle area, double scale) {
    paint(layout(figure, label_width, area, scale), list);
}

Rectangle paint(const Panel& panel, const Figure& style, ImDrawList* list, Rectangle area, double scale) {
    Sheet sheet;
    const Rectangle plot = layout(panel, style, label_width, area, scale, sheet);
    paint(sheet, list);
    return plot;
}

}  // namespace achilles
