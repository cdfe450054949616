// Small pieces that several panels share. Lengths follow the text size, so a scaled interface is the same picture,
// larger.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "panels/panels.hpp"

namespace achilles {

// How plots and words look on the screen, wherever they stand.

constexpr double screen_text_size = 13.0;  // of a plot, at scale 1

// Colours and text of a panel: the rest of the figure is not drawn.
Figure screen_style(const Theme& theme);
// Words broken to a width, pixels.
void paragraph(const std::string& text, float width, const Color& color);

// So many pixels at scale 1.
float units(float pixels);
ImU32 packed(const Color& color, float alpha = 1.0F);
Color text_color();
Color faint_color();
Color error_color();

// The text, or as much of it as fits and an ellipsis.
std::string fitted(const std::string& text, float width);
// A label that begins at a place, as much of it as is `width` wide; of one that is cut a tooltip tells all. The line that is
// written on stays the current one.
void cell(const ImVec2& at, const std::string& text, float width, const Color& color);
// The same of a name and its value: "= 3.2 m" is not cut while there is room for it, the name is.
void cell(const ImVec2& at, const std::string& name, const std::string& value, float width, const Color& color);
// How wide a label is in a cell.
float width_of(const std::string& text);
// A label with dots over its letters, on the current line, `width` wide however long it is.
void label(const std::string& text, float width);
// A quiet heading over a group of widgets; so much at its right end stays free.
void section(const char* title, float free = 0.0F);
// A tooltip for the last item, wrapped; none while a mouse button is down. It covers no line of a panel that it is about.
void tooltip(const std::string& text);
// The same, below or above this part of the surface, none of which it covers.
void tooltip(const std::string& text, const Rectangle& clear);
// Whether a menu or a dialog stands before the panels.
bool is_covered();
// Whether the keys of this frame belong to the current window: no menu or dialog stood before it when they were pressed.
bool is_in_front(const PanelState& state);
// The same of one key: whether it went down for the current window, or with `repeat` is held so long that it does so again.
bool takes_key(const PanelState& state, int code, bool repeat = true);
// Whether Escape was pressed for what asks first, and for nothing in front of it: a menu, a dialog, a text field.
bool take_escape(PanelState& state);
// A line of a menu, with the keys that do the same; true when it is chosen.
bool menu_item(const char* name, PanelState& state, bool ticked = false, bool enabled = true);
// Within a menu: Escape closes it.
void close_by_escape(const PanelState& state);
// What is left to draw on in the current window.
Rectangle remaining();
// Where the last item is, under this name; what can be pressed there can have the keys.
void remember(PanelState& state, const std::string& name);
// Whether a control has the keys, and not the player.
bool has_keys(const PanelState& state);
// Whether it is this one, which then does itself what they say.
bool owns_keys(PanelState& state, const std::string& name);
// Of a frame: before its first control and behind its last.
void begin_focus(PanelState& state);
void use_focus(PanelState& state);
void add_stop(PanelState& state, const std::string& name, const Rectangle& area);
// Writes a path into the field of a dialog.
void use_path(PanelState& state, const std::string& path);
// The instant under the mouse, while the last item is dragged.
bool dragged_to(double low, double high, float left, float width, double& value);
// What is wrong with an input, as the command line says it but without the folder of a file, and how high that is; the colour
// behind it.
void show_message(const std::string& message, float width);
float message_height(const std::string& message, float width);
void paint_error_card(const Rectangle& area);
// The card of a plot on this part of the surface: the row of its head, and what is left for it.
struct PlotCard {
    Rectangle row, inner;
};
PlotCard paint_plot_card(const Rectangle& cell);
// The sign of what opens a menu; x is its left end, y its middle.
void paint_menu_arrow(float x, float y, bool lit);
// A quiet button with such a sign: what it says now opens a menu of that name. Returns where it ends.
float menu_button(const char* popup, const std::string& text, float x, const Rectangle& row, float right,
                  PanelState& state);
// A text field of this width at scale 1, with its name before it; true when Enter was pressed in it.
bool text_row(const char* name, const std::string& id, std::string& text, float width, PanelState& state,
              float name_width = 64.0F);
// Two such fields for the expressions of a plot, y above x, with ids that begin with `id`. `more` ends the tooltip that says what
// an expression is.
bool expression_fields(std::string& x, std::string& y, bool focuses_y, const std::string& id, const std::string& more,
                       PanelState& state);
// Covers with the colour behind it, nearly, what is drawn over time from start to end after the horizon of the run.
void fade_beyond(const Session& session, const Rectangle& area, double start, double end, const Color& behind);
// How far from a marker, in pixels at scale 1, a click is meant for it.
constexpr float marker_reach = 8.0F;
// Of the events that are asked, the one whose sign a hand means: the nearest within reach, but over the sign of a Zeno
// point or a release that one, among whatever many impacts.
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
// A tooltip beside the mouse that says which event this is.
void name_event(const Session& session, int number);
// On the way from the start that there is to this one, as far as a run can start: a hand that pushes a body into the ground
// holds it on the surface.
Vector start_towards(const Session& session, const Vector& q);
// A sentence of the core, which is plain text for terminals, in the field's symbols.
std::string typeset_sentence(std::string text);
// "12.3", with a true minus sign.
std::string number(double value, const char* format = "{:.6g}");
// A number with so many digits, or so many decimals in a column, without those that its error changes (output/precision.hpp).
std::string number(double value, double error, int digits);
std::string number_with_decimals(double value, double error, int decimals);
// "3 m", "30°": a number and a unit that are not torn apart.
std::string number_with_unit(const std::string& number, const std::string& unit);
// A text of numbers with minus signs in place of hyphens.
std::string with_minus(std::string text);
// One of many numbers of this size below or beside one another, with so many decimals; powers of ten where these would show
// nothing of it, or where it would be too long. Without the decimals that its error changes.
std::string number_of_size(double value, double size, int decimals, double error = 0.0);

}  // namespace achilles
