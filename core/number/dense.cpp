#include "number/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace achilles {

using Eigen::MatrixXd, Eigen::VectorXd;

VectorXd least_solution(const MatrixXd& A, const VectorXd& b) {
    return Eigen::CompleteOrthogonalDecomposition<MatrixXd>(A).solve(b);
}
MatrixXd least_solution(const MatrixXd& A, const MatrixXd& B) {
    return Eigen::CompleteOrthogonalDecomposition<MatrixXd>(A).solve(B);
}

VectorXd solution(const MatrixXd& A, const VectorXd& b) { return A.partialPivLu().solve(b); }

MatrixXd range_of(const MatrixXd& A, Eigen::Index dimensions) {
    return A.jacobiSvd(Eigen::ComputeFullU).matrixU().leftCols(dimensions);
}

std::vector<std::complex<double>> eigenvalues_of(const MatrixXd& A) {
    const Eigen::VectorXcd values = A.eigenvalues();
    return {values.begin(), values.end()};
}

}  // namespace achilles
