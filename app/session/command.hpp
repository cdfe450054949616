// Everything a user can do, as a value with a text form: a journal is a list of these, a line each. Each says itself, once
// (command_fields.hpp): what it is called, how it is written, which words follow, what undo makes of it.
//
//     open ball_on_sine        set x' 1.5         eps 1e-6 1e-6 1e-7        seek 3.2        # a comment
//
// Values are in the file's units, angles in radians or as 30 deg; journal.hpp tells how words with spaces are written.
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
    static constexpr auto said =
        Said("open", "write: open SYSTEM; put a path with spaces in double quotes", Change::alone, &Open::system);
};
struct Set {
    std::string name;  // a parameter, a coordinate x, or a rate x'
    Given value;
    static constexpr auto said = Said("set", "write: set NAME VALUE", Change::together, &Set::name, &Set::value);
};
// A new value for an option (all_options()), or for all that its command sets: what it is called, how it is written
// and what it may be stands there.
struct UseOption {
    std::string name;                 // of the command
    std::vector<OptionValue> values;  // of each of options_set_by(name)

    UseOption(std::string_view name, std::vector<OptionValue> values);
    // What sets an option, and those that it is set together with, as they are there.
    UseOption(const Option& option, const Options& as_there);
    bool is_of_one_value() const;  // the same for all that it sets
    friend bool operator==(const UseOption&, const UseOption&) = default;
};
// The same, for those who write C++.
struct End : UseOption {
    explicit End(double time) : UseOption("end", {time}) {}
};
struct Tolerance : UseOption {
    explicit Tolerance(double value) : UseOption("tolerance", {value}) {}
};
struct Eps : UseOption {
    Eps(double q, double v, double t) : UseOption("eps", {q, v, t}) {}
};
struct UseConditions : UseOption {
    explicit UseConditions(Conditions value) : UseOption("conditions", {to_text(value)}) {}
};
struct UseReinitialization : UseOption {
    explicit UseReinitialization(Reinitialization value) : UseOption("reinitialization", {to_text(value)}) {}
};
struct UseMethod : UseOption {
    explicit UseMethod(Method value) : UseOption("method", {to_text(value)}) {}
};
struct MaxImpacts : UseOption {
    explicit MaxImpacts(int count) : UseOption("max-impacts", {count}) {}
};
struct Seek {
    double time = 0.0;  // s; beyond the run: its end, and that is told
    static constexpr auto said = Said("seek", "write: seek NUMBER", Change::none, &Seek::time);
};
struct Play {
    static constexpr auto said = Said("play", alone, Change::none);
};
struct Pause {
    static constexpr auto said = Said("pause", alone, Change::none);
};
struct Select {
    int event = 0;  // its number in the list, from 1; the time moves to it. 0: none
    static constexpr auto said =
        Said("select", "write: select NUMBER, counting the events from 1", Change::view, &Select::event);
};

struct New {  // a system to start from
    static constexpr auto said = Said("new", alone, Change::alone);
};
struct Text {
    std::string text;  // of the whole system file, as the editor holds it
    static constexpr auto said = Said("text", "write: text \"the whole file\", with \\n for every new line",
                                      Change::alone, Field(&Text::text, in_quotes));
};
struct Save {
    std::string file;        // what the editor holds goes there
    bool overwrite = false;  // whatever file may be there; else only the one that was opened or saved before
    static constexpr auto said = Said("save", "write: save FILE, or: save FILE overwrite", Change::view, &Save::file,
                                      Field(&Save::overwrite, command::overwrite));
};
inline const std::vector<std::string> shown_things{"accuracy",  "contours", "controls", "depend", "editor",  "energy",
                                                   "equations", "events",   "export",   "force",  "gallery", "help",
                                                   "lens",      "orbit",    "palette",  "plane",  "plots",   "runs",
                                                   "sides",     "strobe",   "sweep",    "trail",  "velocity"};
