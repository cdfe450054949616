// Every command of the explorer, as a value with a text form. A journal is a list of commands, one per line. Each
// command describes itself once, in `said` (command_fields.hpp): its name, its usage, its fields and what undo does
// with it.
//
//     open ball_on_sine        set x' 1.5         eps 1e-6 1e-6 1e-7        seek 3.2        # a comment
//
// Values are in the file's units, angles in radians or as 30 deg. See journal.hpp for the quoting of words with spaces.
#pragma once

#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "session/command_fields.hpp"
#include "system/description.hpp"

namespace achilles {

namespace command {

struct Open {
    std::string system;  // a path, or the name of one of the assets
    static constexpr auto spec = CommandSpec("open", "write: open SYSTEM; put a path with spaces in double quotes",
                                             UndoPolicy::own_step, &Open::system);
};
struct Set {
    std::string name;  // a parameter, a coordinate x, or a rate x'
    ValueArgument value;
    static constexpr auto spec =
        CommandSpec("set", "write: set NAME VALUE", UndoPolicy::merge_with_previous, &Set::name, &Set::value);
};
// Sets an option (all_options()), or all options that one command sets. Name, syntax and valid values of the command
// come from the option table.
struct SetOption {
    std::string name;                 // the command
    std::vector<OptionValue> values;  // one for each of options_set_by(name)

