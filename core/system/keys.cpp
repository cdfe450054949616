#include "system/keys.hpp"

#include <algorithm>
#include <cassert>

#include "expression/name_suggestions.hpp"

namespace achilles {

std::span<const FileTable> file_tables() {
    static const std::vector<FileTable> tables{
        {"",
         {{"title", "text, the file's name", "the title in lists, windows and figures"},
          {"source", "text", "the source of the system, for example a paper"},
          {"coordinate", "tables, 1 to 8", "[[coordinate]], in the order of the components of q"},
          {"parameter", "tables", "[[parameter]]"},
          {"lagrangian", "table, needed without bodies", "[lagrangian]"},
          {"constraint", "tables, needed", "[[constraint]]: at most 16"},
          {"world", "table", "[world]: gravity and fixed points; from here to torque in place of [lagrangian]"},
          {"body", "tables", "[[body]]: the bodies, placed by the coordinates"},
          {"ground", "tables", "[[ground]]: lines, curves, discs and rings that are touched"},
          {"spring", "tables", "[[spring]]"},
          {"damper", "tables", "[[damper]]"},
          {"force", "tables", "[[force]]: a force at a point"},
          {"torque", "tables", "[[torque]]: a torque on a body"},
          {"run", "table", "[run]: options of a run; the command line overrides them"},
          {"view", "tables",
           "[[view]]: the plots; default: every coordinate and the gap over t, and the plane of the first two"},
          {"drawing", "tables", "[[drawing]]: the mechanism"},
          {"truncation", "table", "[truncation]: when an impact sequence is truncated"},
          {"orbit", "table", "[orbit]: a periodic orbit, or the initial guess of the search for one"},
          {"extra", "table", "[extra]: data of other programs; ignored"}}},
        {"[[coordinate]]",
         {{"name", "name, needed", "its rate is written with a prime: x'"},
          {"start", "number, 0", "q(0)"},
          {"rate", "number, 0", "q'(0)"},
          {"force", "expression, 0", "the generalized force, a function of coordinates, rates, t and parameters"},
          {"unit", "text",
           "for \"rad\" the explorer and the figures show degrees; values may be \"30 deg\", rates \"20 deg/s\""},
          {"range", "[low, high]", "range of the slider; a value outside causes a warning"},
          {"rate_range", "[low, high]", "the same for the rate"}}},
        {"[[parameter]]",
         {{"name", "name, needed", ""},
          {"value", "number, needed",
           "or an expression in other parameters: then it is a derived parameter, without a slider"},
          {"unit", "text", "as for a coordinate"},
          {"about", "text", "the description at its slider"},
          {"range", "[low, high]",
           "range of the slider, logarithmic if low > 0 and high/low >= 100; a value outside causes a warning"}}},
        {"[lagrangian]",
         {{"kinetic", "expression, needed",
           "T(q, q', t), quadratic in the rates; terms of degree 1 and 0 are prescribed motion"},
          {"potential", "expression, needed", "V(q, t)"},
          {"dissipation", "expression, 0", "R(q, q', t): the force -dR/dq' is added"}}},
        {"[[constraint]]",
         {{"name", "name", "needed if there are several; default: contact"},
          {"gap", "expression, needed",
           "h(q, t): positive while the contact is open; an impact occurs when it reaches 0"},
          {"between", "[what touches, what is touched]",
           "in place of gap: a point or a body with a disc; a ground, or a body with a rod, disc or ring"},
          {"longest", "expression", "with two points in between: the length of the string that joins them"},
          {"normal", "true or false", "on a curve: scales the gap so that lambda is the force; default: false"},
          {"slip", "expression",
           "sliding velocity, scaled like the gap; derived with between; no equation uses it yet"},
          {"restitution", "expression, needed", "e, a function of the parameters, from 0 (plastic) to 1 (elastic)"},
          {"begins", "text", "the text printed when contact begins, as in \"knee locks\""},
          {"ends", "text", "the text printed when it ends, as in \"knee opens\""},
          {"drawing", "tables", "[[constraint.drawing]]: the contact surface, with the keys of [[drawing]]"}}},
        {"[world]",
         {{"gravity", "[gx, gy], none", "functions of parameters and t"},
          {"points", "{name = [x, y], ...}", "fixed points, as in world.below"}}},
        {"[[body]]",
         {{"name", "name, needed", "thigh.x, thigh.y, thigh.angle and points such as thigh.end may be used everywhere"},
          {"at", "[x, y] or a point, the origin", "the place of its origin"},
          {"angle", "expression, 0", "counterclockwise, rad"},
          {"on", "a body or ground",
           "at and angle are in its axes; on a ground at = [s, d], the place along it and the distance from it"},
          {"mass", "expression, 0", "a function of the parameters; a body without mass is a frame"},
          {"rod", "[from, to]",
           "a thin rod; at most one shape, described at angle 0: it carries the mass, is drawn and touched"},
          {"disc", "radius", "a disc about the origin"},
          {"ring", "radius", "a thin ring about the origin, touched from inside"},
          {"box", "[w, h]", "a box about the origin, with full widths"},
          {"polygon", "[[x, y], ...]", "its corners, counterclockwise"},
          {"center", "[x, y]", "center of mass; default: of the shape, else the origin"},
          {"inertia", "expression", "about the center of mass; default: of the shape, else 0"},
          {"points", "{name = [x, y], ...}", "more points of the body"},
          {"color", "\"#rrggbb\"", "as in [[drawing]]"},
          {"width", "expression", "as in [[drawing]]"},
          {"hidden", "true or false", "whether it is not drawn; default: false"}}},
        {"[[ground]]",
         {{"name", "name, needed", ""},
          {"line", "[from, to]", "an infinite line, free on the left of from-to"},
          {"curve", "\"f(x)\"", "free above; a function of x, t and parameters"},
          {"over", "[low, high]", "curve: where it is drawn"},
          {"disc", "radius", "free outside"},
          {"ring", "radius", "free inside"},
          {"at", "[x, y] or a point, the origin", "center of a disc or ring"},
          {"on", "a body", "that carries it: a table, a conveyor"},
          {"speed", "expression, 0", "speed of its surface along the tangent"}}},
        {"[[spring]]",
         {{"between", "[point, point]", "its ends; either this or angle"},
          {"angle", "expression", "the angle of a torsion spring"},
          {"stiffness", "expression, needed", "k of k/2*(l - rest)^2"},
          {"rest", "expression, needed with between", "length without force, 0 allowed; of an angle: 0"},
          {"hidden", "true or false", "whether it is not drawn; default: false"}}},
        {"[[damper]]",
         {{"between", "[point, point]", "its ends; either this or angle"},
          {"angle", "expression", "the angle of a torsion damper"},
          {"damping", "expression, needed", "d of the force -d*l'"}}},
        {"[[force]]",
         {{"at", "[x, y] or a point, needed", "where it acts"},
          {"value", "[Fx, Fy], needed", "functions of coordinates, rates, t and parameters"},
          {"on", "a body", "at and value are in its axes, so the force turns with it"},
          {"against", "a point", "takes the opposite force"}}},
        {"[[torque]]",
         {{"on", "a body, needed", ""},
          {"value", "expression, needed", "a function of coordinates, rates, t and parameters, counterclockwise"},
          {"against", "a body", "takes the opposite torque"}}},
        {"[orbit]",
         {{"q", "[numbers], needed", "the coordinates at the start of the period"},
          {"v", "[numbers], needed", "the rates at the start of the period"},
          {"t", "number", "time at the start of the period, s, if there is a drive; default: start_time of [run]"},
          {"period", "expression",
           "the period, s, a function of the parameters: needed if there is a drive, otherwise a guess"},
          {"shift", "[expressions], 0", "the change of each coordinate over a period, a function of the parameters"}}},
        {"[[view]]",
         {{"name", "text, needed", "the name for --view"},
          {"x", "expression, needed",
           "a function of t, coordinates, rates, parameters, gap, gap', gap'', lambda, energy, work, loss, power"},
          {"y", "[expressions], needed", "the same; one curve for each expression"},
          {"label", "text", "label of the y axis; default: the expressions"},
          {"unit", "text", "unit of y; default: derived from the units of coordinates and parameters"}}},
        {"[[drawing]]",
         {{"shape", "word, needed", "one of the shapes below"},
          {"on", "a body", "points are in its axes; every point of a drawing may be a name such as \"thigh.end\""},
          {"color", "\"#rrggbb\"", "default: the color of the phase, or of fixed parts"},
          {"width", "expression", "line width, in pixels at scale 1; default: 2"},
          {"fill", "true or false", "whether the shape is filled; default: true for a disc or box, false for others"}}},
        {"disc", {{"at", "[x, y], needed", "center"}, {"radius", "expression, needed", ""}}},
        {"circle",
         {{"at", "[x, y], needed", "center"}, {"radius", "expression, needed", "radius of the circle (outline only)"}}},
        {"box",
         {{"at", "[x, y], needed", "center"},
          {"size", "[w, h], needed", "width and height along its own axes"},
          {"angle", "expression, 0", "counterclockwise rotation, rad"}}},
        {"segment", {{"from", "[x, y], needed", ""}, {"to", "[x, y], needed", ""}}},
        {"spring",
         {{"from", "[x, y], needed", ""},
          {"to", "[x, y], needed", ""},
          {"coils", "expression", "number of coils; default: chosen from the length at the start"},
          {"across", "expression", "width across; default: chosen automatically, constant as the spring stretches"}}},
        {"damper",
         {{"from", "[x, y], needed", "the end with the cup"},
          {"to", "[x, y], needed", "the end with the piston"},
          {"across", "expression", "as for a spring"}}},
        {"ground",
         {{"from", "[x, y], needed", "start of a line with hatching on its right-hand side"},
          {"to", "[x, y], needed", "end of the line"}}},
        {"curve",
         {{"at", "[x, y], needed", "expressions that may contain the curve parameter"},
          {"over", "[\"s\", low, high], needed", "the curve parameter and its limits"}}},
        {"polyline", {{"points", "[[x, y], ...], needed", ""}}},
        {"text", {{"at", "[x, y], needed", ""}, {"text", "text, needed", ""}}}};
    return tables;
}

std::string other_key(std::string_view word, const std::vector<std::string>& keys) {
    struct KeyAlias {
        std::string_view key,
            words;  // names in other programs; the first entry with a key from `keys` counts
    };
    static constexpr KeyAlias others[] = {
        {"gap", "h distance g phi condition expression height clearance"},
        {"restitution", "e cor bounce epsilon coefficient eps"},
        {"kinetic", "T kinetic_energy T_kin ke KE Ekin"},
        {"potential", "V U potential_energy PE Epot"},
        {"dissipation", "R damping rayleigh D"},
        {"force", "Q forces tau torque generalized_force input u control"},
        {"rate", "velocity speed v v0 initial_velocity qdot dot rate0 start_rate x_dot y_dot"},
        {"start", "q0 x0 y0 initial init initial_value initial_position position"},
        {"value", "default val"},
        {"range", "min max limits bounds lower upper"},
        {"about", "description comment doc tooltip"},
        {"title", "name"},
        {"name", "title id symbol label"},
        {"label", "ylabel"},
        {"at", "position center centre pos xy"},
        {"shape", "type kind"},
        {"radius", "r"},
        {"width", "linewidth thickness lw"},
        {"from", "start p1 a"},
        {"to", "end p2 b"},
        {"end_time", "t_end tend T t_final duration tmax t_stop stop_time end"},
        {"start_time", "t_start t0 start"},
        {"tolerance", "rtol atol tol abstol reltol"},
        {"method", "solver integrator"},
        {"eps_q", "eps"},
        {"run", "options simulation settings solver experiment"},
        {"parameter", "params constants"},
        {"coordinate", "variable state states dof generalized_coordinate initial initial_conditions"},
        {"constraint", "contact collision impact guard unilateral"},
        {"view", "plot figure"},
        {"drawing", "graphics geometry visual"},
        {"lagrangian", "energy dynamics lagrange"}};
    for (const KeyAlias& other : others) {
        const bool is_here = std::find(keys.begin(), keys.end(), other.key) != keys.end();
        if (is_here && has_word(other.words, word)) return std::string(other.key);
    }
    return "";
}

std::string_view instead_of_key(std::string_view word) {
    struct KeyAdvice {
        std::string_view words, instead;
    };
    static constexpr KeyAdvice others[] = {
        {"friction mu mu_s mu_k friction_coefficient", "contacts have no friction here: leave it out"},
        {"gravity g", "gravity is a part of the potential, as m*g*y, with a [[parameter]] g"},
        {"stiffness k c contact_stiffness", "contacts are rigid: a spring belongs to the potential, as k/2*x^2"},
        {"mass m inertia", "a mass is a part of the kinetic energy, as m/2*x'^2, with a [[parameter]] m"},
        {"dt step step_size timestep h max_step", "the step follows from the tolerance in [run]"}};
    for (const KeyAdvice& other : others)
        if (has_word(other.words, word)) return other.instead;
    return "";
}

std::vector<std::string> keys_of(std::string_view heading) {
    const auto all = file_tables();
    const auto table = std::find_if(all.begin(), all.end(), [&](const FileTable& t) { return t.heading == heading; });
    assert(table != all.end());
    std::vector<std::string> names;
    for (const FileKey& key : table->keys) names.emplace_back(key.name);
    return names;
}

}  // namespace achilles
