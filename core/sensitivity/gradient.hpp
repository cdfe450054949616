// Small changes of a state, and the outputs of a program with their derivatives by the components of a change.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "model/model.hpp"
#include "number/jet.hpp"

namespace achilles {

// One change per column; row-major, because events act on rows.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Layout of the components of a small change of a state (theory-derivatives.md 1). As for the sets of core/enclose,
// they are the time of the perturbed run, q, v, the gap h and gap rate u of every contact as independent components,
// and the parameters. Between a truncation and its Zeno point, the remaining accumulation time is a further component.
//
// t is a component, so that a change follows its events and is never reduced to a fixed time on the way. h and u are
// components, so that after an impact h' is exactly 0 and u' keeps its relative accuracy, however small u is.
struct TangentLayout {
    std::size_t dof = 0, contacts = 0, parameters = 0;

    static constexpr Eigen::Index t() { return 0; }
    Eigen::Index q(std::size_t i) const { return index(1 + i); }
    Eigen::Index v(std::size_t i) const { return index(1 + dof + i); }
    Eigen::Index accumulation_time() const { return index(1 + 2 * dof); }
    Eigen::Index h(std::size_t contact) const { return index(2 + 2 * dof + contact); }
    Eigen::Index u(std::size_t contact) const { return index(2 + 2 * dof + contacts + contact); }
    Eigen::Index p(std::size_t k) const { return index(2 + 2 * dof + 2 * contacts + k); }
    Eigen::Index size() const { return p(parameters); }

    // The inputs of programs as components of a change: q, v, then the parameters, then time.
    std::size_t variables() const { return 2 * dof + parameters + 1; }
    Eigen::Index variable(std::size_t k) const {
        return k < 2 * dof ? q(k) : k < 2 * dof + parameters ? p(k - 2 * dof) : t();
    }

 private:
    static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
};

// The outputs of a program with their derivatives by q, v, the parameters and time.
class Gradient {
 public:
    Gradient(const Model& model, const Program& program, const TangentLayout& tangent,
             std::span<const double> parameters)
        : tangent_(tangent) {
        const std::vector<bool> inputs = program.inputs_of(program.output_count());
        for (std::size_t k = 0; k < tangent.variables(); ++k)
            if (inputs[k]) variables_.push_back(k);
        for (std::size_t first = 0; first == 0 || first < variables_.size(); first += lanes) {
            Evaluator<Number>& evaluator = evaluators_.emplace_back(program);
            for (std::size_t k = 0; k < parameters.size(); ++k)
                evaluator.input(model.layout().parameter(k)) = number(parameters[k], 2 * tangent.dof + k, first);
            evaluator.fix();
        }
        values_.resize(program.output_count());
        rows_.setZero(static_cast<Eigen::Index>(program.output_count()), tangent.size());
    }

    // Sets a further input of the program, by slot; derivatives do not refer to it.
    void set_input(std::size_t slot, double value) {
        for (Evaluator<Number>& evaluator : evaluators_) evaluator.input(slot) = value;
    }
    // Evaluates at a state.
    void at(const State& state) {
        const std::size_t n = tangent_.dof;
        for (std::size_t part = 0; part < evaluators_.size(); ++part) {
            Evaluator<Number>& evaluator = evaluators_[part];
            const std::size_t first = part * lanes;
            for (std::size_t i = 0; i < n; ++i) {
                const auto k = static_cast<Eigen::Index>(i);
                evaluator.input(i) = number(state.q[k], i, first);
                evaluator.input(n + i) = number(state.v[k], n + i, first);
            }
            evaluator.clock() = number(state.t, tangent_.variables() - 1, first);
            evaluator.run();
            for (std::size_t i = 0; i < values_.size(); ++i) {
                const Number& output = evaluator.output(i);
                values_[i] = output.value;
                for (std::size_t j = 0; j < lanes && first + j < variables_.size(); ++j)
                    rows_(static_cast<Eigen::Index>(i), tangent_.variable(variables_[first + j])) = output.slope[j];
            }
        }
    }
    double value(std::size_t output) const { return values_[output]; }
    // The derivatives of an output by the components of a change.
    auto row(std::size_t output) const { return rows_.row(static_cast<Eigen::Index>(output)); }

 private:
    static constexpr std::size_t lanes = 8;
    using Number = Jet8;
    // Input number `variable` with value x. It carries a derivative if it is one of the up to `lanes` variables from
    // variables_[first] on, for which this evaluator computes derivatives.
    Number number(double x, std::size_t variable, std::size_t first) const {
        for (std::size_t j = 0; j < lanes && first + j < variables_.size(); ++j)
            if (variables_[first + j] == variable) return Number::variable(x, j);
        return x;
    }

    TangentLayout tangent_;
    std::vector<std::size_t> variables_;         // inputs that the program depends on
    std::vector<Evaluator<Number>> evaluators_;  // one for every `lanes` variables
    std::vector<double> values_;
    RowMatrix rows_;
};

// Gives the index of an output in place of its value, for the names of a class of terms.
struct IdentityLayout {
    std::size_t output(std::size_t index) const { return index; }
};

// The quantities of a contact with their derivatives, by name.
class ContactGradient : public Gradient {
 public:
    ContactGradient(const Model& model, const TypedProgram<ContactTerms>& program, const TangentLayout& tangent,
                    std::span<const double> parameters)
        : Gradient(model, program, tangent, parameters), places_({}, tangent.dof) {}
    double h() const { return value(places_.h()); }
    double hdot() const { return value(places_.hdot()); }
    double n(std::size_t i) const { return value(places_.impulse_direction(i)); }
    auto h_row() const { return row(places_.h()); }
    auto hdot_row() const { return row(places_.hdot()); }
    auto n_row(std::size_t i) const { return row(places_.impulse_direction(i)); }
    double g(std::size_t i) const { return value(places_.gradient(i)); }
    auto g_row(std::size_t i) const { return row(places_.gradient(i)); }
    double W() const { return value(places_.W()); }
    auto W_row() const { return row(places_.W()); }

 private:
    ContactTerms<IdentityLayout> places_;
};

// The slip of a contact or joint and its friction coefficient at a sliding speed, with their derivatives. Those of the
// coefficient are at a fixed sliding speed.
class SlipGradient : public Gradient {
 public:
    SlipGradient(const Model& model, const TypedProgram<SlipTerms>& program, const TangentLayout& tangent,
                 std::span<const double> parameters)
        : Gradient(model, program, tangent, parameters),
          places_({}, tangent.dof),
          speed_(model.layout().sliding_speed()) {}
    void at(const State& state, double speed) {
        set_input(speed_, speed);
        Gradient::at(state);
    }
    double u() const { return value(places_.u()); }
    double coefficient() const { return value(places_.coefficient()); }
    double d(std::size_t i) const { return value(places_.d(i)); }
    double impulse(std::size_t i) const { return value(places_.impulse(i)); }
    auto u_row() const { return row(places_.u()); }
    auto coefficient_row() const { return row(places_.coefficient()); }
    auto d_row(std::size_t i) const { return row(places_.d(i)); }
    auto impulse_row(std::size_t i) const { return row(places_.impulse(i)); }

 private:
    SlipTerms<IdentityLayout> places_;
    std::size_t speed_;
};

}  // namespace achilles
