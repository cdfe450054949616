// What is asked of each of many runs: expressions, and the words `held` and `outcome`, over its end or over a section.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depend/quantities.hpp"
#include "model/model.hpp"
#include "run/trajectory.hpp"
#include "simulate/contact_forces.hpp"
#include "simulate/many.hpp"
#include "study/section.hpp"
#include "study/sweep.hpp"

namespace achilles {

// The prints of a sweep, compiled. An expression may have what a view may (t, coordinates, rates, parameters, gaps, lambda,
// energy, power, work, loss), zeno_time(k), impact_time(k), impact_speed(k) and release_time(k) with k from 1 on (without
// (k): of the last one), zeno_points, impacts, releases, and least_gap. What does not exist is not a number.
//
// d(QUANTITY, NAME) is the derivative of such a quantity by a start x, a rate x' or a parameter, through all impacts and Zeno
// points (theory-derivatives.md 7): at the end at fixed time, at an event following it as it moves. A run that stopped early has
// no derivatives of its end.
class RunMeasures {
 public:
    // Throws InputError with the place in the expression.
    RunMeasures(std::shared_ptr<const Model> model, const Sweep& sweep);

    struct Column {
        enum class Kind { number, held, outcome };
        Kind kind;
        std::string name;              // as typed
        std::string unit;              // "" where it is not known
        std::string quantity{}, by{};  // of a derivative; else empty
    };
    const std::vector<Column>& columns() const { return columns_; }
    // Of the columns, those with numbers.
    std::size_t numbers() const { return slopes_.size(); }
    // Whether the ends of runs and their sequences of events do not tell: for sections, the least gap, and what work and
    // impacts have done where only whole trajectories know it.
    bool needs_everything() const { return needs_everything_; }
    bool needs_least_gap() const { return needs_least_gap_; }

 private:
    friend class Measuring;
    void add_slope(const Sweep& sweep, const std::string& print, const std::string& quantity, const std::string& name,
                   std::vector<std::string>& quantities);
    std::shared_ptr<const Model> model_;
    std::vector<Column> columns_;
    Model::MeasureProgram measures_;
    // Of a number that is a derivative: of which quantity, by which direction of differentiate(). Nothing: the next output of the
    // program.
    struct Slope {
        std::size_t quantity, direction;
    };
    std::vector<std::optional<Slope>> slopes_;
    std::optional<Quantities> quantities_;      // those of the slopes; none where there are no slopes
    std::optional<Program> zero_, zero_along_;  // the expression of a section; with its derivatives
    bool needs_everything_ = false, needs_least_gap_ = false, zero_has_work_ = false;
};

// Takes the measures of runs, one after the other. One per thread; refers to the measures.
class Measuring {
 public:
    explicit Measuring(const RunMeasures& measures);

    // The numbers of a run at its end: so many as there are, appended.
    void at_end(const Trajectory& trajectory, std::vector<double>& numbers);
    // The same at moments of it; what its events are, counts and times, is as it was until then.
    std::vector<Moment> moments(const Trajectory& trajectory, const Section& section);
    void at(const Trajectory& trajectory, const Moment& moment, std::vector<double>& numbers);

 private:
    void begin(const Trajectory& trajectory);
    // `differentiated`: the quantities of the slopes, there.
    void measure(const Sample& sample, std::span<const Passage> passed, std::span<const Quantity> differentiated,
                 std::vector<double>& numbers);
    const RunMeasures* measures_;
    Evaluator<double> numbers_;
    std::optional<Evaluator<double>> zero_;
    std::optional<BoundsAlong> zero_bounds_;
    std::optional<ContactForces> forces_;
    std::vector<double> parameters_;          // of both
    std::vector<Passage> sequence_;           // of the run at whose moments it is asked
    std::optional<Derivatives> derivatives_;  // of the same
    double least_gap_ = 0.0;
};

// The sequence of events of a run as one number: two runs of different signatures differ by more than times and places.

// Bits that depend on all bits of a number, well mixed: what random points and signatures are made of.

// One step of splitmix64.
constexpr std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

// How the run of a point ended: the kind of an Outcome, or a start that it cannot have.
class RunEnd {
 public:
    RunEnd() = default;  // cannot start
    explicit RunEnd(Outcome::Kind kind) : code_(static_cast<std::uint8_t>(1 + static_cast<int>(kind))) {}
    static RunEnd from(std::uint8_t code);
    std::uint8_t code() const { return code_; }
    std::string_view text() const;  // "end time", ..., "cannot start"
    friend bool operator==(const RunEnd&, const RunEnd&) = default;

 private:
    std::uint8_t code_ = 0;
};

// A hash of the events in their order, of each its kind and contacts, and of how the run ended. Left out are the impacts by
// which contacts come to rest: those after which, until the Zeno points of all their contacts, nothing else happens than such
// impacts and Zeno points. How many of them there are depends on where the bouncing is cut, and not on the motion.
std::uint64_t signature_of(std::span<const Passage> sequence, RunEnd end);

}  // namespace achilles
