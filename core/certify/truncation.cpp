#include "certify/truncation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "certify/impact_law_proof.hpp"
#include "certify/paper.hpp"
#include "certify/range.hpp"
#include "certify/sharp.hpp"
#include "certify/sticking.hpp"
#include "contacts/delassus.hpp"

namespace achilles {

AccumulationTime accumulation_time_bounds(const Interval& e, const Interval& a_min, const Interval& a_max,
                                          const Interval& w) {
    const Interval one(1.0), r = a_max / a_min, rebound = Interval(2.0) * e * (one + e) * w;
    return {rebound / (a_max * (one - square(e) / r)), rebound / (a_min * (one - square(e) * r))};
}

double estimated_accumulation_time(const AccelerationTrend& trend, double e, double w) {
    return estimated_accumulation_time(trend.a, trend.b, trend.c, e, w);
}

namespace {

// |cA| + 1.09 |cB| + |cE| and |cC| + |cD| + |cF| + |cG|, for Psi = cA t hdot + cB t hdot^2/z + cC hdot^2 + cD hdot^3/z
// + cE t z + cF hdot z + cG z^2.
struct Psi {
    Interval with_time, without;
};
Psi sizes_of_psi(const AccelerationTrend& trend, const Interval& e, const Interval& per_a) {
    const Interval one(1.0), half(0.5), K = (one + e) / (one - e), e2 = square(e);
    const Interval by_a = Interval(trend.b) * square(per_a), with_c = Interval(trend.c) * per_a;
    const Interval cB = -half * by_a * K, cC = -half * (by_a + with_c) * per_a, cF = cB * per_a;
    const Interval cD = -K * (half * by_a + with_c) * per_a / Interval(3.0);
    const Interval cG = (cD + cF) * ((one + e2) / (one - e2)) - cC;
    // cA = -b/a^2, cE = cB.
    return {abs(by_a) + Interval(1.09, 1.091) * abs(cB) + abs(cB), abs(cC) + abs(cD) + abs(cF) + abs(cG)};
}

}  // namespace

Interval third_order_error(const AccelerationTrend& trend, const AccelerationBounds& drift, const Interval& e,
                           const Interval& a_min, const Interval& a_max, const Interval& w, const Interval& latest) {
    const Interval a(trend.a), one(1.0), two(2.0), T(latest.hi()), per_a = one / a, per_a_min = one / a_min;
    const Interval e2 = square(e), h_m = Interval(0.5) * square(e * w) * per_a_min, middle(mid(drift.Phi));
    const Interval rho = abs(drift.start - a) + abs(drift.by_sigma - Interval(trend.c)) * w +
                         abs(drift.P - Interval(trend.b)) * T + abs(middle) * h_m + abs(drift.Phi - middle) * w * T +
                         abs(drift.Xi) * square(w) * T;
    // max(e, e'')^2 = e^2 max(1, a_max/a_min)
    const Interval z_m = w * sqrt(e2 * (max(one, a_max * per_a_min) + a * per_a_min));
    const Interval d_m = max(abs(a_max - a), abs(a - a_min));
    const Psi psi = sizes_of_psi(trend, e, per_a);
    const Interval S = T * psi.with_time + two * z_m * psi.without;
    const Interval doubled = two * per_a / (one - e);  // 2/(a (1 - e))
    return T * (doubled * rho + d_m * S);
}

Interval third_order_accumulation_time(const AccelerationTrend& trend, const AccelerationBounds& drift,
                                       const Interval& e, const Interval& a_min, const Interval& a_max,
                                       const Interval& w, const Interval& latest) {
    const Interval one(1.0), two(2.0), per_a = one / Interval(trend.a), T0 = two * per_a / (one - e) * e * w;
    const Interval off = third_order_error(trend, drift, e, a_min, a_max, w, latest);
    const Interval curving = (two * Interval(trend.b) * per_a + Interval(trend.c)) / Interval(6.0);
    const Interval center = T0 - square(T0) * curving;
    if (!off.is_defined() || !center.is_defined()) return Interval::undefined();
    return center + Interval(-off.hi(), off.hi());
}

std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, const Interval& e,
                                                            const BouncingKey& key, ContactSet unpressed) {
    const FloatEnvironmentGuard ground;
    if (sticks_at_impacts(model, key))
        return std::make_unique<StickingConditions>(model, run, e, key, unpressed, ground);
    if (run.options.truncation.conditions == Conditions::paper)
        return std::make_unique<PaperConditions>(model, run, e, key, unpressed, ground);
    return std::make_unique<SharpConditions>(model, run, e, key, unpressed, ground);
}

