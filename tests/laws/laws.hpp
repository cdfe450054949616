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

// E - work + loss is constant over the whole run; an impact with impulses p loses sum p (1 - e) |hdot|/2, and in it
// moving surfaces do the work -sum p dh/dt.
Violations energy(const Trajectory& trajectory);
// Every gap >= -1e-12 max(1, |q|) everywhere.
Violations gap(const Trajectory& trajectory);
// Phases abut, and each ends where the set of held contacts changes (Def. 5, where there is one: hybrid, Zeno point,
// constrained, release, hybrid, ...); impacts are Moreau's, with one contact Newton's; Zeno points lie on h = hdot = 0
// where forces press, inside what their certificate says.
Violations phases(const Trajectory& trajectory);
// The force of every held contact presses inside constrained phases; a release is where it is 0 and h''' > 0.
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
