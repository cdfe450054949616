#include "enclose/crossing_surface.hpp"

#include <algorithm>

#include "number/jet.hpp"

namespace achilles {

namespace {

Interval product(const Intervals& a, const Intervals& b) {
    Interval sum(0.0);
    for (std::size_t i = 0; i < a.size(); ++i) sum += times(a[i], b[i]);
    return sum;
}

Intervals unit(std::size_t size, std::size_t i) {
    Intervals result(size);
    result[i] = Interval(1.0);
    return result;
}

}  // namespace

CrossingSurface CrossingSurface::of_gap(const Coordinates& z, std::size_t contact) {
    const std::size_t h = z.h(contact);
    return {[h](const Intervals& box) { return box[h]; }, [h](const Intervals& box) { return unit(box.size(), h); },
            std::pair(h, 0.0), false};
}

CrossingSurface CrossingSurface::of_time(const Coordinates&, double time) {
    return {[time](const Intervals& box) { return box[Coordinates::t()] - Interval(time); },
            [](const Intervals& box) { return unit(box.size(), Coordinates::t()); }, std::pair(Coordinates::t(), time),
            true};
}

void cross(Doubleton& set, const EnclosureStep& step, const CrossingSurface& section, Interval& tau) {
    for (int round = 0;; ++round) {
        const Interval middle(mid(tau));
        Intervals point = step.center_at(middle), box = step.box_over(set, tau);
        for (std::size_t i = 0; i < box.size(); ++i) box[i] = hull(box[i], point[i]);
        const Intervals F = step.rate_at(tau), rho = step.remainder_at(tau), G = section.slope(box);
        IntervalMatrix S = step.slope_at(tau);
        const Interval rate = product(G, F), off = section.value(point) + product(G, rho);
        if (!(section.rises ? certainly_positive(rate) : certainly_negative(rate)))
            throw ProofStopped{"a transversal crossing of an event surface is not proved for the whole set"};
        Intervals across(set.size());  // G S
        for (std::size_t i = 0; i < set.size(); ++i)
            for (std::size_t j = 0; j < set.size(); ++j) across[j] += times(G[i], S(i, j));
        const Interval th = -(off + set.along(across.data())) / rate;
        const Interval narrowed = middle + th;
        tau = {std::max(tau.lo(), narrowed.lo()), std::min(tau.hi(), narrowed.hi())};
        if (!tau.is_defined()) throw ProofStopped{"no enclosure of a crossing time was found"};
        if (round == 0) continue;
        for (std::size_t i = 0; i < set.size(); ++i) {
            if (section.exact && section.exact->first == i) {
                point[i] = Interval(section.exact->second);
                for (std::size_t j = 0; j < set.size(); ++j) S(i, j) = Interval(0.0);
                continue;
            }
            const Interval a = F[i] / rate;
            point[i] = point[i] + rho[i] - times(a, off);
            for (std::size_t j = 0; j < set.size(); ++j) S(i, j) -= times(a, across[j]);
        }
        set.map(point, S);
        if (section.exact) set.set(section.exact->first, section.exact->second);
        return;
    }
}

namespace {

Interval plain_value(const Intervals& c, const Interval& t) {
    Interval sum = c.back();
    for (std::size_t k = c.size() - 1; k-- > 0;) sum = times(sum, t) + c[k];
    return sum;
}

}  // namespace

Interval slope_over(const Intervals& c, const Interval& t) {
    Interval sum(0.0);
    for (std::size_t k = c.size() - 1; k >= 1; --k) sum = times(sum, t) + times(Interval(static_cast<double>(k)), c[k]);
    return sum;
}

// The intersection of Horner's scheme and the mean-value form.
Interval value_over(const Intervals& c, const Interval& t) {
    const Interval plain = plain_value(c, t), middle(mid(t));
    const Interval sharp = plain_value(c, middle) + times(slope_over(c, t), t - middle);
    const double lo = std::max(plain.lo(), sharp.lo()), hi = std::min(plain.hi(), sharp.hi());
    return lo <= hi ? Interval(lo, hi) : plain;
}

FirstRoot first_root(const Intervals& c, double length) {
    constexpr double finest = 0x1p-32;  // fraction of the length; near a graze the zeros are close together
    double a = 0.0, piece = length;
    while (a < length) {
        const double b = std::min(a + piece, length);
        if (value_over(c, {a, b}).lo() > 0.0) {
            a = b;
            piece = 2.0 * piece;
            continue;
        }
        piece = 0.5 * std::min(piece, length - a);
        if (piece < finest * length) break;
    }
    if (a >= length) return {FirstRoot::Kind::none, {}};
    // Starting at a: p > 0 at a and p' < 0 on [a, b], so there is at most one zero. If the Newton image lies below b,
    // there is exactly one.
    for (double reach = finest * length; a > 0.0 || c.front().lo() > 0.0; reach *= 2.0) {
        const double b = std::min(a + reach, length);
        const Interval slope = slope_over(c, {a, b}), middle(0.5 * a + 0.5 * b);
        if (certainly_negative(slope)) {
            const Interval image = middle - plain_value(c, middle) / slope;
            if (image.hi() < b && image.hi() >= a) return {FirstRoot::Kind::one, {std::max(a, image.lo()), image.hi()}};
        }
        if (b >= length) break;
    }
    return {FirstRoot::Kind::undecided, Interval(a)};
}

}  // namespace achilles
