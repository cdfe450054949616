#include "simulate/impact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "number/float_environment.hpp"

namespace achilles {

namespace {

// Bound on the change of h by rounding of q. Written as a loop, because a vector expression of dynamic size is slower
// than the sum.
double rounding_of_q(const Contact& contact, const State& state) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < state.q.size(); ++i) sum += std::abs(contact.g.data()[i] * state.q.data()[i]);
    return 0x1p-53 * sum;
}

// x -= a n
void move_along(Vector& x, double a, const Vector& n) {
    newton::move_along(
        x.data(), static_cast<std::size_t>(x.size()), [n = n.data()](std::size_t i) { return n[i]; }, a);
}

// The interval of all numbers within this relative distance of a computed number.
Interval rounded(double x, double relative) { return {x - relative * std::abs(x), x + relative * std::abs(x)}; }

}  // namespace

void set_rounding_box(Evaluator<Interval>& program, const State& state) {
    constexpr double few_ulps = 0x1p-50;
    const auto n = static_cast<std::size_t>(state.q.size());
    for (std::size_t i = 0; i < n; ++i) {
        program.input(i) = rounded(state.q[static_cast<Eigen::Index>(i)], few_ulps);
        program.input(n + i) = rounded(state.v[static_cast<Eigen::Index>(i)], few_ulps);
    }
    program.clock() = rounded(state.t, few_ulps);
}

Vector impact(const Contact& contact, const Vector& v_before, double e) {
    Vector v = v_before;
    move_along(v, newton::removed_rate(e, contact.hdot), contact.impulse_direction);
    return v;
}

Vector reinitialize(const Contact& contact, const Vector& v_before, Reinitialization kind) {
    if (kind == Reinitialization::kinetic) return impact(contact, v_before, 0.0);
    return v_before - contact.hdot / contact.g.squaredNorm() * contact.g;
}

ContactKinematics::ContactKinematics(const Model& model, const Run& run, std::size_t contact, Mode mode)
    : model_(&model),
      programs_(&model.programs_of(contact, mode)),
      parameters_(run.parameters),
      dof_(static_cast<std::size_t>(model.dof())),
      terms_(model.evaluator(programs_->contact_terms, run.parameters)),
      gap_(model.evaluator<Interval>(programs_->gap, run.parameters)) {}

Contact ContactKinematics::at(const State& state) {
    Contact contact;
    evaluate(state, contact);
    return contact;
}

void ContactKinematics::evaluate(const State& state, Contact& contact) {
    set_state(terms_, state);
    terms_.run();
    contact.h = terms_.h();
    contact.hdot = terms_.hdot();
    contact.W = terms_.W();
    contact.gap_t = terms_.gap_t();
    const auto n = static_cast<Eigen::Index>(dof_);
    contact.impulse_direction.resize(n);
    contact.g.resize(n);
    for (std::size_t i = 0; i < dof_; ++i) {
        contact.impulse_direction.data()[i] = terms_.impulse_direction(i);
        contact.g.data()[i] = terms_.gradient(i);
    }
}

double ContactKinematics::gap_error(const State& state) {
    for (std::size_t i = 0; i < dof_; ++i) gap_.input(i) = rounded(state.q[static_cast<Eigen::Index>(i)], 0x1p-53);
    gap_.clock() = rounded(state.t, 0x1p-53);
    gap_.run();
    return rad(gap_.output(0));
}

// The rounding of q alone contributes a part of the bound, which is cheap to compute and often sufficient. From one step
// to the next the whole bound grows little beyond these roundings of q and t, or beyond the bound before where they
// become small. A value `far` above both is therefore outside without a new bound, but only a few times in succession.
bool ContactKinematics::within_gap_error(double value, double times, const Contact& contact, const State& state) {
    constexpr double far = 0x1p8;
    constexpr int uses = 7;
    const double roundings_of_q = rounding_of_q(contact, state);
    if (std::abs(value) <= times * (0.5 * roundings_of_q)) return true;  // half of it, for its own rounding
    const double roundings = roundings_of_q + 0x1p-53 * std::abs(contact.gap_t * state.t);
    if (uses_left_ > 0 && std::abs(value) > far * times * std::max(error_, error_in_roundings_ * roundings)) {
        --uses_left_;
        return false;
    }
    error_ = gap_error(state);
    error_in_roundings_ = error_ / roundings;
    uses_left_ = roundings > 0.0 ? uses : 0;
    return std::abs(value) <= times * error_;
}

