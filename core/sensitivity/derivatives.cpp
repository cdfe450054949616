#include "sensitivity/derivatives.hpp"

#include <fmt/format.h>

#include <limits>

#include "model/model.hpp"
#include "sensitivity/chain.hpp"

namespace achilles {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Refuses directions that leave the surface of a contact at rest at the start: the perturbed run would start in the air
// or below the surface. It refuses those that change a slip that is 0 at the start and slides from there, or is held by
// static friction alone: the friction force would depend on the sign of the change.
void refuse(Chain& chain, const Model& model, const RowMatrix& Z, std::vector<std::string>& refused) {
    const TangentLayout& tangent = chain.tangent();
    constexpr double rounding = 1e-12;
    for (Index k = 0; k < Z.cols(); ++k) {
        const double size = Z.col(k).head(tangent.h(0)).cwiseAbs().maxCoeff() +
                            Z.col(k).tail(Z.rows() - tangent.u(tangent.contacts)).cwiseAbs().sum();
        for (std::size_t i = 0; i < tangent.contacts; ++i) {
            if (!chain.resting_at_start().contains(i)) continue;
            const std::string& name = model.description().constraints[i].name;
            if (std::abs(Z(tangent.h(i), k)) > rounding * size)
                refused[static_cast<std::size_t>(k)] =
                    fmt::format("the run starts in contact ('{}'), and this direction changes the gap", name);
            else if (std::abs(Z(tangent.u(i), k)) > rounding * size)
                refused[static_cast<std::size_t>(k)] =
                    fmt::format("the run starts in contact ('{}'), and this direction changes the gap rate", name);
        }
        for (const std::size_t i : chain.critical_slips_at_start())
            if (std::abs(chain.slip_row_at_start(i) * Z.col(k)) > rounding * size)
                refused[static_cast<std::size_t>(k)] = fmt::format(
                    "the run starts at slip 0 ('{}'), where its friction jumps, and this direction changes the slip",
                    is_joint(i) ? model.description().frictions[i - max_contacts].name
                                : model.description().constraints[i].name);
    }
}

}  // namespace

Derivatives differentiate(const Trajectory& trajectory) {
    const SystemDescription& system = trajectory.model->description();
    const auto n = static_cast<Index>(system.coordinates.size()), P = static_cast<Index>(system.parameters.size());
    Derivatives result = differentiate(trajectory, MatrixXd::Identity(2 * n + P + 1, 2 * n + P));
    for (const auto& coordinate : system.coordinates) result.directions.push_back(coordinate.name);
    for (const auto& coordinate : system.coordinates) result.directions.push_back(coordinate.name + "'");
    for (const auto& parameter : system.parameters) result.directions.push_back(parameter.name);
    return result;
}

Derivatives differentiate(const Trajectory& trajectory, const MatrixXd& directions) {
    const auto n = static_cast<Index>(trajectory.model->dof()), K = directions.cols();
    const auto P = static_cast<Index>(trajectory.run.parameters.size());
    Chain::ChainOptions options;
    for (Index k = 0; k < P; ++k) options.parameters.push_back(!directions.row(2 * n + k).isZero(0.0));
    Chain chain(trajectory, std::move(options));
    const TangentLayout& tangent = chain.tangent();
    Derivatives result;
    result.refused.resize(static_cast<std::size_t>(K));
    RowMatrix Z = MatrixXd::Zero(tangent.size(), K);
    Z.middleRows(tangent.q(0), 2 * n) = directions.topRows(2 * n);
    Z.middleRows(tangent.p(0), P) = directions.middleRows(2 * n, P);
    Z.row(TangentLayout::t()) = directions.row(2 * n + P);
    chain.complete(Z);
    refuse(chain, *trajectory.model, Z, result.refused);
    for (Index k = 0; k < K; ++k)
        if (!result.refused[static_cast<std::size_t>(k)].empty())
            Z.col(k).setConstant(std::numeric_limits<double>::quiet_NaN());

    const auto positions = [&] { return Z.middleRows(tangent.q(0), n); };
    const auto velocities = [&] { return Z.middleRows(tangent.v(0), n); };
    const auto take = [&](std::size_t event) {
        if (result.events.size() == event) {
            Derivatives::EventSensitivity& at = result.events.emplace_back();
            at.v_before = velocities();
        }
        Derivatives::EventSensitivity& at = result.events[event];
        at.t = Z.row(TangentLayout::t()).transpose();
        at.q = positions();
        at.v_after = velocities();
    };
    while (const ChainLink* link = chain.next()) {
        if (link->event && link->kind == ChainLink::Kind::jump) {
            const Event& event = trajectory.events[*link->event];
            // At the event, after the crossing and before the jump.
            if (event.is_discontinuous()) take(*link->event);
            if (event.is_impact())
                result.events.back().impact_speed = -Z.row(tangent.u(event.contacts.only())).transpose();
            // v_after is that of Newton's impact law, also if the run continues from a restart.
            std::optional<MatrixXd> drawn;
            if (link->completion) drawn = (link->completion->newton * Z).middleRows(tangent.v(0), n);
            link->apply(Z);
            take(*link->event);
            Derivatives::EventSensitivity& at = result.events.back();
            if (!event.is_discontinuous()) at.v_before = at.v_after;
            if (drawn) at.v_after = std::move(*drawn);
            continue;
        }
        link->apply(Z);
    }
    result.margins = chain.margins();
    result.broken = chain.broken();
    if (!result.broken.empty()) {
        result.broken_from = chain.state().t;
        return result;
    }
    const VectorXd F = chain.rate();
    const MatrixXd fixed = Z - F * Z.row(TangentLayout::t());
    result.end = Derivatives::FinalSensitivity{fixed.middleRows(tangent.q(0), n), fixed.middleRows(tangent.v(0), n)};
    return result;
}

}  // namespace achilles
