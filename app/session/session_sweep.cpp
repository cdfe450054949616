// Many runs beside the present one.
#include <fmt/format.h>

#include <algorithm>

#include "expression/parse.hpp"
#include "figure/sweep_figure.hpp"
#include "journal/journal.hpp"
#include "session/refusal.hpp"
#include "session/session.hpp"

namespace achilles {

namespace {

constexpr std::uint64_t points = 512;  // along an axis, of the finest picture

// What varies is not what the values and options of the present run are for.
Sweep sweep_of(const std::string& text, const SystemDescription& description) {
    Sweep sweep = read_sweep(text, description);
    if (sweep.base != default_run(description))
        throw refusal("--set and the options of a run are not allowed here", "the sliders set what does not vary");
    if (sweep.axes.size() > 2) throw refusal("at most two axes can be shown");
    if (sweep.count() > most_drawn_rows)
        throw refusal(
            fmt::format("a sweep of {} points cannot be drawn: at most {} can be", sweep.count(), most_drawn_rows),
            "achilles sweep --csv F writes it as a table");
    return sweep;
}

}  // namespace

std::string default_sweep(const SystemDescription& description) {
    std::vector<const ParameterDescription*> order;
    for (const ParameterDescription& parameter : description.parameters) order.push_back(&parameter);
    const auto restitutes = [&](const ParameterDescription* parameter) {
        return std::any_of(description.constraints.begin(), description.constraints.end(), [&](const auto& constraint) {
            const std::vector<std::string> names = names_in(constraint.restitution.text);
            return std::find(names.begin(), names.end(), parameter->name) != names.end();
        });
    };
    std::stable_partition(order.begin(), order.end(), restitutes);
    Sweep sweep;
    sweep.base = default_run(description);
    if (!order.empty()) {
        const ParameterDescription& first = *order.front();
        sweep.axes.push_back({first.name, first.range[0], first.range[1], points, false});
    } else {
        const CoordinateDescription& first = description.coordinates.front();
        sweep.axes.push_back({first.name + "'", first.rate_range[0], first.rate_range[1], points, false});
    }
    sweep.prints = {"zeno_time(1)"};
    return to_text(sweep, description);
}

std::string Session::sweep_text() const { return scene_.sweep().value_or(default_sweep(description())); }

Sweep Session::sweep() const {
    Sweep sweep = sweep_of(sweep_text(), description());
    sweep.base = asked_;
    return sweep;
}

// Throws InputError where it could not be made of runs that end as the present one does.
void Session::check_sweep(const std::string& text) const {
    Sweep sweep = sweep_of(text, description());
    sweep.base.options = asked_.options;
    if (library_.budget) library_.budget->check(sweep);
    const RunMeasures measures(system_->model, sweep);
}

void Session::perform(const command::ShowSweep& command) {
    try {
        check_sweep(command.text);
    } catch (const Forbidden&) {
        throw;
    } catch (const InputError& problem) {
        throw refusal(problem.what(), std::string(command::ShowSweep::said.usage));
    }
    scene_.perform(command);
}

// Unless another system has not what it names.
void Session::keep_sweep() {
    if (!scene_.sweep()) return;
    try {
        check_sweep(*scene_.sweep());
    } catch (const InputError&) {
        scene_.forget_sweep();
    }
}

void Session::follow_sweep() {
    if (scene_.shows("sweep"))
        sweep_job_->ask(system_->model, sweep());
    else
        sweep_job_->ask(system_->model, {});
    sweep_job_->update(0.0);
}

void Session::settle() {
    receive_pins({});
    receive({});
    receive_proof({});
    receive_estimate({});
    sweep_job_->update({});
    follow_dependence({});
    receive_orbit({});
}

}  // namespace achilles
