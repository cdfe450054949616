// The runs that stay beside the present one, and what a session says of all of them.
#include <fmt/format.h>

#include <algorithm>

#include "figure/difference.hpp"
#include "session/refusal.hpp"
#include "session/session.hpp"

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
           alike(a.constraints, b.constraints, [](const ConstraintDescription& x, const ConstraintDescription& y) {
               return x.name == y.name && same_texts(x.gap, y.gap) && same_texts(x.restitution, y.restitution);
           });
}

const PinnedRun* Session::pinned_at(int place) const {
    const auto found =
        std::find_if(pinned_.begin(), pinned_.end(), [&](const PinnedRun& run) { return run.place == place; });
    return found == pinned_.end() ? nullptr : &*found;
}

void Session::perform(const command::Pin& command) {
    const auto same =
        std::find_if(pinned_.begin(), pinned_.end(), [&](const PinnedRun& p) { return p.trajectory->run == asked_; });
    if (same != pinned_.end()) throw refusal(fmt::format("this run is pinned already, as {}", same->place));
    if (pinned_.size() >= most_pinned)
        throw refusal(fmt::format("{} runs are pinned, and more cannot be told apart", most_pinned),
                      "let one go first: unpin 1, or: unpin all");
    int place = command.place;
    if (place > most_pinned)
        throw refusal(fmt::format("there is no place {} for a run: there are {}", place, most_pinned));
    if (place > 0 && pinned_at(place) != nullptr)
        throw refusal(fmt::format("there is a run pinned at {}", place), fmt::format("unpin {} first, or: pin", place));
    if (place == 0)
        for (place = 1; pinned_at(place) != nullptr;) ++place;
    scene_.perform(command::Show{"runs", true});
    if (watch_ != nullptr) {  // nothing is said of a run that is not there
        pin_waits_ = place;
        return;
    }
    pin(place);
    compose_pinned();
}

// The run that is shown. Throws InputError where all of them would need more memory than one run may.
void Session::pin(int place) {
    double bytes = bytes_of(simulated_->trajectory);
    for (const PinnedRun& run : pinned_) bytes += bytes_of(*run.trajectory);
    if (const double most = simulated_->trajectory.run.options.memory; bytes > most)
        throw refusal(
            fmt::format("the pinned runs would take {:.4g} MB, and memory is {:.4g} MB", bytes / 1e6, most / 1e6),
            fmt::format("let one go (unpin), or allow more: memory {:.1g}", 2.0 * bytes));
    const std::shared_ptr<Simulated>& all = simulated_;
    PinnedRun run;
    run.place = place;
    run.trajectory = {all, &all->trajectory};
    run.sampler = {all, &all->sampler};
    run.samples = {all, &all->samples};
    pinned_.push_back(std::move(run));
}

// Another run takes the place of one that is to be pinned when it is there: so long it may take.
void Session::await_pin() {
    if (!pin_waits_) return;
    constexpr double longest = 5.0;
    receive(patience_ ? Patience(longest) : Patience());
    if (pin_waits_.has_value()) warn("the run that was to be pinned was not finished, and is not pinned");
    pin_waits_.reset();
}

// A run of another system is nothing to compare with.
void Session::let_go() {
    pin_waits_.reset();
    if (pinned_.empty()) return;
    const bool one = pinned_.size() == 1;
    notice_ += fmt::format("{}{} of {} {} let go; undo brings {} back", notice_.empty() ? "" : "; ",
                           one ? std::string("the pinned run") : fmt::format("{} pinned runs", pinned_.size()),
                           system_->name, one ? "is" : "are", one ? "it" : "them");
    pinned_.clear();
}

void Session::perform(const command::Unpin& command) {
    pin_waits_.reset();
    if (command.place > 0 && pinned_at(command.place) == nullptr)
        throw refusal(fmt::format("there is no run pinned at {}", command.place));
    if (!pinned_.empty())
        pinned_.erase(pinned_.begin() + (command.place > 0 ? pinned_at(command.place) - pinned_.data()
                                                           : static_cast<std::ptrdiff_t>(pinned_.size()) - 1));
    compose_pinned();
}

void Session::perform(const command::UnpinAll&) {
    pin_waits_.reset();
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

// What follows from the runs, the plots and the theme, once for each change of them.
void Session::compose_pinned() {
    drawn_.clear();
    run_table_ = {};
    name_.clear();
    const auto is_difference = [](const Plot& plot) { return plot.framing.difference; };
    if (pinned_.empty() && std::none_of(plots_.list().begin(), plots_.list().end(), is_difference)) return;
    std::vector<const Run*> runs{&trajectory().run};
    std::vector<const Trajectory*> trajectories{&trajectory()};
    for (const PinnedRun& run : pinned_) {
        runs.push_back(&run.trajectory->run);
        trajectories.push_back(run.trajectory.get());
    }
    const std::vector<std::string> names = names_of_runs(runs, description());
    name_ = names[0];
    std::vector<ComparedRun> compared;
    for (std::size_t i = 0; i < pinned_.size(); ++i) {
        PinnedRun& run = pinned_[i];
        run.name = names[i + 1];
        if (!run.shown) continue;
        run.touch = std::make_shared<const Touch>(mechanism(), *run.trajectory, limits().size);
        if (run.revision != plots_.revision() || run.dark != theme_.dark || run.plots.size() != plots_.list().size())
            run.plots = plots_.compose(*run.trajectory, *run.samples, theme_);
        run.revision = plots_.revision();
        run.dark = theme_.dark;
        compared.push_back({run.trajectory.get(), run.name, run_color(theme_, run.place)});
    }
    // Of a run that was told to stop there is nothing to compare.
    if (!pinned_.empty() && trajectory().outcome.kind != Outcome::Kind::cancelled)
        run_table_ = achilles::run_table(trajectories);
    for (std::size_t i = 0; i < plots_.list().size() && i < plots().size(); ++i) {
        const Plot& plot = plots_.list()[i];
        std::vector<PinnedPanel> others;
        for (const PinnedRun& run : pinned_)
            if (run.shown) others.push_back({&run.plots[i], run.name, run.place});
        drawn_.push_back(plot.framing.difference ? difference(trajectory(), compared, *plot.prepared, plot.framing)
                                                 : with_pinned(plots()[i], others, plot.framing, theme_));
        drawn_.back().title.clear();
    }
}

}  // namespace achilles
