#include "certify/collapse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/collapse.hpp"

namespace achilles {

namespace {

Interval bottom(const Interval& x) { return Interval(x.lo()); }

// The pair after an impact, as bounds that only get worse if rho falls or the other two rise:
//     rho <= v/u,   beta >= |hddot| H/u^2,   wait >= H/u (s)
struct Bounce {
    Interval rho, beta, wait;
};

// One flight until the other contact impacts: t = phi wait/rho >= its duration (s), d >= |hddot| t/u, r <= u'/u.
struct AlternateFlight {
    Interval phi, t, d, r;
};

// The recursion of theory-collapse.md 3 from one impact to the next.
class Alternation {
 public:
    Alternation(const AlternationBounds& bounds, std::string_view& failed) : bounds_(bounds), failed_(&failed) {}

    std::optional<AlternateFlight> flight(const Bounce& from, std::size_t landed) const {
        const Interval one(1.0), two(2.0), rest = one - two * from.beta / square(from.rho);
        if (!(rest.lo() >= 0.0)) return fail(collapse::still_gap);
        AlternateFlight flight;
        flight.phi = top(two / (one + sqrt(rest)));
        flight.t = top(flight.phi * from.wait / from.rho);
        flight.d = top(flight.phi * from.beta / from.rho);
        flight.r = bottom(from.rho - flight.d);
        if (!certainly_positive(flight.r)) return fail(collapse::falls);
        if (!(bounds_.e[landed].lo() >= (flight.d / two).hi())) return fail(collapse::stays_up);
        return flight;
    }
    std::optional<Bounce> impact_after(const AlternateFlight& flight, std::size_t landed) const {
        const Interval two(2.0), e = top(bounds_.e[landed]), high = e + flight.d / two;
        const Bounce next{bottom(bottom(bounds_.k[1 - landed]) - (e + flight.d) / flight.r),
                          top(flight.d * high / square(flight.r)), top(flight.t * high / flight.r)};
        if (!certainly_positive(next.rho)) return fail_impact(collapse::rises);
        return next;
    }
    // The time from this impact on (s), if two more impacts leave the pair no worse than it is.
    std::optional<CollapseTime> rest_of(const Bounce& from, std::size_t landed) const {
        const auto first = flight(from, landed);
        const auto middle = first ? impact_after(*first, landed) : std::nullopt;
        const auto second = middle ? flight(*middle, 1 - landed) : std::nullopt;
        const auto last = second ? impact_after(*second, 1 - landed) : std::nullopt;
        if (!last) return std::nullopt;
        const auto third = flight(*last, landed);
        if (!third) return std::nullopt;
        // Bounds on the ratios of successive flight times.
        const Interval two(2.0), one(1.0);
        const auto ratio = [&](const AlternateFlight& before, const Bounce& next, const AlternateFlight& after,
                               std::size_t i) {
            return top(after.phi * (top(bounds_.e[i]) + before.d / two) / (before.r * next.rho));
        };
        const Interval q = ratio(*first, *middle, *second, landed), q2 = ratio(*second, *last, *third, 1 - landed);
        const Interval cycle = top(q * q2);
        if (!(last->rho.lo() >= from.rho.lo()) || !(last->beta.hi() <= from.beta.hi()) ||
            !certainly_less(cycle, Interval(1.0))) {
            *failed_ = collapse::contracts;
            return std::nullopt;
        }
        return CollapseTime{top(first->t * (one + q * (one + q2) / (one - cycle))), cycle.hi()};
    }
    // A value of rho, not above this one, from which two impacts are likely to lead to a higher one.
    std::optional<CollapseTime> rest_from_below(const Bounce& from, std::size_t landed) const {
        if (auto time = rest_of(from, landed)) return time;
        const double k = bounds_.k[1 - landed].lo(), e = bounds_.e[landed].hi();
        const double product = bounds_.e[0].hi() * bounds_.e[1].hi();
        const double sum = bounds_.k[0].lo() * bounds_.k[1].lo() - bounds_.e[0].hi() - bounds_.e[1].hi();
        const double root = std::sqrt(sum * sum - 4.0 * product);
        if (!(root > 0.0)) return std::nullopt;
        const double low = (0.5 * (sum - root) + e) / k, high = (0.5 * (sum + root) + e) / k;
        for (double part = 0.5; part > 1e-5; part *= 0.5) {
            const Bounce lower{Interval(high - part * (high - low)), from.beta, from.wait};
            if (!(lower.rho.hi() <= from.rho.lo())) break;
            if (auto time = rest_of(lower, landed)) return time;
        }
        return std::nullopt;
    }

