// What happened in a run, a sentence an event: the same words on the command line, in the window and in files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "run/trajectory.hpp"
#include "system/description.hpp"

namespace achilles {

// "knee is held: 10 impacts before the cut, 1.3 J lost, certified to 1e-6 s from the cut": the Zeno time of the exact motion from
// the computed state at the cut is that near to the event's, by the certificate; "proved" is said of whole runs alone
// (proof.hpp). In the units of the file.
class Sentences {
 public:
    // Of a run that outlives this. Throws nothing.
    explicit Sentences(const Trajectory& trajectory);

    // Of an event, an index into the trajectory's. The walk over the impacts of a long bouncing is made when it is asked.
    std::string of(std::size_t event) const;
    // "start at 0 s: in free flight" and "end at 20 s: knee is held"; of a run that ended early, why.
    std::string start() const;
    std::string end() const;
    // "24 impacts before the cuts", of the whole run.
    std::string impacts() const;
    // "2.13 J", or nothing where it is rounding: of an energy.
    std::string energy(double value) const;
    const std::string& energy_unit() const { return energy_unit_; }
    double energy_scale() const { return energy_scale_; }  // the largest at the run's start and end

 private:
    std::string impact(std::size_t index) const;
    std::string zeno(std::size_t index) const;
    std::string release(const Event& event) const;
    std::string state(ContactSet held) const;
    std::string lost(double energy) const;
    // Of one contact, what the file says of it; may be empty.
    std::string own_words(ContactSet contact, std::string ConstraintDescription::*words) const;

    const Trajectory& trajectory_;
    bool is_of_several_ = false;
    std::string energy_unit_;
    std::vector<std::string> rate_units_;  // of each gap's
    double energy_scale_ = 0.0;
    std::optional<std::size_t> by_convention_;  // the first event that Moreau's law decided
};

// How far the Zeno time can be from the event's, by its certificate (s); nothing where none is proved, and at a landing.
std::optional<double> proved_time(const Event& event);

}  // namespace achilles
