// Bodies, grounds, springs and forces of a system file, read and placed; their energies and forces, the gaps and slips
// between them, and their drawings. expand.cpp puts these into the file in place of the bodies.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "expression/parse.hpp"
#include "system/description.hpp"
#include "system/fields.hpp"
#include "system/planar.hpp"
#include "system/read_tables.hpp"

namespace achilles {

struct LocalPoint {
    ProductSum x, y;
};

enum class TouchShape { none, rod, disc, ring, box, polygon, line, curve };

struct PlacedShape;

// The coordinates and parameters of a file as symbols of a graph, with their values at the start of the file.
class MechanismSymbols {
 public:
    // `contacts`: the names in held(NAME).
    MechanismSymbols(const SystemDescription& system, const std::vector<std::string>& contacts);

    enum class Allowed { constants, constants_and_time, positions, rates, curve };  // curve: x, t and parameters
    const Scope& scope(Allowed allowed) const { return scopes_[static_cast<std::size_t>(allowed)]; }
    std::string text(const ProductSum& sum) const { return writer_->text(sum); }
    // NaN if a value is missing or undefined.
    double at_start(const ProductSum& sum) const;
    bool is_constant(const ProductSum& sum) const;  // depends on parameters only
    bool depends_on_coordinates(const ProductSum& sum) const { return sum.depends_on(kinematics_->coordinates()); }
    bool depends_on_time(const ProductSum& sum) const;
    const Kinematics& kinematics() const { return *kinematics_; }
    Graph& graph() const { return *graph_; }
    std::uint32_t abscissa() const { return abscissa_; }  // the symbol x of a curve
    // The root of a sum of squares; the root of one square is its base, with the sign that makes it positive at the start.
    ProductSum positive_root(const ProductSum& square) const;
    // The unit vector along a line or rod, from its first corner to its second, and its angle.
    LocalPoint direction(const PlacedShape& shape) const;
    ProductSum angle_of(const LocalPoint& direction) const;
    ProductSum number(long top, long bottom = 1) const { return ProductSum::number(*graph_, top, bottom); }

 private:
    std::unique_ptr<Graph> graph_;
    std::unique_ptr<Kinematics> kinematics_;
    std::uint32_t abscissa_ = 0;
    std::vector<double> start_;  // by slot
    Scope scopes_[5];
    std::unique_ptr<ProductSumWriter> writer_;
};

// What bodies and grounds have in common: a place with named points.
struct PlacedShape {
    std::string name;
    bool is_ground = false;
    Location at, name_at;
    MovingFrame frame;
    TouchShape shape = TouchShape::none;
    std::vector<LocalPoint> corners;           // rod, line: its two ends; box: four; polygon: all
    ProductSum radius;                         // disc, ring
    LocalPoint size;                           // box
    std::map<std::string, LocalPoint> points;  // all names but x, y, angle
    TomlValue color, width;                    // kind table: not given
    bool is_hidden = false;
};

struct RigidBody : PlacedShape {
    ProductSum mass, inertia;  // about the center of mass
    LocalPoint center;
    const PlacedShape* on = nullptr;  // may be a ground
    // The angle of another body or of the world, if its origin is a point there, about which it turns.
    std::optional<ProductSum> joint;
    ProductSum height, along;  // on a ground: the distance of its origin, and its velocity along the tangent
    std::string placement;     // for the summary: "at hip, rotated by `theta`"
    std::string how;           // "uniform rod"; "" if mass or inertia are as typed
};

struct GroundSurface : PlacedShape {
    Expression height;  // curve: f(x) of the abscissa and time
    std::array<Text, 2> over;
    ProductSum speed;                 // of its surface along the tangent
    const PlacedShape* on = nullptr;  // the body that carries it
};

// A point as typed, with the body that carries it.
struct NamedPoint {
    MovingPoint point;
    const PlacedShape* carrier = nullptr;  // null: the world
    std::string name;                      // as typed, for messages
    bool is_whole = false;                 // the name of a body alone
    Location at;
};

struct SpringOrDamper {
    bool is_damper = false, is_hidden = false;
    std::optional<std::array<NamedPoint, 2>> between;
    ProductSum angle, coefficient, rest;
    Location at;
};

// A force at a point or a torque on a body, with the point or body that takes the opposite one.
struct AppliedLoad {
    std::optional<NamedPoint> point, against_point;       // force
    const RigidBody *body = nullptr, *against = nullptr;  // torque
    MovingFrame axes;                                     // of the force
    LocalPoint force;
    ProductSum torque;
    Location at;
};

// Reads and places what the tables say. Bodies are placed at first use, so they may stand in any order.
class PlacedMechanism {
 public:
    // Adds the mistakes of the tables.
    PlacedMechanism(const TomlValue& root, const SystemDescription& system, Names& names, ErrorCollector& mistakes);

