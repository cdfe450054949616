// How the mechanism is looked at and how time passes. A value: it knows no run.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "figure/camera.hpp"
#include "session/command.hpp"

namespace achilles {

class Scene {
 public:
    CameraMode camera() const { return camera_; }
    // Of a fixed camera the part of the world in the middle of the picture; nothing: all that the run needs, or what another
    // camera chooses.
    std::optional<command::Look> look() const { return camera_ == CameraMode::fixed ? look_ : std::nullopt; }
    // "trail", "velocity" and "force" of the body, the panels "controls", "plots", "events", "editor", "equations" and
    // "energy", the Zeno "lens" in place of the plots, the table of the pinned "runs" beside the events, where there are any.
    bool shows(const std::string& what) const { return shown_.contains(what); }
    // What stands at the place of the events: one of command::shown_below, else "events"; empty: nothing.
    std::string below() const;
    double speed() const { return speed_; }  // seconds of the run in one of the player's
    bool loops() const { return loops_; }
    // What the configuration plane shows; nothing: what it has by default.
    const std::optional<command::ShowPlane>& plane() const { return plane_; }
    // The sweep that is shown, as its command has it; nothing: what it is by default.
    const std::optional<std::string>& sweep() const { return sweep_; }
    // The quantity whose derivatives are shown, as its command has it; nothing: what it is by default.
    const std::optional<std::string>& depends() const { return depends_; }
    // The left edge of the Zeno lens; nothing: where the row begins.
    const std::optional<double>& lens() const { return lens_; }
    const std::string& finds() const { return finds_; }      // letters that the palette opens with
    const std::string& caption() const { return caption_; }  // what a tour says; empty: nothing

    const std::string& highlight() const { return highlight_; }  // the panel that it is about; empty: none

    // The share of the window that the user gave a panel; 0: as it fits.
    double share(const std::string& panel) const;

    double enlarged() const { return enlarged_; }  // as the user wants it
    bool presents() const { return presents_; }
    // What the scale of a surface so wide and high (pixels at that scale) is multiplied by: so large, and larger for a class,
    // the more so the larger the surface: from the last row it is as small as any.
    double text_scale(double width, double height) const;

    // Each throws InputError and changes nothing where it makes no sense.
    void perform(const command::Look& command);
    void perform(const command::LookAll& command);
    void perform(const command::Camera& command);
    void perform(const command::Show& command);
    void perform(const command::DefaultPlane& command);
    void perform(const command::ShowPlane& command);       // of a system that has what it names
    void perform(const command::ShowSweep& command);       // that can be one of the system
    void perform(const command::ShowDependence& command);  // that can be one of the system
    void perform(const command::Find& command);
    void perform(const command::Speed& command);
    void perform(const command::Loop& command);
    void perform(const command::Lens& command);
    void perform(const command::Size& command);
    void perform(const command::Say& command);
    void perform(const command::Highlight& command);
    void perform(const command::Enlarge& command);
    void perform(const command::Present& command);

    // Another system: another world, but the same taste.
    void forget_place();
    // Another text, which has not what they name.
    void forget_plane() { plane_.reset(); }
    void forget_sweep() { sweep_.reset(); }
    void forget_dependence() { depends_.reset(); }

 private:
    CameraMode camera_ = CameraMode::fit;
    std::optional<command::Look> look_;  // where a fixed camera looked last
    friend std::vector<Command> steps_to(const Scene& scene);
    std::set<std::string> shown_{"trail", "velocity", "force", "controls", "plots", "events", "runs"};
    double speed_ = 1.0;
    bool loops_ = false;
    std::optional<command::ShowPlane> plane_;
    std::optional<std::string> sweep_, depends_;
    std::optional<double> lens_;
    std::map<std::string, double> shares_;
    std::string caption_, highlight_, finds_;
    double enlarged_ = 1.0;
    bool presents_ = false;
};

// What leads from a new scene to this one, but for the lens, which needs a Zeno point to look at.
std::vector<Command> steps_to(const Scene& scene);

// What is not as at the beginning, for the session's text.
std::string to_text(const Scene& scene);

}  // namespace achilles
