// What a cut leaves open, to leading order in the speed w at the cut: how far the state that the run restarts from lies from the
// one that leads to the true motion, and by how much the formula for the wait is wrong. Both are O(w^3).
#pragma once

#include <map>

#include "certify/truncation.hpp"
#include "depend/flow_slope.hpp"
#include "model/model.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

class CompletionError {
 public:
    CompletionError(const Model& model, const Run& run) : model_(&model), run_(run), surfaces_(model, run) {}

    // A cut: the bouncing of a contact while others are held, at the state that the run restarts from (v is s), with w.
    struct Cut {
        std::size_t contact;
        Mode others;
        State restart;
        double speed;
    };

    // True less comparison motion at equal times after the Zeno point, (d_q, d_s) of theory-enclosure.md 6 at sigma = 0, with the
    // integrals I of h and J of hdot^2 over what was cut (in v's place d_s):
    //     d_q = (B - ndot) I,   d_s = (dA/dq n + dA/ds B - Bdot) I + D J,   I = 2 e^3 w^3/(3 a^2 (1 - e^3)),   J = a I
    State shift(const Cut& cut);

    // How long the bouncing lasts (s): the formula of theory-truncation.md 3, and how much longer than that it is. One more
    // bounce, w to w', makes the formula's error (w'/w)^3 times as much, so that
    //     error = (flight + formula' - formula)/(1 - (w'/w)^3).
    struct Wait {
        double formula = 0.0, error = 0.0;
    };
    Wait wait(const Cut& cut);

 private:
    Trend trend(const Cut& cut);

    const Model* model_;
    Run run_;
    Surfaces surfaces_;
    std::map<ContactInMode, TrendTerms<Evaluator<double>>> trends_;
    std::map<ContactInMode, Evaluator<double>> shadows_;
    std::map<Mode, MotionSeries> flights_;
};

}  // namespace achilles