// These share a place: the events'.
inline const std::vector<std::string> shown_below{"equations", "depend", "orbit"};
struct Show {
    std::string what;  // a panel: editor (in place of the sliders), controls, plots, events, equations (in place of
                       // the events), energy (under the results); or trail, velocity, force, strobe (the poses at
                       // events); the section accuracy of the controls; in place of the mechanism the configuration
    // plane, with contours of the energy, or of a system in space two sides; help: the card of keys and words; runs: the table
    // of the pinned ones beside the events; the gallery; the dialog of export; under the plots the sweep; depend, in place of
    // the events: on what a quantity of the run depends; orbit, in the same place: a periodic run and its branch
    bool on = true;
    static constexpr auto said = Said(
        "show", "write: {0} editor", Change::view,
        Field(&Show::what,
              {.one_of = &shown_things, .known = "these can be shown: {}", .complaint = "there is no '{}' to show{}"}),
        Field(&Show::on, {.yes = "show", .no = "hide", .is_name = true}));
};

struct DefaultPlane {  // the first two coordinates, or the only one and its rate
    static constexpr auto said = Said("plane default", alone, Change::view);
};
struct ShowPlane {
    std::string x, y;  // expressions, as in a view: in place of the mechanism
    static constexpr auto said =
        Said("plane", "write: plane X Y, expressions with spaces in double quotes, or: plane default", Change::view,
             &ShowPlane::x, &ShowPlane::y);
};
struct Find {
    std::string text;  // letters of a command, in the palette, which opens
    static constexpr auto said =
        Said("find", "write: find \"letters of a command\"", Change::view, Field(&Find::text, in_quotes));
};

// The plots count from 1, row by row.
struct Grid {
    int columns = 1, rows = 1;
    static constexpr auto said = Said("grid", "write: grid COLUMNS ROWS", Change::alone, &Grid::columns, &Grid::rows);
};
struct PlotView {
    int plot = 1;
    std::string x;  // expressions, as in a view
    std::vector<std::string> y;
    static constexpr auto said = Said("plot", "write: plot NUMBER X Y..., expressions with spaces in double quotes",
                                      Change::alone, &PlotView::plot, &PlotView::x, &PlotView::y);
};
struct Zoom {
    int plot = 1;
    double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;  // in the units that are shown
    static constexpr auto said = Said("zoom", "write: zoom NUMBER X_LOW X_HIGH Y_LOW Y_HIGH", Change::together,
                                      &Zoom::plot, &Zoom::x_low, &Zoom::x_high, &Zoom::y_low, &Zoom::y_high);
};
struct Fit {
    int plot = 1;
    static constexpr auto said = Said("fit", "write: fit NUMBER", Change::alone, &Fit::plot);
};
struct Range {  // of one axis; the other stays as it is
    int plot = 1;
    bool is_x = true;
    double low = 0.0, high = 1.0;
    static constexpr auto said =
        Said("range", "write: range NUMBER x LOW HIGH, or: range NUMBER y LOW HIGH", Change::alone, &Range::plot,
             Field(&Range::is_x, x_or_y), &Range::low, &Range::high);
};
struct AxisScale {
    int plot = 1;
    bool is_x = true, logarithmic = false;
    static constexpr auto said =
        Said("log", "write: log NUMBER x on, or: log NUMBER y off", Change::alone, &AxisScale::plot,
             Field(&AxisScale::is_x, x_or_y), Field(&AxisScale::logarithmic, on_off));
};
struct ShowCurve {
    int plot = 1, curve = 1;
    bool shown = true;
    static constexpr auto said = Said("curve", "write: curve PLOT NUMBER on, or: curve PLOT NUMBER off", Change::alone,
                                      &ShowCurve::plot, &ShowCurve::curve, Field(&ShowCurve::shown, on_off));
};
struct Link {
    bool on = true;  // all plots over time show the same time
    static constexpr auto said = Said("link", "write: link on, or: link off", Change::view, Field(&Link::on, on_off));
};

