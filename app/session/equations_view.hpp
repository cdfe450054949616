// The equations of a system for a panel: simplified once per system, typeset once per width.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check/check.hpp"
#include "figure/formula.hpp"
#include "session/worker.hpp"

namespace achilles {

// Space above a heading, relative to the size of the letters.
constexpr float before_heading = 1.0F;

// A typeset sheet of equations on a scrollable page.
struct TypesetSheet {
    enum class Ink { heading, caption, formula };
    struct SheetLine {
        float x = 0.0F, y = 0.0F;  // left end of its baseline, relative to the corner of the page
        FormulaBox box;
        Ink ink = Ink::formula;
        std::size_t block = 0;
    };
    // Place for the current value of a condition: its upper left corner and width.
    struct ConditionPlace {
        std::size_t condition = 0;
        float x = 0.0F, y = 0.0F, width = 0.0F;
    };
    std::vector<SheetLine> lines;
    std::vector<ConditionPlace> now;
    float width = 0.0F, height = 0.0F;
};

// Typesets the sheet in columns: as few as keep it within the height, if the width allows. `size`: of the letters.
TypesetSheet set_sheet(const EquationSheet& sheet, float size, const FormulaFont& font, float width, float height);

class EquationsView {
 public:
    // The sheet of this model, simplified with the signs that the parameter ranges and these values imply. With a
    // timeout: null until it is ready.
    const EquationSheet* sheet(const std::shared_ptr<const Model>& model, const Run& run, Timeout patience);
    bool is_under_way() const { return is_under_way_; }
    // The sheet returned last by sheet(), which must not be null, typeset. Kept until the size changes.
    const TypesetSheet& typeset_sheet(float size, const FormulaFont& font, float width, float height);
    // What the reader understood of the mechanism, with the values at the start of this run, and the same typeset. Both
    // are kept until the run or the size changes.
    const EquationSheet& mechanism(const std::shared_ptr<const Model>& model, const Run& run);
    const TypesetSheet& typeset_mechanism(float size, const FormulaFont& font, float width, float height);
    // The quantity that determines the sign of a condition's hddot, at a state.
    double value(std::size_t condition, const Model& model, const Run& run, const State& state, double t);

 private:
    using SheetResult = std::shared_ptr<const EquationSheet>;
    std::unique_ptr<Worker<SheetResult>> worker_;
    bool is_under_way_ = false;
    std::shared_ptr<const Model> model_;  // the model whose equations were requested last
    std::vector<double> signs_;           // ranges and values of the parameters that determine the signs
    SheetResult sheet_;
    std::vector<float> typeset_key_;
    TypesetSheet typeset_;
    std::shared_ptr<const Model> mechanism_model_;
    std::optional<Run> mechanism_run_;
    EquationSheet mechanism_;
    std::vector<float> mechanism_key_;
    TypesetSheet typeset_mechanism_;
    std::map<std::size_t, Evaluator<double>> evaluators_;
    std::vector<double> parameters_;  // values in `evaluators_`
};

}  // namespace achilles
