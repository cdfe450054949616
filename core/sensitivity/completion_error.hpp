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

// The outputs of a program from index `first` on.
struct OutputSlice {
    const Evaluator<double>* all = nullptr;
    std::size_t first = 0;
    double output(std::size_t i) const { return all->output(first + i); }
};

class CompletionError {
 public:
    CompletionError(const Model& model, const Run& run) : model_(&model), run_(run), surfaces_(model, run) {}

    // A truncation: how the contact bounces, the state (q, s) with s in place of v, and w.
    struct TruncationState {
        BouncingKey key;
        State tangential;
        double speed;
    };

    // True minus comparison motion at equal times after the Zeno point: (d_q, d_s) of theory-enclosure.md 6 at
    // sigma = 0, with d_s in place of v. I and J are the integrals of h and hdot^2 over the truncated bouncing:
    //     d_q = (B - ndot) I,   d_s = (dA/dq n + dA/ds B - Bdot) I + D J,   I = 2 e^3 w^3/(3 a^2 (1 - e^3)),   J = a I
    // With friction n is n_sigma, or there are two directions (shift_of_sticking).
    State shift(const TruncationState& cut);

    // The accumulation time (s) by the formula of theory-truncation.md 3, and the error (s) to be added to it. One more
    // bounce, from w to w', scales the error of the formula by (w'/w)^3, so that
    //     error = (flight + formula' - formula)/(1 - (w'/w)^3).
    struct AccumulationEstimate {
        double formula = 0.0, error = 0.0;
    };
    AccumulationEstimate accumulation_time(const TruncationState& cut);

 private:
    // The next bounce: its flight time (s), the integral of its slip (m) if the contact sticks, and the cut after it.
    struct Bounce {
        double span, slip_integral;
        TruncationState next;
    };
    Bounce bounce(const TruncationState& cut);
    double time_after(const TruncationState& cut);
    double slip_after(const TruncationState& cut);
    AccelerationTrend trend(const TruncationState& cut);
    ShadowTerms<OutputSlice> shadow_terms(const BouncingKey& key, const State& state);
    PairTerms<Evaluator<double>>& sticking_terms(const BouncingKey& key, const State& state);
    Vector direction(const BouncingKey& key, const State& state);
    void take_out_rates(const BouncingKey& key, State& state);
    double slip_at(std::size_t contact, const State& state);
    State shift_of_sticking(const TruncationState& cut);
    const Model* model_;
    Run run_;
    ContactCache surfaces_;
    std::map<BouncingKey, TrendTerms<Evaluator<double>>> trends_;
    std::map<BouncingKey, Evaluator<double>> shadows_;
    std::map<BouncingKey, PairTerms<Evaluator<double>>> stickings_;
    std::map<Mode, MotionSeries> flights_;
};

}  // namespace achilles
