#include "contacts/delassus.hpp"

namespace achilles {

namespace {

bool is_zero(double x) { return x == 0.0; }
bool is_zero(const Interval& x) { return x.lo() == 0.0 && x.hi() == 0.0; }
bool is_defined(double) { return true; }
bool is_defined(const Interval& x) { return x.is_defined(); }

bool is_clear(double pivot, double diagonal, double least) { return pivot > least * diagonal; }
bool is_clear(const Interval& pivot, const Interval&, double) { return certainly_positive(pivot); }

// Exact zero times a number is exactly zero. An interval product would be widened by rounding, and uncoupled contacts
// would appear coupled.
template <class Number>
Number product(const Number& a, const Number& b) {
    if ((is_zero(a) && is_defined(b)) || (is_zero(b) && is_defined(a))) return Number(0.0);
    return a * b;
}

template <class Number>
ContactVector<Number> zeros(Eigen::Index size) {
    ContactVector<Number> x(size);
    for (Eigen::Index i = 0; i < size; ++i) x[i] = Number(0.0);
    return x;
}

}  // namespace

ContactMatrix<double> rounding_radius(const ContactMatrix<double>& W) {
    constexpr double few = 0x1p-48;
    ContactMatrix<double> radius(W.rows(), W.cols());
    for (Eigen::Index i = 0; i < W.rows(); ++i)
        for (Eigen::Index k = 0; k < W.cols(); ++k)
            radius(i, k) = W(i, k) == 0.0 ? 0.0 : few * std::sqrt(W(i, i) * W(k, k));
    return radius;
}

ContactMatrix<Interval> enclosure(const ContactMatrix<double>& W, const ContactMatrix<double>& radius) {
    ContactMatrix<Interval> result(W.rows(), W.cols());
    for (Eigen::Index i = 0; i < W.rows(); ++i)
        for (Eigen::Index k = 0; k < W.cols(); ++k) {
            const double r = radius(i, k);
            result(i, k) = r == 0.0 ? Interval(W(i, k)) : Interval(W(i, k)) + Interval(-r, r);
        }
    return result;
}

template <class Number>
std::optional<HeldBlock<Number>> HeldBlock<Number>::of(const ContactMatrix<Number>& W, ContactSet held,
                                                       double min_pivot) {
    HeldBlock block;
    block.held_ = held;
    block.factor_ = W;
    ContactMatrix<Number>& L = block.factor_;
    const Eigen::Index size = W.rows();
    for (Eigen::Index j = 0; j < size; ++j) {
        if (!contains(held, j)) continue;
        for (Eigen::Index i = j; i < size; ++i) {
            if (!contains(held, i)) continue;
            for (Eigen::Index k = 0; k < j; ++k)
                if (contains(held, k)) L(i, j) -= product(L(i, k), product(L(j, k), L(k, k)));
        }
        if (!is_clear(L(j, j), W(j, j), min_pivot)) return std::nullopt;
        for (Eigen::Index i = j + 1; i < size; ++i)
            if (contains(held, i) && !is_zero(L(i, j))) L(i, j) /= L(j, j);
    }
    return block;
}

template <class Number>
ContactVector<Number> HeldBlock<Number>::solve(const ContactVector<Number>& b) const {
    const Eigen::Index size = b.size();
    ContactVector<Number> x = zeros<Number>(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        if (!contains(held_, i)) continue;
        x[i] = b[i];
        for (Eigen::Index k = 0; k < i; ++k)
            if (contains(held_, k)) x[i] -= product(factor_(i, k), x[k]);
    }
    for (Eigen::Index i = size; i-- > 0;) {
        if (!contains(held_, i)) continue;
        if (!is_zero(x[i])) x[i] /= factor_(i, i);
        for (Eigen::Index k = i + 1; k < size; ++k)
            if (contains(held_, k)) x[i] -= product(factor_(k, i), x[k]);
    }
    return x;
}

template <class Number>
Number HeldBlock<Number>::between(const ContactMatrix<Number>& W, Eigen::Index i, Eigen::Index k,
                                  const ContactVector<Number>& kappa) {
    Number sum = W(i, k);
    for (Eigen::Index j = 0; j < kappa.size(); ++j) sum += product(W(i, j), kappa[j]);
    return sum;
}

template <class Number>
Transmission<Number> HeldBlock<Number>::transmission(const ContactMatrix<Number>& W, Eigen::Index i) const {
    ContactVector<Number> b(W.rows());
    for (Eigen::Index j = 0; j < b.size(); ++j) b[j] = -W(j, i);
    Transmission<Number> result{solve(b), Number(0.0)};
    result.W = between(W, i, i, result.kappa);
    return result;
}

template class HeldBlock<double>;
template class HeldBlock<Interval>;

}  // namespace achilles
