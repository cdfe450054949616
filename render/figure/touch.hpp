// How the gaps of a system look in the world of its drawing: which side of a line is solid, and how a disc rests on it.
//
// A file says where its discs are and where its lines. Many a gap is of a disc's centre, y - sin(x) with a disc at (x, y):
// drawn as it is said, the disc would sink into the line by its radius r while it touches. The rule: a disc whose centre
// would come onto a drawn line when a gap closes is drawn aside, along the gap's gradient, so that its rim rests there; what
// stands still on the line is its lowest point then, which moves as the file says. With the distance d of the centre from
// the line it is moved by r exp(-(d/2r)^2): heights near the ground are true at any zoom, and far from it the disc is
// where the file says. Where several gaps ask, it is moved the least way that satisfies all.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "figure/field.hpp"
#include "figure/mechanism.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Where and how a gap is near a point of the world that the coordinates move.
struct Nearness {
    double distance = 0.0;  // h/|dh/dp|, in world units
    Point away;             // unit vector: dh/dp, out of what is solid
    Point foot;             // of the perpendicular, on h = 0
};

// One per thread: it evaluates its programs.
class Touch {
 public:
    // Of the run's parameters, in a world of this size (Drawing::size); refers to the model. What is where is found out at the
    // run's start.
    Touch(const Mechanism& mechanism, const Trajectory& trajectory, double size);

    // Puts what is solid behind the shapes, over all that is seen: the drawing's limits. Where no drawing belongs to a contact
    // that is held, the line of its gap is lit.
    void add_ground(Drawing& drawing, double t, const State& state, ContactSet held, const Theme& theme) const;
    // Moves the discs of a drawing (Shape::item) to where they rest.
    void rest(Drawing& drawing, double t, const State& state) const;
    // The same as nearness(), but of what is drawn: where that point, or a disc about it, touches the ground.
    std::optional<Nearness> ground_below(Grip& grip, std::size_t contact, double t, const State& state) const;
    // Which point of the mechanism (Mechanism::grips) comes onto a drawn line when a gap closes: a rod's end; nothing where
    // none does.
    std::optional<std::size_t> tip_of(std::size_t contact) const { return tips_[contact]; }
    // A gap seen from a point of the mechanism; nothing where it is no function of that point.
    std::optional<Nearness> nearness(Grip& grip, std::size_t contact, double t, const State& state) const;

 private:
    struct Disc {
        std::size_t item;
        Grip grip;
        std::vector<std::size_t> contacts;  // that are of its centre
    };
    // What lies beyond h = 0 of a gap of two coordinates that are x and y of the world, less a disc's radius where it
    // counts that; or beyond a circle.
    struct Solid {
        std::size_t contact = 0;
        double skin = 0.0;
        std::array<std::size_t, 2> pair{};
        std::optional<Point> center{};
        double radius = 0.0, sign = 1.0;  // of a circle; -1: solid outside
        bool stands_still = true;         // the gap does not depend on time
    };
    // What was found of one for the part of the world that was seen last, at that time.
    struct Seen {
        Drawing limits;
        double t = 0.0;
        std::vector<Point> area, line;
    };
    const Seen& look(std::size_t solid, const Drawing& drawing, double t, const State& state) const;
    void find_discs(const Mechanism& mechanism, const Trajectory& trajectory, const std::vector<Shape>& shapes);
    void find_tips(const Mechanism& mechanism, const Trajectory& trajectory, const std::vector<Shape>& shapes,
                   double size);
    std::optional<std::array<std::size_t, 2>> plane_of(Grip& grip, const State& start) const;
    bool is_of(std::size_t contact, const std::array<std::size_t, 2>& pair) const;
    PlaneFunction function_of(const Solid& solid, double t, const State& state) const;

    const Model* model_;
    std::vector<double> parameters_;
    mutable std::vector<std::optional<ContactTerms<Evaluator<double>>>> terms_;  // contact by contact, once asked for
    std::vector<Disc> discs_;
    std::vector<Solid> solids_;
    mutable std::vector<std::optional<Seen>> seen_;  // solid by solid
    std::vector<std::optional<std::size_t>> tips_;   // contact by contact
    ContactSet drawn_;                               // contacts to which a drawing belongs
};

}  // namespace achilles
