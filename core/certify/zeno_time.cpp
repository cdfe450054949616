#include "certify/zeno_time.hpp"

namespace achilles {

Wait wait_for_zeno(const Interval& e, const Interval& a_min, const Interval& a_max, const Interval& w) {
    const Interval one(1.0), r = a_max / a_min, rebound = Interval(2.0) * e * (one + e) * w;
    return {rebound / (a_max * (one - square(e) / r)), rebound / (a_min * (one - square(e) * r))};
}

double estimated_wait(const Trend& trend, double e, double w) {
    return estimated_wait(trend.a, trend.b, trend.c, e, w);
}

namespace {

// |cA| + 1.09 |cB| + |cE| and |cC| + |cD| + |cF| + |cG|, for Psi = cA t hdot + cB t hdot^2/z + cC hdot^2 + cD hdot^3/z
// + cE t z + cF hdot z + cG z^2.
struct Psi {
    Interval with_time, without;
};
Psi sizes_of_psi(const Trend& trend, const Interval& e, const Interval& per_a) {
    const Interval one(1.0), half(0.5), K = (one + e) / (one - e), e2 = square(e);
    const Interval by_a = Interval(trend.b) * square(per_a), with_c = Interval(trend.c) * per_a;
    const Interval cB = -half * by_a * K, cC = -half * (by_a + with_c) * per_a, cF = cB * per_a;
    const Interval cD = -K * (half * by_a + with_c) * per_a / Interval(3.0);
    const Interval cG = (cD + cF) * ((one + e2) / (one - e2)) - cC;
    // cA = -b/a^2, cE = cB.
    return {abs(by_a) + Interval(1.09, 1.091) * abs(cB) + abs(cB), abs(cC) + abs(cD) + abs(cF) + abs(cG)};
}

}  // namespace

Interval third_order_error(const Trend& trend, const Drift& drift, const Interval& e, const Interval& a_min,
                           const Interval& a_max, const Interval& w, const Interval& latest) {
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

Interval third_order_wait(const Trend& trend, const Drift& drift, const Interval& e, const Interval& a_min,
                          const Interval& a_max, const Interval& w, const Interval& latest) {
    const Interval one(1.0), two(2.0), per_a = one / Interval(trend.a), T0 = two * per_a / (one - e) * e * w;
    const Interval off = third_order_error(trend, drift, e, a_min, a_max, w, latest);
    const Interval curving = (two * Interval(trend.b) * per_a + Interval(trend.c)) / Interval(6.0);
    const Interval centre = T0 - square(T0) * curving;
    if (!off.is_defined() || !centre.is_defined()) return Interval::undefined();
    return centre + Interval(-off.hi(), off.hi());
}

}  // namespace achilles
