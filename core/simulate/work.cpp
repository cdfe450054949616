#include "simulate/work.hpp"

#include <boost/math/quadrature/gauss.hpp>

namespace achilles {

Work::Work(const Model& model, const Run& run)
    : any_(model.equations().has_power()), dof_(model.dof()), model_(&model), parameters_(run.parameters) {}

double Work::along(const Piece& piece, std::span<const double> coefficients, double from, double to) {
    if (!any_ || !(to > from)) return 0.0;
    const Mode motion = piece.motion();
    auto known = powers_.find(motion);
    if (known == powers_.end())
        known = powers_.emplace(motion, model_->evaluator(model_->power(motion), parameters_)).first;
    Evaluator<double>& power = known->second;
    const auto power_at = [&](double t) {
        set_state(power, state_in(piece, coefficients, dof_, t));
        power.run();
        return power.output(0);
    };
    using boost::math::quadrature::gauss;
    // A power that depends on the time may change while the motion stands still.
    if (!model_->equations().autonomous) return gauss<double, 30>::integrate(power_at, from, to);
    if (piece.degree <= 7) return gauss<double, 7>::integrate(power_at, from, to);
    if (piece.degree <= 10) return gauss<double, 10>::integrate(power_at, from, to);
    if (piece.degree <= 15) return gauss<double, 15>::integrate(power_at, from, to);
    if (piece.degree <= 20) return gauss<double, 20>::integrate(power_at, from, to);
    return gauss<double, 30>::integrate(power_at, from, to);
}

}  // namespace achilles
