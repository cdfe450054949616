// Sections of a run: its events of a kind, or the times at which an expression passes zero upwards.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "number/interval.hpp"
#include "run/trajectory.hpp"
#include "simulate/sampler.hpp"
#include "study/sweep.hpp"

namespace achilles {

// What an expression can be along a part of a run: bounds of it and of its rate on the dense output, of which a root search knows where it need not look. They hold
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

// A moment of a run at which it is asked.
struct Moment {
    Sample sample;           // after the event
    std::size_t events = 0;  // so many have happened by then, this one included
    ContactSet contacts;     // of an event: that land, come to rest or leave
};

// The events of this kind, not before `after`.
std::vector<Moment> events_of(const Trajectory& trajectory, const Section& section);

// The times at which a function of a moment of the run passes zero upwards, found on the dense output to 1e-12 of them. A
// jump or a pole over zero is no passage, nor is a touch, nor what rounding makes of a value that stays zero.
//
// By its bounds none is missed, but where it stays so close to zero for so long that they cannot tell it from zero. Without
// them two passages may hide between the instants that are looked at, eight a step and more where the function bends towards
// zero. The work that forces have done takes long to find: the function is told it where it asks for it.
struct SectionFunction {
    std::function<double(const Sample&)> value;
    bool asks_for_work = false;
    BoundsAlong* bounds = nullptr;
};
std::vector<Moment> zeros_of(const Trajectory& trajectory, const Section& section, const SectionFunction& function);

}  // namespace achilles
