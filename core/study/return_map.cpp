#include "study/return_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "depend/gradient.hpp"
#include "number/dense.hpp"
#include "simulate/simulate.hpp"
#include "study/orbit.hpp"
#include "study/signature.hpp"
#include "system/input_error.hpp"

namespace achilles {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;

ReturnMap::ReturnMap(std::shared_ptr<const Model> model, const Run& run, const Closing& closing, OrbitWatch* watch)
    : model_(std::move(model)), run_(run), watch_(watch) {
    std::vector<Text> texts{closing.period};
    texts.insert(texts.end(), closing.shift.begin(), closing.shift.end());
    texts.resize(1 + static_cast<std::size_t>(model_->dof()));
    for (Text& text : texts)
        if (text.text.empty()) text.text = "0";
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

// What depends on the time does so with the period: seen at instants that have nothing to do with it.
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
    const Tangent tangent{static_cast<std::size_t>(model_->dof()), model_->contacts(), parameters.size()};
    Gradient gradient(*model_, closing_, tangent, parameters);
    gradient.at(run_.start());
    Value value;
    value.value = gradient.value(output);
    value.slope = gradient.row(output).middleCols(tangent.p(0), static_cast<Index>(parameters.size()));
    return value;
}

VectorXd ReturnMap::rate(const std::vector<double>& parameters, const State& state, ContactSet held) const {
    const Index n = dof();
    Model::MotionEvaluators motions;
    auto& motion = model_->lazily(motions, held, parameters);
    set_state(motion, state);
    motion.run();
    VectorXd F(2 * n);
    F.head(n) = state.v;
    for (Index i = 0; i < n; ++i) F[n + i] = motion.acceleration(static_cast<std::size_t>(i));
    return F;
}

Trajectory ReturnMap::run_of(const Lap& lap, double length) const {
    Run run = run_;
    run.q = lap.x.head(dof());
    run.v = lap.x.tail(dof());
    run.parameters = lap.parameters;
    run.options.start_time = lap.start_time;
    run.options.end_time = lap.start_time + length;
    Watch watch;
    if (watch_ != nullptr) {
        watch.stop = watch_->stop;
        ++watch_->runs;
    }
    try {
        Trajectory made = simulate(model_, run, &watch);
        if (made.outcome.kind == Outcome::Kind::cancelled) throw NoOrbit("the search was stopped");
        return made;
    } catch (const InputError& error) {
        throw NoOrbit(fmt::format("a trial run cannot start: {}", error.message));
    }
}

Shot ReturnMap::shoot(const Lap& lap, std::optional<std::size_t> parameter) const {
    const Index n = dof();
    if (!(lap.period > 0.0) || !lap.x.allFinite())
        throw NoOrbit("the search diverged: the period left its admissible range");
    Shot shot;
    shot.run = run_of(lap, lap.period);
    if (shot.run.outcome.kind != Outcome::Kind::end_time)
        throw NoOrbit(
            fmt::format("a trial run stopped at t = {:.10g} s: {}", shot.run.end_time, shot.run.outcome.message));
    if (!shot.run.phases.front().held.empty() || !shot.run.end_held.empty())
        throw NoOrbit(
            "the search reached a start in contact, but needs one in free flight; try another guess (--from, --set)");
    const auto P = static_cast<Index>(lap.parameters.size());
    MatrixXd directions = MatrixXd::Identity(2 * n + P + 1, 2 * n + P);
    for (Index k = 0; parameter && k < P; ++k)
        if (k != static_cast<Index>(*parameter)) directions.col(2 * n + k).setZero();
    shot.derivatives = differentiate(shot.run, directions);
    const Derivatives& d = shot.derivatives;
    if (!d.end) throw NoOrbit(fmt::format("no derivative from t = {:.10g} s on: {}", d.broken_from, d.broken));
    for (const std::string& refused : d.refused)
        if (!refused.empty()) throw NoOrbit("no derivative: " + refused);
    shot.M.resize(2 * n, 2 * n);
    shot.P.resize(2 * n, P);
    shot.M << d.end->q.leftCols(2 * n), d.end->v.leftCols(2 * n);
    shot.P << d.end->q.rightCols(P), d.end->v.rightCols(P);
    VectorXd end(2 * n);
    end << shot.run.end.q, shot.run.end.v;
    shot.defect = end - lap.x;
    for (Index i = 0; i < n; ++i) {
        const Value shift = this->shift(static_cast<std::size_t>(i), lap.parameters);
        shot.defect[i] -= shift.value;
        shot.P.row(i) -= shift.slope;
    }
    shot.F0 = rate(lap.parameters, shot.run.run.start(), {});
    shot.F1 = rate(lap.parameters, shot.run.end, {});
    shot.word = signature_of(sequence_of(shot.run), RunEnd(shot.run.outcome.kind));
    if (!shot.M.allFinite() || !shot.P.allFinite()) throw NoOrbit("no derivative: it is not finite");
    return shot;
}

VectorXd Newton::scaled(const Lap& lap) const {
    VectorXd y(lap.x.size() + 2);
    y << lap.x, lap.period, lap.parameters.empty() ? 0.0 : lap.parameters[parameter_];
    return y.cwiseQuotient(scale_);
}

Lap Newton::lap_at(const Lap& like, const VectorXd& scaled) const {
    const VectorXd y = scaled.cwiseProduct(scale_);
    Lap lap = like;
    lap.x = y.head(like.x.size());
    lap.period = y[like.x.size()];
    if (!lap.parameters.empty()) lap.parameters[parameter_] = y[like.x.size() + 1];
    return lap;
}

// Of the steps of (x, T, p), scaled: that it closes; that it stays on the section, or has the drive's period; the plane.
MatrixXd Newton::matrix(const Shot& shot, const Lap& lap, const VectorXd& F_ref, const VectorXd& normal) const {
    const Index m = lap.x.size();
    const auto p = static_cast<Index>(parameter_);
    MatrixXd A = MatrixXd::Zero(m + 2, m + 2);
    A.topLeftCorner(m, m) = shot.M - MatrixXd::Identity(m, m);
    A.block(0, m, m, 1) = shot.F1;
    if (shot.P.cols() > 0) A.block(0, m + 1, m, 1) = shot.P.col(p);
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

ClosedLap Newton::close(Lap lap, const VectorXd& normal, const VectorXd& predicted, const VectorXd& before,
                        int most) const {
    const Index m = lap.x.size();
    ClosedLap closed;
    Shot shot = map_.shoot(lap, parameter_);
    const VectorXd F_ref = shot.F0;  // the section is across the motion at the first guess
    const std::uint64_t word = shot.word;
    bool same_word = true;
    int slow = 0;
    double last = std::numeric_limits<double>::infinity();
    const auto size_of = [&](const Shot& of) { return of.defect.cwiseQuotient(scale_.head(m)).norm(); };
    for (int round = 1; round <= most; ++round) {
        const MatrixXd A = matrix(shot, lap, F_ref, normal);
        VectorXd r = VectorXd::Zero(m + 2);
        r.head(m) = -shot.defect.cwiseQuotient(scale_.head(m));
        if (map_.is_driven()) r[m] = (map_.period(lap.parameters).value - lap.period) / scale_[m];
        if (normal.size() > 0) r[m + 1] = normal.dot(predicted - scaled(lap));
        const VectorXd step = least_solution(A, r);
        const double size = step.norm();
        if (!std::isfinite(size)) break;
        // It is quadratic, but towards what is no isolated orbit: a family of them, or one that shrinks to rest.
        slow = size > 0.1 * last && last < 0.1 ? slow + 1 : 0;
        if (slow == 6)
            throw NoOrbit(
                "Newton's method converges too slowly: the periodic orbit is not isolated, or shrinks to an "
                "equilibrium");
        // At the rounding of the runs: no step is smaller any more.
        if (size < 1e-15 || (size < 1e-10 && size > 0.25 * last)) {
            closed = {lap, shot, round, size, {}};
            VectorXd along = VectorXd::Zero(m + 2);
            along[m + 1] = 1.0;
            closed.tangent = solution(matrix(shot, lap, F_ref, before.size() > 0 ? before : VectorXd{}), along);
            closed.tangent.normalize();
            return closed;
        }
        last = size;
        // Where the whole step makes it worse, or leaves what can be run, a part of it.
        double part = 1.0;
        for (int half = 0;; ++half) {
            Lap tried = lap_at(lap, scaled(lap) + part * step);
            if (normal.size() == 0) tried.parameters = lap.parameters;  // to the last bit
            try {
                Shot there = map_.shoot(tried, parameter_);
                if (size_of(there) < 2.0 * size_of(shot) + 1e-9 || half == 6) {
                    lap = tried;
                    shot = std::move(there);
                    break;
                }
            } catch (const NoOrbit&) {
                if (half == 6) throw;
            }
            part *= 0.5;
        }
        same_word = same_word && shot.word == word;
    }
    throw NoOrbit(fmt::format(
        "Newton's method does not converge: after {} steps the run misses its start by a relative {:.2g}{}", most,
        size_of(shot), same_word ? "" : ", and the sequence of events changes from step to step; try another guess"));
}

}  // namespace achilles
