// Comparison of several runs of one system: pinned runs and the table of all runs.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "figure/contact_geometry.hpp"
#include "figure/figure.hpp"
#include "run/trajectory.hpp"
#include "sensitivity/error_estimate.hpp"
#include "simulate/sampler.hpp"
#include "system/description.hpp"

namespace achilles {

// A run kept beside the current one, as it was when pinned.

struct PinnedRun {
    int place = 1;   // from 1 to max_pinned; determines its color
    int number = 0;  // order of the pin requests, from 0, whichever run finishes first
    bool shown = true;
    std::shared_ptr<const Trajectory> trajectory;
    std::shared_ptr<Sampler> sampler;
    std::shared_ptr<const std::vector<Sample>> samples;  // for plots
    // Empty if another run was started before the estimate was finished.
    std::shared_ptr<const std::optional<ErrorEstimate>> estimate;
    std::optional<double> horizon() const {
        return *estimate ? horizon_before_end(*trajectory, **estimate) : std::nullopt;
    }
    // Contact geometry of its disks in the drawing of `touched`, for a world of size `touched_size`.
    std::shared_ptr<const ContactGeometry> touch;
    std::shared_ptr<const Mechanism> touched;
    double touched_size = 0.0;
    std::string name;          // how it differs from the other runs; empty: no difference
    std::vector<Panel> plots;  // panels of the selected plots
    int revision = -1;         // revision of the selection in `plots`
    bool dark = false;         // theme of `plots`
};

// True if both descriptions have the same coordinates, parameters, energies, forces and contacts; values, ranges, views
// and drawings may differ. A run of one is then a run of the other.
bool same_system(const SystemDescription& a, const SystemDescription& b);

// Differences between several runs and their consequences.

// A value or an option that is not the same in all runs, in display form: "e", "0.5", "0.3".
struct VaryingInput {
    std::string name;
    bool is_option = false;
    std::vector<std::string> values;  // one per run
};
std::vector<VaryingInput> varying_inputs(std::span<const Run* const> runs, const SystemDescription& description);

// Short names that distinguish the runs: "e = 0.3, x(0) = 1 m". Empty if nothing differs. Runs whose displayed values
// coincide get a number, except those equal to the current run, which is the first.
std::vector<std::string> names_of_runs(std::span<const Run* const> runs, const SystemDescription& description);

struct RunTable {
    struct Row {
        std::string name;
        std::vector<std::string> values;  // one per run
        std::vector<bool> differs;        // true where it differs from the first run, the current one
        std::string change;               // for two runs: value of the first minus that of the second; may be empty
        bool is_cause = false;            // an input (value or option), not a result
    };
    std::vector<Row> rows;
    // For each run whose sequence of events differs from the current run's: its index and the explanation.
    std::vector<std::pair<std::size_t, std::string>> divergences;
};

// A run and the estimate of its error; null: not available (yet).
struct ShownRun {
    const Trajectory* run = nullptr;
    const ErrorEstimate* estimate = nullptr;
};

// Compares the current run with the pinned ones: inputs that vary; the event after which the sequences of events
// differ; times of contacts coming to rest and being released, as far as the runs go; number of impacts; end time and
// final state. Angles are in degrees. Digits that the estimated errors do not justify are left out.
RunTable run_table(std::span<const ShownRun> runs);

// Text form for tests.
std::string to_text(const RunTable& table);

}  // namespace achilles
