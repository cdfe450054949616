// The contents of a system file, read but not yet derived. Every error states file, line and column, and suggests a
// correction.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../run/mode.hpp"
#include "../run/options.hpp"
#include "input_error.hpp"

namespace achilles {

struct CoordinateDescription {
    std::string name, unit;
    double start = 0.0, rate = 0.0;
    Text force;                                                     // generalized force; empty: none
    std::array<double, 2> range{-1.0, 1.0}, rate_range{-1.0, 1.0};  // of its sliders
    bool has_range = false, has_rate_range = false;                 // given in the file
    Location at, start_at, rate_at;
};

struct ParameterDescription {
    std::string name, unit, about;
    double value = 0.0;
    std::array<double, 2> range{0.0, 1.0};
    bool has_range = false;  // given in the file
    Location at;
};

// A parameter defined by other parameters; a run cannot set it.
struct DerivedDescription {
    std::string name, unit, about;
    Text definition;
};

struct DrawingDescription {
    enum class Shape { disc, circle, box, segment, spring, damper, ground, curve, polyline, text };
    Shape shape = Shape::disc;
    std::vector<std::array<Text, 2>> points;  // at; or from, to; or points
    Text radius;                              // disc, circle
    std::vector<Text> sizes;                  // box: width, height, angle; spring: coils, across; damper: across
    std::string over;                         // curve: its variable and its limits
    std::array<Text, 2> over_limits;
    std::string text;   // text
    std::string color;  // "#rrggbb" or ""
    Text width;         // stroke width; empty: default
    bool fill = false;
    std::optional<std::size_t> contact;  // the constraint that contains this drawing: what is touched
    Location at;
};

// True for a disc or a circle.
inline bool is_round(DrawingDescription::Shape shape) {
    return shape == DrawingDescription::Shape::disc || shape == DrawingDescription::Shape::circle;
}

// True for a shape with a center, which can be dragged.
inline bool is_body(DrawingDescription::Shape shape) {
    return is_round(shape) || shape == DrawingDescription::Shape::box;
}

// All expressions of a drawing: x and y of its points, then the radius of a disc or circle, the sizes or the limits of
// a curve, then the width if given.
std::vector<Text> texts_of(const DrawingDescription& drawing);

// What starts a jump or ends a latch: the impacts of a contact, or a zero of an expression.
struct Trigger {
    Text on;                             // the name of the contact, or the expression; empty: none
    std::optional<std::size_t> contact;  // empty: `on` is an expression
};

struct ConstraintDescription {
    std::string name;  // "contact" if a file with one constraint names none
    Text gap, restitution;
    std::string begins{}, ends{};  // sentences for the start and the end of contact: "knee locks"; may be empty
    std::vector<DrawingDescription> drawings;  // of the touched bodies, as written
    Location at;
    Text slip{};      // sliding velocity, scaled like the gap; may be empty. Only friction uses it
    Text friction{};  // Coulomb coefficient while sliding; `slip` in it is the sliding speed. Empty: no friction
    std::optional<Text> static_friction{};  // default: friction at slip 0
    bool never_slides = false;              // friction = "inf"
    Text when{};                            // a closing gap is a contact only where this is positive; empty: always
    Trigger latch{};  // what ends its latch: another contact, or an expression that rises through zero

    bool has_friction() const { return !friction.text.empty(); }
};

// Dry friction without a gap: a bearing, a guide, a belt.
struct FrictionDescription {
    std::string name;
    Text slip, level;                  // level: the friction force while sliding; `slip` in it is the sliding speed
    std::optional<Text> static_level;  // default: level at slip 0
    Location at;
};
inline constexpr std::size_t max_frictions = 8;

// A jump of the state at an event (theory-modes.md 2).
struct JumpDescription {
    std::string name;
    Trigger on;  // right after the impacts of a contact, or where an expression falls through zero
    Text when;   // the jump happens only where this is positive; empty: always
    struct Assignment {
        std::size_t place;  // of the coordinate, or of its rate after all coordinates
        Text value;         // in terms of the state before the jump
    };
    std::vector<Assignment> set;
    Location at;
};
inline constexpr std::size_t max_jumps = 8;

struct ViewDescription {
    std::string name;
    Text x;
    std::vector<Text> y;
    std::string label{}, unit{};  // of the y axis; "": derived from y and the units of the file
};

// A periodic orbit, or an initial guess of one (theory-derivatives.md 9).
struct OrbitDescription {
    std::vector<double> q, v;            // at the start of the period, by coordinate
    std::optional<double> t;             // start time (s) for a driven system; default: start time of [run]
    Text period;                         // s, an expression in the parameters; may be empty
    std::vector<Text> shift;             // by coordinate: increment over a period; empty: zero
    std::optional<ContactSet> inactive;  // contacts that do not count at the start, as listed in the file
    Location at;
};

// What the reader understood of a mechanism's bodies (system/expand.hpp), for `check`; empty for typed energies.

// A line such as "thigh  {0}, {1} about its center; at hip", with expressions for the numbers in braces. Backquotes in it
// enclose expressions.
struct SummaryLine {
    std::string name, pattern;
    std::vector<std::string> values;
    std::vector<std::string> units = {};  // of the values; missing or "": that of the expression
};
// A contact between shapes, or an empty name for a typed gap.
struct SummaryContact {
    std::string name, gap, slip;  // "shank.end on floor"; slip is empty for a string
    std::string force;            // the meaning of lambda
    std::string behind, hint;     // message for a negative gap at the start, {} is its size, and advice
};
struct MechanismSummary {
    std::vector<SummaryLine> bodies, springs;
    std::vector<SummaryContact> contacts;  // one for each constraint if there are bodies
    bool has_signed_length = false;  // of a spring or damper, which goes on below 0 where its ends pass each other
    bool is_prescribed = false;      // a mass is moved by time: energy is T2 - T0 + V
};

struct SystemDescription {
    // Compiled once: each is thousands of instructions.
    SystemDescription();
    SystemDescription(const SystemDescription&);
    SystemDescription(SystemDescription&&) noexcept;
    SystemDescription& operator=(const SystemDescription&);
    SystemDescription& operator=(SystemDescription&&) noexcept;
    ~SystemDescription();

