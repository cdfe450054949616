// One smooth stretch of motion, free or in contact, advanced by an adaptive stepper with dense output.
//
// The quantity whose zero ends the stretch is integrated along with the motion, under the same error control: in flight
// the gap (h, hdot with (h, hdot)' = (hdot, hddot)), in contact hddot (with rate h'''). So a step is never longer than
// that quantity allows, and the gap after an impact is an increment from zero, not a difference of large numbers
// (THEORY section 9).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "model/model.hpp"
#include "simulate/polynomial.hpp"
#include "trajectory.hpp"

namespace achilles {

class Flow {
 public:
    enum class Motion { flight, contact };
    // Why a step could not be made.
    enum class Obstacle { none, left_the_domain, not_a_number, step_too_small };

    Flow(const Model& model, const Run& run);
    ~Flow();

    // The gap and its rate.
    struct Gap {
        double h = 0.0, hdot = 0.0;
    };

    // Start a stretch at (t, state). The first step is at most `first_step` (s); 0 leaves it to the stepper.
    void fly(double t, const State& state, const Gap& gap, double first_step);
    void stay(double t, const State& state);
    // Advances by one accepted step, not past t + `longest`. Where a function leaves its domain inside a step the step
    // is shortened, until it is too short to be a step: that is the obstacle.
    Obstacle step(double longest);
    // Makes the last step again with this shorter duration, so that its end is integrated and not interpolated.
    Obstacle retake(double duration);
    // Moves the end of the last step (onto the surface, say); the next step starts from there.
    void move_end(const State& state);
    // In flight: what is known better of the gap at the end of the last step.
    void move_gap(const Gap& gap);
    // Moves the end of the last step along the motion by a time so short that a second-order Taylor step is exact.
    void shift_end(double dt);

    // The last step: [begin_time, begin_time + duration], its end, and q, v as polynomials in theta.
    double begin_time() const;
    double duration() const;
    double end_time() const { return begin_time() + duration(); }
    const State& end() const;
    // Along the last step, as a polynomial in theta: h in flight, hddot of the free motion in contact.
    Polynomial watched() const;
    // The last step as a piece of dense output; coefficients are appended. Its ends are begin() and end() exactly.
    Piece piece(std::vector<double>& coefficients) const;

    long evaluations() const;

 private:
    void start(Motion motion, double t, const State& state, double first_step);
    struct Stepper;
    std::unique_ptr<Stepper> stepper_;
};

}  // namespace achilles
