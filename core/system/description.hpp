// What a person writes: a system file, read but not yet derived. Every error says file, line, column and what would be
// right.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../run/options.hpp"
#include "input_error.hpp"

namespace achilles {

struct CoordinateDescription {
    std::string name, unit;
    double start = 0.0, rate = 0.0;
    Text force;                                                     // generalised; empty: none
    std::array<double, 2> range{-1.0, 1.0}, rate_range{-1.0, 1.0};  // of its sliders
    bool has_range = false, has_rate_range = false;                 // they stand in the file
    Location at, start_at, rate_at;
};

struct ParameterDescription {
    std::string name, unit, about;
    double value = 0.0;
    std::array<double, 2> range{0.0, 1.0};
    bool has_range = false;  // it stands in the file
    Location at;
};

// One whose value follows from other parameters: no run sets it.
struct DerivedDescription {
    std::string name, unit, about;
    Text definition;
};

struct DrawingDescription {
    enum class Shape { disc, circle, box, segment, spring, damper, ground, curve, polyline, text };
    Shape shape = Shape::disc;
    std::vector<std::array<Text, 2>> points;  // at, or from and to, or points
    Text radius;                              // disc, circle
    std::vector<Text> sizes;                  // box: width, height, angle; spring: coils, across; damper: across
    std::string over;                         // curve: its own parameter, and the limits
    std::array<Text, 2> over_limits;
    std::string text;   // text
    std::string color;  // "#rrggbb" or ""
    Text width;         // stroke width; empty: default
    bool fill = false;
    std::optional<std::size_t> contact;  // that is touched there: it stands in this constraint
    Location at;
};

// A disc, or its outline.
inline bool is_round(DrawingDescription::Shape shape) {
    return shape == DrawingDescription::Shape::disc || shape == DrawingDescription::Shape::circle;
}

// A thing with a middle, by which a hand takes it.
inline bool is_body(DrawingDescription::Shape shape) {
    return is_round(shape) || shape == DrawingDescription::Shape::box;
}

// Every expression of a drawing: x and y of its points, then a disc's or circle's radius, the sizes or a curve's limits, then
// the width if given.
std::vector<Text> texts_of(const DrawingDescription& drawing);

struct ConstraintDescription {
    std::string name;  // "contact" where the file gives none, which may have one constraint then
    Text gap, restitution;
    std::string begins{}, ends{};  // what a person says where contact begins and ends: "knee locks"; may be empty
    std::vector<DrawingDescription> drawings;  // of what is touched, as written
    Location at;
};

struct ViewDescription {
    std::string name;
    Text x;
    std::vector<Text> y;
    std::string label{},
        unit{};  // of the y axis, as it is shown; "": what y is, and the unit that follows from the file's
};

// A periodic run, or a guess of one (theory-derivatives.md 9).
struct OrbitDescription {
    std::vector<double> q, v;  // at the start of the period, by coordinate
    std::optional<double> t;   // s, then: of a drive; else the start time of [run]
    Text period;               // s, an expression in the parameters; may be empty
    std::vector<Text> shift;   // by coordinate: how far it has moved on after a period; empty: nowhere
    Location at;
};

struct SystemDescription {
    std::string file;         // as given; "<text>" for typed text
    std::string source_text;  // the whole file, for carets
    std::string title, source;
    std::vector<CoordinateDescription> coordinates;
    std::vector<ParameterDescription> parameters;  // with values of their own
    std::vector<DerivedDescription> derived;       // each after those that its definition names
    Text kinetic, potential;
    Text dissipation;  // R: minus its derivatives by the rates is added to the forces; may be empty
    std::vector<ConstraintDescription> constraints;  // at least one
    Options options;                                 // defaults overridden by [run] and [truncation]
    std::vector<DrawingDescription> drawings;        // as written; none is a valid answer
    std::vector<ViewDescription> views;              // as written, or default_views()
    std::optional<OrbitDescription> orbit;

    // An error at a place in this file, with the line and a caret.
    InputError error(Location at, const std::string& message, const std::string& hint = {}) const;
};

// The most bytes of a file: thousands of points of a polyline fit, and whatever else it holds is refused in a second.
inline constexpr std::size_t largest_file = std::size_t{4} << 20;

// What a file holds. Throws InputError if there is none to read. Of a file that is too large it is only so much that
// the size tells: parse_system will say so.
std::string read_text(const std::filesystem::path& file, std::size_t largest = largest_file);

// All that is drawn of a system, the constraints' drawings among the others, in the order of the file.
std::vector<DrawingDescription> drawings_of(const SystemDescription& system);

// What views call a quantity of the constraints, gap'' for one: itself, or where there are several gap_knee'', gap_post'',
// in their order.
std::vector<std::string> output_names(const SystemDescription& system, std::string_view quantity);

// A description is never edited: what a person sets is set in a run of it.

// The run that it asks for.
Run default_run(const SystemDescription& description);
// What a person may set: coordinates x and their rates x', parameters.
std::vector<std::string> settable_names(const SystemDescription& description);
// Where a run keeps the value of such a name; null if there is none.
double* find_value(const SystemDescription& description, Run& run, std::string_view name);
// Why there is none for another name: it is derived, or nothing; with what was probably meant.
std::string why_not_settable(const SystemDescription& description, std::string_view name);
// The unit of a coordinate's rate; "" where there is none.
std::string rate_unit(const std::string& unit);
// Whether it is that of an angle or of its rate: degrees may be shown.
inline bool is_of_angles(std::string_view unit) { return unit == "rad" || unit == "rad/s"; }
// The unit of such a name's value, a rate's with its "/s"; "" where it is not known.
std::string unit_of(const SystemDescription& description, std::string_view name);
// A sentence for each value outside the range that the file gives it: no mistake, but perhaps not what was meant.
std::vector<std::string> outside_ranges(const SystemDescription& description, const Run& run);
// A sentence for each line that is drawn too thin to be seen: its width was probably meant in the units of the world.
std::vector<std::string> unseen_lines(const SystemDescription& description);
// Assigns "NAME=VALUE" as --set does. Throws InputError without a location, and leaves the run as it is.
void assign(Run& run, const SystemDescription& description, std::string_view name_value);

// A run whose values are set by their names, as --set does.

class NamedRun : public Run {
 public:
    // The run that the description asks for.
    explicit NamedRun(const SystemDescription& description);

    // Sets a parameter, a coordinate x or its rate x' at the start; angles in rad. Throws InputError where there is no such name,
    // with what was probably meant. May be chained.
    NamedRun& set(std::string_view name, double value);
    // Its value. Throws as set() does.
    double get(std::string_view name) const;

 private:
    std::shared_ptr<const SystemDescription> description_;
};

}  // namespace achilles
