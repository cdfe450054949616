// The default output of `simulate`.
#include "output/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/model.hpp"
#include "number/float_environment.hpp"
#include "output/contacts.hpp"
#include "output/event_descriptions.hpp"
#include "output/page.hpp"
#include "output/precision.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

constexpr std::size_t max_state_columns = 4;  // columns of the table

// Half-width of the certified Zeno time (s), to the farther end of the interval; 0 if it is not certified.
double half_width(const Event& event) { return proved_time(event).value_or(0.0); }

std::string with_unit(const std::string& text, const std::string& unit) {
    return unit.empty() ? text : text + " " + unit;
}

// Decimals: six for values of about 1, and the same number of significant digits for larger or smaller scales.
int decimals_of(double scale) {
    if (!(scale > 0.0)) return 6;
    const int place = static_cast<int>(std::floor(std::log10(scale)));
    return std::clamp(place >= 0 ? 6 - std::max(0, place - 1) : 5 - place, 0, 12);
}

// The value without the decimals that the error affects.
std::string decimal_text(double value, double error, double scale) {
    if (!std::isfinite(error)) return unknown_number;
    if (error >= 1.0) return known_digits(value, error, 9);
    int decimals = decimals_of(scale);
    if (error > 0.0) decimals = std::clamp(static_cast<int>(std::floor(-std::log10(error))), 0, decimals);
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find_first_of("123456789") == std::string::npos) return "0";
    return text;
}

// An input value with at most nine digits.
std::string given_text(double value) { return fmt::format("{:.9g}", value + 0.0); }

// The table of events: one row per change of the contact state.
class ContactChanges {
 public:
    ContactChanges(const Trajectory& trajectory, const ErrorEstimate& estimate)
        : trajectory_(trajectory),
          model_(*trajectory.model),
          precision_(trajectory, &estimate),
          sentences_(trajectory, &estimate),
          scale_(scale_of(trajectory)) {}

    std::string text() const {
        TextTable table;
        table.add_column("t (s)", TextTable::Align::decimal_point);
        table.add_column("event", TextTable::Align::left);
        for (std::size_t i = 0; i < columns(); ++i) table.add_column(heading(i), TextTable::Align::decimal_point);
        if (columns() < coordinates()) table.add_column("...", TextTable::Align::left);
        table.add_column("", TextTable::Align::left);
        add_first_and_last(
            rows(), [&](const std::vector<std::string>& row) { table.add_row(row); },
            [&](std::size_t count) { table.add_line(fmt::format("... {} more events (--verbose)", count)); });
        return table.text();
    }

 private:
    std::size_t coordinates() const { return model_.description().coordinates.size(); }
    std::size_t columns() const { return std::min(coordinates(), max_state_columns); }

    std::string heading(std::size_t i) const {
        const CoordinateDescription& coordinate = model_.description().coordinates[i];
        return coordinate.unit.empty() ? coordinate.name : fmt::format("{} ({})", coordinate.name, coordinate.unit);
    }

    std::vector<std::vector<std::string>> rows() const {
        const Run& run = trajectory_.run;
        std::vector<std::vector<std::string>> rows;
        rows.push_back(row(given_text(run.options.start_time), "start", run.q, {}, sentences_.state_at_start()));
        for (std::size_t i = 0; i < trajectory_.events.size(); ++i)
            if (const Event& event = trajectory_.events[i]; event.changes_held() || event.is_pass())
                rows.push_back(row(i, event));
        const State errors = precision_.of_state(trajectory_.end_time);
        const bool reached = trajectory_.outcome.kind == Outcome::Kind::end_time;
        rows.push_back(row(
            reached ? given_text(trajectory_.end_time) : decimal_text(trajectory_.end_time, 0.0, trajectory_.end_time),
            reached ? "end" : "stop", trajectory_.end.q, errors.q,
            sentences_.state_at_end() + ", " + rates(trajectory_.end.v, errors.v)));
        return rows;
    }

