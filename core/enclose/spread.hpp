// Intervals for a proof as typed on the command line: --width W, --set NAME=LOW..HIGH.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "enclose/enclosure.hpp"

namespace achilles {

struct Spread {
    struct Side {
        std::string name;  // a parameter, an initial coordinate x, or an initial rate x'
        double low = 0.0, high = 0.0;
        friend bool operator==(const Side&, const Side&) = default;
    };
    double width = 0.0;  // half width for all initial coordinates and rates
    std::vector<Side> sides;
    friend bool operator==(const Spread&, const Spread&) = default;
};

// Parses "e=0.4..0.6"; nullopt for a single number. Throws InputError for an unknown name, an invalid number or
// LOW > HIGH.
std::optional<Spread::Side> read_side(const std::string& setting, const SystemDescription& description);
std::string to_text(const Spread::Side& side);

// "start ± 1e-06, e in [0.4, 0.6]"; empty if there is no spread.
std::string told(const Spread& spread);

// The numbers of a run as typed (claim_as_written), widened by the spread.
Claim claim_of(const SystemDescription& description, const Run& run, const Spread& spread);

}  // namespace achilles
