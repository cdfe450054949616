// Differences between versions of ImGui; no other file checks the version. Everything refers to ImGui's current
// context.
// Keys: 1.86 (Debian 12) takes key numbers of the program and reads an array; 1.87 and later (Debian 13 has 1.90) have
// named keys and take events.
// Fonts: a font has one size until 1.92, which rasterizes letters of any size on demand.
// Text fields: the edited text has 16-bit characters; in 1.92 it has the original bytes.
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

// Call once before the first frame.
void prepare_keys(ImGuiIO& io);
// Sets the keys that are held during the next frame.
void hold_keys(ImGuiIO& io, const std::vector<int>& codes);
// Whether the key was pressed in this frame or, if `repeat`, is held long enough to repeat.
bool is_pressed(int code, bool repeat = true);
// Seconds for which the key has been held, negative if it is not held. A value of -1 hides the key from widgets for the
// moment.
float& time_held(int code);

// Source and destination of copied text. The object must outlive the frames.
struct Clipboard {
    void* owner;
    const char* (*get)(void* owner);
    void (*set)(void* owner, const char* text);
};
void use_clipboard(Clipboard& clipboard);

// Rasterizes all letters of the added fonts; the result belongs to the atlas. In every version they are rasterized into
// one texture before the first frame and stay there, which ImGui does without ImGuiBackendFlags_RendererHasTextures.
// Hence a picture does not depend on what was drawn before it.
struct FontTexture {
    const unsigned char* rgba;
    int width, height;  // pixels
};
FontTexture font_texture(ImFontAtlas& atlas);
// Sets OpenGL's name of the atlas texture; returns the texture name of a command that draws triangles.
void name_font_texture(ImFontAtlas& atlas, unsigned name);
unsigned texture_of(const ImDrawCmd& command);
// Between these calls, drawing uses the texture of the atlas.
void push_font_texture(ImDrawList* list);
void pop_font_texture(ImDrawList* list);

// Size in pixels with which the font was added: the line height; and the part of it above the baseline.
float size_of(const ImFont* font);
float ascent_of(ImFont* font);
// At the font's own size: the glyph of a letter, or that of U+FFFD; and all glyphs.
const ImFontGlyph& glyph_of(ImFont* font, char32_t code);
const ImVector<ImFontGlyph>& glyphs_of(ImFont* font);
// Sets the font of ImGui's text, at the font's own size, until ImGui::PopFont().
void push_font(ImFont* font);

// Lines through the points, and from the last to the first if `closed`; and lines along a rectangle, inside its edges.
// ImGui 1.92.8 has another order of arguments that a compiler cannot distinguish.
void stroke(ImDrawList* list, const std::vector<ImVec2>& points, bool closed, unsigned color, float width);
void stroke_rectangle(ImDrawList* list, const ImVec2& low, const ImVec2& high, unsigned color, float rounding,
                      float width);

// Right end of the content of ImGui's current window, from the left edge of the window.
float content_right();
// ImGui::BeginChild() for a panel without a border, but with the padding of the style.
bool begin_padded_child(const char* name, const ImVec2& size);

// Whether a dialog is in front of the current window. ImGui does not block the mouse in the frame in which the dialog
// opens, and a tooltip in that frame would abort the program.
bool is_behind_dialog();
// For the last item: its ID (0 if it has none), whether it is enabled, and the ID of the window that contains it, or of
// which that window is part. scroll_to_item() scrolls it into view.
unsigned item_id();
bool item_is_enabled();
unsigned window_of_item();
void scroll_to_item();
// Scrolls the next window, whose content is `content_height` pixels high, down by `y` pixels from its first frame on.
void scroll_next_window(float y, float content_height);
// ID of the item that is held or edited, 0 if there is none; and a function that deactivates it.
unsigned active_item();
void let_go_of_item();
// Activates an item in the next frame. A text field then takes the keyboard input.
void press_item(unsigned id, bool takes_letters);
// ID of the front dialog that can be reached; 0 if there is none, or if a menu is in front of it.
unsigned front_dialog();
// ID of the front menu or dialog; 0 if there is none. `unseen_popup` for one that has opened but is not drawn yet.
// popup_of_window(): the one to which the current window belongs; 0 if it belongs to a panel.
constexpr unsigned unseen_popup = ~0U;
unsigned front_popup();
unsigned popup_of_window();
// Enables ImGui's keyboard navigation (arrows, Enter) in open menus. Call once per frame.
void walk_menus_by_keys(bool walk);

// True if the next frame may differ from the last one without input: a new window is not drawn yet, or an item is to be
// pressed.
bool awaits_frame();

// For the active text field: its horizontal scroll in pixels, and the line of its cursor, from 1. `text` is the
// displayed text.
float scrolled_sideways(const ImGuiInputTextState& input);
int line_of_cursor(const ImGuiInputTextState& input, const std::string& text);

}  // namespace achilles
