#include "pictures/thumbnails.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "figure/compose.hpp"
#include "figure/mechanism_scene.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

constexpr double thumbnail_shape = 2.3;  // width over height of the widest card; the ground extends to its sides

// Time of the first Zeno point; else a third of the run.
double representative_time(const Trajectory& trajectory) {
    const auto zeno = std::find_if(trajectory.events.begin(), trajectory.events.end(),
                                   [](const Event& event) { return event.is_zeno(); });
    const double start = trajectory.run.options.start_time;
    return zeno != trajectory.events.end() ? zeno->t : start + (trajectory.end_time - start) / 3.0;
}

Thumbnail drawn(const std::filesystem::path& system) {
    const auto model = std::make_shared<const Model>(read_system(system));
    Run run = model->default_run();
    run.options.max_impacts = std::min(run.options.max_impacts, 2000);  // limits the computing time
    const Trajectory trajectory = simulate(model, run);
    const Mechanism mechanism(*model);
    if (mechanism.is_empty()) return {};
    const std::vector<Sample> samples = plot_samples(trajectory);
    const Sample now = Sampler(trajectory).at(representative_time(trajectory));
    // View of the part of the world used so far.
    std::vector<Sample> past;
    for (const Sample& sample : samples)
        if (sample.t <= now.t || past.size() < 2) past.push_back(sample);
    const Drawing seen = widened(mechanism.limits(trajectory, past), thumbnail_shape, 1.0);
    MechanismScene stage(mechanism, trajectory, samples);
    const auto in = [&](const Theme& theme) { return stage.draw(now, seen, theme, {}); };
    return {in(light_theme()), in(dark_theme())};
}

}  // namespace

Thumbnail thumbnail_of(const std::filesystem::path& system) {
    try {
        return drawn(system);
    } catch (const std::exception&) {
        return {};
    }
}

Thumbnails::Thumbnails(std::function<std::filesystem::path(const std::string&)> find, bool waits)
    : find_(std::move(find)), waits_(waits) {}

const Thumbnail* Thumbnails::find(const std::string& system) {
    if (const auto found = thumbnails_.find(system); found != thumbnails_.end()) return &found->second;
    const auto file = [&]() -> std::filesystem::path {
        try {
            return find_(system);
        } catch (const std::exception&) {
            return {};
        }
    };
    if (waits_) return &thumbnails_.emplace(system, thumbnail_of(file())).first->second;
    if (system != in_progress_ && std::find(queue_.begin(), queue_.end(), system) == queue_.end())
        queue_.push_back(system);
    return nullptr;
}

void Thumbnails::update() {
    if (!in_progress_.empty()) {
        const auto ready = worker_.take(0.0);
        if (!ready) return;
        thumbnails_.emplace(std::exchange(in_progress_, {}), **ready);
    }
    if (queue_.empty()) return;
    in_progress_ = queue_.front();
    queue_.clear();  // systems still visible are requested again in the next frame
    std::filesystem::path file;
    try {
        file = find_(in_progress_);
    } catch (const std::exception&) {
    }
    worker_.start([file](const std::stop_token&) { return std::make_shared<Thumbnail>(thumbnail_of(file)); });
}

}  // namespace achilles
