// Geometry of contacts in the drawing of a system: which side of a line is solid, and how a disc rests on it.
//
// The file gives the positions of discs and lines. Many gaps refer to the center of a disc, such as y - sin(x) with a
// disc at (x, y). Drawn literally, the disc would sink into the line by its radius r in contact. Therefore a disc whose
// center would meet a drawn line when a gap closes is drawn displaced along the gap's gradient, so that its rim rests
// on the line. The point on the line is then the lowest point of the disc, and it moves as the file says.
//
// If d is the distance of the center from the line, the displacement is r exp(-(d/2r)^2). Heights near the ground are
// therefore true at any zoom, and far away the disc is where the file says. With several gaps, the smallest
// displacement that satisfies all of them is used.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "figure/field.hpp"
#include "figure/mechanism.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// A gap at a point of the world that the coordinates move.
struct Nearness {
    double distance = 0.0;  // h/|dh/dp|, in world units
    Point away;             // unit vector along dh/dp, out of the solid
    Point foot;             // foot of the perpendicular, on h = 0
};

// Smallest displacement of a body that moves it, along every one of these unit vectors, at least this far.
Eigen::Vector3d min_way(const std::vector<std::pair<Eigen::Vector3d, double>>& wanted);

// Evaluates its programs, so use one per thread.
class ContactGeometry {
 public:
    // For the parameters of a run, in a world of this size (Drawing::size). Keeps a reference to the model. The
    // geometry is determined at the start of the run.
    ContactGeometry(const Mechanism& mechanism, const Trajectory& trajectory, double size);

    // Inserts the solid ground behind the shapes, over the limits of the drawing. If no drawing belongs to a held
    // contact, the line of its gap is highlighted.
    void add_ground(Drawing& drawing, double t, const State& state, Mode mode, const Theme& theme) const;
    // Moves the discs of a drawing (DrawnShape::item) to where they rest.
    void rest(Drawing& drawing, double t, const State& state) const;
    // As nearness(), but for what is drawn: the position where the point, or a disc around it, touches the ground.
    std::optional<Nearness> ground_below(AnchorPoint& grip, std::size_t contact, double t, const State& state) const;
    // The point of the mechanism (Mechanism::grips), such as the end of a rod, that meets a drawn line when a gap
    // closes. nullopt if no point does.
    std::optional<std::size_t> tip_of(std::size_t contact) const { return tips_[contact]; }
    // The gap as a function of a point of the mechanism. nullopt if it does not depend on that point alone.
    std::optional<Nearness> nearness(AnchorPoint& grip, std::size_t contact, double t, const State& state) const;

 private:
    struct Disc {
        std::size_t item;
        AnchorPoint grip;
        std::vector<std::size_t> contacts;  // whose gaps refer to its center
    };
    // The solid side of a gap. The gap depends on two coordinates that are x and y of the world; if it includes the
    // radius of a disc, the solid is smaller by that radius. A solid may also be bounded by a circle.
    struct Solid {
        std::size_t contact = 0;
        double skin = 0.0;
        std::array<std::size_t, 2> pair{};
        std::optional<Point> center{};
        double radius = 0.0, sign = 1.0;  // of a circle; sign -1: solid outside
        bool stands_still = true;         // the gap does not depend on time
    };
    // Result for one solid, cached for the part of the world that was visible last, at that time.
    struct CachedGround {
        Drawing limits;
        double t = 0.0;
        std::vector<Point> area, line;
    };
    const CachedGround& cached_ground(std::size_t solid, const Drawing& drawing, double t, const State& state) const;
    void find_discs(const Mechanism& mechanism, const Trajectory& trajectory, const std::vector<DrawnShape>& shapes);
    void find_tips(const Mechanism& mechanism, const Trajectory& trajectory, const std::vector<DrawnShape>& shapes,
                   double size);
    std::optional<std::array<std::size_t, 2>> plane_of(AnchorPoint& grip, const State& start) const;
    bool gap_depends_only_on(std::size_t contact, const std::array<std::size_t, 2>& pair) const;
    PlaneFunction function_of(const Solid& solid, double t, const State& state) const;

    const Model* model_;
    std::vector<double> parameters_;
    mutable std::vector<std::optional<ContactTerms<Evaluator<double>>>> terms_;  // by contact, compiled at first use
    std::vector<Disc> discs_;
    std::vector<Solid> solids_;
    mutable std::vector<std::optional<CachedGround>> seen_;  // by solid
    std::vector<std::optional<std::size_t>> tips_;           // by contact
    ContactSet drawn_;                                       // contacts to which a drawing belongs
};

}  // namespace achilles
