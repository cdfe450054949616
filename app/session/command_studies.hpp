// The commands that ask more of the present run than the run itself (command.hpp has all others).
#pragma once

#include <string>
#include <vector>

#include "session/command_fields.hpp"

namespace achilles::command {

struct ShowSweep {
    std::string text;  // as on the command line, but for --set and the options: these are what the session has
    static constexpr auto said = Said("sweep", "write: sweep \"--over e=0:0.95:512 --print zeno_time(1)\"",
                                      Change::view, Field(&ShowSweep::text, in_quotes));
};
struct StopProof {  // and forgets what was proved
    static constexpr auto said = Said("prove off", alone, Change::view);
};
struct Prove {
    double width = 0.0;                  // half, for all coordinates and rates of the start
    std::vector<std::string> intervals;  // NAME=LOW..HIGH, which hold what the present run has
    static constexpr auto said =
        Said("prove", "write: prove [width W] [NAME=LOW..HIGH ...], or: prove off", Change::view,
             Field(&Prove::width, length_after("width")), Field(&Prove::intervals, {.may_lack = true}));
};
struct StopOrbit {  // and forgets what was found
    static constexpr auto said = Said("orbit off", alone, Change::view);
};
struct FindOrbit {
    std::string text;  // as on the command line, but for --set and the options: these are what the session has
    static constexpr auto said =
        Said("orbit", "write: orbit \"--from start --continue e=0.1:0.9\", orbit \"\", or: orbit off", Change::view,
             Field(&FindOrbit::text, in_quotes));
};
struct GoOnOrbit {
    int point = 1;  // of the branch, or 1: the run begins there, with its parameters
    static constexpr auto said = Said("branch", "write: branch NUMBER, a point of the branch that `orbit` has followed",
                                      Change::together, &GoOnOrbit::point);
};
struct ShowDependence {
    std::string quantity;  // an expression as a sweep prints it
    static constexpr auto said =
        Said("depend", "write: depend \"zeno_time(2)\", or another expression in the end and the events of a run",
             Change::view, Field(&ShowDependence::quantity, in_quotes));
};

}  // namespace achilles::command