double ContactKinematics::hdot_error(const State& state) {
    auto& enclosure = model_->lazily(enclosure_, programs_->contact_terms, parameters_);
    set_state(enclosure, state);
    enclosure.run();
    return rad(enclosure.hdot());
}

// Newton's method along n. Near the surface, h may be accurate far below the rounding of q, as (2 + sin x) y is near
// y = 0; its rounding is then set by the last correction. Because Newton's method converges quadratically, a reduction
// of |h| by 2^-40 in one iteration means that the rest is rounding. If dh vanishes on the surface, |h| falls by a
// constant factor instead.
bool ContactKinematics::project(State& state, bool keep_velocity, Contact& contact) {
    constexpr int rounds = 8;  // two or three are usual; more help only with rounding
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0;; ++round) {
        evaluate(state, contact);
        if (!(contact.W > 0.0) || !std::isfinite(contact.h)) break;
        // The error bound costs more than an iteration, so the first one evaluates it only if h is tiny at once. One
        // iteration usually leaves a few roundings of q, which further ones do not improve; that is accepted.
        const double roundings = std::abs(contact.h) / rounding_of_q(contact, state);
        const bool far = round == 0 && roundings > 0.5;
        const bool near = round > 0 && (roundings <= 4.0 || std::abs(contact.h) <= 0x1p-40 * before);
        if (near || (!far && within_gap_error(contact.h, round < rounds ? 1.0 : 4.0, contact, state))) {
            if (!keep_velocity) {
                move_along(state.v, contact.hdot, contact.impulse_direction);
                contact.hdot = 0.0;
            }
            return true;
        }
        if (round == rounds) break;
        before = std::abs(contact.h);
        move_along(state.q, contact.h, contact.impulse_direction);
    }
    return false;
}

ContactKinematics::Normal ContactKinematics::normal(const State& state) {
    const FloatEnvironmentGuard ground;
    auto& enclosure = model_->lazily(release_enclosure_, programs_->release_terms, parameters_);
    set_rounding_box(enclosure, state);
    enclosure.run();
    return {enclosure.hddot(), enclosure.jerk()};
}

Interval ContactKinematics::hddot(const State& state) {
    const FloatEnvironmentGuard ground;
    Evaluator<Interval>& enclosure = normal_enclosure();
    set_rounding_box(enclosure, state);
    enclosure.run();
    return enclosure.output(0);
}

Interval ContactKinematics::hddot_within(const State& distances, const State& state) {
    const FloatEnvironmentGuard ground;
    Evaluator<Interval>& enclosure = normal_enclosure();
    const auto around = [](double x, double distance) { return Interval(x) + Interval(-distance, distance); };
    for (std::size_t i = 0; i < dof_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        enclosure.input(i) = around(state.q[k], distances.q[k]);
        enclosure.input(dof_ + i) = around(state.v[k], distances.v[k]);
    }
    enclosure.clock() = around(state.t, distances.t);
    enclosure.run();
    return enclosure.output(0);
}

Evaluator<Interval>& ContactKinematics::normal_enclosure() {
    if (!normal_enclosure_)
        normal_enclosure_ = model_->evaluator<Interval>(programs_->normal_acceleration, parameters_);
    return *normal_enclosure_;
}

double ContactKinematics::normal_acceleration(const State& state) {
    if (!normal_) normal_ = model_->evaluator(programs_->normal_acceleration, parameters_);
    set_state(*normal_, state);
    normal_->run();
    return normal_->output(0);
}

double ContactKinematics::jerk(const State& state) {
    auto& release = model_->lazily(release_, programs_->release_terms, parameters_);
    set_state(release, state);
    release.run();
    return release.jerk();
}

}  // namespace achilles
