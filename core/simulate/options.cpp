#include "simulate/options.hpp"

namespace achilles {

namespace {

// The value whose name this is, if any.
template <class Value, std::size_t Count>
std::optional<Value> named(std::string_view name, const Value (&values)[Count]) {
    for (const Value value : values) {
        if (to_text(value) == name) return value;
    }
    return std::nullopt;
}

}  // namespace

std::string_view to_text(Method method) { return method == Method::taylor ? "taylor" : "dopri5"; }
std::string_view to_text(Conditions conditions) { return conditions == Conditions::sharp ? "sharp" : "paper"; }
std::string_view to_text(Reinitialization reinitialization) {
    return reinitialization == Reinitialization::kinetic ? "kinetic" : "euclidean";
}

std::optional<Method> method_from(std::string_view name) { return named(name, {Method::dopri5, Method::taylor}); }
std::optional<Conditions> conditions_from(std::string_view name) {
    return named(name, {Conditions::paper, Conditions::sharp});
}
std::optional<Reinitialization> reinitialization_from(std::string_view name) {
    return named(name, {Reinitialization::euclidean, Reinitialization::kinetic});
}

}  // namespace achilles
