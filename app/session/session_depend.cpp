// On what a quantity of the present run depends.
#include <cmath>

#include "session/refusal.hpp"
#include "session/session.hpp"

namespace achilles {

std::string Session::depend_text() const { return scene_.depends().value_or(simulated_->quantity); }

bool Session::influences_are_current() const {
    const Influences* const known = influences();
    return known != nullptr && watch_ == nullptr && known->run.get() == &trajectory() &&
           known->quantity.expression == depend_text();
}

void Session::perform(const command::ShowDependence& command) {
    try {
        const Text text{command.quantity, {}};
        system_->model->compile_measures({&text, 1});
    } catch (const InputError& problem) {
        throw refusal(problem.what(), std::string(command::ShowDependence::said.usage));
    }
    scene_.perform(command);
}

// Unless another system has not what it names.
void Session::keep_dependence() {
    if (!scene_.depends()) return;
    try {
        const Text text{*scene_.depends(), {}};
        system_->model->compile_measures({&text, 1});
    } catch (const InputError&) {
        scene_.forget_dependence();
    }
}

// Of the run that is shown. What takes less than half a frame is there in the same one.
void Session::follow_dependence(Patience patience) {
    constexpr double glance = 0.008;
    if (!scene_.shows("depend") || shows_start()) return influences_job_->forget();
    const bool is_new = influences_job_->ask({simulated_, &simulated_->trajectory}, depend_text());
    influences_job_->update(is_new && patience ? glance : patience);
}

std::optional<TangentLine> Session::sweep_tangent() const {
    if (!influences_are_current()) return std::nullopt;
    const Sweep shown = sweep();
    if (shown.axes.size() != 1 || shown.at || shown.prints.front() != influences()->quantity.expression)
        return std::nullopt;
    const SweepAxis& axis = shown.axes.front();
    const Influences::Of* const by = influences()->find(axis.name);
    if (by == nullptr || !std::isfinite(by->derivative)) return std::nullopt;
    return TangentLine{*value(axis.name), influences()->quantity.value, by->derivative, axis.logarithmic};
}

}  // namespace achilles
