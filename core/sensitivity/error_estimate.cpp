#include "sensitivity/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "number/float_environment.hpp"
#include "sensitivity/chain.hpp"
#include "sensitivity/completion_error.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Replaces NaN by infinity (unknown).
Vector known_or_infinite(Vector sizes) {
    for (double& x : sizes)
        if (!std::isfinite(x)) x = std::numeric_limits<double>::infinity();
    return sizes;
}

// The first size that exceeds its share of the range; -1 if there is none.
Eigen::Index first_excess(const Vector& sizes, const Vector& range) {
    for (Eigen::Index i = 0; i < sizes.size(); ++i)
        if (sizes[i] > ErrorCourse::largest_share * std::max(range[i], ErrorCourse::min_range)) return i;
    return -1;
}

// The error, and the covariance of rounding, of all components except the parameters.
struct Transport {
    explicit Transport(const TangentLayout& tangent)
        : size(tangent.p(0)), error(VectorXd::Zero(size)), covariance(MatrixXd::Zero(size, size)) {}

    // A step: e := J e + delta. An event: e := e - F (G e + g(y))/(G F). The covariance: P := J P J'.
    void follow(const ChainLink& link) {
        if (link.kind == ChainLink::Kind::crossing) {
            const auto F = link.F.head(size);
            // At an impact, use the gap as a function of q and t: the components h and u do not include the errors that
            // rounding and steps have added to q and t.
            const auto G = (link.by_place.size() > 0 ? link.by_place : link.G).head(size);
            const double rate = link.G.head(size).dot(F);
            error -= F * ((G.dot(error) + link.residual) / rate);
            // The covariance with the event time, as a row and as a column: roundings that are not symmetric would
            // double at every crossing if one stood for both.
            const Eigen::RowVectorXd row = G * covariance / rate;
            const VectorXd column = covariance * G.transpose() / rate;
            const double variance = G.dot(column) / rate;
            covariance += variance * F * F.transpose() - F * row - column * F.transpose();
            return;
        }
        const auto J = link.J.topLeftCorner(size, size);
        error = J * error;
        if (link.left_out.size() > 0) error += link.left_out.head(size);
        const MatrixXd moved = J * covariance;
        covariance = moved * J.transpose();
    }
    // Adds the rounding of the stored state.
    void round(const State& state, const TangentLayout& tangent) {
        constexpr double unit_roundoff = 0x1p-53;
        const auto add = [&](Index i, double z) { covariance(i, i) += std::pow(unit_roundoff * z, 2); };
        add(TangentLayout::t(), state.t);
        for (std::size_t i = 0; i < tangent.dof; ++i) {
            add(tangent.q(i), state.q[static_cast<Index>(i)]);
            add(tangent.v(i), state.v[static_cast<Index>(i)]);
        }
    }
    void move(const State& shift, const TangentLayout& tangent) {
        error.segment(tangent.q(0), shift.q.size()) += shift.q;
        error.segment(tangent.v(0), shift.v.size()) += shift.v;
    }
    double of_time() const { return std::sqrt(std::pow(error[TangentLayout::t()], 2) + covariance(0, 0)); }

    Index size;
    VectorXd error;
    MatrixXd covariance;
};

// Whether all entries of a link are finite.
bool is_known(const ChainLink& link) {
    return link.kind == ChainLink::Kind::crossing || (link.J.allFinite() && link.left_out.allFinite());
}

// The sizes of e - F e_t at a fixed time, including rounding, for every coordinate and rate.
State sizes_at_fixed_time(const Transport& carried, const TangentLayout& tangent, const VectorXd& rate) {
    const Index time = TangentLayout::t();
    const auto size_of = [&](Index k) {
        const double error = carried.error[k] - rate[k] * carried.error[time];
        const auto& P = carried.covariance;
        const double variance = P(k, k) - 2.0 * rate[k] * P(k, time) + rate[k] * rate[k] * P(time, time);
        return std::sqrt(error * error + std::max(variance, 0.0));
    };
    const auto n = static_cast<Index>(tangent.dof);
    State sizes{Vector::Zero(n), Vector::Zero(n), 0.0};
    for (std::size_t i = 0; i < tangent.dof; ++i) {
        sizes.q[static_cast<Index>(i)] = size_of(tangent.q(i));
        sizes.v[static_cast<Index>(i)] = size_of(tangent.v(i));
    }
    return sizes;
}

