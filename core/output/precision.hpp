// Decimal output that claims no more than is known: bounds rounded outward, and only the meaningful digits of a run's
// numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "number/interval.hpp"
#include "sensitivity/error_estimate.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Bounds and intervals as decimals: conclusions are rounded outward, hypotheses inward. All comparisons of a decimal
// with a double are exact.

// The smallest decimal with this number of digits that is not below x, an upper bound: "3.6e-7".
std::string rounded_up(double x, int digits = 2);
// The greatest such decimal that is not above x: a lower bound, or the time reached by a proof.
std::string rounded_down(double x, int digits = 2);
// A bound, rounded up to two digits. A bound below 1e-16, the rounding of numbers of about 1, is printed as 1e-16.
std::string bound_text(double bound);
// An estimate, which is not a bound: the nearest decimal of one digit, "4e-9".
std::string estimate_text(double estimate);

// "[low, high]", rounded outward, with two digits more than needed to distinguish the ends.
std::string interval_text(double low, double high);
// "2.7251421727(13)", where the parentheses hold the uncertainty in units of the last digit. Contains both ends.
std::string short_text(const Interval& x);
// A conclusion: "= 2.7251421727 +- 1.3e-09", which contains both ends, or "= 2.5" for an interval of exactly that
// number.
std::string outer_text(const Interval& x);
// A hypothesis: "= 0.1" or "in [0.059, 0.061]". The printed numbers lie in the interval: the number as typed, or
// decimals within the widening by interval_of_decimal() at both ends.
std::string inner_text(const Interval& x);

// The meaningful digits of a run's numbers: those that neither the estimated error nor rounding changes. All numbers of
// a run in text output are formatted here; data files have all digits.

// Printed for a number without any known digit.
inline constexpr const char* unknown_number = "?";

// The number with at most `digits` significant digits, rounded at the decimal place of the error's first digit, but with
// at least one digit. "0" if it is less than half a unit of that place; unknown_number if the error is infinite.
std::string known_digits(double value, double error, int digits);
// The number of significant digits that known_digits() prints for a finite error; 0 if it prints "0".
int count_of_known_digits(double value, double error, int digits);
// The number of decimals that such an error leaves, at most `decimals`.
int known_decimals(double error, int decimals);

class EnergyBalance;
class ContactCache;

// Errors of the quantities of a run, for the choice of digits.
class Precision {
 public:
    // The trajectory and its estimate must outlive this object. Without an estimate, only rounding is considered. Not
    // thread-safe.
    explicit Precision(const Trajectory& trajectory, const ErrorEstimate* estimate = nullptr);
    Precision(Precision&&) noexcept;
    Precision& operator=(Precision&&) noexcept;
    ~Precision();

    // Errors of coordinates and rates at a time (s), including rounding; infinite if the estimate does not cover them.
    State of_state(double t) const;
    // Error of the time of an event (s), or of the last event at this time; 0 if there is no such event.
    double of_event(std::size_t event) const;
    double of_time(double t) const;
    // Errors of the gap speed of an impact, and of the energy at an instant.
    double of_gap_speed(std::size_t impact) const;
    double of_energy(const Sample& sample) const;
    // Error of a function of an instant: the sum of the changes by the error of each coordinate and rate.
    template <class Function>
    double of(const Function& value_at, const Sample& sample) const;
    // The time (s) beyond which the run is unreliable, if it is before the end.
    std::optional<double> horizon() const;
    // True for a time beyond the horizon.
    bool is_beyond(double t) const { return horizon() && t > *horizon(); }

 private:
    const Trajectory* trajectory_;
    const ErrorEstimate* estimate_;
    State rounding_, range_;
    std::vector<double> events_;  // errors of event times (s); nondecreasing beyond the horizon
    mutable std::unique_ptr<EnergyBalance> energy_;
    mutable std::unique_ptr<ContactCache> surfaces_;
};

// A coordinate with infinite error is varied over its range. The result is infinite unless the value does not change.
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
