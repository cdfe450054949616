// Continuation of a periodic orbit in a parameter.
#include "analysis/orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "analysis/return_map.hpp"
#include "model/model.hpp"

namespace achilles {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double first_step = 0.02, longest_step = 0.04, shortest_step = 1e-7;
constexpr std::size_t max_branch_points = 2000;

class BranchContinuation {
 public:
    BranchContinuation(const ReturnMap& map, const ShootingSolver& newton, Branch& branch, double low, double high)
        : map_(map), newton_(newton), branch_(branch), p_(branch.parameter), low_(low), high_(high) {}

    // Follows the branch from a converged orbit along its tangent. Adds the points, and returns the reason for its end.
    std::string go(ConvergedOrbit from) {
        at_ = std::move(from);
        point_ = orbit_of(map_, at_);
        double ds = first_step;
        while (points_.size() < max_branch_points) {
            if (nears_zeno_loss(ds)) {
                if (const auto why = find_zeno_loss()) return *why;
            }
            std::optional<ConvergedOrbit> next;
            try {
                if (const auto bound = beyond(ds)) {
                    end_at(*bound);
                    return "the end of the range";
                }
                next = stepped(ds);
            } catch (const OrbitNotFound& none) {
                if ((ds *= 0.5) < shortest_step) return end_reason(none);
                continue;
            }
            const double turn = at_.tangent.dot(next->tangent);
            const bool other = next->shot.event_signature != at_.shot.event_signature;
            constexpr double near_change = 1e-5;
            if ((turn < 0.9 || (other && ds > near_change)) && ds > 2.0 * shortest_step) {
                ds *= 0.5;
                continue;
            }
            if (value_of(*next) < low_ || value_of(*next) > high_) {
                ds *= 0.5;
                continue;
            }
            OrbitPoint point = orbit_of(map_, *next);
            find_events(*next, ds);
            if (other) branch_.changes.push_back(point);
            before_ = {{value_of(at_), point_.psi.value_or(0.0)}};
            if (!point_.psi || other) before_.reset();
            points_.push_back(point);
            at_ = std::move(*next);
            point_ = std::move(point);
            rebase();
            if (turn > 0.975 && at_.iterations <= 5) ds = std::min(1.6 * ds, longest_step);
        }
        return fmt::format("the branch has more than {} points", max_branch_points);
    }
    std::vector<OrbitPoint>& points() { return points_; }

 private:
    static double lambda(const ConvergedOrbit& closed) { return closed.tangent[closed.tangent.size() - 1]; }
    double value_of(const ConvergedOrbit& closed) const { return closed.lap.parameters[p_]; }

    ConvergedOrbit stepped(double ds) const {
        const VectorXd predicted = newton_.scaled(at_.lap) + ds * at_.tangent;
        return newton_.close(newton_.lap_at(at_.lap, predicted), at_.tangent, predicted, at_.tangent, 8);
    }
    // A converged orbit at this value of the parameter; `like` is a nearby one.
    ConvergedOrbit at_value(const ConvergedOrbit& like, double value) const {
        const Index last = like.tangent.size() - 1;
        VectorXd y = newton_.scaled(like.lap);
        const double step = value / newton_.scale()[last] - y[last];
        if (std::abs(like.tangent[last]) > 1e-3) y += like.tangent * (step / like.tangent[last]);
        ShootingPoint lap = newton_.lap_at(like.lap, y);
        lap.parameters[p_] = value;
        return newton_.close(lap, {}, {}, like.tangent, 12);
    }

    // The end of the range, if the step would pass it.
    std::optional<double> beyond(double ds) const {
        const double predicted = value_of(at_) + ds * lambda(at_) * (high_ - low_);
        if (predicted < low_) return low_;
        return predicted > high_ ? std::optional(high_) : std::nullopt;
    }
    void end_at(double bound) {
        if (value_of(at_) == bound) return;
        ConvergedOrbit end = at_value(at_, bound);
        const OrbitPoint point = orbit_of(map_, end);
        if (at_.tangent.dot(end.tangent) < 0.0) end.tangent = -end.tangent;
        find_events(end, std::nullopt);
        points_.push_back(point);
    }

