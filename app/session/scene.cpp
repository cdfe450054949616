#include "session/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "expression/name_suggestions.hpp"
#include "session/command.hpp"

namespace achilles {

void Scene::perform(const command::LookAt& command) {
    if (!(command.width > 0.0) || !std::isfinite(command.x) || !std::isfinite(command.y) ||
        !std::isfinite(command.width))
        throw refusal(fmt::format("a view {} wide cannot be shown", command.width));
    look_ = command;
    camera_ = CameraMode::fixed;
}

void Scene::perform(const command::LookAll&) {
    look_.reset();
    camera_ = CameraMode::fit;
}

void Scene::perform(const command::SetCamera& command) {
    const auto mode = camera_mode_from(command.mode);
    if (!mode)
        throw refusal(
            fmt::format("there is no camera '{}'{}", command.mode, did_you_mean(command.mode, command::camera_modes)));
    if (*mode == CameraMode::fixed && !look_)
        throw refusal("camera fixed: no view has been chosen yet", "use look X Y WIDTH, or the mouse wheel");
    camera_ = *mode;
    if (camera_ == CameraMode::fit) look_.reset();
}

void Scene::perform(const command::Turn& command) {
    if (!(std::abs(command.about) <= 360.0) || !(std::abs(command.tilt) <= 90.0))
        throw refusal(fmt::format("a system cannot be turned by {} and {} degrees", command.about, command.tilt),
                      "use -360 to 360 about the vertical, and a tilt from -90 to 90");
    direction_ = {command.about, command.tilt};
}

void Scene::forget_place() {
    look_.reset();
    direction_.reset();
    if (camera_ == CameraMode::fixed) camera_ = CameraMode::fit;
    lens_.reset();
    plane_.reset();
    sweep_.reset();
    depends_.reset();
    lecture_sliders_.clear();
}

void Scene::perform(const command::DefaultPlane&) {
    plane_.reset();
    shown_.insert("plane");
}

void Scene::perform(const command::ShowPlane& command) {
    plane_ = command;
    shown_.insert("plane");
}

void Scene::perform(const command::ShowSweep& command) {
    sweep_ = command.text;
    perform(command::Show{"sweep", true});
}

void Scene::perform(const command::ShowSensitivity& command) {
    depends_ = command.quantity;
    perform(command::Show{"depend", true});
}

void Scene::perform(const command::Show& command) {
    const auto& things = command::shown_things;
    if (std::find(things.begin(), things.end(), command.what) == things.end())
        throw refusal(fmt::format("there is no '{}' to show{}", command.what, did_you_mean(command.what, things)));
    if (command.what == "mechanism" && !command.on)
        throw refusal("the mechanism cannot be hidden", "a panel can: hide plots");
    if (std::find(command::tabs.begin(), command::tabs.end(), command.what) != command::tabs.end()) {
        if (command.on) front_ = command.what;
        if (!command.on && front_ == command.what) front_ = "mechanism";
    }
    // Only one card at a time covers the window.
    const auto is_card = [](const std::string& what) {
        return what == "help" || what == "palette" || what == "gallery" || what == "export";
    };
    if (command.on && is_card(command.what)) std::erase_if(shown_, is_card);
    if (command.what == "palette") finds_.clear();
    const auto& studies = command::studies;
    if (command.on && std::find(studies.begin(), studies.end(), command.what) != studies.end())
        for (const std::string& other : studies) shown_.erase(other);
    if (command.on)
        shown_.insert(command.what);
    else
        shown_.erase(command.what);
}

std::string Scene::below() const {
    for (const std::string& what : command::studies)
        if (shows(what)) return what;
    return shows("events") ? "events" : "";
}

void Scene::perform(const command::Find& command) {
    perform(command::Show{"palette", true});
    finds_ = command.text;
}

void Scene::perform(const command::Speed& command) {
    if (!(command.value >= command::slowest && command.value <= command::fastest))
        throw refusal(fmt::format("the playback speed must be from {} to {} times real time, not {}", command::slowest,
                                  command::fastest, command.value));
    speed_ = command.value;
}

void Scene::perform(const command::Loop& command) { loops_ = command.on; }

void Scene::perform(const command::ShowLens& command) {
    lens_ = std::clamp(command.from, -100.0, 1e9);
    front_ = "plots";
    shown_.insert("lens");
}

double Scene::share(const std::string& panel) const {
    const auto found = shares_.find(panel);
    return found == shares_.end() ? 0.0 : found->second;
}

void Scene::perform(const command::SetPanelSize& command) {
    if (!(command.share >= 0.0 && command.share < 1.0))
        throw refusal(fmt::format("a panel cannot take {} of the window", command.share));
    // Journals from when the sweep had a panel of its own.
    shares_[command.panel == "sweep" ? "events" : command.panel] = command.share;
}

// A highlight ends with its caption.
void Scene::perform(const command::Say& command) { caption_ = command.text, highlight_.clear(); }

void Scene::perform(const command::Highlight& command) {
    highlight_ = command.panel == "none" ? std::string() : command.panel;
    if (shows(highlight_) && std::find(command::tabs.begin(), command::tabs.end(), highlight_) != command::tabs.end())
        front_ = highlight_;  // a tour speaks of it
}

void Scene::perform(const command::Enlarge& command) {
    if (!(command.value >= command::smallest && command.value <= command::largest))
        throw refusal(fmt::format("the size must be from {} to {} times the default, not {}", command::smallest,
                                  command::largest, command.value));
    enlarged_ = command.value;
}

void Scene::perform(const command::Present& command) {
    presents_ = command.on;
    lecture_sliders_ = command.sliders;
}

double Scene::text_scale(double width, double height) const {
    constexpr double least = 1.5, presented_width = 900.0, presented_height = 520.0;
    return enlarged_ *
           (presents_ ? std::max(least, std::min(width / presented_width, height / presented_height)) : 1.0);
}

std::vector<Command> steps_to(const Scene& scene) {
    std::vector<Command> steps;
    if (scene.look_) steps.emplace_back(*scene.look_);
    if (scene.camera() != (scene.look_ ? CameraMode::fixed : CameraMode::fit))
        steps.emplace_back(command::SetCamera{std::string(to_text(scene.camera()))});
    if (const auto& from = scene.direction()) steps.emplace_back(command::Turn{from->about, from->tilt});
    Scene before;
    if (scene.plane()) before.perform(*scene.plane()), steps.emplace_back(*scene.plane());
    if (scene.sweep())
        before.perform(command::ShowSweep{*scene.sweep()}), steps.emplace_back(command::ShowSweep{*scene.sweep()});
    if (const auto& quantity = scene.depends()) {
        steps.emplace_back(command::ShowSensitivity{*quantity});
        before.perform(command::ShowSensitivity{*quantity});
    }
    const auto show = [&](const std::string& thing, bool on) {
        steps.emplace_back(command::Show{thing, on});
        before.perform(command::Show{thing, on});
    };
    for (const std::string& thing : command::shown_things)
        if (thing != "export" && scene.shows(thing) != before.shows(thing)) show(thing, scene.shows(thing));
    if (before.front() != scene.front()) show(scene.front(), true);
    if (!scene.finds().empty()) steps.emplace_back(command::Find{scene.finds()});
    if (scene.speed() != Scene().speed()) steps.emplace_back(command::Speed{scene.speed()});
    if (scene.loops()) steps.emplace_back(command::Loop{true});
    for (const std::string& panel : command::sized_panels)
        if (scene.share(panel) > 0.0) steps.emplace_back(command::SetPanelSize{panel, scene.share(panel)});
    if (scene.enlarged() != 1.0) steps.emplace_back(command::Enlarge{scene.enlarged()});
    if (scene.presents()) steps.emplace_back(command::Present{true, scene.lecture_sliders()});
    if (!scene.caption().empty()) steps.emplace_back(command::Say{scene.caption()});
    if (!scene.highlight().empty()) steps.emplace_back(command::Highlight{scene.highlight()});
    return steps;
}

std::string to_text(const Scene& scene) {
    std::string text;
    if (const auto& look = scene.look())
        text += fmt::format("look {:.9g} {:.9g} {:.9g}\n", look->x, look->y, look->width);
    if (scene.camera() == CameraMode::follow || scene.camera() == CameraMode::zeno)
        text += fmt::format("camera {}\n", to_text(scene.camera()));
    if (const auto& from = scene.direction()) text += fmt::format("turn {:.9g} {:.9g}\n", from->about, from->tilt);
    // The session's text has the edited text itself instead.
    for (const std::string& thing : command::shown_things)
        if (thing != "editor" && scene.shows(thing) != Scene().shows(thing))
            text += fmt::format("{} {}\n", scene.shows(thing) ? "show" : "hide", thing);
    if (scene.front() != Scene().front()) text += fmt::format("front {}\n", scene.front());
    if (const auto& plane = scene.plane()) text += fmt::format("plane {} | {}\n", plane->x, plane->y);
    if (scene.sweep()) text += fmt::format("sweep {}\n", *scene.sweep());
    if (scene.depends()) text += fmt::format("depend {}\n", *scene.depends());
    for (const std::string& panel : command::sized_panels)
        if (const double share = scene.share(panel); share > 0.0) text += fmt::format("size {} {:.9g}\n", panel, share);
    if (scene.speed() != 1.0) text += fmt::format("speed {:.9g}\n", scene.speed());
    if (scene.lens()) text += fmt::format("lens {:.9g}\n", *scene.lens());
    if (scene.loops()) text += "loop on\n";
    if (scene.enlarged() != 1.0) text += fmt::format("enlarge {:.9g}\n", scene.enlarged());
    if (scene.presents()) text += to_text(command::Present{true, scene.lecture_sliders()}) + "\n";
    if (!scene.finds().empty()) text += fmt::format("finds {}\n", scene.finds());
    if (!scene.caption().empty()) text += fmt::format("says {}\n", scene.caption());
    if (!scene.highlight().empty()) text += fmt::format("highlights {}\n", scene.highlight());
    return text;
}

}  // namespace achilles