struct Start {  // several values at once: the run in between might be none
    std::vector<std::pair<std::string, Given>> values;
    static constexpr auto said =
        Said("start", "write: start NAME VALUE NAME VALUE ...", Change::together, &Start::values);
};
struct LookAll {
    static constexpr auto said = Said("look all", alone, Change::view);
};
struct Look {
    double x = 0.0, y = 0.0, width = 1.0;  // of the world: the middle of the picture, and how much of it is seen
    static constexpr auto said =
        Said("look", "write: look X Y WIDTH, or: look all", Change::view, &Look::x, &Look::y, &Look::width);
};
inline const std::vector<std::string> camera_modes{"fit", "fixed", "follow", "zeno"};
struct Camera {
    std::string
        mode;  // CameraMode: all of the run; where was looked last; with the body; closer to the next Zeno point
    static constexpr auto said =
        Said("camera", "write: camera fit, camera fixed, camera follow, or: camera zeno", Change::view,
             Field(&Camera::mode, {.one_of = &camera_modes, .complaint = "there is no camera '{}'{}"}));
};
constexpr double slowest = 1e-3, fastest = 10.0;
struct Speed {
    double value = 1.0;  // seconds of the run in one of the player's, slowest to fastest
    static constexpr auto said = Said("speed", "write: speed NUMBER", Change::view, &Speed::value);
};
struct Loop {
    bool on = true;  // at the end the player begins again
    static constexpr auto said = Said("loop", "write: loop on, or: loop off", Change::view, Field(&Loop::on, on_off));
};
struct Step {
    int events = 1;  // to the next event, or with -1 the one before
    static constexpr auto said = Said("step", "write: step 1, or: step -1", Change::none, &Step::events);
};

struct Undo {
    static constexpr auto said = Said("undo", alone, Change::view);
};
struct Redo {
    static constexpr auto said = Said("redo", alone, Change::view);
};
// Pinned runs stay beside the present one as they are. Each has a place, from 1, which is its colour.
inline constexpr How place{.may_lack = true, .complaint = "places count from 1: there is no place {}"};
struct Pin {
    int place = 0;  // of the present run; 0: the first that is free
    static constexpr auto said = Said("pin", "write: pin [PLACE]", Change::view, Field(&Pin::place, command::place));
};
struct UnpinAll {
    static constexpr auto said = Said("unpin all", alone, Change::view);
};
struct Unpin {
    int place = 0;  // of the run that goes; 0: the one that was pinned last
    static constexpr auto said =
        Said("unpin", "write: unpin [PLACE], or: unpin all", Change::view, Field(&Unpin::place, command::place));
};
struct ShowPinned {
    int place = 1;
    bool shown = true;
    static constexpr auto said = Said("pinned", "write: pinned PLACE on, or: pinned PLACE off", Change::view,
                                      &ShowPinned::place, Field(&ShowPinned::shown, on_off));
};
struct Recall {
    int place = 1;  // every value and option as that pinned run has it, which stays
    static constexpr auto said = Said("recall", "write: recall PLACE", Change::alone, &Recall::place);
};
struct PlotDifference {
    int plot = 1;
    bool on = true;  // how far the pinned runs are from the present one, over time
    static constexpr auto said = Said("difference", "write: difference NUMBER on, or: difference NUMBER off",
                                      Change::alone, &PlotDifference::plot, Field(&PlotDifference::on, on_off));
};
struct Lens {
    double from = 0.0;  // -log10 of the time left at the left edge of the Zeno lens, which opens
    static constexpr auto said = Said("lens", "write: lens NUMBER", Change::view, &Lens::from);
};
struct UseTheme {
    bool dark = false;
    static constexpr auto said =
        Said("theme", "write: theme light, or: theme dark", Change::view,
             Field(&UseTheme::dark, {.yes = "dark", .no = "light", .complaint = "there is no theme '{}'"}));
};
constexpr double smallest = 0.5, largest = 3.0;
struct Enlarge {
    double value = 1.0;  // of everything: letters, strokes, panels
    static constexpr auto said =
        Said("enlarge", "write: enlarge NUMBER, 1 is the default size", Change::view, &Enlarge::value);
};
struct Present {
    bool on = true;  // to a class: the mechanism, one plot, the results, all of it larger
    static constexpr auto said =
        Said("present", "write: present on, or: present off", Change::view, Field(&Present::on, on_off));
};
inline const std::vector<std::string> sized_panels{"controls", "editor", "events", "plots", "sweep"};
struct Size {
    std::string panel;   // the editor in place of the controls has a width of its own
    double share = 0.0;  // of the window's width, for events of its height; 0: as it fits
    static constexpr auto said =
        Said("size", "write: size controls 0.3 (a share of the window), or: size plots auto", Change::view,
             Field(&Size::panel, {.one_of = &sized_panels, .complaint = "there is no panel '{}'{}"}),
             Field(&Size::share, {.fits = [](double x) { return x > 0.0 && x < 1.0; },
                                  .zero = "auto",
                                  .complaint = "a panel cannot take {} of the window"}));
};

