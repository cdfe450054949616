// The pinned runs and the comparison of all runs.
#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "figure/difference.hpp"
#include "output/proof.hpp"
#include "session/command.hpp"
#include "session/session.hpp"
#include "session/study_jobs.hpp"

namespace achilles {

namespace {

bool same_texts(const Text& a, const Text& b) { return a.text == b.text; }

template <class Thing, class Same>
bool alike(const std::vector<Thing>& a, const std::vector<Thing>& b, const Same& same) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

}  // namespace

bool same_system(const SystemDescription& a, const SystemDescription& b) {
    return same_texts(a.kinetic, b.kinetic) && same_texts(a.potential, b.potential) &&
           same_texts(a.dissipation, b.dissipation) &&
           alike(a.coordinates, b.coordinates,
                 [](const CoordinateDescription& x, const CoordinateDescription& y) {
                     return x.name == y.name && x.unit == y.unit && same_texts(x.force, y.force);
                 }) &&
           alike(a.parameters, b.parameters,
                 [](const ParameterDescription& x, const ParameterDescription& y) {
                     return x.name == y.name && x.unit == y.unit;
                 }) &&
           alike(a.derived, b.derived,
                 [](const DerivedDescription& x, const DerivedDescription& y) {
                     return x.name == y.name && same_texts(x.definition, y.definition);
                 }) &&
           alike(a.constraints, b.constraints,
                 [](const ConstraintDescription& x, const ConstraintDescription& y) {
                     return x.name == y.name && same_texts(x.gap, y.gap) && same_texts(x.restitution, y.restitution);
                 }) &&
           alike(sliding_places(a), sliding_places(b), [](const SlidingPlace& x, const SlidingPlace& y) {
               const Text none;
               return x.name == y.name && x.number == y.number && same_texts(*x.slip, *y.slip) &&
                      same_texts(*x.level, *y.level) &&
                      same_texts(x.static_level ? *x.static_level : none, y.static_level ? *y.static_level : none);
           });
}

const PinnedRun* Session::pinned_at(int place) const {
    const auto found =
        std::find_if(pinned_.begin(), pinned_.end(), [&](const PinnedRun& run) { return run.place == place; });
    return found == pinned_.end() ? nullptr : &*found;
}

void Session::perform(const command::Pin& command) {
    const auto same = std::find_if(pinned_.begin(), pinned_.end(),
                                   [&](const PinnedRun& p) { return p.trajectory->run == requested_run_; });
    if (same != pinned_.end()) throw refusal(fmt::format("this run is already pinned, as {}", same->place));
    const auto made =
        std::find_if(pins_.begin(), pins_.end(), [&](const PendingPin& p) { return p.run == requested_run_; });
    if (pin_waits_ || made != pins_.end())
        throw refusal(fmt::format("this run will be pinned, as {}, when it has finished",
                                  pin_waits_ ? *pin_waits_ : made->place));
    if (pinned_.size() + pins_.size() >= max_pinned)
        throw refusal(fmt::format("{} runs are pinned, and no more can be pinned", max_pinned),
                      "unpin one first: unpin 1, or: unpin all");
    int place = command.place;
    if (place > max_pinned)
        throw refusal(fmt::format("there is no place {} for a run: the places are 1 to {}", place, max_pinned));
    const auto is_taken = [this](int at) { return pinned_at(at) != nullptr || waits_at(at); };
    if (place > 0 && is_taken(place))
        throw refusal(fmt::format("a run is already pinned at {}", place),
                      fmt::format("unpin {} first, or: pin", place));
    if (place == 0)
        for (place = 1; is_taken(place);) ++place;
    scene_.perform(command::Show{"runs", true});
    ++pin_requests_;
    if (watch_ != nullptr) {  // the current run is not finished
        pin_waits_ = place;
        return;
    }
    pin(place, pin_requests_, simulated_);
    compose_pinned();
}

// Throws InputError if all runs together would need more memory than one run may use.
void Session::pin(int place, int number, const std::shared_ptr<FinishedRun>& all) {
    double bytes = bytes_of(all->trajectory);
    for (const PinnedRun& run : pinned_) bytes += bytes_of(*run.trajectory);
    if (const double most = all->trajectory.run.options.memory; bytes > most)
        throw refusal(
            fmt::format("the pinned runs would take {:.4g} MB, but memory is {:.4g} MB", bytes / 1e6, most / 1e6),
            fmt::format("unpin one, or allow more: memory {:.1g}", 2.0 * bytes));
    PinnedRun run;
    run.place = place;
    run.number = number;
    run.trajectory = {all, &all->trajectory};
    run.sampler = {all, &all->sampler};
    run.samples = {all, &all->samples};
    run.estimate = {all, &all->estimate};
    const auto later =
        std::find_if(pinned_.begin(), pinned_.end(), [&](const PinnedRun& one) { return one.number > number; });
    pinned_.insert(later, std::move(run));
}

bool Session::waits_at(int place) const {
    return pin_waits_ == place ||
           std::any_of(pins_.begin(), pins_.end(), [&](const PendingPin& pin) { return pin.place == place; });
}

std::vector<int> Session::pins_under_way() const {
    std::vector<int> places;
    for (const PendingPin& pin : pins_) places.push_back(pin.place);
    if (pin_waits_) places.push_back(*pin_waits_);
    return places;
}

void Session::on_ready(const std::function<void()>& ready) {
    ready_ = ready;
    worker_->on_ready(ready);
    estimator_->on_ready(ready);
    curves_worker_->on_ready(ready);
    sweep_job_->on_ready(ready);
    proof_job_->on_ready(ready);
    proof_behind_job_->on_ready(ready);
    sensitivities_job_->on_ready(ready);
    orbit_job_->on_ready(ready);
    for (const PendingPin& pin : pins_) pin.worker->on_ready(ready);
}

// Another run is about to start while one to be pinned is under way: that one continues on a worker of its own.
void Session::put_aside_pin() {
    if (!pin_waits_) return;
    if (!patience_) receive(patience_);
    if (!pin_waits_) return;
    pins_.push_back({*std::exchange(pin_waits_, std::nullopt), pin_requests_, requested_run_, std::move(worker_)});
    worker_ = std::make_unique<Runner>();
    if (ready_) worker_->on_ready(ready_);
    watch_.reset();
}

// Receives finished runs in the order of their requests.
void Session::receive_pins(Timeout patience) {
    std::erase_if(stopped_, [](const auto& worker) { return worker->take(0.0).has_value(); });
    while (!pins_.empty()) {
        try {
            const std::optional<std::shared_ptr<FinishedRun>> run = pins_.front().worker->take(patience);
            if (!run) return;
            pin(pins_.front().place, pins_.front().number, *run);
        } catch (const InputError& problem) {
            error_ = problem.what();
        } catch (const std::bad_alloc&) {
            error_ = "there is not enough memory to pin the run";
        }
        pins_.erase(pins_.begin());
        compose_pinned();
    }
}

// Cancels a pin. Its worker is kept until it has released the run, which may take time for a long one.
void Session::stop_pin(std::size_t i) {
    pins_[i].worker->start([](const std::stop_token&) { return std::shared_ptr<FinishedRun>(); });
    stopped_.push_back(std::move(pins_[i].worker));
    pins_.erase(pins_.begin() + static_cast<std::ptrdiff_t>(i));
}

void Session::cancel_pins() {
    pin_waits_.reset();
    while (!pins_.empty()) stop_pin(0);
}

// Drops the pinned runs when the system changes, since they cannot be compared.
void Session::drop_pinned_runs() {
    cancel_pins();
    if (pinned_.empty()) return;
    const bool one = pinned_.size() == 1;
    notice_ += fmt::format("{}{} of {} {} unpinned; undo restores {}", notice_.empty() ? "" : "; ",
                           one ? std::string("the pinned run") : fmt::format("{} pinned runs", pinned_.size()),
                           system_->name, one ? "was" : "were", one ? "it" : "them");
    pinned_.clear();
}

void Session::perform(const command::Unpin& command) {
    // A run still to be pinned counts as the one pinned last.
    if (const std::vector<int> waiting = pins_under_way();
        command.place > 0 ? waits_at(command.place) : !waiting.empty()) {
        const int place = command.place > 0 ? command.place : waiting.back();
        if (pin_waits_ == place) pin_waits_.reset();
        for (std::size_t i = pins_.size(); i-- > 0;)
            if (pins_[i].place == place) stop_pin(i);
        return;
    }
    if (command.place > 0 && pinned_at(command.place) == nullptr)
        throw refusal(fmt::format("there is no run pinned at {}", command.place));
    if (!pinned_.empty())
        pinned_.erase(pinned_.begin() + (command.place > 0 ? pinned_at(command.place) - pinned_.data()
                                                           : static_cast<std::ptrdiff_t>(pinned_.size()) - 1));
    compose_pinned();
}

void Session::perform(const command::UnpinAll&) {
    cancel_pins();
    pinned_.clear();
    compose_pinned();
}

void Session::perform(const command::ShowPinned& command) {
    if (pinned_at(command.place) == nullptr) throw refusal(fmt::format("there is no run pinned at {}", command.place));
    for (PinnedRun& run : pinned_)
        if (run.place == command.place) run.shown = command.shown;
    compose_pinned();
}

void Session::perform(const command::Recall& command) {
    const PinnedRun* const pinned = pinned_at(command.place);
    if (pinned == nullptr) throw refusal(fmt::format("there is no run pinned at {}", command.place));
    rerun(Run(pinned->trajectory->run));
}

// Recomputes everything that depends on runs, proof, plots and theme, once per change.
void Session::compose_pinned() {
    drawn_.clear();
    run_table_ = {};
    name_.clear();
    enclosed_ = shown_proof() == nullptr ? std::vector<const EnclosedEvent*>()
                                         : enclosed_events(trajectory(), shown_proof()->enclosure);
    const auto is_difference = [](const Plot& plot) { return plot.framing.difference; };
    if (pinned_.empty() && proof() == nullptr &&
        std::none_of(plots_.list().begin(), plots_.list().end(), is_difference))
        return;
    std::vector<const Run*> runs{&trajectory().run};
    std::vector<ShownRun> shown{{&trajectory(), error_estimate()}};
    for (const PinnedRun& run : pinned_) {
        runs.push_back(&run.trajectory->run);
        shown.push_back({run.trajectory.get(), *run.estimate ? &**run.estimate : nullptr});
    }
    const std::vector<std::string> names = names_of_runs(runs, description());
    name_ = names[0];
    std::vector<ComparedRun> compared;
    for (std::size_t i = 0; i < pinned_.size(); ++i) {
        PinnedRun& run = pinned_[i];
        run.name = names[i + 1];
        if (!run.shown) continue;
        const Mechanism& drawn = system_->mechanism;  // turned, the scene has the contacts
        if (run.touched.get() != &drawn || run.touched_size != limits().size) {
            run.touched = {system_, &drawn};
            run.touched_size = limits().size;
            run.touch = std::make_shared<const ContactGeometry>(drawn, *run.trajectory, run.touched_size);
        }
        if (run.revision != plots_.revision() || run.dark != theme_.dark || run.plots.size() != plots_.list().size())
            run.plots = plots_.compose(*run.trajectory, *run.samples, theme_, run.horizon());
        run.revision = plots_.revision();
        run.dark = theme_.dark;
        compared.push_back({run.trajectory.get(), run.name, run_color(theme_, run.place), run.horizon()});
    }
    // A run that was stopped has no results to compare.
    if (!pinned_.empty() && !shows_start()) run_table_ = achilles::run_table(shown);
    for (std::size_t i = 0; i < plots_.list().size() && i < plots().size(); ++i) {
        const Plot& plot = plots_.list()[i];
        std::vector<PinnedPanel> others;
        for (const PinnedRun& run : pinned_)
            if (run.shown) others.push_back({&run.plots[i], run.name, run.place});
        Panel own = plots()[i];
        if (proof() != nullptr)
            own = with_proof(std::move(own), trajectory(), *proof(), *plot.prepared, plot.framing, theme_);
        drawn_.push_back(plot.framing.difference
                             ? difference(trajectory(), compared, *plot.prepared, plot.framing, horizon())
                             : with_pinned(std::move(own), others, plot.framing, theme_));
        drawn_.back().title.clear();
    }
}

}  // namespace achilles