    // The largest value of any gap at step ends and in the middle of steps.
    double largest_gap() const {
        const Trajectory& run = at_.shot.run;
        const Model& model = *run.model;
        double largest = 0.0;
        for (std::size_t contact = 0; contact < model.contacts(); ++contact) {
            Evaluator<double> gap = model.evaluator(model.gap(contact), run.run.parameters);
            for (const DenseSegment& piece : run.pieces)
                for (const double t : {0.5 * (piece.start + piece.end), piece.end}) {
                    set_state(gap, state_in(piece, run.coefficients, model.dof(), t));
                    gap.run();
                    largest = std::max(largest, gap.output(0));
                }
        }
        return largest;
    }

    // The reason why no step succeeds: the flights shrink to zero at this value of the parameter, or the message of the
    // search.
    std::string end_reason(const OrbitNotFound& none) const {
        constexpr double low = 1e-7;  // relative to the distance that the system moves in a period
        const double way = at_.shot.run.run.v.cwiseAbs().maxCoeff() * at_.lap.period, gap = largest_gap();
        if (map_.model()->contacts() == 0 || !(gap < low * way)) return none.what();
        return fmt::format("the flights shrink to zero: the gap never exceeds {:.1e} at {:.6g}", gap, value_of(at_));
    }

    // ---- events between two points ----

    using Test = std::function<double(const ConvergedOrbit&)>;
    double of_multipliers(const ConvergedOrbit& closed, bool pairs) const {
        std::size_t zeros = 0;
        const auto free = free_multipliers(map_, closed.shot, zeros);
        std::complex<double> product = 1.0;
        for (std::size_t i = 0; i < free.size(); ++i) {
            if (!pairs) product *= free[i] + 1.0;
            for (std::size_t j = i + 1; pairs && j < free.size(); ++j) product *= free[i] * free[j] - 1.0;
        }
        return product.real();
    }
    bool is_circle(const OrbitPoint& point) const {
        return std::any_of(point.multipliers.begin(), point.multipliers.end(),
                           [](const auto& mu) { return mu.imag() != 0.0 && std::abs(std::abs(mu) - 1.0) < 1e-3; });
    }

    void find_events(const ConvergedOrbit& next, std::optional<double> ds) {
        const auto look = [&](const Test& test, std::vector<OrbitPoint>& found, const auto& is_so) {
            const double a = test(at_), b = test(next);
            if (!(a * b < 0.0)) return;
            try {
                const ConvergedOrbit there = ds ? between(test, a, b, *ds) : between_values(next, test, a, b);
                OrbitPoint at = orbit_of(map_, there);
                if (is_so(at)) found.push_back(std::move(at));
            } catch (const OrbitNotFound&) {
                // The test function jumps across zero: there is no such event.
            }
        };
        const auto always = [](const OrbitPoint&) { return true; };
        look(lambda, branch_.folds, always);
        look([&](const ConvergedOrbit& c) { return of_multipliers(c, false); }, branch_.flips, always);
        look([&](const ConvergedOrbit& c) { return of_multipliers(c, true); }, branch_.neimark_sacker,
             [&](const OrbitPoint& at) { return is_circle(at); });
    }

    // The zero of a test function by the Illinois method, over the step length or over the parameter.
    template <class At>
    static ConvergedOrbit zero(const Test& test, double low, double high, double a, double b, double resolution,
                               const At& at) {
        ConvergedOrbit there;
        for (int round = 0; round < 60; ++round) {
            double s = (a * high - b * low) / (a - b);
            if (!(s > std::min(low, high) && s < std::max(low, high))) s = 0.5 * (low + high);
            there = at(s);
            const double value = test(there);
            if (value == 0.0 || std::abs(high - low) < resolution) break;
            if (value * b < 0.0) {
                low = high, a = b;
            } else {
                a *= 0.5;
            }
            const bool done = std::abs(s - high) < resolution;
            high = s, b = value;
            if (done) break;
        }
        return there;
    }
    ConvergedOrbit between(const Test& test, double a, double b, double ds) const {
        return zero(test, 0.0, ds, a, b, 1e-14, [&](double s) { return stepped(s); });
    }
    ConvergedOrbit between_values(const ConvergedOrbit& next, const Test& test, double a, double b) const {
        return zero(test, value_of(at_), value_of(next), a, b, 1e-14 * std::abs(high_ - low_),
                    [&](double value) { return at_value(at_, value); });
    }

