// Points and frames that move in the plane, as sums of rotated vectors. Two rotated vectors multiply to the cosine and the
// sine of the difference of their angles, so that sin^2 + cos^2 does not appear and nothing is left to simplify.
#pragma once

#include <array>
#include <vector>

#include "expression/product_sum.hpp"

namespace achilles {

// R(angle) (x, y), where R turns counterclockwise.
struct RotatedVector {
    ProductSum angle, x, y;
};

// A sum of rotated vectors with different angles.
struct PlanarVector {
    std::vector<RotatedVector> terms;

    PlanarVector() = default;
    PlanarVector(const ProductSum& angle, const ProductSum& x, const ProductSum& y);
    bool is_zero() const { return terms.empty(); }
};
PlanarVector operator+(const PlanarVector& a, const PlanarVector& b);
PlanarVector operator-(const PlanarVector& a, const PlanarVector& b);

// (R(a) u).(R(b) w) = cos(b - a) (u.w) - sin(b - a) (u x w),   (R(a) u) x (R(b) w) = cos(b - a) (u x w) + sin(b - a) (u.w)
ProductSum dot(const PlanarVector& a, const PlanarVector& b, Graph& graph);
ProductSum cross(const PlanarVector& a, const PlanarVector& b, Graph& graph);
// The components along axes that are turned by an angle.
std::array<ProductSum, 2> components(const PlanarVector& vector, const ProductSum& axes, Graph& graph);

// A point that moves: its velocity is linear in the rates, and its drift is the velocity at rates zero, from the time in
// its position.
struct MovingPoint {
    PlanarVector position, velocity, drift;
    PlanarVector motion() const { return velocity + drift; }
};

// Axes that move. Their angular velocity is rate + drift.
struct MovingFrame {
    MovingPoint origin;
    ProductSum angle, rate, drift;
    ProductSum turning() const { return rate + drift; }
};

// The derivatives of quantities that depend on coordinates and time.
class Kinematics {
 public:
    Kinematics(Graph& graph, std::vector<std::uint32_t> coordinates, std::vector<std::uint32_t> rates,
               std::uint32_t time)
        : graph_(graph), q_(std::move(coordinates)), v_(std::move(rates)), t_(time) {}

    ProductSum rate_of(const ProductSum& quantity) const;   // sum of d/dq_i v_i
    ProductSum drift_of(const ProductSum& quantity) const;  // d/dt at constant coordinates
    ProductSum change_of(const ProductSum& quantity) const { return rate_of(quantity) + drift_of(quantity); }
    // The point (x, y) of a frame; x and y may depend on coordinates and time.
    MovingPoint point_in(const MovingFrame& frame, const ProductSum& x, const ProductSum& y) const;
    // A frame at a point, turned by an angle against other axes.
    MovingFrame frame_at(const MovingPoint& origin, const MovingFrame& axes, const ProductSum& angle) const;
    // Axes of the world, and a frame that does not move.
    MovingFrame world() const { return {}; }
    Graph& graph() const { return graph_; }
    const std::vector<std::uint32_t>& coordinates() const { return q_; }
    const std::vector<std::uint32_t>& rates() const { return v_; }
    std::uint32_t time() const { return t_; }

 private:
    Graph& graph_;
    std::vector<std::uint32_t> q_, v_;
    std::uint32_t t_;
};

}  // namespace achilles
