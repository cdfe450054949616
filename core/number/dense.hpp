// Eigen's decompositions, compiled once: each takes longer to compile than any file that asks for one.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace achilles {

// The shortest x of those with the least |A x - b|, by a QR decomposition with pivots; for every column of B.
Eigen::VectorXd least_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd least_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
// x of A x = b, of a square A that has an inverse.
Eigen::VectorXd solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
// An orthonormal basis of the range of A, of so many of its dimensions: those of the largest columns.
Eigen::MatrixXd range_of(const Eigen::MatrixXd& A, Eigen::Index dimensions);
// Of a square matrix, in no order.
std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& A);

}  // namespace achilles
