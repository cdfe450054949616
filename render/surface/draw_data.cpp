#include "surface/draw_data.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

// The top row of a frame is row 0 of its texture, so that only the copy to a window must be flipped.
const char* triangle_vertex = R"(layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texture_at;
layout(location = 2) in vec4 tint;
uniform vec2 size;
out vec2 at;
out vec4 color;
void main() {
    at = texture_at;
    color = tint;
    gl_Position = vec4(2.0 * position / size - 1.0, 0.0, 1.0);
})";

const char* triangle_fragment = R"(in vec2 at;
in vec4 color;
uniform sampler2D picture;
layout(location = 0) out vec4 result;
void main() { result = color * texture(picture, at); })";

// The two triangles of a rectangle that ImGui fills with one opaque color: its pixels and its color.
struct OpaqueRectangle {
    PixelArea area;
    ImU32 color;
};

// Smaller ones are not worth a call of their own.
constexpr float smallest_filled = 2000.0F;  // pixels

// The triangles from index `at` on, if they are such a rectangle. A pixel is inside if its center is.
std::optional<OpaqueRectangle> opaque_rectangle(const ImDrawList& list, const ImDrawCmd& command, unsigned at) {
    const auto vertex = [&](unsigned i) -> const ImDrawVert& {
        const ImDrawIdx index = list.IdxBuffer[static_cast<int>(command.IdxOffset + at + i)];
        return list.VtxBuffer[static_cast<int>(command.VtxOffset + index)];
    };
    const ImDrawVert &low = vertex(0), &high = vertex(2);
    if (low.col >> IM_COL32_A_SHIFT != 255 ||
        std::abs((high.pos.x - low.pos.x) * (high.pos.y - low.pos.y)) < smallest_filled)
        return {};
    const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
    const ImVec2 corners[] = {low.pos, {high.pos.x, low.pos.y}, high.pos, low.pos, high.pos, {low.pos.x, high.pos.y}};
    for (unsigned i = 0; i < 6; ++i) {
        const ImDrawVert& v = vertex(i);
        if (v.pos.x != corners[i].x || v.pos.y != corners[i].y || v.col != low.col || v.uv.x != white.x ||
            v.uv.y != white.y)
            return {};
    }
    const auto first = [](float edge) { return static_cast<int>(std::ceil(std::clamp(edge, -1e6F, 1e6F) - 0.5F)); };
    const int x = first(std::min(low.pos.x, high.pos.x)), y = first(std::min(low.pos.y, high.pos.y));
    return OpaqueRectangle{
        {x, y, first(std::max(low.pos.x, high.pos.x)) - x, first(std::max(low.pos.y, high.pos.y)) - y}, low.col};
}

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

}  // namespace