 private:
    std::optional<AlternateFlight> fail(std::string_view name) const {
        *failed_ = name;
        return std::nullopt;
    }
    std::optional<Bounce> fail_impact(std::string_view name) const {
        *failed_ = name;
        return std::nullopt;
    }
    const AlternationBounds& bounds_;
    std::string_view* failed_;
};

}  // namespace

std::optional<CollapseTime> collapse_time(const AlternationBounds& bounds, const AlternationStart& start,
                                          std::string_view& failed) {
    constexpr int most_impacts = 80;
    const Alternation alternation(bounds, failed);
    Bounce now{bottom(start.v / start.u), top(bounds.acceleration * start.H / square(start.u)), top(start.H / start.u)};
    if (!certainly_positive(now.rho)) {
        failed = collapse::rises;
        return std::nullopt;
    }
    std::size_t landed = start.landed;
    Interval before(0.0);
    for (int i = 0; i < most_impacts; ++i) {
        if (auto rest = alternation.rest_from_below(now, landed)) {
            rest->T = top(before + rest->T);
            return rest;
        }
        const auto flight = alternation.flight(now, landed);
        const auto next = flight ? alternation.impact_after(*flight, landed) : std::nullopt;
        if (!next) return std::nullopt;
        before = top(before + flight->t);
        now = *next;
        landed = 1 - landed;
    }
    return std::nullopt;
}

CollapseConditions::CollapseConditions(const Model& model, const Run& run, const std::array<Interval, 2>& e,
                                       std::size_t first, std::size_t second, Mode closed, ContactSet unpressed,
                                       const FloatEnvironmentGuard& ground)
    : TwoContactConditions(model, run, e, first, second, closed, unpressed, ground),
      has_skew_(model.has_friction()),
      sliding_(model.pair(first, second, closed).sliding) {
    if (sliding_ > 0) slips_ = model.evaluator<Interval>(model.pair(first, second, closed).slips, run.parameters);
}

std::optional<CollapseConditions::AtCut> CollapseConditions::at_cut(const PairCollision& collision,
                                                                    const State& tangential) {
    if (!evaluate_terms_at(tangential)) return std::nullopt;
    const PairLaw<double> law{mid(W(0, 0)), mid(W(0, 1)), mid(W(1, 0)), mid(W(1, 1)), {mid(e_[0]), mid(e_[1])}};
    const double c = std::sqrt(law.coupling());
    if (!(law.W12 < 0.0 && law.W21 < 0.0 && c < 1.0)) return std::nullopt;
    const std::array<double, 2> size = law.sizes();
    AtCut cut{law, {Interval(size[0]), Interval(size[1])}, {}, {}, {}};
    cut.impulse = {cut.size[0] / Interval(law.W11), cut.size[1] / Interval(law.W22)};
    cut.W0 = {{{Interval(1.0), Interval(-c)}, {Interval(-c), Interval(1.0)}}};
    const std::array<Interval, 2> sigma{Interval(collision.sigma[0]) / cut.size[0],
                                        Interval(collision.sigma[1]) / cut.size[1]};
    cut.r0 = top(sqrt(abs(by_inverse(cut.W0, sigma, sigma))));
    return cut;
}

// The bounds on the motion as long as it stays in the box, whose terms must have been evaluated.
std::optional<TwoContactConditions::MotionBounds> CollapseConditions::bounds_over(const PairBox& box, const AtCut& cut,
                                                                                  const CollapseStart& start,
                                                                                  std::string_view& failed) {
    const Interval one(1.0), two(2.0);
    if (!certainly_negative(W(0, 1)) || !certainly_negative(W(1, 0))) {
        failed = collapse::negative_c;
        return std::nullopt;
    }
    AlternationBounds bounds{{}, e_, Interval(0.0)};
    PairMatrix scaled;
    std::array<Interval, 2> hddot;
    for (std::size_t k = 0; k < 2; ++k) {
        bounds.k[k] = -W(1 - k, k) * (one + e_[k]) * cut.size[k] / (W(k, k) * cut.size[1 - k]);
        hddot[k] = terms_.hddot(k) / cut.size[k];
        bounds.acceleration = max(bounds.acceleration, abs(hddot[k]));
        for (std::size_t l = 0; l < 2; ++l) scaled[k][l] = W(k, l) * cut.impulse[l] / cut.size[k];
    }
    const Interval skew = has_skew_ ? (scaled[0][1] - scaled[1][0]) / two : Interval(0.0);
    if (has_skew_) scaled[0][1] = (scaled[0][1] + scaled[1][0]) / two;
    const std::size_t i = start.landed, j = 1 - i;
    const auto time =
        collapse_time(bounds,
                      {i, Interval(start.speed) / cut.size[i], Interval(-start.collision.sigma[j]) / cut.size[j],
                       Interval(start.collision.h[j]) / cut.size[j]},
                      failed);
    if (!time) return std::nullopt;
    // The growth of |sigma| in the norm of W0: forces add their integral, and each impact at most twice the deviation of
    // W times its impulse. S bounds the sum of these, in units of r0.
    const Interval force = top(sqrt(abs(by_inverse(cut.W0, hddot, hddot)))), omega = deviation(scaled, cut.W0, skew);
    const Interval kd = sqrt(two / (one + cut.W0[0][1]));
    const Interval duration = top(time->T / cut.r0);
    if (!certainly_less(kd * omega, one)) {
        failed = collapse::contained;
        return std::nullopt;
    }
    Interval m(box.growth);  // confirmed below
    const Interval S = top(kd * (two * m + force * duration) / (one - kd * omega));
    const Interval growth = top(one + force * duration + two * omega * S / (one - omega));
    if (!growth.is_defined() || !(growth.hi() <= 2.0)) {
        failed = collapse::contained;
        return std::nullopt;
    }
    MotionBounds motion;
    motion.T = time->T;
    motion.growth = growth;
    const Interval speed = m * cut.r0;
    motion.peak = speed * time->T;
    for (std::size_t k = 0; k < 2; ++k) {
        motion.force[k] = one / cut.size[k];
        motion.gap[k] = cut.size[k] * speed * square(time->T) / two;
    }
    motion.products = {square(cut.size[0] * speed) * time->T, cut.size[0] * cut.size[1] * square(speed) * time->T,
                       square(cut.size[1] * speed) * time->T};
    contraction_ = time->contraction;
    return motion;
}

// Whether the accelerations over the box decide which contacts stay (theory-collapse.md 4). A contact whose
// acceleration is 0 everywhere touches.
bool CollapseConditions::decides_who_stays(const PairBox& box, bool& both_held) {
    std::vector<Interval> at_rest = box.all;
    at_rest[2 * dof_] = at_rest[2 * dof_ + 1] = Interval(0.0);
    evaluate_terms(at_rest);
    const std::array<Interval, 2> a{-terms_.hddot(0), -terms_.hddot(1)};
    both_held = true;
    bool both_leave = true, one_leaves = false;
    for (std::size_t k = 0; k < 2; ++k) {
        // The acceleration of the other gap while contact k is held.
        const Interval other = a[1 - k] - W(1 - k, k) / W(k, k) * a[k];
        both_held = both_held && certainly_positive(other);
        one_leaves = one_leaves || (certainly_positive(a[k]) && certainly_negative(other));
        both_leave = both_leave && (certainly_negative(a[k]) || mag(a[k]) == 0.0);
    }
    return both_held || one_leaves || both_leave;
}

// Whether no slip ends over the box: u = u(s) + L sigma, with |sigma| bounded in the norm of W0 (theory-collapse.md 5).
bool CollapseConditions::keeps_sliding(const PairBox& box, const AtCut& cut) {
    if (!slips_) return true;
    set_box(*slips_, box.all);
    slips_->run();
    for (std::size_t k = 0; k < sliding_; ++k) {
        const Interval L0 = slips_->output(3 * k + 1) * cut.size[0], L1 = slips_->output(3 * k + 2) * cut.size[1];
        const Interval square_norm = square(L0) + Interval(2.0) * cut.W0[0][1] * L0 * L1 + square(L1);
        const Interval change = top(sqrt(abs(square_norm))) * Interval(box.growth) * cut.r0;
        if (!certainly_less(change, slips_->output(3 * k))) return false;
    }
    return true;
}

std::optional<PairCompletion> CollapseConditions::certify(const CollapseStart& start, bool cut_at_resolution,
                                                          std::string_view& failed) {
    const FloatEnvironmentGuard ground;
    const PairCollision& collision = start.collision;
    const State tangential = tangential_of(collision);
    const auto cut = at_cut(collision, tangential);
    if (!cut) return std::nullopt;
    const std::size_t i = start.landed, j = 1 - i;
    const AlternateImpacts law(cut->law);
    const double estimate = law.time(i, collision.sigma[i], collision.sigma[j], collision.h[j]);
    if (!law.is_real || !(estimate >= 0.0) || !std::isfinite(estimate)) {
        failed = law.is_real ? collapse::cone : collapse::real;
        return std::nullopt;
    }
    PairBox box = first_box(collision, tangential, 1.1 * estimate, 1.0 + 1e-6);
    for (int round = 0; round < 40; ++round) {
        update(box, cut->size, cut->r0);
        if (!evaluate_terms(box.all)) return std::nullopt;
        const auto motion = bounds_over(box, *cut, start, failed);
        if (!motion) return std::nullopt;
        failed = collapse::contained;
        if (!contain(box, *motion)) continue;
        std::optional<Certificate::OtherContactBounds> others;
        failed = collapse::slides;
        if (!keeps_sliding(box, *cut)) return std::nullopt;
        failed = collapse::others;
        if (!prove_other_contacts_stay(box.all, others)) return std::nullopt;
        const Interval first_flight =
            Interval(collision.h[j]) / (Interval(-collision.sigma[j]) + abs(terms_.hddot(j)) * motion->T);
        PairCompletion result{certificate_at(collision.before.t, {bottom(first_flight), motion->T}, estimate),
                              restart_of(collision, tangential)};
        Certificate& c = result.certificate;
        add_shadow(c, box, *motion);
        c.a_min = std::min(-terms_.hddot(0).hi(), -terms_.hddot(1).hi());
        c.a_max = std::max(-terms_.hddot(0).lo(), -terms_.hddot(1).lo());
        // Where a contact leaves, the motions differ from the computed time to the true one.
        const Interval late = top(motion->T - bottom(first_flight));
        std::vector<Interval> jump(dof_);
        for (std::size_t k = 0; k < dof_; ++k)
            jump[k] = top(abs(terms_.N(0, k) * terms_.hddot(0) + terms_.N(1, k) * terms_.hddot(1)));
        bool both_held = false;
        failed = collapse::who_stays;
        if (!decides_who_stays(box, both_held) && !cut_at_resolution) return std::nullopt;
        if (!both_held) {
            const Interval velocity = norm(jump) * late, position = velocity * motion->T;
            c.shadowing_velocity = (Interval(*c.shadowing_velocity) + velocity).hi();
            c.shadowing_position = (Interval(*c.shadowing_position) + position).hi();
            c.uniform_position = (Interval(*c.uniform_position) + position).hi();
        }
        decide(c, 0.5 * (Interval(c.zeno_high) - Interval(c.zeno_low)).hi());
        c.assumptions = {{"growth of the energy", motion->growth.hi(), 2.0},
                         {"ratio of two flight times to the two before", contraction_, 1.0}};
        c.others = std::move(others);
        c.cut_at_resolution = cut_at_resolution;
        failed = collapse::tolerances;
        if (!cut_at_resolution && !is_accepted(c)) return std::nullopt;
        failed = {};
        return result;
    }
    return std::nullopt;
}

}  // namespace achilles
