// The OpenGL part of curves: their coverage masks, all in one texture, and the pixels that take their ink.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "surface/curves.hpp"

namespace achilles {

namespace {

const char* edge_vertex = R"(layout(location = 0) in vec4 edge;   // its ends, pixels
uniform vec4 region;   // origin in pixels, size in mask pixels
uniform vec2 stroke;   // half width in mask pixels, mask pixels per pixel
flat out vec2 a, b;
void main() {
    a = (edge.xy - region.xy) * stroke.y;
    b = (edge.zw - region.xy) * stroke.y;
    vec2 d = b - a;
    float l = length(d);
    d = l > 1e-6 ? d / l : vec2(1.0, 0.0);
    float reach = stroke.x + 1.0;
    vec2 p = (gl_VertexID & 1) == 0 ? a - reach * d : b + reach * d;
    p += ((gl_VertexID & 2) == 0 ? reach : -reach) * vec2(-d.y, d.x);
    gl_Position = vec4(2.0 * p / region.zw - 1.0, 0.0, 1.0);
})";

// Coverage of a pixel by a stroke with round ends: the overlap of the stroke's width with the pixel's, along the line
// from the nearest point of the edge. Also correct for strokes thinner than a pixel.
const char* edge_fragment = R"(flat in vec2 a, b;
uniform vec2 stroke;
uniform vec2 origin;   // corner of the region in the mask
layout(location = 0) out vec4 coverage;
void main() {
    vec2 p = (gl_FragCoord.xy - origin) - a, d = b - a;
    float t = clamp(dot(p, d) / max(dot(d, d), 1e-12), 0.0, 1.0);
    float r = length(p - t * d);
    coverage = vec4(clamp(min(r + 0.5, stroke.x) - max(r - 0.5, -stroke.x), 0.0, 1.0), 0.0, 0.0, 1.0);
})";

const char* overlay_vertex = R"(layout(location = 0) in vec4 area;   // in pixels: origin, size
uniform vec2 size;   // size of the target
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float((gl_VertexID >> 1) & 1));
    gl_Position = vec4(2.0 * (area.xy + corner * area.zw) / size - 1.0, 0.0, 1.0);
})";

const char* overlay_fragment = R"(uniform sampler2D mask;
uniform vec4 shift;   // a pixel, and its place in the mask
uniform int fineness;
uniform vec4 ink;
layout(location = 0) out vec4 color;
void main() {
    ivec2 first = (ivec2(gl_FragCoord.xy) - ivec2(shift.xy)) * fineness + ivec2(shift.zw);
    float sum = 0.0;
    for (int j = 0; j < fineness; ++j)
        for (int i = 0; i < fineness; ++i) sum += texelFetch(mask, first + ivec2(i, j), 0).r;
    color = vec4(ink.rgb, ink.a * sum / float(fineness * fineness));
})";

// Tiles of a part of the picture that a curve may touch.
class TouchedTiles {
 public:
    explicit TouchedTiles(const PixelArea& part)
        : part_(part),
          columns_((part.width + tile - 1) / tile),
          rows_((part.height + tile - 1) / tile),
          marks_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}
    // Marks the tiles within `reach` of an edge, and some next to them.
    void add(const ImVec2& from, const ImVec2& to, double reach) {
        constexpr double step = tile / 2.0;  // pixels along the edge
        const double x = double{from.x} - part_.x, y = double{from.y} - part_.y;
        const double across = double{to.x} - from.x, down = double{to.y} - from.y;
        const double around = reach + step / 2.0;
        const int parts = 1 + static_cast<int>(std::hypot(across, down) / step);
        for (int k = 0; k <= parts; ++k) mark(x + across * k / parts, y + down * k / parts, around);
    }
    // Runs of them, without overlap: origin and size of each, in pixels.
    std::vector<CurvePainter::Four> areas() const {
        std::vector<CurvePainter::Four> all;
        for (int row = 0; row < rows_; ++row)
            for (int from = 0; from < columns_;) {
                int to = from;
                while (to < columns_ && marks_[at(to, row)] != 0) ++to;
                const int x = from * tile, y = row * tile;
                if (to > from)
                    all.push_back({static_cast<float>(part_.x + x), static_cast<float>(part_.y + y),
                                   static_cast<float>(std::min(to * tile, part_.width) - x),
                                   static_cast<float>(std::min(tile, part_.height - y))});
                from = to + 1;
            }
        return all;
    }

 private:
    static constexpr int tile = 16;  // pixels
    std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    void mark(double x, double y, double around) {
        const auto tile_at = [](double pixels) { return static_cast<int>(std::floor(pixels / tile)); };
        const int left = std::max(tile_at(x - around), 0), right = std::min(tile_at(x + around), columns_ - 1);
        const int top = std::max(tile_at(y - around), 0), bottom = std::min(tile_at(y + around), rows_ - 1);
        for (int row = top; row <= bottom; ++row)
            for (int column = left; column <= right; ++column) marks_[at(column, row)] = 1;
    }
    PixelArea part_;
    int columns_, rows_;
    std::vector<unsigned char> marks_;
};

