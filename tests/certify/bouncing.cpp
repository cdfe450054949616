#include "certify/bouncing.hpp"

#include <algorithm>
#include <cmath>

namespace achilles::test {

namespace {

double size(const Reals& x) {
    double most = 0.0;
    for (const Real& entry : x) most = std::max(most, std::abs(static_cast<double>(entry)));
    return most;
}

Point sum(const std::vector<Point>& coefficients, const Real& t) {
    Point result = coefficients.back();
    for (std::size_t k = coefficients.size() - 1; k-- > 0;) {
        for (std::size_t i = 0; i < result.q.size(); ++i) {
            result.q[i] = coefficients[k].q[i] + t * result.q[i];
            result.v[i] = coefficients[k].v[i] + t * result.v[i];
        }
    }
    return result;
}

// The longest step for which the series, cut where it is, errs by less than the tolerance: all of the duration where
// expand() stopped early. Judged by two terms, since one may vanish by symmetry.
double safe_step(const std::vector<Point>& path, double duration, double tolerance) {
    double step = duration;
    if (path.size() <= max_order) return step;
    for (std::size_t k = path.size() - 2; k < path.size(); ++k) {
        const double term = std::max(size(path[k].v), size(path[k].q));
        if (term > 0.0) step = std::min(step, 0.7 * std::pow(tolerance / term, 1.0 / static_cast<double>(k)));
    }
    return step;
}

}  // namespace

Real distance(const Reals& a, const Reals& b) {
    Real total = 0;
    for (std::size_t i = 0; i < a.size(); ++i) total += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(total);
}

TrueMotion::TrueMotion(const Model& model, const Run& run)
    : n_(static_cast<std::size_t>(model.n())),
      e_(model.evaluator<Real>(model.restitution(), run.parameters).output(0)),
      flight_(model.flight(), model.layout(), run.parameters),
      contact_motion_(model.contact(), model.layout(), run.parameters),
      gap_(model.gap(), model.layout(), run.parameters),
      surface_(model.evaluator<Real>(model.surface(), run.parameters)),
      acceleration_(model.evaluator<Real>(model.contact(), run.parameters)) {}

TrueMotion::Contact TrueMotion::contact(const Point& point) {
    for (std::size_t i = 0; i < n_; ++i) {
        surface_.input(i) = point.q[i];
        surface_.input(n_ + i) = point.v[i];
    }
    surface_.run();
    Contact result{surface_.output(0), surface_.output(1), {}, {}};
    for (std::size_t i = 0; i < n_; ++i) {
        result.n.push_back(surface_.output(2 + i));
        result.g.push_back(surface_.output(2 + n_ + i));
    }
    return result;
}

Point TrueMotion::collision(const State& before) {
    Point point;
    for (std::size_t i = 0; i < n_; ++i) {
        point.q.emplace_back(before.q[static_cast<Eigen::Index>(i)]);
        point.v.emplace_back(before.v[static_cast<Eigen::Index>(i)]);
    }
    for (int round = 0; round < 4; ++round) {  // Newton from 1e-16: two rounds would do
        const Contact c = contact(point);
        for (std::size_t i = 0; i < n_; ++i) point.q[i] -= c.h * c.n[i];
    }
    return point;
}

Point TrueMotion::restart(const Point& collision, Reinitialization kind) {
    const Contact c = contact(collision);
    Real g2 = 0;
    for (const Real& entry : c.g) g2 += entry * entry;
    Point result = collision;
    for (std::size_t i = 0; i < n_; ++i)
        result.v[i] -= c.hdot * (kind == Reinitialization::kinetic ? c.n[i] : Real(c.g[i] / g2));
    return result;
}

// Terms until two in a row are negligible after `duration`, or there are no more.
TrueMotion::Coefficients TrueMotion::expand(Evaluator<Series>& motion, const Point& from, double duration,
                                            double tolerance) {
    Coefficients path{from};
    int negligible = 0;
    double power = 1.0;
    for (std::size_t k = 0; k < max_order && negligible < 2; ++k) {
        for (std::size_t i = 0; i < n_; ++i) {
            motion.set(i, k, path[k].q[i]);
            motion.set(n_ + i, k, path[k].v[i]);
        }
        motion.run(k);
        Point next;
        for (std::size_t i = 0; i < n_; ++i) {
            next.q.push_back(path[k].v[i] / (k + 1));
            next.v.push_back(motion.output(i, k) / (k + 1));
        }
        power *= duration;
        negligible = std::max(size(next.v), size(next.q)) * power < tolerance ? negligible + 1 : 0;
        path.push_back(next);
    }
    return path;
}

// Where the gap of this path first returns to zero within the step. The certified motions fall all the time (hddot <
// 0), so that Newton's iteration from the end, where the gap is negative, comes down on that root from the right.
std::optional<Real> TrueMotion::landing(const Coefficients& path, const Real& step) {
    Reals gap;
    for (std::size_t k = 0; k < path.size() && k <= max_order; ++k) {
        for (std::size_t i = 0; i < n_; ++i) gap_.set(i, k, path[k].q[i]);
        gap_.run(k);
        gap.push_back(gap_.output(0, k));
    }
    const auto horner = [&](const Real& t) {
        Real value = 0, slope = 0;
        for (std::size_t k = gap.size(); k-- > 0;) {
            slope = slope * t + value;
            value = value * t + gap[k];
        }
        return std::pair{value, slope};
    };
    Real t = step;
    if (horner(t).first > 0) return std::nullopt;
    for (int round = 0; round < 60; ++round) {
        const auto [value, slope] = horner(t);
        const Real correction = value / slope;
        t -= correction;
        if (abs(correction) < 1e-24 * t) break;
    }
    return t;
}

bool TrueMotion::fly(Point& point, Real& time, double expected, double tolerance) {
    for (int step = 0; step < 2000; ++step) {
        const Coefficients path = expand(flight_, point, expected, tolerance);
        const Real length(safe_step(path, expected, tolerance));
        const auto arrival = landing(path, length);
        const Real& taken = arrival ? *arrival : length;
        time += taken;
        point = sum(path, taken);
        if (arrival) return *arrival > 0;
    }
    return false;
}

std::optional<ZenoPoint> TrueMotion::zeno(const Point& collision, double until) {
    ZenoPoint result{0, collision, 0, {}};
    Point& point = result.point;
    const double first = -static_cast<double>(contact(point).hdot);
    for (; result.impacts < 100000; ++result.impacts) {
        const Contact c = contact(point);
        const Point slid = restart(point, Reinitialization::kinetic);
        for (std::size_t i = 0; i < n_; ++i) {
            acceleration_.input(i) = slid.q[i];
            acceleration_.input(n_ + i) = slid.v[i];
        }
        acceleration_.run();
        const Real w = -c.hdot, a = -acceleration_.output(n_);
        if (!(w > 0) || !(a > 0)) return std::nullopt;
        if (e_ == 0 || w < until * first) {
            const Real rest = 2 * e_ * w / (a * (1 - e_));
            for (std::size_t i = 0; i < n_; ++i) {
                point.q[i] += slid.v[i] * rest;
                point.v[i] = slid.v[i] + acceleration_.output(i) * rest;
            }
            result.time += rest;
            return result;
        }
        for (std::size_t i = 0; i < n_; ++i) point.v[i] += (1 + e_) * w * c.n[i];
        const double expected = 2.2 * static_cast<double>(e_ * w / a), speed = static_cast<double>(w);
        result.velocities.push_back(point.v);
        if (!fly(point, result.time, expected, std::max(1e-32, 1e-20 * speed))) return std::nullopt;
        result.velocities.push_back(point.v);
    }
    return std::nullopt;
}

Point TrueMotion::constrained(Point start, const Real& duration, double tolerance) {
    Real left = duration;
    while (left > 0) {
        const double expected = static_cast<double>(left);
        const Coefficients path = expand(contact_motion_, start, expected, tolerance);
        const double length = safe_step(path, expected, tolerance);
        const Real taken = length < expected ? Real(length) : left;
        start = sum(path, taken);
        left -= taken;
    }
    return start;
}

}  // namespace achilles::test
