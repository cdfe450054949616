#include "simulate/contact_forces.hpp"

#include "contacts/complementarity.hpp"
#include "number/dense.hpp"

namespace achilles {

ContactForces::ContactForces(const Model& model, std::span<const double> parameters)
    : model_(&model), parameters_(parameters.begin(), parameters.end()), surfaces_(model.contacts()) {}

void ContactForces::set(const State& state, Mode mode, ContactSet load_bearing) {
    state_ = state;
    mode_ = mode;
    load_bearing_ = load_bearing;
    shared_.clear();
    motion_ = nullptr;
}

double ContactForces::force(std::size_t contact) {
    if (!mode_.is_held(contact)) return 0.0;
    if (model_->has_friction()) return with_friction(contact).lambda;
    if (load_bearing_ != mode_.held()) {
        if (shared_.empty()) share();
        return shared_[contact];
    }
    const Mode others = model_->unconstrained(mode_, contact);
    const ContactInMode key(others, contact);
    auto known = forces_.find(key);
    if (known == forces_.end())
        known = forces_.emplace(key, model_->evaluator(model_->programs_of(contact, others).force, parameters_)).first;
    set_state(known->second, state_);
    known->second.run();
    return known->second.output(0);
}

double ContactForces::friction_force(std::size_t which) {
    return mode_.is_held(which) ? with_friction(which).tau : 0.0;
}

ContactForces::NormalAndFriction ContactForces::with_friction(std::size_t which) {
    const ContactInMode key(mode_, which);
    auto known = forces_.find(key);
    if (known == forces_.end())
        known = forces_.emplace(key, model_->evaluator(model_->friction_force(which, mode_), parameters_)).first;
    Evaluator<double>& force = known->second;
    set_state(force, state_);
    force.run();
    return {force.output(0) / force.output(2), force.output(1) / force.output(2)};
}

// Solves W lambda = -hddot over all held contacts for the lambda >= 0 of least norm. First, the part of hddot that no
// force can balance is removed (rounding, by which dependent gaps do not move together). If no lambda >= 0 exists,
// lambda = W^+ (-hddot).
void ContactForces::share() {
    if (!all_) {
        Run run;
        run.parameters = parameters_;
        all_.emplace(*model_, run);
    }
    const ClosedContacts closed = all_->at(state_, mode_.held());
    ContactVector<double> hddot(closed.W.rows());
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        hddot[static_cast<Eigen::Index>(i)] =
            all_->of(closed.which[i], Mode().with_acting(mode_.seen_by_forces().within(model_->equations().in_forces)))
                .normal_acceleration(state_);
    const Eigen::MatrixXd W = closed.W;
    const Eigen::VectorXd least = least_solution(W, Eigen::VectorXd(-hddot));
    const auto pressing = solve_complementarity(closed.W, -closed.W * least);
    shared_.assign(surfaces_.size(), 0.0);
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        shared_[closed.which[i]] = pressing ? pressing->p[k] : least[k];
    }
}

double ContactForces::acceleration(std::size_t contact) {
    if (mode_.is_held(contact)) return 0.0;
    if (motion_ == nullptr) {
        motion_ = &model_->lazily(motions_, mode_.only(load_bearing_), parameters_);
        set_state(*motion_, state_);
        motion_->run();
    }
    return motion_->hddot(contact);
}

const ContactTerms<Evaluator<double>>& ContactForces::surface(std::size_t contact) {
    auto& terms = model_->lazily(surfaces_[contact], model_->programs_of(contact).contact_terms, parameters_);
    set_state(terms, state_);
    terms.run();
    return terms;
}

Vector ContactForces::generalized_force() {
    Vector Q = Vector::Zero(state_.q.size());
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        if (!mode_.is_held(i)) continue;
        const double lambda = force(i);
        const auto& terms = surface(i);
        for (Eigen::Index k = 0; k < Q.size(); ++k) Q[k] += lambda * terms.gradient(static_cast<std::size_t>(k));
        if (!model_->equations().friction.contains(i)) continue;
        auto slip = model_->evaluator(model_->slip_terms(i), parameters_);
        set_state(slip, state_);
        slip.run();
        const double tau = friction_force(i);
        for (Eigen::Index k = 0; k < Q.size(); ++k) Q[k] += tau * slip.d(static_cast<std::size_t>(k));
    }
    return Q;
}

void ContactForces::run_view(Evaluator<double>& view, const Sample& sample, const std::vector<bool>& reads) {
    const auto is_read = [&](std::size_t slot) { return reads.empty() || reads[slot]; };
    const Layout& layout = model_->layout();
    set_state(view, sample.state);
    view.input(layout.work()) = sample.work;
    view.input(layout.loss()) = sample.loss;
    if (!layout.has_contact_inputs()) {
        view.input(layout.contact()) = sample.contact ? 1.0 : 0.0;
    } else {
        set(sample);
        for (std::size_t i = 0; i < layout.contacts; ++i) {
            if (is_read(layout.acceleration(i))) view.input(layout.acceleration(i)) = acceleration(i);
            if (is_read(layout.force(i))) view.input(layout.force(i)) = force(i);
            if (layout.forces_see_contact) view.input(layout.held(i)) = mode_.seen_by_forces().contains(i) ? 1.0 : 0.0;
        }
        if (layout.frictions > 0) view.input(layout.heat()) = sample.heat;
        std::size_t k = 0;
        for (const auto& [which, law] : model_->equations().friction) {
            if (is_read(layout.friction_force(k))) view.input(layout.friction_force(k)) = friction_force(which);
            ++k;
        }
    }
    view.run();
}

}  // namespace achilles
