// The runs of one system side by side: those that stay beside the present one, and all of them in a table.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "depend/error_estimate.hpp"
#include "figure/figure.hpp"
#include "figure/touch.hpp"
#include "run/trajectory.hpp"
#include "simulate/sampler.hpp"
#include "system/description.hpp"

namespace achilles {

// A run that stays beside the present one, as it was when it was pinned.

struct PinnedRun {
    int place = 1;   // from 1 to most_pinned: its colour
    int number = 0;  // of those that were asked for, so many before it: whichever run is there first
    bool shown = true;
    std::shared_ptr<const Trajectory> trajectory;
    std::shared_ptr<Sampler> sampler;
    std::shared_ptr<const std::vector<Sample>> samples;  // for plots
    std::shared_ptr<const std::optional<ErrorEstimate>>
        estimate;  // nothing where another run was made before it was there
    std::optional<double> horizon() const {
        return *estimate ? horizon_before_end(*trajectory, **estimate) : std::nullopt;
    }
    std::shared_ptr<const Touch> touch;        // how its discs rest in the present drawing,
    std::shared_ptr<const Mechanism> touched;  // of this mechanism,
    double touched_size = 0.0;                 // in a world of this size
    std::string name;                          // how it differs from the others and the present one; empty: not at all
    std::vector<Panel> plots;                  // of what is plotted now
    int revision = -1;                         // of that,
    bool dark = false;                         // and in which theme
};

// Whether two descriptions are of one system: the same coordinates, parameters, energies, forces and contacts, whatever the
// values, ranges, views and drawings. Then a run of one is a run of the other.
bool same_system(const SystemDescription& a, const SystemDescription& b);

// What differs between several runs, and what follows from it.

// A value or an option that not all of some runs have alike, as a person reads it: "e", "0.5", "0.3".
struct VaryingInput {
    std::string name;
    bool is_option = false;
    std::vector<std::string> values;  // run by run
};
std::vector<VaryingInput> varying_inputs(std::span<const Run* const> runs, const SystemDescription& description);

// What tells each run from the others: "e = 0.3, x(0) = 1 m", a few words at most. Empty where nothing differs; runs whose
// values differ by less than these words show are numbered, but those that are the present one, which is the first.
std::vector<std::string> names_of_runs(std::span<const Run* const> runs, const SystemDescription& description);

struct RunTable {
    struct Row {
        std::string name;
        std::vector<std::string> values;  // run by run
        std::vector<bool> differs;        // from the first, the present run
        std::string change;               // of two runs: how much more the first has; may be empty
        bool is_cause = false;            // a value or option, which others follow from
    };
    std::vector<Row> rows;
    // Where a run goes another way than the present one: its number among the runs, and the sentence.
    std::vector<std::pair<std::size_t, std::string>> partings;
};

// A run, and the estimate of its error; null: there is none, or not yet.
struct ShownRun {
    const Trajectory* run = nullptr;
    const ErrorEstimate* estimate = nullptr;
};

// Of the present run and the pinned ones: the inputs that vary; after which event the course is another one; when contacts come to rest and are released, as far as the
// runs go, the number of impacts, the end and the state there. Coordinates of angles are in degrees. Numbers have the digits that
// the estimated errors leave.
RunTable run_table(std::span<const ShownRun> runs);

// The table as text, for tests.
std::string to_text(const RunTable& table);

}  // namespace achilles
