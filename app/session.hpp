// The state of the explorer: one system, one run of it, and where its player stands. apply() is the only door.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "figure/compose.hpp"
#include "figure/mechanism.hpp"
#include "trajectory.hpp"

namespace achilles {

// How a session finds a system by what `open` says. Throws InputError.
using Opener = std::function<SystemDescription(const std::string& system)>;

class Session {
 public:
    // Opens `first`, known as `name`. Throws InputError if it cannot be derived or cannot start.
    Session(const std::string& name, const SystemDescription& first, Opener opener);

    // Does what the command says. What cannot be done leaves everything as it was but error().
    void apply(const Command& command);

    const std::string& system() const { return system_->name; }  // as opened
    const std::shared_ptr<const Model>& model() const { return system_->model; }
    const SystemDescription& description() const { return system_->model->description(); }
    const Run& run() const { return motion_->trajectory.run; }
    // Of a parameter, a coordinate's start x or its rate x'; nothing if there is no such name.
    std::optional<double> value(const std::string& name) const;
    const Trajectory& trajectory() const { return motion_->trajectory; }
    const Mechanism& mechanism() const { return system_->mechanism; }
    // The world the mechanism needs during the whole run.
    const Drawing& limits() const { return motion_->limits; }
    // The first views of the system, at most four, composed.
    const std::vector<Panel>& plots() const { return motion_->plots; }
    // Where the present stands in such a plot, in its units, one point a curve.
    std::vector<Point> present(std::size_t plot) const;

    double time() const { return time_; }
    const Sample& now() const { return now_; }  // the state at that time
    bool playing() const { return playing_; }
    int selected() const { return selected_; }           // an event's number, from 1; 0: none
    const std::string& error() const { return error_; }  // why the last command was refused; empty: it was not
    const Theme& theme() const { return theme_; }

 private:
    // A system derived and compiled: nothing here depends on a parameter's value.
    struct System {
        System(const std::string& name, const SystemDescription& description);
        std::string name;
        std::shared_ptr<const Model> model;
        Mechanism mechanism;
        std::vector<PreparedView> views;
    };
    // One run and what is shown of it.
    struct Motion {
        Motion(const System& system, const Run& run, const Theme& theme);
        Trajectory trajectory;
        Trajectory without_events;  // of the same model and run
        Sampler sampler;
        Drawing limits;
        std::vector<Panel> plots;
    };

    void perform(const command::Open& command);
    void perform(const command::Set& command);
    void perform(const command::End& command);
    void perform(const command::Tolerance& command);
    void perform(const command::Eps& command);
    void perform(const command::UseConditions& command);
    void perform(const command::UseReinitialization& command);
    void perform(const command::Seek& command);
    void perform(const command::Play& command);
    void perform(const command::Pause& command);
    void perform(const command::Select& command);
    void rerun(const Run& run);
    void move_to(double time);

    Opener opener_;
    Theme theme_ = light_theme();
    std::shared_ptr<const System> system_;
    std::shared_ptr<Motion> motion_;
    Sample now_;
    double time_ = 0.0;
    bool playing_ = false;
    int selected_ = 0;
    std::string error_;
};

// Lets so much time pass for a session that plays. At the end it stops, or with `loop` begins again.
void play_on(Session& session, double seconds, bool loop);

// The session as text: what tests compare.
std::string to_text(const Session& session);

}  // namespace achilles
