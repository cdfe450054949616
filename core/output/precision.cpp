#include "output/precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>

#include "enclose/enclosure.hpp"
#include "model/model.hpp"
#include "output/contacts.hpp"
#include "simulate/contact_cache.hpp"

namespace achilles {

namespace {

constexpr int max_digits = 17;  // enough to distinguish any two doubles

// The digits of a number, and the power of ten of the first digit.
struct Digits {
    std::string all;
    int exponent = 0;
};

// |x| exactly, x != 0: a double is a decimal of at most 767 digits.
Digits digits_of(double x) {
    std::array<char, 800> buffer;
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), std::abs(x), std::chars_format::scientific, 766);
    const std::string text(buffer.data(), end.ptr);
    const std::size_t e = text.find('e');
    return {text.substr(0, 1) + text.substr(2, e - 2), std::atoi(text.c_str() + e + 1)};
}

// The power of ten of the first digit of |x|, x != 0.
int leading(double x) {
    const std::string text = fmt::format("{:.20e}", x);
    return std::atoi(text.c_str() + text.find('e') + 1);
}

// number * 10^unit.
struct Decimal {
    std::int64_t number = 0;
    int unit = 0;
};

Digits digits_of(const Decimal& x) {
    Digits result{fmt::format("{}", std::abs(x.number)), 0};
    result.exponent = static_cast<int>(result.all.size()) - 1 + x.unit;
    return result;
}

// True if a < b, for digits of positive numbers. Trailing zeros are ignored.
bool is_less(const Digits& a, const Digits& b) {
    if (a.exponent != b.exponent) return a.exponent < b.exponent;
    const std::size_t size = std::max(a.all.size(), b.all.size());
    return a.all + std::string(size - a.all.size(), '0') < b.all + std::string(size - b.all.size(), '0');
}

bool is_less(const Decimal& a, double b) {
    if (a.number == 0 || b == 0.0) return a.number == 0 ? b > 0.0 : a.number < 0;
    if ((a.number < 0) != (b < 0.0)) return a.number < 0;
    return a.number > 0 ? is_less(digits_of(a), digits_of(b)) : is_less(digits_of(b), digits_of(a));
}

// The greatest multiple of 10^unit that is not above x. Requires fewer than 10^18 multiples below |x|.
Decimal floor_of(double x, int unit) {
    const long double many = static_cast<long double>(x) * std::pow(10.0L, -unit), floor = std::floor(many);
    const long double rounding = 8.0L * std::numeric_limits<long double>::epsilon() * std::abs(many);
    auto number = static_cast<std::int64_t>(floor);
    if (many - floor > rounding && floor + 1.0L - many > rounding) return {number, unit};
    const auto is_above = [&](std::int64_t multiple) { return is_less({-multiple, unit}, -x); };
    while (is_above(number)) --number;
    while (!is_above(number + 1)) ++number;
    return {number, unit};
}

Decimal ceil_of(double x, int unit) { return {-floor_of(-x, unit).number, unit}; }

// In the format of std::format("{}"), but with all digits of x, including trailing zeros.
std::string to_text(const Decimal& x) {
    if (x.number == 0 && x.unit >= 0) return "0";
    Digits digits = digits_of(x);
    const char* const sign = x.number < 0 ? "-" : "";
    constexpr int low = -5, high = 16;  // exponents beyond these are printed in scientific notation
    if (x.number != 0 && (digits.exponent < low || digits.exponent >= high)) {
        if (digits.all.size() > 1) digits.all.insert(1, ".");
        return fmt::format("{}{}e{}", sign, digits.all, digits.exponent);
    }
    if (x.unit >= 0) return sign + digits.all + std::string(static_cast<std::size_t>(x.unit), '0');
    const auto decimals = static_cast<std::size_t>(-x.unit);
    if (digits.all.size() <= decimals) digits.all.insert(0, decimals + 1 - digits.all.size(), '0');
    return sign + digits.all.insert(digits.all.size() - decimals, ".");
}

// Without trailing zeros.
std::string shortened(Decimal x) {
    while (x.number != 0 && x.number % 10 == 0) x.number /= 10, ++x.unit;
    return x.number == 0 ? "0" : to_text(x);
}

// A decimal with the fewest digits in [low, high]; all digits if only a double with very many digits is inside.
std::string shortest_in(double low, double high) {
    if (low <= 0.0 && high >= 0.0) return "0";
    const double large = std::max(std::abs(low), std::abs(high));
    for (int unit = leading(large) + 1; unit > leading(large) - max_digits; --unit) {
        const Decimal inside = ceil_of(low, unit);
        if (!is_less({-inside.number, unit}, -high)) return shortened(inside);
    }
    Digits digits = digits_of(low);
    digits.all.erase(digits.all.find_last_not_of('0') + 1);
    return fmt::format("{}{}.{}e{}", low < 0.0 ? "-" : "", digits.all.substr(0, 1), digits.all.substr(1),
                       digits.exponent);
}

// A center with a limited number of digits, and the distance to the farther end in units of its last digit.
struct Centered {
    Decimal center;
    std::int64_t off = 0;
};

