// Tests certificates against reference motions (34 digits): random collisions near Zeno equilibria, the claims of
// core/certify about them, and the motion that follows.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "certify/bouncing.hpp"
#include "certify/truncation.hpp"

namespace achilles::test {

// One certificate with the tolerances for which it was requested.
struct CertificateCase {
    Truncation asked;
    bool held = false;  // the conditions hold for the tolerances; otherwise it states what can be proved without them
    Certificate certificate;
    // The estimate of tau_inf - tau_k by simulate(), if it cuts at this collision.
    std::optional<double> best;
};

// One collision with all its certificates. `zeno` is the reference Zeno point, empty if there is none.
struct Trial {
    Run run;
    std::size_t contact = 0;  // the impacting contact
    Mode mode;                // the other contacts that are held
    std::vector<CertificateCase> certified;
    std::optional<ZenoPoint> zeno;
    struct RestartPoint {
        Collision collision;     // input of the conditions
        Point restart, at_zeno;  // the constrained motion: its start, and its state at tau_inf
        double farthest = 0.0;   // the largest sampled |q(t) - q~(t)|, with q~ the constrained motion
    };
    RestartPoint kinetic, euclidean;
    // Minimum and maximum, over the sampled instants, of the forces, gaps and transmissions of the other contacts.
    std::optional<TrueMotion::OtherContacts> least, most;
    const RestartPoint& restarted(Reinitialization kind) const {
        return kind == Reinitialization::kinetic ? kinetic : euclidean;
    }
};

// One inequality that a certificate claims: actual <= bound.
struct Claim {
    enum class ClaimKind {
        earliest,
        latest,
        position,
        velocity,
        shadowing_position,
        shadowing_velocity,
        uniform_position,
        best_estimate,  // the estimate of the Zeno time lies in the interval
        others,         // statements about the other contacts
        tolerance
    };
    ClaimKind about;
    double bound, actual;
    bool holds() const { return actual <= bound; }
};

// All claims of the certificate about the trial, with the reference values.
std::vector<Claim> claims(const Trial& trial, const CertificateCase& certified);

// The largest |v - v*| between tau_k and the Zeno point. No certificate claims it, but the sum in Def. 7 bounds it.
double largest_excursion(const Trial& trial, Reinitialization kind);

// Reproducible random trials of one system, always with hddot < 0. States are in the ranges of its description, impact
// speeds in 1e-5 .. 1, tolerances in 1e-6 .. 1e-1 (both log-uniform), restitutions in 0 .. 0.95. With
// `Vary::everything` the states are around the file's start. Then the other parameters (0.5 .. 1.5 times their values),
// the time, the impacting contact and one held contact vary as well.
class Trials {
 public:
    enum class Vary { restitution, everything };
    Trials(std::shared_ptr<const Model> model, unsigned seed, Vary vary = Vary::restitution);
    const Model& model() const { return *model_; }
    Trial next();
    // Simulates from a random start near the file's. Returns a trial for each Zeno point of the run that follows an
    // impact sequence; none if the start is invalid.
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
