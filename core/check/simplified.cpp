#include "check/simplified.hpp"

#include <algorithm>
#include <stdexcept>

#include "number/float_environment.hpp"

namespace achilles {

namespace {

constexpr long work_of_a_try = 1000000;

using Solution = std::vector<std::pair<std::uint32_t, Expression>>;  // slot, value

// The sign of an expression in parameters only, over their ranges and the values of the run.
class ParameterSigns {
 public:
    ParameterSigns(const Model& model, const Run& run) : model_(model), run_(run) {
        const Layout& layout = model.layout();
        for (std::uint32_t slot = 0; slot < layout.count(); ++slot)
            (slot < 2 * layout.dof || slot >= 2 * layout.dof + layout.p ? others_ : parameters_).push_back(slot);
    }

    // True if the expression depends on parameters and its sign is known.
    bool of_parameters(Expression e) const { return depends_on(e, parameters_) && (*this)(e) != Sign::unknown; }

    Sign operator()(Expression e) const {
        if (depends_on(e, others_)) return Sign::unknown;
        const Program program(std::span(&e, 1), model_.layout().slots());
        Evaluator<Interval> value(program);
        for (std::size_t i = 0; i < run_.parameters.size(); ++i) {
            const auto& range = model_.description().parameters[i].range;
            const double now = run_.parameters[i];
            value.input(model_.layout().parameter(i)) = Interval(std::min(now, range[0]), std::max(now, range[1]));
        }
        value.fix();
        value.run();
        const Interval enclosure = value.output(0);
        if (!enclosure.is_defined()) return Sign::unknown;
        return enclosure.lo() > 0.0 ? Sign::positive : enclosure.lo() >= 0.0 ? Sign::not_negative : Sign::unknown;
    }

 private:
    const Model& model_;
    const Run& run_;
    std::vector<std::uint32_t> parameters_, others_;
};

class SimplificationSearch {
 public:
    SimplificationSearch(const Model& model, const Run& run, const std::vector<const ContactEquations*>& contacts,
                         Graph& graph)
        : layout_(model.layout()),
          e_(model.equations()),
          contacts_(contacts),
          c_(*contacts.front()),
          graph_(graph),
          signs_(model, run) {}

    // Tries all solutions, with and without the angle addition formulas, and keeps the shortest hddot.
    std::optional<ZenoCondition> best() try {
        for (const Solution& coordinate : coordinates(on_held_surfaces()))
            for (const Solution& solution : with_rates(coordinate))
                for (const bool expand_angles : {false, true}) try_solution(solution, expand_angles);
        if (best_) decide(*best_);
        return std::move(best_);
    } catch (const ExpressionTooLarge&) {
        return std::nullopt;
    }

 private:
    Expression on(Expression e, const Solution& solution) const {
        Expression result = graph_.adopt(e);
        for (const auto& [slot, value] : solution)
            result = substitute(result, std::span(&slot, 1), std::span(&value, 1));
        return result;
    }

    // x = -f(0)/f'(0), if f is linear in x with a derivative that is nowhere 0.
    std::optional<Expression> solve(Expression f, std::uint32_t slot) const {
        const Expression zero = graph_.number(0), slope = derivative(f, slot);
        try {
            Algebra algebra(graph_, Work{work_of_a_try / 100});
            const Fraction steepness = algebra.simplify(slope);
            if (steepness.is_zero() || !algebra.simplify(derivative(slope, slot)).is_zero()) return std::nullopt;
            if (!has_sign(algebra, steepness)) return std::nullopt;
            const Expression rest = substitute(f, std::span(&slot, 1), std::span(&zero, 1));
            return algebra.expression(algebra.divide(algebra.simplify(-rest), steepness));
        } catch (const std::domain_error&) {  // f is not defined at x = 0
        } catch (const SimplificationLimit&) {
        }
        return std::nullopt;
    }

    bool has_sign(const Algebra& algebra, const Fraction& fraction) const {
        Positivity positivity(algebra, signs_);
        return (positivity.is_positive(fraction.numerator) || positivity.is_positive(-fraction.numerator)) &&
               (positivity.is_positive(fraction.denominator, true) ||
                positivity.is_positive(-fraction.denominator, true));
    }

