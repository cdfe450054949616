// A system in space: a point with three coordinates, seen from a direction that the user chooses.
//
// A [[drawing]] has two coordinates, so that of a system in space shows it from one side only, which its file has made
// up. Turned, the system is drawn as it is: the surfaces of its gaps as a net of lines, the point with its trail, and the
// directions of the axes. The projection is orthographic, so that a length keeps its scale wherever it is.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "model/model.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

class Mechanism;

// The direction from which a system in space is seen, degrees.
struct ViewAngles {
    double about = 30.0;  // turn about the vertical axis z; at 0, x points to the right and y away from the viewer
    double tilt = 30.0;   // 0: from the side, 90: from above
    friend bool operator==(const ViewAngles&, const ViewAngles&) = default;
};
// Angles that a hand sets: whole degrees, the first from -180 to 180, the second from -90 to 90.
ViewAngles rounded(const ViewAngles& angles);

// Projection of a point in space onto the picture.
class SpaceView {
 public:
    using Place = Eigen::Vector3d;
    // Whether the coordinates are x, y and z, or r, phi and z, of a point: its kinetic energy at the start must be that
    // of a point.
    static bool shows(const Model& model);
    // Requires shows(model).
    SpaceView(const Model& model, const ViewAngles& angles);

    Place place(const Vector& q) const;            // x, y, z
    Eigen::Matrix3d slope(const Vector& q) const;  // of the place, by the coordinates
    Eigen::Vector3d coordinates(const Place& place) const;
    // To the right, up and toward the viewer; the first two are the place in the picture.
    Place seen(const Place& place) const { return axes_ * place; }
    Place unseen(const Place& seen) const { return axes_.transpose() * seen; }

 private:
    bool is_cylindrical_ = false;  // r, phi, z
    Eigen::Matrix3d axes_;         // rows: the directions to the right, up and toward the viewer
};

// The direction from which the drawing of a file shows a system in space; the default if that is none.
ViewAngles drawn_angles(const Mechanism& mechanism, const Model& model);

// The box around a run in space.
struct SpaceBox {
    SpaceView::Place middle, half;
    SpaceBox(const SpaceView& view, std::span<const Sample> samples);
    double size() const { return 2.0 * half.maxCoeff(); }
};

// The surfaces of the gaps around a run. Evaluates its programs, so use one per thread.
class SpaceSurfaces {
 public:
    // Keeps a reference to the model.
    SpaceSurfaces(const Model& model, std::span<const double> parameters, const SpaceView& view,
                  std::span<const Sample> samples);
    // Inserts the surfaces behind the shapes; those of held contacts are darker.
    void add(Drawing& drawing, const Sample& now, const Theme& theme) const;
    // Moves the ball from its point of contact to where its rim touches the surfaces, as ContactGeometry::rest does.
    void rest(Drawing& drawing, double t, const State& state) const;
    // Appends the directions of x, y and z, in a corner of the picture.
    void add_axes(Drawing& drawing, const Theme& theme) const;

 private:
    using Line = std::vector<SpaceView::Place>;
    struct Net {
        double t = 0.0;
        std::vector<Line> lines;
    };
    using Gap = std::function<double(const SpaceView::Place&)>;
    Gap gap(std::size_t contact, double t, const State& state) const;
    const Net& net(std::size_t contact, const Sample& now) const;

    const Model* model_;
    std::vector<double> parameters_;
    SpaceView view_;
    SpaceBox box_;
    mutable std::vector<std::optional<Net>> nets_;  // by contact, for the last time
};

}  // namespace achilles
