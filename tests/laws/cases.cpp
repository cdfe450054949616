#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <regex>

#include "core/systems.hpp"
#include "laws/laws.hpp"

namespace achilles::test {

void PrintTo(const Case& one, std::ostream* out) { *out << one.system << ", " << to_text(one.method); }

std::string name_of(const testing::TestParamInfo<Case>& info) {
    return info.param.system + "_" + std::string(to_text(info.param.method));
}

std::vector<Method> all_methods() { return {Method::taylor, Method::dopri5}; }

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const Method method : all_methods())
        for (const std::string& name : all_systems()) cases.push_back({name, method});
    return cases;
}

std::shared_ptr<const Model> model_of(const std::string& system) {
    static std::map<std::string, std::shared_ptr<const Model>> models;
    auto& model = models[system];
    if (!model) model = load(system);
    return model;
}

Run run_of(const Case& one) {
    auto run = model_of(one.system)->default_run();
    run.options.method = one.method;
    return run;
}

Trajectory simulated(const Case& one, const Run& run) {
    Trajectory trajectory = simulate(model_of(one.system), run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    return trajectory;
}

std::string with_slip(const std::string& text, const std::string& value) {
    return std::regex_replace(text, std::regex("\\bslip\\b"), "(" + value + ")");
}

double distance(const State& a, const State& b) {
    double result = 0.0;
    const auto compare = [&](const Vector& x, const Vector& y) {
        for (Eigen::Index i = 0; i < x.size(); ++i)
            result = std::max(result, std::abs(x[i] - y[i]) / std::max(1.0, std::abs(x[i])));
    };
    compare(a.q, b.q);
    compare(a.v, b.v);
    return result;
}

}  // namespace achilles::test
