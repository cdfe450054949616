#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/model.hpp"
#include "number/float_environment.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "sensitivity/error_estimate.hpp"

namespace achilles {

namespace {

RunWarning made_again(const Trajectory& trajectory) {
    const Options &requested = trajectory.run.options, &used = *trajectory.rerun_options;
    std::string what = fmt::format("tolerance {:g}", used.tolerance);
    for (const char* key : {"eps_q", "eps_v"})
        if (const Option& eps = option(key); eps.get(requested) != eps.get(used))
            what += ", " + summary_text(eps, used, "{:g}");
    return {fmt::format("repeated at tolerance {:g}", used.tolerance),
            fmt::format("undecided at tolerance {:g}{}: the whole run was repeated with {}", requested.tolerance,
                        trajectory.rerun_reason.empty() ? "" : " (" + trajectory.rerun_reason + ")", what)};
}

// True if the gap of the contact exceeds `height` at the end of a step. `largest` returns the largest gap found.
bool has_been_above(double height, const Trajectory& trajectory, std::size_t contact, double& largest) {
    const Model& model = *trajectory.model;
    auto gap = model.evaluator(model.gap(contact), trajectory.run.parameters);
    const auto at = [&](const State& state) {
        set_state(gap, state);
        gap.run();
        return gap.output(0);
    };
    largest = std::max(largest, at(trajectory.run.start()));
    for (auto piece = trajectory.pieces.begin(); piece != trajectory.pieces.end() && !(largest > height); ++piece)
        largest = std::max(largest, at(state_in(*piece, trajectory.coefficients, model.dof(), piece->end)));
    return largest > height;
}

// eps is in the units of the file, whatever the size of the motion. Small bounces are then truncated too soon.
std::optional<RunWarning> cut_too_soon(const Trajectory& trajectory) {
    constexpr double large_share = 0.001, wanted_share = 1e-4;
    std::vector<double> largest_of(trajectory.model->contacts(), 0.0);  // a run may have very many such events
    for (const Event& event : trajectory.events) {
        if (!is_zeno_point(event) || !event.certificate || event.contacts.count() != 1) continue;
        std::size_t contact = 0;
        while (!event.contacts.contains(contact)) ++contact;
        const Certificate& c = *event.certificate;
        // With the paper's conditions, the height of the omitted bounces is bounded by their speed.
        const double w = event.truncation->impact_speed;
        const double bound = c.uniform_position.value_or(c.a_min > 0.0 ? 0.5 * w * w / c.a_min : c.position_bound);
        const double enough = bound / large_share;
        double& largest = largest_of[contact];
        if (largest >= enough || has_been_above(enough, trajectory, contact, largest) || !(largest > 0.0)) continue;
        const std::string when =
            event.impacts == 1 ? "at its first impact" : fmt::format("after {} impacts", event.impacts);
        const double eps = std::max(min_tolerance, std::pow(10.0, std::floor(std::log10(wanted_share * largest))));
        return RunWarning{
            "eps is large here",
            fmt::format("eps_q = {:g} is large for this motion: the impact sequence was cut {}, t = {:.6g}, "
                        "where {} {:.2g}, but the gap never exceeds {:.2g}: try --eps {:g}",
                        trajectory.run.options.truncation.eps_q, when, event.truncation->t,
                        c.uniform_position ? "the position is certified to" : "bounces may be as high as", bound,
                        largest, eps)};
    }
    return std::nullopt;
}

// Between a cut and its Zeno point the motion holds contacts that the phase does not hold yet. If a phase has no
// pieces, the last piece belongs to the phase before it.
std::optional<RunWarning> ended_during_completion(const Trajectory& trajectory) {
    if (trajectory.phases.empty() || trajectory.events.empty()) return std::nullopt;
    const Phase& phase = trajectory.phases.back();
    if (phase.first_piece == phase.last_piece || trajectory.end_time < trajectory.pieces.back().end)
        return std::nullopt;
    const ContactSet to_hold = trajectory.pieces.back().mode.held().without(phase.mode.held());
    bool has_bounces = false;  // bounces are omitted
    for (std::size_t i = 0; i < trajectory.model->contacts(); ++i)
        if (to_hold.contains(i) && trajectory.model->restitution(trajectory.run.parameters, i) > 0.0)
            has_bounces = true;
    if (!has_bounces) return std::nullopt;
    const Event& cut = trajectory.events.back();
    return RunWarning{
        "ends before a Zeno point",
        fmt::format("the run ends between a cut, t = {:.9g}, and its Zeno point: after the cut it is the restarted "
                    "motion, without the remaining bounces; for the certificate choose a later end time",
                    cut.t)};
}

// A certificate starts from the computed state. If the error of this state exceeds the width of the interval, the
// interval contains the Zeno time of a neighboring motion. This matters only if the error exceeds the tolerance.
std::optional<RunWarning> integration_outweighs(const Trajectory& trajectory) {
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        if (!event.is_zeno() || !event.certificate || !event.certificate->certified) continue;
        const double width = event.certificate->zeno_high - event.certificate->zeno_low;
        const double error = integration_error_of_time(trajectory, i);
        if (!(width > 0.0) || !(error > width) || !(error > trajectory.run.options.truncation.eps_t)) continue;
        return RunWarning{
            "integration error exceeds an interval",
            fmt::format("the interval of the Zeno time {:.6g} is {:.1g} s wide: it is certified for the motion from "
                        "the computed state, but earlier integration errors and cuts may have shifted this time by "
                        "{:.1g} s (an estimate, usually too large): try a smaller --tolerance",
                        event.t, width, error)};
    }
    return std::nullopt;
}

// Flights too short for double precision are not computed, even if the requested tolerance needs them.
std::optional<RunWarning> unresolved_flights(const Trajectory& trajectory) {
    for (const Event& event : trajectory.events) {
        if (!event.is_zeno() || !event.certificate || !event.certificate->cut_at_resolution ||
            !event.certificate->decision)
            continue;
        const Inequality& closest = event.certificate->decision->closest();
        if (closest.left < closest.right) continue;
        return RunWarning{
            "eps is not met",
            fmt::format("the impact sequence was cut at t = {:.6g} because shorter flights cannot be resolved in "
                        "double precision; the truncation criterion is not met: {}, {:.2g} < {:.2g}, does not hold",
                        event.truncation->t, closest.name, closest.left, closest.right)};
    }
    return std::nullopt;
}

}  // namespace

