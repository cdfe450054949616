// Wrappers of Eigen's decompositions, compiled once because each takes long to compile.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace achilles {

// Minimum-norm least-squares solution x of A x = b, for every column of B. Uses a complete orthogonal decomposition.
Eigen::VectorXd least_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd least_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
// Solution x of A x = b for a square, invertible A.
Eigen::VectorXd solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
// Orthonormal basis, A.rows() x dimensions, of the span of the leading pivot columns of A. `dimensions` is the
// numerical rank to be used.
Eigen::MatrixXd range_of(const Eigen::MatrixXd& A, Eigen::Index dimensions);
// Eigenvalues of a square matrix, in no particular order.
std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& A);

}  // namespace achilles