    std::vector<std::string> row(std::size_t index, const Event& event) const {
        const double time_error = std::max(half_width(event), precision_.of_event(index));
        const State errors = precision_.of_state(event.t);
        // The printed state is that at the printed time, so an error of the time moves it.
        const Vector moved = errors.q + time_error * event.v_after.cwiseAbs();
        const Event::Kind kind = is_plastic_landing(event) ? Event::Kind::impact : event.kind;
        return row(decimal_text(event.t, time_error, trajectory_.end_time), std::string(names_of(kind).label), event.q,
                   moved, sentences_.change(index));
    }

    // Without `errors`, q is printed as given.
    std::vector<std::string> row(std::string time, std::string name, const Vector& q, const Vector& errors,
                                 std::string note) const {
        std::vector<std::string> cells{std::move(time), std::move(name)};
        for (std::size_t i = 0; i < columns(); ++i) {
            const auto at = static_cast<Eigen::Index>(i);
            cells.push_back(errors.size() == 0 ? given_text(q[at]) : decimal_text(q[at], errors[at], scale_.q[at]));
        }
        if (columns() < coordinates()) cells.emplace_back();
        cells.push_back(std::move(note));
        return cells;
    }

    std::string rates(const Vector& v, const Vector& errors) const {
        std::string text;
        for (std::size_t i = 0; i < columns(); ++i) {
            const auto at = static_cast<Eigen::Index>(i);
            const std::string name = model_.description().coordinates[i].name + "'";
            text += fmt::format(
                "{}{} = {}", i > 0 ? ", " : "", name,
                with_unit(decimal_text(v[at], errors[at], scale_.v[at]), unit_of(model_.description(), name)));
        }
        return columns() < coordinates() ? text + ", ..." : text;
    }

    const Trajectory& trajectory_;
    const Model& model_;
    Precision precision_;
    EventDescriptions sentences_;
    State scale_;
};

std::string times_line(const Trajectory& trajectory, const ErrorEstimate& estimate) {
    std::vector<double> widths;
    double integration = 0.0;
    bool is_estimated = true;
    int uncertified = 0;
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        if (!is_zeno_point(event)) continue;
        if (const auto bound = proved_time(event))
            widths.push_back(*bound);
        else
            ++uncertified;
        if (i < estimate.events.size())
            integration = std::max(integration, estimate.events[i]);
        else
            is_estimated = false;
    }
    std::string text;
    if (widths.size() == 1)
        text = fmt::format("Zeno time certified within {} s (truncation only)", rounded_up(widths[0]));
    else if (widths.size() == 2)
        text = fmt::format("Zeno times certified within {} s and {} s (truncation only)", rounded_up(widths[0]),
                           rounded_up(widths[1]));
    else if (!widths.empty())
        text = fmt::format("{} Zeno times certified, each within {} s (truncation only)", widths.size(),
                           rounded_up(*std::max_element(widths.begin(), widths.end())));
    if (uncertified > 0)
        text += fmt::format("{}{} Zeno {} not certified", text.empty() ? "" : "; ", uncertified,
                            uncertified == 1 ? "point is" : "points are");
    if (text.empty()) return "";
    if (is_estimated && integration > 0.0)
        text += fmt::format("; estimated integration error {} s", estimate_text(integration));
    return text + ".\n";
}

std::string end_line(const Trajectory& trajectory, const ErrorEstimate& estimate, const std::string& prove_command) {
    const std::string state = estimate.end ? "estimated error " + estimate_text(estimate.end->size())
                                           : "no error estimate, because " + estimate.no_estimate_reason;
    if (first_unproved(trajectory.model->description())) return fmt::format("State at the end: {}.\n", state);
    return fmt::format("State at the end: {}. For a proof of the whole run: {}\n", state, prove_command);
}

// Only with friction: "Heat of friction 4.52 J, loss at impacts 0.301 J."
std::string dissipation_line(const Trajectory& trajectory, const EventDescriptions& sentences) {
    if (!trajectory.model->has_friction()) return "";
    Sample end;
    end.t = trajectory.end_time, end.state = trajectory.end;
    const double error = sentences.precision().of_energy(end);
    const auto text = [&](double value) {
        const std::string shown = sentences.energy(value, error);
        return shown.empty() ? with_unit("0", sentences.energy_unit()) : shown;
    };
    return fmt::format("Heat of friction {}, loss at impacts {}.\n", text(trajectory.heat), text(trajectory.loss));
}

