// Sections of a run: its events of one kind, or the upward zero crossings of an expression.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/sweep.hpp"
#include "model/model.hpp"
#include "number/interval.hpp"
#include "run/trajectory.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Bounds of an expression and its rate over a part of a run, from dense output. A root search skips the parts where
// they exclude a root. The projection of states in contact is not included. Requires a FloatEnvironmentGuard
// (number/float_environment.hpp).
class PathBounds {
 public:
    // `section` is a result of Model::compile_section(). Returns nullopt if it depends on forces or accelerations of
    // several contacts, or on the work of forces, which dense output does not contain.
    static std::optional<PathBounds> of(const Model& model, const Program& section, std::span<const double> parameters);

    // Bounds for times in [from, to] within a step; undefined if the expression may be undefined there.
    Interval value(const Trajectory& trajectory, const DenseSegment& piece, double from, double to);
    // Bounds of the rate, per s, over the interval of the last value().
    Interval rate();

 private:
    PathBounds(const Model& model, const Program& section, std::span<const double> parameters);
    Layout layout_;
    std::size_t variables_;  // q and v
    Evaluator<Interval> section_;
    std::vector<Interval> rates_;  // of q and v
};

// A point of a run in a section.
struct SectionPoint {
    Sample sample;           // after the event
    std::size_t events = 0;  // number of events up to this point, including this one
    ContactSet contacts;     // for an event: the contacts that impact, come to rest or leave
};

// The events of the section's kind, not before `after`.
std::vector<SectionPoint> events_of(const Trajectory& trajectory, const Section& section);

// The times at which a function of the run crosses zero upward, found on dense output to a relative 1e-12. A jump or a
// pole across zero is not a crossing, nor is a touch, nor rounding of a value that stays zero.
//
// With bounds, no crossing is missed, unless the function stays so close to zero for so long that the bounds cannot
// separate it from zero. Without bounds, two crossings between neighboring evaluation points may be missed; there are
// eight per step, and more where the function curves toward zero. Work is provided to the function only on request,
// because it is slow to compute.
struct SectionFunction {
    std::function<double(const Sample&)> value;
    bool asks_for_work = false;
    PathBounds* bounds = nullptr;
};
std::vector<SectionPoint> zeros_of(const Trajectory& trajectory, const Section& section,
                                   const SectionFunction& function);

}  // namespace achilles
