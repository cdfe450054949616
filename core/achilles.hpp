// Achilles as a library: mechanical systems with impacts, simulated past their Zeno points.
//
//     read_system(file), parse_system(text)   a system file                     SystemDescription
//     derive(description)                     its equations of motion, once     shared_ptr<const Model>
//     NamedRun(description).set("e", 0.3)     parameters, start and options     Run
//     simulate(model, run)                    the completed execution           Trajectory: phases, events, certificates
//     trajectory(t)                           q and v at a time                 Sample
//     estimate_error(trajectory)              how wrong it has become, roughly  ErrorEstimate
//     make_sweep({.over = ..., .prints = ...}, run, description)                Sweep
//     sweep_columns(model, sweep)             many runs, on all cores           SweepColumns
//     simulate_many(), simulate_ends()        many runs, each reduced to what is wanted of it
//     parse_orbit_request({.along = ...}, run, model)                           OrbitRequest: of a periodic run
//     solve_orbit_request(request, model)     the run, its multipliers, branch  OrbitResult, or why there is none
//
// A Model never changes and may be used by several threads. What is wrong with a file, a name or an expression is thrown as an
// InputError, which says where it stands and what would be right; what ends a run early is the trajectory's `outcome`.
// Numbers are in the file's units, angles in rad.
#pragma once

#include "analysis/orbit.hpp"
#include "analysis/sweep.hpp"
#include "model/read_system.hpp"
#include "output/sweep_columns.hpp"
#include "sensitivity/error_estimate.hpp"
#include "simulate/batch.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"
#include "system/description.hpp"
