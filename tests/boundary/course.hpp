// The course of an execution: its phases in order, with the impacts that are events. What a run and the truth can be
// compared by, whether the run keeps its events or its end alone.
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
    std::vector<double> impacts;  // times, as far as they are kept
    std::size_t count = 0;        // of impacts
    // The bouncing was cut at the last of these impacts, or (the truth's) is settled: what follows is no event.
    bool cut = false;
    double zeno_low = 0.0, zeno_high = 0.0;  // if it reached its Zeno point
};

struct Course {
    std::vector<Stretch> stretches;
    double end = 0.0;
    bool timed = true;  // the times of impacts are known, and the one at a cut is counted
};

// A start in contact that rounding made a flight of no height counts as contact.
Course course_of(const Trajectory& trajectory, bool from_contact = false);
Course course_of(const TrueExecution& truth, double end_time);
// What of it is before a time.
Course until(Course course, double time);
// "3+ C 2 ...": impacts by phase, + where they go on to a Zeno point, C for contact.
std::string to_text(const Course& course);

// Where a run's course first is not the true one.
struct Difference {
    enum class Kind { missed_impact, extra_impact, missed_release, extra_release, zeno_time, no_zeno };
    Kind kind;
    std::size_t stretch = 0, impact = 0;  // which stretch, and which of its impacts, from 0
    double last = 0.0;                    // of the last event before that both have
    double t = 0.0;                       // when the one has what the other lacks; -1: not known yet
    // Both have an impact of this number, the run's at this time, but too far away to be the same.
    std::optional<double> own_time;
};
std::string to_text(Difference::Kind kind);

// `same`: impacts (stretch, number) known to be the same one although their times differ; number `zeno` is the Zeno
// point of a stretch.
constexpr std::size_t zeno = static_cast<std::size_t>(-1);
using Impacts = std::set<std::pair<std::size_t, std::size_t>>;
std::optional<Difference> first_difference(const Course& own, const Course& truth, const Impacts& same);

}  // namespace achilles::test
