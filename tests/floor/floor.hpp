// Never under the floor: random starts over the ranges a description shows, what simulate() makes of them, and whether
// that is what happens in 34 digits.
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

// Reproducible starts in the air: uniform over the ranges of coordinates and rates, where every gap is above 1e-6 (a start
// closer to the floor is a question about the start, not about the motion). Written out, since the standard's
// distributions differ between libraries.
class Starts {
 public:
    Starts(std::shared_ptr<const Model> model, unsigned seed);
    State next();
    // Of all that a run may have: parameters within their ranges, a part of the time that the file shows, at a start of
    // those.
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

// An impact stored at a gap below -1e-12, relative to the coordinates where they are larger than 1. Empty if none is.
std::string below_the_floor(const Trajectory& trajectory);

// What is wrong with a trajectory by itself: an impact stored so, an outcome other than the end time (several contacts
// may be undecided), or a gap below -1e-12 at the end of a step, or below -`between` inside one, where dense output is
// an interpolation. Empty if nothing is.
std::string fault(const Trajectory& trajectory, double between);

// The first violation of a law (floor/laws.hpp). Empty if all are obeyed.
std::string broken_law(const Trajectory& trajectory);

// The end of a run that is simulated beside others.
Trajectory by_eight(const std::shared_ptr<const Model>& model, const Run& run);

// A run in digits that give the same bits back, for a bug report; that of a trajectory.
std::string start_of(const Model& model, const Run& run);
std::string start_of(const Trajectory& trajectory);

// A trajectory beside the truth.
struct Comparison {
    double error = 0.0;  // the largest difference (floor/agreement.hpp)
    std::string where;
    // The same between the run and runs from starts moved by 1e-7, over 1e-7, and at least 1. Infinite if phases
    // differ.
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

// A start whose free motion dips to a given least gap, and back up, before anything else happens.
struct Grazing {
    State start;
    Dip dip;  // of the start as rounded to doubles
};

class GrazingStarts {
 public:
    GrazingStarts(std::shared_ptr<const Model> model, unsigned seed);
    // Nothing where no start of 2000 dips near the floor: in some systems the gap falls for ever once it falls.
    std::optional<Grazing> next(double least_gap);

 private:
    bool dips_near_the_floor(const State& start);
    std::optional<Grazing> tune(State start, double least_gap);
    std::shared_ptr<const Model> model_;
    Run run_;
    double soon_;  // s, a dip later than this is not looked for
    Starts starts_;
    Evaluator<double> flight_, gap_;
    TrueRuns truth_;
};

}  // namespace achilles::test
