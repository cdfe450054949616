// On what a run depends, for a person.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "depend/quantities.hpp"
#include "model/model.hpp"
#include "output/output.hpp"

namespace achilles {

namespace {

// "x -4.027, y -2.697, ...": of the directions that have one.
std::string row(const Derivatives& d, const Eigen::VectorXd& values) {
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < d.directions.size(); ++k) {
        const double x = values[static_cast<Eigen::Index>(k)];
        if (std::isfinite(x)) parts.push_back(fmt::format("{} {:.6g}", d.directions[k], std::abs(x) < 1e-13 ? 0.0 : x));
    }
    return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string margins(const DerivativeMargins& m) {
    std::vector<std::string> parts;
    const auto add = [&](const char* what, const std::optional<double>& x) {
        if (x) parts.push_back(fmt::format("{} {:.3g}", what, *x));
    };
    add("smallest speed of a grazing impact", m.grazing_speed);
    add("smallest minimum of a gap in flight", m.gap_minimum);
    add("smallest -hddot at a Zeno point", m.a_inf);
    add("smallest h''' at a release", m.release_jerk);
    return parts.empty() ? ""
                         : fmt::format("  margins (there are no derivatives where one of them is 0): {}\n",
                                       fmt::join(parts, ", "));
}

}  // namespace

std::string summary(const Trajectory& trajectory, const Dependence& dependence) {
    const Derivatives& d = dependence.derivatives;
    std::string text = "\nderivatives of event times, and of the state at the fixed end time:\n";
    int zeno = 0, releases = 0;
    for (std::size_t i = 0; i < d.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        if (event.kind == Event::Kind::impact) continue;
        const bool is_zeno = event.kind == Event::Kind::zeno;
        text += fmt::format("  {}({}): {}\n", is_zeno ? "zeno_time" : "release_time", is_zeno ? ++zeno : ++releases,
                            row(d, d.events[i].t));
    }
    const auto& coordinates = trajectory.model->description().coordinates;
    for (std::size_t i = 0; d.end && i < coordinates.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        text += fmt::format("  {} at the end: {}\n", coordinates[i].name, row(d, d.end->q.row(k).transpose()));
        text += fmt::format("  {}' at the end: {}\n", coordinates[i].name, row(d, d.end->v.row(k).transpose()));
    }
    for (const Quantity& quantity : dependence.quantities)
        text +=
            fmt::format("  {} = {:.10g}: {}\n", quantity.expression, quantity.value,
                        quantity.refused.empty() ? row(d, quantity.derivatives) : "no derivative: " + quantity.refused);
    for (std::size_t k = 0; k < d.refused.size(); ++k)
        if (!d.refused[k].empty())
            text += fmt::format("  with respect to {}: no derivative: {}\n", d.directions[k], d.refused[k]);
    if (!d.broken.empty()) text += fmt::format("  no derivatives from t = {:.9g} s on: {}\n", d.broken_from, d.broken);
    if (trajectory.run.options.method == Method::dopri5)
        text += "  computed by Taylor series from the start of each dopri5 step: as accurate as the states there\n";
    return text + margins(d.margins) + "Certificates do not cover derivatives.\n";
}

}  // namespace achilles
