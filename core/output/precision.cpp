#include "output/precision.hpp"

#include <fmt/format.h>

#include "model/model.hpp"
#include "output/energy.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// An error of more than this share of a coordinate's range leaves nothing of it.
constexpr double useless_share = 0.1;

// The place of the first digit: -3 of 0.0042. Of an error it is the first that it changes.
int place_of(double x) { return static_cast<int>(std::floor(std::log10(x))); }

// The errors that rounding makes: coordinates of one unit are computed from one another, angles from their sine and cosine, and
// a rate is seen by what it moves over the run.
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
        for (double& range : *ranges) range = std::max(range, ErrorCourse::least_range);
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
    if (surfaces_ == nullptr) surfaces_ = std::make_unique<Surfaces>(*trajectory_->model, trajectory_->run);
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
