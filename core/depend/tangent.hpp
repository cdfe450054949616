// Where the components of a small change of a state stand (theory-derivatives.md 1): as a set's coordinates in core/enclose, the
// member's own time, q, v, of every contact the gap h and its rate u once more, and the parameters; besides, between the
// collision at which a bouncing was cut and its Zeno point, how long it still is to wait.
//
// t is a component, so that a change follows its events and is never reduced to a fixed time on the way. h and u are, so
// that after an impact h' is 0 exactly and u' keeps its relative accuracy, however small u is.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace achilles {

// Of changes, one a column: events act on rows.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Tangent {
    std::size_t dof = 0, contacts = 0, parameters = 0;

    static constexpr Eigen::Index t() { return 0; }
    Eigen::Index q(std::size_t i) const { return index(1 + i); }
    Eigen::Index v(std::size_t i) const { return index(1 + dof + i); }
    Eigen::Index wait() const { return index(1 + 2 * dof); }
    Eigen::Index h(std::size_t contact) const { return index(2 + 2 * dof + contact); }
    Eigen::Index u(std::size_t contact) const { return index(2 + 2 * dof + contacts + contact); }
    Eigen::Index p(std::size_t k) const { return index(2 + 2 * dof + 2 * contacts + k); }
    Eigen::Index size() const { return p(parameters); }

    // What programs depend on: q, v, then the parameters, then the time, each as the component that it is.
    std::size_t variables() const { return 2 * dof + parameters + 1; }
    Eigen::Index variable(std::size_t k) const {
        return k < 2 * dof ? q(k) : k < 2 * dof + parameters ? p(k - 2 * dof) : t();
    }

 private:
    static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
};

}  // namespace achilles
