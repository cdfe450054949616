// Simulates a run: the completed execution of a system, past every Zeno point, until the end time.
#pragma once

#include <atomic>
#include <memory>
#include <stop_token>

#include "../run/trajectory.hpp"

namespace achilles {

// Cancellation and progress of a run, shared with another thread.
struct RunMonitor {
    std::stop_token stop;           // ends the run at its next step, as "cancelled"; set it before the run starts
    std::atomic<double> time{0.0};  // s, reached so far
    std::atomic<long> impacts{0};   // number so far
};

// What a trajectory records. Recording::full: all. Recording::final_state: only the final state, time, outcome, phases,
// counts, the smallest gap at step ends, and the sequence of events without states; no dense output and no energy. The
// computed motion is the same.
enum class Recording { full, final_state };

// Simulates one run. Failures during the run are reported in Trajectory::outcome, never thrown. Throws InputError if
// the run cannot start (Model::check). A tolerance or eps below min_tolerance is raised to it, also in the
// trajectory's copy of the run.
Trajectory simulate(const std::shared_ptr<const Model>& model, const Run& run, RunMonitor* watch = nullptr,
                    Recording keep = Recording::full);

}  // namespace achilles
