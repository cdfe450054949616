// A set of states as Lohner's doubleton { c + C r0 + B r }: c, C and B are doubles, r0 is the box that the run starts from
// less its middle, which never changes, r what errors have added (theory-enclosure.md 1).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

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

// What ends a proof: nothing is claimed from there on.
struct Undecided {
    std::string reason;
};

class Doubleton {
 public:
    // The last `constants` coordinates are the same before and after every map, and never gain errors.
    explicit Doubleton(const Intervals& box, std::size_t constants = 0);

    std::size_t size() const { return centre_.size(); }
    // A member of the hull: what a mean-value form starts from.
    double centre(std::size_t i) const { return centre_[i]; }
    Intervals centre() const { return {centre_.begin(), centre_.end()}; }
    Interval hull(std::size_t i) const;
    Intervals hull() const;
    // sum_j row_j (z_j - c_j) over all members z.
    Interval along(const Interval* row) const;

    // The image under a map with F(z) in at_centre + slope (z - c): at_centre contains F(c), slope contains the derivatives over
    // the hull, and what both add may hold what an error adds to F. Throws Undecided where something is not defined.
    void map(const Intervals& at_centre, const IntervalMatrix& slope);
    // Coordinate i is exactly this in every member.
    void set(std::size_t i, double value);

 private:
    std::size_t moving_;  // coordinates that are no constants
    std::vector<double> centre_;
    Eigen::MatrixXd start_, errors_;  // C; B, of the moving ones
    Intervals of_start_, of_errors_;  // r0, r: 0 lies in both
};

// B^-1 x over a box x, for a nearly orthogonal B: within B'x + delta |B'x| [-1, 1], delta = eps/(1 - eps), eps >= |B'B - 1|.
class NearlyOrthogonal {
 public:
    // Throws Undecided where eps is not below 1/2.
    explicit NearlyOrthogonal(const Eigen::MatrixXd& matrix);
    Intervals solve(const Intervals& x) const;

 private:
    Eigen::MatrixXd matrix_;
    Interval delta_;
};

}  // namespace achilles
