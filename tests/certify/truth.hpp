// Certificates against the truth: collisions near Zeno equilibria at random, what core/certify claims about them, and
// what really happens.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "certify/bouncing.hpp"
#include "certify/truncation.hpp"

namespace achilles::test {

// One certificate and what it is about.
struct Certified {
    Truncation asked;
    bool held = false;  // the conditions hold for the tolerances; otherwise it is the widest that can be proved
    Certificate certificate;
    // What simulate() takes for the Zeno time, from tau_k on, where it cuts at this collision.
    std::optional<double> best;
};

// One collision with every certificate that it gets. The truth is known unless `zeno` is empty.
struct Trial {
    Run run;
    std::size_t contact = 0;  // that lands
    Mode mode;                // the others' that are held meanwhile
    std::vector<Certified> certified;
    std::optional<ZenoPoint> zeno;
    struct Restarted {
        Collision collision;     // as the conditions see it
        Point restart, at_zeno;  // where the constrained motion starts, and where it is at tau_inf
        double farthest = 0.0;   // the largest |q(t) - q~(t)| of the instants looked at, q~ being that motion
    };
    Restarted kinetic, euclidean;
    // Of the other contacts at the instants looked at: the least, and the extremes of what an impulse is passed on by.
    std::optional<TrueMotion::Others> least, most;
    const Restarted& restarted(Reinitialization kind) const {
        return kind == Reinitialization::kinetic ? kinetic : euclidean;
    }
};

// A claim is true if actual <= bound.
struct Claim {
    enum class About {
        earliest,
        latest,
        position,
        velocity,
        shadowing_position,
        shadowing_velocity,
        uniform_position,
        best_estimate,  // of the Zeno time: inside the interval
        others,         // what is said of the other contacts
        tolerance
    };
    About about;
    double bound, actual;
    bool holds() const { return actual <= bound; }
};

// Everything that the certificate claims about the trial, next to what is true.
std::vector<Claim> claims(const Trial& trial, const Certified& certified);

// The largest |v - v*| on the way to the Zeno point, after tau_k. Not claimed, but it is what Def. 7 adds up.
double largest_excursion(const Trial& trial, Reinitialization kind);

// Reproducible trials of one system: states over the ranges that its description shows, impact speeds 1e-5 .. 1 and
// tolerances 1e-6 .. 1e-1 (both log-uniform), restitution 0 .. 0.95, always hddot < 0. With `everything` the other
// parameters as well (0.5 .. 1.5 times theirs), the time, the contact that lands and one that may be held, and states
// around the file's start.
class Trials {
 public:
    enum class Vary { restitution, everything };
    Trials(std::shared_ptr<const Model> model, unsigned seed, Vary vary = Vary::restitution);
    const Model& model() const { return *model_; }
    Trial next();
    // What the run from a random start near the file's certifies: a trial for each of its Zeno points that ends a
    // bouncing. Nothing where the start is not allowed.
    std::vector<Trial> next_run();

 private:
    double uniform(double low, double high);
    std::size_t any_of(std::size_t count);
    Run any_run();
    std::optional<State> zeno_equilibrium(Trial& trial);
    void collide(Trial& trial, const State& before) const;
    void certify(Trial& trial, const State& before);
    void find_truth(Trial& trial, const State& before) const;
    std::optional<double> best_estimate(Run run, const State& before, const Certificate& certificate) const;

    std::shared_ptr<const Model> model_;
    std::mt19937_64 random_;
    Vary vary_;
};

}  // namespace achilles::test
