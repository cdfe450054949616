// What every execution of every system obeys. A law takes a trajectory and returns its violations, one sentence each:
// none for what simulate() makes, some for a trajectory that was falsified (lies_test.cpp).
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "run/trajectory.hpp"

namespace achilles::test {

using Violations = std::vector<std::string>;

// The energy is constant where the motion is smooth, and falls by (1 - e^2) hdot^2/(2 W) in an impact.
Violations energy(const Trajectory& trajectory);
// gap >= -1e-12 max(1, |q|) everywhere.
Violations gap(const Trajectory& trajectory);
// Phases abut and alternate (Def. 5): hybrid, Zeno point, constrained, release, hybrid, ...; impacts are Newton's, in
// hybrid phases; Zeno points lie on h = hdot = 0 with hddot < 0, inside what their certificate says.
Violations phases(const Trajectory& trajectory);
// lambda > 0 inside constrained phases, 0 in flight; a release is where lambda = 0 and h''' > 0.
Violations contact_force(const Trajectory& trajectory);

// One file of assets/systems, integrated by one method.
struct Case {
    std::string system;
    Method method = Method::taylor;
};
void PrintTo(const Case& one, std::ostream* out);
std::string name_of(const testing::TestParamInfo<Case>& info);

// The methods that --method accepts and computes with.
std::vector<Method> all_methods();
// Every file in the folder with every method there is.
std::vector<Case> all_cases();

std::shared_ptr<const Model> model_of(const std::string& system);
// The run that the file asks for, with this method.
Run run_of(const Case& one);
// Simulates, and expects that the run reaches its end time.
Trajectory simulated(const Case& one, const Run& run);
// The largest difference of a coordinate or rate, relative where these are large.
double distance(const State& a, const State& b);

class Law : public testing::TestWithParam<Case> {};

}  // namespace achilles::test
