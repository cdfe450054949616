// Small widgets shared by the panels. Lengths scale with the text size, so that a scaled interface looks the same, only
// larger.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "panels/panels.hpp"
#include "session/number_text.hpp"

namespace achilles {

// Appearance of plots and text on the screen.

constexpr double screen_text_size = 13.0;  // of a plot, at scale 1

// Colors and text size of a panel; other parts of the figure are not drawn.
Figure screen_style(const Theme& theme);
// Text wrapped to a width in pixels.
void paragraph(const std::string& text, float width, const Color& color);

// Converts a length in pixels at scale 1 to pixels.
float units(float pixels);
ImU32 packed(const Color& color, float alpha = 1.0F);
Color text_color();
Color faint_color();
Color error_color();

// The text, shortened with an ellipsis if necessary.
std::string fitted(const std::string& text, float width);
// A label at a position, shortened to `width`; a tooltip shows the full text. Does not move the cursor.
void cell(const ImVec2& at, const std::string& text, float width, const Color& color);
// The same for a name and its value, such as "= 3.2 m". The name is shortened before the value.
void cell(const ImVec2& at, const std::string& name, const std::string& value, float width, const Color& color);
// Width of a label in a cell.
float width_of(const std::string& text);
// A table whose columns have these widths (pixels), without padding; its rows are as high as the lines of a text.
class LineTable {
 public:
    LineTable(const char* name, const std::vector<float>& widths);
    ~LineTable();
    LineTable(const LineTable&) = delete;
    LineTable& operator=(const LineTable&) = delete;
    void next_row() const;
    // A label in the next column, shortened to it, with room for a sign of this width before it. Returns where they
    // begin.
    ImVec2 put(const std::string& text, const Color& color, float sign = 0.0F) const;

 private:
    bool is_open_;
};
// A label with dots over its letters, on the current line, always `width` wide.
void label(const std::string& text, float width);
// A faint heading over a group of widgets, leaving `free` pixels at its right end.
void section(const char* title, float free = 0.0F);
// Tooltip for the last item, wrapped; not while a mouse button is down. In a menu it is placed beside the menu.
void tooltip(const std::string& text);
// The same, placed below or above `clear` without covering it.
void tooltip(const std::string& text, const Rectangle& clear, bool prefers_above = false);
// The same after a second, beside the window: for a slider, whose neighbors stay visible. `id` names the row.
void slow_tooltip(const std::string& id, const std::string& text, PanelState& state);
// True if a menu or a dialog is in front of the panels.
bool is_covered();
// True if the keys of this frame belong to the current window: no menu or dialog was in front of it when they were
// pressed.
bool is_in_front(const PanelState& state);
// The same for one key: true if it was pressed for the current window or, with `repeat`, repeats.
bool takes_key(const PanelState& state, int code, bool repeat = true);
// True if Escape was pressed and no menu, dialog or text field in front used it. Only the first caller gets it.
bool take_escape(PanelState& state);
// In a menu: closes it on Escape.
void close_by_escape(const PanelState& state);
// The remaining area of the current window.
Rectangle remaining();
// Registers the area of the last item under a name. Items that can be pressed become focusable.
void remember(PanelState& state, const std::string& name);
// True if a control, not the player, has the keys.
bool has_keys(const PanelState& state);
// True if the control of this name has the focus; it then handles the keys itself.
bool owns_keys(PanelState& state, const std::string& name);
// Call these before the first control of a frame and after its last.
void begin_focus(PanelState& state);
void use_focus(PanelState& state);
void add_stop(PanelState& state, const std::string& name, const Rectangle& area);
// Writes a path into the field of a dialog.
void use_path(PanelState& state, const std::string& path);
// Maps the mouse to a value in [low, high] along `width` pixels from `left`, while the last item is dragged.
bool dragged_to(double low, double high, float left, float width, double& value);
// The text of an input error as on the command line, but without the file's folder; its height; and its background.
void show_message(const std::string& message, float width);
float message_height(const std::string& message, float width);
void paint_error_card(const Rectangle& area);
// The background of a plot: its title row and its inner area.
struct PlotCard {
    Rectangle row, inner;
};
PlotCard paint_plot_card(const Rectangle& cell);
// The arrow of a button that opens a menu; x is its left end, y its middle.
void paint_menu_arrow(float x, float y, bool lit);
// A flat button with such an arrow, which opens the menu `popup`. Returns its right end.
float menu_button(const char* popup, const std::string& text, float x, const Rectangle& row, float right,
                  PanelState& state);
// A text field of this width at scale 1, with its name before it; true if Enter was pressed in it.
bool text_row(const char* name, const std::string& id, std::string& text, float width, PanelState& state,
              float name_width = 64.0F);
// Two text fields for the expressions of a plot, y above x, with ids that begin with `id`. `more` is appended to the
// tooltip that explains expressions.
bool expression_fields(std::string& x, std::string& y, bool focuses_y, const std::string& id, const std::string& more,
                       PanelState& state);
// Moves the time by hand. An event selected elsewhere is let go, except in the Zeno lens, which stays at its point.
void move_time(const Session& session, double time, Commands& commands);
// A triangle, or two bars while something plays.
void paint_play_sign(const ImVec2& center, bool is_playing);
// Fades the part of a time plot from `start` to `end` that lies after the horizon of the run.
void fade_beyond(const Session& session, const Rectangle& area, double start, double end, const Color& behind);
// Click tolerance of an event marker, pixels at scale 1.
constexpr float marker_reach = 8.0F;
// Finds the event marker nearest to the mouse within reach. Directly on the marker of a Zeno point or release, that one
// takes precedence over any number of impacts.
class NearestEvent {
 public:
    NearestEvent(const ImVec2& mouse, double reach) : mouse_(mouse), reach_(reach) {}
    void ask(int number, const Event& event, double x, double y);
    std::optional<int> found() const { return found_; }

 private:
    ImVec2 mouse_;
    double reach_, least_ = 0.0;
    std::optional<int> found_;
};
// A tooltip beside the mouse that names the event.
void name_event(const Session& session, int number);

}  // namespace achilles