Canvas::Canvas(const AddressFunction& address_of, int curve_fineness)
    : gl_(address_of), curves_(gl_, curve_fineness), tiles_(gl_) {
    program_ = gl_.program(triangle_vertex, triangle_fragment);
    gl_.GenBuffers(1, &vertex_buffer_);
    gl_.GenBuffers(1, &index_buffer_);
    gl_.GenVertexArrays(1, &vertices_);
    gl_.BindVertexArray(vertices_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
    for (const GLuint location : {0U, 1U, 2U}) gl_.EnableVertexAttribArray(location);
}

Canvas::~Canvas() {
    gl_.DeleteFramebuffers(1, &target_.framebuffer);
    gl_.DeleteTextures(1, &picture_);
    gl_.DeleteTextures(1, &fonts_);
    gl_.DeleteVertexArrays(1, &vertices_);
    gl_.DeleteBuffers(1, &index_buffer_);
    gl_.DeleteBuffers(1, &vertex_buffer_);
    gl_.DeleteProgram(program_);
}

void Canvas::load_fonts() {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const auto [pixels, width, height] = font_texture(atlas);
    if (std::max(width, height) > largest_texture) throw std::runtime_error("the text is too large for OpenGL");
    gl_.DeleteTextures(1, &fonts_);
    fonts_ = gl_.texture(GL_RGBA8, width, height, GL_RGBA, pixels);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    name_font_texture(atlas, fonts_);
    is_stale_ = true;
}

void Canvas::resize(int width, int height) {
    if (width == target_.width && height == target_.height) return;
    GLint limit = 0;
    gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    limit = std::min(limit, largest_texture);
    if (width < 1 || height < 1 || std::max(width, height) > limit)
        throw std::runtime_error("cannot draw " + std::to_string(width) + " x " + std::to_string(height) +
                                 " pixels; each side must be 1 to " + std::to_string(limit));
    gl_.DeleteFramebuffers(1, &target_.framebuffer);
    gl_.DeleteTextures(1, &picture_);
    picture_ = gl_.texture(GL_RGBA8, width, height, GL_RGBA, nullptr);
    target_ = {gl_.framebuffer(picture_), width, height};
    is_stale_ = true;
}

void Canvas::draw(const ImDrawData& data, const float (&clear)[3]) {
    draw_over(data, clear[0], clear[1], clear[2], 1.0F);
}

void Canvas::draw_over_nothing(const ImDrawData& data) { draw_over(data, 0.0F, 0.0F, 0.0F, 0.0F); }

void Canvas::draw_over(const ImDrawData& data, float red, float green, float blue, float alpha) {
    resize(static_cast<int>(data.DisplaySize.x), static_cast<int>(data.DisplaySize.y));
    const std::array clear{red, green, blue, alpha};
    DrawnFrame frame(data);
    const bool is_new = std::exchange(is_stale_, false) || std::exchange(cleared_, clear) != clear;
    const std::vector<PixelArea> parts = is_new ? std::vector{PixelArea{0, 0, target_.width, target_.height}}
                                                : frame.differences(last_, target_.width, target_.height);
    cleared_ = clear;
    last_ = std::move(frame);
    has_changed_ = !parts.empty();
    if (parts.empty()) return;
    set_state();
    gl_.ClearColor(red, green, blue, alpha);
    for (const PixelArea& part : parts) {
        gl_.Scissor(part.x, part.y, part.width, part.height);
        gl_.Clear(GL_COLOR_BUFFER_BIT);
        drawn_pixels_ += long{part.width} * part.height;
    }
    draw_parts(data, parts);
}

// Draws each command in the parts that it can change.
void Canvas::draw_parts(const ImDrawData& data, const std::vector<PixelArea>& parts) {
    struct DrawnPart {
        const ImDrawList* list;
        const ImDrawCmd* command;
        const PixelArea* part;
    };
    std::vector<DrawnPart> all;
    for (std::size_t i = 0; i < last_.lists().size(); ++i) {
        const ImDrawList* const list = data.CmdLists[i];
        for (int k = 0; k < list->CmdBuffer.Size; ++k)
            for (const PixelArea& part : parts) {
                const PixelArea both = common(last_.lists()[i].commands[static_cast<std::size_t>(k)].area, part);
                if (both.width > 0 && both.height > 0) all.push_back({list, &list->CmdBuffer[k], &part});
            }
    }
    curves_.begin();
    for (const DrawnPart& one : all)
        if (is_curve(*one.command)) curves_.add(*one.list, *one.command, target_, *one.part);
    const ImDrawList* uploaded = nullptr;
    for (const DrawnPart& one : all) {
        if (std::exchange(uploaded, one.list) != one.list) upload(*one.list);
        draw_command(*one.list, *one.command, *one.part);
    }
}

void Canvas::upload(const ImDrawList& list) {
    gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
}

void Canvas::set_state() {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer);
    gl_.Viewport(0, 0, target_.width, target_.height);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Enable(GL_BLEND);
    gl_.BlendEquation(GL_FUNC_ADD);
    gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.UseProgram(program_);
    gl_.Uniform1i(gl_.GetUniformLocation(program_, "picture"), 0);
    gl_.Uniform2f(gl_.GetUniformLocation(program_, "size"), static_cast<float>(target_.width),
                  static_cast<float>(target_.height));
    gl_.BindVertexArray(vertices_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    read_vertices_from(0);
}

// Indices are relative to this vertex. WebGL has no glDrawElementsBaseVertex.
void Canvas::read_vertices_from(unsigned vertex) {
    if (vertex == first_vertex_) return;
    first_vertex_ = vertex;
    constexpr GLsizei stride = sizeof(ImDrawVert);
    const std::size_t start = vertex * sizeof(ImDrawVert);
    gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, offset(start + offsetof(ImDrawVert, pos)));
    gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, offset(start + offsetof(ImDrawVert, uv)));
    gl_.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, offset(start + offsetof(ImDrawVert, col)));
}

