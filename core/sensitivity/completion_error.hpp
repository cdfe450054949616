// The error of a truncation, to leading order in the speed w at the truncation. It consists of the distance between the
// restart state and the one that leads to the true motion, and of the error of the formula for the accumulation time.
// Both are O(w^3).
#pragma once

#include <map>

#include "certify/truncation.hpp"
#include "model/model.hpp"
#include "sensitivity/flow_sensitivity.hpp"
#include "simulate/contact_cache.hpp"

namespace achilles {

class CompletionError {
 public:
    CompletionError(const Model& model, const Run& run) : model_(&model), run_(run), surfaces_(model, run) {}

    // A truncation: a contact, the mode in which it is open, the restart state (v is s), and w.
    struct TruncationState {
        std::size_t contact;
        Mode others;
        State restart;
        double speed;
    };

    // True minus comparison motion at equal times after the Zeno point: (d_q, d_s) of theory-enclosure.md 6 at
    // sigma = 0, with d_s in place of v. I and J are the integrals of h and hdot^2 over the truncated bouncing:
    //     d_q = (B - ndot) I,   d_s = (dA/dq n + dA/ds B - Bdot) I + D J,   I = 2 e^3 w^3/(3 a^2 (1 - e^3)),   J = a I
    State shift(const TruncationState& cut);

    // The accumulation time (s) by the formula of theory-truncation.md 3, and the error (s) to be added to it. One more
    // bounce, from w to w', scales the error of the formula by (w'/w)^3, so that
    //     error = (flight + formula' - formula)/(1 - (w'/w)^3).
    struct AccumulationEstimate {
        double formula = 0.0, error = 0.0;
    };
    AccumulationEstimate accumulation_time(const TruncationState& cut);

 private:
    AccelerationTrend trend(const TruncationState& cut);

    const Model* model_;
    Run run_;
    ContactCache surfaces_;
    std::map<ContactInMode, TrendTerms<Evaluator<double>>> trends_;
    std::map<ContactInMode, Evaluator<double>> shadows_;
    std::map<Mode, MotionSeries> flights_;
};

}  // namespace achilles
