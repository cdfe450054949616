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
// Solution of A x = b for a square A by elimination with full pivots. With pivots below `threshold` times the largest it
// is one of several, or none.
struct PivotedSolution {
    Eigen::VectorXd x;
    bool is_unique = false;
};
PivotedSolution pivoted_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold);
// Orthogonal matrix whose leading columns span those of A, in order.
Eigen::MatrixXd orthogonal_basis(const Eigen::MatrixXd& A);
// Eigenvalues of a square matrix, in no particular order.
std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& A);

}  // namespace achilles
