#include "simulate/mode_kinematics.hpp"

#include "number/float_environment.hpp"
#include "simulate/impact.hpp"

namespace achilles {

ModeKinematics::ModeKinematics(const Model& model, std::span<const double> parameters, Mode mode)
    : model_(&model),
      parameters_(parameters.begin(), parameters.end()),
      mode_(mode),
      dynamics_(&model.motion(mode)),
      contacts_(model.contacts()),
      dof_(static_cast<std::size_t>(model.dof())) {}

template <class Terms>
auto ModeKinematics::value_of(const Terms& terms, std::size_t event) const {
    using Number = std::remove_cvref_t<decltype(terms.hddot(event))>;
    EventValue<Number> result{terms.hddot(event), Number(0.0)};
    if (event < contacts_ && !mode_.is_held(event)) return result;
    std::size_t rate = event < contacts_ ? 0 : static_cast<std::size_t>(mode_.held().count()) + event - contacts_;
    for (const std::size_t i : mode_.held())
        if (i < event && event < contacts_) ++rate;
    result.rate = terms.jerk(rate);
    return result;
}

void ModeKinematics::run(const State& state) {
    const Program& program = dynamics_->program;
    if (!terms_) terms_.emplace(model_->evaluator(program, parameters_), dof_, events());
    set_state(*terms_, state);
    terms_->run();
}

auto ModeKinematics::at(const State& state, std::size_t event) -> EventValue<double> {
    run(state);
    return value_of(*terms_, event);
}

Vector ModeKinematics::acceleration(const State& state) {
    run(state);
    Vector a(static_cast<Eigen::Index>(dof_));
    for (std::size_t i = 0; i < dof_; ++i) a[static_cast<Eigen::Index>(i)] = terms_->acceleration(i);
    return a;
}

auto ModeKinematics::enclosed(const State& state) -> std::vector<EventValue<Interval>> {
    const FloatEnvironmentGuard ground;
    const Program& program = dynamics_->program;
    if (!enclosure_) enclosure_.emplace(model_->evaluator<Interval>(program, parameters_), dof_, events());
    set_rounding_box(*enclosure_, state);
    enclosure_->run();
    std::vector<EventValue<Interval>> all;
    for (std::size_t i = 0; i < events(); ++i) all.push_back(value_of(*enclosure_, i));
    return all;
}

}  // namespace achilles
