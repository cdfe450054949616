#include "session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "expression/nearest.hpp"
#include "model/model.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

constexpr std::size_t most_plots = 4;

// A refusal that names no file: the user's hand made the mistake.
InputError refusal(const std::string& message, const std::string& hint = {}) { return {{}, {}, message, hint}; }

void expect_positive(double value, const char* what) {
    if (!(std::isfinite(value) && value > 0.0))
        throw refusal(fmt::format("{} must be positive and finite, but it would be {}", what, value));
}

// Where a run keeps the value of a name: a parameter, a coordinate's start x, its rate x'. Null if there is none.
double* find_value(const SystemDescription& description, Run& run, const std::string& name) {
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        if (description.parameters[i].name == name) return &run.parameters[i];
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const std::string& coordinate = description.coordinates[i].name;
        if (name == coordinate) return &run.q[static_cast<Eigen::Index>(i)];
        if (name == coordinate + "'") return &run.v[static_cast<Eigen::Index>(i)];
    }
    return nullptr;
}

InputError no_such_name(const SystemDescription& description, const std::string& name) {
    std::vector<std::string> names;
    for (const ParameterDescription& p : description.parameters) names.push_back(p.name);
    for (const CoordinateDescription& c : description.coordinates) names.insert(names.end(), {c.name, c.name + "'"});
    return refusal(fmt::format("there is no parameter, coordinate or rate '{}'{}", name, did_you_mean(name, names)));
}

}  // namespace

Session::System::System(const std::string& name_as_opened, const SystemDescription& description)
    : name(name_as_opened), model(std::make_shared<const Model>(description)), mechanism(*model) {
    const auto& all = model->description().views;
    for (std::size_t i = 0; i < std::min(all.size(), most_plots); ++i) views.emplace_back(*model, all[i]);
}

Session::Motion::Motion(const System& system, const Run& run, const Theme& theme)
    : trajectory(simulate(system.model, run)), sampler(trajectory) {
    without_events.model = trajectory.model;
    without_events.run = run;
    const std::vector<Sample> samples = plot_samples(trajectory);
    limits = system.mechanism.limits(trajectory, samples);
    for (const PreparedView& view : system.views) plots.push_back(compose(trajectory, samples, view, theme));
}

Session::Session(const std::string& name, const SystemDescription& first, Opener opener) : opener_(std::move(opener)) {
    system_ = std::make_shared<const System>(name, first);
    rerun(system_->model->default_run());
}

void Session::apply(const Command& command) {
    try {
        std::visit([this](const auto& what) { perform(what); }, command);
        // Playing on must not wipe away what the last change of the run complained about.
        const bool moves_time_only = std::holds_alternative<command::Seek>(command) ||
                                     std::holds_alternative<command::Play>(command) ||
                                     std::holds_alternative<command::Pause>(command);
        if (!moves_time_only) error_.clear();
    } catch (const InputError& problem) {
        error_ = problem.what();
    }
}

void Session::perform(const command::Open& command) {
    const auto opened = std::make_shared<const System>(command.system, opener_(command.system));
    const auto motion = std::make_shared<Motion>(*opened, opened->model->default_run(), theme_);
    system_ = opened;
    motion_ = motion;
    playing_ = false;
    selected_ = 0;
    move_to(0.0);
}

void Session::perform(const command::Set& command) {
    Run changed = run();
    double* const value = find_value(description(), changed, command.name);
    if (value == nullptr) throw no_such_name(description(), command.name);
    if (!std::isfinite(command.value)) throw refusal(fmt::format("'{}' must be finite", command.name));
    *value = command.value;
    rerun(changed);
}

std::optional<double> Session::value(const std::string& name) const {
    Run copy = run();
    const double* const found = find_value(description(), copy, name);
    return found == nullptr ? std::nullopt : std::optional(*found);
}

void Session::perform(const command::End& command) {
    expect_positive(command.time, "the end time");
    Run changed = run();
    changed.options.end_time = command.time;
    rerun(changed);
}

void Session::perform(const command::Tolerance& command) {
    expect_positive(command.value, "the tolerance");
    Run changed = run();
    changed.options.tolerance = command.value;
    rerun(changed);
}

void Session::perform(const command::Eps& command) {
    for (const double value : {command.q, command.v, command.t}) expect_positive(value, "eps");
    Run changed = run();
    changed.options.truncation.eps_q = command.q;
    changed.options.truncation.eps_v = command.v;
    changed.options.truncation.eps_t = command.t;
    rerun(changed);
}

void Session::perform(const command::UseConditions& command) {
    Run changed = run();
    changed.options.truncation.conditions = command.conditions;
    rerun(changed);
}

void Session::perform(const command::UseReinitialization& command) {
    Run changed = run();
    changed.options.truncation.reinitialization = command.reinitialization;
    rerun(changed);
}

void Session::perform(const command::Seek& command) { move_to(command.time); }

void Session::perform(const command::Play&) {
    // Play at the end means: once more.
    if (time_ >= trajectory().end_time) move_to(0.0);
    playing_ = true;
}

void Session::perform(const command::Pause&) { playing_ = false; }

void Session::perform(const command::Select& command) {
    const auto& events = trajectory().events;
    if (command.event < 0 || static_cast<std::size_t>(command.event) > events.size())
        throw refusal(fmt::format("there is no event {}: this run has {}", command.event, events.size()));
    selected_ = command.event;
    if (selected_ > 0) move_to(events[static_cast<std::size_t>(selected_ - 1)].t);
}

// The same model with another run: nothing is read or derived again.
void Session::rerun(const Run& run) {
    motion_ = std::make_shared<Motion>(*system_, run, theme_);
    if (static_cast<std::size_t>(selected_) > trajectory().events.size()) selected_ = 0;
    move_to(time_);
}

void Session::move_to(double time) {
    time_ = std::clamp(time, 0.0, trajectory().end_time);
    now_ = motion_->sampler.at(time_);
}

std::vector<Point> Session::present(std::size_t plot) const {
    const Panel panel = compose(motion_->without_events, {&now_, 1}, system_->views[plot], theme_);
    std::vector<Point> points;
    for (const Curve& curve : panel.curves) points.insert(points.end(), curve.points.begin(), curve.points.end());
    return points;
}

void play_on(Session& session, double seconds, bool loop) {
    if (!session.playing()) return;
    session.apply(command::Seek{session.time() + seconds});
    if (session.time() < session.trajectory().end_time) return;
    if (loop)
        session.apply(command::Play{});  // at the end: once more
    else
        session.apply(command::Pause{});
}

std::string to_text(const Session& session) {
    std::string text = fmt::format("system {}\n", session.system());
    const SystemDescription& description = session.description();
    const Run& run = session.run();
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        text += fmt::format("{} = {:.9g}\n", description.parameters[i].name, run.parameters[i]);
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        text += fmt::format("{0} = {1:.9g}, {0}' = {2:.9g}\n", description.coordinates[i].name, run.q[at], run.v[at]);
    }
    text += fmt::format("time {:.9g}{}, event {}\n", session.time(), session.playing() ? " playing" : "",
                        session.selected());
    if (!session.error().empty()) text += "error " + session.error() + "\n";
    return text + to_text(session.trajectory());
}

}  // namespace achilles
