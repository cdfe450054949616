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

// uv.x of a vertex: whether the edge to the next vertex is drawn.
constexpr float pen_down = 1.0F, pen_up = 0.0F;

// Marks a command as a curve. Other renderers would call it and draw nothing.
void curve_mark(const ImDrawList*, const ImDrawCmd*) {}

const char* edge_vertex = R"(layout(location = 0) in vec2 from;
layout(location = 1) in vec2 to;
layout(location = 2) in float pen;
uniform vec4 region;   // origin in pixels, size in mask pixels
uniform vec2 stroke;   // half width in mask pixels, mask pixels per pixel
flat out vec2 a, b;
void main() {
    a = (from - region.xy) * stroke.y;
    b = (to - region.xy) * stroke.y;
    vec2 d = b - a;
    float l = length(d);
    d = l > 1e-6 ? d / l : vec2(1.0, 0.0);
    float reach = stroke.x + 1.0;
    vec2 p = (gl_VertexID & 1) == 0 ? a - reach * d : b + reach * d;
    p += ((gl_VertexID & 2) == 0 ? reach : -reach) * vec2(-d.y, d.x);
    gl_Position = pen > 0.5 ? vec4(2.0 * p / region.zw - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
})";

// Coverage of a pixel by a stroke with round ends: the overlap of the stroke's width with the pixel's, along the line
// from the nearest point of the edge. Also correct for strokes thinner than a pixel.
const char* edge_fragment = R"(flat in vec2 a, b;
uniform vec2 stroke;
layout(location = 0) out vec4 coverage;
void main() {
    vec2 p = gl_FragCoord.xy - a, d = b - a;
    float t = clamp(dot(p, d) / max(dot(d, d), 1e-12), 0.0, 1.0);
    float r = length(p - t * d);
    coverage = vec4(clamp(min(r + 0.5, stroke.x) - max(r - 0.5, -stroke.x), 0.0, 1.0), 0.0, 0.0, 1.0);
})";

const char* overlay_vertex = R"(void main() {
    gl_Position = vec4((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? -1.0 : 1.0, 0.0, 1.0);
})";

const char* overlay_fragment = R"(uniform sampler2D mask;
uniform vec2 origin;
uniform int fineness;
uniform vec4 ink;
layout(location = 0) out vec4 color;
void main() {
    ivec2 first = (ivec2(gl_FragCoord.xy) - ivec2(origin)) * fineness;
    float sum = 0.0;
    for (int j = 0; j < fineness; ++j)
        for (int i = 0; i < fineness; ++i) sum += texelFetch(mask, first + ivec2(i, j), 0).r;
    color = vec4(ink.rgb, ink.a * sum / float(fineness * fineness));
})";

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

