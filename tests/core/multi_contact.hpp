// Runs with forces, moving gaps and several gaps, for tests of their output.
#pragma once

#include "core/systems.hpp"

namespace achilles::test {

inline const char* const gap_systems[] = {"driven_damped_pendulum", "travelling_wave",    "vibrating_table",
                                          "bowl_and_post",          "pendulum_two_stops", "ball_in_box"};

inline std::shared_ptr<const Model> load_gaps(const std::string& name) {
    return std::make_shared<const Model>(read_system(source_file("tests/reference/gaps/" + name + ".toml")));
}

inline Trajectory run_gaps(const std::string& name) {
    const auto model = load_gaps(name);
    auto run = model->default_run();
    run.options.tolerance = 1e-10;
    return simulate(model, run);
}

// A rod of mass and length 1 dropped flat on the ground, e = 1/2 at both ends.
inline std::shared_ptr<const Model> flat_rod() {
    return typed(R"toml(
title = "Rod dropped flat"
[[coordinate]]
name = "y"
start = 0.5
[[coordinate]]
name = "th"
start = 0
unit = "rad"
[lagrangian]
kinetic = "y'^2/2 + th'^2/24"
potential = "y"
[[constraint]]
name = "left"
gap = "y - sin(th)/2"
restitution = 0.5
[[constraint]]
name = "right"
gap = "y + sin(th)/2"
restitution = 0.5
[run]
end_time = 1.5
)toml");
}

// Index of the event nearest to time t.
inline std::size_t event_near(const Trajectory& trajectory, double t) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < trajectory.events.size(); ++i)
        if (std::abs(trajectory.events[i].t - t) < std::abs(trajectory.events[nearest].t - t)) nearest = i;
    return nearest;
}

}  // namespace achilles::test
