// What a proof shall hold for besides the numbers of one run, as a person says it: --width W, --set NAME=LOW..HIGH.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "enclose/enclosure.hpp"

namespace achilles {

struct Spread {
    struct Side {
        std::string name;  // a parameter, a coordinate's start x or its rate x'
        double low = 0.0, high = 0.0;
        friend bool operator==(const Side&, const Side&) = default;
    };
    double width = 0.0;  // half, for all coordinates and rates of the start
    std::vector<Side> sides;
    friend bool operator==(const Spread&, const Spread&) = default;
};

// "e=0.4..0.6"; nothing where it is one number. Throws InputError for a name or a number that is none, and for an interval that
// is written backwards.
std::optional<Spread::Side> read_side(const std::string& setting, const SystemDescription& description);
std::string to_text(const Spread::Side& side);

// "start ± 1e-06, e in [0.4, 0.6]"; empty: the run's own numbers.
std::string told(const Spread& spread);

// The numbers of a run as a person wrote them, with the spread about them.
Claim claim_of(const SystemDescription& description, const Run& run, const Spread& spread);

}  // namespace achilles