std::string first_line(const Trajectory& trajectory, const EventDescriptions& sentences) {
    const std::string& title = trajectory.model->description().title;
    if (trajectory.outcome.kind != Outcome::Kind::end_time)
        return fmt::format("{}: stopped at t = {:.9g} s of {:.9g} s: {}\n  {}. {}\n", title, trajectory.end_time,
                           trajectory.run.options.end_time, to_text(trajectory.outcome.kind),
                           trajectory.outcome.message, advice(trajectory));
    const bool has_zeno = std::any_of(trajectory.events.begin(), trajectory.events.end(), is_zeno_point);
    return fmt::format("{}: simulated to t = {:.9g} s, {} at the end{}\n", title, trajectory.end_time,
                       sentences.state_at_end(),
                       !has_zeno && trajectory.statistics.impacts > 0 ? "; no Zeno point" : "");
}

}  // namespace

std::string advice(const Trajectory& trajectory) {
    switch (trajectory.outcome.kind) {
        case Outcome::Kind::end_time:
        case Outcome::Kind::cancelled:
            return "";
        case Outcome::Kind::too_many_impacts:
            return "Try a larger --max-impacts, or a larger --eps to truncate earlier.";
        case Outcome::Kind::too_many_steps:
            return "Try a larger --max-steps.";
        case Outcome::Kind::out_of_memory:
            return "Try a larger --memory, or an earlier --end.";
        case Outcome::Kind::not_a_number:
        case Outcome::Kind::left_the_domain:
            return "Check the expressions of the system there, or choose an earlier --end.";
        case Outcome::Kind::step_too_small:
            return "Try a larger --tolerance, or --method dopri5.";
        case Outcome::Kind::undecided:
            return "Try a smaller --tolerance, another initial state, or another parameter value.";
        case Outcome::Kind::simultaneous_impacts:
            return "To continue with Moreau's law: --simultaneous moreau.";
        case Outcome::Kind::redundant_contacts:
            return trajectory.model->has_friction() ? "Remove a redundant contact or the friction of one."
                                                    : "Remove a redundant contact.";
        case Outcome::Kind::painleve:
        case Outcome::Kind::impact_not_unique:
            return "Try a smaller friction coefficient, or choose an earlier --end.";
        case Outcome::Kind::energy_gain:
            return "To reduce the restitution until no energy is gained: --energy-gain cap.";
        case Outcome::Kind::too_many_events:
            return "Try a larger --max-events.";
    }
    return "";
}

std::string answer(const Trajectory& trajectory, const ErrorEstimate& estimate, const std::string& prove_command) {
    const FloatEnvironmentGuard ground;
    const EventDescriptions sentences(trajectory, &estimate);
    std::string text = first_line(trajectory, sentences);
    for (const RunWarning& remark : remarks(trajectory, estimate)) text += "  warning: " + remark.sentence + "\n";
    if (trajectory.ambiguous_impacts > 0)
        text += fmt::format(
            "  warning: {} simultaneous {} an order-dependent outcome; resolved together by Moreau's law. Orders: "
            "--json. Stop instead: --simultaneous stop\n",
            trajectory.ambiguous_impacts, trajectory.ambiguous_impacts == 1 ? "impact has" : "impacts have");
    text += "\n" + ContactChanges(trajectory, estimate).text() + "\n";
    text += dissipation_line(trajectory, sentences);
    text += times_line(trajectory, estimate) + end_line(trajectory, estimate, prove_command);
    const Statistics& s = trajectory.statistics;
    return text + fmt::format("{} impact{}, {} steps. For impacts, bounds and assumptions: --verbose\n", s.impacts,
                              s.impacts == 1 ? "" : "s", s.steps);
}

}  // namespace achilles