std::vector<RunWarning> remarks(const Trajectory& trajectory) {
    const FloatEnvironmentGuard ground;
    std::vector<RunWarning> all;
    if (trajectory.rerun_options) all.push_back(made_again(trajectory));
    if (auto remark = cut_too_soon(trajectory)) all.push_back(std::move(*remark));
    if (auto remark = unresolved_flights(trajectory)) all.push_back(std::move(*remark));
    if (auto remark = integration_outweighs(trajectory)) all.push_back(std::move(*remark));
    if (auto remark = ended_during_completion(trajectory)) all.push_back(std::move(*remark));
    return all;
}

std::optional<RunWarning> horizon_remark(const Trajectory& trajectory, const ErrorEstimate& estimate) {
    const std::optional<double> horizon = horizon_before_end(trajectory, estimate);
    if (!horizon) return std::nullopt;
    const ErrorCourse& course = estimate.course;
    const std::string name =
        trajectory.model->description().coordinates[static_cast<std::size_t>(course.coordinate())].name +
        (course.is_rate() ? "'" : "");
    const Options& used = trajectory.rerun_options ? *trajectory.rerun_options : trajectory.run.options;
    const std::string advice = used.tolerance > 10.0 * min_tolerance ? "; a smaller --tolerance extends this time" : "";
    const std::string label = fmt::format("trusted until t = {:.6g} s", *horizon);
    return RunWarning{
        label, fmt::format("{}, not to the end: after this time the estimated error of {} exceeds {:g} of its range, "
                           "and the computed motion is not that of the system{}. Unknown numbers are printed as {}",
                           label, name, ErrorCourse::largest_share, advice, unknown_number)};
}

std::vector<RunWarning> remarks(const Trajectory& trajectory, const ErrorEstimate& estimate) {
    std::vector<RunWarning> all = remarks(trajectory);
    if (auto remark = horizon_remark(trajectory, estimate)) all.insert(all.begin(), std::move(*remark));
    return all;
}

}  // namespace achilles
