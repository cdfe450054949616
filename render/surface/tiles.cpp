#include "surface/tiles.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace achilles {

namespace {

// Marks a command as tiles. Another renderer would call it, and draw none.
void tiles_mark(const ImDrawList*, const ImDrawCmd*) {}

// Before its cells a picture keeps this in the list, in as many vertices as it takes.
struct Header {
    Rectangle area;
    std::int32_t columns, rows;
};

constexpr std::size_t vertices_for(std::size_t bytes) { return (bytes + sizeof(ImDrawVert) - 1) / sizeof(ImDrawVert); }
constexpr std::size_t header_bytes = vertices_for(sizeof(Header)) * sizeof(ImDrawVert);

static_assert(sizeof(Color) == 4);

const char* tiles_vertex = R"(#version 330 core
uniform vec4 area;   // in pixels: origin, size
uniform vec2 size;   // of the target
out vec2 at;
void main() {
    at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(2.0 * (area.xy + at * area.zw) / size - 1.0, 0.0, 1.0);
})";

const char* tiles_fragment = R"(#version 330 core
in vec2 at;
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
    // No index points at these vertices: what follows counts from behind them.
    list->_CmdHeader.VtxOffset = static_cast<unsigned>(list->VtxBuffer.Size);
    list->_OnChangedVtxOffset();
}

bool are_tiles(const ImDrawCmd& command) { return command.UserCallback == tiles_mark; }

TilesPainter::TilesPainter(const Gl& gl) : gl_(gl) {
    program_ = gl.program(tiles_vertex, tiles_fragment);
    gl.GenVertexArrays(1, &vertices_);
}

TilesPainter::~TilesPainter() {
    gl_.DeleteVertexArrays(1, &vertices_);
    gl_.DeleteProgram(program_);
}

void TilesPainter::draw(const ImDrawList& list, const ImDrawCmd& command, const Target& target) {
    const auto first = static_cast<int>(reinterpret_cast<std::intptr_t>(command.UserCallbackData));
    const char* const bytes = reinterpret_cast<const char*>(&list.VtxBuffer[first]);
    Header header{};
    std::memcpy(&header, bytes, sizeof header);
    const int x = std::max(static_cast<int>(command.ClipRect.x), 0);
    const int y = std::max(static_cast<int>(command.ClipRect.y), 0);
    const int width = std::min(static_cast<int>(command.ClipRect.z), target.width) - x;
    const int height = std::min(static_cast<int>(command.ClipRect.w), target.height) - y;
    if (width <= 0 || height <= 0) return;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl_.Viewport(0, 0, target.width, target.height);
    gl_.Scissor(x, y, width, height);
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