// Four vertices per quadrilateral, which gl_VertexID tells apart. Instances would be as short, but Mesa's software
// renderer takes several times as long for them.
void add_corners(const CurvePainter::Four& values, std::vector<CurvePainter::Four>& vertices) {
    vertices.insert(vertices.end(), 4, values);
}

const void* offset_of_quad(std::size_t quad) { return reinterpret_cast<const void*>(6 * quad * sizeof(GLuint)); }

}  // namespace

CurvePainter::CurvePainter(const Gl& gl, int fineness) : gl_(gl), fineness_(fineness) {
    edges_ = gl.program(edge_vertex, edge_fragment);
    overlay_ = gl.program(overlay_vertex, overlay_fragment);
    gl.GenVertexArrays(1, &vertex_array_);
    gl.GenBuffers(1, &vertex_buffer_);
    gl.GenBuffers(1, &index_buffer_);
    gl.BindVertexArray(vertex_array_);
    gl.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.BindVertexArray(0);
}

CurvePainter::~CurvePainter() {
    gl_.DeleteFramebuffers(1, &mask_framebuffer_);
    gl_.DeleteTextures(1, &mask_);
    gl_.DeleteBuffers(1, &index_buffer_);
    gl_.DeleteBuffers(1, &vertex_buffer_);
    gl_.DeleteVertexArrays(1, &vertex_array_);
    gl_.DeleteProgram(overlay_);
    gl_.DeleteProgram(edges_);
}

void CurvePainter::begin() {
    curves_.clear();
    vertices_.clear();
    next_ = masked_ = 0;
    is_loaded_ = false;
}

void CurvePainter::add(const ImDrawList& list, const ImDrawCmd& command, const Target& target, const PixelArea& part) {
    const StoredCurve stored = stored_curve(list, command);
    PreparedCurve& curve = curves_.emplace_back();
    // Coordinates in the mask have the same origin for every part of the curve.
    curve.region = common(stored.area, PixelArea{0, 0, target.width, target.height});
    curve.part = common(curve.region, part);
    curve.width = stored.width, curve.color = stored.color;
    if (curve.part.width <= 0 || curve.part.height <= 0) return;
    const PixelArea& region = curve.region;
    curve.fineness = std::max(region.width, region.height) * fineness_ <= largest_texture ? fineness_ : 1;
    curve.first_edge = vertices_.size() / 4;
    const double reach = stored.width / 2.0 + 1.0;
    const double left = curve.part.x - reach, right = curve.part.x + curve.part.width + reach;
    const double top = curve.part.y - reach, bottom = curve.part.y + curve.part.height + reach;
    TouchedTiles tiles(curve.part);
    for (std::size_t i = 0; i + 1 < stored.points.size(); ++i) {
        if (stored.points[i].uv.x != pen_down) continue;
        const ImVec2 &a = stored.points[i].pos, &b = stored.points[i + 1].pos;
        if (std::max(a.x, b.x) < left || std::min(a.x, b.x) > right || std::max(a.y, b.y) < top ||
            std::min(a.y, b.y) > bottom)
            continue;
        add_corners({a.x, a.y, b.x, b.y}, vertices_);
        tiles.add(a, b, reach);
    }
    curve.edges = vertices_.size() / 4 - curve.first_edge;
    curve.first_area = vertices_.size() / 4;
    for (const Four& area : tiles.areas()) add_corners(area, vertices_);
    curve.areas = vertices_.size() / 4 - curve.first_area;
}

void CurvePainter::draw_next(const Target& target) {
    const std::size_t at = next_++;
    if (curves_[at].edges == 0) return;
    gl_.BindVertexArray(vertex_array_);
    if (!std::exchange(is_loaded_, true)) load();
    if (at >= masked_) draw_masks(at);
    composite(curves_[at], target);
}

