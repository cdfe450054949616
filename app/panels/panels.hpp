// The explorer's frame: widgets read the session and return what the user wants. One function builds it, for the window
// and for pictures, so both show the same bytes.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "figure/plane.hpp"
#include "paint/paint.hpp"
#include "panels/browser.hpp"
#include "panels/focus.hpp"
#include "session/session.hpp"

namespace achilles {

struct SystemEntry {
    std::string name, title;
    std::string group = {};  // those of one group stand together
};

// The text as the hand types it, until it rests and the text becomes a command; and what is asked about files.
struct EditorState {
    std::string text, known;  // as typed; as the session has it
    std::string document;     // its name
    int revision = 0;         // counts the texts that came from elsewhere
    int shown_revision = -1;  // in the last frame
    double resting = 0.0;     // s since the last letter
    int go_to = 0;            // a line that is to be seen; 0: any
    float scroll = 0.0F;      // of the last frame: how many pixels of the text are above what is seen
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

// A file that a journal or a picture wants, and what the user says to it.
struct FileQuestion {
    std::string asker;           // the journal or the picture
    std::string want;            // "write /home/me/a.toml"
    std::size_t more = 0;        // files that it wants after this one
    std::optional<bool> answer;  // whether it may
};

// Text that an earlier window left unsaved, and what becomes of it.
struct RecoveryQuestion {
    std::string name, when;
    enum class Answer { none, recover, discard, later } answer = Answer::none;
};

// What is taken away, as the dialog has it; the path is the editor's.
struct TakeAwayForm {
    int plot = 0;  // from 1; 0: all of them
    enum class What { plots, mechanism, film } what = What::plots;
    std::string ending = "svg";                                  // of the file, also where its path has none yet
    bool on_paper = false;                                       // measured in mm; else 1200 x 800 pixels
    double width = 85.0, height = 0.0, font = 8.0, dpi = 300.0;  // mm, pt; a height of 0: what fits the plots
    double fps = 30.0, speed = 0.0;                              // of a film; a speed of 0: the player's
    int pixels = 1280;                                           // its width
    bool dark = false;
};

// A film that is being drawn beside the window, and what the user wants of it.
struct FilmProgress {
    std::string film, line;
    double share = 0.0;
    bool is_given_up = false;
};

// The menu of one plot: what is typed there.
struct PlotMenu {
    int plot = -1;
    std::string x, y;
    bool was_entered = false;  // what was typed is being plotted: if that is refused the menu stays
    bool is_wrong = false;     // it was refused
};

// The command palette: the line as it is typed, and what became of it.
struct PaletteState {
    std::string text;
    int chosen = 0;          // a row of the list, from 0
    int revision = 0;        // counts the lines that are not typed
    bool focuses = false;    // the line is to have the hand,
    bool to_end = false;     // with the cursor behind it
    bool completes = false;  // Tab was pressed
    bool has_run = false;    // the line was given as a command; if that is refused the palette stays
    std::string wrong;       // why it was refused
};

// A value that is typed in place of its slider.
struct TypedValue {
    std::string id;  // of the slider; empty: none
    std::string text, as_it_was;
    std::string wrong;  // why the text was not taken; empty: it was not entered yet
    bool is_new = false;
};

// A press of a slider is a drag, a click that moves it there, or half of a double click, which types: until this is
// known nothing moves.
struct PressedSlider {
    std::string id;                         // that is pressed, or was last; empty: none
    double since = 0.0;                     // s, of ImGui's clock
    double target = 0.0;                    // where it was pressed, as a value
    bool is_drag = false;                   // it is one
    double share = 0.0;                     // of the track, where the hand is
    bool is_fine = false;                   // Shift is held: the hand has twenty times as far to go,
    bool is_relative = false;               // and since it was, goes on from where it came to
    double from_x = 0.0, from_share = 0.0;  // there: pixels, of the track
    std::string clicked;  // the slider that was clicked: its value is to be clicked_target when no second click comes
    double clicked_since = 0.0, clicked_target = 0.0;
};

// A box that is being drawn in a plot.
struct PlotBox {
    int plot = -1;
    Point from;  // pixels
};

// What a hand holds in the mechanism. Until it lets go the picture stands still: a camera or an arrow's scale that
// follows the run would take the thing out of the hand.
struct HeldMechanism {
    enum class What { nothing, body, arrow, world } what = What::nothing;
    bool has_moved = false;                 // since then the start is shown, which the hand changes
    std::size_t grip = 0;                   // which body, of Mechanism::grips()
    Point offset;                           // from the hand to what it holds, pixels
    Placement placement;                    // of the picture
    double fastest = 0.0, strongest = 0.0;  // what the arrows are measured by
};

// The configuration plane, and the picture until another run takes its place.
struct PlaneView {
    bool is_held = false;  // the start, by the hand
    Point offset;          // from the hand to it, pixels
    PlaneTexts texts;
    std::shared_ptr<const Plane> plane;  // of these
    std::shared_ptr<const Model> model;  // of that
    std::shared_ptr<const Panel> panel;
    std::optional<Run> run;  // of that
    double end = 0.0;
    std::optional<double> horizon;
    bool dark = false;
    Framing framing, framed;  // as it is to be; as it was made
    std::vector<Point> event_places;
    std::vector<ImpactArrow> arrows;
    Point arrows_in;  // a plot so wide and high, pixels
    Plane::Surfaces surfaces;
    std::vector<Plane::Level> levels;
    std::vector<double> surfaces_key, levels_key;  // what these depend on; empty: nothing is known yet
    // In its menu.
    std::string x, y;          // as they are typed
    bool was_entered = false;  // what was typed is being shown: if that is refused the menu stays
    bool is_wrong = false;     // it was refused
};

// The limits of an axis of the sweep, as they are typed.
struct SweepMenu {
    SweepAxis of;  // the axis that they are of
    std::string low, high, wrong;
};

// The sweep's picture until other runs are there, and what was asked about it last.
struct SweepState {
    std::shared_ptr<const SweepData> of;
    std::shared_ptr<const Panel> panel;
    bool dark = false;
    std::string problem;  // why it has no picture
    std::array<SweepMenu, 2> menus;
    std::string print, zero;  // as they are typed
    std::optional<Run> measured_run;
    std::vector<std::string> measured;  // the prints
    std::optional<double> measure;      // of that run
    const SweepData* told_of = nullptr;
    std::uint64_t told_point = 0;
    std::string told;
};

// Where a hand has moved the strip of results.
struct ResultStrip {
    std::optional<std::size_t> begin;  // the first result that is shown; nothing: as the time has it
    std::size_t seen = 0, count = 0;   // until another event is to be seen, or another run: its event; how many results
    bool is_held = false, was_dragged = false;
    float dragged = 0.0F;  // since it moved last, pixels
};

class EquationsView;
class EnergyCourse;
struct OrbitView;
class Thumbnails;

// What belongs to the view and not to the session, so is in no journal.
struct PanelState {
    std::vector<SystemEntry> systems;                                  // to choose from
    std::vector<std::string> recent;                                   // paths of files, the last first
    std::vector<SystemEntry> tours;                                    // journals to replay
    std::vector<SystemEntry> manual;                                   // its pages
    std::function<std::string(const std::string& topic)> manual_page;  // the text of one
    std::string manual_text;                                           // of the one that was chosen
    bool opens_manual = false;
    bool on_tour = false;                           // one is under way: its caption has buttons
    std::size_t tour_said = 0, tour_sentences = 0;  // of it: the how manieth sentence is said, and how many there are
    enum class OnTour { nothing, back, next, stop } tour_wants = OnTour::nothing;  // a button that was pressed
    int copies = 0;                    // the session's, that the clipboard has
    double width = 0.0, height = 0.0;  // of the surface, pixels: as the last frame found it
    bool reads_folders = true;         // a picture shows no folder of anybody's
    bool in_window = false;            // a window may show how long the run took; a picture must not
    bool show_impacts = false;         // in the event list: each, not folded into one line
    std::set<std::size_t> unfolded;    // of folded impacts those that are listed all the same, by the first of them
    EditorState editor;
    BrowserState browser;
    bool browser_has_field = false;  // letters go to its path
    TakeAwayForm take_away;
    std::optional<FilmProgress> film;
    std::shared_ptr<Thumbnails> thumbnails;  // of the gallery; null: it has none
    Focus focus;
    std::optional<FileQuestion> file_question;  // asked until it is answered
    std::optional<RecoveryQuestion> recovery_question;
    TypedValue typed;
    PressedSlider pressed;
    PlotMenu plot_menu;
    PaletteState palette;
    PlotBox box;
    HeldMechanism held;
    PlaneView plane;
    SweepState sweep;
    std::string depend;  // a quantity, as it is typed
    std::shared_ptr<OrbitView> orbit;
    ResultStrip strip;
    bool on_marker = false;  // the timeline was pressed where an event is marked, and not dragged since
    bool escape = false;     // Escape was pressed, and nothing in front of the panels has it
    bool changing = false;   // a change was made that more commands may go on with
    std::optional<double> pointed_at, pointed_before;  // the instant under the mouse in a plot; in the last frame
    std::shared_ptr<EquationsView> equations;          // once they were shown
    std::shared_ptr<EnergyCourse> energy;              // of the run that is shown, while its energy is
    // A name that the mouse is over: in the equations, in this frame and in the last; in the controls, on its slider.
    std::string lights, lit, pointed_slider;
    int followed = -1;                        // the row the event list scrolled to last
    std::map<std::string, Rectangle> places;  // where the last frame put a control ("set g", "play"): tests look here
};

// One frame over the whole surface: call between ImGui::NewFrame() and ImGui::Render().
std::vector<Command> explorer(const Session& session, PanelState& state);

// Its parts, each inside a window of its own that the explorer has begun.
using Commands = std::vector<Command>;
// The keys that change what is seen, whatever has the bar.
void use_view_keys(const Session& session, PanelState& state, Commands& commands);
void show_bar(const Session& session, PanelState& state, Commands& commands);
void show_system(const Session& session, PanelState& state, Commands& commands);
void show_controls(const Session& session, PanelState& state, Commands& commands);
// What the run has otherwise than the system's file or text (`of`), at most so many lines, in the order of the controls; a click
// puts it back. Nothing where nothing differs.
void show_changes(const Session& session, const std::string& of, std::size_t lines, PanelState& state,
                  Commands& commands);
void show_editor(const Session& session, PanelState& state, Commands& commands);
// What can be taken away, and the tours: lines of a menu.
void show_take_away_items(const Session& session, PanelState& state, Commands& commands);
void show_tour_items(const Session& session, PanelState& state, Commands& commands);
// The pages of the manual as lines of a menu, and the one that was chosen, above everything else.
void show_help_items(PanelState& state, Commands& commands);
// Keys and words on a card (F1), while the scene shows it.
void show_help(const Session& session, PanelState& state, Commands& commands);
void show_manual(PanelState& state);
// Any command by a few of its letters (Ctrl+Shift+P), while the scene shows the palette.
void show_palette(const Session& session, PanelState& state, Commands& commands);
// Above the mechanism: what a tour says.
float caption_height(const Session& session, const PanelState& state, float width);
void show_caption(const Session& session, PanelState& state, Commands& commands);
void show_dialogs(const Session& session, PanelState& state, Commands& commands);
// The field for a path, with the keys of a shell; true where Enter was pressed in it. Below it the folder: whether what was
// entered or clicked went there, and whether it is a file that is meant.
bool path_line(PanelState& state, bool focuses);
struct Browsed {
    bool has_taken = false, is_chosen = false;
};
Browsed browse(PanelState& state, const std::vector<std::string>& endings, bool entered);
// What is taken away and how large, above the path; below it what will be written. While the scene shows "export", too.
void show_take_away_form(const Session& session, PanelState& state);
struct TakeAwayNote {
    std::string text;
    bool is_wrong = false;  // nothing can be written so
};
TakeAwayNote take_away_note(const Session& session, const TakeAwayForm& form);
command::Export take_away_command(const TakeAwayForm& form, const std::string& file, bool overwrite);
// The file that is written: the path, with the form's ending where it has none.
std::string take_away_file(const TakeAwayForm& form, const std::string& path);
// A film on its way.
void show_film(PanelState& state);
// The systems in pictures (Ctrl+G), above everything else, while the scene shows "gallery".
void show_gallery(const Session& session, PanelState& state, Commands& commands);
void show_mechanism(const Session& session, PanelState& state, Commands& commands);
// Under the mechanism: every Zeno point and release, with what is proved of its time.
void show_results(const Session& session, PanelState& state, Commands& commands);
float results_height(const Session& session);
// Under them: where the energy is and where it went, now and, where there is room, over the run.
void show_energy(const Session& session, PanelState& state, Commands& commands);
float energy_height(bool with_course);
// At the top of the mechanism's panel: the state in numbers, and how high that is in a panel so wide.
void show_state(const Session& session, const Rectangle& panel);
float state_height(const Session& session, float panel_width);
// "2.7251422 ± 7.4e-7": the time of a Zeno point, and how far that of the exact motion from the computed state at the cut can be
// from it, or the measure of the integration's error where that is larger; without a proof the time alone.
std::string time_text(const Trajectory& trajectory, std::size_t event, double error = 0.0);
// What that stands for.
std::string precision_text();
// "proved: t in [LOW, HIGH]" behind this; empty where there is no proof of the event.
std::string proved_text(const Session& session, std::size_t event, const std::string& before = "");
// In place of the mechanism, of any system: two quantities, where the gap is open, the run, and its start to drag. With one
// coordinate its phase plane.
bool has_contours(const PlaneView& plane);
void show_plane(const Session& session, const Rectangle& area, PanelState& state, Commands& commands);
void show_timeline(const Session& session, PanelState& state, Commands& commands);
float timeline_height();
void show_plots(const Session& session, PanelState& state, Commands& commands);
// Above the plots: how many; and the menu behind a plot's title.
void show_grid_bar(const Session& session, PanelState& state, Commands& commands);
void open_plot_menu(const Session& session, std::size_t plot, PanelState& state);
void show_plot_menu(const Session& session, std::size_t plot, PanelState& state, Commands& commands);
// Many runs beside the present one.
void show_sweep(const Session& session, PanelState& state, Commands& commands);
void show_events(const Session& session, PanelState& state, Commands& commands);
// In the same place: the equations of motion, each contact's, and the Zeno conditions with their present values.
void show_equations(const Session& session, PanelState& state, Commands& commands);
// In the same place: what a quantity of the run depends on.
void show_dependence(const Session& session, PanelState& state, Commands& commands);
// In the same place: the periodic run near the present one, and its branch.
void show_orbit(const Session& session, PanelState& state, Commands& commands);
// Which of these.
void show_lower_tabs(const Session& session, PanelState& state, Commands& commands);
// Frames must go on until they are there.
bool derives_equations(const PanelState& state);
// What is proved at a Zeno event: the facts, line by line, and every inequality with both sides and the one that
// decided.
std::vector<std::string> certificate_lines(const Event& event);
void show_certificate(const Event& event);
// The cards beside the list, each about the event with this index: its certificate or the Zeno lens; what an impact
// cost and why the bouncing was not cut there; why the contact ended. And how the pinned runs and the present one
// differ, and how wide that wants to be. The first line of a card; true if the user closes it.
bool show_card_title(const std::string& title, const std::string& more, PanelState& state, float margin = 0.0F);
void show_zeno(const Session& session, std::size_t index, PanelState& state, Commands& commands);
// The Zeno lens takes the place of the plots while a Zeno point is chosen.
bool lens_is_open(const Session& session);
void show_lens(const Session& session, PanelState& state, Commands& commands);
void show_impact(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_release(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_comparison(const Session& session, PanelState& state, Commands& commands);
float comparison_width(const Session& session);
// Under the sliders: the runs that are pinned, where there are any.
void show_runs(const Session& session, PanelState& state, Commands& commands);
// Where that panel is not seen: their names in the head of a plot, up to `right`. Returns where they begin.
float name_runs(const Session& session, const Rectangle& row, float right);
void show_status(const Session& session, const PanelState& state);
// "about 12 s left" of a run that has come so far, from 0 to 1, in so many seconds; empty: too early to tell.
std::string time_left(double seconds, double share);

// Letters were typed that are no command yet: frames must go on until they are.
bool is_typing(const PanelState& state);
// The same of a click that may still become a double click.
bool waits_for_click(const PanelState& state);
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
// `ending`: "svg", as ending_of() has it.
void ask_to_take_away(const Session& session, PanelState& state, const std::string& ending, int plot = 0);
void save_or_ask(const Session& session, PanelState& state, Commands& commands);

}  // namespace achilles
