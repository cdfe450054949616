#include "enclose/doubleton.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "number/dense.hpp"
#include "number/jet.hpp"

namespace achilles {

namespace {

using Matrix = Eigen::MatrixXd;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

// The first `rows` rows of a times b; if b has fewer rows than a has columns, the missing ones are 0.
IntervalMatrix product(const IntervalMatrix& a, const Matrix& b, std::size_t rows) {
    const auto n = static_cast<std::size_t>(b.rows()), columns = static_cast<std::size_t>(b.cols());
    IntervalMatrix result(rows, columns);
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t j = 0; j < columns; ++j) result(i, j) += times(a(i, k), Interval(b(index(k), index(j))));
    return result;
}

Matrix middle(const IntervalMatrix& a, std::size_t rows) {
    Matrix result(index(rows), index(a.columns()));
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t j = 0; j < a.columns(); ++j) result(index(i), index(j)) = mid(a(i, j));
    return result;
}

// An orthogonal basis from the columns, in order of decreasing length times radius, completed if columns are missing.
Matrix basis_along(const Matrix& columns, const Intervals& radii) {
    const auto n = static_cast<std::size_t>(columns.cols());
    std::vector<double> reach(n);
    for (std::size_t j = 0; j < n; ++j) reach[j] = columns.col(index(j)).norm() * rad(radii[j]);
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return reach[a] > reach[b]; });
    Matrix ordered(columns.rows(), columns.cols());
    for (std::size_t j = 0; j < n; ++j) ordered.col(index(j)) = columns.col(index(order[j]));
    return orthogonal_basis(ordered);
}

}  // namespace

IntervalMatrix IntervalMatrix::identity(std::size_t n) {
    IntervalMatrix result(n, n);
    for (std::size_t i = 0; i < n; ++i) result(i, i) = Interval(1.0);
    return result;
}

NearOrthogonalSolver::NearOrthogonalSolver(const Matrix& matrix) : matrix_(matrix) {
    Interval largest(0.0);
    for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
        Interval row(0.0);
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
            Interval entry(i == j ? -1.0 : 0.0);
            for (Eigen::Index k = 0; k < matrix.rows(); ++k)
                entry += times(Interval(matrix(k, i)), Interval(matrix(k, j)));
            row += abs(entry);
        }
        largest = max(largest, row);
    }
    const Interval eps(largest.hi());
    if (!(eps.hi() < 0.5)) throw ProofStopped{"the enclosure of the state became numerically singular"};
    delta_ = eps / (Interval(1.0) - eps);
}

Intervals NearOrthogonalSolver::solve(const Intervals& x) const {
    Intervals result(x.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t k = 0; k < x.size(); ++k) result[i] += times(Interval(matrix_(index(k), index(i))), x[k]);
        largest = std::max(largest, mag(result[i]));
    }
    const Interval off = times(delta_, Interval(-largest, largest));
    for (Interval& entry : result) entry += off;
    return result;
}

Doubleton::Doubleton(const Intervals& box, std::size_t constants)
    : moving_(box.size() - constants), center_(box.size()) {
    const std::size_t n = box.size();
    std::vector<std::size_t> wide;
    for (std::size_t i = 0; i < n; ++i) {
        center_[i] = mid(box[i]);
        if (box[i].lo() < box[i].hi()) wide.push_back(i);
    }
    start_ = Matrix::Zero(index(n), index(wide.size()));
    for (std::size_t j = 0; j < wide.size(); ++j) {
        start_(index(wide[j]), index(j)) = 1.0;
        of_start_.push_back(box[wide[j]] - Interval(center_[wide[j]]));
    }
    errors_ = Matrix::Identity(index(moving_), index(moving_));
    of_errors_.assign(moving_, Interval(0.0));
}

Interval Doubleton::hull(std::size_t i) const {
    Interval sum(center_[i]);
    for (std::size_t j = 0; j < of_start_.size(); ++j) sum += times(Interval(start_(index(i), index(j))), of_start_[j]);
    for (std::size_t j = 0; i < moving_ && j < moving_; ++j)
        sum += times(Interval(errors_(index(i), index(j))), of_errors_[j]);
    return sum;
}

Intervals Doubleton::hull() const {
    Intervals result;
    for (std::size_t i = 0; i < size(); ++i) result.push_back(hull(i));
    return result;
}

Interval Doubleton::along(const Interval* row) const {
    Interval sum(0.0);
    const auto add = [&](const Matrix& columns, const Intervals& box) {
        for (std::size_t j = 0; j < box.size(); ++j) {
            if (box[j].lo() == 0.0 && box[j].hi() == 0.0) continue;
            Interval factor(0.0);
            for (std::size_t i = 0; i < static_cast<std::size_t>(columns.rows()); ++i)
                factor += times(row[i], Interval(columns(index(i), index(j))));
            sum += times(factor, box[j]);
        }
    };
    add(start_, of_start_);
    add(errors_, of_errors_);
    return sum;
}

void Doubleton::map(const Intervals& at_center, const IntervalMatrix& slope) {
    const std::size_t n = moving_;
    for (std::size_t i = 0; i < n; ++i) {
        bool bounded = std::isfinite(width(at_center[i]));
        for (std::size_t j = 0; j < size(); ++j) bounded = bounded && std::isfinite(width(slope(i, j)));
        if (!bounded) throw ProofStopped{"a term of the equations may be undefined or unbounded on the set"};
    }
    const IntervalMatrix by_start = product(slope, start_, n), by_errors = product(slope, errors_, n);
    const Matrix start = middle(by_start, n);
    Intervals rest(n);  // neither in the center nor in C
    for (std::size_t i = 0; i < n; ++i) {
        center_[i] = mid(at_center[i]);
        rest[i] = at_center[i] - Interval(center_[i]);
        for (std::size_t j = 0; j < of_start_.size(); ++j)
            rest[i] += times(by_start(i, j) - Interval(start(index(i), index(j))), of_start_[j]);
    }
    const Matrix basis = basis_along(middle(by_errors, n), of_errors_);
    const NearOrthogonalSolver inverse(basis);
    Intervals errors = inverse.solve(rest);
    for (std::size_t j = 0; j < n; ++j) {
        if (of_errors_[j].lo() == 0.0 && of_errors_[j].hi() == 0.0) continue;
        Intervals column(n);
        for (std::size_t i = 0; i < n; ++i) column[i] = by_errors(i, j);
        column = inverse.solve(column);
        for (std::size_t i = 0; i < n; ++i) errors[i] += times(column[i], of_errors_[j]);
    }
    start_.topRows(index(n)) = start;
    errors_ = basis;
    of_errors_ = errors;
}

void Doubleton::set(std::size_t i, double value) {
    center_[i] = value;
    start_.row(index(i)).setZero();
    if (i < moving_) errors_.row(index(i)).setZero();
}

}  // namespace achilles