std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, const Interval& e,
                                                            std::size_t contact, Mode mode, ContactSet unpressed) {
    return truncation_conditions(model, run, e, BouncingKey{contact, mode}, unpressed);
}

bool SpeedGuess::fails(double speed) {
    constexpr double doubt = 1.5;              // accepted error factor of a guess that was made at another collision
    if (speed > last_speed_) too_wide_ = 0.0;  // a new bouncing sequence
    last_speed_ = speed;
    const double slower = speed / wide_speed_;
    return slower < 1.0 && too_wide_ * slower * slower * (power_ == 3 ? slower : 1.0) > doubt;
}

void SpeedGuess::remember(double speed, double too_wide, int power) {
    wide_speed_ = speed;
    too_wide_ = too_wide;
    power_ = power;
}

std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, std::size_t contact,
                                                            Mode mode, ContactSet unpressed) {
    return truncation_conditions(model, run, model.restitutions(run.parameters)[contact].enclosure, contact, mode,
                                 unpressed);
}

Interval instant_of(const Collision& collision, ContactTerms<Evaluator<Interval>>& contact) {
    const State& state = collision.before;
    set_state(contact, state);
    const auto around = [](double x) { return Interval(x) + Interval(-1.0, 1.0) * Interval(0x1p-53 * std::abs(x)); };
    for (Eigen::Index i = 0; i < state.q.size(); ++i) contact.input(static_cast<std::size_t>(i)) = around(state.q[i]);
    contact.clock() = around(state.t);
    contact.run();
    const double ulp = 0x1p-52 * std::abs(state.t);  // plus at most this
    const Interval d = Interval(4.0 * rad(contact.h())) / Interval(collision.speed) + Interval(ulp);
    return Interval(state.t) + Interval(-d.hi(), d.hi());
}

Interval norm(const std::vector<Interval>& x) {
    Interval sum(0.0);
    for (const Interval& entry : x) sum = sum + square(entry);
    return sqrt(sum);
}

void CollisionBox::put_into(std::vector<Interval>& variables) const {
    for (std::size_t i = 0; i < q0.size(); ++i) {
        variables[i] = widened(q0[i], q_radius[i]);
        variables[q0.size() + i] = widened(s0[i], s_radius[i]);
    }
}

ConditionsBase::ConditionsBase(const Model& model, const Run& run, const OtherContactTerms* others,
                               std::vector<std::uint32_t> variables, ContactSet unpressed, const FloatEnvironmentGuard&)
    : dof_(static_cast<std::size_t>(model.dof())),
      truncation_(run.options.truncation),
      variables_(std::move(variables)),
      is_alone_(model.contacts() == 1),
      unpressed_(unpressed),
      other_contact_terms_(others),
      impulse_ratio_(model.layout().impulse_ratio()),
      sliding_speed_(model.layout().sliding_speed()) {
    if (other_contact_terms_ == nullptr) return;
    other_contact_program_ = model.evaluator<Interval>(other_contact_terms_->program, run.parameters);
    if (!other_contact_terms_->impact_law.elements.empty())
        impact_law_program_ = model.evaluator<Interval>(other_contact_terms_->impact_law.program, run.parameters);
}

