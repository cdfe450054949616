#include "simulate/options.hpp"

namespace achilles {

std::string_view to_text(Method method) { return method == Method::dopri5 ? "dopri5" : "taylor"; }
std::string_view to_text(Conditions conditions) { return conditions == Conditions::paper ? "paper" : "sharp"; }
std::string_view to_text(Reinitialization kind) { return kind == Reinitialization::kinetic ? "kinetic" : "euclidean"; }

namespace {

template <class Value>
std::optional<Value> one_of(std::string_view text, Value a, Value b) {
    if (text == to_text(a)) return a;
    if (text == to_text(b)) return b;
    return std::nullopt;
}

}  // namespace

std::optional<Method> method_from(std::string_view text) { return one_of(text, Method::dopri5, Method::taylor); }
std::optional<Conditions> conditions_from(std::string_view text) {
    return one_of(text, Conditions::paper, Conditions::sharp);
}
std::optional<Reinitialization> reinitialization_from(std::string_view text) {
    return one_of(text, Reinitialization::euclidean, Reinitialization::kinetic);
}

}  // namespace achilles
