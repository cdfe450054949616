// Common parts of bench_engine: settings, runs, errors and ratios.
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
// The largest difference; NaN if one is NaN.
double error_of(const Values& end, const Values& truth);
Run run_with(const Model& model, Method method, const Setting& setting);
// The methods that are implemented. A method whose results equal another's in every byte is not implemented yet.
std::vector<Method> methods(const std::shared_ptr<const Model>& model);
// Name of the processor, printed beside ratios, since these depend on it.
std::string processor_name();
// The median of the ratios of all rounds, as text.
std::string ratio(const std::vector<double>& reference, const std::vector<double>& times);

// For the ball and the pendulum and each error of the final state: the fastest setting of each contestant with this
// error.
void measure_work_and_precision(int rounds);
// Random balls, in single runs and in batches of eight.
void measure_ensemble(int count, int rounds);

}  // namespace achilles::bench
