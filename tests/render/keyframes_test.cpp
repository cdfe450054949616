// Instants for a player: between two of them every point moves uniformly, and yet it is where the run is.
#include "figure/keyframes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/systems.hpp"
#include "figure/compose.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

// What a player shows at time t: the numbers of every shape.
std::vector<ShapeNumbers> shown_at(const std::vector<MotionClip>& clips, double t) {
    const auto later = std::upper_bound(clips.begin(), clips.end(), t,
                                        [](double time, const MotionClip& clip) { return time < clip.times.front(); });
    const MotionClip& clip = *std::prev(later);
    const auto next = std::upper_bound(clip.times.begin(), clip.times.end(), t);
    const auto i = static_cast<std::size_t>(std::prev(next) - clip.times.begin());
    const std::size_t j = std::min(i + 1, clip.times.size() - 1);
    const double length = clip.times[j] - clip.times[i];
    const double share = length > 0.0 ? std::min((t - clip.times[i]) / length, 1.0) : 0.0;
    std::vector<ShapeNumbers> all;
    for (const MotionClip::ClipShape& shape : clip.shapes) {
        if (shape.course != MotionClip::Course::smooth) {
            all.push_back(*shape.numbers[shape.course == MotionClip::Course::still ? 0 : i]);
            continue;
        }
        ShapeNumbers now = *shape.numbers[i];
        for (std::size_t k = 0; k < now.size(); ++k) now[k] += share * ((*shape.numbers[j])[k] - now[k]);
        all.push_back(std::move(now));
    }
    return all;
}

std::size_t count_of(const std::vector<MotionClip>& clips) {
    std::size_t count = 0;
    for (const MotionClip& clip : clips) count += clip.times.size();
    return count;
}

class DrawnRun {
 public:
    explicit DrawnRun(const std::string& system)
        : trajectory(run_of(test::load(system))),
          samples(plot_samples(trajectory)),
          mechanism(*trajectory.model),
          stage(mechanism, trajectory, samples) {}
    std::vector<PictureShape> at(const Sample& now, const Theme& theme = light_theme()) {
        Layers layers;
        layers.way = false;
        std::vector<PictureShape> shapes;
        for (const DrawnShape& shape : stage.draw(now, stage.limits(), theme, layers).shapes)
            shapes.push_back(picture_shape(0, shape));
        return shapes;
    }
    Trajectory trajectory;
    std::vector<Sample> samples;
    Mechanism mechanism;
    MechanismScene stage;

 private:
    static Trajectory run_of(const std::shared_ptr<const Model>& model) {
        return simulate(model, model->default_run());
    }
};

TEST(Keyframes, PutEveryPointWhereTheRunIs) {
    for (const auto& [name, part] : {std::pair("ball_on_sine", 2e-3),
                                     {"ball_on_sine", 1e-5},  // steps are divided many times
                                     {"double_pendulum", 2e-3},
                                     {"slider_crank_clearance", 2e-3},
                                     {"block_on_incline", 2e-3}}) {
        DrawnRun run(name);
        const double tolerance = part * run.stage.limits().size;
        const Keyframes keyframes(
            run.trajectory, [&](const Sample& now, const Theme& theme) { return run.at(now, theme); }, tolerance);
        const std::vector<MotionClip> clips = keyframes.clips(tolerance);
        Sampler sampler(run.trajectory);
        std::vector<double> times;
        std::mt19937 random(4);
        std::uniform_real_distribution<double> somewhere(run.trajectory.run.options.start_time,
                                                         run.trajectory.end_time);
        for (int i = 0; i < 300; ++i) times.push_back(somewhere(random));
        for (const Event& event : run.trajectory.events)
            for (const double step : {-1e-4, -1e-7, 1e-7, 1e-4}) times.push_back(event.t + step);
        double worst = 0.0;
        for (const double t : times) {
            if (t < run.trajectory.run.options.start_time || t > run.trajectory.end_time) continue;
            const std::vector<ShapeNumbers> shown = shown_at(clips, t);
            const std::vector<PictureShape> drawn = run.at(sampler.at(t));
            // Marks of friction may come and go within the last step to an event.
            for (std::size_t i = 0; i < std::min(shown.size(), drawn.size()); ++i) {
                if (!drawn[i].look.moves || shown[i].size() != drawn[i].numbers->size()) continue;
                for (std::size_t k = 0; k < shown[i].size(); ++k)
                    if (std::isfinite(shown[i][k]))
                        worst = std::max(worst, std::abs(shown[i][k] - (*drawn[i].numbers)[k]));
            }
        }
        EXPECT_LT(worst, 1.6 * tolerance) << name;
        EXPECT_GT(worst, 0.05 * tolerance) << name << ": the instants are closer than needed";
        // Fewer instants for a coarser picture, never closer than the run was sampled.
        EXPECT_LT(count_of(keyframes.clips(8.0 * tolerance)), count_of(clips)) << name;
        EXPECT_LT(count_of(clips), 3000U) << name;
    }
}

