// The gallery files and methods on which the laws of floor/laws.hpp are tested.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "floor/laws.hpp"
#include "model/model.hpp"

namespace achilles::test {

// One file of assets/systems, integrated by one method.
struct Case {
    std::string system;
    Method method = Method::taylor;
};
void PrintTo(const Case& one, std::ostream* out);
std::string name_of(const testing::TestParamInfo<Case>& info);

// The methods that --method accepts and computes with.
std::vector<Method> all_methods();
// Every gallery file with every method.
std::vector<Case> all_cases();

std::shared_ptr<const Model> model_of(const std::string& system);
// The run that the file specifies, with the method of `one`.
Run run_of(const Case& one);
// Simulates the run and expects that it reaches its end time.
Trajectory simulated(const Case& one, const Run& run);
// The largest difference of a coordinate or rate; relative where the values are large.
double distance(const State& a, const State& b);

// A friction coefficient or level with the sliding speed `slip` in it replaced by this expression.
std::string with_slip(const std::string& text, const std::string& value);

class Law : public testing::TestWithParam<Case> {};

}  // namespace achilles::test
