#include "surface/curves.hpp"

#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>

namespace achilles {

namespace {

// Below what 8-bit coverage resolves along a straight edge (0.05 px is 13 of 255 at the edge of a stroke).
constexpr double thinning_tolerance = 0.05;

// Before its points a curve has two header vertices in the list: the bounding box and color, then the width and the
// number of points.
constexpr std::size_t header_vertices = 2;

// Marks a command as a curve. Other renderers would call it and draw nothing.
void curve_mark(const ImDrawList*, const ImDrawCmd*) {}

ImVec2 vec(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

// The whole pixels with the visible part of a curve. `header` is its first vertex.
PixelArea area_of_curve(const ImDrawVert& header, const ImDrawCmd& command) {
    const auto whole = [](float x) { return static_cast<int>(std::clamp(x, -1e6F, 1e6F)); };
    const auto low = [&](float a, float b) { return whole(std::floor(std::max({a, b, 0.0F}))); };
    const auto high = [&](float a, float b) { return whole(std::ceil(std::min(a, b))); };
    const int x = low(header.pos.x, command.ClipRect.x), y = low(header.pos.y, command.ClipRect.y);
    return {x, y, high(header.uv.x, command.ClipRect.z) - x, high(header.uv.y, command.ClipRect.w) - y};
}

}  // namespace

PixelArea common(const PixelArea& a, const PixelArea& b) {
    const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
    return {x, y, std::min(a.x + a.width, b.x + b.width) - x, std::min(a.y + a.height, b.y + b.height) - y};
}

PixelArea around(const PixelArea& a, const PixelArea& b) {
    const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

namespace {

// The long curves that were drawn last, reduced to what their pixels need. Frame after frame most of them are the same,
// and to compare their points is much faster than to thin and cut them again.
class ReducedCurves {
 public:
    const std::vector<Point>& get(const std::vector<Point>& pixels, const ClipBox& box, const ScreenStroke& stroke) {
        ++now_;
        const auto is_same = [&](const Entry& entry) {
            return entry.pixels.size() == pixels.size() && entry.width == stroke.width && entry.dash == stroke.dash &&
                   std::memcmp(&entry.box, &box, sizeof box) == 0 &&
                   std::memcmp(entry.pixels.data(), pixels.data(), pixels.size() * sizeof(Point)) == 0;
        };
        auto found = std::find_if(entries_.begin(), entries_.end(), is_same);
        if (found == entries_.end()) {
            constexpr std::size_t most = 64;
            if (entries_.size() < most) entries_.emplace_back();
            found = std::min_element(entries_.begin(), entries_.end(),
                                     [](const Entry& a, const Entry& b) { return a.used < b.used; });
            *found = {pixels, box, stroke.width, stroke.dash, reduced(pixels, box, stroke), 0};
        }
        found->used = now_;
        return found->points;
    }
    static std::vector<Point> reduced(const std::vector<Point>& pixels, const ClipBox& box,
                                      const ScreenStroke& stroke) {
        return cut(thinned(pixels, thinning_tolerance), box, stroke.dash, stroke.width / 2.0);
    }

 private:
    struct Entry {
        std::vector<Point> pixels;
        ClipBox box;
        double width = 0.0;
        std::vector<double> dash;
        std::vector<Point> points;
        long used = 0;  // when it was asked for last, in calls
    };
    std::vector<Entry> entries_;
    long now_ = 0;
};

constexpr std::size_t long_curve = 500;  // points

}  // namespace

void add_curve(ImDrawList* list, const std::vector<Point>& pixels, const ScreenStroke& stroke) {
    if (!(stroke.width > 0.0) || stroke.color.a == 0) return;
    const double margin = stroke.width / 2.0 + 1.0;
    const ImVec2 clip_low = list->GetClipRectMin(), clip_high = list->GetClipRectMax();
    const ClipBox box{clip_low.x - margin, clip_low.y - margin, clip_high.x + margin, clip_high.y + margin};
    thread_local ReducedCurves long_curves;
    std::vector<Point> short_curve;
    if (pixels.size() < long_curve) short_curve = ReducedCurves::reduced(pixels, box, stroke);
    const std::vector<Point>& points = pixels.size() < long_curve ? short_curve : long_curves.get(pixels, box, stroke);

    ClipBox bounds{1e9, 1e9, -1e9, -1e9};
    for (const Point& p : points) {
        if (!is_finite(p)) continue;
        bounds = {std::min(bounds.x_low, p.x), std::min(bounds.y_low, p.y), std::max(bounds.x_high, p.x),
                  std::max(bounds.y_high, p.y)};
    }
    if (bounds.x_low > bounds.x_high) return;

    const auto first = static_cast<std::intptr_t>(list->VtxBuffer.Size);
    list->AddCallback(curve_mark, reinterpret_cast<void*>(first));
    list->PrimReserve(0, static_cast<int>(points.size() + header_vertices));
    const Color& c = stroke.color;
    list->PrimWriteVtx(vec({bounds.x_low - margin, bounds.y_low - margin}),
                       vec({bounds.x_high + margin, bounds.y_high + margin}), IM_COL32(c.r, c.g, c.b, c.a));
    list->PrimWriteVtx(vec({stroke.width, 0.0}), {0.0F, 0.0F}, static_cast<ImU32>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool here = is_finite(points[i]), next = i + 1 < points.size() && is_finite(points[i + 1]);
        list->PrimWriteVtx(here ? vec(points[i]) : ImVec2(0.0F, 0.0F), {here && next ? pen_down : pen_up, 0.0F}, 0);
    }
    // No index refers to these vertices. Later indices are relative to their end, so that a long curve does not exhaust
    // 16 bits.
    list->_CmdHeader.VtxOffset = static_cast<unsigned>(list->VtxBuffer.Size);
    list->_OnChangedVtxOffset();
}

bool is_curve(const ImDrawCmd& command) { return command.UserCallback == curve_mark; }

StoredCurve stored_curve(const ImDrawList& list, const ImDrawCmd& command) {
    const auto first = static_cast<int>(reinterpret_cast<std::intptr_t>(command.UserCallbackData));
    const ImDrawVert &bounds = list.VtxBuffer[first], &size = list.VtxBuffer[first + 1];
    return {area_of_curve(bounds, command),
            double{size.pos.x},
            bounds.col,
            {&list.VtxBuffer[first + static_cast<int>(header_vertices)], size.col}};
}

// ---- rasters of cells ----

namespace {

// Marks a command as tiles. Other renderers would call it and draw nothing.
void tiles_mark(const ImDrawList*, const ImDrawCmd*) {}

// Header in the list before the cells of a picture; it takes as many vertices as needed.
struct Header {
    Rectangle area;
    std::int32_t columns, rows;
};

constexpr std::size_t vertices_for(std::size_t bytes) { return (bytes + sizeof(ImDrawVert) - 1) / sizeof(ImDrawVert); }
constexpr std::size_t header_bytes = vertices_for(sizeof(Header)) * sizeof(ImDrawVert);

static_assert(sizeof(Color) == 4);

const char* tiles_vertex = R"(uniform vec4 area;   // in pixels: origin, size
uniform vec2 size;   // size of the target
out vec2 at;
void main() {
    at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(2.0 * (area.xy + at * area.zw) / size - 1.0, 0.0, 1.0);
})";

const char* tiles_fragment = R"(in vec2 at;
uniform sampler2D cells;
layout(location = 0) out vec4 color;
void main() {
    ivec2 count = textureSize(cells, 0);
    color = texelFetch(cells, clamp(ivec2(floor(at * vec2(count))), ivec2(0), count - 1), 0);
})";

}  // namespace

void add_tiles(ImDrawList* list, const Rectangle& area, const Cells& cells) {
    if (cells.columns < 1 || cells.rows < 1 || std::max(cells.columns, cells.rows) > largest_texture) return;
    const auto first = static_cast<std::intptr_t>(list->VtxBuffer.Size);
    const std::size_t bytes = header_bytes + cells.colors.size() * sizeof(Color), vertices = vertices_for(bytes);
    list->AddCallback(tiles_mark, reinterpret_cast<void*>(first));
    list->PrimReserve(0, static_cast<int>(vertices));
    const Header header{area, cells.columns, cells.rows};
    std::memset(static_cast<void*>(list->_VtxWritePtr), 0, vertices * sizeof(ImDrawVert));
    std::memcpy(static_cast<void*>(list->_VtxWritePtr), &header, sizeof header);
    std::memcpy(reinterpret_cast<char*>(list->_VtxWritePtr) + header_bytes, cells.colors.data(),
                cells.colors.size() * sizeof(Color));
    list->_VtxWritePtr += vertices;
    // No index refers to these vertices. Later indices are relative to their end.
    list->_CmdHeader.VtxOffset = static_cast<unsigned>(list->VtxBuffer.Size);
    list->_OnChangedVtxOffset();
}

bool are_tiles(const ImDrawCmd& command) { return command.UserCallback == tiles_mark; }

PixelArea clip_of(const ImDrawCmd& command) {
    const auto whole = [](float x) { return static_cast<int>(std::clamp(x, -1e6F, 1e6F)); };
    const int x = std::max(whole(command.ClipRect.x), 0), y = std::max(whole(command.ClipRect.y), 0);
    return {x, y, whole(command.ClipRect.z) - x, whole(command.ClipRect.w) - y};
}

std::span<const unsigned char> curve_or_tiles(const ImDrawList& list, const ImDrawCmd& command, PixelArea& area) {
    if (!is_curve(command) && !are_tiles(command)) return {};
    const auto first = static_cast<int>(reinterpret_cast<std::intptr_t>(command.UserCallbackData));
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&list.VtxBuffer[first]);
    if (is_curve(command)) {
        area = area_of_curve(list.VtxBuffer[first], command);
        const std::size_t points = list.VtxBuffer[first + 1].col;
        return {bytes, (points + header_vertices) * sizeof(ImDrawVert)};
    }
    Header header{};
    std::memcpy(&header, bytes, sizeof header);
    const auto low = [](float x) { return static_cast<int>(std::floor(x)) - 1; };
    const auto high = [](float x) { return static_cast<int>(std::ceil(x)) + 1; };
    area = {low(header.area.x), low(header.area.y), 0, 0};
    area.width = high(header.area.x + header.area.width) - area.x;
    area.height = high(header.area.y + header.area.height) - area.y;
    area = common(area, clip_of(command));
    const std::size_t cells = static_cast<std::size_t>(header.columns) * static_cast<std::size_t>(header.rows);
    return {bytes, header_bytes + cells * sizeof(Color)};
}

