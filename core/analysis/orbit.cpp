#include "analysis/orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/return_map.hpp"
#include "number/dense.hpp"
#include "sensitivity/chain.hpp"
#include "simulate/contact_cache.hpp"

namespace achilles {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double loss_exponent(double e) {
    // Bisection for theta, the duration of a flight in units of the time to the release: e (3 - 2 theta) =
    // (3 - theta) (1 - theta)^2. Right minus left side falls from 3 (1 - e) at theta = 0 to -e at theta = 1.
    double low = 0.0, high = 1.0;
    for (int round = 0; round < 100; ++round) {
        const double theta = 0.5 * (low + high), rho = 1.0 - theta;
        ((3.0 - theta) * rho * rho > e * (3.0 - 2.0 * theta) ? low : high) = theta;
    }
    const double theta = 0.5 * (low + high), rho = 1.0 - theta;
    const double m =
        e * ((0.5 - 2.0 * theta / 3.0) / (rho * rho) + (theta - 2.0 * theta * theta / 3.0) / (rho * rho * rho)) /
        (0.5 - theta / 3.0);
    return std::log(1.0 / rho) / std::log(m);
}

Options tightest_options() {
    Options options;
    options.tolerance = 1e-14;
    Truncation& bounds = options.truncation;
    bounds.eps_q = bounds.eps_v = bounds.eps_t = 1e-11;
    return options;
}

namespace {

// Sets the smallest psi over the Zeno points of a run, and the shortest contact after one. Leaves them unset if the run
// has no Zeno point, or if e = 0 leaves no bouncing.
void set_psi(const Model& model, const Trajectory& run, OrbitPoint& point) {
    for (std::size_t i = 0; i < run.events.size(); ++i) {
        const Event& event = run.events[i];
        if (!event.is_zeno() || !event.contacts.has_one()) continue;
        const std::size_t contact = event.contacts.only();
        const double e = model.restitution(run.run.parameters, contact);
        if (!(e > 0.0 && e < 1.0)) continue;
        auto hddot = model.evaluator(model.programs_of(contact, event.mode.without(contact)).normal_acceleration,
                                     run.run.parameters);
        set_state(hddot, {event.q, event.v_after, event.t});
        hddot.run();
        const double psi = std::pow(std::max(-hddot.output(0), 0.0), 1.0 / loss_exponent(e));
        const double contact_lasts = (i + 1 < run.events.size() ? run.events[i + 1].t : run.end_time) - event.t;
        point.shortest_contact = point.psi ? std::min(point.shortest_contact, contact_lasts) : contact_lasts;
        point.psi = std::min(psi, point.psi.value_or(psi));
    }
}

// Number of contacts whose slip ends in an impact: u+ = 0, and a change of u- is forgotten.
int count_stuck(ContactCache& surfaces, const Event& impact) {
    if (impact.friction == nullptr) return 0;
    constexpr double rounding = 1e-10;
    int stuck = 0;
    for (const auto& [contact, impulse] : impact.friction->tangential) {
        const double before = surfaces.slip(contact, {impact.q, impact.v_before, impact.t}).u,
                     after = surfaces.slip(contact, {impact.q, impact.v_after, impact.t}).u;
        if (impulse != 0.0 && std::abs(after) <= rounding * (std::abs(before) + impact.impact_speed)) ++stuck;
    }
    return stuck;
}

// Number of zero multipliers: two for every contact held at one time, and two for a plastic impact. With friction, one
// more for every contact or joint that sticks at one time or in an impact (theory-friction.md 6).
std::size_t count_zero_multipliers(const Model& model, const Trajectory& run) {
    int most = 0;
    ContactCache surfaces(model, run.run);
    for (const Phase& phase : run.phases) {
        const ContactSet stuck =
            phase.mode.elements_in(ContactState::held).within(surfaces.rough()).without(phase.mode.implied());
        most = std::max(most, 2 * phase.mode.held().count() + stuck.count());
    }
    for (const Event& event : run.events) {
        int forgotten = event.is_impact() ? count_stuck(surfaces, event) : 0;
        for (std::size_t i = 0; i < model.contacts(); ++i)
            if (event.contacts.contains(i) && model.restitution(run.run.parameters, i) == 0.0) {
                forgotten += 2;
                break;
            }
        most = std::max(most, forgotten);
    }
    return std::min(static_cast<std::size_t>(most), 2 * static_cast<std::size_t>(model.dof()));
}

}  // namespace

std::vector<std::complex<double>> free_multipliers(const ReturnMap& map, const ShootingResult& shot,
                                                   std::size_t& zeros) {
    const Index m = shot.M.rows();
    zeros = count_zero_multipliers(*map.model(), shot.run);
    const Index r = m - static_cast<Index>(zeros), flow = map.is_driven() ? 0 : 1;
    if (r <= flow) return {};
    // The image of M has r dimensions and contains all nonzero multipliers. The direction of the flow comes first; its
    // column is 1, 0, ...
    MatrixXd reached(m, flow + r);
    if (flow > 0) reached.col(0) = shot.F1.normalized();
    reached.rightCols(r) = range_of(shot.M, r);
    // Remove the flow's direction from the basis.
    for (Index round = 0; flow > 0 && round < 2; ++round)
        reached.rightCols(r) -= reached.col(0) * (reached.col(0).transpose() * reached.rightCols(r));
    const MatrixXd across = range_of(reached.rightCols(r), r - flow);
    std::vector<std::complex<double>> all = eigenvalues_of(MatrixXd(across.transpose() * shot.M) * across);
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
        return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
    });
    // A change of a free coordinate stays as it is: a multiplier that is exactly 1.
    for (std::size_t i = 0; i < map.free_coordinates().size() && !all.empty(); ++i)
        all.erase(std::min_element(all.begin(), all.end(),
                                   [](const auto& a, const auto& b) { return std::abs(a - 1.0) < std::abs(b - 1.0); }));
    return all;
}

