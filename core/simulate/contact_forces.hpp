// Contact forces and gap accelerations at an instant of a run (theory-gaps.md 2).
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Use one object per thread. Refers to the model.
class ContactForces {
 public:
    ContactForces(const Model& model, std::span<const double> parameters);

    // Sets the state, the mode and the load-bearing contacts (the held contacts whose constraints define the motion)
    // for the calls below.
    void set(const State& state, Mode mode, ContactSet load_bearing);
    void set(const State& state, Mode mode) { set(state, mode, mode.held()); }
    void set(const Sample& sample) { set(sample.state, sample.mode, sample.load_bearing); }

    // lambda_i of a held contact; 0 if it is open. If some held contacts are not load-bearing, the forces are
    // not unique: these are the nonnegative ones of least norm (solve_complementarity).
    double force(std::size_t contact);
    // tau of a contact or joint with friction; 0 if it is open.
    double friction_force(std::size_t which);
    // hddot_i of an open contact; 0 if it is held.
    double acceleration(std::size_t contact);
    // sum lambda_i g_i' + tau_i d_i', the generalized contact force. The friction of joints is not part of it.
    Vector generalized_force();

    // Sets the inputs of a view's program from a sample, and runs it. `reads` marks, by slot, the inputs that the
    // program depends on (Program::inputs_of); if it is empty, all are set.
    void run_view(Evaluator<double>& view, const Sample& sample, const std::vector<bool>& reads = {});

 private:
    const ContactTerms<Evaluator<double>>& surface(std::size_t contact);
    void share();

    const Model* model_;
    std::vector<double> parameters_;
    State state_;
    Mode mode_;
    ContactSet load_bearing_;
    std::vector<double> shared_;  // forces of all contacts, if they are not unique; empty until needed
    Model::MotionEvaluators motions_;
    MotionTerms<Evaluator<double>>* motion_ = nullptr;  // at the state; null until needed
    struct NormalAndFriction {
        double lambda, tau;
    };
    NormalAndFriction with_friction(std::size_t which);
    std::map<ContactInMode, Evaluator<double>> forces_;
    std::vector<std::optional<ContactTerms<Evaluator<double>>>> surfaces_;
    std::optional<ContactCache> all_;  // used if forces are not unique
};

}  // namespace achilles