TilesPainter::TilesPainter(const Gl& gl) : gl_(gl) {
    program_ = gl.program(tiles_vertex, tiles_fragment);
    gl.GenVertexArrays(1, &vertices_);
}

TilesPainter::~TilesPainter() {
    gl_.DeleteVertexArrays(1, &vertices_);
    gl_.DeleteProgram(program_);
}

void TilesPainter::draw(const ImDrawList& list, const ImDrawCmd& command, const Target& target, const PixelArea& part) {
    const auto first = static_cast<int>(reinterpret_cast<std::intptr_t>(command.UserCallbackData));
    const char* const bytes = reinterpret_cast<const char*>(&list.VtxBuffer[first]);
    Header header{};
    std::memcpy(&header, bytes, sizeof header);
    const PixelArea seen = common(clip_of(command), part);
    if (seen.width <= 0 || seen.height <= 0) return;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl_.Viewport(0, 0, target.width, target.height);
    gl_.Scissor(seen.x, seen.y, seen.width, seen.height);
    gl_.UseProgram(program_);
    gl_.BindVertexArray(vertices_);
    gl_.ActiveTexture(GL_TEXTURE0);
    const GLuint texture = gl_.texture(GL_RGBA8, header.columns, header.rows, GL_RGBA, bytes + header_bytes);
    gl_.Uniform1i(gl_.GetUniformLocation(program_, "cells"), 0);
    gl_.Uniform4f(gl_.GetUniformLocation(program_, "area"), header.area.x, header.area.y, header.area.width,
                  header.area.height);
    gl_.Uniform2f(gl_.GetUniformLocation(program_, "size"), static_cast<float>(target.width),
                  static_cast<float>(target.height));
    gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    gl_.DeleteTextures(1, &texture);
}

}  // namespace achilles
