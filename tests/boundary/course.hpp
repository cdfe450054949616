// The course of an execution: its phases in order, with their impacts. Runs are compared with references by it, whether
// events or only the final state was recorded.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "certify/execution.hpp"
#include "run/trajectory.hpp"

namespace achilles::test {

struct Stretch {
    Phase::Kind kind = Phase::Kind::hybrid;
    double start = 0.0;
    std::vector<double> impacts;  // times, as far as recorded
    std::size_t count = 0;        // number of impacts
    // The sequence was cut at the last of these impacts; in a reference, it converges. Later impacts are not listed.
    bool cut = false;
    double zeno_low = 0.0, zeno_high = 0.0;  // if it reached its Zeno point
};

struct Course {
    std::vector<Stretch> stretches;
    double end = 0.0;
    bool timed = true;  // the times of impacts are known, and the impact at a cut is counted
};

// `from_contact`: a flight of zero height at the start, caused by rounding, counts as contact.
Course course_of(const Trajectory& trajectory, bool from_contact = false);
Course course_of(const TrueExecution& truth, double end_time);
// The part of the course before `time`.
Course until(Course course, double time);
// For example "3+ C 2 ...": the number of impacts of each phase, + if a Zeno point follows, C for contact.
std::string to_text(const Course& course);

// The first difference of a run's course from the reference.
struct Difference {
    enum class Kind { missed_impact, extra_impact, missed_release, extra_release, zeno_time, no_zeno };
    Kind kind;
    std::size_t stretch = 0, impact = 0;  // the stretch and its impact, counted from 0
    double last = 0.0;                    // time of the last common event
    double t = 0.0;                       // time of the event that the other does not have; -1: not known yet
    // Time of the run's impact with this number, if both have one but the times differ too much.
    std::optional<double> own_time;
};
std::string to_text(Difference::Kind kind);

// `same` lists impacts (stretch, number) that are known to be equal although their times differ. The number `zeno`
// denotes the Zeno point of a stretch.
constexpr std::size_t zeno = static_cast<std::size_t>(-1);
using Impacts = std::set<std::pair<std::size_t, std::size_t>>;
std::optional<Difference> first_difference(const Course& own, const Course& truth, const Impacts& same);

}  // namespace achilles::test
