// Where the player of a session stands: its time, the event it has chosen, and the lens on that.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "session/refusal.hpp"
#include "session/session.hpp"

namespace achilles {

void Session::perform(const command::Seek& command) {
    move_to(command.time);
    place(command);
    const double start = run().options.start_time, end = trajectory().end_time;
    if (under_way() == nullptr && !(command.time >= start && command.time <= end))
        warn(fmt::format("seek {}: the run {} at t = {} s", command.time, command.time < start ? "begins" : "ends",
                         command.time < start ? start : end));
}

void Session::perform(const command::Play&) {
    // Play at the end means: once more.
    if (time_ >= trajectory().end_time) move_to(run().options.start_time);
    playing_ = true;
}

void Session::perform(const command::Pause&) { playing_ = false; }

void Session::perform(const command::Select& command) {
    const auto& events = trajectory().events;
    if (command.event < 0 || static_cast<std::size_t>(command.event) > events.size())
        throw refusal(fmt::format("there is no event {}: this run has {}", command.event, events.size()));
    selected_ = command.event;
    if (selected_ > 0) move_to(events[static_cast<std::size_t>(selected_ - 1)].t);
    place(command);
}

const Event* Session::selected_zeno() const {
    if (selected_ == 0) return nullptr;
    const Event& event = trajectory().events[static_cast<std::size_t>(selected_ - 1)];
    return event.kind == Event::Kind::zeno ? &event : nullptr;
}

// The lens looks at a Zeno point: without one nothing would be seen of it.
void Session::perform(const command::Lens& command) {
    if (selected_zeno() == nullptr) {
        const auto& events = trajectory().events;
        const auto first = std::find_if(events.begin(), events.end(),
                                        [](const Event& event) { return event.kind == Event::Kind::zeno; });
        throw refusal("the lens needs a Zeno point, but none is selected",
                      first == events.end() ? "this run has no Zeno point"
                                            : fmt::format("select it first: select {}", first - events.begin() + 1));
    }
    scene_.perform(command);
}

// While a run is under way: what is to be done again on its result.
void Session::place(const Command& command) {
    if (watch_ != nullptr) placed_ = command;
}

void Session::move_to(double time) {
    time_ = std::clamp(time, run().options.start_time, trajectory().end_time);
    now_ = simulated_->sampler.at(time_);
}

// The next event after the present, or the last before it; beyond them the end and the start.
void Session::perform(const command::Step& command) {
    const auto& events = trajectory().events;
    const double start = run().options.start_time;
    double time = time_;
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

void play_on(Session& session, double seconds) {
    if (!session.playing()) return;
    session.apply(
        command::Seek{std::min(session.time() + seconds * session.scene().speed(), session.trajectory().end_time)});
    if (session.time() < session.trajectory().end_time || session.under_way() != nullptr) return;
    if (session.scene().loops())
        session.apply(command::Play{});  // at the end: once more
    else
        session.apply(command::Pause{});
}

}  // namespace achilles
