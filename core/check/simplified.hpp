// The derived equations as a person would write them, and the Zeno condition: hddot < 0 on the contact surface h = 0,
// hdot = 0 (paper, Thm. 2). What the machine evaluates is equations(); these are equal to it. For the files of this
// library only: see algebra/multinomial.hpp.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algebra/factored.hpp"
#include "model/model.hpp"

namespace achilles {

// hddot where the contact is kept, and what its sign depends on.
struct ZenoCondition {
    std::unique_ptr<Algebra> algebra;
    std::vector<std::pair<Expression, Expression>> solved;  // symbols that h = 0 and hdot = 0 were solved for
    Fraction hddot;
    // hddot = positive * decisive. `positive` was proved to be: see `assumed`, and, where `definite`, M is positive
    // definite.
    Factored positive, decisive;
    std::vector<Expression> assumed;  // of parameters alone, positive over the parameters' ranges
    bool definite = false;
    enum class Verdict { depends, always, never } verdict = Verdict::depends;
};

// Nothing stands where simplifying took too long.
class Simplified {
 public:
    Simplified(const Model& model, const Run& run);
    Simplified(const Simplified&) = delete;

    std::vector<std::optional<Fraction>> M, bias, dh;  // as Equations has them
    std::optional<Fraction> hdot, W, hddot, lambda;
    std::optional<ZenoCondition> zeno;

    Algebra& algebra() const { return *algebra_; }
    // The order in which names stand in a product: parameters, coordinates, rates (Writer).
    const std::vector<int>& ranks() const { return ranks_; }

 private:
    std::optional<Fraction> simplify(Expression expression);

    Graph graph_;
    std::unique_ptr<Algebra> algebra_;
    std::vector<int> ranks_;
};

}  // namespace achilles