struct Reset {  // every value and option as the file has it
    static constexpr auto said = Said("reset", alone, Change::alone);
};
struct Done {  // with this change: what follows is another one, be it of the same value
    static constexpr auto said = Said("done", alone, Change::none);
};

struct Export {
    std::string
        file;  // what goes there, its ending tells: .svg, .png, .pdf the plots; .json, .csv the run; .journal all;
               // .mp4, .gif the mechanism in motion beside the plots
    bool overwrite = false;                                   // whatever file may be there
    int plot = 0;                                             // this one alone; 0: all
    bool mechanism = false;                                   // as it is now, in place of the plots
    double width = 0.0, height = 0.0, font = 0.0, dpi = 0.0;  // of a picture: mm, mm, pt; 0: see PaperSize
    double fps = 0.0, speed = 0.0;                            // of a film; 0: 30, and as the player's
    int pixels = 0;                                           // its width; 0: 1280
    bool dark = false;
    static constexpr auto said = Said(
        "export",
        "write: export FILE, or: export FILE overwrite; one plot alone: export FILE plot 2, or mechanism; on paper: "
        "width MM height MM font PT dpi N; of a film: fps N speed X pixels N; dark",
        Change::view, &Export::file,
        Field(&Export::plot, {.after = "plot", .complaint = "plots count from 1: there is no plot {}"}),
        Field(&Export::mechanism, {.yes = "mechanism", .may_lack = true}), Field(&Export::width, length_after("width")),
        Field(&Export::height, length_after("height")), Field(&Export::font, length_after("font")),
        Field(&Export::dpi, length_after("dpi")), Field(&Export::fps, length_after("fps")),
        Field(&Export::speed, length_after("speed")),
        Field(&Export::pixels, {.after = "pixels", .complaint = "{} is not a valid width in pixels"}),
        Field(&Export::dark, {.yes = "dark", .may_lack = true}), Field(&Export::overwrite, command::overwrite));
};
inline const std::vector<std::string> copied_things{"explorer", "figure", "run", "sweep"};
struct Copy {
    std::string what;  // one of copied_things: the command line that makes it goes to the clipboard
    static constexpr auto said =
        Said("copy", "write: copy explorer, copy figure, copy run, or: copy sweep", Change::view,
             Field(&Copy::what, {.one_of = &copied_things, .complaint = "'{}' has no command{}"}));
};

// What makes a journal a tour.
struct Wait {
    double seconds = 0.0;  // for somebody to look; a run that plays goes on meanwhile
    static constexpr auto said = Said(
        "wait", "write: wait SECONDS", Change::none,
        Field(&Wait::seconds, {.fits = [](double x) { return x >= 0.0; }, .complaint = "the time must be 0 or more"}));
};
struct Say {
    std::string text;  // stands above the mechanism until something else does; empty: nothing
    static constexpr auto said =
        Said("say", "write: say \"a sentence\", or: say \"\"", Change::view, Field(&Say::text, in_quotes));
};
inline const std::vector<std::string> highlighted_panels{"bar",   "controls", "energy", "events", "mechanism", "none",
                                                         "plots", "results",  "status", "sweep",  "timeline"};
struct Highlight {
    std::string panel;  // that a tour's words are about: a frame stands around it until something else is said
    static constexpr auto said = Said("highlight", "write: highlight plots, or: highlight none", Change::view,
                                      Field(&Highlight::panel, {.one_of = &highlighted_panels,
                                                                .known = "these can be highlighted: {}",
                                                                .complaint = "there is no panel '{}'{}"}));
};
struct Replay {
    std::string journal;  // a path, or the name of one of the assets
    static constexpr auto said = Said("replay", "write: replay JOURNAL; put a path with spaces in double quotes",
                                      Change::view, &Replay::journal);
};