void add_curve(ImDrawList* list, const std::vector<Point>& pixels, const ScreenStroke& stroke) {
    if (!(stroke.width > 0.0) || stroke.color.a == 0) return;
    const double margin = stroke.width / 2.0 + 1.0;
    const ImVec2 clip_low = list->GetClipRectMin(), clip_high = list->GetClipRectMax();
    const ClipBox box{clip_low.x - margin, clip_low.y - margin, clip_high.x + margin, clip_high.y + margin};
    const std::vector<Point> points = cut(thinned(pixels, thinning_tolerance), box, stroke.dash, stroke.width / 2.0);

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

CurvePainter::CurvePainter(const Gl& gl, int fineness) : gl_(gl), fineness_(fineness) {
    edges_ = gl.program(edge_vertex, edge_fragment);
    overlay_ = gl.program(overlay_vertex, overlay_fragment);
    gl.GenVertexArrays(1, &vertices_);
}

CurvePainter::~CurvePainter() {
    gl_.DeleteFramebuffers(1, &mask_framebuffer_);
    gl_.DeleteTextures(1, &mask_);
    gl_.DeleteVertexArrays(1, &vertices_);
    gl_.DeleteProgram(overlay_);
    gl_.DeleteProgram(edges_);
}

void CurvePainter::draw(const ImDrawList& list, const ImDrawCmd& command, GLuint vertex_buffer, const Target& target,
                        const PixelArea& part) {
    const auto first = static_cast<int>(reinterpret_cast<std::intptr_t>(command.UserCallbackData));
    const ImDrawVert& bounds = list.VtxBuffer[first];
    const ImDrawVert& size = list.VtxBuffer[first + 1];
    // The mask has the same origin for every part of the curve.
    const PixelArea region = common(area_of_curve(bounds, command), PixelArea{0, 0, target.width, target.height});
    const PixelArea seen = common(region, part);
    if (seen.width <= 0 || seen.height <= 0) return;

    const int fineness = std::max(region.width, region.height) * fineness_ <= largest_texture ? fineness_ : 1;
    reserve_mask(region.width * fineness, region.height * fineness);
    draw_mask(region, seen, fineness, size.pos.x, static_cast<std::size_t>(first) + header_vertices, size.col,
              vertex_buffer);
    composite(region, seen, fineness, bounds.col, target);
}

void CurvePainter::reserve_mask(int width, int height) {
    if (width <= mask_width_ && height <= mask_height_) return;
    mask_width_ = std::max(width, mask_width_);
    mask_height_ = std::max(height, mask_height_);
    gl_.DeleteFramebuffers(1, &mask_framebuffer_);
    gl_.DeleteTextures(1, &mask_);
    mask_ = gl_.texture(GL_R8, mask_width_, mask_height_, GL_RED, nullptr);
    mask_framebuffer_ = gl_.framebuffer(mask_);
}

void CurvePainter::draw_mask(const PixelArea& region, const PixelArea& part, int fineness, double width,
                             std::size_t first, std::size_t points, GLuint vertex_buffer) {
    const int mask_width = region.width * fineness, mask_height = region.height * fineness;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, mask_framebuffer_);
    gl_.Viewport(0, 0, mask_width, mask_height);
    gl_.Scissor((part.x - region.x) * fineness, (part.y - region.y) * fineness, part.width * fineness,
                part.height * fineness);
    gl_.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    gl_.BlendEquation(GL_MAX);

    gl_.UseProgram(edges_);
    gl_.Uniform4f(gl_.GetUniformLocation(edges_, "region"), static_cast<float>(region.x), static_cast<float>(region.y),
                  static_cast<float>(mask_width), static_cast<float>(mask_height));
    gl_.Uniform2f(gl_.GetUniformLocation(edges_, "stroke"), static_cast<float>(width * fineness / 2.0),
                  static_cast<float>(fineness));

    // One instance per edge: the same vertex array, read from this vertex and from the next one.
    gl_.BindVertexArray(vertices_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer);
    const auto attribute = [&](GLuint location, GLint components, std::size_t offset) {
        gl_.EnableVertexAttribArray(location);
        gl_.VertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, sizeof(ImDrawVert),
                                reinterpret_cast<const void*>(first * sizeof(ImDrawVert) + offset));
        gl_.VertexAttribDivisor(location, 1);
    };
    attribute(0, 2, offsetof(ImDrawVert, pos));
    attribute(1, 2, sizeof(ImDrawVert) + offsetof(ImDrawVert, pos));
    attribute(2, 1, offsetof(ImDrawVert, uv));
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(points) - 1);
    gl_.BlendEquation(GL_FUNC_ADD);
}

void CurvePainter::composite(const PixelArea& region, const PixelArea& part, int fineness, unsigned color,
                             const Target& target) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl_.Viewport(0, 0, target.width, target.height);
    gl_.Scissor(part.x, part.y, part.width, part.height);
    gl_.UseProgram(overlay_);
    gl_.BindTexture(GL_TEXTURE_2D, mask_);
    gl_.Uniform1i(gl_.GetUniformLocation(overlay_, "mask"), 0);
    gl_.Uniform1i(gl_.GetUniformLocation(overlay_, "fineness"), fineness);
    gl_.Uniform2f(gl_.GetUniformLocation(overlay_, "origin"), static_cast<float>(region.x),
                  static_cast<float>(region.y));
    const ImVec4 ink = ImGui::ColorConvertU32ToFloat4(color);
    gl_.Uniform4f(gl_.GetUniformLocation(overlay_, "ink"), ink.x, ink.y, ink.z, ink.w);
    gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
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
uniform vec2 size;   // of the target
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

