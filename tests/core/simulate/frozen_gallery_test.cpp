// The gallery as it was typed as energies, frozen: the files in tests/reference/hand_typed must give the events and the
// final states that they gave when they were stored, whatever becomes of the files in assets/systems.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/systems.hpp"
#include "run/trajectory.hpp"

namespace achilles {
namespace {

const nlohmann::json& frozen_results() {
    static const nlohmann::json all =
        nlohmann::json::parse(std::ifstream(test::source_file("tests/reference/hand_typed.json")));
    return all;
}

std::vector<std::string> frozen_names() {
    std::vector<std::string> names;
    for (const auto& [name, result] : frozen_results().items()) names.push_back(name);
    return names;
}

class FrozenGallery : public testing::TestWithParam<std::string> {};

// The tolerance is that of the reference mechanisms, or twice the estimated error where a run amplifies rounding.
TEST_P(FrozenGallery, GivesItsEventsAndItsEnd) {
    const auto& expected = frozen_results().at(GetParam());
    const auto model = std::make_shared<const Model>(
        read_system(test::source_file("tests/reference/hand_typed/" + GetParam() + ".toml")));
    const Trajectory run = simulate(model, model->default_run());
    const double tolerance = std::max(1e-8, 2.0 * expected["end"]["reach"].get<double>());
    ASSERT_EQ(run.events.size(), expected["events"].size());
    for (std::size_t i = 0; i < run.events.size(); ++i) {
        const auto& [kind, contacts, t] = expected["events"][i].get<std::tuple<std::string, std::string, double>>();
        std::string together;
        for (const std::size_t contact : run.events[i].contacts)
            together += (together.empty() ? "" : "+") + model->description().constraints[contact].name;
        EXPECT_EQ(names_of(run.events[i].kind).word, kind) << "event " << i;
        EXPECT_EQ(together, contacts) << "event " << i;
        EXPECT_NEAR(run.events[i].t, t, tolerance) << "event " << i;
    }
    for (Eigen::Index i = 0; i < run.end.q.size(); ++i) {
        EXPECT_NEAR(run.end.q[i], expected["end"]["q"][static_cast<std::size_t>(i)].get<double>(), tolerance);
        EXPECT_NEAR(run.end.v[i], expected["end"]["v"][static_cast<std::size_t>(i)].get<double>(), tolerance);
    }
}

INSTANTIATE_TEST_SUITE_P(HandTyped, FrozenGallery, testing::ValuesIn(frozen_names()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace achilles
