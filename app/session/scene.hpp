// View state: camera, playback, visible panels and layers. A plain value, independent of any run.
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
    // View of a fixed camera. Empty: the whole extent of the run, or the view that another camera mode computes.
    std::optional<command::LookAt> look() const { return camera_ == CameraMode::fixed ? look_ : std::nullopt; }
    // The direction from which a system in space is seen; empty: as its file draws it.
    const std::optional<ViewAngles>& direction() const { return direction_; }
    // True if `what`, one of command::shown_things, is visible.
    bool shows(const std::string& what) const { return shown_.contains(what); }
    // The panel at the place of the events: one of command::studies, or "events"; empty: none.
    std::string below() const;
    // The panel shown last, one of command::tabs: in front if the window is too small for all.
    const std::string& front() const { return front_; }
    double speed() const { return speed_; }  // simulated seconds per second of playback
    bool loops() const { return loops_; }
    // The axes of the configuration plane; empty: the default.
    const std::optional<command::ShowPlane>& plane() const { return plane_; }
    // The arguments of the sweep command; empty: the default sweep.
    const std::optional<std::string>& sweep() const { return sweep_; }
    // The quantity whose derivatives are shown; empty: the default quantity.
    const std::optional<std::string>& depends() const { return depends_; }
    // The left edge of the Zeno lens; empty: the start of the impact sequence.
    const std::optional<double>& lens() const { return lens_; }
    const std::string& finds() const { return finds_; }      // initial search text of the palette
    const std::string& caption() const { return caption_; }  // caption of a tour; empty: none

    const std::string& highlight() const { return highlight_; }  // framed panel; empty: none

    // The share of the window set by the user for a panel; 0: automatic.
    double share(const std::string& panel) const;

    double enlarged() const { return enlarged_; }  // interface scale set by the user
    bool presents() const { return presents_; }
    // The sliders chosen for the lecture; empty: those that differ from the file.
    const std::vector<std::string>& lecture_sliders() const { return lecture_sliders_; }
    // Scale factor for a surface of this width and height (pixels at that scale). Includes the user's factor. In
    // presentation mode it grows with the surface, so that text stays readable from the last row.
    double text_scale(double width, double height) const;

    // Each applies a command. Throws InputError and changes nothing if the command is invalid.
    void perform(const command::LookAt& command);
    void perform(const command::LookAll& command);
    void perform(const command::SetCamera& command);
    void perform(const command::TurnBack&) { direction_.reset(); }
    void perform(const command::Turn& command);  // the caller has checked that the system is one in space
    void perform(const command::Show& command);
    void perform(const command::DefaultPlane& command);
    void perform(const command::ShowPlane& command);        // the caller has checked the names it uses
    void perform(const command::ShowSweep& command);        // the caller has checked that the system allows it
    void perform(const command::ShowSensitivity& command);  // the caller has checked that the system allows it
    void perform(const command::Find& command);
    void perform(const command::Speed& command);
    void perform(const command::Loop& command);
    void perform(const command::ShowLens& command);
    void perform(const command::SetPanelSize& command);
    void perform(const command::Say& command);
    void perform(const command::Highlight& command);
    void perform(const command::Enlarge& command);
    void perform(const command::Present& command);

    // Resets what depends on the world of a system, such as the view, and keeps preferences.
    void forget_place();
    // Reset settings that use names missing from an edited text.
    void forget_direction() { direction_.reset(); }
    void forget_plane() { plane_.reset(); }
    void forget_sweep() { sweep_.reset(); }
    void forget_dependence() { depends_.reset(); }

 private:
    CameraMode camera_ = CameraMode::fit;
    std::optional<command::LookAt> look_;  // the last view of a fixed camera
    std::optional<ViewAngles> direction_;
    friend std::vector<Command> steps_to(const Scene& scene);
    std::set<std::string> shown_{"trail", "velocity", "force", "mechanism", "controls", "plots", "events", "runs"};
    std::string front_ = "mechanism";
    double speed_ = 1.0;
    bool loops_ = false;
    std::optional<command::ShowPlane> plane_;
    std::optional<std::string> sweep_, depends_;
    std::optional<double> lens_;
    std::map<std::string, double> shares_;
    std::string caption_, highlight_, finds_;
    double enlarged_ = 1.0;
    bool presents_ = false;
    std::vector<std::string> lecture_sliders_;
};

// Commands that lead from a new scene to this one, except the lens, which needs a Zeno point.
std::vector<Command> steps_to(const Scene& scene);

// Text form of everything that differs from a new scene, part of to_text(Session).
std::string to_text(const Scene& scene);

}  // namespace achilles
