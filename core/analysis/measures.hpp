// The quantities printed for each of many runs: expressions, and the words `held`, `modes` and `outcome`, at the end or
// at a section.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/section.hpp"
#include "analysis/sweep.hpp"
#include "model/model.hpp"
#include "run/trajectory.hpp"
#include "sensitivity/quantities.hpp"
#include "simulate/batch.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles {

// The compiled prints of a sweep. An expression may contain the names of a view (t, coordinates, rates, parameters,
// gaps, lambda, energy, power, work, loss). It may also contain zeno_time(k), impact_time(k), impact_speed(k) and
// release_time(k), with k from 1 (without (k): the last one), zeno_points, impacts, releases, and least_gap. With
// friction it may contain slips, friction forces and heat, stick_time(k), slip_time(k), reversal_time(k), sticks, slips
// and reversals. Several contacts without friction have collapse_time(k) and collapses. A quantity that does not exist is NaN.
//
// d(QUANTITY, NAME) is the derivative of such a quantity by an initial coordinate x, an initial rate x' or a parameter,
// through all impacts and Zeno points (theory-derivatives.md 7). At the end, time is fixed; at an event, the derivative
// follows the event. A run that stopped early has no derivatives of its end.
class RunMeasures {
 public:
    // Throws InputError with the place in the expression.
    RunMeasures(std::shared_ptr<const Model> model, const SweepSpec& sweep);

    struct Column {
        enum class Kind { number, held, outcome, modes };
        Kind kind;
        std::string name;              // as typed
        std::string unit;              // "" if unknown
        std::string quantity{}, by{};  // of a derivative; else empty
    };
    const std::vector<Column>& columns() const { return columns_; }
    // Number of columns with numbers.
    std::size_t numbers() const { return slopes_.size(); }
    // Whether runs must be recorded in full: for sections, derivatives and the smallest gap, and for work and loss if
    // they cannot be computed otherwise.
    bool needs_everything() const { return needs_everything_; }
    bool needs_least_gap() const { return needs_least_gap_; }
    // Whether the modes of friction are printed.
    bool prints_modes() const;

 private:
    friend class MeasureEvaluator;
    void add_slope(const SweepSpec& sweep, const std::string& print, const std::string& quantity,
                   const std::string& name, std::vector<std::string>& quantities);
    std::shared_ptr<const Model> model_;
    std::vector<Column> columns_;
    Model::MeasureProgram measures_;
    // For a number that is a derivative: its quantity, and its direction in differentiate(). nullopt: the number is the
    // next output of the program.
    struct Slope {
        std::size_t quantity, direction;
    };
    std::vector<std::optional<Slope>> slopes_;
    std::optional<Quantities> quantities_;      // quantities of the derivatives; empty if there are none
    std::optional<Program> zero_, zero_along_;  // expression of a section; with its derivatives
    bool needs_everything_ = false, needs_least_gap_ = false, zero_has_work_ = false;
};

// Evaluates the measures of one run after another. Use one object per thread; refers to the measures.
class MeasureEvaluator {
 public:
    explicit MeasureEvaluator(const RunMeasures& measures);

    // Appends the numbers of a run at its end.
    void at_end(const Trajectory& trajectory, std::vector<double>& numbers);
    // The points of a run in a section, in order of time.
    std::vector<SectionPoint> moments(const Trajectory& trajectory, const Section& section);
    // Appends the numbers at one of these points. Counts and times of events are those up to the point.
    void at(const Trajectory& trajectory, const SectionPoint& moment, std::vector<double>& numbers);

 private:
    void begin(const Trajectory& trajectory);
    // `differentiated`: the quantities of the derivatives at this point.
    void measure(const Sample& sample, std::span<const EventRecord> passed, std::span<const Quantity> differentiated,
                 std::vector<double>& numbers);
    const RunMeasures* measures_;
    Evaluator<double> numbers_;
    std::optional<Evaluator<double>> zero_;
    std::optional<PathBounds> zero_bounds_;
    std::optional<ContactForces> forces_;
    std::vector<double> parameters_;          // of both evaluators
    std::vector<EventRecord> sequence_;       // events of the current run
    std::optional<Derivatives> derivatives_;  // of the current run
    double least_gap_ = 0.0;
};

// ---- event signature: a hash of the event sequence of a run; runs with different sequences differ in it ----

// One step of splitmix64: a hash function for random points and event signatures.
constexpr std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

// How the run of a point ended: the kind of an Outcome, or "cannot start".
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

// A hash of the kinds and contacts of the events in their order, and of how the run ended. Impacts that only precede a
// Zeno point are left out: those after which nothing else happens, until the Zeno points of all their contacts, than
// such impacts and Zeno points. Their number depends on where the bouncing is truncated, not on the motion.
std::uint64_t signature_of(std::span<const EventRecord> sequence, RunEnd end);

}  // namespace achilles
