#include "simulate/work.hpp"

#include <boost/math/quadrature/gauss.hpp>

namespace achilles {

Work::Work(const Model& model, const Run& run)
    : any_(model.equations().has_power()), dof_(model.dof()), power_(model.evaluator(model.power(), run.parameters)) {}

double Work::along(const Piece& piece, std::span<const double> coefficients, double from, double to) {
    if (!any_ || !(to > from)) return 0.0;
    const auto power_at = [&](double t) {
        set_state(power_, state_in(piece, coefficients, dof_, t));
        power_.run();
        return power_.free() - (piece.contact ? power_.taken() : 0.0);
    };
    return boost::math::quadrature::gauss<double, 7>::integrate(power_at, from, to);
}

}  // namespace achilles
