#include "certify/execution.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace achilles::test {

Point point_of(const State& state) {
    Point point;
    for (Eigen::Index i = 0; i < state.q.size(); ++i) {
        point.q.emplace_back(state.q[i]);
        point.v.emplace_back(state.v[i]);
    }
    point.t = state.t;
    return point;
}

template <class Number>
TrueRunsOf<Number>::TrueRunsOf(const Model& model, const List<Number>& parameters, std::size_t most_events,
                               double longest_step)
    : dof_(static_cast<std::size_t>(model.dof())),
      most_events_(most_events),
      motion_(model, parameters, longest_step),
      e_(evaluator(model, model.restitution(), parameters).output(0)) {
    if (!(e_ >= 0 && e_ <= 1)) throw std::invalid_argument("true runs need 0 <= e <= 1");
}

template <class Number>
TrueExecutionOf<Number> TrueRunsOf<Number>::run(const Point& start, double end_time, double cut) {
    flight_ = {start, 0, 0};
    contact_ = false;
    return run(end_time, cut);
}

template <class Number>
TrueExecutionOf<Number> TrueRunsOf<Number>::run_from_contact(const Point& start, double end_time, double cut) {
    Point point = start;
    for (int round = 0; round < 4; ++round) {
        const auto contact = motion_.contact(point);
        for (std::size_t i = 0; i < dof_; ++i) point.q[i] -= contact.h * contact.n[i];
    }
    point = motion_.restart(point, Reinitialization::kinetic);
    const Number hddot = motion_.normal_acceleration(point);
    contact_ = hddot < 0 || (hddot == 0 && motion_.jerk(point) < 0);
    flight_ = {point, 0, hddot > 0 ? 2 : 3};
    return run(end_time, cut);
}

template <class Number>
TrueExecutionOf<Number> TrueRunsOf<Number>::run(double end_time, double cut) {
    end_time_ = end_time;
    cut_ = cut;
    result_ = {};
    if (contact_) result_.start_phase = Phase::Kind::constrained;
    expected_ = end_time;
    while (flight_.time < end_time_) {
        if (result_.events.size() > most_events_)
            throw std::runtime_error("the truth about this bouncing does not end");
        if (contact_) {
            stay();
        } else {
            fly();
        }
    }
    result_.end = flight_.point;
    result_.end_phase = contact_ ? Phase::Kind::constrained : Phase::Kind::hybrid;
    return std::move(result_);
}

// Whether hddot changes by less than 1e-6 of itself in the remaining time. The geometric series assumes a constant
// hddot, which fails at any impact speed if hddot approaches zero.
template <class Number>
bool TrueRunsOf<Number>::settles(const Point& slid, const Number& acceleration, const Number& rest) {
    return abs(motion_.normal_acceleration(motion_.drift(slid, rest)) + acceleration) < 1e-6 * acceleration;
}

template <class Number>
void TrueRunsOf<Number>::fly() {
    // Lower flights need a smaller error.
    const double rise = flight_.known == 1 ? static_cast<double>(motion_.contact(flight_.point).hdot) : 1.0;
    const double tolerance = precision * std::clamp(rise, 1e-12, 1.0);
    if (!motion_.fly(flight_, end_time_ - flight_.time, expected_, tolerance)) {
        flight_.time = end_time_;
        return;
    }
    const auto contact = motion_.contact(flight_.point);
    const Number w = -contact.hdot;
    Point& point = flight_.point;
    const Point slid = motion_.restart(point, Reinitialization::kinetic);
    const Number a = -motion_.normal_acceleration(slid);
    const Number rest = a > 0 && e_ < 1 ? Number(2 * e_ * w / (a * (1 - e_))) : Number(0);
    if (a > 0 && e_ < 1 && (e_ == 0 || (w < cut_ && settles(slid, a, rest)))) {
        result_.events.push_back({Event::Kind::zeno, flight_.time + rest, w, point});
        point = slid;
        contact_ = true;
        return;
    }
    result_.events.push_back({Event::Kind::impact, flight_.time, w, point});
    for (std::size_t i = 0; i < dof_; ++i) point.v[i] += (1 + e_) * w * contact.n[i];
    flight_.known = e_ > 0 ? 1 : 2;
    const double left = static_cast<double>(end_time_ - flight_.time);
    expected_ = a > 0 && e_ > 0 ? std::min(left, 2.2 * static_cast<double>(e_ * w / a)) : left;
}

template <class Number>
void TrueRunsOf<Number>::stay() {
    if (!motion_.stay(flight_, end_time_ - flight_.time, precision)) {
        flight_.time = end_time_;
        return;
    }
    result_.events.push_back({Event::Kind::release, flight_.time, 0, flight_.point});
    contact_ = false;
    flight_.known = 3;
    expected_ = static_cast<double>(end_time_ - flight_.time);
}

template <class Number>
std::optional<DipOf<Number>> TrueRunsOf<Number>::first_dip(const Point& start, double within) {
    FlightOf<Number> flight{start, 0, 0};
    if (!motion_.fly_to_dip(flight, within, within, 1e-22)) return std::nullopt;
    return Dip{flight.time, motion_.contact(flight.point).h, motion_.normal_acceleration(flight.point)};
}

template class TrueRunsOf<Real>;
template class TrueRunsOf<Dual>;

}  // namespace achilles::test
