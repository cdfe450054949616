#include "number/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace achilles {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

using Decomposition = Eigen::CompleteOrthogonalDecomposition<MatrixXd>;

}  // namespace

VectorXd least_solution(const MatrixXd& A, const VectorXd& b) { return Decomposition(A).solve(b); }

MatrixXd least_solution(const MatrixXd& A, const MatrixXd& B) {
    const Decomposition decomposition(A);
    MatrixXd result(A.cols(), B.cols());
    for (Eigen::Index k = 0; k < B.cols(); ++k) result.col(k) = decomposition.solve(VectorXd(B.col(k)));
    return result;
}

VectorXd solution(const MatrixXd& A, const VectorXd& b) { return A.partialPivLu().solve(b); }

PivotedSolution pivoted_solution(const MatrixXd& A, const VectorXd& b, double threshold) {
    Eigen::FullPivLU<MatrixXd> factors(A);
    factors.setThreshold(threshold);
    return {factors.solve(b), factors.isInvertible()};
}

MatrixXd orthogonal_basis(const MatrixXd& A) {
    return Eigen::HouseholderQR<MatrixXd>(A).householderQ() * MatrixXd::Identity(A.rows(), A.rows());
}

MatrixXd range_of(const MatrixXd& A, Eigen::Index dimensions) {
    MatrixXd basis = MatrixXd::Zero(A.rows(), dimensions);
    for (Eigen::Index k = 0; k < dimensions; ++k) basis(k, k) = 1.0;
    basis.applyOnTheLeft(Decomposition(A).householderQ());
    return basis;
}

std::vector<std::complex<double>> eigenvalues_of(const MatrixXd& A) {
    const Eigen::VectorXcd values = A.eigenvalues();
    return {values.begin(), values.end()};
}

}  // namespace achilles
