// Two executions of one start beside one another: what happens to each contact, and when.
#pragma once

#include <string>
#include <vector>

#include "certify/execution.hpp"
#include "run/trajectory.hpp"

namespace achilles::test {

// An execution as what happens to each contact: it bounces until it rests, rests until it leaves, bounces.
struct Outline {
    struct Bouncing {
        std::vector<double> impacts;  // times
        double zeno_low = 0.0, zeno_high = 0.0;
    };
    struct OfContact {
        std::vector<Bouncing> bounces{1};  // the last one may lack its Zeno point
        std::vector<double> leaves;        // times: released, or opened by an impact
        std::size_t zenos = 0;
    };
    std::vector<OfContact> contacts;
    Vector end;
    bool ends_alone = false;  // no events are kept
};
Outline outline_of(const Trajectory& trajectory);
Outline outline_of(const TrueExecution& truth);  // of one contact

// The largest difference between times, s, and in the end state; infinite where other things happen.
struct Distance {
    double size = 0.0;
    std::string where;
    void add(double more, const std::string& place);
};

// How far `b` is from `a`: the times of impacts before the bouncing was cut, of Zeno points (beyond what is certified) and
// of leaving, and the end. A bouncing may have been cut at another impact, so those that both have are compared. Of a
// trajectory that keeps its end alone, the leaving and the end.
Distance between(const Outline& a, const Outline& b);

}  // namespace achilles::test
