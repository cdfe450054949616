// Tests that no trajectory penetrates: simulates random starts in the ranges of a description, and compares the
// trajectories with 34-digit references.
#pragma once

#include <array>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "certify/execution.hpp"
#include "floor/agreement.hpp"
#include "model/model.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

// Reproducible starts in flight: uniform in the ranges of coordinates and rates, with every gap above 1e-6. (Closer
// starts would test the treatment of the start, not the motion.) Own formulas, since the distributions of the standard
// library differ between implementations.
class Starts {
 public:
    Starts(std::shared_ptr<const Model> model, unsigned seed);
    State next();
    // A run from such a start, with random parameters in their ranges and a part of the file's duration.
    Run next_run();
    double uniform(double low, double high);

 private:
    void look(const Run& run);
    std::optional<State> in_the_air(int tries);
    double within(const std::array<double, 2>& range);

    std::shared_ptr<const Model> model_;
    std::vector<Evaluator<double>> gaps_;
    double start_time_ = 0.0;
    std::mt19937_64 random_;
};

// Describes an impact stored at a gap below -1e-12 max(1, |q|); empty if there is none.
std::string below_the_floor(const Trajectory& trajectory);

// Describes an error of a trajectory that is visible without a reference; empty if there is none. Errors are: an impact
// below the floor (see above); an outcome other than the end time (several contacts may be undecided); a gap below
// -1e-12 at the end of a step; a gap below -`between` inside a step, where dense output interpolates.
std::string fault(const Trajectory& trajectory, double between);

// The first violation of a law (floor/laws.hpp); empty if there is none.
std::string broken_law(const Trajectory& trajectory);

// The trajectory of a run simulated in a batch, recorded without events.
Trajectory by_eight(const std::shared_ptr<const Model>& model, const Run& run);

// The start and options of a run for a bug report, with enough digits to restore all bits; the same for a trajectory.
std::string start_of(const Model& model, const Run& run);
std::string start_of(const Trajectory& trajectory);

// Result of the comparison of a trajectory with its reference.
struct Comparison {
    double error = 0.0;  // the largest difference (floor/agreement.hpp)
    std::string where;
    // Sensitivity to the start: the largest difference to runs from starts moved by 1e-7, divided by 1e-7; at least 1.
    // Infinite if phases differ.
    double sensitivity = 1.0;
    bool agrees() const { return error <= 1e-8 * sensitivity; }
};

class Judge {
 public:
    Judge(std::shared_ptr<const Model> model, const Run& run);
    Comparison compare(const Trajectory& trajectory);

 private:
    std::shared_ptr<const Model> model_;
    TrueRuns truth_;
};

// A start whose gap in free motion has a given local minimum before any other event.
struct Grazing {
    State start;
    Dip dip;  // for the start as rounded to doubles
};

class GrazingStarts {
 public:
    GrazingStarts(std::shared_ptr<const Model> model, unsigned seed);
    // nullopt if none of 2000 starts has a minimum near the floor: in some systems a decreasing gap has no minimum.
    std::optional<Grazing> next(double least_gap);

 private:
    bool dips_near_the_floor(const State& start);
    std::optional<Grazing> tune(State start, double least_gap);
    std::shared_ptr<const Model> model_;
    Run run_;
    double soon_;  // s, the latest time of a minimum
    Starts starts_;
    Evaluator<double> flight_, gap_;
    TrueRuns truth_;
};

}  // namespace achilles::test
