// Playback position, selected event and the lens on it, animation of a value, and the lecture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "model/model.hpp"
#include "session/command.hpp"
#include "session/session.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

constexpr double frames_per_second = 60.0;  // of the playback, for steps by one frame

}  // namespace

void Session::perform(const command::Seek& command) {
    move_to(command.time);
    place(command);
    const double start = run().options.start_time, end = trajectory().end_time;
    if (under_way() == nullptr && !(command.time >= start && command.time <= end))
        warn(fmt::format("seek {}: the run {} at t = {} s", command.time, command.time < start ? "begins" : "ends",
                         command.time < start ? start : end));
}

void Session::perform(const command::Play&) {
    // Play at the end restarts from the beginning.
    if (time_ >= trajectory().end_time) move_to(run().options.start_time);
    playing_ = true;
}

void Session::perform(const command::Pause&) { playing_ = false; }

void Session::perform(const command::Select& command) {
    const auto& events = trajectory().events;
    if (command.event < 0 || static_cast<std::size_t>(command.event) > events.size())
        throw refusal(fmt::format("there is no event {}: this run has events 1 to {}", command.event, events.size()));
    choose(command.event);
    place(command);
}

// Selects an event, or none (0), and moves the time to it.
void Session::choose(int event) {
    selected_ = event;
    meaning_.reset();
    if (event == 0) return;
    const auto index = static_cast<std::size_t>(event - 1);
    meaning_ = meaning_of(trajectory(), index);
    move_to(trajectory().events[index].t);
}

// A changed run keeps the selected event by its meaning, and the time goes with it if it was there; or lets it go.
void Session::keep_choice(bool is_at_event) {
    const auto found = meaning_ ? find_event(trajectory(), *meaning_) : std::nullopt;
    const double before = time_;
    choose(found ? static_cast<int>(*found) + 1 : 0);
    if (!found || !is_at_event) move_to(before);
}

const Event* Session::selected_zeno() const {
    if (selected_ == 0) return nullptr;
    const Event& event = trajectory().events[static_cast<std::size_t>(selected_ - 1)];
    return event.is_zeno() ? &event : nullptr;
}

// The lens needs a Zeno point to look at.
void Session::perform(const command::ShowLens& command) {
    if (selected_zeno() == nullptr) {
        const auto& events = trajectory().events;
        const auto first =
            std::find_if(events.begin(), events.end(), [](const Event& event) { return event.is_zeno(); });
        throw refusal("the lens needs a Zeno point, but none is selected",
                      first == events.end() ? "this run has no Zeno point"
                                            : fmt::format("select it first: select {}", first - events.begin() + 1));
    }
    scene_.perform(command);
}

// While a run is under way: remember what to repeat on its result.
void Session::place(const Command& command) {
    if (watch_ != nullptr) placed_ = command;
}

void Session::move_to(double time) {
    time_ = std::clamp(time, run().options.start_time, trajectory().end_time);
    now_ = simulated_->sampler.at(time_);
}

// Selects the event, or the Zeno point, this many steps later or earlier; beyond the last one goes to the end or the
// start of the run.
void Session::step_to_event(int steps, bool is_zeno) {
    const auto& events = trajectory().events;
    const auto here = [&](bool after) {
        const auto is_before = [&](const Event& event) { return after ? event.t <= time_ : event.t < time_; };
        return std::partition_point(events.begin(), events.end(), is_before) - events.begin();
    };
    // From the selected event, so that several at one time are passed one by one.
    const bool is_at_event = selected_ > 0 && events[static_cast<std::size_t>(selected_ - 1)].t == time_;
    std::ptrdiff_t next =
        steps > 0 ? (is_at_event ? selected_ : here(true)) : (is_at_event ? selected_ - 1 : here(false)) - 1;
    const std::ptrdiff_t step = steps > 0 ? 1 : -1;
    for (int left = std::abs(steps); next >= 0 && next < std::ssize(events); next += step) {
        const bool counts = !is_zeno || is_zeno_point(events[static_cast<std::size_t>(next)]);
        if (counts && --left == 0) break;
    }
    const bool is_event = next >= 0 && next < std::ssize(events);
    choose(is_event ? static_cast<int>(next) + 1 : 0);
    if (!is_event) move_to(steps > 0 ? trajectory().end_time : run().options.start_time);
    place(is_event ? Command(command::Select{selected_}) : Command(command::Seek{time_}));
}

// Goes to the next event or the last one before the current time; beyond those, to the end or the start.
void Session::perform(const command::StepEvents& command) {
    const auto& events = trajectory().events;
    const double start = run().options.start_time;
    double time = time_;
    if (command.what == "frame") {
        choose(0);
        move_to(time_ + command.events * scene_.speed() / frames_per_second);
        return place(command::Seek{time_});
    }
    if (!command.what.empty()) return step_to_event(command.events, command.what == "zeno");
    for (int i = 0; i < std::abs(command.events); ++i) {
        if (time == (command.events > 0 ? trajectory().end_time : start)) break;
        const auto later = std::upper_bound(events.begin(), events.end(), time,
                                            [](double t, const Event& event) { return t < event.t; });
        const auto here = std::lower_bound(events.begin(), events.end(), time,
                                           [](const Event& event, double t) { return event.t < t; });
        if (command.events > 0)
            time = later != events.end() ? later->t : trajectory().end_time;
        else
            time = here != events.begin() ? std::prev(here)->t : start;
    }
    move_to(time);
    place(command::Seek{time});
}

// Sets a value without an undo step of its own: the whole animation is one. Returns false if it is refused.
bool Session::vary(const std::string& name, double value) {
    error_.clear();
    try {
        perform(command::SetStart{{{name, value}}});
        follow_studies();
        return true;
    } catch (const PermissionDenied&) {
        throw;
    } catch (const InputError& problem) {
        error_ = problem.what();
        return false;
    }
}

// Sets the value where the animation has come to. A run that takes longer than a frame is waited for, so that every
// picture is of a finished run.
void Session::animate(double seconds) {
    if (!animation_ || under_way() != nullptr) return;
    Animation now = *animation_;
    now.elapsed = std::min(now.elapsed + seconds, now.seconds);
    const double share = now.elapsed / now.seconds;
    const bool is_possible = vary(now.name, now.from + share * (now.to - now.from));
    if (!is_possible || share >= 1.0)
        animation_.reset();
    else
        animation_ = now;
}

void Session::perform(const command::Present& command) {
    constexpr std::size_t most_sliders = 3;
    if (command.sliders.size() > most_sliders) throw refusal("a lecture shows at most three sliders");
    for (const std::string& name : command.sliders)
        if (!value(name)) throw refusal(why_not_settable(description(), name));
    scene_.perform(command);
}

void play_on(Session& session, double seconds) {
    session.animate(seconds);
    if (!session.playing()) return;
    session.apply(
        command::Seek{std::min(session.time() + seconds * session.scene().speed(), session.trajectory().end_time)});
    if (session.time() < session.trajectory().end_time || session.under_way() != nullptr) return;
    if (session.scene().loops())
        session.apply(command::Play{});  // restart at the end
    else
        session.apply(command::Pause{});
}

}  // namespace achilles