    // ---- the loss of a Zeno point ----

    // Whether psi, which is linear in the parameter, would reach zero within a few steps.
    bool nears_zeno_loss(double ds) const {
        if (!before_ || !point_.psi || no_loss_found_) return false;
        const double x0 = (*before_)[0], psi0 = (*before_)[1], x1 = value_of(at_), psi1 = *point_.psi;
        if (!(psi1 < psi0) || x0 == x1) return false;
        const double left = psi1 * (x1 - x0) / (psi0 - psi1);  // change of the parameter until psi is 0
        const double reach = 3.0 * ds * std::abs(lambda(at_)) * (high_ - low_);
        const double there = x1 + left;
        return std::abs(left) < reach && there > low_ && there < high_;
    }

    // Finds the loss of a Zeno point by the secant method, from the side where the orbit exists. Returns nullopt if
    // there is no loss.
    std::optional<std::string> find_zeno_loss() {
        double x0 = (*before_)[0], psi0 = (*before_)[1], x1 = value_of(at_), psi1 = *point_.psi;
        ConvergedOrbit near = at_;
        OrbitPoint point = point_, first = point_;
        std::vector<OrbitPoint> passed;
        const double range = high_ - low_;
        double where = 0.0, before = std::numeric_limits<double>::infinity(), share = 0.4;
        int refused = 0;
        for (int round = 0; round < 60; ++round) {
            where = x1 + psi1 * (x1 - x0) / (psi0 - psi1);
            ConvergedOrbit next;
            OrbitPoint reached;
            const double target = x1 + share * (where - x1);
            try {
                next = at_value(near, target);
                reached = orbit_of(map_, next);
                if (!reached.psi || !(*reached.psi < psi1) || reached.event_signature != point.event_signature)
                    throw OrbitNotFound("the Zeno point is not lost there");
            } catch (const OrbitNotFound&) {
                share *= 0.5;
                if (++refused == 6) break;
                continue;
            }
            x0 = x1, psi0 = psi1;
            x1 = target, psi1 = *reached.psi;
            near = std::move(next);
            point = std::move(reached);
            passed.push_back(point);
            share = std::min(0.9, 1.5 * share);
            // Converged: a further point would agree to all digits of the runs.
            const double there = x1 + psi1 * (x1 - x0) / (psi0 - psi1);
            if (std::abs(there - before) < 1e-13 * range || psi1 < 1e-10 * *first.psi) break;
            before = there;
        }
        where = x1 + psi1 * (x1 - x0) / (psi0 - psi1);
        // At a loss, the contact time vanishes together with psi. Otherwise something else vanishes, such as the whole
        // motion.
        if (psi1 > 1e-3 * *first.psi || !(point.shortest_contact < 0.2 * first.shortest_contact)) {
            no_loss_found_ = true;
            return std::nullopt;
        }
        // The other data are extrapolated linearly to the loss, from points as close as can be computed.
        OrbitPoint lost = point;
        const OrbitPoint& by = passed.size() > 1 ? passed[passed.size() - 2] : first;
        const double share_left = (where - x1) / (x1 - by.parameters[p_]);
        for (const auto state : {&OrbitPoint::state, &OrbitPoint::flight}) {
            (lost.*state).q += share_left * ((point.*state).q - (by.*state).q);
            (lost.*state).v += share_left * ((point.*state).v - (by.*state).v);
        }
        lost.period += share_left * (point.period - by.period);
        const auto is_real = [](const OrbitPoint& one) {
            return std::all_of(one.multipliers.begin(), one.multipliers.end(),
                               [](const auto& mu) { return mu.imag() == 0.0; });
        };
        for (std::size_t i = 0; i < lost.multipliers.size() && is_real(by) && is_real(point); ++i)
            lost.multipliers[i] += share_left * (point.multipliers[i] - by.multipliers[i]);
        lost.parameters[p_] = where;
        lost.psi = 0.0;
        lost.margins.a_inf = 0.0;
        lost.shortest_contact = 0.0;
        // Points too close to be distinguished in a plot are left out.
        for (std::size_t i = 0; i < passed.size() && i < 6; ++i) points_.push_back(passed[i]);
        points_.push_back(lost);
        branch_.zeno_lost.push_back(lost);
        return fmt::format("a Zeno point is lost: a_inf = 0 at {:.12g}", where);
    }