    // Solutions of h = 0 and hdot = 0 of the held contacts, each for the first possible symbol.
    Solution on_held_surfaces() const {
        Solution solution;
        const auto use = [&](Expression zero, std::uint32_t first_slot) {
            for (std::uint32_t slot = first_slot; slot < first_slot + layout_.dof; ++slot)
                if (const auto value = solve(zero, slot)) return solution.emplace_back(slot, *value), void();
        };
        for (std::size_t i = 1; i < contacts_.size(); ++i) use(on(contacts_[i]->gap, solution), layout_.q(0));
        for (std::size_t i = 1; i < contacts_.size(); ++i) use(on(contacts_[i]->hdot, solution), layout_.v(0));
        return solution;
    }

    // These solutions extended by each solution of h = 0; the first result has no extension.
    std::vector<Solution> coordinates(const Solution& held) const {
        std::vector<Solution> result{held};
        const Expression gap = on(c_.gap, held), hddot = on(c_.hddot, held);
        std::vector<std::uint32_t> all;
        for (std::size_t i = 0; i < layout_.dof; ++i) all.push_back(layout_.q(i));
        for (const std::uint32_t slot : all) {
            const auto value = solve(gap, slot);
            if (!value) continue;
            Solution solution = held;
            solution.emplace_back(slot, *value);
            if (!depends_on(*value, all)) return {solution};  // a constant, which cannot be improved
            if (depends_on(hddot, std::span(&slot, 1))) result.push_back(solution);
        }
        return result;
    }

    // This solution, and its extensions by each solution of hdot = 0.
    std::vector<Solution> with_rates(const Solution& coordinate) const {
        std::vector<Solution> result{coordinate};
        const Expression hdot = on(c_.hdot, coordinate), hddot = on(c_.hddot, coordinate);
        for (std::size_t i = 0; i < layout_.dof; ++i) {
            const std::uint32_t slot = layout_.v(i);
            const auto value = solve(hdot, slot);
            if (!value) continue;
            Solution solution = coordinate;
            solution.emplace_back(slot, *value);
            if (value->is_zero()) return {solution};
            if (depends_on(hddot, std::span(&slot, 1))) result.push_back(solution);
        }
        return result;
    }

    static std::size_t length(const Fraction& fraction) {
        return fraction.numerator.terms().size() + fraction.denominator.terms().size();
    }

    // Uses the constraints that could not be solved: adds multiples of h, hdot and hdot^2 to the numerator as long as
    // that makes the result shorter.
    Fraction in_contact(Fraction hddot, const Solution& solution, Algebra& algebra) const {
        std::vector<Multinomial> zeros;
        for (const ContactEquations* contact : contacts_) {
            const Multinomial hdot = algebra.simplify(on(contact->hdot, solution)).numerator;
            zeros.push_back(algebra.simplify(on(contact->gap, solution)).numerator);
            zeros.push_back(hdot);
            zeros.push_back(algebra.reduced(power(hdot, 2, algebra.work())));
        }
        for (bool shorter = true; shorter;) {
            shorter = false;
            for (const Multinomial& zero : zeros) {
                const Fraction now = hddot;
                for (const Multinomial::Term& of_zero : zero.terms()) {
                    for (const Multinomial::Term& term : now.numerator.terms()) {
                        const auto multiple = divide(Multinomial({term}), Multinomial({of_zero}), algebra.work());
                        if (!multiple) continue;
                        const Multinomial subtracted = times(zero, *multiple, algebra.work());
                        const Fraction other = algebra.add(now, {-subtracted, now.denominator});
                        if (length(other) < length(hddot)) {
                            hddot = other;
                            shorter = true;
                        }
                    }
                }
            }
        }
        return hddot;
    }

    void try_solution(const Solution& solution, bool expand_angles) {
        if (work_ <= 0) return;
        auto algebra = std::make_unique<Algebra>(graph_, Work{std::min(work_, work_of_a_try)}, expand_angles);
        const long before = algebra->work().left;
        try {
            const Fraction hddot = in_contact(algebra->simplify(on(c_.hddot, solution)), solution, *algebra);
            work_ -= before - algebra->work().left;
            if (best_ && length(best_->hddot) <= length(hddot)) return;
            best_.emplace();
            best_->algebra = std::move(algebra);
            best_->hddot = hddot;
            solution_ = solution;
            for (const auto& [slot, value] : solution) best_->solved.emplace_back(graph_.symbol(slot), value);
        } catch (const std::domain_error&) {  // a step is undefined at this solution
        } catch (const SimplificationLimit&) {
            work_ -= before;
        } catch (const ExpressionTooLarge&) {
            work_ = 0;
        }
    }

