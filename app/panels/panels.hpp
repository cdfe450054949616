// The explorer's frame: widgets read the session and return the user's commands. The window and the off-screen picture
// call the same function, so both show the same.
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
#include "session/results_text.hpp"
#include "session/sweep_text.hpp"

namespace achilles {

struct SystemEntry {
    std::string name, title;
    std::string group = {};  // entries of one group are listed together
};

// The text being typed, until a pause makes it a command; and the file dialogs.
struct EditorState {
    std::string text, known;  // as typed; as in the session
    std::string document;     // name of the document
    int revision = 0;         // counts texts that were not typed
    int shown_revision = -1;  // in the last frame
    double resting = 0.0;     // s since the last keystroke
    int go_to = 0;            // line to scroll to; 0: none
    float scroll = 0.0F;      // scroll position in the last frame, pixels
    float height = 0.0F;      // visible height of the text, pixels
    bool is_active = false;   // it has the keyboard
    bool takes_keys = false;  // give it the keyboard as soon as it is seen

    enum class OpenDialog { nothing, open, save, unsaved, export_run };
    OpenDialog asking = OpenDialog::nothing;
    std::string path;                // path typed in a dialog
    bool keeps_path = false;         // the path entered was wrong: the field keeps the keyboard
    std::optional<Command> waiting;  // command to perform after the changes are saved or discarded
    bool has_saved = false;          // the save command was issued; `waiting` follows if it succeeds
    bool is_closing = false;         // the window waits to be closed
    bool may_close = false;          // it can be closed without loss
};

// A file that a journal or a picture requests, and the user's answer.
struct FileQuestion {
    std::string asker;           // the journal or the picture
    std::string request;         // "write /home/me/a.toml"
    std::size_t more = 0;        // number of further files that it requests
    std::optional<bool> answer;  // whether access is allowed
};

// Text left unsaved by an earlier window, and the user's answer.
struct RecoveryQuestion {
    std::string name, when;
    enum class RecoveryChoice { none, recover, discard, later } answer = RecoveryChoice::none;
};

// Contents of the export dialog; the path is in EditorState.
struct ExportForm {
    int plot = 0;  // from 1; 0: all plots
    enum class ExportSubject { plots, mechanism, film } what = ExportSubject::plots;
    std::string ending = "svg";  // file extension, used if the path has none
    bool on_paper = false;       // size in mm; else 1200 x 800 pixels
    // Width and height in mm, font in pt, resolution in pixels per inch. Height 0: fits the plots.
    double width = 85.0, height = 0.0, font = 8.0, dpi = 300.0;
    double fps = 30.0, speed = 0.0;  // of an animation; speed 0: the playback speed
    int pixels = 1280;               // width of an animation
    bool dark = false;
};

// Progress of an animation being drawn, and the user's wish to cancel it.
struct FilmProgress {
    std::string film, line;
    double share = 0.0;
    bool is_given_up = false;
};

// The choices and axes of the plots so far, newest last, and which of them is shown.
struct ViewHistory {
    std::vector<Plots> views;
    std::size_t at = 0;
    double changed = -1e9;  // s, ImGui time of the last change; changes that follow soon belong to it
};

// The menu of one plot with the expressions being typed.
struct PlotMenu {
    int plot = -1;
    std::string x, y;
    bool was_entered = false;  // the expressions were submitted: if they are refused, the menu stays open
    bool is_wrong = false;     // they were refused
};

// The command palette: the line being typed and its result.
struct PaletteState {
    std::string text;
    int chosen = 0;          // row of the list, from 0
    int revision = 0;        // counts lines that were not typed
    bool focuses = false;    // give the line the keyboard
    bool to_end = false;     // and put the cursor at its end
    bool completes = false;  // Tab was pressed
    bool has_run = false;    // the line was submitted: if it is refused, the palette stays open
    std::string wrong;       // why it was refused
};

// A value being typed in place of its slider.
struct TypedValue {
    std::string id;  // of the slider; empty: none
    std::string text, previous;
    std::string wrong;  // why the text was refused; empty: not submitted yet
    bool is_new = false;
};

// A press on a slider can start a drag, be a click that moves the slider, or be half of a double click, which opens the
// text field. Nothing moves until this is decided.
struct PressedSlider {
    std::string id;                         // the slider that is or was pressed; empty: none
    double since = 0.0;                     // s, ImGui time
    double target = 0.0;                    // value at the press position
    bool is_drag = false;                   // it is one
    double share = 0.0;                     // mouse position as a share of the track
    bool is_fine = false;                   // Shift is down: the mouse moves the value 20 times more slowly
    bool is_relative = false;               // Shift was used in this drag: motion is relative to the point below
    double from_x = 0.0, from_share = 0.0;  // that point: mouse in pixels, value as a share of the track
    // The slider that was clicked. It gets the value clicked_target unless a second click follows.
    std::string clicked;
    double clicked_since = 0.0, clicked_target = 0.0;
};

// A slider under the mouse, whose tooltip appears after a while.
struct PointedControl {
    std::string id;
    double since = 0.0;     // s, ImGui time
    int frame = -1;         // the last frame with the mouse there
    bool is_early = false;  // in that frame its tooltip was not shown yet
};

// A zoom box being drawn in a plot.
struct PlotBox {
    int plot = -1;
    Point from;      // pixels
    int button = 1;  // the mouse button that draws it
};

// A click in a plot, which waits until it cannot become a double click.
struct PlotClick {
    int plot = 0;                    // from 1; 0: none
    int event = 0;                   // the event under it, from 1; 0: the time
    double time = 0.0, since = 0.0;  // s: of the run; ImGui time
};

// Mouse drag in the mechanism view. While it lasts, the camera and the arrow scale are frozen so that the target does
// not move under the mouse.
struct MechanismDrag {
    enum class DragTarget { none, body, arrow, background } what = DragTarget::none;
    bool has_moved = false;                 // from then on the start is shown, which the drag changes
    std::size_t grip = 0;                   // which body, index into Mechanism::grips()
    std::optional<MaterialPoint> material;  // in place of it: a point between its ends, or in a box
    Point offset;                           // from the mouse to the target, pixels
    Placement placement;                    // frozen placement of the picture
    double fastest = 0.0, strongest = 0.0;  // frozen reference values of the arrow scale
    std::optional<ViewAngles> direction{};  // of a system in space, when the drag began
};

// The configuration plane, and its picture for the run that is shown.
struct PlaneView {
    bool is_held = false;  // the start is being dragged
    Point offset;          // from the mouse to the start, pixels
    PlaneTexts texts;
    std::shared_ptr<const Plane> plane;  // made from `texts`
    std::shared_ptr<const Model> model;  // model of `plane`
    std::shared_ptr<const Panel> panel;
    std::optional<Run> run;  // run of `panel`
    double end = 0.0;
    std::optional<double> horizon;
    bool dark = false;
    Framing framing, framed;  // requested axes; axes of `panel`
    std::vector<Point> event_places;
    std::vector<ImpactArrow> arrows;
    Point arrows_in;  // size of the plot for which `arrows` were computed, pixels
    Plane::Surfaces surfaces;
    std::vector<Plane::Level> levels;
    std::vector<double> surfaces_key, levels_key;  // inputs of `surfaces` and `levels`; empty: not computed
    // Its menu.
    std::string x, y;          // expressions being typed
    bool was_entered = false;  // they were submitted: if they are refused, the menu stays open
    bool is_wrong = false;     // they were refused
};

// The limits of a sweep axis being typed.
struct SweepMenu {
    SweepAxis of;  // the axis they belong to
    std::string low, high, wrong;
};

// The picture of the sweep, and cached queries about it.
struct SweepState {
    std::shared_ptr<const SweepData> of;
    std::shared_ptr<const Panel> panel;
    bool dark = false;
    std::string problem;  // why there is no picture
    std::array<SweepMenu, 2> menus;
    std::string print, zero;  // expressions being typed
    std::optional<Run> measured_run;
    std::vector<std::string> measured;  // the printed quantities
    std::optional<double> measure;      // the first of them for `measured_run`
    const SweepData* described_data = nullptr;
    std::uint64_t described_point = 0;
    std::string tooltip;
};

// Scroll position of the strip of results after the user moved it.
struct ResultStrip {
    std::optional<std::size_t> begin;  // first result shown; empty: follows the time
    // Target event and number of results when it was moved; the position is reset when they change.
    std::size_t seen = 0, count = 0;
    bool is_held = false, was_dragged = false;
    float dragged = 0.0F;  // drag distance since the last step, pixels
};

class EquationsView;
class EnergyCourse;
struct OrbitView;
class Thumbnails;

// View state that is not part of the session and thus not in a journal.
struct PanelState {
    std::vector<SystemEntry> systems;                                  // for the lists
    std::vector<std::string> recent;                                   // recently opened files, newest first
    std::vector<SystemEntry> tours;                                    // journals to replay
    std::vector<SystemEntry> manual;                                   // pages of the manual
    std::function<std::string(const std::string& topic)> manual_page;  // returns the text of a page
    std::string manual_text;                                           // text of the selected page
    bool opens_manual = false;
    bool on_tour = false;                                    // a tour is running: its caption has buttons
    std::size_t tour_captions_shown = 0, tour_captions = 0;  // number of captions shown so far, and in total
    enum class TourAction { none, back, next, stop } tour_action = TourAction::none;  // button pressed
    int copies = 0;                       // Session::copies() at the last copy to the clipboard
    double width = 0.0, height = 0.0;     // surface in the last frame, pixels
    std::string front;                    // the panel in front, if the panels are tabs; else empty
    bool is_alone = false;                // no panel has room beside the mechanism
    bool reads_folders = true;            // false in a picture, which must not show private folders
    bool on_page = false;                 // in a browser: files are chosen and downloaded there
    std::function<void()> choose_file{};  // on a page: asks for a file, which is then dropped on it
    bool in_window = false;               // a window may show computing times; a picture must not
    bool show_impacts = false;            // event list without folding of impacts
    std::set<std::size_t> unfolded;       // unfolded rows, by their first impact
    EditorState editor;
    BrowserState browser;
    bool browser_has_field = false;  // the path field has the keyboard
    ExportForm export_form;
    std::optional<FilmProgress> film;
    std::shared_ptr<Thumbnails> thumbnails;  // for the gallery; null: none
    Focus focus;
    std::optional<FileQuestion> file_question;  // shown until it is answered
    std::optional<RecoveryQuestion> recovery_question;
    TypedValue typed;
    PressedSlider pressed;
    PointedControl pointed;
    PlotMenu plot_menu;
    ViewHistory views;
    PaletteState palette;
    PlotBox box;
    PlotClick plot_click;
    MechanismDrag held;
    PlaneView plane;
    SweepState sweep;
    std::string depend;  // the quantity being typed
    std::shared_ptr<OrbitView> orbit;
    ResultStrip strip;
    bool on_marker = false;  // the timeline was pressed on an event marker and not dragged since
    bool escape = false;     // Escape was pressed and not used by anything in front of the panels
    bool changing = false;   // the last change may be continued by further commands
    std::optional<double> pointed_at, pointed_before;  // time under the mouse in a plot, in this and in the last frame
    std::shared_ptr<EquationsView> equations;          // null until first shown
    std::shared_ptr<EnergyCourse> energy;              // for the run that is shown, while the energy is visible
    // Name under the mouse: in the equations (this frame, last frame), and on a slider.
    std::string lights, lit, pointed_slider;
    int followed = -1;  // row that the event list scrolled to last
    // Areas of the controls ("set g", "play") in the last frame, used by tests.
    std::map<std::string, Rectangle> places;
};

// Builds one frame over the whole surface. Call it between ImGui::NewFrame() and ImGui::Render().
std::vector<Command> explorer(const Session& session, PanelState& state);

// Parts of the frame. Each draws into a window already begun by explorer().
void show_bar(const Session& session, PanelState& state, Commands& commands);
void show_system(const Session& session, PanelState& state, Commands& commands);
void show_controls(const Session& session, PanelState& state, Commands& commands);
// The slider of a parameter, or of an initial coordinate or rate.
void show_value_slider(const Session& session, const std::string& name, PanelState& state, Commands& commands);
// The lecture (F11): the title of the system, and up to three sliders with a button that animates each.
float lecture_title_height();
void show_lecture_title(const Session& session);
std::vector<std::string> lecture_sliders(const Session& session);
void show_lecture_sliders(const Session& session, PanelState& state, Commands& commands);
// Lists the differences of the run from the system's file or text (`of`), at most `lines` lines, in the order of the
// controls; a click restores the original value. Draws nothing without differences.
void show_changes(const Session& session, const std::string& of, std::size_t lines, PanelState& state,
                  Commands& commands);
void show_editor(const Session& session, PanelState& state, Commands& commands);
// Menu entries that depend on the installed files: tours and pages of the manual; and the window with a page.
void show_tour_items(const Session& session, PanelState& state, Commands& commands);
void show_help_items(PanelState& state);
void open_manual(PanelState& state, const std::string& page);
// The card of keys and terms (F1), while the scene shows "help".
void show_help(const Session& session, PanelState& state, Commands& commands);
void show_manual(PanelState& state);
// The command palette (Ctrl+Shift+P), while the scene shows "palette".
void show_palette(const Session& session, PanelState& state, Commands& commands);
// The caption of a tour, above the mechanism.
float caption_height(const Session& session, const PanelState& state, float width);
void show_caption(const Session& session, PanelState& state, Commands& commands);
void show_dialogs(const Session& session, PanelState& state, Commands& commands);
// The path field with shell-like keys; returns true if Enter was pressed. browse() shows the folder below it.
// `has_taken`: the entry or click was used to open a folder or fill the field. `is_chosen`: a file was chosen.
bool path_line(PanelState& state, bool focuses);
struct BrowseResult {
    bool has_taken = false, is_chosen = false;
};
BrowseResult browse(PanelState& state, const std::vector<std::string>& endings, bool entered);
// The export options above the path, and a note on the resulting file below it.
void show_export_form(const Session& session, PanelState& state);
struct ExportNote {
    std::string text;
    bool is_wrong = false;  // the export is not possible
};
ExportNote export_note(const Session& session, const ExportForm& form);
command::Export export_command(const ExportForm& form, const std::string& file, bool overwrite);
// The output file: the path, with the form's extension if it has none.
std::string export_file(const ExportForm& form, const std::string& path);
// Progress of an animation.
void show_film(PanelState& state);
// The gallery (Ctrl+G): pictures of the systems, while the scene shows "gallery".
void show_gallery(const Session& session, PanelState& state, Commands& commands);
void show_mechanism(const Session& session, PanelState& state, Commands& commands);
// Below the mechanism: every Zeno point and release, with the certified accuracy of its time.
void show_results(const Session& session, PanelState& state, Commands& commands);
float results_height(const Session& session);
// Below the results: the energies at the current time and, if there is room, over the run.
void show_energy(const Session& session, PanelState& state, Commands& commands);
float energy_height(bool with_course);
// The state in numbers at the top of the mechanism's panel, and its height for a panel of this width.
void show_state(const Session& session, const Rectangle& panel);
float state_height(const Session& session, float panel_width);
// The configuration plane in place of the mechanism: two quantities, the region where the gap is open, the run, and its
// start, which can be dragged. For one coordinate it is the phase plane.
bool has_contours(const PlaneView& plane);
void show_plane(const Session& session, const Rectangle& area, PanelState& state, Commands& commands);
void show_timeline(const Session& session, PanelState& state, Commands& commands);
float timeline_height();
void show_plots(const Session& session, PanelState& state, Commands& commands);
// Above the plots: the grid selection; and the menu opened by a plot's title.
void show_grid_bar(const Session& session, PanelState& state, Commands& commands);
// Records the choices and axes of the plots, and goes back (-1) or forward (1) in that record.
void follow_views(const Session& session, PanelState& state);
void go_to_view(const Session& session, PanelState& state, int step, Commands& commands);
void open_plot_menu(const Session& session, std::size_t plot, PanelState& state);
void show_plot_menu(const Session& session, std::size_t plot, PanelState& state, Commands& commands);
// The sweep around the current run. Shown instead of the events.
void show_sweep(const Session& session, PanelState& state, Commands& commands);
void show_events(const Session& session, PanelState& state, Commands& commands);
// The equations of motion, those of each contact, and the Zeno conditions with their current values. Shown instead of
// the events.
void show_equations(const Session& session, PanelState& state, Commands& commands);
// Sensitivities of a quantity of the run. Shown instead of the events.
void show_dependence(const Session& session, PanelState& state, Commands& commands);
// The periodic orbit near the current run, and its branch. Shown instead of the events.
void show_orbit(const Session& session, PanelState& state, Commands& commands);
// The proof of the run. Shown instead of the events. Until when, for what, and what it assumes.
std::string proof_sentence(const Session& session, const Proof& proof);
void show_proof(const Session& session, PanelState& state, Commands& commands);
// In a small window: the tabs of all panels.
void show_panel_tabs(const Session& session, PanelState& state, Commands& commands);
// Tabs that select the events or one of these studies, and what is selected.
void show_lower_panel(const Session& session, PanelState& state, Commands& commands);
// The padded area of a study, ended by ImGui::EndChild().
void begin_study(const char* name);
// True while equations are being derived, so that frames must continue.
bool derives_equations(const PanelState& state);
// Cards beside the event list, about one event: the certificate of a Zeno point; the loss of an impact and why the
// sequence was not cut there; the reason for a release; the forces of friction. Another card compares the runs;
// comparison_width() is its preferred width. show_card_title() returns true if the user closes the card.
bool show_card_title(const std::string& title, const std::string& more, PanelState& state, float margin = 0.0F);
void show_zeno(const Session& session, std::size_t index, PanelState& state, Commands& commands);
// The Zeno lens replaces the plots while a Zeno point is selected.
bool lens_is_open(const Session& session);
void show_lens(const Session& session, PanelState& state, Commands& commands);
void show_impact(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_release(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_friction(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_collapse(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_jump(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_pass(const Session& session, std::size_t index, PanelState& state, Commands& commands);
void show_comparison(const Session& session, PanelState& state, Commands& commands);
float comparison_width(const Session& session);
// Below the sliders: the pinned runs, if any.
void show_runs(const Session& session, PanelState& state, Commands& commands);
// Names of the pinned runs in the title row of a plot, up to `right`, if that panel is hidden. Returns their left end.
float name_runs(const Session& session, const Rectangle& row, float right);
void show_status(const Session& session, const PanelState& state);
// "about 12 s left", extrapolated from a fraction `share` (0 to 1) done in `seconds`; empty: too early.
std::string time_left(double seconds, double share);

// True while typed text is not yet a command, so that frames must continue.
bool is_typing(const PanelState& state);
// The same for a click that may become a double click.
bool waits_for_click(const PanelState& state);
// The same for a tooltip that is not shown yet.
bool waits_for_tooltip(const PanelState& state);
// Turns the typed text into a command now.
void hand_over_text(EditorState& editor, Commands& commands);
// Toggles between the editor and the sliders.
void toggle_editor(const Session& session, PanelState& state, Commands& commands);
// Issues a command that replaces the edited text. Asks first if the text has unsaved changes.
void request(const Session& session, PanelState& state, const Command& command, Commands& commands);
// True if the window can be closed at once. Otherwise asks first, and later sets may_close.
bool request_close(const Session& session, PanelState& state);
// Open the file dialogs. save_or_ask() asks only if the text has no file yet.
void ask_to_open(PanelState& state);
void ask_to_save(const Session& session, PanelState& state);
// `ending`: "svg", in the form of ending_of().
void ask_to_export(const Session& session, PanelState& state, const std::string& ending, int plot = 0);
void save_or_ask(const Session& session, PanelState& state, Commands& commands);

// ---- shared by the sweep panel, the sensitivity panel, their menus and the sliders ----

// Drag-and-drop payload type of a slider's name that is dropped onto an axis.
inline constexpr const char* dragged_name = "name";
// A row of menus, up to `right`: the quantities along x and y, and the printed quantity.
void show_sweep_menus(const Session& session, const Rectangle& row, PanelState& state, Commands& commands);

// "15.88 s per m": a derivative, with angles in degrees. "none" if it does not exist.
std::string derivative_text(const SystemDescription& system, const Sensitivities& known,
                            const Sensitivities::Sensitivity& by);
// The sweep over that slider with this quantity.
command::ShowSweep sweep_over(const Session& session, const std::string& name, const std::string& quantity);

}  // namespace achilles
