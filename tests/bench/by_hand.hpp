// The two problems of the paper's Fig. 4 written by hand, for the programs that the engine is compared with. The
// equations are derived on paper, and the compiler knows the parameters.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

namespace achilles::bench {

using Values = std::array<double, 4>;  // q (2), v (2)

// Options of a program written by hand.
struct Settings {
    double tolerance = 1e-9;  // absolute and relative
    double cut = 1e-3;        // impact speed below which a plastic impact ends the sequence
    double end_time = 20.0;
};

struct Result {
    Values end{};
    int impacts = 0, zenos = 0, releases = 0;
};

// Example 3 with m = g = 1, e = 0.5.
struct Ball {
    static constexpr double e = 0.5;
    static double gap(const Values& y) { return y[1] - std::sin(y[0]); }
    static double gap_rate(const Values& y) { return y[3] - std::cos(y[0]) * y[2]; }
    static std::array<double, 2> normal(const Values& y) {  // M^-1 g'/W
        const double c = std::cos(y[0]);
        return {-c / (1.0 + c * c), 1.0 / (1.0 + c * c)};
    }
    static double normal_acceleration(const Values& y) { return std::sin(y[0]) * y[2] * y[2] - 1.0; }
    static void flight(const Values& y, Values& rate) { rate = {y[2], y[3], 0.0, -1.0}; }
    static void contact(const Values& y, Values& rate) {
        const double s = std::sin(y[0]), c = std::cos(y[0]), push = (1.0 - s * y[2] * y[2]) / (1.0 + c * c);
        rate = {y[2], y[3], -c * push, push - 1.0};
    }
};

// Example 4 with all parameters 1, e = 0.5.
struct Pendulum {
    static constexpr double e = 0.5;
    static double gap(const Values& y) { return y[1]; }
    static double gap_rate(const Values& y) { return y[3]; }
    static std::array<double, 2> normal(const Values& y) {
        const double c = std::cos(y[1]);
        return {-(c / 2.0 + 1.0 / 3.0) / (5.0 / 3.0 + c), 1.0};
    }
    static double normal_acceleration(const Values& y) {
        Values rate;
        flight(y, rate);
        return rate[3];
    }
    static void flight(const Values& y, Values& rate) {
        const double c = std::cos(y[1]), k = std::sin(y[1]) / 2.0, far = std::sin(y[0] + y[1]) / 2.0;
        const double m11 = 5.0 / 3.0 + c, m12 = c / 2.0 + 1.0 / 3.0, m22 = 1.0 / 3.0;
        const double b1 = -k * (2.0 * y[2] + y[3]) * y[3] + 1.5 * std::sin(y[0]) + far;
        const double b2 = k * y[2] * y[2] + far;
        const double d = 1.0 / (m11 * m22 - m12 * m12);
        rate = {y[2], y[3], d * (m12 * b2 - m22 * b1), d * (m12 * b1 - m11 * b2)};
    }
    static void contact(const Values& y, Values& rate) {
        flight(y, rate);
        const auto n = normal(y);
        rate[2] -= n[0] * rate[3];
        rate[3] = 0.0;
    }
};

// The impact, common to both programs.
template <class Problem>
void bounce(Values& y, double hdot, double e) {
    const auto n = Problem::normal(y);
    y[2] -= (1.0 + e) * hdot * n[0];
    y[3] -= (1.0 + e) * hdot * n[1];
}

template <class Problem>
void project(Values& y) {
    for (int round = 0; round < 2; ++round) {
        const double h = Problem::gap(y);
        const auto n = Problem::normal(y);
        y[0] -= h * n[0];
        y[1] -= h * n[1];
    }
    bounce<Problem>(y, Problem::gap_rate(y), 0.0);
}

// One program; it keeps its memory between runs.
class Program {
 public:
    virtual ~Program() = default;
    virtual Result run(const Values& start, const Settings& settings) = 0;
};

// Problem: Ball or Pendulum.
template <class Problem>
std::unique_ptr<Program> by_odeint();
template <class Problem>
std::unique_ptr<Program> by_arkode();

}  // namespace achilles::bench
