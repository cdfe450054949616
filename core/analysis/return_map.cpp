#include "analysis/return_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/measures.hpp"
#include "analysis/orbit.hpp"
#include "model/read_expressions.hpp"
#include "number/dense.hpp"
#include "sensitivity/gradient.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"
#include "system/input_error.hpp"

namespace achilles {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;

namespace {

// Where a period may start: no contact is closed and no joint sticks, so that all directions have derivatives.
bool is_flight(Mode mode) { return mode.is_free() && mode.elements_in(ContactState::held).empty(); }

}  // namespace

ReturnMap::ReturnMap(std::shared_ptr<const Model> model, const Run& run, const ReturnCondition& closing,
                     OrbitMonitor* watch)
    : model_(std::move(model)), run_(run), watch_(watch) {
    std::vector<Text> texts{closing.period};
    texts.insert(texts.end(), closing.shift.begin(), closing.shift.end());
    texts.resize(1 + static_cast<std::size_t>(model_->dof()));
    for (std::size_t i = 1; i < texts.size(); ++i)
        if (texts[i].text == free_shift) free_.push_back(i - 1);
    for (Text& text : texts)
        if (text.text.empty() || text.text == free_shift) text.text = "0";
    closing_ = model_->compile_of_parameters(texts);
    const double T = period(run.parameters).value;
    if (closing.period.text.empty()) {
        if (is_driven())
            throw InputError("--period", {}, "the system depends on time: the period of the drive must be given",
                             "write --period 2*pi/om, an expression in the parameters, or period in [orbit]");
        return;
    }
    if (!(T > 0.0) || !std::isfinite(T))
        throw InputError("--period " + closing.period.text, {},
                         fmt::format("the period must be positive, but it is {} s", T), "give a positive period");
    if (is_driven()) check_repeats();
}

// Checks that forces and gaps repeat with the period, at instants unrelated to it.
void ReturnMap::check_repeats() const {
    const double T = period(run_.parameters).value;
    for (int i = 1; i <= 5; ++i) {
        State now = run_.start();
        now.t += 0.1234567 * i * T;
        State later = now;
        later.t += T;
        const VectorXd F = rate(run_.parameters, now, {}), G = rate(run_.parameters, later, {});
        double change = (F - G).norm(), size = 1e-8 * F.norm();
        for (std::size_t k = 0; k < model_->contacts(); ++k) {
            auto gap = model_->evaluator(model_->gap(k), run_.parameters);
            set_state(gap, now);
            gap.run();
            const double h = gap.output(0);
            set_state(gap, later);
            gap.run();
            change += std::abs(gap.output(0) - h);
            size += 1e-8 * std::abs(h);
        }
        if (!(change <= size + 1e-8))
            throw InputError(fmt::format("--period {}", T), {}, "the forces and gaps do not repeat with this period",
                             "give a period of the drive");
    }
}

ReturnMap::Value ReturnMap::value(std::size_t output, const std::vector<double>& parameters) const {
    const TangentLayout tangent{static_cast<std::size_t>(model_->dof()), model_->contacts(), parameters.size()};
    Gradient gradient(*model_, closing_, tangent, parameters);
    gradient.at(run_.start());
    Value value;
    value.value = gradient.value(output);
    value.slope = gradient.row(output).middleCols(tangent.p(0), static_cast<Index>(parameters.size()));
    return value;
}

bool ReturnMap::is_free(Index coordinate) const {
    return std::find(free_.begin(), free_.end(), static_cast<std::size_t>(coordinate)) != free_.end();
}

MatrixXd ReturnMap::without_free(MatrixXd rows) const {
    for (const std::size_t i : free_) rows.row(static_cast<Index>(i)).setZero();
    return rows;
}

MatrixXd ReturnMap::return_matrix(const ShootingResult& shot) const {
    MatrixXd A = without_free(shot.M - MatrixXd::Identity(shot.M.rows(), shot.M.cols()));
    for (const std::size_t i : free_) A(static_cast<Index>(i), static_cast<Index>(i)) = 1.0;
    return A;
}

VectorXd ReturnMap::rate(const std::vector<double>& parameters, const State& state, Mode mode) const {
    const Index n = dof();
    Model::MotionEvaluators motions;
    auto& motion = model_->lazily(motions, mode, parameters);
    set_state(motion, state);
    motion.run();
    VectorXd F(2 * n);
    F.head(n) = state.v;
    for (Index i = 0; i < n; ++i) F[n + i] = motion.acceleration(static_cast<std::size_t>(i));
    return F;
}

Trajectory ReturnMap::run_of(const ShootingPoint& lap, double length) const {
    Run run = run_;
    run.q = lap.x.head(dof());
    run.v = lap.x.tail(dof());
    run.parameters = lap.parameters;
    run.options.start_time = lap.start_time;
    run.options.end_time = lap.start_time + length;
    RunMonitor watch;
    if (watch_ != nullptr) {
        watch.stop = watch_->stop;
        ++watch_->runs;
    }
    try {
        Trajectory made = simulate(model_, run, &watch);
        if (made.outcome.kind == Outcome::Kind::cancelled) throw OrbitNotFound("the search was stopped");
        return made;
    } catch (const InputError& error) {
        throw OrbitNotFound(fmt::format("a trial run cannot start: {}", error.message));
    }
}

void ReturnMap::settle(ShootingPoint& lap) const {
    if (lap.mode.is_free()) return;
    Run run = run_;
    run.parameters = lap.parameters;
    ContactCache surfaces(*model_, run);
    State state{lap.x.head(dof()), lap.x.tail(dof()), lap.start_time};
    if (!surfaces.settle(state, lap.mode))
        throw OrbitNotFound(
            "the search left the contact surfaces on which its run starts; try another guess (--from, --set)");
    lap.x << state.q, state.v;
}

// Whether the run begins and ends as its start is meant: in a flight with sliding joints, or in the mode of the start.
void ReturnMap::check_mode(const ShootingPoint& lap, Mode begins, Mode ends) const {
    if (!lap.mode.is_free()) {
        if (begins == lap.mode && ends == lap.mode) return;
        throw OrbitNotFound(
            "the search reached a period that does not begin and end with the same contacts held; try another guess "
            "(--from, --set)");
    }
    if (is_flight(begins) && is_flight(ends)) return;
    throw OrbitNotFound(
        begins.is_free() && ends.is_free()
            ? "the search reached a start at which a joint sticks, but needs one at which all of them slide; try "
              "another guess (--from, --set)"
            : "the search reached a start in contact, but needs one in free flight; try another guess (--from, --set)");
}

// The changes of q, v and the parameters, one per column, for which derivatives are computed: all of them in a flight. In
// contact G dx + G_p dp = 0 for the gaps, gap rates and slips that the mode keeps at 0, so
//     dx <- (1 - G^+ G) dx,   dp <- (-G^+ G_p, 1) dp
MatrixXd ReturnMap::directions_at(const ShootingPoint& lap) const {
    const Index n = dof(), P = static_cast<Index>(lap.parameters.size());
    MatrixXd directions = MatrixXd::Identity(2 * n + P + 1, 2 * n + P);
    if (lap.mode.is_free()) return directions;
    const TangentLayout tangent{static_cast<std::size_t>(n), model_->contacts(), lap.parameters.size()};
    const State state{lap.x.head(n), lap.x.tail(n), lap.start_time};
    std::vector<RowVectorXd> kept;
    const auto keep = [&](const RowVectorXd& row) {
        RowVectorXd by(2 * n + P);
        by << row.segment(tangent.q(0), 2 * n), row.segment(tangent.p(0), P);
        kept.push_back(by);
    };
    for (const std::size_t i : lap.mode.held()) {
        ContactGradient contact(*model_, model_->programs_of(i).contact_terms, tangent, lap.parameters);
        contact.at(state);
        keep(contact.h_row());
        keep(contact.hdot_row());
    }
    for (const std::size_t i : lap.mode.elements_in(ContactState::held).without(lap.mode.implied())) {
        if (!model_->equations().friction.contains(i)) continue;
        SlipGradient slip(*model_, model_->slip_terms(i), tangent, lap.parameters);
        slip.at(state, 0.0);
        keep(slip.u_row());
    }
    MatrixXd G(static_cast<Index>(kept.size()), 2 * n + P);
    for (Index k = 0; k < G.rows(); ++k) G.row(k) = kept[static_cast<std::size_t>(k)];
    directions.topRows(2 * n) -= least_solution(MatrixXd(G.leftCols(2 * n)), G);
    return directions;
}

ShootingResult ReturnMap::shoot(const ShootingPoint& lap, std::optional<std::size_t> parameter) const {
    const Index n = dof();
    if (!(lap.period > 0.0) || !lap.x.allFinite())
        throw OrbitNotFound("the search diverged: the period left its admissible range");
    ShootingResult shot;
    shot.run = run_of(lap, lap.period);
    if (shot.run.outcome.kind != Outcome::Kind::end_time)
        throw OrbitNotFound(
            fmt::format("a trial run stopped at t = {:.10g} s: {}", shot.run.end_time, shot.run.outcome.message));
    const Mode begins = shot.run.phases.front().mode, ends = shot.run.end_mode;
    check_mode(lap, begins, ends);
    const auto P = static_cast<Index>(lap.parameters.size());
    MatrixXd directions = directions_at(lap);
    for (Index k = 0; parameter && k < P; ++k)
        if (k != static_cast<Index>(*parameter)) directions.col(2 * n + k).setZero();
    shot.derivatives = differentiate(shot.run, directions);
    const Derivatives& d = shot.derivatives;
    if (!d.end) throw OrbitNotFound(fmt::format("no derivative from t = {:.10g} s on: {}", d.broken_from, d.broken));
    for (const std::string& refused : d.refused)
        if (!refused.empty()) throw OrbitNotFound("no derivative: " + refused);
    shot.M.resize(2 * n, 2 * n);
    shot.P.resize(2 * n, P);
    shot.M << d.end->q.leftCols(2 * n), d.end->v.leftCols(2 * n);
    shot.P << d.end->q.rightCols(P), d.end->v.rightCols(P);
    VectorXd end(2 * n);
    end << shot.run.end.q, shot.run.end.v;
    shot.defect = end - lap.x;
    shot.shift = shot.defect.head(n);
    for (Index i = 0; i < n; ++i) {
        if (is_free(i)) {
            constexpr double accuracy = 1e-6;
            if (!((shot.M.col(i) - VectorXd::Unit(2 * n, i)).norm() <= accuracy))
                throw OrbitNotFound(fmt::format("the motion depends on {}, so its shift cannot be free",
                                                model_->description().coordinates[static_cast<std::size_t>(i)].name));
            shot.defect[i] = 0.0;
            continue;
        }
        const Value shift = this->shift(static_cast<std::size_t>(i), lap.parameters);
        shot.shift[i] = shift.value;
        shot.defect[i] -= shift.value;
        shot.P.row(i) -= shift.slope;
    }
    shot.F0 = rate(lap.parameters, shot.run.run.start(), begins);
    shot.F1 = rate(lap.parameters, shot.run.end, ends);
    shot.event_signature = signature_of(sequence_of(shot.run), RunEnd(shot.run.outcome.kind));
    if (!shot.M.allFinite() || !shot.P.allFinite()) throw OrbitNotFound("no derivative: it is not finite");
    return shot;
}

VectorXd ShootingSolver::scaled(const ShootingPoint& lap) const {
    VectorXd y(lap.x.size() + 2);
    y << lap.x, lap.period, lap.parameters.empty() ? 0.0 : lap.parameters[parameter_];
    return y.cwiseQuotient(scale_);
}

ShootingPoint ShootingSolver::lap_at(const ShootingPoint& like, const VectorXd& scaled) const {
    const VectorXd y = scaled.cwiseProduct(scale_);
    ShootingPoint lap = like;
    lap.x = y.head(like.x.size());
    lap.period = y[like.x.size()];
    if (!lap.parameters.empty()) lap.parameters[parameter_] = y[like.x.size() + 1];
    return lap;
}

// The Jacobian for steps of (x, T, p), scaled. Rows: the return condition; the section, or the period of the drive; the
// plane.
MatrixXd ShootingSolver::matrix(const ShootingResult& shot, const ShootingPoint& lap, const VectorXd& F_ref,
                                const VectorXd& normal) const {
    const Index m = lap.x.size();
    const auto p = static_cast<Index>(parameter_);
    MatrixXd A = MatrixXd::Zero(m + 2, m + 2);
    A.topLeftCorner(m, m) = map_.return_matrix(shot);
    A.block(0, m, m, 1) = map_.without_free(shot.F1);
    if (shot.P.cols() > 0) A.block(0, m + 1, m, 1) = map_.without_free(shot.P.col(p));
    if (map_.is_driven()) {
        A(m, m) = 1.0;
        if (shot.P.cols() > 0) A(m, m + 1) = -map_.period(lap.parameters).slope[p];
    } else {
        A.row(m).head(m) = F_ref.transpose();
    }
    A = A * scale_.asDiagonal();
    for (Index i = 0; i < m; ++i) A.row(i) /= scale_[i];
    if (map_.is_driven())
        A.row(m) /= scale_[m];
    else
        A.row(m) /= std::max(A.row(m).norm(), 1e-300);
    if (normal.size() > 0)
        A.row(m + 1) = normal.transpose();
    else
        A(m + 1, m + 1) = 1.0;
    return A;
}

ConvergedOrbit ShootingSolver::close(ShootingPoint lap, const VectorXd& normal, const VectorXd& predicted,
                                     const VectorXd& before, int most) const {
    const Index m = lap.x.size();
    map_.settle(lap);
    ConvergedOrbit closed;
    ShootingResult shot = map_.shoot(lap, parameter_);
    const VectorXd F_ref = shot.F0;  // the section is perpendicular to the flow at the first guess
    const std::uint64_t event_signature = shot.event_signature;
    bool same_signature = true;
    int slow = 0;
    double last = std::numeric_limits<double>::infinity();
    const auto size_of = [&](const ShootingResult& of) { return of.defect.cwiseQuotient(scale_.head(m)).norm(); };
    for (int round = 1; round <= most; ++round) {
        const MatrixXd A = matrix(shot, lap, F_ref, normal);
        VectorXd r = VectorXd::Zero(m + 2);
        r.head(m) = -shot.defect.cwiseQuotient(scale_.head(m));
        if (map_.is_driven()) r[m] = (map_.period(lap.parameters).value - lap.period) / scale_[m];
        if (normal.size() > 0) r[m + 1] = normal.dot(predicted - scaled(lap));
        const VectorXd step = least_solution(A, r);
        const double size = step.norm();
        if (!std::isfinite(size)) break;
        // Convergence is quadratic, except toward an orbit that is not isolated: one of a family, or one that shrinks
        // to an equilibrium.
        slow = size > 0.1 * last && last < 0.1 ? slow + 1 : 0;
        if (slow == 6)
            throw OrbitNotFound(
                "Newton's method converges too slowly: the periodic orbit is not isolated, or shrinks to an "
                "equilibrium");
        // Converged to the rounding of the runs: steps do not become smaller.
        if (size < 1e-15 || (size < 1e-10 && size > 0.25 * last)) {
            // A least-squares step also vanishes where the equations contradict each other, as in a flight without events.
            constexpr double closes = 1e-6;
            if (const double miss = r.norm(); !(miss <= closes))
                throw OrbitNotFound(
                    fmt::format("Newton's method ends at a run that does not return: it misses its start or its period "
                                "by a relative {:.2g}; try another guess (--from, --set)",
                                miss));
            closed = {lap, shot, round, size, {}};
            VectorXd along = VectorXd::Zero(m + 2);
            along[m + 1] = 1.0;
            closed.tangent = solution(matrix(shot, lap, F_ref, before.size() > 0 ? before : VectorXd{}), along);
            closed.tangent.normalize();
            return closed;
        }
        last = size;
        // If the full step increases the defect or leads to a run that fails, use a part of it.
        double part = 1.0;
        for (int half = 0;; ++half) {
            ShootingPoint tried = lap_at(lap, scaled(lap) + part * step);
            if (normal.size() == 0) tried.parameters = lap.parameters;  // exactly equal
            try {
                map_.settle(tried);
                ShootingResult there = map_.shoot(tried, parameter_);
                if (size_of(there) < 2.0 * size_of(shot) + 1e-9 || half == 6) {
                    lap = tried;
                    shot = std::move(there);
                    break;
                }
            } catch (const OrbitNotFound&) {
                if (half == 6) throw;
            }
            part *= 0.5;
        }
        same_signature = same_signature && shot.event_signature == event_signature;
    }
    throw OrbitNotFound(
        fmt::format("Newton's method does not converge: after {} steps the run misses its start by a relative {:.2g}{}",
                    most, size_of(shot),
                    same_signature ? "" : ", and the sequence of events changes from step to step; try another guess"));
}

using Eigen::Index, Eigen::VectorXd;

namespace {

VectorXd stacked(const State& state) {
    VectorXd x(2 * state.q.size());
    x << state.q, state.v;
    return x;
}

State state_at(const Trajectory& run, double t) {
    State state = Sampler(run).at(t).state;
    state.t = t;
    return state;
}

// A motion between two events.
struct MotionPhase {
    double start = 0.0, end = 0.0;
    bool after_release = false;
    Mode mode;
};
// The longest part of a motion in contact in which its held contacts count: elsewhere a start would not be held. False if
// there is none.
bool keep_where_contacts_count(const Trajectory& run, MotionPhase& phase) {
    const Model& model = *run.model;
    ContactSet conditional;
    for (const std::size_t i : phase.mode.held())
        if (model.is_conditional(i)) conditional = conditional.with(i);
    if (conditional.empty()) return true;
    auto guards = model.evaluator(model.guards(), run.run.parameters);
    constexpr int instants = 64;
    int first = 0, best_first = 0, best = 0;  // instants that count in succession
    const double length = phase.end - phase.start;
    for (int k = 0; k <= instants; ++k) {
        set_state(guards, state_at(run, phase.start + length * k / instants));
        guards.run();
        bool counts = true;
        for (const std::size_t i : conditional) counts = counts && guards.output(model.guard_of_contact(i)) > 0.0;
        if (!counts) {
            first = k + 1;
        } else if (k - first > best) {
            best_first = first;
            best = k - first;
        }
    }
    phase.end = phase.start + length * (best_first + best) / instants;
    phase.start += length * best_first / instants;
    return best > 0;
}

// The flights of a run; if there are none but short ones, as of a foot that is put down, the motions in contact.
std::vector<MotionPhase> flights_of(const Trajectory& run) {
    std::vector<MotionPhase> flights, in_contact;
    double from = run.run.options.start_time;
    Mode mode = run.phases.front().mode;
    bool released = false;
    const auto add = [&](double to) {
        if (to > from) (is_flight(mode) ? flights : in_contact).push_back({from, to, released, mode});
    };
    for (const Event& event : run.events) {
        // The last impact before a truncation is followed by its Zeno point; there is no flight between them.
        add(event.is_zeno() ? from : event.t);
        from = event.t;
        mode = event.mode;
        released = event.is_release();
    }
    add(run.end_time);
    const double shortest = 1e-3 * (run.end_time - run.run.options.start_time);
    const bool flies = std::any_of(flights.begin(), flights.end(),
                                   [&](const MotionPhase& flight) { return flight.end - flight.start > shortest; });
    if (flies || in_contact.empty()) return flights;
    std::erase_if(in_contact, [&](MotionPhase& phase) { return !keep_where_contacts_count(run, phase); });
    return in_contact;
}

ShootingPoint lap_from(const ReturnMap& map, const State& state, double period, Mode mode = {}) {
    return {stacked(state), state.t, period, map.run().parameters, mode.is_free() ? Mode() : mode};
}

// The longest flight that starts before this time.
std::optional<MotionPhase> longest(const std::vector<MotionPhase>& flights, double before) {
    std::optional<MotionPhase> best;
    for (const MotionPhase& flight : flights)
        if (flight.start < before && (!best || flight.end - flight.start > best->end - best->start)) best = flight;
    return best;
}

// Whether the run starts in a flight that is not too short.
bool begins_in_flight(const std::vector<MotionPhase>& flights, const Trajectory& run, double period) {
    return !flights.empty() && flights.front().start == run.run.options.start_time &&
           flights.front().end - flights.front().start > 1e-3 * period;
}

// A guess at the start, or in the middle of the longest flight that starts in [from, from + period].
ShootingPoint in_flight(const ReturnMap& map, const Trajectory& run, double period, double from) {
    std::vector<MotionPhase> flights = flights_of(run);
    const bool at_start = from == run.run.options.start_time;
    if (at_start && begins_in_flight(flights, run, period) && flights.front().mode.is_free())
        return lap_from(map, run.run.start(), period);
    std::erase_if(flights, [&](const MotionPhase& flight) { return flight.start < from; });
    const auto flight = longest(flights, from + period);
    if (!flight) throw OrbitNotFound("the run has no motion between its events in which a period could begin");
    return lap_from(map, state_at(run, 0.5 * (flight->start + flight->end)), period, flight->mode);
}

// The distance between state b and state a moved by the shift, relative to the size of the states.
double return_distance(const ReturnMap& map, const State& scale, const State& a, const State& b) {
    double sum = 0.0;
    const double q = std::max(scale.q.maxCoeff(), 1e-300), v = std::max(scale.v.maxCoeff(), 1e-300);
    for (Index i = 0; i < a.q.size(); ++i) {
        sum += std::pow((b.v[i] - a.v[i]) / v, 2);
        if (map.is_free(i)) continue;
        const double shift = map.shift(static_cast<std::size_t>(i), map.run().parameters).value;
        // A shifted coordinate is measured by its shift.
        const double size = shift != 0.0 ? std::abs(shift) : q;
        sum += std::pow((b.q[i] - a.q[i] - shift) / size, 2);
    }
    return std::sqrt(sum);
}

// A guess between the two most similar releases.
std::optional<ShootingPoint> from_releases(const ReturnMap& map, const Trajectory& run) {
    std::vector<std::size_t> releases;
    for (std::size_t i = 0; i < run.events.size(); ++i)
        if (run.events[i].is_release() && run.events[i].mode.is_free()) releases.push_back(i);
    if (releases.size() < 2) return std::nullopt;
    const State scale = scale_of(run);
    const auto state = [&](std::size_t i) {
        const Event& event = run.events[releases[i]];
        return State{event.q, event.v_after, event.t};
    };
    double least = std::numeric_limits<double>::infinity();
    const auto each = [&](const auto& take) {
        for (std::size_t between = 1; between < releases.size(); ++between)
            for (std::size_t i = releases.size() - between; i-- > 0;)
                if (take(i, i + between, return_distance(map, scale, state(i), state(i + between)))) return;
    };
    each([&](std::size_t, std::size_t, double distance) {
        least = std::min(least, distance);
        return false;
    });
    std::optional<ShootingPoint> best;
    each([&](std::size_t i, std::size_t j, double distance) {
        if (distance > 2.0 * least + 1e-6) return false;
        const double t = state(i).t;
        const double next = run.events[releases[i] + 1].t;
        best = lap_from(map, state_at(run, 0.5 * (t + next)), state(j).t - t);
        return true;
    });
    return best;
}

// A guess from the start to the closest return after the run has been far away.
ShootingPoint from_recurrence(const ReturnMap& map, const Trajectory& run) {
    const ShootingPoint begin =
        in_flight(map, run, run.end_time - run.run.options.start_time, run.run.options.start_time);
    const State first = state_at(run, begin.start_time), scale = scale_of(run);
    constexpr int instants = 4000;
    Sampler sampler(run);
    std::vector<double> distance;
    const double length = run.end_time - begin.start_time;
    for (int i = 1; i <= instants; ++i)
        distance.push_back(
            return_distance(map, scale, first, sampler.at(begin.start_time + length * i / instants).state));
    const double far = *std::max_element(distance.begin(), distance.end());
    auto from = std::find_if(distance.begin(), distance.end(), [&](double d) { return d > 0.5 * far; });
    const double near = *std::min_element(from, distance.end());
    while (from != distance.end() && *from > near + 0.1 * far) ++from;
    while (from + 1 != distance.end() && from[1] < *from) ++from;
    ShootingPoint lap = begin;
    lap.period = length * static_cast<double>(from - distance.begin() + 1) / instants;
    return lap;
}

}  // namespace

VectorXd scale_of(const ReturnMap& map, const ShootingPoint& lap, double of_parameter) {
    const Trajectory run = map.run_of(lap, lap.period);
    const State scale = achilles::scale_of(run);
    const double q = std::max(scale.q.maxCoeff(), 1e-6), v = std::max(scale.v.maxCoeff(), 1e-6);
    const Index n = map.dof();
    VectorXd s(2 * n + 2);
    for (Index i = 0; i < n; ++i) {
        s[i] = std::max(scale.q[i], 1e-2 * q);
        s[n + i] = std::max(scale.v[i], 1e-2 * v);
    }
    s[2 * n] = lap.period;
    s[2 * n + 1] = of_parameter;
    return s;
}

ShootingPoint earlier(const ReturnMap& map, ShootingPoint lap) {
    while (lap.start_time >= map.run().options.start_time + lap.period) {
        lap.start_time -= lap.period;
        for (Index i = 0; i < map.dof(); ++i) lap.x[i] -= map.shift(static_cast<std::size_t>(i), lap.parameters).value;
    }
    return lap;
}

ShootingPoint guess_of(const ReturnMap& map, int periods) {
    const Options& options = map.run().options;
    const double T = map.period(map.run().parameters).value;
    const double length = T > 0.0 ? (periods + 2) * T : (periods + 1) * (options.end_time - options.start_time);
    const Trajectory run = map.run_of(lap_from(map, map.run().start(), T), length);
    if (run.outcome.kind != Outcome::Kind::end_time && run.events.empty()) throw OrbitNotFound(run.outcome.message);
    if (map.is_driven()) return earlier(map, in_flight(map, run, T, options.start_time + periods * T));
    if (T > 0.0) {
        int before = periods;
        for (const MotionPhase& flight : flights_of(run))
            if (flight.after_release && before-- == 0)
                return lap_from(map, state_at(run, 0.5 * (flight.start + flight.end)), T, flight.mode);
        return in_flight(map, run, T, options.start_time + periods * T);
    }
    if (auto found = from_releases(map, run)) return *found;
    return from_recurrence(map, run);
}

ShootingPoint rebased(const ReturnMap& map, const ShootingPoint& lap, bool past_a_release) {
    // Two periods, so that a flight that extends into the next period is complete.
    const Trajectory run = map.run_of(lap, 2.0 * lap.period);
    const double end = lap.start_time + lap.period;
    std::optional<MotionPhase> best;
    for (const MotionPhase& flight : flights_of(run)) {
        if (flight.start == lap.start_time || flight.start >= end) continue;
        constexpr double too_short = 1e-3;
        if (!past_a_release && flight.end > end && flight.end - flight.start > too_short * lap.period) {
            best = flight;  // the flight of the present start
            break;
        }
        const bool better = !best || (past_a_release && flight.after_release != best->after_release
                                          ? flight.after_release
                                          : flight.end - flight.start > best->end - best->start);
        if (better) best = flight;
    }
    if (!best) return lap;
    ShootingPoint moved = lap_from(map, state_at(run, 0.5 * (best->start + best->end)), lap.period, best->mode);
    moved.parameters = lap.parameters;
    return moved;
}

}  // namespace achilles
