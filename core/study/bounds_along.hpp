// What an expression can be along a part of a run.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "number/interval.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// Bounds of an expression and of its rate on the dense output, of which a root search knows where it need not look. They hold
// but for what a state in contact is moved by when it is projected. Stands on a Ground (number/ground.hpp).
class BoundsAlong {
 public:
    // Of Model::compile_section(). Nothing where it asks for forces and accelerations of several contacts, or for the work that
    // forces have done: those are not known on the way.
    static std::optional<BoundsAlong> of(const Model& model, const Program& section,
                                         std::span<const double> parameters);

    // While the time is between these, within a piece: undefined where the expression need not be.
    Interval value(const Trajectory& trajectory, const Piece& piece, double from, double to);
    // Of its rate, 1/s, there where value() was asked last.
    Interval rate();

 private:
    BoundsAlong(const Model& model, const Program& section, std::span<const double> parameters);
    Layout layout_;
    std::size_t variables_;  // q and v
    Evaluator<Interval> section_;
    std::vector<Interval> rates_;  // of q and v
};

}  // namespace achilles