// ---- data of a converged orbit ----

namespace {

// Sets the initial state of the period, and its derivatives and those of the period by the parameters.
void set_section(const ReturnMap& map, const ConvergedOrbit& closed, Orbit& orbit) {
    const Index n = map.dof(), P = static_cast<Index>(orbit.parameters.size());
    const ShootingResult& shot = closed.shot;
    const ShootingPoint& lap = closed.lap;
    // (dx, dT)/dp of the start; without a drive, perpendicular to the flow.
    MatrixXd A = MatrixXd::Zero(2 * n + 1, 2 * n + 1), r = MatrixXd::Zero(2 * n + 1, P);
    A.topLeftCorner(2 * n, 2 * n) = map.return_matrix(shot);
    A.topRightCorner(2 * n, 1) = map.without_free(shot.F1);
    r.topRows(2 * n) = -map.without_free(shot.P);
    if (map.is_driven()) {
        A(2 * n, 2 * n) = 1.0;
        if (P > 0) r.row(2 * n) = map.period(lap.parameters).slope;
    } else {
        A.row(2 * n).head(2 * n) = shot.F0.transpose();
    }
    // Without parameters there is nothing to solve, and Eigen would access an empty matrix.
    const MatrixXd by = P > 0 ? least_solution(A, r) : r;
    orbit.parameter_derivatives = by;
    orbit.state = shot.run.run.start();
    const double start_time = map.run().options.start_time;
    const Event* const last = shot.run.events.empty() ? nullptr : &shot.run.events.back();
    const auto unshift = [&] {
        orbit.state.q -= shot.shift;
        for (Index i = 0; i < n && P > 0; ++i)
            orbit.parameter_derivatives.row(i) -=
                map.is_free(i)
                    ? shot.M.row(i) * by.topRows(2 * n) - by.row(i) + shot.F1[i] * by.row(2 * n) + shot.P.row(i)
                    : map.shift(static_cast<std::size_t>(i), lap.parameters).slope;
    };
    if (!map.is_driven() && last != nullptr && last->is_release()) {
        orbit.is_at_release = true;
        const Derivatives::EventSensitivity& at = shot.derivatives.events.back();
        MatrixXd there(2 * n, 2 * n + P);
        there << at.q, at.v_after;
        orbit.parameter_derivatives.topRows(2 * n) = there.leftCols(2 * n) * by.topRows(2 * n) + there.rightCols(P);
        orbit.state = {last->q, last->v_after, start_time};
        unshift();
    } else if (map.is_driven() && lap.start_time > start_time) {
        const double t = start_time + lap.period;
        const Trajectory run = map.run_of(lap, t - lap.start_time);
        const Derivatives d = differentiate(run);
        if (!d.end) return;
        MatrixXd there(2 * n, 2 * n + P);
        there << d.end->q, d.end->v;
        orbit.parameter_derivatives.topRows(2 * n) = there.leftCols(2 * n) * by.topRows(2 * n) + there.rightCols(P);
        // At a fixed start time, the end time changes with the period.
        const VectorXd F = map.rate(lap.parameters, run.end, run.end_mode);
        if (P > 0) orbit.parameter_derivatives.topRows(2 * n) += F * by.row(2 * n);
        orbit.state = run.end;
        orbit.state.t = start_time;
        unshift();
    }
}

}  // namespace

Orbit orbit_of(const ReturnMap& map, const ConvergedOrbit& closed) {
    Orbit orbit;
    orbit.parameters = closed.lap.parameters;
    orbit.flight = closed.shot.run.run.start();
    orbit.period = closed.lap.period;
    orbit.iterations = closed.iterations;
    orbit.error = closed.error;
    orbit.is_autonomous = !map.is_driven();
    orbit.multipliers = free_multipliers(map, closed.shot, orbit.zero_multipliers);
    constexpr double rounding = 1e-9;
    orbit.stable = std::all_of(orbit.multipliers.begin(), orbit.multipliers.end(),
                               [](const auto& mu) { return std::abs(mu) < 1.0 - rounding; });
    for (const std::size_t i : map.free_coordinates())
        orbit.free.emplace_back(map.model()->description().coordinates[i].name,
                                closed.shot.shift[static_cast<Index>(i)]);
    orbit.multipliers.insert(orbit.multipliers.begin(), orbit.shifts(), 1.0);
    orbit.multipliers.resize(static_cast<std::size_t>(2 * map.dof()));
    orbit.margins = closed.shot.derivatives.margins;
    set_psi(*map.model(), closed.shot.run, orbit);
    orbit.event_signature = closed.shot.event_signature;
    set_section(map, closed, orbit);
    orbit.run = closed.shot.run;
    return orbit;
}

