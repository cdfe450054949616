// The forces that hold contacts, and how the gaps accelerate, at an instant of a run (theory-gaps.md 2).
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "simulate/sampler.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

// One per thread. Refers to the model.
class ContactForces {
 public:
    ContactForces(const Model& model, std::span<const double> parameters);

    // What is asked next is asked of this state, where these are held, in the motion of the carriers among them.
    void set(const State& state, Mode mode, ContactSet carriers);
    void set(const State& state, Mode mode) { set(state, mode, mode.held()); }
    void set(const Sample& sample) { set(sample.state, sample.mode, sample.carriers); }

    // lambda_i, that which holds contact i while the others of them are held; 0 where it is not held. Where not all of them are
    // carriers it is one choice of several: the forces of least norm that press (solve_complementarity).
    double force(std::size_t contact);
    // hddot_i of the motion; 0 where contact i is held.
    double acceleration(std::size_t contact);
    // sum lambda_i g_i', as a generalised force.
    Vector generalised();

    // Gives the program of a view all that it may ask for of a sample, and runs it. `reads`, by slot: the inputs that it depends
    // on (Program::inputs_of); empty: all of them.
    void run_view(Evaluator<double>& view, const Sample& sample, const std::vector<bool>& reads = {});

 private:
    const ContactTerms<Evaluator<double>>& surface(std::size_t contact);
    void share();

    const Model* model_;
    std::vector<double> parameters_;
    State state_;
    Mode mode_;
    ContactSet carriers_;
    std::vector<double> shared_;  // of all contacts, where the forces are not unique; empty until they are asked for
    Model::MotionEvaluators motions_;
    MotionTerms<Evaluator<double>>* motion_ = nullptr;  // at the state; null until it is asked for
    std::map<ContactInMode, Evaluator<double>> forces_;
    std::vector<std::optional<ContactTerms<Evaluator<double>>>> surfaces_;
    std::optional<Surfaces> all_;  // where forces are shared
};

}  // namespace achilles