bool ConditionsBase::prove_other_contacts_stay(const std::vector<Interval>& box,
                                               std::optional<Certificate::OtherContactBounds>& proved,
                                               const Interval& e, const Interval& ratio) {
    obstacle_.reset();
    if (other_contact_terms_ == nullptr) return true;
    set_box(other_contact_program_, box);
    if (!other_contact_terms_->cones.empty()) other_contact_program_.input(sliding_speed_) = Interval(0.0);
    const ImpactLawTerms& law = other_contact_terms_->impact_law;
    if (!law.elements.empty()) other_contact_program_.input(impulse_ratio_) = ratio;
    other_contact_program_.run();
    proved = bounds_on_other_contacts(*other_contact_terms_, other_contact_program_, unpressed_, inactive_, latched_,
                                      &obstacle_);
    if (!proved) return false;
    if (!law.elements.empty()) {
        set_box(impact_law_program_, box);
        obstacle_ = doubt_of_impact_law(law, impact_law_program_, sliding_speed_, e);
        if (obstacle_) return false;
    }
    if (is_alone_) proved.reset();
    return true;
}

Certificate ConditionsBase::certificate_at(double tau_k, const AccumulationTime& accumulation_time,
                                           double estimated) const {
    Certificate certificate;
    certificate.certified = true;
    certificate.conditions = truncation_.conditions;
    certificate.reinitialization = truncation_.reinitialization;
    certificate.zeno_low = (Interval(tau_k) + Interval(accumulation_time.earliest.lo())).lo();
    certificate.zeno_high = (Interval(tau_k) + Interval(accumulation_time.latest.hi())).hi();
    const double low = std::max(tau_k, certificate.zeno_low), time = tau_k + estimated;
    certificate.zeno_time = std::isfinite(time) ? std::clamp(time, low, std::max(low, certificate.zeno_high))
                                                : 0.5 * (low + certificate.zeno_high);
    return certificate;
}

void ConditionsBase::decide(Certificate& c, double half_width) const {
    constexpr double none = std::numeric_limits<double>::infinity();
    c.decision = {{"time bound", half_width, truncation_.eps_t},
                  {"uniform position", c.uniform_position.value_or(none), truncation_.eps_q},
                  {"shadowing velocity", c.shadowing_velocity.value_or(none), truncation_.eps_v}};
    c.tightest_bound = c.decision->closest().name;
}

TruncationConditions::TruncationConditions(const Model& model, const Run& run, const Interval& e,
                                           const BouncingKey& key, ContactSet unpressed,
                                           const FloatEnvironmentGuard& ground)
    : ConditionsBase(model, run,
                     model.contacts() == 1 && !model.has_friction() && !model.has_guards()
                         ? nullptr
                         : &model.other_contact_terms(key),
                     model.bouncing(key).variables, unpressed, ground),
      sigma_(model.layout().sigma()),
      autonomous_(model.equations().autonomous),
      e_(e),
      state_(key.state),
      contact_(model.evaluator<Interval>(model.programs_of(key.contact, key.mode).contact_terms, run.parameters)),
      trend_(model.evaluator(model.bouncing(key).trend, run.parameters)),
      change_(dof_, Interval(0.0)) {
    if (model.equations().in_forces.contains(key.contact))
        change_program_ = model.evaluator<Interval>(model.change_at_zeno_point(key), run.parameters);
}

void TruncationConditions::find_change(const std::vector<Interval>& box) {
    if (!change_program_) return;
    set_box(*change_program_, box);
    change_program_->run();
    for (std::size_t i = 0; i < dof_; ++i) change_[i] = abs(change_program_->output(i));
}

Interval TruncationConditions::late_change(std::size_t i, const Certificate& c, const Interval& growth) const {
    return change_program_ ? change_[i] * (Interval(c.zeno_high) - Interval(c.zeno_low)) * growth : Interval(0.0);
}

AccelerationTrend TruncationConditions::trend_at(const Collision& collision) {
    set_state(trend_, collision.with(collision.tangential));
    trend_.run();
    return {-trend_.hddot(), -trend_.rate(), -trend_.by_sigma()};
}