Centered centered(const Interval& x, int min_unit, int max_unit) {
    const double middle = mid(x), half = std::max(x.hi() - middle, middle - x.lo()), large = mag(x);
    int unit = std::clamp(half > 0.0 ? leading(half) - 1 : min_unit, min_unit, max_unit);
    if (large > 0.0) unit = std::max(unit, leading(large) + 1 - max_digits);
    const Decimal below = floor_of(middle, unit), low = floor_of(x.lo(), unit), high = ceil_of(x.hi(), unit);
    Centered result{below, 0};
    // Of the two neighboring decimals, takes the one nearer to the center.
    const std::int64_t up = std::max(below.number + 1 - low.number, high.number - below.number - 1);
    result.off = std::max(below.number - low.number, high.number - below.number);
    if (up < result.off) result = {{below.number + 1, unit}, up};
    return result;
}

bool is_finite(const Interval& x) { return std::isfinite(x.lo()) && std::isfinite(x.hi()); }

// The double that interval_of_decimal() turned into this interval, if there is one.
std::optional<double> written(const Interval& x) {
    const double middle = mid(x);
    for (const double near : {middle, std::nextafter(middle, -HUGE_VAL), std::nextafter(middle, HUGE_VAL)}) {
        const Interval made = interval_of_decimal(near);
        if (made.lo() == x.lo() && made.hi() == x.hi()) return near;
    }
    return std::nullopt;
}

}  // namespace

std::string rounded_up(double x, int digits) {
    if (!std::isfinite(x)) return fmt::format("{}", x);
    return x == 0.0 ? "0" : shortened(ceil_of(x, leading(x) + 1 - digits));
}

std::string rounded_down(double x, int digits) {
    if (!std::isfinite(x)) return fmt::format("{}", x);
    return x == 0.0 ? "0" : shortened(floor_of(x, leading(x) + 1 - digits));
}

std::string estimate_text(double estimate) {
    std::string text = fmt::format("{:.1g}", estimate);
    if (const std::size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
    return text;
}

std::string bound_text(double bound) {
    constexpr double rounding = 1e-16;
    return rounded_up(std::max(bound, rounding));
}

std::string interval_text(double low, double high) {
    if (!std::isfinite(low) || !std::isfinite(high)) return fmt::format("[{}, {}]", low, high);
    const double large = std::max(std::abs(low), std::abs(high));
    if (large == 0.0) return "[0, 0]";
    constexpr int few = 8, more = 2;
    int unit = leading(large) + 1 - few;
    unit = std::min(unit, high > low ? leading(high - low) - more : leading(large) - max_digits);
    unit = std::max(unit, leading(large) + 1 - max_digits);
    return fmt::format("[{}, {}]", shortened(floor_of(low, unit)), shortened(ceil_of(high, unit)));
}

std::string short_text(const Interval& x) {
    if (!is_finite(x)) return fmt::format("[{}, {}]", x.lo(), x.hi());
    constexpr int min_unit = -15;  // finer than the spacing of doubles of a few seconds
    const Centered value = centered(x, min_unit, 0);
    return value.off == 0 ? shortened(value.center) : fmt::format("{}({})", to_text(value.center), value.off);
}

std::string outer_text(const Interval& x) {
    if (!is_finite(x)) return fmt::format("in [{}, {}]", x.lo(), x.hi());
    constexpr int tiny = -300, huge = 300;
    Centered value = centered(x, tiny, huge);
    if (value.off == 0) return "= " + shortened(value.center);
    if (value.off >= 100) value.off = (value.off + 9) / 10 * 10;  // round up to two digits
    const double radius = std::strtod(fmt::format("{}e{}", value.off, value.center.unit).c_str(), nullptr);
    return fmt::format("= {} +- {:.1e}", value.center.number == 0 ? "0" : to_text(value.center), radius);
}

std::string inner_text(const Interval& x) {
    if (!is_finite(x)) return fmt::format("in [{}, {}]", x.lo(), x.hi());
    constexpr double rounded = 0x1p-47;  // bound on the relative widening by interval_of_decimal()
    const double slack = rounded * mag(x);
    if (width(x) <= slack) {
        const std::optional<double> typed = written(x);
        return "= " + (typed ? fmt::format("{}", *typed + 0.0) : shortest_in(x.lo(), x.hi()));
    }
    return fmt::format("in [{}, {}]", shortest_in(x.lo(), x.lo() + 0.5 * slack),
                       shortest_in(x.hi() - 0.5 * slack, x.hi()));
}

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// A coordinate whose error exceeds this share of its range has no known digits.
constexpr double useless_share = 0.1;

// The power of ten of the first digit: -3 for 0.0042.
int place_of(double x) { return static_cast<int>(std::floor(std::log10(x))); }

// Rounding errors, in proportion to a scale. Coordinates of the same unit have a common scale, because they may be
// computed from one another. Angles have a scale of at least 1 rad. Rates have at least that of their coordinate,
// divided by the duration of the run.
State rounding_of(const Trajectory& trajectory) {
    const State own = scale_of(trajectory);
    const auto& coordinates = trajectory.model->description().coordinates;
    const double duration = trajectory.end_time - trajectory.run.options.start_time;
    State scale = own;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        if (coordinates[i].unit == "rad") scale.q[at] = std::max(scale.q[at], 1.0);
        for (std::size_t k = 0; k < coordinates.size(); ++k) {
            if (coordinates[k].unit != coordinates[i].unit) continue;
            scale.q[at] = std::max(scale.q[at], own.q[static_cast<Eigen::Index>(k)]);
            scale.v[at] = std::max(scale.v[at], own.v[static_cast<Eigen::Index>(k)]);
        }
        if (duration > 0.0) scale.v[at] = std::max(scale.v[at], scale.q[at] / duration);
    }
    return {noise * scale.q, noise * scale.v, 0.0};
}

}  // namespace

