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
#include "simulate/simulate.hpp"
#include "system/input_error.hpp"

namespace achilles {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;

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

}  // namespace achilles
