// The completed execution of a system: past every Zeno point, until the end time.
#pragma once

#include <atomic>
#include <memory>
#include <stop_token>

#include "../run/trajectory.hpp"

namespace achilles {

// A run as another thread sees it: it can be told to stop, and it says how far it is.
struct Watch {
    std::stop_token stop;  // once asked for, the run ends at its next step, as "cancelled"; set before the run starts
    std::atomic<double> time{0.0};  // s, reached so far
    std::atomic<long> impacts{0};   // so far
};

// What a trajectory keeps of its run: everything, or the end alone (state, time, outcome, phases, counts, the least gap at
// step ends, and the sequence of events without their states) without dense output and energy. The motion is the same.
enum class Keep { everything, end };

// Runs. Never throws for what happens on the way: that is the trajectory's outcome. Throws InputError if the run cannot
// start (Model::check). A tolerance or eps below least_tolerance is raised to it, in the trajectory's run too.
Trajectory simulate(const std::shared_ptr<const Model>& model, const Run& run, Watch* watch = nullptr,
                    Keep keep = Keep::everything);

}  // namespace achilles
