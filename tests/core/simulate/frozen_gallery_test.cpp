// The gallery as it was typed as energies, frozen: the files in tests/reference/hand_typed must give the events and the
// final states that they gave when they were stored, whatever becomes of the files in assets/systems.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

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

// ---- the files of the gallery that say the same with bodies ----

std::vector<std::string> rewritten_names() {
    std::vector<std::string> names = frozen_names();
    std::erase_if(names, [](const std::string& name) {
        return read_text(test::source_file("assets/systems/" + name + ".toml")).find("\nbody = ") == std::string::npos;
    });
    return names;
}

class RewrittenGallery : public testing::TestWithParam<std::string> {};

TEST_P(RewrittenGallery, HasTheEventsOfItsEnergies) {
    struct Accuracy {
        bool is_tightest;
        double allowed;  // s
    };
    for (const Accuracy& accuracy : {Accuracy{false, 1e-8}, Accuracy{true, 1e-11}}) {
        const auto run_in = [&](const std::string& folder) {
            const auto model =
                std::make_shared<const Model>(read_system(test::source_file(folder + GetParam() + ".toml")));
            achilles::Run run = model->default_run();
            if (accuracy.is_tightest) {
                run.options.tolerance = 1e-14;
                run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-12;
            }
            return simulate(model, run);
        };
        const Trajectory typed = run_in("tests/reference/hand_typed/"), bodies = run_in("assets/systems/");
        EXPECT_EQ(bodies.outcome.kind, typed.outcome.kind);
        ASSERT_EQ(bodies.events.size(), typed.events.size());
        for (std::size_t i = 0; i < typed.events.size(); ++i) {
            EXPECT_EQ(bodies.events[i].kind, typed.events[i].kind) << "event " << i;
            EXPECT_EQ(bodies.events[i].contacts, typed.events[i].contacts) << "event " << i;
            EXPECT_NEAR(bodies.events[i].t, typed.events[i].t, accuracy.allowed) << "event " << i;
        }
    }
}

// Names of coordinates, parameters and contacts, starts, sliders and titles are part of how a system is used.
TEST_P(RewrittenGallery, KeepsItsNamesAndValues) {
    const SystemDescription typed =
                                read_system(test::source_file("tests/reference/hand_typed/" + GetParam() + ".toml")),
                            bodies = read_system(test::source_file("assets/systems/" + GetParam() + ".toml"));
    EXPECT_EQ(bodies.title, typed.title);
    EXPECT_EQ(bodies.source, typed.source);
    ASSERT_EQ(bodies.coordinates.size(), typed.coordinates.size());
    for (std::size_t i = 0; i < typed.coordinates.size(); ++i) {
        const CoordinateDescription &one = bodies.coordinates[i], &other = typed.coordinates[i];
        EXPECT_EQ(std::tie(one.name, one.unit, one.start, one.rate, one.range, one.rate_range),
                  std::tie(other.name, other.unit, other.start, other.rate, other.range, other.rate_range));
    }
    ASSERT_EQ(bodies.parameters.size(), typed.parameters.size());
    for (std::size_t i = 0; i < typed.parameters.size(); ++i) {
        const ParameterDescription &one = bodies.parameters[i], &other = typed.parameters[i];
        EXPECT_EQ(std::tie(one.name, one.unit, one.about, one.value, one.range),
                  std::tie(other.name, other.unit, other.about, other.value, other.range));
    }
    ASSERT_EQ(bodies.derived.size(), typed.derived.size());
    for (std::size_t i = 0; i < typed.derived.size(); ++i) EXPECT_EQ(bodies.derived[i].name, typed.derived[i].name);
    ASSERT_EQ(bodies.constraints.size(), typed.constraints.size());
    for (std::size_t i = 0; i < typed.constraints.size(); ++i) {
        const ConstraintDescription &one = bodies.constraints[i], &other = typed.constraints[i];
        EXPECT_EQ(std::tie(one.name, one.begins, one.ends, one.restitution.text),
                  std::tie(other.name, other.begins, other.ends, other.restitution.text));
    }
    ASSERT_EQ(bodies.views.size(), typed.views.size());
    for (std::size_t i = 0; i < typed.views.size(); ++i) EXPECT_EQ(bodies.views[i].name, typed.views[i].name);
    EXPECT_EQ(bodies.options.end_time, typed.options.end_time);
    EXPECT_EQ(bodies.orbit.has_value(), typed.orbit.has_value());
}

INSTANTIATE_TEST_SUITE_P(HandTyped, RewrittenGallery, testing::ValuesIn(rewritten_names()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace achilles