namespace {

Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y; }
Point between(const Point& a, const Point& b, double s) { return {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}; }

// Williams' cone algorithm. From an anchor, the tolerance around each point subtends a small angle. As long as these
// angles have a common direction, a single edge from the anchor passes all points within the tolerance.
class Cone {
 public:
    Cone(const Point& anchor, double tolerance) : anchor_(anchor), farthest_(anchor), tolerance_(tolerance) {}

    // Accepts the point; false if the edge must end at farthest().
    bool accept(const Point& point) {
        const Point v = point - anchor_;
        const double r = std::sqrt(dot(v, v));      // is_finite() has excluded overflow and underflow here
        if (r < reach_ - tolerance_) return false;  // reversal: an extreme
        if (r <= tolerance_) return true;
        if (open_ && (cross(low_, v) < 0.0 || cross(v, high_) < 0.0 || dot(low_, v) < 0.0)) return false;
        narrow(v, tolerance_ / r);
        if (r > reach_) {
            reach_ = r;
            farthest_ = point;
        }
        return true;
    }
    const Point& farthest() const { return farthest_; }
    bool empty() const { return reach_ == 0.0; }

 private:
    void narrow(const Point& v, double sine) {
        const double cosine = std::sqrt(1.0 - sine * sine);
        const Point low{v.x * cosine + v.y * sine, v.y * cosine - v.x * sine};
        const Point high{v.x * cosine - v.y * sine, v.y * cosine + v.x * sine};
        if (!open_ || cross(low_, low) > 0.0) low_ = low;
        if (!open_ || cross(high, high_) > 0.0) high_ = high;
        open_ = true;
    }

    Point anchor_, farthest_, low_{}, high_{};
    double tolerance_, reach_ = 0.0;
    bool open_ = false;
};

void thin_run(const std::vector<Point>& points, std::size_t begin, std::size_t end, double tolerance,
              std::vector<Point>& out) {
    out.push_back(points[begin]);
    Cone cone(points[begin], tolerance);
    for (std::size_t i = begin + 1; i < end; ++i) {
        if (cone.accept(points[i])) continue;
        out.push_back(cone.farthest());
        cone = Cone(cone.farthest(), tolerance);
        cone.accept(points[i]);  // a new cone accepts every point
    }
    if (end - begin > 1) {
        if (!cone.empty()) out.push_back(cone.farthest());
        out.push_back(points[end - 1]);
    }
}

// Liang-Barsky clipping: the part of the edge inside the box, as fractions of the edge.
std::optional<std::pair<double, double>> inside(const Point& a, const Point& b, const ClipBox& box) {
    double enter = 0.0, leave = 1.0;
    const auto side = [&](double start, double step, double low, double high) {
        if (step == 0.0) return start >= low && start <= high;
        const double s = (low - start) / step, t = (high - start) / step;
        enter = std::max(enter, std::min(s, t));
        leave = std::min(leave, std::max(s, t));
        return enter <= leave;
    };
    if (!side(a.x, b.x - a.x, box.x_low, box.x_high) || !side(a.y, b.y - a.y, box.y_low, box.y_high)) return {};
    return std::pair{enter, leave};
}

// Collects edges and joins consecutive ones.
class Pieces {
 public:
    void add(const Point& a, const Point& b) {
        if (out_.empty() || !joined_ || out_.back().x != a.x || out_.back().y != a.y) {
            if (!out_.empty()) out_.push_back(gap_point());
            out_.push_back(a);
        }
        out_.push_back(b);
        joined_ = true;
    }
    void lift() { joined_ = false; }
    std::vector<Point> take() { return std::move(out_); }