    const MechanismSymbols& symbols() const { return symbols_; }
    // Those without mistakes, in the order of the file.
    std::vector<const RigidBody*> bodies() const { return placed(&Entry::body); }
    std::vector<const GroundSurface*> grounds() const { return placed(&Entry::ground); }
    std::array<ProductSum, 2> gravity;
    std::vector<SpringOrDamper> springs;  // and dampers, in the order of the file
    std::vector<AppliedLoad> loads;
    Location gravity_at;

    // An expression with values such as thigh.end.x replaced by their text. The name `own` is kept, or replaced by
    // own_value. Throws Mistake.
    Text substituted(const Text& text, const std::string& own = "", const std::string& own_value = "");
    // `own` is a name that stands for the abscissa.
    ProductSum read(const Text& text, MechanismSymbols::Allowed allowed, const std::string& own = "");
    // A point [x, y] or a name, in the axes of a body or ground (null: the world). Throw Mistake.
    NamedPoint read_point(const TomlValue& value, const Fields& fields, std::string_view key, PlacedShape* on,
                          const std::string& own = "");
    // A body or ground by its name; null for the world. Throws Mistake.
    PlacedShape* find(const Text& name);
    // The point of a name such as thigh.end. Throws Mistake.
    NamedPoint find_point(const Text& name, PlacedShape* on);
    // Throws Mistake, at a place, if a line or rod that is touched turns in its axes: the slip leaves that out.
    void check_direction(const PlacedShape& shape, const Location& at) const;
    // True if two points are on one body and do not move in it.
    bool is_rigid(const NamedPoint& a, const NamedPoint& b) const;
    static bool is_world(const std::string& name) { return name == "world"; }

 private:
    using Allowed = MechanismSymbols::Allowed;
    struct Entry {
        Fields fields;
        std::unique_ptr<RigidBody> body;  // one of the two
        std::unique_ptr<GroundSurface> ground;
        bool has_unknown_keys;  // they are reported, and what follows from them is not
        enum class State { unseen, on_the_way, done, failed } state = State::unseen;
        PlacedShape& shape() const { return body ? static_cast<PlacedShape&>(*body) : *ground; }
    };
    template <class Shape>
    std::vector<const Shape*> placed(std::unique_ptr<Shape> Entry::*shape) const {
        std::vector<const Shape*> list;
        for (const Entry& entry : entries_)
            if (entry.*shape && entry.state == Entry::State::done) list.push_back((entry.*shape).get());
        return list;
    }
    void list_names(const TomlValue& root, const char* key);
    void read_world(const TomlValue& root);
    void read_springs(const TomlValue& root, const char* key);
    void read_loads(const TomlValue& root, const char* key);
    void read_force(AppliedLoad& load, const Fields& fields);
    void read_torque(AppliedLoad& load, const Fields& fields);
    Entry* entry_of(const std::string& name);
    void place(Entry& entry);
    void place_body(RigidBody& body, const Fields& fields);
    std::optional<ProductSum> joint_of(const RigidBody& body, const NamedPoint& origin) const;
    void place_ground(GroundSurface& ground, const Fields& fields);
    void place_on_ground(RigidBody& body, const Fields& fields, const GroundSurface& ground);
    void place_on_curve(RigidBody& body, const LocalPoint& place, const GroundSurface& curve);
    bool is_zero_at_start(const LocalPoint& vector) const;
    void read_shape(PlacedShape& shape, const Fields& fields);
    void read_mass(RigidBody& body, const Fields& fields);
    ProductSum spread_mass(RigidBody& body) const;
    void read_points(PlacedShape& shape, const Fields& fields);
    LocalPoint read_local(const TomlValue& value, const Fields& fields, std::string_view key,
                          MechanismSymbols::Allowed allowed, const std::string& own = "");
    ProductSum read_positive(const Fields& fields, std::string_view key, const TomlValue& value, bool may_be_zero);
    ProductSum value_of(const std::string& token, const Location& at);
    PlacedShape* on_of(const Fields& fields);
    [[noreturn]] void refuse_unknown(const Text& name) const;