int count_of_known_digits(double value, double error, int digits) {
    if (value == 0.0) return 0;
    if (!(error > 0.0) || !std::isfinite(value)) return digits;
    if (std::abs(value) < 0.5 * std::pow(10.0, place_of(error))) return 0;
    return std::clamp(place_of(std::abs(value)) - place_of(error) + 1, 1, digits);
}

std::string known_digits(double value, double error, int digits) {
    if (!std::isfinite(error)) return unknown_number;
    const int known = count_of_known_digits(value, error, digits);
    return known == 0 ? "0" : fmt::format("{:.{}g}", value, known);
}

int known_decimals(double error, int decimals) {
    return error > 0.0 && std::isfinite(error) ? std::clamp(-place_of(error), 0, decimals) : decimals;
}

Precision::Precision(const Trajectory& trajectory, const ErrorEstimate* estimate)
    : trajectory_(&trajectory), estimate_(estimate), rounding_(rounding_of(trajectory)) {
    const Vector none = Vector::Zero(trajectory.run.q.size());
    range_ = estimate != nullptr && !estimate->course.entries().empty() ? estimate->course.range() : State{none, none};
    for (Vector* ranges : {&range_.q, &range_.v})
        for (double& range : *ranges) range = std::max(range, ErrorCourse::min_range);
    if (estimate == nullptr) return;
    const double duration = trajectory.end_time - trajectory.run.options.start_time;
    const std::optional<double> horizon = estimate->course.horizon();
    double largest = 0.0;
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const bool is_beyond = horizon && trajectory.events[i].t >= *horizon;
        const bool is_estimated = i < estimate->events.size();
        double error = is_estimated ? estimate->events[i] : is_beyond ? infinite : 0.0;
        if (!(error <= useless_share * duration)) error = infinite;
        if (is_beyond) error = largest = std::max(largest, error);
        events_.push_back(error);
    }
}

Precision::Precision(Precision&&) noexcept = default;
Precision& Precision::operator=(Precision&&) noexcept = default;
Precision::~Precision() = default;

State Precision::of_state(double t) const {
    std::optional<State> sizes = estimate_ != nullptr ? estimate_->course.at(t) : std::nullopt;
    if (!sizes) return rounding_;
    const auto known = [](Vector& all, const Vector& range, const Vector& rounding) {
        for (Eigen::Index i = 0; i < all.size(); ++i)
            all[i] = all[i] > useless_share * range[i] ? infinite : std::max(all[i], rounding[i]);
    };
    known(sizes->q, range_.q, rounding_.q);
    known(sizes->v, range_.v, rounding_.v);
    return *sizes;
}

double Precision::of_event(std::size_t event) const { return event < events_.size() ? events_[event] : 0.0; }

double Precision::of_time(double t) const {
    const auto& events = trajectory_->events;
    const auto after = std::upper_bound(events.begin(), events.end(), t,
                                        [](double time, const Event& event) { return time < event.t; });
    if (after == events.begin() || std::prev(after)->t != t) return 0.0;
    return of_event(static_cast<std::size_t>(after - events.begin()) - 1);
}

double Precision::of_gap_speed(std::size_t impact) const {
    const Event& event = trajectory_->events[impact];
    if (event.contacts.empty()) return 0.0;
    if (surfaces_ == nullptr) surfaces_ = std::make_unique<ContactCache>(*trajectory_->model, trajectory_->run);
    std::size_t contact = 0;
    while (!event.contacts.contains(contact)) ++contact;
    Sample before;
    before.t = event.t;
    before.state = {event.q, event.v_before, event.t};
    return of([&](const Sample& sample) { return surfaces_->of(contact).at(sample.state).hdot; }, before);
}

double Precision::of_energy(const Sample& sample) const {
    if (energy_ == nullptr) energy_ = std::make_unique<EnergyBalance>(*trajectory_->model, trajectory_->run);
    return of([&](const Sample& at) { return energy_->at(at).total(); }, sample);
}

std::optional<double> Precision::horizon() const {
    return estimate_ != nullptr ? horizon_before_end(*trajectory_, *estimate_) : std::nullopt;
}

}  // namespace achilles