 private:
    std::vector<Point> out_;
    bool joined_ = false;
};

// The dash pattern as a function of arc length.
class Dashes {
 public:
    Dashes(const std::vector<double>& lengths, double cap) : lengths_(lengths), cap_(cap) {
        if (lengths_.size() % 2 != 0) lengths_.insert(lengths_.end(), lengths.begin(), lengths.end());
        period_ = std::accumulate(lengths_.begin(), lengths_.end(), 0.0);
        // A pattern shorter than a pixel would be invisible but slow.
        if (!(period_ >= 1.0) || !std::isfinite(period_)) lengths_.clear();
    }
    bool solid() const { return lengths_.empty(); }

    // Adds the dashes in the interval [from, to] of an edge with the given length that starts at arc length `start`.
    void stroke(const Point& a, const Point& b, double start, double length, double from, double to,
                Pieces& pieces) const {
        if (to > farthest_dash)
            return pieces.add(between(a, b, (from - start) / length), between(a, b, (to - start) / length));
        double offset = period_ * std::floor(from / period_);
        for (; offset < to; offset += period_) {
            double at = offset;
            for (std::size_t k = 0; k < lengths_.size(); k += 2) {
                const double middle = at + lengths_[k] / 2.0;
                const double half = std::max(lengths_[k] / 2.0 - cap_, 0.0);
                const double low = std::max(middle - half, from), high = std::min(middle + half, to);
                if (low <= high)
                    pieces.add(between(a, b, (low - start) / length), between(a, b, (high - start) / length));
                if (high < to) pieces.lift();
                at += lengths_[k] + lengths_[k + 1];
            }
        }
    }

 private:
    // Beyond this arc length rounding destroys the phase of the dashes, and far beyond it adding a period has no
    // effect.
    static constexpr double farthest_dash = 1e12;

    std::vector<double> lengths_;
    double cap_, period_ = 0.0;
};

}  // namespace

Point gap_point() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
}

bool is_finite(const Point& point) {
    // Beyond this limit the squares in the formulas would overflow. No screen is that wide.
    constexpr double largest = 1e100;
    return std::abs(point.x) < largest && std::abs(point.y) < largest;
}

std::vector<Point> thinned(const std::vector<Point>& points, double tolerance) {
    std::vector<Point> out;
    for (std::size_t begin = 0; begin < points.size();) {
        if (!is_finite(points[begin])) {
            ++begin;
            continue;
        }
        std::size_t end = begin;
        while (end < points.size() && is_finite(points[end])) ++end;
        if (!out.empty()) out.push_back(gap_point());
        thin_run(points, begin, end, tolerance, out);
        begin = end;
    }
    return out;
}

std::vector<Point> cut(const std::vector<Point>& points, const ClipBox& box, const std::vector<double>& dash,
                       double cap) {
    const Dashes dashes(dash, cap);
    Pieces pieces;
    double start = 0.0;  // arc length
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Point& a = points[i];
        const Point& b = points[i + 1];
        if (!is_finite(a) || !is_finite(b)) {
            pieces.lift();
            continue;
        }
        const double length = dashes.solid() ? 0.0 : std::hypot(b.x - a.x, b.y - a.y);  // not needed for solid lines
        const auto part = inside(a, b, box);
        if (!part) {
            pieces.lift();
        } else if (dashes.solid() || length == 0.0) {
            // The end points themselves instead of a + 1 * (b - a), because adjacent edges must join exactly.
            pieces.add(part->first > 0.0 ? between(a, b, part->first) : a,
                       part->second < 1.0 ? between(a, b, part->second) : b);
        } else {
            dashes.stroke(a, b, start, length, start + part->first * length, start + part->second * length, pieces);
        }
        start += length;
    }
    return pieces.take();
}

}  // namespace achilles
