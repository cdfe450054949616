#include "system/keys.hpp"

#include <algorithm>
#include <cassert>

#include "expression/nearest.hpp"

namespace achilles {

std::span<const FileTable> file_tables() {
    static const std::vector<FileTable> tables{
        {"",
         {{"title", "text, the file's name", "what lists, windows and figures call the system"},
          {"source", "text", "where it is from"},
          {"coordinate", "tables, 1 to 8", "[[coordinate]], in the order in which states are written"},
          {"parameter", "tables", "[[parameter]]"},
          {"lagrangian", "table, needed", "[lagrangian]"},
          {"constraint", "tables, needed", "[[constraint]]: 16 at most"},
          {"run", "table", "[run]: how a run is made, unless the command line says otherwise"},
          {"view", "tables",
           "[[view]]: the plots. Without one every coordinate and the gap over t, and the plane of the "
           "first two"},
          {"drawing", "tables", "[[drawing]]: the mechanism"},
          {"truncation", "table", "[truncation]: when infinitely many impacts may be cut short"},
          {"orbit", "table", "[orbit]: a periodic run, or where the search for one begins"},
          {"extra", "table", "[extra]: whatever other programs want to know; it is not read"}}},
        {"[[coordinate]]",
         {{"name", "name, needed", "its rate is the name with a prime: x'"},
          {"start", "number, 0", "q(0)"},
          {"rate", "number, 0", "q'(0)"},
          {"force", "expression, 0", "the generalised force on it, of coordinates, rates, t and parameters"},
          {"unit", "text",
           "of \"rad\" the explorer and the figures show degrees; values may be \"30 deg\", rates \"20 deg/s\""},
          {"range", "[low, high]", "of the slider; a value outside of it gets a warning"},
          {"rate_range", "[low, high]", "the same of the rate"}}},
        {"[[parameter]]",
         {{"name", "name, needed", ""},
          {"value", "number, needed", "or an expression in other parameters: it follows from them, and has no slider"},
          {"unit", "text", "as of a coordinate"},
          {"about", "text", "what a slider says of it"},
          {"range", "[low, high]",
           "of the slider, logarithmic where low > 0 and high/low >= 100; a value outside of it "
           "gets a warning"}}},
        {"[lagrangian]",
         {{"kinetic", "expression, needed", "T(q, q'), quadratic in the rates"},
          {"potential", "expression, needed", "V(q, t)"},
          {"dissipation", "expression, 0", "R(q, q', t): minus its derivatives by the rates is added to the forces"}}},
        {"[[constraint]]",
         {{"name", "name", "needed where there are several; else it is contact"},
          {"gap", "expression, needed",
           "h(q, t): the system is free where it is positive, an impact is where it closes"},
          {"restitution", "expression, needed", "e, of the parameters, from 0 (plastic) to 1 (elastic)"},
          {"begins", "text", "what is said where contact begins, as in \"knee locks\""},
          {"ends", "text", "and where it ends, as in \"knee opens\""},
          {"drawing", "tables", "[[constraint.drawing]]: what is touched, drawn as any [[drawing]]"}}},
        {"[orbit]",
         {{"q", "[numbers], needed", "the coordinates where the period begins"},
          {"v", "[numbers], needed", "their rates there"},
          {"t", "number", "s, then: where there is a drive; without it start_time of [run]"},
          {"period", "expression", "s, of the parameters: needed where there is a drive, else a guess"},
          {"shift", "[expressions], 0", "of the parameters: by how much each coordinate has moved on after a period"}}},
        {"[[view]]",
         {{"name", "text, needed", "what --view calls it"},
          {"x", "expression, needed",
           "of t, coordinates, rates, parameters, gap, gap', gap'', lambda, energy, work, loss, power"},
          {"y", "[expressions], needed", "the same; a curve each"},
          {"label", "text", "of the y axis, in place of the expressions"},
          {"unit", "text", "of y, in place of the one that follows from the units of coordinates and parameters"}}},
        {"[[drawing]]",
         {{"shape", "word, needed", "one of those below"},
          {"color", "\"#rrggbb\"", "else that of the phase, or of what does not move"},
          {"width", "expression", "of the line, in pixels of a picture at scale 1; without it 2"},
          {"fill", "true or false", "a disc or a box is filled unless it says false, others are where it says true"}}},
        {"disc", {{"at", "[x, y], needed", "its middle"}, {"radius", "expression, needed", ""}}},
        {"circle", {{"at", "[x, y], needed", "its middle"}, {"radius", "expression, needed", "of an outline"}}},
        {"box",
         {{"at", "[x, y], needed", "its middle"},
          {"size", "[w, h], needed", "along its own axes"},
          {"angle", "expression, 0", "rad, by which it is turned to the left"}}},
        {"segment", {{"from", "[x, y], needed", ""}, {"to", "[x, y], needed", ""}}},
        {"spring",
         {{"from", "[x, y], needed", ""},
          {"to", "[x, y], needed", ""},
          {"coils", "expression", "how many; without it as many as look right at the start"},
          {"across", "expression", "how broad; without it what looks right, and keeps as it stretches"}}},
        {"damper",
         {{"from", "[x, y], needed", "the end with the cup"},
          {"to", "[x, y], needed", "that with the piston"},
          {"across", "expression", "as of a spring"}}},
        {"ground",
         {{"from", "[x, y], needed", "a line with hatching on its right as one goes"},
          {"to", "[x, y], needed", "to here"}}},
        {"curve",
         {{"at", "[x, y], needed", "expressions that may have the curve's own parameter"},
          {"over", "[\"s\", low, high], needed", "that parameter, and between what"}}},
        {"polyline", {{"points", "[[x, y], ...], needed", ""}}},
        {"text", {{"at", "[x, y], needed", ""}, {"text", "text, needed", ""}}}};
    return tables;
}

std::string other_key(std::string_view word, const std::vector<std::string>& keys) {
    struct Other {
        std::string_view key,
            words;  // of the words one stands for another key elsewhere, the first that is known here counts
    };
    static constexpr Other others[] = {
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
    for (const Other& other : others) {
        const bool is_here = std::find(keys.begin(), keys.end(), other.key) != keys.end();
        if (is_here && has_word(other.words, word)) return std::string(other.key);
    }
    return "";
}

std::string_view instead_of_key(std::string_view word) {
    struct Other {
        std::string_view words, instead;
    };
    static constexpr Other others[] = {
        {"friction mu mu_s mu_k friction_coefficient", "contacts have no friction here: leave it out"},
        {"gravity g", "gravity is a part of the potential, as m*g*y, with a [[parameter]] g"},
        {"stiffness k c contact_stiffness", "contacts are rigid: a spring belongs to the potential, as k/2*x^2"},
        {"mass m inertia", "a mass is a part of the kinetic energy, as m/2*x'^2, with a [[parameter]] m"},
        {"dt step step_size timestep h max_step", "the step follows from the tolerance in [run]"}};
    for (const Other& other : others)
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