std::optional<Certificate::OtherContactBounds> bounds_on_other_contacts(const OtherContactTerms& other_contact_terms,
                                                                        const Evaluator<Interval>& program,
                                                                        ContactSet unpressed, ContactSet inactive,
                                                                        ContactSet latched,
                                                                        std::optional<BouncingObstacle>* obstacle) {
    Certificate::OtherContactBounds others;
    const auto fail = [obstacle](std::size_t which, std::string_view text) {
        if (obstacle != nullptr) *obstacle = BouncingObstacle{which, text};
        return std::nullopt;
    };
    const std::size_t bouncing = other_contact_terms.bouncing.size();
    std::size_t next = bouncing;
    for (const std::size_t contact : other_contact_terms.held) {
        const Interval hddot = program.output(next), W = program.output(next + 1);
        next += 2;
        const bool is_unpressed = unpressed.contains(contact), is_latched = latched.contains(contact);
        if (!(is_unpressed || is_latched || certainly_negative(hddot)) || !certainly_positive(W))
            return fail(contact, "is not proved to stay pressed");
        Certificate::OtherContactBounds::HeldContactBound held{contact, 0.0, 0.0,
                                                               is_unpressed ? 0.0 : (-hddot / W).lo()};
        for (std::size_t k = 0; k < bouncing; ++k) {
            const Interval kappa = program.output(next++);
            if (!is_latched && !(kappa.lo() >= 0.0)) {
                if (!counts_as_zero(kappa, std::sqrt(mid(program.output(k)) / mid(W))))
                    return fail(contact, "is not proved to stay closed under the impulses");
                others.rounded_zero = true;
            }
            held.transmission_low = k == 0 ? kappa.lo() : std::min(held.transmission_low, kappa.lo());
            held.transmission_high = k == 0 ? kappa.hi() : std::max(held.transmission_high, kappa.hi());
        }
        others.held.push_back(held);
    }
    for (const std::size_t contact : other_contact_terms.open) {
        const Interval gap = program.output(next++);
        if (inactive.contains(contact)) {
            if (!certainly_negative(gap)) return fail(contact, "is not proved to stay closed without counting");
            continue;
        }
        if (!certainly_positive(gap)) return fail(contact, "is not proved to stay open");
        others.least_gap = std::min(others.least_gap.value_or(std::numeric_limits<double>::infinity()), gap.lo());
    }
    for (std::size_t i = 0; i < other_contact_terms.positive; ++i) {
        if (certainly_positive(program.output(next++))) continue;
        if (i >= other_contact_terms.conditions.size()) return std::nullopt;
        return fail(other_contact_terms.conditions[i].which, other_contact_terms.conditions[i].text);
    }
    for (std::size_t i = 0; i < other_contact_terms.nonzero; ++i) {
        const Interval on = program.output(next++);
        if (!certainly_positive(on) && !certainly_negative(on)) return std::nullopt;
    }
    for (const std::size_t contact : other_contact_terms.cones) {
        const auto place = std::find(other_contact_terms.held.begin(), other_contact_terms.held.end(), contact) -
                           other_contact_terms.held.begin();
        const Interval W = program.output(bouncing + static_cast<std::size_t>(place) * (2 + bouncing) + 1);
        const double size = std::sqrt(mid(program.output(0)) / mid(W));
        for (int side = 0; side < 2; ++side) {
            const Interval room = program.output(next++);
            if (!(room.lo() >= 0.0) && !counts_as_zero(room, size))
                return fail(contact, "is not proved to stick under the impulses");
        }
    }
    return others;
}

Interval transmission(const OtherContactTerms& other_contact_terms, const Evaluator<Interval>& program, std::size_t i) {
    const std::size_t bouncing = other_contact_terms.bouncing.size();
    return program.output(bouncing + i * (2 + bouncing) + 2);
}

}  // namespace achilles
