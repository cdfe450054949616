// Systems and reference results for the tests.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

inline std::filesystem::path source_file(const std::string& relative) {
    return std::filesystem::path(ACHILLES_SOURCE_DIR) / relative;
}

inline constexpr Method both_methods[] = {Method::taylor, Method::dopri5};

// Names of the gallery's systems, sorted.
inline std::vector<std::string> all_systems() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(source_file("assets/systems")))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
    std::sort(names.begin(), names.end());
    return names;
}

// The reference systems with forces, moving or several gaps (tests/reference/gaps.json), then those of them with one
// gap and explicit time.
inline const char* const reference_systems[] = {"driven_damped_pendulum", "travelling_wave",    "vibrating_table",
                                                "bowl_and_post",          "pendulum_two_stops", "ball_in_box"};
inline const char* const timed_systems[] = {"driven_damped_pendulum", "travelling_wave", "vibrating_table"};

// Loads a system of the gallery, or else a reference system.
inline std::shared_ptr<const Model> load(const std::string& name) {
    std::filesystem::path path = source_file("assets/systems/" + name + ".toml");
    if (!std::filesystem::exists(path)) path = source_file("tests/reference/gaps/" + name + ".toml");
    return std::make_shared<const Model>(read_system(path));
}

// Systems of the gallery with friction, jumps or forces that see a contact, and others with several gaps. These are
// lists because googletest asks for them whenever a test program starts, once for each test of a suite: to derive all
// models would take a second each time. Gallery.ListsAreThoseOfTheModels compares them.
inline const char* const with_friction_or_jumps[] = {"bead_on_rough_sine",
                                                     "block_on_incline",
                                                     "bouncing_dimer",
                                                     "compass_gait",
                                                     "compass_gait_floating",
                                                     "impacting_stick",
                                                     "kneed_walker",
                                                     "ladder",
                                                     "painleve_rod",
                                                     "rimless_wheel",
                                                     "rocking_block",
                                                     "rough_pendulum",
                                                     "simplest_walker",
                                                     "slider_crank_friction",
                                                     "slip_runner",
                                                     "spinning_ball_between_walls",
                                                     "spun_disc",
                                                     "stick_slip_belt",
                                                     "superball",
                                                     "two_mass_hopper",
                                                     "woodpecker"};
inline const char* const with_several_gaps[] = {"backlash",
                                                "ball_in_sloped_box",
                                                "ball_in_v",
                                                "ball_round_post",
                                                "box_dropped_flat",
                                                "cart_between_walls",
                                                "double_pendulum_two_stops",
                                                "impact_pair",
                                                "kneed_leg",
                                                "newtons_cradle",
                                                "seesaw",
                                                "slider_crank_clearance",
                                                "table_on_legs",
                                                "three_balls",
                                                "wavy_ramp"};

// Whether a list has this name.
inline bool has(std::span<const char* const> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// Those without jumps, too.
inline std::vector<std::string> systems_without_friction() {
    std::vector<std::string> names = all_systems();
    std::erase_if(names, [](const std::string& name) { return has(with_friction_or_jumps, name); });
    return names;
}

// The gallery's systems with one gap and no friction.
inline std::vector<std::string> systems_of_one_gap() {
    std::vector<std::string> names = systems_without_friction();
    std::erase_if(names, [](const std::string& name) { return has(with_several_gaps, name); });
    return names;
}

// The same system with the parameter e as the restitution of every contact.
inline std::shared_ptr<const Model> with_one_restitution(const Model& model) {
    SystemDescription system = model.description();
    for (ConstraintDescription& constraint : system.constraints) constraint.restitution.text = "e";
    ParameterDescription& e = system.parameters.emplace_back();
    e.name = "e";
    e.value = 0.5;
    return std::make_shared<const Model>(std::move(system));
}

inline std::shared_ptr<const Model> typed(const std::string& text) {
    return std::make_shared<const Model>(parse_system(text, "typed.toml"));
}

// The error message for a text, from reading to the start of a run; "" if it is valid.
inline std::string told(const std::string& text) {
    try {
        const Model model(parse_system(text, "f.toml"));
        model.check(model.default_run());
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

// The error message of reading a text; "" if it is valid.
inline std::string told_by_reading(const std::string& text) {
    try {
        parse_system(text, "f.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

// A drop onto the floor x = 0: hddot = -g.
inline std::shared_ptr<const Model> drop() {
    return typed(
        "title = \"drop\"\n[[coordinate]]\nname = \"x\"\nstart = 0\n[[parameter]]\nname = \"g\"\nvalue = 1\n"
        "[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"g*x\"\n"
        "[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n");
}

// A system of two coordinates, its terms as text.
struct PlaneSystem {
    std::string kinetic = "1/2*(a'^2 + b'^2)", potential = "b", gap = "b", e = "0.5";
    double a = 0.0, b = 0.0, a_rate = 0.0, b_rate = 0.0, end = 10.0;
    std::string a_force = "0", b_force = "0";
};

inline std::shared_ptr<const Model> model_of(const PlaneSystem& plane) {
    return typed(
        fmt::format("title = \"two coordinates\"\n[[coordinate]]\nname = \"a\"\nstart = {}\nrate = {}\nforce = \"{}\"\n"
                    "[[coordinate]]\nname = \"b\"\nstart = {}\nrate = {}\nforce = \"{}\"\n[lagrangian]\nkinetic = "
                    "\"{}\"\npotential = \"{}\"\n[[constraint]]\ngap = \"{}\"\n"
                    "restitution = \"{}\"\n[run]\nend_time = {}\n",
                    plane.a, plane.a_rate, plane.a_force, plane.b, plane.b_rate, plane.b_force, plane.kinetic,
                    plane.potential, plane.gap, plane.e, plane.end));
}

inline nlohmann::json reference(const std::string& name) {
    std::ifstream file(source_file("tests/reference/" + name + ".json"));
    return nlohmann::json::parse(file);
}

inline double number(const nlohmann::json& text) { return std::stod(text.get<std::string>()); }

// The paper's two problems.
struct Problem {
    std::string asset, key;
};
inline const Problem problems[] = {{"ball_on_sine", "ball"}, {"double_pendulum", "double_pendulum"}};

inline std::vector<Event> events_of(const Trajectory& trajectory, Event::Kind kind) {
    std::vector<Event> result;
    for (const Event& event : trajectory.events)
        if (event.kind == kind) result.push_back(event);
    return result;
}
inline std::size_t count(const Trajectory& trajectory, Event::Kind kind) { return events_of(trajectory, kind).size(); }

}  // namespace achilles::test
