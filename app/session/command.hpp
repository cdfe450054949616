// Everything a user can do, as a value with a text form: a journal is a list of these, a line each.
//
//     open ball_on_sine        set g 9.81         set x' 1.5         end 20        tolerance 1e-10
//     eps 1e-6                 eps 1e-6 1e-6 1e-7 (position, velocity, time)
//     conditions paper         reinitialization kinetic
//     seek 3.2                 play               pause              select 25
//     new                      text "title = \"A ball\"\n..."          show editor        hide editor
//     save mine.toml           save mine.toml overwrite
//     grid 3 2 (columns, rows) plot 1 t y gap     plot 2 x "x'^2 + y'^2"      link off
//     start x 0.3 x' 1.5       look 2 0.5 8 (middle, width)   look all    speed 0.1    loop on     step -1
//     undo   redo              pin    unpin       lens 3 (10^-3 s before the Zeno point at its left edge)
//     zoom 1 0 5 -1 2.5        fit 1     range 1 x 0 5     log 1 y on    curve 1 2 off
//     method dopri5            max-impacts 1000   max-steps 100000
//     export ball.svg          export run.json overwrite (.svg, .png the plots; .json, .csv the run; .journal all)
//     copy figure              copy run           copy explorer (the command line that makes it, to the clipboard)
//     say "Look at the ball."  wait 2.5 (s; passes at once without a window)         replay the_ball
//     theme dark               hide plots         size controls 0.3 (a share of the window)   size events auto
//     reset (every value and option as the file has it)     done (what follows is another change)
//
// Values are in the file's units, angles in radians; words.hpp tells how words with spaces are written.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "system/description.hpp"

