#include "algebra/vanishes.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "algebra/algebra.hpp"

namespace achilles {

namespace {

constexpr long max_work = 400000;

// Solution of number atom + rest = 0.
struct LinearSolution {
    std::size_t atom;
    Multinomial number, rest;
};

class Elimination {
 public:
    Elimination(Graph& graph, std::span<const std::uint32_t> unknowns)
        : algebra_(graph, Work{max_work}), unknowns_(unknowns) {}

    bool proves(Expression expression, std::vector<Expression> zeros) {
        for (std::size_t i = 0; i < zeros.size(); ++i) {
            const Multinomial zero = algebra_.simplify(zeros[i]).numerator;
            const auto solved = solve(zero, true);
            if (!solved) continue;
            const std::uint32_t slot = slot_of(solved->atom);
            const Expression value = -(algebra_.expression(solved->rest) / algebra_.expression(solved->number));
            const auto replaced = [&](Expression x) { return substitute(x, {&slot, 1}, {&value, 1}); };
            expression = replaced(expression);
            std::transform(zeros.begin(), zeros.end(), zeros.begin(), replaced);
        }
        // The remaining zeros are solved for functions, which are substituted in the polynomial only.
        Multinomial left = algebra_.simplify(expression).numerator;
        for (const Expression zero : zeros) {
            if (left.is_zero()) return true;
            if (const auto solved = solve(algebra_.simplify(zero).numerator, false)) left = replaced(left, *solved);
        }
        return left.is_zero();
    }

 private:
    // Solves for an unknown symbol that no function depends on, or for a function.
    std::optional<LinearSolution> solve(const Multinomial& zero, bool for_a_symbol) const {
        const std::vector<std::size_t> atoms = zero.atoms();
        for (const std::size_t atom : atoms) {
            if (is_unknown(atom) != for_a_symbol || (!for_a_symbol && !is_moving_function(atom))) continue;
            const std::vector<Multinomial> parts = zero.coefficients(atom);
            if (parts.size() != 2 || !parts[1].is_number()) continue;
            if (for_a_symbol && is_inside(slot_of(atom), atoms, atom)) continue;
            return LinearSolution{atom, parts[1], parts[0]};
        }
        return std::nullopt;
    }

    bool is_symbol(std::size_t atom) const {
        return algebra_.graph().node(algebra_.atom(atom).id()).operation == Operation::symbol;
    }
    std::uint32_t slot_of(std::size_t atom) const { return algebra_.graph().node(algebra_.atom(atom).id()).a; }
    bool is_unknown(std::size_t atom) const {
        return is_symbol(atom) && std::find(unknowns_.begin(), unknowns_.end(), slot_of(atom)) != unknowns_.end();
    }
    bool is_moving_function(std::size_t atom) const {
        return !is_symbol(atom) && depends_on(algebra_.atom(atom), unknowns_);
    }
    bool is_inside(std::uint32_t slot, const std::vector<std::size_t>& atoms, std::size_t but) const {
        return std::any_of(atoms.begin(), atoms.end(), [&](std::size_t atom) {
            return atom != but && depends_on(algebra_.atom(atom), {&slot, 1});
        });
    }

    // Substitutes atom = -rest/number in a polynomial of degree d in the atom, and multiplies by number^d.
    Multinomial replaced(const Multinomial& polynomial, const LinearSolution& solved) {
        const std::vector<Multinomial> parts = polynomial.coefficients(solved.atom);
        Multinomial result, power(1);
        for (std::size_t k = 0; k < parts.size(); ++k) {  // powers of the number: Horner's rule, from below
            result = times(result, solved.number, algebra_.work()) + times(parts[k], power, algebra_.work());
            power = times(power, -solved.rest, algebra_.work());
        }
        return algebra_.reduced(result);
    }

    Algebra algebra_;
    std::span<const std::uint32_t> unknowns_;
};

// True if the proof succeeds within its work limit.
template <class Proof>
bool is_proved(const Proof& proof) {
    try {
        return proof();
    } catch (const SimplificationLimit&) {
    } catch (const ExpressionTooLarge&) {
    } catch (const std::domain_error&) {
    }
    return false;
}

}  // namespace

bool vanishes(Expression expression) {
    if (expression.is_zero()) return true;
    Graph graph(expression.graph());
    Algebra algebra(graph, Work{max_work});
    return is_proved([&] { return algebra.simplify(graph.adopt(expression)).is_zero(); });
}

bool vanishes_where(Expression expression, std::span<const Expression> zeros, std::span<const std::uint32_t> unknowns) {
    if (expression.is_zero()) return true;
    Graph graph(expression.graph());
    std::vector<Expression> adopted;
    for (const Expression zero : zeros) adopted.push_back(graph.adopt(zero));
    return is_proved([&] { return Elimination(graph, unknowns).proves(graph.adopt(expression), adopted); });
}

}  // namespace achilles