// Draws what lies in `part`, which does not change its pixels.
void Canvas::draw_command(const ImDrawList& list, const ImDrawCmd& command, const PixelArea& part) {
    if (is_curve(command)) {
        curves_.draw_next(target_);
        return set_state();
    }
    if (are_tiles(command)) {
        tiles_.draw(list, command, target_, part);
        return set_state();
    }
    if (command.UserCallback == ImDrawCallback_ResetRenderState) return set_state();
    if (command.UserCallback != nullptr) return command.UserCallback(&list, &command);
    const PixelArea seen = common(clip_of(command), part);
    if (seen.width <= 0 || seen.height <= 0 || command.ElemCount == 0) return;
    gl_.BindTexture(GL_TEXTURE_2D, texture_of(command));
    read_vertices_from(command.VtxOffset);
    unsigned begin = 0;
    const auto draw_until = [&](unsigned end) {
        if (end == begin) return;
        gl_.Scissor(seen.x, seen.y, seen.width, seen.height);
        gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(end - begin), GL_UNSIGNED_SHORT,
                         offset((command.IdxOffset + begin) * sizeof(ImDrawIdx)));
        begin = end;
    };
    for (unsigned at = 0; at + 6 <= command.ElemCount; at += 3)
        if (const auto rectangle = opaque_rectangle(list, command, at)) {
            draw_until(at);
            fill(common(rectangle->area, seen), rectangle->color);
            begin = at + 6;
            at += 3;
        }
    draw_until(command.ElemCount);
}

// Clears the area, which is several times as fast as triangles of this color.
void Canvas::fill(const PixelArea& area, unsigned color) {
    if (area.width <= 0 || area.height <= 0) return;
    const ImVec4 ink = ImGui::ColorConvertU32ToFloat4(color);
    gl_.ClearColor(ink.x, ink.y, ink.z, ink.w);
    gl_.Scissor(area.x, area.y, area.width, area.height);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
}

Image Canvas::read(bool transparent) const {
    Image image{target_.width, target_.height, {}, {}};
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (pixels == 0) return image;               // nothing was drawn yet
    std::vector<std::uint8_t> read(4 * pixels);  // WebGL reads all four components or none
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target_.framebuffer);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.ReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    image.rgb.resize(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) std::copy_n(&read[4 * i], 3, &image.rgb[3 * i]);
    if (!transparent) return image;
    image.alpha.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) image.alpha[i] = read[4 * i + 3];
    // On transparency, colors are premultiplied by alpha.
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const int alpha = image.alpha[i / 3];
        if (alpha > 0)
            image.rgb[i] = static_cast<std::uint8_t>(std::min(255, (image.rgb[i] * 255 + alpha / 2) / alpha));
    }
    return image;
}

void Canvas::show() const {
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target_.framebuffer);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.BlitFramebuffer(0, 0, target_.width, target_.height, 0, target_.height, target_.width, 0, GL_COLOR_BUFFER_BIT,
                        GL_NEAREST);
}

}  // namespace achilles
