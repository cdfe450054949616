#include "simulate/domain_monitor.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "model/domain_boundaries.hpp"
#include "model/undefined_term.hpp"

namespace achilles {

namespace {

constexpr int counted = 4;  // last terms of a series that are used: symmetry may make three in a row 0
constexpr int lowest = 8;
constexpr double settled = 0x1p-10;  // the part of the start below which the last terms of a series end it
constexpr int highest = SeriesEvaluator<double>::highest_order;
static_assert(highest < Polynomial::capacity);

// A part of [0, 1], from 0, in which p stays positive as at 0: each further term takes at most an equal share of the
// first one.
double positive_part(const Polynomial& p) {
    double theta = 1.0;
    for (int k = 1; k <= p.degree; ++k) {
        const double part = p.c[0] / (p.degree * std::abs(p.c[static_cast<std::size_t>(k)]));
        if (part < 1.0) theta = std::min(theta, std::pow(part, 1.0 / k));
    }
    return theta;
}

// Sum of the absolute values of the last terms.
double tail(const Polynomial& p) {
    double sum = 0.0;
    for (int k = p.degree; k > p.degree - counted; --k) sum += std::abs(p.c[static_cast<std::size_t>(k)]);
    return sum;
}

}  // namespace

DomainMonitor::DomainMonitor(const Model& model, const Run& run)
    : edges_(model.edges()),
      block_(2 * static_cast<std::size_t>(model.dof())),
      series_(model.edge_series(), run.parameters),
      distances_(edges_.size()),
      sums_(edges_.size()),
      signs_(edges_.size()) {}

// An exponential or hyperbolic function has a distance, too (model/domain_boundaries.hpp): `growth` minus the rise of
// u, or minus twice the fall of |u|. Returns the factor of the series of u in that distance; 0 if |u| is too small for
// the function to be missed.
double DomainMonitor::sign_of(const DomainBoundary& edge, double start) const {
    if (edge.kind == DomainBoundary::Kind::edge) return 1.0;
    if (edge.kind == DomainBoundary::Kind::exponential) return -1.0;
    return std::abs(start) < DomainBoundary::growth ? 0.0 : std::copysign(2.0, start);
}

// The distance of one edge at the start of a step, whose series has begun. Also sets the factor of its higher terms.
double DomainMonitor::begin_distance(std::size_t i) {
    const double start = series_.start(i);
    signs_[i] = sign_of(edges_[i], start);
    return edges_[i].kind == DomainBoundary::Kind::edge ? start : DomainBoundary::growth;
}

// Whether safe_part() is 1, from the motion in time, whose polynomials over the step need not be formed. The distances
// are expanded as far as there, but by a limited number of orders. Each lies above its smallest partial sum
// (first_descent()) minus the terms that are left out, which are below the last ones. False means unknown.
bool DomainMonitor::is_safe(const Stepper::TimeSeries& motion, double time, double span) {
    series_.begin(motion.first, time);
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const double start = begin_distance(i);
        if (!(start > 0.0)) return false;
        sums_[i] = {start, start, start, &series_.output(i), {}};
    }
    static constexpr std::array<double, 2 * max_coordinates> zeros{};
    const double* order = motion.first;
    double power = span;
    for (int k = 1; k <= 2 * lowest; ++k, power *= span) {
        series_.extend(k, k <= motion.degree ? order += motion.width : zeros.data());
        const std::size_t place = static_cast<std::size_t>(k) % counted;
        const double* sign = signs_.data();
        for (PartialSum& each : sums_) {
            const double term = *sign++ * *each.output * power;
            each.sum += term;
            each.least = std::min(each.least, each.sum);
            each.last[place] = std::abs(term);
        }
        const auto is_known = [](const PartialSum& each) { return each.tail() < settled * each.start; };
        if (k < lowest || !std::all_of(sums_.begin(), sums_.end(), is_known)) continue;
        return std::all_of(sums_.begin(), sums_.end(),
                           [](const PartialSum& each) { return each.least > 0.125 * each.start + 2.0 * each.tail(); });
    }
    return false;
}

// The motion in a step is a polynomial in theta, whatever the method, so the distances are series in theta. They are
// expanded until their last terms are small.
double DomainMonitor::safe_part(const Stepper& stepper, double time) {
    motion_.clear();
    const auto motion = stepper.time_series();
    if (motion && is_safe(*motion, time, stepper.current_time())) return 1.0;
    degree_ = stepper.coefficients(motion_);
    motion_.resize(motion_.size() + block_, 0.0);
    series_.begin(motion_.data(), time, stepper.current_time());
    for (std::size_t i = 0; i < distances_.size(); ++i) distances_[i].c[0] = begin_distance(i);
    bool known = false;
    for (int k = 1; k <= highest && !known; ++k) {
        series_.extend(k, motion_.data() + std::min<std::size_t>(static_cast<std::size_t>(k), degree_ + 1) * block_);
        known = k >= lowest;
        for (std::size_t i = 0; i < distances_.size(); ++i) {
            Polynomial& distance = distances_[i];
            distance.c[static_cast<std::size_t>(k)] = signs_[i] * series_.output(i);
            distance.degree = k;
            known = known && tail(distance) < settled * distance.c[0];
        }
    }
    double theta = 1.0;
    for (Polynomial& distance : distances_) theta = std::min(theta, safe_part(distance));
    return theta;
}

