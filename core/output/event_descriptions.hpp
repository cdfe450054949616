// The events of a run as sentences, the same on the command line, in the window and in files.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/contacts.hpp"
#include "output/precision.hpp"
#include "run/trajectory.hpp"
#include "system/description.hpp"

namespace achilles {

// A sentence such as "knee is held: 10 impacts before the cut, 1.3 J lost, certified to 1e-6 s from the cut". The
// certificate bounds the distance of the event from the Zeno time of the exact motion that starts at the computed state
// of the cut. The word "proved" is reserved for whole runs (proof.hpp). Units are those of the file, but gap speeds are
// in deg/s if angles are shown in degrees, as in the explorer. That shows each time with its bound, so its sentences say
// only "certified".
class EventDescriptions {
 public:
    enum class Angles { radians, degrees };
    // Never throws. The trajectory and the estimate, which determines the digits, must outlive this object.
    explicit EventDescriptions(const Trajectory& trajectory, const ErrorEstimate* estimate = nullptr,
                               Angles angles = Angles::radians);
    // Sets an estimate that is computed later.
    void take(const ErrorEstimate& estimate) { precision_ = Precision(trajectory_, &estimate); }
    const Precision& precision() const { return precision_; }

    // The sentence of an event, by index. Only this call searches the impacts of a long sequence.
    std::string of(std::size_t event) const;
    // "start at 0 s: in free flight" and "end at 20 s: knee is held", with the reason if the run ended early.
    std::string start() const;
    std::string end() const;
    // A change of the contact state in short, for a table: "contact begins; impacts since 1.694 s dissipated 0.301 J".
    std::string change(std::size_t event) const;
    // "free flight", "in contact", "held by left and right"; with friction "in contact and sliding to the left", "held
    // by left (sticks) and right".
    std::string state_at_start() const;
    // The same for the end, with "in flight".
    std::string state_at_end() const;
    // The state in a mode in other words: "in free flight", "in contact", "left sticks, stop is held".
    std::string state(Mode mode, const State& at) const;
    // "24 impacts before the cuts", for the whole run.
    std::string impacts() const;
    // "2.13 J" for an energy with this error; empty if it is only rounding.
    std::string energy(double value, double error) const;
    const std::string& energy_unit() const { return energy_unit_; }
    double energy_scale() const { return energy_scale_; }  // the larger of the energies at start and end

 private:
    std::string impact(std::size_t index) const;
    std::string collapse(std::size_t index) const;
    std::string zeno(std::size_t index) const;
    std::string release(const Event& event) const;
    std::string friction(const Event& event) const;
    std::string jump(std::size_t index) const;
    std::string pass(const Event& event) const;
    std::string friction_after(std::size_t index) const;
    std::string participle(std::size_t which, Mode mode, const State& at) const;
    std::string verbs(ContactSet which, Mode mode, const State& at) const;
    Mode start_mode() const;
    std::string holding(Mode mode, const State& at, const char* flight) const;
    std::string beginning(const Event& event) const;
    std::string energy(double value, const Event& event) const;
    std::string lost(double energy, const Event& event) const;
    // The file's words for a single contact; may be empty.
    std::string own_words(ContactSet contact, std::string ConstraintDescription::*words) const;

    struct RateUnit {
        std::string text;
        double factor = 1.0;  // converts from the file's unit
    };

    const Trajectory& trajectory_;
    Precision precision_;
    bool shows_bounds_ = true;
    std::shared_ptr<Slips> slips_;  // null without friction
    bool is_of_several_ = false;    // contacts, and joints with friction
    std::string energy_unit_;
    std::vector<RateUnit> rate_units_;  // by contact, of its gap's rate
    double energy_scale_ = 0.0;
    std::optional<std::size_t> by_convention_;  // index of the first event resolved by Moreau's law
};

// Certified bound on the error of a Zeno time (s); nullopt if it is not certified, or for a plastic impact.
std::optional<double> proved_time(const Event& event);

}  // namespace achilles