namespace {

// The number of shifts between the initial state of the period and the start of the search.
double shifts_from_start(const ReturnMap& map, const ConvergedOrbit& closed) {
    double along = 0.0, square = 0.0;
    const auto& events = closed.shot.run.events;
    const bool at_release = !map.is_driven() && !events.empty() && events.back().is_release();
    for (Index i = 0; i < map.dof(); ++i) {
        const double shift = closed.shot.shift[i];
        const double begins = at_release ? events.back().q[i] - shift : closed.lap.x[i];
        along += (begins - map.run().q[i]) * shift;
        square += shift * shift;
    }
    return square > 0.0 ? std::round(along / square) : 0.0;
}

// Moves the orbit by shifts to where the search began. Without a drive, it also sets the start time so that the period
// begins at a release, if there is one, at the start time of the run.
ConvergedOrbit put_in_place(const ReturnMap& map, const ShootingSolver& newton, ConvergedOrbit closed) {
    const auto last_is_release = [&] {
        const auto& events = closed.shot.run.events;
        return !events.empty() && events.back().is_release();
    };
    const auto& events = closed.shot.run.events;
    const bool any = std::any_of(events.begin(), events.end(),
                                 [](const Event& event) { return event.is_release() && event.mode.is_free(); });
    if (!map.is_driven() && any && !last_is_release()) closed = newton.close(rebased(map, closed.lap, true));
    ShootingPoint lap = closed.lap;
    const double shifts = shifts_from_start(map, closed);
    lap.x.head(map.dof()) -= shifts * closed.shot.shift;
    if (!map.is_driven())
        lap.start_time = map.run().options.start_time +
                         (last_is_release() ? lap.period - (closed.shot.run.events.back().t - lap.start_time) : 0.0);
    return lap.start_time == closed.lap.start_time && shifts == 0.0 ? closed : newton.close(lap);
}

ConvergedOrbit search(const ReturnMap& map, int periods) {
    const ShootingPoint lap = guess_of(map, periods);
    const ShootingSolver newton(map, scale_of(map, lap, 1.0), 0);
    ConvergedOrbit closed = newton.close(lap);
    const int iterations = closed.iterations;
    constexpr double shrunk = 1e-3;
    const Index n = map.dof();
    const double before = newton.scale().segment(n, n).maxCoeff(),
                 now = scale_of(map, closed.lap, 1.0).segment(n, n).maxCoeff();
    if (!(closed.lap.period > shrunk * lap.period && now > shrunk * before))
        throw OrbitNotFound("the search converged to an equilibrium, not to a periodic orbit");
    closed = put_in_place(map, newton, std::move(closed));
    closed.iterations = iterations;
    closed.shot = map.shoot(closed.lap);
    return closed;
}

// Projects a guess with a negative gap of a contact that counts onto its surface. A foot that never slides comes to rest.
void lift(const Model& model, Run& run) {
    State state = run.start();
    ContactCache surfaces(model, run);
    const auto counts = [&](std::size_t contact) {
        if (!model.is_conditional(contact)) return true;
        auto guards = model.evaluator(model.guards(), run.parameters);
        set_state(guards, state);
        guards.run();
        return guards.output(model.guard_of_contact(contact)) > 0.0;
    };
    Mode below;
    for (std::size_t i = 0; i < model.contacts(); ++i) {
        if (!(surfaces.of(i).at(state).h < 0.0) || !counts(i)) continue;
        const bool slides = surfaces.rough().contains(i) && !surfaces.never_slides(i);
        below = below.with(i, slides ? ContactState::slip_plus : ContactState::held);
    }
    if (below.is_free() || !surfaces.settle(state, below)) return;
    run.q = state.q;
    run.v = state.v;
}

}  // namespace

OrbitSearchResult find_orbit(const std::shared_ptr<const Model>& model, const OrbitProblem& problem) {
    Chain::check(problem.run);
    Run run = problem.run;
    if (problem.is_guess) lift(*model, run);
    model->check(run);
    const ReturnMap map(model, run, problem.closing, problem.watch);
    OrbitSearchResult found;
    // A run that forgets its start approaches the orbit by itself, so further attempts start after several periods.
    for (const int periods : {0, 1, 3, 8, 20}) {
        try {
            found.orbit = orbit_of(map, search(map, periods));
            return found;
        } catch (const OrbitNotFound& none) {
            if (found.reason.empty()) found.reason = none.what();
            if (problem.watch != nullptr && problem.watch->stop.stop_requested()) break;
        }
    }
    return found;
}

}  // namespace achilles
