#include "contacts/complementarity.hpp"

#include <cmath>

namespace achilles {

namespace {

using Matrix = ContactMatrix<double>;
using Vector = ContactVector<double>;
using Eigen::Index;

constexpr double tolerance = 5e-13;

// The power of two nearest to 1/sqrt(w). Scaling by it is exact.
double scale_for(double w) { return w > 0.0 ? std::exp2(-std::round(0.5 * std::log2(w))) : 1.0; }

// The problem scaled such that W_jj is about 1: impulses p = scale p', y = y'/scale.
class Problem {
 public:
    Problem(const Matrix& W, const Vector& b) : scale_(b.size()), W_(W), b_(b) {
        for (Index j = 0; j < size(); ++j) scale_[j] = scale_for(W(j, j));
        for (Index i = 0; i < size(); ++i) {
            b_[i] *= scale_[i];
            for (Index k = 0; k < size(); ++k) {
                W_(i, k) *= scale_[i] * scale_[k];
                const double natural = std::sqrt(std::abs(W(i, i) * W(k, k))) * scale_[i] * scale_[k];
                if (std::abs(W_(i, k)) <= rounded_zero * natural) W_(i, k) = 0.0;
            }
        }
    }

    // A solution on a set of contacts over which W is positive definite. One exists if there is any solution.
    std::optional<Vector> basic() const {
        for (const double min_pivot : {HeldBlock<double>::clear, 0x1p-46}) {
            if (const auto p = pivoted(min_pivot)) return p;
            if (const auto p = enumerated(min_pivot)) return p;
        }
        return std::nullopt;
    }

    Complementarity finished(const Vector& basic_p) const {
        Complementarity result;
        const ContactSet zero = zeros_of(basic_p);
        result.unique = HeldBlock<double>::of(W_, zero).has_value();
        Vector p = basic_p;
        if (!result.unique)
            if (const auto least = least_norm(zero)) p = *least;
        result.y = residual(p);
        for (Index j = 0; j < size(); ++j) {
            if (contains(zero, j)) result.y[j] = 0.0;
            result.y[j] /= scale_[j];
            if (p[j] > 0.0) result.active = with(result.active, j);
        }
        result.p = p.cwiseProduct(scale_);
        return result;
    }

 private:
    Index size() const { return b_.size(); }
    Vector residual(const Vector& p) const { return b_ + W_ * p; }
    Vector bounds(const Vector& p) const { return tolerance * (b_.cwiseAbs() + W_.cwiseAbs() * p.cwiseAbs()); }

    ContactSet zeros_of(const Vector& p) const {
        const Vector y = residual(p), bound = bounds(p);
        ContactSet zero;
        for (Index j = 0; j < size(); ++j)
            if (std::abs(y[j]) <= bound[j]) zero = with(zero, j);
        return zero;
    }

    // Whether p >= 0, y >= 0 and p y = 0 hold within the bounds. False for a NaN.
    bool solves(const Vector& p) const {
        const Vector y = residual(p), bound = bounds(p);
        for (Index j = 0; j < size(); ++j) {
            const bool holds = p[j] > 0.0 ? std::abs(y[j]) <= bound[j] : p[j] == 0.0 && y[j] >= -bound[j];
            if (!holds) return false;
        }
        return true;
    }

    // p with y = 0 over a set, of any sign; after one step of iterative refinement.
    std::optional<Vector> on(ContactSet set, double min_pivot) const {
        const auto block = HeldBlock<double>::of(W_, set, min_pivot);
        if (!block) return std::nullopt;
        Vector p = block->solve(-b_);
        p -= block->solve(residual(p));
        return p;
    }

    // Block pivoting: every contact of the wrong sign changes sides, up to 8 times. This finds nearly all solutions.
    std::optional<Vector> pivoted(double min_pivot) const {
        constexpr int rounds = 8;
        ContactSet set;
        for (Index j = 0; j < size(); ++j)
            if (b_[j] < 0.0) set = with(set, j);
        for (int round = 0; round < rounds; ++round) {
            const auto p = on(set, min_pivot);
            if (!p) return std::nullopt;
            if (const Vector positive = p->cwiseMax(0.0); solves(positive)) return positive;
            const Vector y = residual(*p), bound = bounds(*p);
            for (Index j = 0; j < size(); ++j) {
                if (contains(set, j) && (*p)[j] < 0.0) {
                    set = without(set, j);
                } else if (!contains(set, j) && y[j] < -bound[j]) {
                    set = with(set, j);
                }
            }
        }
        return std::nullopt;
    }

    std::optional<Vector> enumerated(double min_pivot) const {
        const unsigned count = 1u << size();
        for (unsigned bits = 0; bits < count; ++bits) {
            const auto p = on(set_of(bits), min_pivot);
            if (!p) continue;
            if (const Vector positive = p->cwiseMax(0.0); solves(positive)) return positive;
        }
        return std::nullopt;
    }

    ContactSet set_of(unsigned bits) const {
        ContactSet set;
        for (Index j = 0; j < size(); ++j)
            if ((bits >> j & 1u) != 0) set = with(set, j);
        return set;
    }

