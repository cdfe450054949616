// Achilles as a library: mechanical systems with impacts, simulated past their Zeno points.
//
//     read_system(file), parse_system(text)   a system file                     SystemDescription
//     derive(description)                     its equations of motion, once     shared_ptr<const Model>
//     NamedRun(description).set("e", 0.3)     parameters, start and options     Run
//     simulate(model, run)                    the completed execution           Trajectory: phases, events, certificates
//     trajectory(t)                           q and v at a time                 Sample
//     estimate_error(trajectory)              an estimate of its error          ErrorEstimate
//     make_sweep({.over = ..., .prints = ...}, run, description)                SweepSpec
//     sweep_columns(model, sweep)             many runs, on all cores           SweepColumns
//     simulate_many(), simulate_ends()        many runs, each reduced by a function of the caller
//     parse_orbit_request({.along = ...}, run, model)                           OrbitRequest
//     solve_orbit_request(request, model)     a periodic orbit, its multipliers and its branch, or the reason why none
//                                             was found                         OrbitResult
//
// A Model never changes and may be used by several threads. A mistake in a file, a name or an expression is thrown as
// an InputError, which has its place and a correction. A run that ends early reports the reason in the trajectory's
// `outcome`. Numbers are in the file's units, angles in rad.
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
