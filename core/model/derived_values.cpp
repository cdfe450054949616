#include "model/derived_values.hpp"

namespace achilles {

std::vector<double> derived_values(const Model& model, std::span<const double> parameters) {
    const auto& all = model.description().derived;
    if (all.empty()) return {};
    std::vector<Text> names;
    for (const DerivedDescription& derived : all) names.push_back({derived.name, derived.definition.at});
    const Program program = model.compile_drawing(names);
    auto value = model.evaluator(program, parameters);
    value.run();
    std::vector<double> values;
    for (std::size_t i = 0; i < all.size(); ++i) values.push_back(value.output(i));
    return values;
}

}  // namespace achilles
