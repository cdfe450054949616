// The equations as the panel keeps them: simplified once for a system, set once for a width, drawn every frame.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "check/check.hpp"
#include "figure/formula.hpp"
#include "session/worker.hpp"

namespace achilles {

// A sheet in its place on a page that may be scrolled.
struct SetSheet {
    enum class Ink { heading, caption, formula };
    struct Line {
        float x = 0.0F, y = 0.0F;  // of its base line's left end, from the page's corner
        FormulaBox box;
        Ink ink = Ink::formula;
        std::size_t block = 0;
    };
    // Where what a condition is now stands: the left end of the top, and how wide.
    struct Now {
        std::size_t condition = 0;
        float x = 0.0F, y = 0.0F, width = 0.0F;
    };
    std::vector<Line> lines;
    std::vector<Now> now;
    float width = 0.0F, height = 0.0F;
};

// In columns side by side where there is room for them, and as few as make it as high as asked for. `size`: of the
// letters.
SetSheet set_sheet(const EquationSheet& sheet, float size, const FormulaFont& font, float width, float height);

class EquationsView {
 public:
    // The sheet of this model, with the signs that the parameters' ranges and these values allow. Without patience null
    // until it is ready.
    const EquationSheet* sheet(const std::shared_ptr<const Model>& model, const Run& run, Patience patience);
    bool is_under_way() const { return is_under_way_; }
    // The sheet that was asked for last, set.
    const SetSheet& set(float size, const FormulaFont& font, float width, float height);
    // What the sign of a condition's hddot depends on, at a state.
    double value(std::size_t condition, const Model& model, const Run& run, const State& state, double t);

 private:
    using Made = std::shared_ptr<const EquationSheet>;
    std::unique_ptr<Worker<Made>> worker_;
    bool is_under_way_ = false;
    std::shared_ptr<const Model> model_;  // of what was asked for last
    std::vector<double> signs_;           // the parameters' ranges, with the values
    Made sheet_;
    std::vector<float> set_for_;
    SetSheet set_;
    std::map<std::size_t, Evaluator<double>> evaluators_;
    std::vector<double> parameters_;  // of these
};

}  // namespace achilles
