// The derived equations in simplified form, and the Zeno condition: hddot < 0 on the contact surface h = 0, hdot = 0
// (paper, Thm. 2). Runs evaluate equations(), to which these are equal. For the files of this library only: see
// algebra/multinomial.hpp.
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

// hddot of a contact on its surface, and the factors that determine its sign.
struct ZenoCondition {
    std::unique_ptr<Algebra> algebra;
    // Solutions of h = 0 and hdot = 0, including those of held contacts: symbols and values, in the order of
    // substitution.
    std::vector<std::pair<Expression, Expression>> solved;
    Fraction hddot;
    // hddot = positive * decisive. The factor `positive` is proved to be positive under the assumptions `assumed` and,
    // if `definite`, where M is positive definite.
    FactoredForm positive, decisive;
    std::vector<Expression> assumed;  // depend on parameters only; positive over their ranges,
    bool vanishing = false;           // or, if true, some only nonnegative: valid where they are not 0
    bool definite = false;
    enum class Verdict { depends, always, never } verdict = Verdict::depends;
};

// A contact while none is held. Members are empty if simplification takes too much work.
struct SimplifiedContact {
    std::vector<std::optional<Fraction>> dh;
    std::optional<Fraction> hdot, W, hddot, lambda;
    std::optional<ZenoCondition> zeno;
};

// The same for a contact while another is held: hddot is that of the motion in `mode` (theory-gaps.md 2), on both
// surfaces.
struct HeldCondition {
    std::size_t contact = 0;
    Mode mode;
    std::optional<ZenoCondition> zeno;
};

// The simplified equations of a model. Members are empty if simplification takes too much work.
class SimplifiedEquations {
 public:
    // After a stop request nothing more is simplified, and the result is incomplete.
    SimplifiedEquations(const Model& model, const Run& run, std::stop_token stop = {});
    SimplifiedEquations(const SimplifiedEquations&) = delete;

    std::vector<std::optional<Fraction>> M, bias, Q;  // as in Equations
    std::vector<SimplifiedContact> contacts;
    // For each contact while one other is held, if there are few contacts.
    std::vector<HeldCondition> while_held;
    static constexpr std::size_t few_contacts = 4;

    // The equations of the contact in this condition's mode, which have their own graph.
    const ContactEquations& held_equations(const HeldCondition& condition) const {
        return motions_->of(condition.mode).contacts[condition.contact];
    }

    Algebra& algebra() const { return *algebra_; }
    // The order of names in a product: parameters, coordinates, rates (AlgebraWriter).
    const std::vector<int>& ranks() const { return ranks_; }

 private:
    std::optional<Fraction> simplify(Expression expression);
    SimplifiedContact simplify(const Model& model, const Run& run, std::size_t contact);
    std::optional<ZenoCondition> condition(const Model& model, const Run& run,
                                           const std::vector<const ContactEquations*>& involved);

    std::unique_ptr<ContactModes> motions_;  // motions of while_held, derived before their graph is copied
    Graph graph_;
    std::unique_ptr<Algebra> algebra_;
    std::vector<int> ranks_;
    std::stop_token stop_;
};

// The Zeno condition of the first of these contacts; the others are held. Solves h = 0 and hdot = 0 of all of them for
// coordinates and rates, if that is possible and makes hddot shorter. nullopt if that takes too much work. Creates
// nodes in `graph`, a copy of the model's.
std::optional<ZenoCondition> zeno_condition(const Model& model, const Run& run,
                                            const std::vector<const ContactEquations*>& contacts, Graph& graph);

// The product of all factors as one expression.
Expression expression_of(const FactoredForm& product, Algebra& algebra);

}  // namespace achilles
