// Shapes that move with a run, as few instants between which every point moves uniformly: for a player that can only
// interpolate. Impacts, the bounces before a Zeno point and jumps are followed as far as the picture shows them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "figure/mechanism_scene.hpp"

namespace achilles {

// The numbers of a shape that may change: x and y of its points, NaN for a break; of a disc center and radius.
using ShapeNumbers = std::vector<double>;

// A shape in one of the pictures of a page, at one instant.
struct PictureShape {
    std::size_t picture = 0;
    DrawnShape look;  // without points
    std::shared_ptr<const ShapeNumbers> numbers;
};
PictureShape picture_shape(std::size_t picture, const DrawnShape& shape);

// Shapes that keep their order and their looks from the first instant to the last.
struct MotionClip {
    // `smooth`: the shape has the same breaks and the same number of points at all instants. `stepped`: it is redrawn at
    // each instant, which are close together then.
    enum class Course { still, smooth, stepped };
    struct ClipShape {
        std::size_t picture = 0;
        DrawnShape look, dark;  // without points; in the light and in the dark theme
        Course course = Course::still;
        std::vector<std::shared_ptr<const ShapeNumbers>> numbers;  // one per instant; a single entry if it is still
    };
    PhaseLabel phase;
    std::vector<double> times;  // s; the same time twice where something jumps
    std::vector<ClipShape> shapes;
};

// The run in motion. `shapes`: what is drawn at a sample in a theme, in the same order in both. Points lie within
// `tolerance` of their true positions. Throws what `shapes` throws.
using ShapesAt = std::function<std::vector<PictureShape>(const Sample& now, const Theme& theme)>;

class Keyframes {
 public:
    // Samples the run so finely that it can be thinned to any tolerance from this one on.
    Keyframes(const Trajectory& trajectory, ShapesAt shapes, double tolerance);
    Keyframes(const Keyframes&) = delete;
    Keyframes& operator=(const Keyframes&) = delete;
    // In order of time; each begins where the one before ends.
    std::vector<MotionClip> clips(double tolerance) const;

 private:
    struct Frame {
        Sample now;
        PhaseLabel phase;
        std::vector<PictureShape> shapes;
    };
    Frame frame(const Sample& now) const;
    static void add(std::vector<Frame>& frames, Frame frame);
    void note_stepped(const Frame& from, const Frame& to);
    void refine(Sampler& sampler, const Frame& from, const Frame& to, double tolerance, int depth);
    static bool continues(const Frame& from, const Frame& to);
    MotionClip clip(std::size_t first, std::size_t last, double tolerance) const;
    std::vector<std::size_t> kept(std::size_t first, std::size_t last, const std::vector<MotionClip::Course>& courses,
                                  double tolerance) const;

    const Trajectory& trajectory_;
    ShapesAt shapes_;
    double step_ = 0.0;             // s, between two instants of a stepped shape
    std::vector<bool> is_stepped_;  // by the shape's place in the list
    std::vector<Frame> frames_;
};

}  // namespace achilles
