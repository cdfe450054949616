#include "simulate/least_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/model.hpp"

namespace achilles {

namespace {

struct Height {
    double t, h, hdot;
};

class GapAlong {
 public:
    GapAlong(const Trajectory& trajectory, std::size_t contact)
        : trajectory_(trajectory),
          contact_(trajectory.model->evaluator(trajectory.model->programs_of(contact).contact_terms,
                                               trajectory.run.parameters)) {}

    Height at(const State& state) {
        set_state(contact_, state);
        contact_.run();
        return {state.t, contact_.h(), contact_.hdot()};
    }

    // The least gap inside the piece where it is below this; else this. A step of either method is short enough that the
    // gap turns round once at most in each of a few parts.
    double below(double least, const Piece& piece) {
        constexpr int parts = 8;
        Height before = at(piece, piece.start);
        for (int i = 1; i <= parts; ++i) {
            const Height after = at(piece, piece.start + (piece.end - piece.start) * i / parts);
            if (i < parts) least = std::min(least, after.h);
            if (before.hdot <= 0.0 && after.hdot > 0.0 && where_tangents_meet(before, after) < least)
                least = std::min(least, minimum(piece, before, after));
            before = after;
        }
        return least;
    }

 private:
    Height at(const Piece& piece, double t) {
        return at(state_in(piece, trajectory_.coefficients, trajectory_.run.q.size(), t));
    }

    // No convex function with these values and rates goes lower.
    static double where_tangents_meet(const Height& a, const Height& b) {
        const double t = (b.h - a.h + a.hdot * a.t - b.hdot * b.t) / (a.hdot - b.hdot);
        return a.h + a.hdot * (std::clamp(t, a.t, b.t) - a.t);
    }

    // Between a fall and a rise, by halving.
    double minimum(const Piece& piece, Height falling, Height rising) {
        for (int i = 0; i < 60; ++i) {
            const double t = 0.5 * (falling.t + rising.t);
            if (t <= falling.t || t >= rising.t) break;
            const Height middle = at(piece, t);
            (middle.hdot < 0.0 ? falling : rising) = middle;
        }
        return std::min(falling.h, rising.h);
    }

    const Trajectory& trajectory_;
    ContactTerms<Evaluator<double>> contact_;
};

}  // namespace

double least_gap(const Trajectory& trajectory) {
    double least =
        trajectory.statistics.steps > 0 ? trajectory.statistics.least_gap : std::numeric_limits<double>::infinity();
    for (std::size_t contact = 0; contact < trajectory.model->contacts(); ++contact) {
        GapAlong gap(trajectory, contact);
        least = std::min(least, gap.at(trajectory.run.start()).h);
        for (const Piece& piece : trajectory.pieces)
            if (!piece.mode.is_held(contact)) least = gap.below(least, piece);
    }
    return least;
}

}  // namespace achilles