    MechanismSymbols symbols_;
    Names& names_;
    ErrorCollector& mistakes_;
    std::vector<Entry> entries_;
    PlacedShape world_;
    bool are_names_complete_ = true;  // false: a name could not be read, so no name is reported as unknown
    std::vector<std::string> way_;    // names of the bodies that are being placed
    const SystemDescription& system_;
};

// The names in an expression with the parts after their dots and with their primes, such as thigh.end.x', as pieces of
// the text.
std::vector<std::string_view> dotted_names_in(std::string_view text);

// The two items of an array. Throws Mistake, which says what is expected.
const std::vector<TomlValue>& two_items(const Fields& fields, std::string_view key, const TomlValue& value,
                                        std::string_view expected);

inline constexpr std::string_view closed_loop_advice =
    "for a closed loop choose coordinates that close the loop, or use a stiff spring";

// Makes a part of a mechanism, such as "the place of 'thigh'", from the table at `at`. Adds its mistakes; a division by
// zero and an expression that is too large are mistakes of the table. Returns true if there are none.
template <class Make>
bool attempt_part(ErrorCollector& mistakes, const Location& at, const std::string& part, const Make& make) {
    return mistakes.attempt([&] {
        try {
            make();
        } catch (const std::domain_error& problem) {
            throw Mistake{at, part + " has a " + problem.what(), {}};
        } catch (const ExpressionTooLarge& problem) {
            throw Mistake{at, part + " is too large: " + problem.what(), {}};
        }
    });
}

// ---- energies and forces (mechanism_terms.cpp) ----
//
// With p_i = dp/dq_i and p_t = dp/dt of the center of mass of each body, and w_i and w_t of its angle:
//     M_ij = sum m p_i.p_j + J w_i w_j,   c_i = sum m p_i.p_t + J w_i w_t,   T0 = sum m/2 p_t^2 + J/2 w_t^2
//     kinetic = 1/2 v'M v,   potential = sum -m gravity.p - T0 + springs
//     force_i = dp/dq_i.F + da/dq_i tau - dc_i/dt - sum_k (dc_i/dq_k - dc_k/dq_i) v_k

struct DerivedTerm {
    ProductSum value;
    Location at;  // the table that it is made from
};

struct MechanismTerms {
    DerivedTerm kinetic;
    std::vector<DerivedTerm> potential, dissipation;
    std::vector<std::vector<DerivedTerm>> forces;  // one list for each coordinate
    bool is_prescribed = false;                    // time moves a mass
};

// Adds the mistakes that show up here: a coordinate that moves no mass, inertia that depends on time, and springs,
// dampers and loads that act on no coordinate.
MechanismTerms derive_terms(const PlacedMechanism& mechanism, const SystemDescription& system,
                            ErrorCollector& mistakes);

// The distance between two points, and its rate.
struct PointDistance {
    ProductSum value, rate;
    bool is_signed = false;  // the points stay on one line: positive at the start, and kept when they pass each other
};
// Throws Mistake if the points are always together.
PointDistance distance_between(const PlacedMechanism& mechanism, const NamedPoint& from, const NamedPoint& to,
                               bool may_be_signed, const Location& at);

// ---- gaps and slips of contacts between shapes (contact_geometry.cpp) ----
//
// The gap is the distance of what touches from what is touched, except on a curve. The slip is the tangential velocity of
// the point of what touches that is nearest, minus that of the touched body at the same place. The tangent is the normal
// (towards what touches) turned right. The slip is scaled like the gap.

struct ShapeContact {
    ProductSum gap, slip;
    ProductSum scale;                      // gap and slip are a distance and a velocity times this factor; 0 means 1
    bool has_slip = true;                  // false: a string
    std::string name;                      // "shank.end on floor"
    std::string force;                     // what lambda is: "a distance: lambda is the force"
    std::string behind, hint;              // message and advice for a negative gap at the start; {} is its size
    const PlacedShape* touches = nullptr;  // null: a point of the world
    const PlacedShape* touched = nullptr;  // null: a string, or a point of the world
    NamedPoint point;                      // what touches: a point, or the center of a disc
    std::optional<NamedPoint> other;       // string: its other end
    ProductSum longest;                    // string: its length
};

// The geometry of a [[constraint]] with `between`. Throws Mistake.
ShapeContact read_contact(PlacedMechanism& mechanism, const Fields& fields);

// ---- drawings of bodies, springs, grounds and contacts, as [[drawing]] tables of the file (mechanism_drawings.cpp) ----

// Tables that the reader makes, with the location of their origin.
TomlValue made_string(std::string text, const Location& at);
TomlValue made_number(double number, const Location& at);
TomlValue made_boolean(bool boolean, const Location& at);
TomlValue made_list(const Location& at);  // empty
TomlValue made_point(const std::array<std::string, 2>& point, const Location& at);
TomlValue made_table(const Location& at);
TomlValue& set_entry(TomlValue& table, const std::string& key, TomlValue value);  // adds or replaces
TomlValue* find_entry(TomlValue& table, std::string_view key);

struct MechanismDrawings {
    std::vector<TomlValue> free;                      // [[drawing]]
    std::vector<std::vector<TomlValue>> of_contacts;  // [[constraint.drawing]], by contact
};

// `contacts` has an empty entry for a constraint with a typed gap.
MechanismDrawings draw_mechanism(const PlacedMechanism& mechanism,
                                 const std::vector<std::optional<ShapeContact>>& contacts);

// The coordinates in the world of a point of a frame, as text.
std::array<std::string, 2> world_point(const MechanismSymbols& symbols, const MovingPoint& point);

}  // namespace achilles
