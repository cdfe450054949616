#include "certify/bouncing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "certify/roots.hpp"

namespace achilles::test {

namespace {

template <class Number>
double size(const List<Number>& x) {
    double most = 0.0;
    for (const Number& entry : x) most = std::max(most, std::abs(static_cast<double>(entry)));
    return most;
}

template <class Number>
PointOf<Number> sum(const std::vector<PointOf<Number>>& coefficients, const Number& t) {
    PointOf<Number> result = coefficients.back();
    result.t = coefficients.front().t + t;
    for (std::size_t k = coefficients.size() - 1; k-- > 0;) {
        for (std::size_t i = 0; i < result.q.size(); ++i) {
            result.q[i] = coefficients[k].q[i] + t * result.q[i];
            result.v[i] = coefficients[k].v[i] + t * result.v[i];
        }
    }
    return result;
}

// The longest step for which a truncated series errs by less than the tolerance, from the sizes of its last two terms.
// Two are needed, since one may vanish by symmetry.
double safe_step(double step, std::size_t order, std::array<double, 2> last, double tolerance) {
    for (std::size_t k = 0; k < 2; ++k)
        if (last[k] > 0.0)
            step = std::min(step, 0.7 * std::pow(tolerance / last[k], 1.0 / static_cast<double>(order - 1 + k)));
    return step;
}

// The whole duration, if expand() stopped before the highest order.
template <class Number>
double safe_step(const std::vector<PointOf<Number>>& path, double duration, double tolerance) {
    if (path.size() <= max_order) return duration;
    const auto term = [&](std::size_t k) { return std::max(size(path[k].v), size(path[k].q)); };
    return safe_step(duration, max_order, {term(max_order - 1), term(max_order)}, tolerance);
}

}  // namespace

Real distance(const Reals& a, const Reals& b) {
    Real total = 0;
    for (std::size_t i = 0; i < a.size(); ++i) total += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(total);
}

template <class Number>
TrueMotionOf<Number>::TrueMotionOf(const Model& model, const Numbers& parameters, double longest_step,
                                   std::size_t contact, Mode mode)
    : dof_(static_cast<std::size_t>(model.dof())),
      clock_(model.layout().t()),
      longest_step_(longest_step),
      e_(evaluator<Number>(model, model.restitution(contact), parameters).output(0)),
      flight_(model.motion(mode).program, model.layout(), parameters),
      contact_motion_(model.motion(mode.with(contact, ContactState::held)).program, model.layout(), parameters),
      gap_(model.gap(contact), model.layout(), parameters),
      release_(model.programs_of(contact, mode).release_terms, model.layout(), parameters),
      surface_(evaluator<Number>(model, model.programs_of(contact, mode).contact_terms, parameters)),
      free_surface_(evaluator<Number>(model, model.programs_of(contact).contact_terms, parameters)),
      normal_(evaluator<Number>(model, model.programs_of(contact, mode).release_terms, parameters)),
      acceleration_(
          evaluator<Number>(model, model.motion(mode.with(contact, ContactState::held)).program, parameters)) {
    for (std::size_t j = 0; j < model.contacts(); ++j) {
        if (j == contact) continue;
        if (mode.is_held(j)) {
            const auto terms = [&](Mode others) {
                return evaluator<Number>(model, model.programs_of(j, others).contact_terms, parameters);
            };
            held_.push_back({terms(mode.without(j).with(contact, ContactState::held)), terms(mode.without(j)),
                             evaluator<Number>(model, model.programs_of(j, mode.without(j)).force, parameters)});
        } else {
            open_.push_back(evaluator<Number>(model, model.gap(j), parameters));
        }
    }
}

template <class Number>
template <class Terms>
void TrueMotionOf<Number>::set(Terms& terms, const Point& point) const {
    for (std::size_t i = 0; i < dof_; ++i) {
        terms.input(i) = point.q[i];
        terms.input(dof_ + i) = point.v[i];
    }
    terms.clock() = point.t;
    terms.run();
}

template <class Number>
typename TrueMotionOf<Number>::Contact TrueMotionOf<Number>::contact(const Point& point) {
    set(surface_, point);
    Contact result{surface_.h(), surface_.hdot(), {}, {}};
    for (std::size_t i = 0; i < dof_; ++i) {
        result.n.push_back(surface_.impulse_direction(i));
        result.g.push_back(surface_.gradient(i));
    }
    return result;
}

// The transmissions are kappa = -g_i n_j, with n_j computed while the remaining contacts are held.
template <class Number>
typename TrueMotionOf<Number>::OtherContacts TrueMotionOf<Number>::others(const Point& point) {
    OtherContacts result;
    set(free_surface_, point);
    for (HeldContact& other : held_) {
        set(other.force, point);
        result.forces.push_back(other.force.output(0));
        set(other.without, point);
        Number kappa = 0;
        for (std::size_t i = 0; i < dof_; ++i) kappa -= free_surface_.gradient(i) * other.without.impulse_direction(i);
        result.transmissions.push_back(kappa);
    }
    for (Evaluator<Number>& gap : open_) {
        set(gap, point);
        result.gaps.push_back(gap.output(0));
    }
    return result;
}

template <class Number>
PointOf<Number> TrueMotionOf<Number>::collision(const State& before) {
    Point point;
    for (std::size_t i = 0; i < dof_; ++i) {
        point.q.emplace_back(before.q[static_cast<Eigen::Index>(i)]);
        point.v.emplace_back(before.v[static_cast<Eigen::Index>(i)]);
    }
    point.t = before.t;
    for (int round = 0; round < 4; ++round) {  // Newton's method from 1e-16; two rounds would suffice
        const Contact c = contact(point);
        Point next = point;
        for (std::size_t i = 0; i < dof_; ++i) next.q[i] -= c.h * c.n[i];
        for (HeldContact& other : held_) {  // along directions that leave the other gaps unchanged
            set(other.with, point);
            for (std::size_t i = 0; i < dof_; ++i) {
                next.q[i] -= other.with.h() * other.with.impulse_direction(i);
                next.v[i] -= other.with.hdot() * other.with.impulse_direction(i);
            }
        }
        point = next;
    }
    return point;
}

template <class Number>
PointOf<Number> TrueMotionOf<Number>::restart(const Point& collision, Reinitialization kind) {
    const Contact c = contact(collision);
    Number g2 = 0;
    for (const Number& entry : c.g) g2 += entry * entry;
    Point result = collision;
    for (std::size_t i = 0; i < dof_; ++i)
        result.v[i] -= c.hdot * (kind == Reinitialization::kinetic ? c.n[i] : Number(c.g[i] / g2));
    return result;
}

// Taylor terms until two in a row are negligible at `duration`, or up to the highest order.
template <class Number>
typename TrueMotionOf<Number>::Coefficients TrueMotionOf<Number>::expand(Evaluator<Series<Number>>& motion,
                                                                         const Point& from, double duration,
                                                                         double tolerance) {
    Coefficients path{from};
    int negligible = 0;
    double power = 1.0;
    for (std::size_t k = 0; k < max_order && negligible < 2; ++k) {
        for (std::size_t i = 0; i < dof_; ++i) {
            motion.set(i, k, path[k].q[i]);
            motion.set(dof_ + i, k, path[k].v[i]);
        }
        motion.set(clock_, k, k == 0 ? from.t : Number(k == 1));
        motion.run(k);
        Point next;
        for (std::size_t i = 0; i < dof_; ++i) {
            next.q.push_back(path[k].v[i] / (k + 1));
            next.v.push_back(motion.output(i, k) / (k + 1));
        }
        power *= duration;
        negligible = std::max(size(next.v), size(next.q)) * power < tolerance ? negligible + 1 : 0;
        path.push_back(next);
    }
    return path;
}

// Taylor coefficients of an output of a program along the path, to the order that the tolerance requires. It may exceed
// that of the path: the sine of a parabola. If the highest order is not sufficient, `step` is reduced.
template <class Number>
List<Number> TrueMotionOf<Number>::along(const Coefficients& path, Evaluator<Series<Number>>& program,
                                         std::size_t output, double& step, double tolerance) {
    Numbers result;
    int negligible = 0;
    double power = 1.0;
    for (std::size_t k = 0; k <= max_order && (negligible < 2 || k < path.size()); ++k) {
        for (std::size_t i = 0; i < dof_; ++i) {
            program.set(i, k, k < path.size() ? path[k].q[i] : Number(0));
            program.set(dof_ + i, k, k < path.size() ? path[k].v[i] : Number(0));
        }
        program.set(clock_, k, k == 0 ? path[0].t : Number(k == 1));
        program.run(k);
        result.push_back(program.output(output, k));
        negligible = std::abs(static_cast<double>(result.back())) * power < tolerance ? negligible + 1 : 0;
        power *= step;
    }
    if (negligible < 2) {
        const auto term = [&](std::size_t k) { return std::abs(static_cast<double>(result[k])); };
        step = safe_step(step, max_order, {term(max_order - 1), term(max_order)}, tolerance);
    }
    return result;
}

// Follows the motion to an event: the first descent of a watched quantity through zero.
template <class Number>
bool TrueMotionOf<Number>::move(Flight& flight, StopCondition until, const Number& longest, double expected,
                                double tolerance) {
    Number left = longest;
    for (int steps = 0; left > 0; flight.known = 0) {
        if (++steps > 3000) throw std::runtime_error("the truth about this motion takes too many steps");
        const double reach = std::min({expected, static_cast<double>(left), longest_step_});
        const bool in_contact = until == StopCondition::release || until == StopCondition::least_force;
        const Coefficients path = expand(in_contact ? contact_motion_ : flight_, flight.point, reach, tolerance);
        double step = safe_step(path, reach, tolerance);
        Numbers watched = along(path, in_contact ? release_ : gap_, 0, step, tolerance);  // hddot, or h
        if (until == StopCondition::dip || until == StopCondition::least_force) watched = derivative(watched);
        if (until == StopCondition::dip || until == StopCondition::release)
            for (Number& c : watched) c = -c;
        // Divides out the known root at 0, which would be found again.
        if (until == StopCondition::impact) watched.erase(watched.begin(), watched.begin() + flight.known);
        const auto event = first_descent(watched, step);
        const Number taken = event ? *event : step < static_cast<double>(left) ? Number(step) : left;
        flight.time += taken;
        flight.point = sum(path, taken);
        left -= taken;
        if (event) return true;
        expected *= 2.0;  // so that the number of steps of a long flight stays small
    }
    return false;
}

template <class Number>
bool TrueMotionOf<Number>::fly(Flight& flight, const Number& longest, double expected, double tolerance) {
    return move(flight, StopCondition::impact, longest, expected, tolerance);
}

template <class Number>
bool TrueMotionOf<Number>::fly_to_dip(Flight& flight, const Number& longest, double expected, double tolerance) {
    return move(flight, StopCondition::dip, longest, expected, tolerance);
}

template <class Number>
bool TrueMotionOf<Number>::stay(Flight& contact, const Number& longest, double tolerance) {
    return move(contact, StopCondition::release, longest, static_cast<double>(longest), tolerance);
}

template <class Number>
bool TrueMotionOf<Number>::stay_to_dip(Flight& contact, const Number& longest, double tolerance) {
    return move(contact, StopCondition::least_force, longest, static_cast<double>(longest), tolerance);
}

template <class Number>
Number TrueMotionOf<Number>::normal_acceleration(const Point& point) {
    set(normal_, point);
    return normal_.hddot();
}

template <class Number>
Number TrueMotionOf<Number>::jerk(const Point& point) {
    set(normal_, point);
    return normal_.jerk();
}

template <class Number>
PointOf<Number> TrueMotionOf<Number>::drift(const Point& slid, const Number& time) {
    set(acceleration_, slid);
    Point result = slid;
    for (std::size_t i = 0; i < dof_; ++i) {
        result.q[i] += slid.v[i] * time;
        result.v[i] += acceleration_.acceleration(i) * time;
    }
    result.t += time;
    return result;
}

template <class Number>
std::optional<ZenoPointOf<Number>> TrueMotionOf<Number>::zeno(const Point& collision, double until) {
    ZenoPoint result{0, collision, 0, {}, {}};
    Point& point = result.point;
    const double first = -static_cast<double>(contact(point).hdot);
    for (; result.impacts < 100000; ++result.impacts) {
        const Contact c = contact(point);
        const Point slid = restart(point, Reinitialization::kinetic);
        const Number w = -c.hdot, a = -normal_acceleration(slid);
        if (!(w > 0) || !(a > 0)) return std::nullopt;
        if (e_ == 0 || w < until * first) {
            const Number rest = 2 * e_ * w / (a * (1 - e_));
            point = constrained(slid, rest, 1e-32);
            result.time += rest;
            return result;
        }
        for (std::size_t i = 0; i < dof_; ++i) point.v[i] += (1 + e_) * w * c.n[i];
        const double expected = 2.2 * static_cast<double>(e_ * w / a), speed = static_cast<double>(w);
        result.velocities.push_back(point.v);
        Flight flight{point, result.time, 1};
        if (!fly(flight, 100 * expected, expected, std::max(1e-32, 1e-20 * speed))) return std::nullopt;
        if (result.flights.size() < flights_kept)
            result.flights.push_back({point, result.time, flight.time - result.time});
        point = flight.point;
        result.time = flight.time;
        result.velocities.push_back(point.v);
    }
    return std::nullopt;
}

template <class Number>
std::vector<InstantOf<Number>> TrueMotionOf<Number>::inside(const ZenoPoint& zeno, double tolerance) {
    std::vector<Instant> result;
    for (std::size_t i = 0; i < zeno.flights.size(); ++i) {
        const auto& flown = zeno.flights[i];
        const Point middle = flight_at(flown.start, {flown.duration / 2}, tolerance)[0];
        Numbers times;
        for (std::size_t k = 1; k < instants_of_flight[i]; ++k)
            times.push_back(flown.duration * k / instants_of_flight[i]);
        times.push_back(flown.duration / 2 - contact(middle).hdot / normal_acceleration(middle));  // the top
        std::sort(times.begin(), times.end());
        const auto points = flight_at(flown.start, times, tolerance);
        for (std::size_t k = 0; k < times.size(); ++k) result.push_back({flown.time + times[k], points[k]});
    }
    return result;
}

template <class Number>
PointOf<Number> TrueMotionOf<Number>::constrained(Point start, const Number& duration, double tolerance) {
    return contact_at(start, {duration}, tolerance).back();
}

// Evaluates one series at all times for which it is accurate.
template <class Number>
std::vector<PointOf<Number>> TrueMotionOf<Number>::follow(Evaluator<Series<Number>>& motion, Point point,
                                                          const Numbers& times, double tolerance) {
    std::vector<Point> result;
    Number from = 0;
    while (result.size() < times.size()) {
        const double left = static_cast<double>(times.back() - from);
        if (!(left > 0.0)) {
            result.resize(times.size(), point);
            break;
        }
        const double reach = std::min(left, longest_step_);
        const Coefficients path = expand(motion, point, reach, tolerance);
        const double length = safe_step(path, reach, tolerance);
        const Number end = length < left ? Number(from + length) : times.back();
        for (; result.size() < times.size() && times[result.size()] <= end;)
            result.push_back(sum(path, times[result.size()] - from));
        point = sum(path, end - from);
        from = end;
    }
    return result;
}

template <class Number>
std::vector<PointOf<Number>> TrueMotionOf<Number>::contact_at(const Point& start, const Numbers& times,
                                                              double tolerance) {
    return follow(contact_motion_, start, times, tolerance);
}

template <class Number>
std::vector<PointOf<Number>> TrueMotionOf<Number>::flight_at(const Point& start, const Numbers& times,
                                                             double tolerance) {
    return follow(flight_, start, times, tolerance);
}

template class TrueMotionOf<Real>;
template class TrueMotionOf<Dual>;

}  // namespace achilles::test