// Uploads the vertices of the frame, and indices for as many quadrilaterals.
void CurvePainter::load() {
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(Four)), vertices_.data(),
                   GL_STREAM_DRAW);
    const std::size_t count = vertices_.size() / 4;
    if (count <= indexed_) return;
    indexed_ = 2 * count;
    std::vector<GLuint> indices;
    indices.reserve(6 * indexed_);
    for (std::size_t quad = 0; quad < indexed_; ++quad)
        for (const GLuint corner : {0u, 1u, 2u, 2u, 1u, 3u}) indices.push_back(static_cast<GLuint>(4 * quad) + corner);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)), indices.data(),
                   GL_STATIC_DRAW);
}

// Places masks in rows, from this curve on until the texture is full.
void CurvePainter::place_masks(std::size_t first, int& width, int& height) {
    constexpr int usual_width = 2048, most_height = 4096;
    width = usual_width, height = 0;
    for (std::size_t i = first; i < curves_.size(); ++i)
        width = std::max(width, curves_[i].part.width * curves_[i].fineness);
    int x = 0, y = 0;
    for (masked_ = first; masked_ < curves_.size(); ++masked_) {
        PreparedCurve& curve = curves_[masked_];
        if (curve.edges == 0) continue;
        const int across = curve.part.width * curve.fineness, down = curve.part.height * curve.fineness;
        if (x + across > width) x = 0, y = height;
        if (masked_ > first && y + down > most_height) return;
        curve.x = x, curve.y = y;
        x += across;
        height = std::max(height, y + down);
    }
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

// All masks in one go: a renderer that works in tiles, as Mesa's does, begins anew at every change of the framebuffer.
void CurvePainter::draw_masks(std::size_t first) {
    int width = 0, height = 0;
    place_masks(first, width, height);
    reserve_mask(width, height);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, mask_framebuffer_);
    gl_.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl_.BlendEquation(GL_MAX);
    gl_.UseProgram(edges_);
    for (std::size_t i = first; i < masked_; ++i)
        if (curves_[i].edges > 0) draw_mask(curves_[i]);
    gl_.BlendEquation(GL_FUNC_ADD);
}

void CurvePainter::draw_mask(const PreparedCurve& curve) {
    const PixelArea &region = curve.region, &part = curve.part;
    const int fineness = curve.fineness, width = region.width * fineness, height = region.height * fineness;
    const int x = curve.x - (part.x - region.x) * fineness, y = curve.y - (part.y - region.y) * fineness;
    gl_.Viewport(x, y, width, height);
    gl_.Scissor(curve.x, curve.y, part.width * fineness, part.height * fineness);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    gl_.Uniform4f(gl_.GetUniformLocation(edges_, "region"), static_cast<float>(region.x), static_cast<float>(region.y),
                  static_cast<float>(width), static_cast<float>(height));
    gl_.Uniform2f(gl_.GetUniformLocation(edges_, "stroke"), static_cast<float>(curve.width * fineness / 2.0),
                  static_cast<float>(fineness));
    gl_.Uniform2f(gl_.GetUniformLocation(edges_, "origin"), static_cast<float>(x), static_cast<float>(y));
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * curve.edges), GL_UNSIGNED_INT,
                     offset_of_quad(curve.first_edge));
}

void CurvePainter::composite(const PreparedCurve& curve, const Target& target) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl_.Viewport(0, 0, target.width, target.height);
    gl_.Scissor(curve.part.x, curve.part.y, curve.part.width, curve.part.height);
    gl_.UseProgram(overlay_);
    gl_.BindTexture(GL_TEXTURE_2D, mask_);
    gl_.Uniform1i(gl_.GetUniformLocation(overlay_, "mask"), 0);
    gl_.Uniform1i(gl_.GetUniformLocation(overlay_, "fineness"), curve.fineness);
    gl_.Uniform4f(gl_.GetUniformLocation(overlay_, "shift"), static_cast<float>(curve.part.x),
                  static_cast<float>(curve.part.y), static_cast<float>(curve.x), static_cast<float>(curve.y));
    const ImVec4 ink = ImGui::ColorConvertU32ToFloat4(curve.color);
    gl_.Uniform4f(gl_.GetUniformLocation(overlay_, "ink"), ink.x, ink.y, ink.z, ink.w);
    gl_.Uniform2f(gl_.GetUniformLocation(overlay_, "size"), static_cast<float>(target.width),
                  static_cast<float>(target.height));
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * curve.areas), GL_UNSIGNED_INT,
                     offset_of_quad(curve.first_area));
}

}  // namespace achilles
