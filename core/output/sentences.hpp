// What happened in a run, a sentence an event: the same words on the command line, in the window and in files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "output/precision.hpp"
#include "run/trajectory.hpp"
#include "system/description.hpp"

namespace achilles {

// "knee is held: 10 impacts before the cut, 1.3 J lost, certified to 1e-6 s from the cut": the Zeno time of the exact motion from
// the computed state at the cut is that near to the event's, by the certificate; "proved" is said of whole runs alone
// (proof.hpp). In the units of the file, but gap speeds in deg/s where angles are shown in degrees.
class Sentences {
 public:
    enum class Angles { radians, degrees };
    // Of a run that outlives this. Throws nothing. Numbers have the digits that its estimate leaves, which outlives this, too.
    explicit Sentences(const Trajectory& trajectory, const ErrorEstimate* estimate = nullptr,
                       Angles angles = Angles::radians);
    // An estimate that comes later.
    void take(const ErrorEstimate& estimate) { precision_ = Precision(trajectory_, &estimate); }
    const Precision& precision() const { return precision_; }

    // Of an event, an index into the trajectory's. The walk over the impacts of a long bouncing is made when it is asked.
    std::string of(std::size_t event) const;
    // "start at 0 s: in free flight" and "end at 20 s: knee is held"; of a run that ended early, why.
    std::string start() const;
    std::string end() const;
    // A change of the contact state in a few words, for a table: "contact begins; impacts since 1.694 s dissipated 0.301 J".
    std::string change(std::size_t event) const;
    // "free flight", "in contact", "held by left and right".
    std::string state_at_start() const;
    // The same, with "in flight".
    std::string state_at_end() const;
    // "24 impacts before the cuts", of the whole run.
    std::string impacts() const;
    // "2.13 J", or nothing where it is rounding: of an energy with such an error.
    std::string energy(double value, double error) const;
    const std::string& energy_unit() const { return energy_unit_; }
    double energy_scale() const { return energy_scale_; }  // the largest at the run's start and end

 private:
    std::string impact(std::size_t index) const;
    std::string zeno(std::size_t index) const;
    std::string release(const Event& event) const;
    std::string state(Mode mode) const;
    std::string holding(Mode mode, const char* flight) const;
    std::string beginning(const Event& event) const;
    std::string energy(double value, const Event& event) const;
    std::string lost(double energy, const Event& event) const;
    // Of one contact, what the file says of it; may be empty.
    std::string own_words(ContactSet contact, std::string ConstraintDescription::*words) const;

    struct RateUnit {
        std::string text;
        double factor = 1.0;  // of a number in the file's unit
    };

    const Trajectory& trajectory_;
    Precision precision_;
    bool is_of_several_ = false;
    std::string energy_unit_;
    std::vector<RateUnit> rate_units_;  // of each gap's
    double energy_scale_ = 0.0;
    std::optional<std::size_t> by_convention_;  // the first event that Moreau's law decided
};

// How far the Zeno time can be from the event's, by its certificate (s); nothing where none is proved, and at a landing.
std::optional<double> proved_time(const Event& event);

}  // namespace achilles