    // If the start of the period is close to an event, moves it to the middle of its flight, or of another one.
    void rebase() {
        const Trajectory& run = at_.shot.run;
        if (run.events.empty()) return;
        const double before = run.end_time - run.events.back().t, after = run.events.front().t - at_.lap.start_time;
        if (std::min(before, after) > 0.2 * (before + after)) return;
        try {
            const ShootingPoint there = rebased(map_, at_.lap);
            const Trajectory way = map_.run_of(at_.lap, there.start_time - at_.lap.start_time);
            const Derivatives d = differentiate(way);
            if (!d.end) return;
            const Index m = at_.lap.x.size(), P = static_cast<Index>(at_.lap.parameters.size());
            MatrixXd by(m, m + P);
            by << d.end->q, d.end->v;
            VectorXd change = at_.tangent.cwiseProduct(newton_.scale());
            const double dp = change[m + 1];
            change.head(m) = (by.leftCols(m) * change.head(m) + by.col(m + static_cast<Index>(p_)) * dp).eval();
            const ShootingPoint moved = map_.is_driven() ? earlier(map_, there) : there;
            const VectorXd before_it = change.cwiseQuotient(newton_.scale()).normalized();
            at_ = newton_.close(moved, {}, {}, before_it, 12);
            if (at_.tangent.dot(before_it) < 0.0) at_.tangent = -at_.tangent;
        } catch (const OrbitNotFound&) {
            // The orbit is also valid where it started before.
        }
    }
    const ReturnMap& map_;
    const ShootingSolver& newton_;
    Branch& branch_;
    std::size_t p_;
    double low_, high_;
    ConvergedOrbit at_;
    OrbitPoint point_;
    std::optional<std::array<double, 2>> before_;  // parameter value and psi of the last point
    bool no_loss_found_ = false;
    std::vector<OrbitPoint> points_;
};

}  // namespace

Branch follow(const std::shared_ptr<const Model>& model, const OrbitProblem& problem, const Orbit& orbit,
              std::size_t parameter, double low, double high) {
    const ReturnMap map(model, problem.run, problem.closing, problem.watch);
    Branch branch;
    branch.parameter = parameter;
    const Run& start = orbit.run.run;
    ShootingPoint lap;
    lap.x.resize(2 * map.dof());
    lap.x << start.q, start.v;
    lap.start_time = start.options.start_time;
    lap.period = orbit.period;
    lap.parameters = orbit.parameters;
    const ShootingSolver newton(map, scale_of(map, lap, high - low), parameter);
    const ConvergedOrbit closed = newton.close(lap);
    for (const int side : {0, 1}) {
        BranchContinuation walk(map, newton, branch, low, high);
        ConvergedOrbit from = closed;
        const double along = from.tangent[from.tangent.size() - 1];
        if ((side == 0) == (along > 0.0)) from.tangent = -from.tangent;
        try {
            branch.ends[static_cast<std::size_t>(side)] = walk.go(std::move(from));
        } catch (const OrbitNotFound& none) {
            branch.ends[static_cast<std::size_t>(side)] = none.what();
        }
        std::vector<OrbitPoint>& points = walk.points();
        if (side == 0) {
            branch.points.assign(points.rbegin(), points.rend());
            branch.points.push_back(orbit);
        } else {
            branch.points.insert(branch.points.end(), points.begin(), points.end());
        }
    }
    for (auto* found : {&branch.folds, &branch.flips, &branch.neimark_sacker, &branch.zeno_lost})
        std::sort(found->begin(), found->end(),
                  [&](const OrbitPoint& a, const OrbitPoint& b) { return branch.value(a) < branch.value(b); });
    return branch;
}

}  // namespace achilles
