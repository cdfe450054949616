#include "run/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

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

namespace {

template <class AnyOptions>
auto tolerances(AnyOptions& options) {
    auto& truncation = options.truncation;
    return std::array{std::pair("tolerance", &options.tolerance), std::pair("eps_q", &truncation.eps_q),
                      std::pair("eps_v", &truncation.eps_v), std::pair("eps_t", &truncation.eps_t)};
}

}  // namespace

std::vector<std::string> warnings(const Options& options) {
    std::vector<std::string> told;
    for (const auto& [name, value] : tolerances(options))
        if (*value < least_tolerance)
            told.push_back(fmt::format("{} = {} is less than double precision can serve: {} is used", name, *value,
                                       least_tolerance));
    return told;
}

void raise_to_least(Options& options) {
    for (const auto& [name, value] : tolerances(options)) *value = std::max(*value, least_tolerance);
}

}  // namespace achilles