// These ask more of the present run than the run itself.
struct ShowSweep {
    std::string text;  // as on the command line, but for --set and the options: these are what the session has
    static constexpr auto said = Said("sweep", "write: sweep \"--over e=0:0.95:512 --print zeno_time(1)\"",
                                      Change::view, Field(&ShowSweep::text, in_quotes));
};
struct StopProof {  // and forgets what was proved
    static constexpr auto said = Said("prove off", alone, Change::view);
};
struct Prove {
    double width = 0.0;                  // half, for all coordinates and rates of the start
    std::vector<std::string> intervals;  // NAME=LOW..HIGH, which hold what the present run has
    static constexpr auto said =
        Said("prove", "write: prove [width W] [NAME=LOW..HIGH ...], or: prove off", Change::view,
             Field(&Prove::width, length_after("width")), Field(&Prove::intervals, {.may_lack = true}));
};
struct StopOrbit {  // and forgets what was found
    static constexpr auto said = Said("orbit off", alone, Change::view);
};
struct FindOrbit {
    std::string text;  // as on the command line, but for --set and the options: these are what the session has
    static constexpr auto said =
        Said("orbit", "write: orbit \"--from start --continue e=0.1:0.9\", orbit \"\", or: orbit off", Change::view,
             Field(&FindOrbit::text, in_quotes));
};
struct GoOnOrbit {
    int point = 1;  // of the branch, or 1: the run begins there, with its parameters
    static constexpr auto said = Said("branch", "write: branch NUMBER, a point of the branch that `orbit` has followed",
                                      Change::together, &GoOnOrbit::point);
};
struct ShowDependence {
    std::string quantity;  // an expression as a sweep prints it
    static constexpr auto said =
        Said("depend", "write: depend \"zeno_time(2)\", or another expression in the end and the events of a run",
             Change::view, Field(&ShowDependence::quantity, in_quotes));
};

}  // namespace command

// In the order in which they are listed.
using AnyCommand =
    std::variant<command::Open, command::Set, command::UseOption, command::Seek, command::Play, command::Pause,
                 command::Select, command::New, command::Text, command::Save, command::Show, command::DefaultPlane,
                 command::ShowPlane, command::ShowSweep, command::StopProof, command::Prove, command::ShowDependence,
                 command::StopOrbit, command::FindOrbit, command::GoOnOrbit, command::Find, command::Grid,
                 command::PlotView, command::Zoom, command::Fit, command::Range, command::AxisScale, command::ShowCurve,
                 command::Link, command::Start, command::LookAll, command::Look, command::Camera, command::Speed,
                 command::Loop, command::Step, command::Undo, command::Redo, command::Pin, command::UnpinAll,
                 command::Unpin, command::ShowPinned, command::Recall, command::PlotDifference, command::Lens,
                 command::UseTheme, command::Enlarge, command::Present, command::Size, command::Reset, command::Done,
                 command::Export, command::Copy, command::Wait, command::Say, command::Highlight, command::Replay>;
// A variant that is copied, moved and destroyed in command.cpp alone: it would take the compiler seconds in every file
// that holds one.
struct Command : AnyCommand {
    using AnyCommand::AnyCommand;
    Command(const Command& other);
    Command(Command&& other) noexcept;
    Command& operator=(const Command& other);
    Command& operator=(Command&& other) noexcept;
    ~Command();
};

// One line, without its end; numbers in the shortest form that reads back the same.
std::string to_text(const Command& command);

// Reads one line. Throws InputError that names file, line and column. A line must hold a command: see parse_journal.
Command parse_command(std::string_view text, const std::string& file = "<command>", int line = 1);

// How all are written, a line each.
std::vector<std::string> command_usages();

command::Change change_of(const Command& command);
// Whether a command goes on with the change that the last one made: the same slider, the same plot.
bool goes_on(const Command& last, const Command& next);

// The error of a command that is refused. It names no file, because the user gave the command. The hint says what would be
// right; it may be empty.
inline InputError refusal(const std::string& message, const std::string& hint = {}) { return {{}, {}, message, hint}; }

// A journal asks for what it may not do. None of its commands has been performed. A refused command is reported and the
// session goes on; this error also ends the making of a picture.
struct Forbidden : InputError {
    using InputError::InputError;
    std::vector<std::string> wants;  // the results of want(), each once, if the user may allow the access to files
};

// Calls `perform`. An InputError of it becomes the refusal of a Command, with its usage as the hint; Forbidden stays what it is.
template <class Command, class Perform>
auto or_refuse(Perform perform) {
    try {
        return perform();
    } catch (const Forbidden&) {
        throw;
    } catch (const InputError& problem) {
        throw refusal(problem.what(), std::string(Command::said.usage));
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
