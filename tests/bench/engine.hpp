// What the parts of bench_engine share: settings, runs with them, errors and ratios.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/by_hand.hpp"
#include "model/model.hpp"

namespace achilles::bench {

struct Setting {
    double tolerance = 0.0, cut = 0.0;
};

Values values_of(const State& state);
// The largest difference; NaN where one is.
double error_of(const Values& end, const Values& truth);
Run run_with(const Model& model, Method method, const Setting& setting);
// The methods there are: one that gives another's bytes is not there yet.
std::vector<Method> methods(const std::shared_ptr<const Model>& model);
// The processor that a ratio belongs to: it is another one on another.
std::string processor_name();
// The median of the rounds' ratios.
std::string ratio(const std::vector<double>& reference, const std::vector<double>& times);

// For each error in the end state of the ball and of the pendulum, the fastest setting of each contestant that meets it.
void measure_work_and_precision(int rounds);
// Random balls, one by one and eight at a time.
void measure_ensemble(int count, int rounds);

}  // namespace achilles::bench
