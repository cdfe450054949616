// A set of states as Lohner's doubleton { c + C r0 + B r } (theory-enclosure.md 1). c, C and B are doubles. r0 is the
// initial box minus its center and never changes; r contains the accumulated errors.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "expression/scalar.hpp"
#include "number/interval.hpp"

namespace achilles {

using Intervals = std::vector<Interval>;

class IntervalMatrix {
 public:
    IntervalMatrix(std::size_t rows, std::size_t columns) : columns_(columns), entries_(rows * columns) {}
    static IntervalMatrix identity(std::size_t n);
    std::size_t columns() const { return columns_; }
    Interval& operator()(std::size_t i, std::size_t j) { return entries_[i * columns_ + j]; }
    const Interval& operator()(std::size_t i, std::size_t j) const { return entries_[i * columns_ + j]; }
    const Interval* row(std::size_t i) const { return entries_.data() + i * columns_; }

 private:
    std::size_t columns_;
    Intervals entries_;
};

// Ends a proof: nothing is claimed beyond this point.
struct ProofStopped {
    std::string reason;
};

class Doubleton {
 public:
    // Every map leaves the last `constants` coordinates unchanged; they never acquire errors.
    explicit Doubleton(const Intervals& box, std::size_t constants = 0);

    std::size_t size() const { return center_.size(); }
    // A point of the hull, the center of mean-value forms.
    double center(std::size_t i) const { return center_[i]; }
    Intervals center() const { return {center_.begin(), center_.end()}; }
    Interval hull(std::size_t i) const;
    Intervals hull() const;
    // sum_j row_j (z_j - c_j) over all members z.
    Interval along(const Interval* row) const;

    // The image of the set under a map with F(z) in at_center + slope (z - c). at_center must contain F(c), and slope
    // the derivatives over the hull; both may include an error of F. Throws ProofStopped if an entry is undefined or
    // unbounded.
    void map(const Intervals& at_center, const IntervalMatrix& slope);
    // Sets coordinate i to exactly this value in every member.
    void set(std::size_t i, double value);

 private:
    std::size_t moving_;  // number of coordinates that are not constant
    std::vector<double> center_;
    Eigen::MatrixXd start_, errors_;  // C; B, for the coordinates that are not constant
    Intervals of_start_, of_errors_;  // r0, r: both contain 0
};

// B^-1 x over a box x for a nearly orthogonal B: it lies in B'x + delta |B'x| [-1, 1], with delta = eps/(1 - eps),
// eps >= |B'B - 1|.
class NearOrthogonalSolver {
 public:
    // Throws ProofStopped if eps is not below 1/2.
    explicit NearOrthogonalSolver(const Eigen::MatrixXd& matrix);
    Intervals solve(const Intervals& x) const;

 private:
    Eigen::MatrixXd matrix_;
    Interval delta_;
};

// Whether a number has derivatives in at least one direction; Jet<Number, 0> has none.
template <class Number>
inline constexpr bool has_directions = [] {
    if constexpr (HasDerivatives<Number>)
        return std::tuple_size_v<decltype(Number::slope)> > 0;
    else
        return false;
}();

// Layout of the coordinates of a set of states (theory-enclosure.md 1): the time of the member, q, v, the gap h and gap
// rate u of every contact as independent coordinates, and the interval parameters.
struct Coordinates {
    std::size_t dof = 0;
    bool autonomous = true;
    Intervals parameters;             // of the whole system; those that are not coordinates are enclosed as intervals
    std::vector<std::size_t> varied;  // indices of the parameters that are coordinates
    std::size_t contacts = 1;

    static constexpr std::size_t t() { return 0; }
    std::size_t q(std::size_t i) const { return 1 + i; }
    std::size_t v(std::size_t i) const { return 1 + dof + i; }
    std::size_t h(std::size_t contact = 0) const { return 1 + 2 * dof + 2 * contact; }
    std::size_t u(std::size_t contact = 0) const { return 2 + 2 * dof + 2 * contact; }
    std::size_t parameter(std::size_t k) const { return 1 + 2 * dof + 2 * contacts + k; }
    std::size_t size() const { return parameter(varied.size()); }

    // Indices of the coordinates on which the accelerations depend.
    std::vector<std::size_t> of_motion() const {
        std::vector<std::size_t> result;
        for (std::size_t i = 0; i < 2 * dof; ++i) result.push_back(q(i));
        if (!autonomous) result.push_back(t());
        for (std::size_t k = 0; k < varied.size(); ++k) result.push_back(parameter(k));
        return result;
    }
    // Indices of the coordinates on which the maps at events depend: those of the accelerations, h and u.
    std::vector<std::size_t> of_maps() const {
        std::vector<std::size_t> result = of_motion();
        for (std::size_t i = 0; i < contacts; ++i) result.insert(result.end(), {h(i), u(i)});
        return result;
    }
    // The coordinates of a box as numbers with derivatives by these variables; parameter_numbers() does the same for
    // all parameters.
    template <class Number>
    std::vector<Number> numbers(const Intervals& box, const std::vector<std::size_t>& variables) const {
        std::vector<Number> result;
        for (const Interval& entry : box) result.emplace_back(entry);
        mark(result, variables);
        return result;
    }
    template <class Number>
    std::vector<Number> parameter_numbers(const std::vector<Number>& state) const {
        std::vector<Number> result;
        for (const Interval& value : parameters) result.emplace_back(value);
        for (std::size_t k = 0; k < varied.size(); ++k) result[varied[k]] = state[parameter(k)];
        return result;
    }

 private:
    template <class Number>
    static void mark(std::vector<Number>& state, const std::vector<std::size_t>& variables) {
        if constexpr (has_directions<Number>)
            for (std::size_t j = 0; j < variables.size(); ++j)
                state[variables[j]] = Number::variable(state[variables[j]].value, j);
    }
};

// Calls maker.template operator()<N>() for the smallest supported N >= count. Throws ProofStopped if there are too many
// directions.
template <class Maker>
auto with_directions(std::size_t count, const Maker& maker) {
    if (count <= 4) return maker.template operator()<4>();
    if (count <= 6) return maker.template operator()<6>();
    if (count <= 8) return maker.template operator()<8>();
    if (count <= 12) return maker.template operator()<12>();
    if (count <= 18) return maker.template operator()<18>();
    if (count <= 34) return maker.template operator()<34>();
    throw ProofStopped{"too many coordinates and interval parameters for a proof (maximum 34)"};
}

}  // namespace achilles
