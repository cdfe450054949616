// The bound on the time until two chattering contacts come to rest, against computed impact sequences (theory-gaps.md
// 3).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "certify/two_contacts.hpp"

namespace achilles {
namespace {

// Impacts of two contacts until both rest, with constant W and a and Newton's law. A contact that bounces alone forever
// is held. Returns the time and the integral of lambda_i h_i.
struct Rest {
    double t = 0.0;
    std::array<double, 2> integral{};
};
Rest rest_of(const PairAtCollision& pair, std::array<double, 2> h, std::array<double, 2> sigma) {
    const double W0 = mid(pair.W[0][0]), c = mid(pair.W[0][1]), W1 = mid(pair.W[1][1]), det = W0 * W1 - c * c;
    const std::array<double, 2> W{W0, W1}, lambda{mid(pair.lambda[0]), mid(pair.lambda[1])};
    const auto energy = [&] {
        return 0.5 * (W1 * sigma[0] * sigma[0] - 2.0 * c * sigma[0] * sigma[1] + W0 * sigma[1] * sigma[1]) / det +
               lambda[0] * h[0] + lambda[1] * h[1];
    };
    constexpr double never = std::numeric_limits<double>::infinity();
    const auto landing = [](double height, double speed, double a) {
        if (height <= 0.0) return speed < 0.0 ? 0.0 : a > 0.0 && speed > 0.0 ? 2.0 * speed / a : never;
        const double D = speed * speed + 2.0 * a * height;
        if (D < 0.0 || (a <= 0.0 && speed >= 0.0)) return never;
        return a > 0.0 && speed >= 0.0 ? (speed + std::sqrt(D)) / a : 2.0 * height / (std::sqrt(D) - speed);
    };
    Rest rest;
    constexpr std::size_t nobody = 2;
    std::size_t held = nobody;
    const double begin = energy();
    for (int impact = 0; impact < 20000 && energy() > 1e-13 * begin; ++impact) {
        std::array<double, 2> a{mid(pair.a[0]), mid(pair.a[1])}, wait{};
        if (held != nobody) {
            a[1 - held] = (W[1 - held] - c * c / W[held]) * lambda[1 - held];
            a[held] = 0.0;
        }
        for (std::size_t k = 0; k < 2; ++k) wait[k] = held == k ? never : landing(h[k], sigma[k], a[k]);
        for (std::size_t k = 0; k < 2 && held == nobody; ++k) {
            if (h[k] != 0.0 || !(sigma[k] > 0.0) || !(a[k] > 0.0)) continue;
            const double still = 2.0 * sigma[k] / (a[k] * (1.0 - mid(pair.e[k])));
            if (!(still < 1e-9 * std::min(wait[1 - k], 1e2 * std::abs(sigma[1 - k])))) continue;
            sigma[1 - k] -= c * sigma[k] / W[k];
            sigma[k] = 0.0;
            held = k;
        }
        if (held != nobody && wait[held] < never) continue;
        const std::size_t i = wait[0] < wait[1] ? 0 : 1;
        const double t = wait[i];
        if (t == never) break;
        for (std::size_t k = 0; k < 2; ++k) {
            rest.integral[k] += lambda[k] * (h[k] + (sigma[k] / 2.0 - a[k] * t / 6.0) * t) * t;
            if (held != k) h[k] = std::max(0.0, h[k] + (sigma[k] - a[k] * t / 2.0) * t), sigma[k] -= a[k] * t;
        }
        rest.t += t;
        h[i] = 0.0;
        if (held == nobody || c > 0.0) {
            sigma[1 - i] -= (1.0 + mid(pair.e[i])) * sigma[i] * c / W[i];
            held = nobody;
        }
        sigma[i] *= -mid(pair.e[i]);
    }
    return rest;
}

TEST(PairBound, NoPairRestsLaterThanIsClaimed) {
    std::mt19937 random(6);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    int claimed = 0;
    double latest = 0.0;
    for (int i = 0; i < 600; ++i) {
        PairAtCollision pair;
        const double d0 = std::exp(uniform(-1.0, 1.0)), d1 = std::exp(uniform(-1.0, 1.0)), c = uniform(-0.97, 0.97);
        pair.W = {{{Interval(d0 * d0), Interval(c * d0 * d1)}, {Interval(c * d0 * d1), Interval(d1 * d1)}}};
        std::array<double, 2> lambda{std::exp(uniform(-2.0, 2.0)), std::exp(uniform(-2.0, 2.0))};
        if (c < 0.0 && i % 2 == 0) lambda[1] = -c * d0 / d1 * lambda[0] * (i % 4 == 0 ? 1.0 : uniform(0.9, 1.0));
        pair.lambda = {Interval(lambda[0]), Interval(lambda[1])};
        for (std::size_t k = 0; k < 2; ++k)
            pair.a[k] = Interval(mid(pair.W[k][0]) * lambda[0] + mid(pair.W[k][1]) * lambda[1]);
        if (i % 4 == 0 && c < 0.0) pair.a[1] = Interval(0.0);
        pair.e = {Interval(uniform(0.0, 0.9)), Interval(uniform(0.0, 0.9))};
        const std::array<double, 2> h{i % 3 == 0 ? 0.0 : uniform(0.0, 1.0), i % 5 == 0 ? 0.0 : uniform(0.0, 1.0)},
            sigma{uniform(-1.0, 1.0), uniform(-1.0, 1.0)};
        const double det = d0 * d0 * d1 * d1 * (1.0 - c * c);
        const double kinetic =
            (d1 * d1 * sigma[0] * sigma[0] - 2.0 * c * d0 * d1 * sigma[0] * sigma[1] + d0 * d0 * sigma[1] * sigma[1]) /
            det;
        pair.r0 = Interval(std::sqrt(kinetic + 2.0 * (lambda[0] * h[0] + lambda[1] * h[1])));
        const auto bound = pair_bound(pair);
        if (!bound) continue;
        ++claimed;
        const Rest rest = rest_of(pair, h, sigma);
        EXPECT_LE(rest.t, bound->T.hi()) << i;
        EXPECT_LE(std::max(rest.integral[0], rest.integral[1]), bound->J.hi()) << i;
        latest = std::max(latest, rest.t / bound->T.hi());
    }
    EXPECT_GT(claimed, 300);
    EXPECT_GT(latest, 0.1);  // and the bound is not much too large
}

}  // namespace
}  // namespace achilles