double DomainMonitor::safe_part(Polynomial& distance) const {
    const double start = distance.c[0], allowed = 0x1p-6 * start;
    if (!(start > 0.0)) return 0.0;
    // The series is accurate as far as its last terms are small. If the step is far too long, the last terms may have
    // overflowed, or `allowed` divided by them underflows; they are dropped.
    while (distance.degree > lowest && !(allowed / tail(distance) > 0.0)) --distance.degree;
    double known = 1.0;
    for (int k = distance.degree; k > distance.degree - counted; --k) {
        const double c = std::abs(distance.c[static_cast<std::size_t>(k)]);
        if (!(c <= allowed)) known = std::min(known, std::isfinite(c) ? std::pow(allowed / c, 1.0 / k) : 0.0);
    }
    double power = known;
    for (int k = 1; known < 1.0 && k <= distance.degree; ++k, power *= known)
        distance.c[static_cast<std::size_t>(k)] *= power;
    // Subtract an eighth of the start, and the last terms as an estimate of the omitted ones. As long as the rest is
    // positive, which it is at the start, the distance is above an eighth of its start value.
    distance.c[0] -= 0.125 * start + tail(distance);
    const FirstCrossing descent = first_descent(distance, 0, 0.0);
    if (descent.kind == FirstCrossing::Kind::none) return known;
    return known * (descent.theta > 0.0 ? descent.theta : positive_part(distance));
}

namespace {

using Values = std::vector<Interval>;  // q, v, t

// The first undefined part of the expressions over a box, with the value of its operand at the state; empty if there is
// none.
std::string undefined_among(const Model& model, const Run& run, std::span<const Expression> expressions,
                            const State& state, const Values& box, const char* name) {
    const auto found = first_undefined(model, run.parameters, expressions, state, box);
    if (!found) return "";
    return fmt::format("{} in {} becomes undefined, with {} = {:.3g}", found->part, name, found->operand, found->value);
}

// The first function that may reach its edge in the box, where it has a value but is not smooth; empty if there is
// none.
std::string first_edge(const Model& model, const Run& run, const State& state, const Values& box) {
    for (const DomainBoundary& edge : model.edges()) {
        if (edge.kind != DomainBoundary::Kind::edge) continue;
        const Program program(std::span(&edge.event_function, 1), model.layout().slots());
        auto distance = model.evaluator<Interval>(program, run.parameters);
        set_box(distance, box);
        distance.run();
        if (certainly_positive(distance.output(0))) continue;
        return fmt::format("{} in {} reaches a point where it is not smooth, with {} = {:.3g}",
                           shortened(model, edge.function), edge.place, shortened(model, edge.argument),
                           value_at(model, run.parameters, edge.argument, state));
    }
    return "";
}

// The first pivot of M that is not positive on the whole box, with its value at the state; empty if there is none.
std::string first_bad_pivot(const Model& model, const Run& run, const State& state, const Values& box) {
    const Program program(model.equations().pivots, model.layout().slots());
    auto enclosure = model.evaluator<Interval>(program, run.parameters);
    auto value = model.evaluator(program, run.parameters);
    set_box(enclosure, box);
    enclosure.run();
    set_state(value, state);
    value.run();
    for (std::size_t i = 0; i < program.output_count(); ++i) {
        const Interval pivot = enclosure.output(i);
        if (!pivot.is_defined() || certainly_positive(pivot)) continue;
        return fmt::format("the mass matrix is no longer positive definite: the pivot of '{}' is {:.3g}",
                           model.description().coordinates[i].name, value.output(i));
    }
    return "";
}

// Checks the user's expressions first: a message about the derivative 1/x of log(x) would not help.
std::string undefined_in(const Model& model, const Run& run, const State& state, const Values& box) {
    const Equations& e = model.equations();
    const auto look = [&](const std::vector<Expression>& expressions, const char* name) {
        return undefined_among(model, run, expressions, state, box, name);
    };
    std::string found = look({e.given.kinetic}, "the kinetic energy");
    if (found.empty()) found = look({e.given.potential}, "the potential");
    if (found.empty()) found = look(e.gaps, "the gap");
    if (found.empty()) found = look(e.given.Q, "the forces");
    if (found.empty()) found = first_edge(model, run, state, box);
    if (found.empty()) found = first_bad_pivot(model, run, state, box);
    if (found.empty()) found = look(e.free.f, "the equations of motion");
    return found;
}

}  // namespace

std::string edge_of_domain(const Model& model, const Run& run, const State& state) {
    const double scale = std::max(1e-3, std::abs(state.t));
    for (const double reach : {1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9}) {
        Values box = box_of(state);
        for (Eigen::Index i = 0; i < state.q.size(); ++i) {
            const double ahead = state.q[i] + reach * scale * state.v[i];
            box[static_cast<std::size_t>(i)] = hull(Interval(state.q[i]), Interval(ahead));
        }
        box.back() = Interval(state.t, state.t + reach * scale);
        const std::string found = undefined_in(model, run, state, box);
        if (!found.empty()) return found;
    }
    return "";
}

std::string edge_of_contact(const Model& model, const Run& run, const State& state) {
    return undefined_in(model, run, state, box_of(state));
}

}  // namespace achilles
