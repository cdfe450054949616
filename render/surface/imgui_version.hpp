// What ImGui's versions do in other ways, and the only place that asks for the version. Keys: 1.86 (Debian 12) numbers
// them as the program does and looks at an array, 1.87 and later (Debian 13 has 1.90) name them and are told what happens.
// Fonts: a font has one size, until 1.92 makes letters of any size when they are asked for. Text fields: the text that is
// edited is 16-bit characters, in 1.92 the bytes that were given. All of it is about ImGui's current context.
#pragma once

#include <string>
#include <vector>

#include "surface/frame.hpp"

struct ImDrawCmd;
struct ImDrawList;
struct ImFont;
struct ImFontAtlas;
struct ImFontGlyph;
struct ImGuiInputTextState;
struct ImGuiIO;
struct ImVec2;
template <typename T>
struct ImVector;

namespace achilles {

// Once, before the first frame.
void prepare_keys(ImGuiIO& io);
// The keys that are held during the next frame.
void hold_keys(ImGuiIO& io, const std::vector<int>& codes);
// Whether the key went down with this frame or, if `repeat`, is held so long that it does so again.
bool is_pressed(int code, bool repeat = true);
// Seconds for which the key has been held, negative if it is not: a widget sees no key that is set to -1 for a while.
float& time_held(int code);

// Where text is copied to and pasted from. The object outlives the frames.
struct Clipboard {
    void* owner;
    const char* (*get)(void* owner);
    void (*set)(void* owner, const char* text);
};
void use_clipboard(Clipboard& clipboard);

// Draws all letters of the fonts that were added; what is returned belongs to the atlas. In every version they are drawn
// before the first frame and stay where they are in one texture, as ImGui does for a program that does not promise more
// (ImGuiBackendFlags_RendererHasTextures). So pictures do not depend on what was drawn before them.
struct FontTexture {
    const unsigned char* rgba;
    int width, height;  // pixels
};
FontTexture font_texture(ImFontAtlas& atlas);
// The name that OpenGL gave to the atlas's texture, and that of the texture of a command that draws triangles.
void name_font_texture(ImFontAtlas& atlas, unsigned name);
unsigned texture_of(const ImDrawCmd& command);
// What is drawn until pop_font_texture takes its letters from the atlas.
void push_font_texture(ImDrawList* list);
void pop_font_texture(ImDrawList* list);

// The size in pixels that the font was added with: one line's height; and of that what is above the base line.
float size_of(const ImFont* font);
float ascent_of(ImFont* font);
// Of the font at its own size: the letter's glyph, or that of U+FFFD; and all glyphs.
const ImFontGlyph& glyph_of(ImFont* font, char32_t code);
const ImVector<ImFontGlyph>& glyphs_of(ImFont* font);
// ImGui's text is of this font and of its own size until ImGui::PopFont().
void push_font(ImFont* font);

// Lines through the points, from the last to the first too if `closed`; and round a rectangle, inside its edges. ImGui
// 1.92.8 has other orders of arguments that a compiler takes for each other.
void stroke(ImDrawList* list, const std::vector<ImVec2>& points, bool closed, unsigned color, float width);
void stroke_rectangle(ImDrawList* list, const ImVec2& low, const ImVec2& high, unsigned color, float rounding,
                      float width);

// Where the content of ImGui's current window ends on the right, from the window's left edge.
float content_right();
// ImGui::BeginChild for a panel without a border that keeps the style's padding all the same.
bool begin_padded_child(const char* name, const ImVec2& size);

// Whether a dialog stands before the current window. One that has opened in this frame does not keep the mouse from it yet, and
// a tooltip that appears then ends the program.
bool is_behind_dialog();
// Of the last item: its number, 0 where it has none, whether it can be pressed, and the number of the window that it is in,
// or that this is part of. And a scroll that brings it into view.
unsigned item_id();
bool item_is_enabled();
unsigned window_of_item();
void scroll_to_item();
// The window that begins next, whose content is `content_height` pixels high, is scrolled down by `y` pixels from its first
// frame on.
void scroll_next_window(float y, float content_height);
// The item that is held or typed in, 0: none; lets go of it.
unsigned active_item();
void let_go_of_item();
// Presses an item in the next frame; a field for letters has them then.
void press_item(unsigned id, bool takes_letters);
// The dialog in front of everything that can be reached, the number of its window; 0: there is none, or a menu before it.
unsigned front_dialog();
// The menu or dialog in front, the number of its window; 0: there is none. `unseen_popup` for one that has opened and has not
// been drawn yet. And the one that the current window is, or is part of; 0: it is part of a panel.
constexpr unsigned unseen_popup = ~0U;
unsigned front_popup();
unsigned popup_of_window();
// Whether ImGui's own keys walk through what is open: arrows, Enter. Once a frame.
void walk_menus_by_keys(bool walk);

// Of the text field that has the hand: how far it is scrolled sideways, in pixels, and the line of its cursor, from 1.
// `text` is what the field shows.
float scrolled_sideways(const ImGuiInputTextState& input);
int line_of_cursor(const ImGuiInputTextState& input, const std::string& text);

}  // namespace achilles
