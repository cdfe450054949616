#include "contacts/collapse.hpp"

#include <algorithm>

namespace achilles {

AlternateImpacts::AlternateImpacts(const PairLaw<double>& pair) : k{}, e(pair.e) {
    k = {std::abs(pair.W21) * (1.0 + e[0]) / pair.W11, std::abs(pair.W12) * (1.0 + e[1]) / pair.W22};
    const double sum = k[0] * k[1] - e[0] - e[1], product = e[0] * e[1];
    const double p = std::cbrt(product);
    is_real = pair.reality() >= 0.0;
    is_fast = k[0] * k[1] > e[0] + e[1] + p + p * p;
    if (!is_real) return;
    mu_plus = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product)));
    mu_minus = product / mu_plus;  // without cancellation
}

}  // namespace achilles
