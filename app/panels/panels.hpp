// The explorer's frame: widgets read the session and return what the user wants. One function builds it, for the window
// and for pictures, so both show the same bytes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "paint/paint.hpp"
#include "session/session.hpp"

namespace achilles {

struct SystemEntry {
    std::string name, title;
};

// The text as the hand types it, until it rests and the text becomes a command; and what is asked about files.
struct EditorState {
    std::string text, known;  // as typed; as the session has it
    int revision = 0;         // counts the texts that came from elsewhere
    double resting = 0.0;     // s since the last letter
    int go_to = 0;            // a line to scroll to; 0: none
    float height = 0.0F;      // of the text on the screen, pixels
    bool is_active = false;   // letters go here

    enum class Asking { nothing, open, save, unsaved, take_away };
    Asking asking = Asking::nothing;
    std::string path;                // typed in a dialog
    bool keeps_path = false;         // what was entered was wrong: more letters go there
    std::optional<Command> waiting;  // to be done once the changes are saved or given up
    bool has_saved = false;          // the command to save has been given, what waits may follow
    bool is_closing = false;         // it is the window that waits to be closed
    bool may_close = false;          // now nothing is lost by it
};

// The menu of one plot: what is typed there.
struct PlotMenu {
    int plot = -1;
    std::string x, y;
};

// A value that is typed in place of its slider.
struct TypedValue {
    std::string id;  // of the slider; empty: none
    std::string text, as_it_was;
    std::string wrong;  // why the text was not taken; empty: it was not entered yet
    bool is_new = false;
    std::pair<std::string, double> before;  // the slider that was pressed last, and its value then
};

// A box that is being drawn in a plot.
struct PlotBox {
    int plot = -1;
    Point from;  // pixels
};

// What belongs to the view and not to the session, so is in no journal.
struct PanelState {
    std::vector<SystemEntry> systems;  // to choose from
    std::vector<SystemEntry> tours;    // journals to replay
    bool on_tour = false;              // one is under way: its caption has buttons
    enum class OnTour { nothing, next, stop } tour_wants = OnTour::nothing;  // a button that was pressed
    int copies = 0;                                                          // the session's, that the clipboard has
    bool in_window = false;    // a window may show how long the run took; a picture must not
    bool show_impacts = true;  // in the event list
    EditorState editor;
    TypedValue typed;
    PlotMenu plot_menu;
    PlotBox box;
    enum class Hand { free, body, arrow, world } hand = Hand::free;  // what it holds in the mechanism
    bool changing = false;                             // a change was made that more commands may go on with
    std::optional<double> pointed_at, pointed_before;  // the instant under the mouse in a plot; in the last frame
    int followed = -1;                                 // the row the event list scrolled to last
    std::map<std::string, Rectangle> places;  // where the last frame put a control ("set g", "play"): tests look here
};

// One frame over the whole surface: call between ImGui::NewFrame() and ImGui::Render().
std::vector<Command> explorer(const Session& session, PanelState& state);

// Its parts, each inside a window of its own that the explorer has begun.
using Commands = std::vector<Command>;
void show_bar(const Session& session, PanelState& state, Commands& commands);
void show_system(const Session& session, PanelState& state, Commands& commands);
void show_controls(const Session& session, PanelState& state, Commands& commands);
void show_editor(const Session& session, PanelState& state, Commands& commands);
// What can be taken away, and the tours: lines of a menu.
void show_take_away_items(const Session& session, PanelState& state, Commands& commands);
void show_tour_items(const Session& session, PanelState& state, Commands& commands);
// Above the mechanism: what a tour says.
float caption_height(const Session& session, const PanelState& state, float width);
void show_caption(const Session& session, PanelState& state, Commands& commands);
void show_dialogs(const Session& session, PanelState& state, Commands& commands);
void show_mechanism(const Session& session, PanelState& state, Commands& commands);
void show_timeline(const Session& session, PanelState& state, Commands& commands);
float timeline_height();
void show_plots(const Session& session, PanelState& state, Commands& commands);
// Above the plots: how many; and the menu behind a plot's title.
void show_grid_bar(const Session& session, PanelState& state, Commands& commands);
void open_plot_menu(const Session& session, std::size_t plot, PanelState& state);
void show_plot_menu(const Session& session, std::size_t plot, PanelState& state, Commands& commands);
void show_events(const Session& session, PanelState& state, Commands& commands);
// What is proved at a Zeno event: the facts, line by line, and every inequality with both sides and the one that
// decided.
std::vector<std::string> certificate_lines(const Event& event);
void show_certificate(const Event& event);
// The cards beside the list, each about the event with this index: its certificate or the Zeno lens; what an impact
// cost and why the bouncing was not cut there; why the contact ended. And how the pinned run and the present one
// differ. The first line of a card; true if the user closes it.
bool show_card_title(const std::string& title, const std::string& more, PanelState& state, float margin = 0.0F);
void show_zeno(const Session& session, std::size_t index, PanelState& state, Commands& commands);
// The Zeno lens takes the place of the plots while a Zeno point is chosen.
bool lens_is_open(const Session& session);
void show_lens(const Session& session, PanelState& state, Commands& commands);
void show_impact(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_release(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_comparison(const Session& session, PanelState& state, Commands& commands);
void show_status(const Session& session, const PanelState& state);

// Letters were typed that are no command yet: frames must go on until they are.
bool is_typing(const PanelState& state);
// What was typed becomes a command now.
void hand_over_text(EditorState& editor, Commands& commands);
// Shows the editor in place of the sliders, or the sliders again.
void toggle_editor(const Session& session, PanelState& state, Commands& commands);
// A command that puts another text in place of the edited one: asks first where that has changes that are not saved.
void request(const Session& session, PanelState& state, const Command& command, Commands& commands);
// Whether the window may be closed at once; otherwise asks first, and then sets may_close.
bool request_close(const Session& session, PanelState& state);
// Begin to ask for a path. Saving asks where the text has no file yet.
void ask_to_open(PanelState& state);
void ask_to_save(const Session& session, PanelState& state);
void ask_to_take_away(const Session& session, PanelState& state, const std::string& ending);
void save_or_ask(const Session& session, PanelState& state, Commands& commands);

}  // namespace achilles
