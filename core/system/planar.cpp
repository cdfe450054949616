#include "system/planar.hpp"

#include <algorithm>
#include <utility>

namespace achilles {

PlanarVector::PlanarVector(const ProductSum& angle, const ProductSum& x, const ProductSum& y) {
    if (!x.is_zero() || !y.is_zero()) terms.push_back({angle, x, y});
}

PlanarVector operator+(const PlanarVector& a, const PlanarVector& b) {
    PlanarVector result = a;
    for (const RotatedVector& added : b.terms) {
        const auto like = std::find_if(result.terms.begin(), result.terms.end(),
                                       [&](const RotatedVector& term) { return term.angle == added.angle; });
        if (like == result.terms.end()) {
            result.terms.push_back(added);
            continue;
        }
        like->x = like->x + added.x;
        like->y = like->y + added.y;
        if (like->x.is_zero() && like->y.is_zero()) result.terms.erase(like);
    }
    return result;
}

PlanarVector operator-(const PlanarVector& a, const PlanarVector& b) {
    PlanarVector minus = b;
    for (RotatedVector& term : minus.terms) {
        term.x = -term.x;
        term.y = -term.y;
    }
    return a + minus;
}

namespace {

// The sum over all pairs of terms of cos(b - a) `even` + sin(b - a) `odd`.
template <class Even, class Odd>
ProductSum over_pairs(const PlanarVector& a, const PlanarVector& b, Graph& graph, const Even& even, const Odd& odd) {
    ProductSum sum;
    for (const RotatedVector& u : a.terms) {
        for (const RotatedVector& w : b.terms) {
            const auto [c, s] = cosine_and_sine(w.angle - u.angle, graph);
            sum = std::move(sum) + c * even(u, w) + s * odd(u, w);
        }
    }
    return sum.without_squares();
}

ProductSum dot_of(const RotatedVector& u, const RotatedVector& w) { return u.x * w.x + u.y * w.y; }
ProductSum cross_of(const RotatedVector& u, const RotatedVector& w) { return u.x * w.y - u.y * w.x; }

}  // namespace

ProductSum dot(const PlanarVector& a, const PlanarVector& b, Graph& graph) {
    return over_pairs(a, b, graph, dot_of,
                      [](const RotatedVector& u, const RotatedVector& w) { return -cross_of(u, w); });
}

ProductSum cross(const PlanarVector& a, const PlanarVector& b, Graph& graph) {
    return over_pairs(a, b, graph, cross_of, dot_of);
}

std::array<ProductSum, 2> components(const PlanarVector& vector, const ProductSum& axes, Graph& graph) {
    const ProductSum one = ProductSum::number(graph, 1);
    return {dot({axes, one, {}}, vector, graph), dot({axes, {}, one}, vector, graph)};
}

ProductSum Kinematics::rate_of(const ProductSum& quantity) const {
    ProductSum sum;
    for (std::size_t i = 0; i < q_.size(); ++i)
        sum = std::move(sum) + quantity.derivative(q_[i]) * ProductSum::from(graph_.symbol(v_[i]));
    return sum;
}

ProductSum Kinematics::drift_of(const ProductSum& quantity) const { return quantity.derivative(t_); }

MovingPoint Kinematics::point_in(const MovingFrame& frame, const ProductSum& x, const ProductSum& y) const {
    const ProductSum& angle = frame.angle;
    // An angular velocity and a length that are sums stay together: L*cos(a - b)*a'*(a' + c').
    const auto turning = [&](const ProductSum& rate) {
        return PlanarVector(angle, -(rate.packed() * y.packed()), rate.packed() * x.packed());
    };
    return {frame.origin.position + PlanarVector(angle, x, y),
            frame.origin.velocity + PlanarVector(angle, rate_of(x), rate_of(y)) + turning(frame.rate),
            frame.origin.drift + PlanarVector(angle, drift_of(x), drift_of(y)) + turning(frame.drift)};
}

MovingFrame Kinematics::frame_at(const MovingPoint& origin, const MovingFrame& axes, const ProductSum& angle) const {
    return {origin, axes.angle + angle, axes.rate + rate_of(angle), axes.drift + drift_of(angle)};
}

}  // namespace achilles
