// Compares two executions from one start: the events of each contact and their times.
#pragma once

#include <string>
#include <vector>

#include "certify/execution.hpp"
#include "run/trajectory.hpp"

namespace achilles::test {

// An execution by contact: impacts up to a Zeno point, contact up to a release or opening, impacts, and so on.
struct Outline {
    struct BounceOutline {
        std::vector<double> impacts;  // times
        double zeno_low = 0.0, zeno_high = 0.0;
    };
    struct ContactOutline {
        std::vector<BounceOutline> bounces{1};  // the last one may have no Zeno point
        std::vector<double> leaves;             // times of release, or of opening by an impact
        std::size_t zenos = 0;
    };
    std::vector<ContactOutline> contacts;
    Vector end;
    bool ends_alone = false;  // recorded without events
};
Outline outline_of(const Trajectory& trajectory);
Outline outline_of(const TrueExecution& truth);  // one contact only

// The largest difference of event times (s) and of the final state. Infinite if the events differ.
struct Distance {
    double size = 0.0;
    std::string where;
    void add(double more, const std::string& place);
};

// The distance of `b` from `a`: times of impacts before the cut, of Zeno points (beyond the certified interval) and of
// releases, and the final state. The two may be cut at different impacts, so only common impacts are compared. Without
// recorded events, releases and the final state are compared.
Distance between(const Outline& a, const Outline& b);

}  // namespace achilles::test
