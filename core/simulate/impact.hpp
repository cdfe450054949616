// Contact quantities at a state, Newton's impact law, reinitialization, and projection onto the surface h(q) = 0.
#pragma once

#include <optional>

#include "contacts/impact_law.hpp"
#include "model/model.hpp"
#include "number/interval.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// Contact quantities at one state (theory.md 1).
struct Contact {
    double h = 0.0, hdot = 0.0, W = 0.0;
    double gap_t = 0.0;        // dh/dt at constant q: minus the speed at which the surface approaches
    Vector impulse_direction;  // n = M^-1 g'/W, so that g n = 1: the direction of every impulse
    Vector g;                  // dh, as a column
};

// v+ by Newton's impact law (contacts/impact_law.hpp).
Vector impact(const Contact& contact, const Vector& v_before, double e);

// The energy balance of an impact, dE = work - loss - heat, with the work of the moving contact surface.
struct Exchange {
    double work = 0.0, loss = 0.0, heat = 0.0;
};
inline Exchange exchange(const Contact& contact, double e) {
    const double impulse = newton::impulse(e, contact.hdot, contact.W);
    return {newton::work(impulse, contact.gap_t), newton::loss(impulse, e, contact.hdot)};
}

// Restart velocity of the constrained motion. kinetic: s = v - n hdot; euclidean: v* = v - (g v/|g|^2) g' (Def. 7).
Vector reinitialize(const Contact& contact, const Vector& v_before, Reinitialization kind);

// Sets the inputs of a program to the rounding box of a state.
void set_rounding_box(Evaluator<Interval>& program, const State& state);

// Evaluates contact quantities for one run.
class ContactKinematics {
 public:
    // For a contact in a mode in which it is open: n, W, hddot and its rate are those of theory-gaps.md 2.
    ContactKinematics(const Model& model, const Run& run, std::size_t contact = 0, Mode mode = {});

    Contact at(const State& state);
    // The same, stored in `contact`.
    void evaluate(const State& state, Contact& contact);
    // Error bound of h at q: the radius of its interval enclosure over all states that round to this one.
    double gap_error(const State& state);
    // Whether |value|, a difference of gaps, is at most `times` that bound. The bound of a state before serves for a
    // value that is far above it.
    bool within_gap_error(double value, double times, const Contact& contact, const State& state);
    // Before another run with the same parameters: no bound of the last run serves in it.
    void begin_run() { uses_left_ = 0; }
    // Error bound of hdot.
    double hdot_error(const State& state);
    // Moves q along n until |h| is at rounding level, then sets v to s unless keep_velocity. Returns the contact
    // quantities there in `contact`; false if it fails: dh = 0, or h cannot be brought to zero.
    bool project(State& state, bool keep_velocity, Contact& contact);
    // Enclosures of hddot and of h''' along the constrained motion over the rounding box of a state.
    struct Normal {
        Interval hddot, jerk;
    };
    Normal normal(const State& state);
    // The first of them alone, which is much cheaper.
    Interval hddot(const State& state);
    // hddot over all states within these distances of `state`.
    Interval hddot_within(const State& distances, const State& state);
    double normal_acceleration(const State& state);
    double jerk(const State& state);

 private:
    Evaluator<Interval>& normal_enclosure();
    const Model* model_;
    const Model::ContactPrograms* programs_;
    std::vector<double> parameters_;
    std::size_t dof_;
    ContactTerms<Evaluator<double>> terms_;
    Evaluator<Interval> gap_;
    // The last bound that within_gap_error() has computed, also in roundings of q and t, and how often it may still
    // serve.
    double error_ = 0.0, error_in_roundings_ = 0.0;
    int uses_left_ = 0;
    std::optional<Evaluator<double>> normal_;
    std::optional<ReleaseTerms<Evaluator<double>>> release_;
    std::optional<ContactTerms<Evaluator<Interval>>> enclosure_;
    std::optional<Evaluator<Interval>> normal_enclosure_;
    std::optional<ReleaseTerms<Evaluator<Interval>>> release_enclosure_;
};

}  // namespace achilles
