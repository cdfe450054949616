// Programs' outputs by name, over any scalar. The order of the outputs is defined only here, both for the code that
// compiles a program and for the code that reads it.
//
// A class of terms extends a base with outputs (such as an Evaluator) for a system with `dof` coordinates. list()
// arranges expressions in the order in which the members read them.
#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "expression/expression.hpp"
#include "program/program.hpp"

namespace achilles {

using Expressions = std::vector<Expression>;

// Concatenates lists.
inline Expressions joined(std::initializer_list<Expressions> lists) {
    Expressions all;
    for (const Expressions& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
}

template <class Base>
class Terms : public Base {
 public:
    Terms() = default;
    Terms(Base base, std::size_t dof) : Base(std::move(base)), dof_(dof) {}

 protected:
    std::size_t dof_ = 0;
};

// A base without outputs, for the use of list() alone.
struct NoOutputs {};

// A program whose outputs have the names of TermsOf.
template <template <class> class TermsOf>
class TypedProgram : public Program {
 public:
    TypedProgram() = default;
    // Compiles the expressions; the arguments are those of list().
    template <class... Parts>
    static TypedProgram of(Slots slots, const Parts&... parts) {
        return TypedProgram(TermsOf<NoOutputs>::list(parts...), slots);
    }

 private:
    TypedProgram(const Expressions& outputs, Slots slots) : Program(outputs, slots) {}
};

// The gap h at (q, v, t): its rate, n = M^-1 g'/W, g = dh, W = g M^-1 g', and dh/dt (theory.md 1).
template <class Base>
class ContactTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(Expression h, Expression hdot, const Expressions& impulse_direction,
                            const Expressions& gradient, Expression W, Expression gap_t) {
        return joined({{h, hdot}, impulse_direction, gradient, {W, gap_t}});
    }
    decltype(auto) h() const { return this->output(0); }
    decltype(auto) hdot() const { return this->output(1); }
    decltype(auto) impulse_direction(std::size_t i) const { return this->output(2 + i); }
    decltype(auto) gradient(std::size_t i) const { return this->output(2 + this->dof_ + i); }
    decltype(auto) W() const { return this->output(2 + 2 * this->dof_); }
    decltype(auto) gap_t() const { return this->output(3 + 2 * this->dof_); }
};

// Outputs of a mode's motion: acceleration, pivots of M, hddot of every contact, and jerk, the rate of hddot for each
// held contact. For a held contact, hddot is along the motion that holds the other held contacts. The event functions
// of friction follow after hddot, and their rates after the jerks; `contacts` then counts them, too.
template <class Base>
class MotionTerms : public Terms<Base> {
 public:
    MotionTerms() = default;
    MotionTerms(Base base, std::size_t dof, std::size_t contacts = 1)
        : Terms<Base>(std::move(base), dof), contacts_(contacts) {}
    static Expressions list(const Expressions& acceleration, const Expressions& pivots, const Expressions& further) {
        return joined({acceleration, pivots, further});
    }
    decltype(auto) acceleration(std::size_t i) const { return this->output(i); }
    decltype(auto) pivot(std::size_t i) const { return this->output(this->dof_ + i); }
    decltype(auto) hddot(std::size_t contact) const { return this->output(2 * this->dof_ + contact); }
    // For contact i of the held contacts.
    decltype(auto) jerk(std::size_t i) const { return this->output(2 * this->dof_ + contacts_ + i); }

 private:
    std::size_t contacts_ = 1;
};

// The slip of a contact or joint in a mode in which it is open (model/friction.hpp): u, c, du/dv, its acceleration, the
// acceleration of the coordinates by tau = 1, and both friction coefficients, that of sliding at the given speed.
template <class Base>
class SlipTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(Expression u, Expression c, Expression udot, Expression coefficient,
                            Expression static_coefficient, const Expressions& d, const Expressions& impulse) {
        return joined({{u, c, udot, coefficient, static_coefficient}, d, impulse});
    }
    decltype(auto) u() const { return this->output(0); }
    decltype(auto) c() const { return this->output(1); }
    decltype(auto) udot() const { return this->output(2); }
    decltype(auto) coefficient() const { return this->output(3); }
    decltype(auto) static_coefficient() const { return this->output(4); }
    decltype(auto) d(std::size_t i) const { return this->output(5 + i); }
    decltype(auto) impulse(std::size_t i) const { return this->output(5 + this->dof_ + i); }
};

// What must be defined at the start of a run: free acceleration, pivots, hddot, kinetic and potential energy.
template <class Base>
class StartTerms : public MotionTerms<Base> {
 public:
    using MotionTerms<Base>::MotionTerms;
    static Expressions list(const Expressions& f, const Expressions& pivots, Expression hddot, Expression kinetic,
                            Expression potential) {
        return MotionTerms<Base>::list(f, pivots, {hddot, kinetic, potential});
    }
    decltype(auto) kinetic() const { return this->output(2 * this->dof_ + 1); }
    decltype(auto) potential() const { return this->output(2 * this->dof_ + 2); }
};

// What a release needs: hddot, and its rate along the constrained motion.
template <class Base>
class ReleaseTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(Expression hddot, Expression jerk) { return {hddot, jerk}; }
    decltype(auto) hddot() const { return this->output(0); }
    decltype(auto) jerk() const { return this->output(1); }
};

template <class Base>
class EnergyTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(Expression total, Expression kinetic, Expression potential) {
        return {total, kinetic, potential};
    }
    decltype(auto) total() const { return this->output(0); }
    decltype(auto) kinetic() const { return this->output(1); }
    decltype(auto) potential() const { return this->output(2); }
};

// What Def. 7 needs over a box: hddot, n and the free acceleration f.
template <class Base>
class Definition7Terms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(Expression hddot, const Expressions& impulse_direction, const Expressions& acceleration) {
        return joined({{hddot}, impulse_direction, acceleration});
    }
    decltype(auto) hddot() const { return this->output(0); }
    decltype(auto) impulse_direction(std::size_t i) const { return this->output(1 + i); }
    decltype(auto) acceleration(std::size_t i) const { return this->output(1 + this->dof_ + i); }
};

}  // namespace achilles