    static int sign_of(const Multinomial& base, int exponent, Positivity& positivity) {
        const bool below = exponent < 0;
        if (below && exponent % 2 == 0) return 1;
        if (positivity.is_positive(base, below)) return 1;
        if (positivity.is_positive(-base, below)) return exponent % 2 == 0 ? 1 : -1;
        return 0;
    }

    // Sign of a factor with an odd power where M is positive definite: that of a leading minor of M in which the other
    // factors are positive. 0: unknown.
    int sign_by_definiteness(const Multinomial& base, Algebra& algebra, Positivity& positivity) const {
        Expression minor = graph_.number(1);
        for (const Expression pivot : e_.pivots) {
            minor = minor * graph_.adopt(pivot);
            const FactoredForm factors = factor(algebra.simplify(on(minor, solution_)), algebra);
            bool found = false, others_positive = factors.number != 0;
            for (const auto& [other, exponent] : factors.factors) {
                if (other == base && exponent % 2 != 0)
                    found = true;
                else if (exponent % 2 != 0 && !positivity.is_positive(other, true))
                    others_positive = false;
            }
            if (found && others_positive) return factors.number > 0 ? 1 : -1;
        }
        return 0;
    }

    // Separates the factors of hddot into those proved to be positive and the others.
    void decide(ZenoCondition& zeno) const {
        Algebra& algebra = *zeno.algebra;
        algebra.work() = Work{work_of_a_try};
        std::set<std::size_t> dropped_for, known_for;  // atoms whose signs were used: for dropped factors, for others
        bool unknown = false;
        try {
            const FactoredForm all = factor(zeno.hddot, algebra);
            zeno.positive.number = all.number;
            if (all.number < 0) zeno.positive.number.backend().negate();
            zeno.decisive.number = all.number < 0 ? -1 : all.number == 0 ? 0 : 1;
            for (const auto& [base, exponent] : all.factors) {
                Positivity positivity(algebra, signs_);
                const bool below = exponent < 0, atom = base.terms().size() == 1;
                bool definite = false;
                int sign = sign_of(base, exponent, positivity);
                if (sign == 0 && exponent % 2 != 0) {
                    sign = sign_by_definiteness(base, algebra, positivity);
                    definite = sign != 0;
                }
                unknown = unknown || sign == 0;
                // A single symbol in the numerator is kept, because it shows what drives the motion: g sin(theta).
                const bool drop = sign != 0 && (below || !atom);
                (drop ? zeno.positive : zeno.decisive).factors.push_back({base, exponent});
                if (drop && sign < 0) {
                    zeno.positive.number = -zeno.positive.number;
                    zeno.decisive.number = -zeno.decisive.number;
                }
                if (sign != 0)
                    (drop ? dropped_for : known_for).insert(positivity.used().begin(), positivity.used().end());
                zeno.definite = zeno.definite || definite;
            }
        } catch (const SimplificationLimit&) {  // the condition stays unfactored
            zeno.positive = FactoredForm{};
            zeno.decisive = FactoredForm{1, {{zeno.hddot.numerator, 1}, {zeno.hddot.denominator, -1}}};
            unknown = true;
        }
        if (!unknown) dropped_for.merge(known_for);
        for (const std::size_t atom : dropped_for)
            if (const Expression assumed = algebra.atom(atom); signs_.of_parameters(assumed)) {
                zeno.assumed.push_back(assumed);
                zeno.vanishing = zeno.vanishing || signs_(assumed) == Sign::not_negative;
            }
        if (!unknown)
            zeno.verdict = zeno.decisive.number < 0 ? ZenoCondition::Verdict::always : ZenoCondition::Verdict::never;
    }