    // The solution with the smallest sum W_jj p_j^2. Over its own support it is also the smallest solution of W p = -b
    // of any sign. Active-set iteration: drop contacts with a negative impulse, add those that would lower the sum, up
    // to 8 rounds. It nearly always succeeds; otherwise all sets are enumerated.
    std::optional<Vector> least_norm(ContactSet zero) const {
        constexpr int rounds = 8;
        for (Index j = 0; j < size(); ++j)
            if (!(W_(j, j) > 0.0)) zero = without(zero, j);
        ContactSet support = zero;
        for (int round = 0; round < rounds; ++round) {
            const auto p = least_of_any_sign(support);
            if (!p) break;
            const ContactSet better = improved(support, *p, zero);
            if (better == support) {
                if (const Vector positive = p->cwiseMax(0.0); solves(positive)) return positive;
                break;
            }
            support = better;
        }
        return least_of_all(zero);
    }

    // p is optimal if p >= 0, W_jj p_j = (W nu)_j on the support for some nu, and (W nu)_j <= 0 on the other contacts.
    ContactSet improved(ContactSet support, const Vector& p, ContactSet zero) const {
        const Vector weighted = W_.diagonal().cwiseProduct(p);
        const Vector pull = W_ * HeldBlock<double>::of(W_, basis_of(support))->solve(weighted);
        const double least = tolerance * weighted.cwiseAbs().maxCoeff();
        ContactSet better = support;
        for (Index j = 0; j < size(); ++j) {
            if (contains(support, j) && weighted[j] < -least) better = without(better, j);
            if (contains(zero, j) && !contains(support, j) && pull[j] > least) better = with(better, j);
        }
        return better;
    }

    std::optional<Vector> least_of_all(ContactSet zero) const {
        std::optional<Vector> least;
        double norm = HUGE_VAL;
        for (unsigned bits = 0; bits < 1u << size(); ++bits) {
            const ContactSet set = set_of(bits);
            if (!is_within(set, zero)) continue;
            const auto p = least_of_any_sign(set);
            if (!p || p->minCoeff() < -tolerance * p->maxCoeff()) continue;
            const Vector positive = p->cwiseMax(0.0);
            if (!(weighted_norm(positive) < norm) || !solves(positive)) continue;
            least = positive;
            norm = weighted_norm(positive);
        }
        return least;
    }

    bool is_within(ContactSet set, ContactSet other) const {
        for (Index j = 0; j < size(); ++j)
            if (contains(set, j) && !contains(other, j)) return false;
        return true;
    }

    double weighted_norm(const Vector& p) const { return W_.diagonal().dot(p.cwiseAbs2()); }

    // A largest subset over which W is clearly positive definite. The largest pivot is taken first, which keeps
    // rounding errors small in the kernel below.
    ContactSet basis_of(ContactSet set) const {
        ContactSet basis;
        for (;;) {
            const auto block = HeldBlock<double>::of(W_, basis);
            double most = HeldBlock<double>::clear;
            Index next = -1;
            for (Index j = 0; j < size(); ++j) {
                if (!contains(set, j) || contains(basis, j)) continue;
                const double pivot = block->transmission(W_, j).W / W_(j, j);
                if (!(pivot > most)) continue;
                most = pivot;
                next = j;
            }
            const ContactSet larger = next < 0 ? basis : with(basis, next);
            if (next < 0 || !HeldBlock<double>::of(W_, larger)) return basis;
            basis = larger;
        }
    }

    // The p of least norm that is 0 outside of `set` and solves b + W p = 0 over it; nullopt if there is none. It
    // starts from the solution on a basis B, a largest subset over which W is clearly positive definite. It then moves
    // along the kernel, which the remaining contacts k of `set` span by
    //     x_B = -W_BB^-1 W_Bk, x_k = 1.
    std::optional<Vector> least_of_any_sign(ContactSet set) const {
        const ContactSet basis = basis_of(set);
        const auto block = HeldBlock<double>::of(W_, basis);
        Vector p = block->solve(-b_);
        Matrix kernel = Matrix::Zero(size(), size());  // column k for every remaining k
        ContactSet rest;
        for (Index k = 0; k < size(); ++k) {
            if (!contains(set, k) || contains(basis, k)) continue;
            rest = with(rest, k);
            kernel.col(k) = block->transmission(W_, k).kappa;
            kernel(k, k) = 1.0;
        }
        const Matrix weighted = W_.diagonal().asDiagonal() * kernel;
        const auto normal = HeldBlock<double>::of(kernel.transpose() * weighted, rest, 0x1p-46);
        if (!normal) return std::nullopt;
        p -= kernel * normal->solve(weighted.transpose() * p);
        p -= kernel * normal->solve(weighted.transpose() * p);
        return p;
    }

    Vector scale_;
    Matrix W_;
    Vector b_;
};

}  // namespace

std::optional<Complementarity> solve_complementarity(const Matrix& W, const Vector& b) {
    const Problem problem(W, b);
    const auto p = problem.basic();
    if (!p) return std::nullopt;
    return problem.finished(*p);
}

}  // namespace achilles