ErrorEstimate none(std::string reason) {
    ErrorEstimate result;
    result.no_estimate_reason = std::move(reason);
    return result;
}

// e - F e_t, the error at a fixed time.
ErrorEstimate::FinalError at_end(const Transport& carried, const TangentLayout& tangent, const VectorXd& rate) {
    const auto n = static_cast<Index>(tangent.dof);
    MatrixXd fixed = MatrixXd::Identity(carried.size, carried.size);
    fixed.col(TangentLayout::t()) -= rate.head(carried.size);
    const VectorXd error = fixed * carried.error;
    const MatrixXd moved = fixed * carried.covariance, covariance = moved * fixed.transpose();
    ErrorEstimate::FinalError end;
    end.q = error.segment(tangent.q(0), n);
    end.v = error.segment(tangent.v(0), n);
    end.norm = error.segment(tangent.q(0), 2 * n).norm();
    end.sigma = std::sqrt(covariance.diagonal().segment(tangent.q(0), 2 * n).sum());
    return end;
}

bool is_finite(const ErrorEstimate::FinalError& end) {
    return end.q.allFinite() && end.v.allFinite() && std::isfinite(end.reach());
}

// Why the truncation error of a step at time t (s) is infinite.
std::string reason_of_overflow(const Trajectory& trajectory, double t) {
    constexpr double near = 1e-6;  // s
    if (trajectory.outcome.kind == Outcome::Kind::painleve && trajectory.end_time - t <= near)
        return "the contact force grows without bound where the run stops";
    return fmt::format(
        "at t = {:.6g} s a function overflows in the truncation error of a step, as cosh(u)^2 does beyond u = 355; "
        "write 1 - tanh(u)^2 for 1/cosh(u)^2",
        t);
}

ErrorEstimate estimate(const Trajectory& trajectory, const std::stop_token& stop) {
    const Options& options = trajectory.run.options;
    if (options.method != Method::taylor)
        return none("errors are estimated only for Taylor's method (--method taylor)");
    if (options.truncation.reinitialization != Reinitialization::kinetic)
        return none("errors are estimated only with the kinetic reinitialization, not with the Euclidean one");
    if (trajectory.pieces.empty() && trajectory.end_time > options.start_time)
        return none("only the final state of this run was stored");
    if (trajectory.pieces.size() > max_estimated_steps)
        return none(
            fmt::format("the run has more than {} steps, and an estimate would take several times as long as the run",
                        max_estimated_steps));
    Chain chain(trajectory, {.errors = true});
    const TangentLayout& tangent = chain.tangent();
    Transport carried(tangent);
    CompletionError of_cuts(*trajectory.model, trajectory.run);
    std::optional<CompletionError::TruncationState> cut;
    ErrorEstimate result;
    result.course.begin(trajectory.run);
    std::size_t steps = 0;
    while (const ChainLink* link = chain.next()) {
        if (stop.stop_requested()) return none("the estimate was cancelled");
        if (!is_known(*link)) return none(reason_of_overflow(trajectory, chain.state().t));
        carried.follow(*link);
        if (link->kind == ChainLink::Kind::crossing) continue;
        if (link->kind == ChainLink::Kind::step || link->event) carried.round(chain.state(), tangent);
        // The last link of a step contains its omitted terms.
        if (link->kind == ChainLink::Kind::step && link->left_out.size() > 0)
            result.course.add(trajectory, trajectory.pieces[steps++],
                              sizes_at_fixed_time(carried, tangent, chain.rate()));
        if (!link->event) continue;
        const Event& event = trajectory.events[*link->event];
        if (link->completion) {
            cut = {link->completion->key, link->completion->tangential, link->completion->speed};
            carried.move(of_cuts.shift(*cut), tangent);
        } else if (event.is_zeno() && cut) {
            // The error of the Zeno time of the run.
            const CompletionError::AccumulationEstimate accumulation_time = of_cuts.accumulation_time(*cut);
            const double error = accumulation_time.formula + accumulation_time.error - (event.t - cut->tangential.t);
            if (!is_plastic_landing(event)) carried.error += link->F.head(carried.size) * error;
            cut.reset();
        }
        result.events.push_back(carried.of_time());
        result.course.add(event, sizes_at_fixed_time(carried, tangent, chain.rate()));
    }
    if (!chain.broken().empty()) {
        result.no_estimate_reason = chain.broken();
    } else if (cut) {
        result.no_estimate_reason =
            "the run ends between a cut and its Zeno point, where the computed motion leaves out the remaining impacts";
    } else {
        result.end = at_end(carried, tangent, chain.rate());
        if (!is_finite(*result.end)) {
            result.end.reset();
            result.no_estimate_reason =
                "the estimated errors overflow by the end of the run; a shorter run has an estimate";
        }
    }
    result.trusted_until = result.course.horizon();
    if (!result.trusted_until && result.end) result.trusted_until = trajectory.end_time;
    return result;
}

}  // namespace

