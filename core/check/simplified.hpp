// The derived equations as a person would write them, and the Zeno condition: hddot < 0 on the contact surface h = 0,
// hdot = 0 (paper, Thm. 2). What the machine evaluates is equations(); these are equal to it. For the files of this
// library only: see algebra/multinomial.hpp.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "algebra/algebra.hpp"
#include "model/model.hpp"

namespace achilles {

// hddot of a contact where it is kept, and what its sign depends on.
struct ZenoCondition {
    std::unique_ptr<Algebra> algebra;
    // Symbols that h = 0 and hdot = 0, of what is held, too, were solved for, one after the other.
    std::vector<std::pair<Expression, Expression>> solved;
    Fraction hddot;
    // hddot = positive * decisive. `positive` was proved to be: see `assumed`, and, where `definite`, M is positive
    // definite.
    Factored positive, decisive;
    std::vector<Expression> assumed;  // of parameters alone, positive over the parameters' ranges,
    bool vanishing = false;           // or some not negative: where they are not 0, as is assumed of a divisor
    bool definite = false;
    enum class Verdict { depends, always, never } verdict = Verdict::depends;
};

// A contact while none is held. Nothing stands where simplifying took too long.
struct SimplifiedContact {
    std::vector<std::optional<Fraction>> dh;
    std::optional<Fraction> hdot, W, hddot, lambda;
    std::optional<ZenoCondition> zeno;
};

// The same of a contact while others are held: hddot is that of their motion (theory-gaps.md 2), on their surfaces.
struct HeldCondition {
    std::size_t contact = 0;
    Mode mode;
    std::optional<ZenoCondition> zeno;
};

// Nothing stands where simplifying took too long.
class Simplified {
 public:
    // Once it is told to stop, nothing more is simplified: who told it does not want the result.
    Simplified(const Model& model, const Run& run, std::stop_token stop = {});
    Simplified(const Simplified&) = delete;

    std::vector<std::optional<Fraction>> M, bias, Q;  // as Equations has them
    std::vector<SimplifiedContact> contacts;
    // Of each contact while one other is held, where there are few contacts.
    std::vector<HeldCondition> while_held;
    static constexpr std::size_t few_contacts = 4;

    // The equations of such a contact, in a graph of their own.
    const ContactEquations& held_equations(const HeldCondition& condition) const {
        return motions_->of(condition.mode).contacts[condition.contact];
    }

    Algebra& algebra() const { return *algebra_; }
    // The order in which names stand in a product: parameters, coordinates, rates (Writer).
    const std::vector<int>& ranks() const { return ranks_; }

 private:
    std::optional<Fraction> simplify(Expression expression);
    SimplifiedContact simplify(const Model& model, const Run& run, std::size_t contact);
    std::optional<ZenoCondition> condition(const Model& model, const Run& run,
                                           const std::vector<const ContactEquations*>& involved);

    std::unique_ptr<ContactModes> motions_;  // those of while_held, derived before their graph is copied
    Graph graph_;
    std::unique_ptr<Algebra> algebra_;
    std::vector<int> ranks_;
    std::stop_token stop_;
};

// hddot of the first of these contacts after h = 0 and hdot = 0, of all of them, were solved for a coordinate and a rate,
// where they can be and it makes hddot shorter: the others are held. Nothing where it takes too long. Nodes are made in
// `graph`, a copy of the model's.
std::optional<ZenoCondition> zeno_condition(const Model& model, const Run& run,
                                            const std::vector<const ContactEquations*>& contacts, Graph& graph);

// A product of factors as one expression, factor by factor.
Expression expression_of(const Factored& product, Algebra& algebra);

}  // namespace achilles