    SetOption(std::string_view name, std::vector<OptionValue> values);
    // The command that sets `option`, with the values that `as_there` has for it and for the options set together with
    // it.
    SetOption(const Option& option, const Options& as_there);
    bool sets_single_value() const;  // true if all options it sets get the same value
    friend bool operator==(const SetOption&, const SetOption&) = default;
};
// Constructors for C++ callers.
struct SetEndTime : SetOption {
    explicit SetEndTime(double time) : SetOption("end", {time}) {}
};
struct Tolerance : SetOption {
    explicit Tolerance(double value) : SetOption("tolerance", {value}) {}
};
struct Eps : SetOption {
    Eps(double q, double v, double t) : SetOption("eps", {q, v, t}) {}
};
struct SetConditions : SetOption {
    explicit SetConditions(Conditions value) : SetOption("conditions", {to_text(value)}) {}
};
struct SetReinitialization : SetOption {
    explicit SetReinitialization(Reinitialization value) : SetOption("reinitialization", {to_text(value)}) {}
};
struct SetMethod : SetOption {
    explicit SetMethod(Method value) : SetOption("method", {to_text(value)}) {}
};
struct MaxImpacts : SetOption {
    explicit MaxImpacts(int count) : SetOption("max-impacts", {count}) {}
};
struct Seek {
    double time = 0.0;  // s; a time beyond the run goes to its end, with a warning
    static constexpr auto spec = CommandSpec("seek", "write: seek NUMBER", UndoPolicy::none, &Seek::time);
};
struct Play {
    static constexpr auto spec = CommandSpec("play", alone, UndoPolicy::none);
};
struct Pause {
    static constexpr auto spec = CommandSpec("pause", alone, UndoPolicy::none);
};
struct Select {
    int event = 0;  // number in the event list, from 1; the time moves to the event. 0: no event
    static constexpr auto spec =
        CommandSpec("select", "write: select NUMBER, counting the events from 1", UndoPolicy::view, &Select::event);
};

struct New {  // opens a template for a new system
    static constexpr auto spec = CommandSpec("new", alone, UndoPolicy::own_step);
};
struct SetText {
    std::string text;  // the whole system file, as in the editor
    static constexpr auto spec = CommandSpec("text", "write: text \"the whole file\", with \\n for every new line",
                                             UndoPolicy::own_step, Field(&SetText::text, in_quotes));
};
struct Save {
    std::string file;        // where the text in the editor is written
    bool overwrite = false;  // replace any existing file; otherwise only the file that was opened or saved before
    static constexpr auto spec = CommandSpec("save", "write: save FILE, or: save FILE overwrite", UndoPolicy::view,
                                             &Save::file, Field(&Save::overwrite, command::overwrite));
};
struct Reload {  // reads the file of the system again; sliders keep what they changed
    static constexpr auto spec = CommandSpec("reload", alone, UndoPolicy::own_step);
};
inline const std::vector<std::string> shown_things{
    "accuracy", "contours", "controls", "depend", "editor",    "energy", "equations", "events", "export",
    "force",    "gallery",  "help",     "lens",   "mechanism", "orbit",  "palette",   "plane",  "plots",
    "proof",    "runs",     "sides",    "strobe", "sweep",     "trail",  "velocity"};
// Studies: tabs beside the event list. At most one is shown; without one, the events are.
inline const std::vector<std::string> studies{"equations", "depend", "sweep", "orbit", "proof"};
// Panels that are tabs in a small window; the one shown last is in front.
inline const std::vector<std::string> tabs{"mechanism", "controls", "editor", "plots", "events",
                                           "equations", "depend",   "sweep",  "orbit", "proof"};
struct Show {
    // What to show or hide. Panels: `controls`, `plots`, `events`; `editor` (replaces the controls); the studies, which
    // replace the events; `energy` (below the results); `runs` (table of pinned runs, beside the events). `mechanism`
    // brings it to the front in a small window; it cannot be hidden. In the mechanism view: `trail`, `velocity`,
    // `force`, `strobe` (poses at events); `plane` replaces the mechanism with the configuration plane, `contours` adds
    // energy contours to it; `sides` shows two side views of a 3D system. Cards: `help`, `gallery`, `palette`,
    // `export`. `accuracy` is a section of the controls.
    std::string what;
    bool on = true;
    static constexpr auto spec = CommandSpec(
        "show", "write: {0} editor", UndoPolicy::view,
        Field(&Show::what,
              {.one_of = &shown_things, .known = "these can be shown: {}", .complaint = "there is no '{}' to show{}"}),
        Field(&Show::on, {.yes = "show", .no = "hide", .is_name = true}));
};

struct DefaultPlane {  // the first two coordinates, or the single coordinate and its rate
    static constexpr auto spec = CommandSpec("plane default", alone, UndoPolicy::view);
};
struct ShowPlane {
    std::string x, y;  // expressions, as in a view; the plane replaces the mechanism
    static constexpr auto spec =
        CommandSpec("plane", "write: plane X Y, expressions with spaces in double quotes, or: plane default",
                    UndoPolicy::view, &ShowPlane::x, &ShowPlane::y);
};
struct Find {
    std::string text;  // search text; the palette opens with it
    static constexpr auto spec =
        CommandSpec("find", "write: find \"letters of a command\"", UndoPolicy::view, Field(&Find::text, in_quotes));
};

// Plots are numbered from 1, row by row.
struct SetGrid {
    int columns = 1, rows = 1;
    static constexpr auto spec =
        CommandSpec("grid", "write: grid COLUMNS ROWS", UndoPolicy::own_step, &SetGrid::columns, &SetGrid::rows);
};
struct PlotView {
    int plot = 1;
    std::string x;  // expressions, as in a view
    std::vector<std::string> y;
    static constexpr auto spec =
        CommandSpec("plot", "write: plot NUMBER X Y..., expressions with spaces in double quotes", UndoPolicy::own_step,
                    &PlotView::plot, &PlotView::x, &PlotView::y);
};
struct Zoom {
    int plot = 1;
    double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;  // in display units
    static constexpr auto spec =
        CommandSpec("zoom", "write: zoom NUMBER X_LOW X_HIGH Y_LOW Y_HIGH", UndoPolicy::merge_with_previous,
                    &Zoom::plot, &Zoom::x_low, &Zoom::x_high, &Zoom::y_low, &Zoom::y_high);
};
struct Fit {
    int plot = 1;
    static constexpr auto spec = CommandSpec("fit", "write: fit NUMBER", UndoPolicy::own_step, &Fit::plot);
};
struct SetRange {  // sets one axis; the other one is unchanged
    int plot = 1;
    bool is_x = true;
    double low = 0.0, high = 1.0;
    static constexpr auto spec =
        CommandSpec("range", "write: range NUMBER x LOW HIGH, or: range NUMBER y LOW HIGH", UndoPolicy::own_step,
                    &SetRange::plot, Field(&SetRange::is_x, x_or_y), &SetRange::low, &SetRange::high);
};
struct AxisScale {
    int plot = 1;
    bool is_x = true, logarithmic = false;
    static constexpr auto spec =
        CommandSpec("log", "write: log NUMBER x on, or: log NUMBER y off", UndoPolicy::own_step, &AxisScale::plot,
                    Field(&AxisScale::is_x, x_or_y), Field(&AxisScale::logarithmic, on_off));
};
struct ShowCurve {
    int plot = 1, curve = 1;
    bool shown = true;
    static constexpr auto spec =
        CommandSpec("curve", "write: curve PLOT NUMBER on, or: curve PLOT NUMBER off", UndoPolicy::own_step,
                    &ShowCurve::plot, &ShowCurve::curve, Field(&ShowCurve::shown, on_off));
};
struct Link {
    bool on = true;  // all plots over time share one time axis
    static constexpr auto spec =
        CommandSpec("link", "write: link on, or: link off", UndoPolicy::view, Field(&Link::on, on_off));
};

struct SetStart {  // sets several values at once: an intermediate state might be infeasible
    std::vector<std::pair<std::string, ValueArgument>> values;
    static constexpr auto spec = CommandSpec("start", "write: start NAME VALUE NAME VALUE ...",
                                             UndoPolicy::merge_with_previous, &SetStart::values);
};
struct LookAll {
    static constexpr auto spec = CommandSpec("look all", alone, UndoPolicy::view);
};
struct LookAt {
    // View center and visible width, in world units.
    double x = 0.0, y = 0.0, width = 1.0;
    static constexpr auto spec = CommandSpec("look", "write: look X Y WIDTH, or: look all", UndoPolicy::view,
                                             &LookAt::x, &LookAt::y, &LookAt::width);
};
inline const std::vector<std::string> camera_modes{"fit", "fixed", "follow", "zeno"};
struct SetCamera {
    std::string
        // One of CameraMode: fit the whole run; keep the last view; follow the body; zoom in on the next Zeno point.
        mode;
    static constexpr auto spec =
        CommandSpec("camera", "write: camera fit, camera fixed, camera follow, or: camera zeno", UndoPolicy::view,
                    Field(&SetCamera::mode, {.one_of = &camera_modes, .complaint = "there is no camera '{}'{}"}));
};
struct TurnBack {  // the picture as the file draws it
    static constexpr auto spec = CommandSpec("turn default", alone, UndoPolicy::view);
};
struct Turn {
    // The direction from which a system in space is seen, degrees (ViewAngles).
    double about = 0.0, tilt = 0.0;
    static constexpr auto spec =
        CommandSpec("turn", "write: turn ABOUT TILT, in degrees, such as turn 30 45, or: turn default",
                    UndoPolicy::view, &Turn::about, &Turn::tilt);
};
constexpr double slowest = 1e-3, fastest = 10.0;
struct Speed {
    double value = 1.0;  // simulated seconds per second of playback, from `slowest` to `fastest`
    static constexpr auto spec = CommandSpec("speed", "write: speed NUMBER", UndoPolicy::view, &Speed::value);
};
struct Loop {
    bool on = true;  // playback restarts at the end
    static constexpr auto spec =
        CommandSpec("loop", "write: loop on, or: loop off", UndoPolicy::view, Field(&Loop::on, on_off));
};
inline const std::vector<std::string> step_kinds{"event", "frame", "zeno"};
struct StopAnimation {
    static constexpr auto spec = CommandSpec("animate off", alone, UndoPolicy::none);
};
struct Animate {
    std::string name;  // a parameter, a coordinate x, or a rate x'
    ValueArgument from, to;
    double seconds = 0.0;  // of playback; 0: 5
    static constexpr auto spec =
        CommandSpec("animate", "write: animate NAME FROM TO [over SECONDS], or: animate off", UndoPolicy::own_step,
                    &Animate::name, &Animate::from, &Animate::to, Field(&Animate::seconds, length_after("over")));
};
struct StepEvents {
    int events = 1;  // 1: to the next event; -1: to the previous one
    // One of `step_kinds`. `event` and `zeno` also choose the event or Zeno point, `frame` moves by one picture of the
    // playback. Empty: only the time moves to the event.
    std::string what = {};
    static constexpr auto spec = CommandSpec(
        "step", "write: step 1, or: step -1 event, frame or zeno", UndoPolicy::none, &StepEvents::events,
        Field(&StepEvents::what, {.one_of = &step_kinds, .may_lack = true, .complaint = "there is no step by '{}'{}"}));
};

struct Undo {
    static constexpr auto spec = CommandSpec("undo", alone, UndoPolicy::view);
};
struct Redo {
    static constexpr auto spec = CommandSpec("redo", alone, UndoPolicy::view);
};
// Pinned runs are kept unchanged beside the current run. Each has a place, from 1, which determines its color.
inline constexpr FieldFormat place{.may_lack = true, .complaint = "places count from 1: there is no place {}"};
struct Pin {
    int place = 0;  // place for the current run; 0: the first free one
    static constexpr auto spec =
        CommandSpec("pin", "write: pin [PLACE]", UndoPolicy::view, Field(&Pin::place, command::place));
};
struct UnpinAll {
    static constexpr auto spec = CommandSpec("unpin all", alone, UndoPolicy::view);
};
struct Unpin {
    int place = 0;  // place of the run to remove; 0: the one pinned last
    static constexpr auto spec = CommandSpec("unpin", "write: unpin [PLACE], or: unpin all", UndoPolicy::view,
                                             Field(&Unpin::place, command::place));
};
struct ShowPinned {
    int place = 1;
    bool shown = true;
    static constexpr auto spec = CommandSpec("pinned", "write: pinned PLACE on, or: pinned PLACE off", UndoPolicy::view,
                                             &ShowPinned::place, Field(&ShowPinned::shown, on_off));
};
struct Recall {
    int place = 1;  // copies every value and option of this pinned run to the current one; the run stays pinned
    static constexpr auto spec = CommandSpec("recall", "write: recall PLACE", UndoPolicy::own_step, &Recall::place);
};
struct PlotDifference {
    int plot = 1;
    bool on = true;  // plot the difference of each pinned run from the current one, over time
    static constexpr auto spec =
        CommandSpec("difference", "write: difference NUMBER on, or: difference NUMBER off", UndoPolicy::own_step,
                    &PlotDifference::plot, Field(&PlotDifference::on, on_off));
};
struct ShowLens {
    double from = 0.0;  // opens the Zeno lens; -log10 of the remaining time at its left edge
    static constexpr auto spec = CommandSpec("lens", "write: lens NUMBER", UndoPolicy::view, &ShowLens::from);
};
struct SetTheme {
    bool dark = false;
    static constexpr auto spec =
        CommandSpec("theme", "write: theme light, or: theme dark", UndoPolicy::view,
                    Field(&SetTheme::dark, {.yes = "dark", .no = "light", .complaint = "there is no theme '{}'"}));
};
constexpr double smallest = 0.5, largest = 3.0;
struct Enlarge {
    double value = 1.0;  // scale factor of the user interface
    static constexpr auto spec =
        CommandSpec("enlarge", "write: enlarge NUMBER, 1 is the default size", UndoPolicy::view, &Enlarge::value);
};
struct Present {
    bool on = true;  // lecture mode: title, mechanism, one plot, up to three sliders and the player, enlarged
    // The names of these sliders; empty: those that differ from the file.
    std::vector<std::string> sliders = {};
    static constexpr auto spec =
        CommandSpec("present", "write: present on [NAME ...] (up to three sliders), or: present off", UndoPolicy::view,
                    Field(&Present::on, on_off), Field(&Present::sliders, {.may_lack = true}));
};
inline const std::vector<std::string> sized_panels{"controls", "editor", "events", "plots", "sweep"};
struct SetPanelSize {
    std::string panel;   // the editor, which replaces the controls, has its own width
    double share = 0.0;  // share of the window's width (events: of its height); 0: automatic
    static constexpr auto spec =
        CommandSpec("size", "write: size controls 0.3 (a share of the window), or: size plots auto", UndoPolicy::view,
                    Field(&SetPanelSize::panel, {.one_of = &sized_panels, .complaint = "there is no panel '{}'{}"}),
                    Field(&SetPanelSize::share, {.fits = [](double x) { return x > 0.0 && x < 1.0; },
                                                 .zero = "auto",
                                                 .complaint = "a panel cannot take {} of the window"}));
};

struct Reset {  // restores every value and option of the file
    static constexpr auto spec = CommandSpec("reset", alone, UndoPolicy::own_step);
};
struct EndEdit {  // ends the current edit: the next change is a separate undo step, even of the same value
    static constexpr auto spec = CommandSpec("done", alone, UndoPolicy::none);
};

struct Export {
    std::string
        // Output file. Its extension selects what is written: .svg, .png, .pdf the plots; .json, .csv the run; .journal
        // the session; .mp4, .gif an animation of the mechanism beside the plots.
        file;
    bool overwrite = false;  // replace any existing file
    int plot = 0;            // only this plot; 0: all
    bool mechanism = false;  // the mechanism at the current time instead of the plots
    // Picture size and font in mm, mm, pt; 0: the default of PaperSize.
    double width = 0.0, height = 0.0, font = 0.0, dpi = 0.0;
    double fps = 0.0, speed = 0.0;  // of an animation; 0: 30, and the playback speed
    int pixels = 0;                 // width of an animation; 0: 1280
    bool dark = false;
    static constexpr auto spec = CommandSpec(
        "export",
        "write: export FILE, or: export FILE overwrite; one plot alone: export FILE plot 2, or mechanism; on paper: "
        "width MM height MM font PT dpi N; of a film: fps N speed X pixels N; dark",
        UndoPolicy::view, &Export::file,
        Field(&Export::plot, {.after = "plot", .complaint = "plots count from 1: there is no plot {}"}),
        Field(&Export::mechanism, {.yes = "mechanism", .may_lack = true}), Field(&Export::width, length_after("width")),
        Field(&Export::height, length_after("height")), Field(&Export::font, length_after("font")),
        Field(&Export::dpi, length_after("dpi")), Field(&Export::fps, length_after("fps")),
        Field(&Export::speed, length_after("speed")),
        Field(&Export::pixels, {.after = "pixels", .complaint = "{} is not a valid width in pixels"}),
        Field(&Export::dark, {.yes = "dark", .may_lack = true}), Field(&Export::overwrite, command::overwrite));
};
inline const std::vector<std::string> copied_things{"data",    "events", "explorer", "figure", "link",
                                                    "picture", "plots",  "run",      "sweep"};
struct Copy {
    // One of copied_things. `link`: what opens this session in a browser. `explorer`, `figure`, `run`, `sweep`: the
    // shell command that makes it. `data`: the run; `events`: the selected event, or all; `plots`: what is plotted, all
    // as tables. `picture`: the plots.
    std::string what;
    int plot = 0;  // of `plots` and `picture`: only this plot; 0: all
    static constexpr auto spec = CommandSpec(
        "copy",
        "write: copy link; copy explorer, figure, run or sweep (a command line); copy data or events (a table); copy "
        "plots or picture, of one plot: copy plots 2",
        UndoPolicy::view, Field(&Copy::what, {.one_of = &copied_things, .complaint = "'{}' cannot be copied{}"}),
        Field(&Copy::plot, {.may_lack = true, .complaint = "plots count from 1: there is no plot {}"}));
};

// Commands for guided tours.
struct Wait {
    double seconds = 0.0;  // pause; playback continues
    static constexpr auto spec = CommandSpec(
        "wait", "write: wait SECONDS", UndoPolicy::none,
        Field(&Wait::seconds, {.fits = [](double x) { return x >= 0.0; }, .complaint = "the time must be 0 or more"}));
};
struct Say {
    std::string text;  // caption above the mechanism until the next `say`; empty: no caption
    static constexpr auto spec =
        CommandSpec("say", "write: say \"a sentence\", or: say \"\"", UndoPolicy::view, Field(&Say::text, in_quotes));
};
inline const std::vector<std::string> highlighted_panels{"bar",   "controls", "energy", "events", "mechanism", "none",
                                                         "plots", "results",  "status", "sweep",  "timeline"};
struct Highlight {
    std::string panel;  // the panel to frame until the next `say`
    static constexpr auto spec =
        CommandSpec("highlight", "write: highlight plots, or: highlight none", UndoPolicy::view,
                    Field(&Highlight::panel, {.one_of = &highlighted_panels,
                                              .known = "these can be highlighted: {}",
                                              .complaint = "there is no panel '{}'{}"}));
};
struct Replay {
    std::string journal;  // a path, or the name of an asset
    static constexpr auto spec = CommandSpec("replay", "write: replay JOURNAL; put a path with spaces in double quotes",
                                             UndoPolicy::view, &Replay::journal);
};

// Studies of the current run.
struct ShowSweep {
    // As on the command line, without --set and options of the run: those come from the session.
    std::string text;
    static constexpr auto spec = CommandSpec("sweep", "write: sweep \"--over e=0:0.95:512 --print zeno_time(1)\"",
                                             UndoPolicy::view, Field(&ShowSweep::text, in_quotes));
};
struct StopProof {  // also forgets the proof
    static constexpr auto spec = CommandSpec("prove off", alone, UndoPolicy::view);
};
struct Prove {
    // Half-width (radius) of the interval of every initial coordinate and rate.
    double width = 0.0;
    std::vector<std::string> intervals;  // NAME=LOW..HIGH; each must contain the value of the current run
    static constexpr auto spec =
        CommandSpec("prove", "write: prove [width W] [NAME=LOW..HIGH ...], or: prove off", UndoPolicy::view,
                    Field(&Prove::width, length_after("width")), Field(&Prove::intervals, {.may_lack = true}));
};
struct StopOrbit {  // also forgets the result
    static constexpr auto spec = CommandSpec("orbit off", alone, UndoPolicy::view);
};
struct FindOrbit {
    // As on the command line, without --set and options of the run: those come from the session.
    std::string text;
    static constexpr auto spec =
        CommandSpec("orbit", "write: orbit \"--from start --continue e=0.1:0.9\", orbit \"\", or: orbit off",
                    UndoPolicy::view, Field(&FindOrbit::text, in_quotes));
};
struct SelectBranchPoint {
    // Number of a point of the branch, or 1. The run takes its start and parameters from there.
    int point = 1;
    static constexpr auto spec =
        CommandSpec("branch", "write: branch NUMBER, a point of the branch that `orbit` has followed",
                    UndoPolicy::merge_with_previous, &SelectBranchPoint::point);
};
struct ShowSensitivity {
    std::string quantity;  // an expression that --print of a sweep accepts
    static constexpr auto spec = CommandSpec(
        "depend", "write: depend \"zeno_time(2)\", or another expression in the end and the events of a run",
        UndoPolicy::view, Field(&ShowSensitivity::quantity, in_quotes));
};

}  // namespace command

// In the order of the help listing.
using AnyCommand =
    std::variant<command::Open, command::Set, command::SetOption, command::Seek, command::Play, command::Pause,
                 command::Select, command::New, command::SetText, command::Save, command::Reload, command::Show,
                 command::DefaultPlane, command::ShowPlane, command::ShowSweep, command::StopProof, command::Prove,
                 command::ShowSensitivity, command::StopOrbit, command::FindOrbit, command::SelectBranchPoint,
                 command::Find, command::SetGrid, command::PlotView, command::Zoom, command::Fit, command::SetRange,
                 command::AxisScale, command::ShowCurve, command::Link, command::SetStart, command::LookAll,
                 command::LookAt, command::SetCamera, command::TurnBack, command::Turn, command::Speed, command::Loop,
                 command::StopAnimation, command::Animate, command::StepEvents, command::Undo, command::Redo,
                 command::Pin, command::UnpinAll, command::Unpin, command::ShowPinned, command::Recall,
                 command::PlotDifference, command::ShowLens, command::SetTheme, command::Enlarge, command::Present,
                 command::SetPanelSize, command::Reset, command::EndEdit, command::Export, command::Copy, command::Wait,
                 command::Say, command::Highlight, command::Replay>;
// The variant type with copy, move and destruction defined in command.cpp: inline, they would cost seconds of compile
// time in every file that uses a Command.
struct Command : AnyCommand {
    using AnyCommand::AnyCommand;
    Command(const Command& other);
    Command(Command&& other) noexcept;
    Command& operator=(const Command& other);
    Command& operator=(Command&& other) noexcept;
    ~Command();
};

using Commands = std::vector<Command>;

// One line without a newline. Numbers have the shortest form that reads back to the same value.
std::string to_text(const Command& command);

// Parses one line. Throws InputError with file, line and column. The line must contain a command; see parse_journal()
// for blank lines and comments.
Command parse_command(std::string_view text, const std::string& file = "<command>", int line = 1);

// The usage of every command, one line each.
std::vector<std::string> command_usages();

command::UndoPolicy undo_policy_of(const Command& command);
// True if `next` continues the edit of `last`: the same slider or the same plot. Both then form one undo step.
bool continues_edit(const Command& last, const Command& next);

// The error of a rejected command. It names no file, because the user gave the command. The hint, which may be empty,
// says what to do instead.
inline InputError refusal(const std::string& message, const std::string& hint = {}) { return {{}, {}, message, hint}; }

// Thrown if a journal tries to do what its file policy does not allow. None of its commands has been performed. An
// ordinary rejected command is reported and the session continues; this error also stops the rendering of a picture.
struct PermissionDenied : InputError {
    using InputError::InputError;
    // Results of access_request(), without duplicates, if the user may allow the file access.
    std::vector<std::string> requests;
};

// Calls `perform`. An InputError is rethrown as the refusal of a Command with its usage as the hint; Forbidden passes
// unchanged.
template <class Command, class Perform>
auto or_refuse(Perform perform) {
    try {
        return perform();
    } catch (const PermissionDenied&) {
        throw;
    } catch (const InputError& problem) {
        throw refusal(problem.what(), std::string(Command::spec.usage));
    }
}

// True if `check` throws no InputError.
template <class Check>
bool passes(Check check) {
    try {
        check();
        return true;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace achilles