    const Layout& layout_;
    const Equations& e_;
    std::vector<const ContactEquations*> contacts_;  // the contact of the condition, then the held contacts
    const ContactEquations& c_;
    Graph& graph_;
    ParameterSigns signs_;
    long work_ = 4 * work_of_a_try;
    std::optional<ZenoCondition> best_;
    Solution solution_;
};

}  // namespace

Expression expression_of(const FactoredForm& product, Algebra& algebra) {
    Expression result =
        algebra.expression(Fraction{Multinomial(numerator(product.number)), Multinomial(denominator(product.number))});
    for (const auto& [base, exponent] : product.factors)
        for (int i = 0; i < std::abs(exponent); ++i)
            result = exponent > 0 ? result * algebra.expression(base) : result / algebra.expression(base);
    return result;
}

std::optional<ZenoCondition> zeno_condition(const Model& model, const Run& run,
                                            const std::vector<const ContactEquations*>& contacts, Graph& graph) {
    const FloatEnvironmentGuard ground;
    return SimplificationSearch(model, run, contacts, graph).best();
}

namespace {

// Work for one formula, about a tenth of a second. A double pendulum takes a hundredth of it; the general hddot of a
// triple pendulum exceeds it.
constexpr long work_of_a_formula = 400000;

bool holds_some(const Model& model) {
    return model.contacts() > 1 && model.contacts() <= SimplifiedEquations::few_contacts;
}

// The motions that hold one contact; null if there are too many contacts or the equations are too large.
std::unique_ptr<ContactModes> derived_motions(const Model& model) {
    if (!holds_some(model)) return nullptr;
    try {
        auto motions = std::make_unique<ContactModes>(model.equations(), model.layout());
        for (std::size_t j = 0; j < model.contacts(); ++j) motions->of(Mode::holding(ContactSet::of(j)));
        return motions;
    } catch (const ExpressionTooLarge&) {
        return nullptr;
    }
}

}  // namespace

std::optional<Fraction> SimplifiedEquations::simplify(Expression expression) {
    if (stop_.stop_requested()) return std::nullopt;
    algebra_->work() = Work{work_of_a_formula};
    try {
        return algebra_->simplify(graph_.adopt(expression));
    } catch (const SimplificationLimit&) {
    } catch (const ExpressionTooLarge&) {
    }
    return std::nullopt;
}

std::optional<ZenoCondition> SimplifiedEquations::condition(const Model& model, const Run& run,
                                                            const std::vector<const ContactEquations*>& involved) {
    if (stop_.stop_requested()) return std::nullopt;
    return zeno_condition(model, run, involved, graph_);
}

SimplifiedContact SimplifiedEquations::simplify(const Model& model, const Run& run, std::size_t contact) {
    const ContactEquations& c = model.equations().free.contacts[contact];
    SimplifiedContact result;
    for (const Expression entry : c.g) result.dh.push_back(simplify(entry));
    result.hdot = simplify(c.hdot);
    result.W = simplify(c.W);
    result.hddot = simplify(c.hddot);
    // lambda = -hddot/W, from the simplified quotients to avoid repeating their divisions.
    if (result.hddot && result.W) {
        algebra_->work() = Work{work_of_a_formula};
        try {
            result.lambda = algebra_->divide({-result.hddot->numerator, result.hddot->denominator}, *result.W);
        } catch (const SimplificationLimit&) {
        }
    }
    result.zeno = this->condition(model, run, {&c});
    return result;
}

SimplifiedEquations::SimplifiedEquations(const Model& model, const Run& run, std::stop_token stop)
    : motions_(derived_motions(model)),
      graph_(motions_ ? motions_->graph() : model.equations().energy.graph()),
      algebra_(std::make_unique<Algebra>(graph_, Work{})),
      stop_(std::move(stop)) {
    const Equations& e = model.equations();
    const Layout& layout = model.layout();
    ranks_.assign(layout.count(), 0);
    for (std::size_t i = 0; i < layout.dof; ++i) {
        ranks_[layout.q(i)] = 1;
        ranks_[layout.v(i)] = 2;
    }
    for (const Expression entry : e.M) M.push_back(simplify(entry));
    for (const Expression entry : e.bias) bias.push_back(simplify(entry));
    for (const Expression entry : e.Q) Q.push_back(simplify(entry));
    for (std::size_t i = 0; i < model.contacts(); ++i) contacts.push_back(simplify(model, run, i));
    for (std::size_t i = 0; i < model.contacts(); ++i)
        for (std::size_t j = 0; j < model.contacts() && motions_; ++j) {
            if (i == j || e.friction.contains(j)) continue;  // with friction it may stick or slide
            HeldCondition& condition = while_held.emplace_back();
            condition.contact = i;
            condition.mode = Mode::holding(ContactSet::of(j));
            condition.zeno = this->condition(model, run, {&held_equations(condition), &e.free.contacts[j]});
        }
}

}  // namespace achilles