namespace achilles {

namespace command {

struct Open {
    std::string system;  // a path, or the name of one of the assets
    friend bool operator==(const Open&, const Open&) = default;
};
struct Set {
    std::string name;  // a parameter, a coordinate x, or a rate x'
    double value = 0.0;
    friend bool operator==(const Set&, const Set&) = default;
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
    double time = 0.0;  // s; beyond the run: its end
    friend bool operator==(const Seek&, const Seek&) = default;
};
struct Play {
    friend bool operator==(const Play&, const Play&) = default;
};
struct Pause {
    friend bool operator==(const Pause&, const Pause&) = default;
};
struct Select {
    int event = 0;  // its number in the list, from 1; the time moves to it. 0: none
    friend bool operator==(const Select&, const Select&) = default;
};

struct New {  // a system to start from
    friend bool operator==(const New&, const New&) = default;
};
struct Text {
    std::string text;  // of the whole system file, as the editor holds it
    friend bool operator==(const Text&, const Text&) = default;
};
struct Save {
    std::string file;        // what the editor holds goes there
    bool overwrite = false;  // whatever file may be there; else only the one that was opened or saved before
    friend bool operator==(const Save&, const Save&) = default;
};
inline const std::vector<std::string> shown_things{"controls", "editor", "events", "force",
                                                   "lens",     "plots",  "trail",  "velocity"};
struct Show {
    std::string what;  // a panel: editor (in place of the sliders), controls, plots, events; or trail, velocity, force
    bool on = true;
    friend bool operator==(const Show&, const Show&) = default;
};

inline const std::vector<std::string> sized_panels{"controls", "editor", "events", "plots"};
struct Size {
    std::string panel;   // the editor in place of the controls has a width of its own
    double share = 0.0;  // of the window's width, for events of its height; 0: as it fits
    friend bool operator==(const Size&, const Size&) = default;
};
struct UseTheme {
    bool dark = false;
    friend bool operator==(const UseTheme&, const UseTheme&) = default;
};

struct Reset {  // every value and option as the file has it
    friend bool operator==(const Reset&, const Reset&) = default;
};
struct Done {  // with this change: what follows is another one, be it of the same value
    friend bool operator==(const Done&, const Done&) = default;
};
struct Start {  // several values at once: the run in between might be none
    std::vector<std::pair<std::string, double>> values;
    friend bool operator==(const Start&, const Start&) = default;
};
struct Look {
    double x = 0.0, y = 0.0, width = 1.0;  // of the world: the middle of the picture, and how much of it is seen
    friend bool operator==(const Look&, const Look&) = default;
};
struct LookAll {
    friend bool operator==(const LookAll&, const LookAll&) = default;
};
constexpr double slowest = 1e-3, fastest = 10.0;
struct Speed {
    double value = 1.0;  // seconds of the run in one of the player's, slowest to fastest
    friend bool operator==(const Speed&, const Speed&) = default;
};
struct Loop {
    bool on = true;  // at the end the player begins again
    friend bool operator==(const Loop&, const Loop&) = default;
};
struct Step {
    int events = 1;  // to the next event, or with -1 the one before
    friend bool operator==(const Step&, const Step&) = default;
};

// The plots count from 1, row by row.
struct Grid {
    int columns = 1, rows = 1;
    friend bool operator==(const Grid&, const Grid&) = default;
};
struct PlotView {
    int plot = 1;
    std::string x;  // expressions, as in a view
    std::vector<std::string> y;
    friend bool operator==(const PlotView&, const PlotView&) = default;
};
struct Zoom {
    int plot = 1;
    double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;  // in the units that are shown
    friend bool operator==(const Zoom&, const Zoom&) = default;
};
struct Range {  // of one axis; the other stays as it is
    int plot = 1;
    bool is_x = true;
    double low = 0.0, high = 1.0;
    friend bool operator==(const Range&, const Range&) = default;
};
struct Fit {
    int plot = 1;
    friend bool operator==(const Fit&, const Fit&) = default;
};
struct AxisScale {
    int plot = 1;
    bool is_x = true, logarithmic = false;
    friend bool operator==(const AxisScale&, const AxisScale&) = default;
};
struct ShowCurve {
    int plot = 1, curve = 1;
    bool shown = true;
    friend bool operator==(const ShowCurve&, const ShowCurve&) = default;
};
struct Link {
    bool on = true;  // all plots over time show the same time
    friend bool operator==(const Link&, const Link&) = default;
};

struct Undo {
    friend bool operator==(const Undo&, const Undo&) = default;
};
struct Redo {
    friend bool operator==(const Redo&, const Redo&) = default;
};
struct Pin {
    bool on = true;  // the present run stays beside those that follow
    friend bool operator==(const Pin&, const Pin&) = default;
};
struct Lens {
    double from = 0.0;  // -log10 of the time left at the left edge of the Zeno lens
    friend bool operator==(const Lens&, const Lens&) = default;
};
struct Export {
    std::string file;        // what goes there, its ending tells
    bool overwrite = false;  // whatever file may be there
    friend bool operator==(const Export&, const Export&) = default;
};
inline const std::vector<std::string> copied_things{"explorer", "figure", "run"};
struct Copy {
    std::string what;  // one of copied_things: the command line that makes it goes to the clipboard
    friend bool operator==(const Copy&, const Copy&) = default;
};

// What makes a journal a tour.
struct Say {
    std::string text;  // stands above the mechanism until something else does; empty: nothing
    friend bool operator==(const Say&, const Say&) = default;
};
struct Wait {
    double seconds = 0.0;  // for somebody to look; a run that plays goes on meanwhile
    friend bool operator==(const Wait&, const Wait&) = default;
};
struct Replay {
    std::string journal;  // a path, or the name of one of the assets
    friend bool operator==(const Replay&, const Replay&) = default;
};

}  // namespace command

using AnyCommand =
    std::variant<command::Open, command::Set, command::UseOption, command::Seek, command::Play, command::Pause,
                 command::Select, command::New, command::Text, command::Save, command::Show, command::Grid,
                 command::PlotView, command::Zoom, command::Fit, command::AxisScale, command::ShowCurve, command::Link,
                 command::Start, command::Look, command::LookAll, command::Speed, command::Loop, command::Step,
                 command::Undo, command::Redo, command::Pin, command::Lens, command::Size, command::UseTheme,
                 command::Reset, command::Done, command::Export, command::Copy, command::Range, command::Say,
                 command::Wait, command::Replay>;
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

}  // namespace achilles
