// What JSON and CSV say of dry friction.
#include <gtest/gtest.h>

#include <string>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

Trajectory sliding_block() {
    const auto model = derive(parse_system(R"-(coordinate = [{name = "x", rate = -1}, {name = "y"}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - x/2"
constraint = [{name = "foot", gap = "y", restitution = 0, slip = "x'", friction = 0.3}]
friction = [{name = "air", slip = "x'", level = 0.01}]
)-"));
    achilles::Run run = model->default_run();
    run.options.end_time = 3.0;
    return simulate(model, run);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(FrictionOutput, JsonNamesModesEventsAndHeat) {
    const std::string json = to_json(sliding_block());
    EXPECT_TRUE(has(json, R"("kind": "reversal")"));
    EXPECT_TRUE(has(json, R"("direction": 1)"));
    EXPECT_TRUE(has(json, R"("foot": "slip-")"));
    EXPECT_TRUE(has(json, R"("foot": "slip+")"));
    EXPECT_TRUE(has(json, R"("air": "slip+")"));
    EXPECT_TRUE(has(json, R"("heat": )"));
    EXPECT_TRUE(has(json, "dry friction"));  // why there is no error estimate
}

TEST(FrictionOutput, CsvHasSlipForceModesAndHeat) {
    const std::string csv = to_csv(sliding_block());
    const std::string heading = csv.substr(0, csv.find('\n'));
    EXPECT_EQ(
        heading,
        "t,phase,x,y,x',y',gap,gap rate,lambda,slip_foot,friction_force_foot,slip_air,friction_force_air,energy,j,"
        "modes,work,loss,heat");
    EXPECT_TRUE(has(csv, ",foot:slip-+air:slip-,"));
    EXPECT_TRUE(has(csv, ",foot:slip++air:slip+,"));
}

}  // namespace
}  // namespace achilles
