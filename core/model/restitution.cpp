#include "model/restitution.hpp"

#include <fmt/format.h>

namespace achilles {

namespace {

bool is_restitution(double lo, double hi) { return lo >= -restitution_rounding && hi <= 1.0 + restitution_rounding; }

std::optional<Mistake> not_in_range(const Text& restitution, const std::string& fact) {
    return Mistake{restitution.at, "the restitution must lie in [0, 1], but " + fact, "0 is plastic, 1 is elastic"};
}

}  // namespace

double without_rounding(double e) {
    if (!is_restitution(e, e)) return e;
    return e > 1.0 ? 1.0 : e < 0.0 ? 0.0 : e;
}

std::optional<Mistake> mistake_in(const Text& restitution, double e) {
    if (is_restitution(e, e)) return std::nullopt;
    return not_in_range(restitution, fmt::format("it is {}", e));
}

std::optional<Mistake> mistake_in(const Text& restitution, const Interval& e) {
    if (is_restitution(e.lo(), e.hi())) return std::nullopt;
    return not_in_range(restitution, fmt::format("with these intervals it lies in [{}, {}]: the part {} is impossible",
                                                 e.lo(), e.hi(), e.hi() > 1.0 ? "above 1" : "below 0"));
}

}  // namespace achilles