TEST(Keyframes, KeepTheTimeAndTheLookOfEveryPhase) {
    DrawnRun run("ball_on_sine");
    const Keyframes keyframes(
        run.trajectory, [&](const Sample& now, const Theme& theme) { return run.at(now, theme); }, 0.01);
    const std::vector<MotionClip> clips = keyframes.clips(0.01);
    EXPECT_EQ(clips.front().times.front(), 0.0);
    EXPECT_EQ(clips.back().times.back(), run.trajectory.end_time);
    for (const Phase& phase : run.trajectory.phases) {
        const auto begins = [&](const MotionClip& clip) { return clip.times.front() == phase.start; };
        const auto clip = std::find_if(clips.begin(), clips.end(), begins);
        ASSERT_NE(clip, clips.end()) << phase.start;
        const PhaseLook look = look_of(*run.trajectory.model, phase.kind, phase.mode);
        EXPECT_EQ(clip->phase.color, look);
    }
    for (const MotionClip& clip : clips) {
        EXPECT_TRUE(std::is_sorted(clip.times.begin(), clip.times.end()));
        // Both themes: the ball has another color in each.
        EXPECT_NE(clip.shapes.back().look.fill_color, clip.shapes.back().dark.fill_color);
    }
}

// A line with more and more points, a point that jumps at every impact, and one that stands still.
TEST(Keyframes, StepWherePointsComeAndGoAndJumpAtEvents) {
    const auto model = test::load("ball_on_floor");
    const Trajectory trajectory = simulate(model, model->default_run());
    const double duration = trajectory.end_time - trajectory.run.options.start_time;
    ASSERT_GT(trajectory.events.size(), 3U);
    const Keyframes keyframes(
        trajectory,
        [&](const Sample& now, const Theme&) {
            DrawnShape line, point, rest;
            line.points.resize(2 + static_cast<std::size_t>(100.0 * now.t / duration), Point{now.t, 2.0});
            point.points = {{static_cast<double>(now.j), now.t}};
            rest.points = {{3.0, 4.0}};
            return std::vector<PictureShape>{picture_shape(0, line), picture_shape(1, point), picture_shape(1, rest)};
        },
        1e-3);
    const std::vector<MotionClip> clips = keyframes.clips(1e-3);
    bool has_stepped = false, has_jumped = false;
    for (const MotionClip& clip : clips) {
        ASSERT_EQ(clip.shapes.size(), 3U);
        EXPECT_EQ(clip.shapes[2].course, MotionClip::Course::still);
        EXPECT_EQ(clip.shapes[2].numbers.size(), 1U);
        for (std::size_t i = 1; i < clip.times.size(); ++i) {
            const double step = clip.times[i] - clip.times[i - 1];
            if (clip.shapes[0].course == MotionClip::Course::stepped) {
                has_stepped = true;
                EXPECT_LE(step, 1.01 * duration / 600.0);
            }
            const double jump = (*clip.shapes[1].numbers[i])[0] - (*clip.shapes[1].numbers[i - 1])[0];
            if (jump != 0.0) {
                has_jumped = true;
                EXPECT_EQ(step, 0.0) << clip.times[i];
            }
        }
    }
    EXPECT_TRUE(has_stepped && has_jumped);
}

}  // namespace
}  // namespace achilles
