// Numbers as decimals that claim no more than is known: bounds, rounded to the safe side, and the digits of a run that mean
// something.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "depend/error_estimate.hpp"
#include "number/interval.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Bounds and intervals as decimals that claim no more than the numbers they print: what is concluded is rounded outward,
// what is assumed is rounded inward. Every comparison of a decimal with a double is exact.

// The least decimal of so many digits that is not below x, an upper bound: "3.6e-7".
std::string rounded_up(double x, int digits = 2);
// The greatest one that is not above x: a lower bound, or the time that a proof reaches.
std::string rounded_down(double x, int digits = 2);
// A bound, rounded up to two digits; one below 1e-16, the rounding of numbers about 1, is printed as that.
std::string bound_text(double bound);
// An estimate, which bounds nothing: its nearest decimal of one digit, "4e-9".
std::string estimate_text(double estimate);

// "[low, high]", rounded outward, with as many digits as tell the ends apart and two more.
std::string interval_text(double low, double high);
// "2.7251421727(13)": the last digits of the number may be off by so many of them. Both ends are inside.
std::string short_text(const Interval& x);
// "= 2.7251421727 +- 1.3e-09": a conclusion. Both ends are inside. "= 2.5" where the interval is exactly that.
std::string outer_text(const Interval& x);
// "= 0.1" or "in [0.059, 0.061]": a hypothesis. What is printed lies in the interval: what a person wrote, or a decimal
// between it and what as_written() adds on both sides.
std::string inner_text(const Interval& x);

// Which digits of a run's numbers mean something: those that neither its estimated error nor rounding changes. Every number that
// a person reads of a run goes through here; files of data hold all digits.

// Printed in place of a number of which no digit is known.
inline constexpr const char* unknown_number = "?";

// The number as {:.{digits}g} prints it, without the digits behind the first that such an error changes; 0 where that is all of
// them, unknown_number where the error is infinite.
std::string known_digits(double value, double error, int digits);
// How many digits that is: 0 where the number is 0 to its error.
int count_of_known_digits(double value, double error, int digits);
// How many decimals such an error leaves, of so many.
int known_decimals(double error, int decimals);

class EnergyBalance;
class Surfaces;

class Precision {
 public:
    // Of a run that outlives this, as its estimate does; without one rounding alone is known. Not for two threads at once.
    explicit Precision(const Trajectory& trajectory, const ErrorEstimate* estimate = nullptr);
    Precision(Precision&&) noexcept;
    Precision& operator=(Precision&&) noexcept;
    ~Precision();

    // Errors of coordinates and rates at a time, at least of rounding; infinite where the estimate says that nothing is known.
    State of_state(double t) const;
    // Of the time of an event; of the last event at this time, 0 where there is none (s).
    double of_event(std::size_t event) const;
    double of_time(double t) const;
    // Of the gap speed of an impact, and of the energy at an instant.
    double of_gap_speed(std::size_t impact) const;
    double of_energy(const Sample& sample) const;
    // Of any function of an instant: the sum of what the error of each coordinate and rate changes of it.
    template <class Function>
    double of(const Function& value_at, const Sample& sample) const;
    // Where the horizon comes before the end (s).
    std::optional<double> horizon() const;
    // Whether a time lies behind the horizon.
    bool is_beyond(double t) const { return horizon() && t > *horizon(); }

 private:
    const Trajectory* trajectory_;
    const ErrorEstimate* estimate_;
    State rounding_, range_;
    std::vector<double> events_;  // of their times; behind the horizon none becomes smaller
    mutable std::unique_ptr<EnergyBalance> energy_;
    mutable std::unique_ptr<Surfaces> surfaces_;
};

// A coordinate whose error hides it does not matter where the value does not depend on it.
template <class Function>
double Precision::of(const Function& value_at, const Sample& sample) const {
    const double here = value_at(sample);
    if (!std::isfinite(here)) return 0.0;
    const State errors = of_state(sample.t);
    double sum = 0.0;
    Sample moved = sample;
    for (Eigen::Index k = 0; k < 2 * errors.q.size(); ++k) {
        const bool is_rate = k >= errors.q.size();
        const Eigen::Index i = is_rate ? k - errors.q.size() : k;
        const double error = (is_rate ? errors.v : errors.q)[i], range = (is_rate ? range_.v : range_.q)[i];
        double& x = (is_rate ? moved.state.v : moved.state.q)[i];
        const double before = x;
        double change = -1.0;
        for (const double side : {-1.0, 1.0}) {
            x = before + side * (std::isfinite(error) ? error : range);
            const double there = std::abs(value_at(moved) - here);
            if (std::isfinite(there)) change = std::max(change, there);
        }
        x = before;
        if (change < 0.0 || (!std::isfinite(error) && change > 0.0)) return std::numeric_limits<double>::infinity();
        sum += change;
    }
    return sum;
}

}  // namespace achilles