    std::string file;         // path as given; "<text>" for typed text
    std::string source_text;  // the whole file, to show lines in errors
    std::string title, source;
    std::vector<CoordinateDescription> coordinates;
    std::vector<ParameterDescription> parameters;  // those with values of their own
    std::vector<DerivedDescription> derived;       // each after those that its definition uses
    Text kinetic, potential;
    Text dissipation;                                // R: -dR/dv is added to the forces; may be empty
    std::vector<ConstraintDescription> constraints;  // may be empty: a smooth system
    std::vector<FrictionDescription> frictions;      // without a gap
    std::vector<JumpDescription> jumps;              // in the order of the file
    Options options;                                 // defaults overridden by [run] and [truncation]
    Location reinitialization_at;                    // of this option; line 0 if the file does not have it
    std::vector<DrawingDescription> drawings;        // as written; may be empty
    std::vector<ViewDescription> views;              // as written, or default_views()
    std::optional<OrbitDescription> orbit;
    MechanismSummary mechanism;

    bool has_friction() const;
    // Whether some contact counts only sometimes.
    bool has_conditional_contacts() const;
    // An error at a location in this file, with the line and a caret.
    InputError error(Location at, const std::string& message, const std::string& hint = {}) const;
};

// Maximum size of a file in bytes. Enough for polylines of thousands of points; a larger file is rejected at once.
inline constexpr std::size_t largest_file = std::size_t{4} << 20;

// The contents of a file. Throws InputError if it cannot be read. For a file larger than `largest`, returns a prefix
// that is too long for parse_system, which reports the size.
std::string read_text(const std::filesystem::path& file, std::size_t largest = largest_file);

// All drawings of a system, including those of the constraints, in the order of the file.
std::vector<DrawingDescription> drawings_of(const SystemDescription& system);

// The names that views use for a quantity of the constraints, such as gap'': the quantity itself, or for several
// constraints gap_knee'', gap_post'', in their order. Empty if there are no constraints.
std::vector<std::string> output_names(const SystemDescription& system, std::string_view quantity);

// One contact with friction or one [[friction]]: what they have in common.
struct SlidingPlace {
    std::string name;
    const Text *slip, *level;  // level: the coefficient of a contact
    const Text* static_level;  // null: level at slip 0
    std::size_t number;        // in a Mode: of the contact, or joint_number()
    bool never_slides;
};
// All of them: the contacts with friction in the order of the constraints, then [[friction]]. They point into `system`.
std::vector<SlidingPlace> sliding_places(const SystemDescription& system);
// The names that views use for a quantity of these: slip or friction_force, with several contacts or places slip_foot.
std::vector<std::string> sliding_names(const SystemDescription& system, std::string_view quantity);

// A description is never edited: values are changed in a run.

// The run with the values of the description.
Run default_run(const SystemDescription& description);
// Names that can be set: coordinates x, their rates x', parameters.
std::vector<std::string> settable_names(const SystemDescription& description);
// Pointer to the value with this name in a run; null if the name cannot be set.
double* find_value(const SystemDescription& description, Run& run, std::string_view name);
// The reason why a name cannot be set: it is derived, or unknown, with a suggestion.
std::string why_not_settable(const SystemDescription& description, std::string_view name);
// The unit of a coordinate's rate; "" if the coordinate has no unit.
std::string rate_unit(const std::string& unit);
// True for the unit of an angle or an angular rate, which can be shown in degrees.
inline bool is_of_angles(std::string_view unit) { return unit == "rad" || unit == "rad/s"; }
// The unit of a settable value, for a rate with "/s"; "" if unknown.
std::string unit_of(const SystemDescription& description, std::string_view name);
// Warnings, one sentence for each value outside the range given in the file.
std::vector<std::string> outside_ranges(const SystemDescription& description, const Run& run);
// Warnings, one sentence for each line too thin to see, whose width was probably meant in world units.
std::vector<std::string> unseen_lines(const SystemDescription& description);
// Sets "NAME=VALUE" like --set. Throws InputError without a location and leaves the run unchanged if it is invalid.
void assign(Run& run, const SystemDescription& description, std::string_view name_value);

// A run whose values are set by name, like --set.

class NamedRun : public Run {
 public:
    // The run with the values of the description.
    explicit NamedRun(const SystemDescription& description);

    // Sets a parameter, a coordinate x or its rate x' at the start; angles in rad. Throws InputError, with a
    // suggestion, if the name is unknown. Returns *this.
    NamedRun& set(std::string_view name, double value);
    // The value with this name. Throws like set().
    double get(std::string_view name) const;

 private:
    std::shared_ptr<const SystemDescription> description_;
};

}  // namespace achilles