// ---- error course ----

void ErrorCourse::take(const Vector& q, const Vector& v) {
    low_ = {low_.q.cwiseMin(q), low_.v.cwiseMin(v)};
    high_ = {high_.q.cwiseMax(q), high_.v.cwiseMax(v)};
}

void ErrorCourse::begin(const Run& run) {
    low_ = high_ = {run.q, run.v};
    const Vector none = Vector::Zero(run.q.size());
    entries_ = {{run.options.start_time, none, none}};
    horizon_.reset();
}

// A coordinate may have its extremes inside a step, so several points are taken.
void ErrorCourse::add(const Trajectory& trajectory, const DenseSegment& step, const State& sizes) {
    constexpr int parts = 8;
    for (int k = 1; k <= parts; ++k) {
        const double t = step.start + (step.end - step.start) * k / parts;
        const State state = state_in(step, trajectory.coefficients, trajectory.run.q.size(), t);
        take(state.q, state.v);
    }
    add(step.end, sizes);
}

void ErrorCourse::add(const Event& event, const State& sizes) {
    take(event.q, event.v_before);
    take(event.q, event.v_after);
    add(event.t, sizes);
}

void ErrorCourse::add(double t, const State& sizes) {
    Entry entry{t, known_or_infinite(sizes.q), known_or_infinite(sizes.v)};
    if (!horizon_) {
        const State range = this->range();
        const Eigen::Index q = first_excess(entry.q, range.q), v = first_excess(entry.v, range.v);
        if (q >= 0 || v >= 0) {
            horizon_ = t;
            is_rate_ = q < 0;
            coordinate_ = is_rate_ ? v : q;
        }
    } else {
        entry.q = entry.q.cwiseMax(entries_.back().q);
        entry.v = entry.v.cwiseMax(entries_.back().v);
    }
    entries_.push_back(std::move(entry));
}

std::optional<State> ErrorCourse::at(double t) const {
    if (entries_.empty()) return std::nullopt;
    auto after = std::lower_bound(entries_.begin(), entries_.end(), t,
                                  [](const Entry& entry, double time) { return entry.t < time; });
    if (after == entries_.end()) {
        if (!horizon_) return std::nullopt;
        return State{entries_.back().q, entries_.back().v, t};
    }
    State sizes{after->q, after->v, t};
    const auto include = [&](const Entry& entry) {
        sizes.q = sizes.q.cwiseMax(entry.q);
        sizes.v = sizes.v.cwiseMax(entry.v);
    };
    if (after->t > t && after != entries_.begin()) include(*std::prev(after));
    for (; after != entries_.end() && after->t == t; ++after) include(*after);
    return sizes;
}

// ---- estimate ----

std::optional<double> horizon_before_end(const Trajectory& trajectory, const ErrorEstimate& estimate) {
    if (!estimate.trusted_until || *estimate.trusted_until >= trajectory.end_time) return std::nullopt;
    return estimate.trusted_until;
}

double ErrorEstimate::FinalError::size() const { return std::hypot(norm, sigma); }

ErrorEstimate estimate_error(const Trajectory& trajectory, const std::stop_token& stop) {
    const FloatEnvironmentGuard ground;
    try {
        return estimate(trajectory, stop);
    } catch (const InputError& too_large) {  // derivatives that the run itself did not need
        return none(too_large.message);
    }
}

}  // namespace achilles
