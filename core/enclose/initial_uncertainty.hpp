// Intervals for a proof as typed on the command line: --width W, --set NAME=LOW..HIGH.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "enclose/enclosure.hpp"

namespace achilles {

struct InitialUncertainty {
    struct VariableRange {
        std::string name;  // a parameter, an initial coordinate x, or an initial rate x'
        double low = 0.0, high = 0.0;
        friend bool operator==(const VariableRange&, const VariableRange&) = default;
    };
    double width = 0.0;  // half width for all initial coordinates and rates
    std::vector<VariableRange> sides;
    friend bool operator==(const InitialUncertainty&, const InitialUncertainty&) = default;
};

// Parses "e=0.4..0.6"; nullopt for a single number. Throws InputError for an unknown name, an invalid number or
// LOW > HIGH.
std::optional<InitialUncertainty::VariableRange> parse_interval(const std::string& setting,
                                                                const SystemDescription& description);
std::string to_text(const InitialUncertainty::VariableRange& side);

// "start ± 1e-06, e in [0.4, 0.6]"; empty if there is no spread.
std::string describe(const InitialUncertainty& spread);

// The numbers of a run as typed (problem_from_decimals), widened by the spread.
EnclosureProblem problem_of(const SystemDescription& description, const Run& run, const InitialUncertainty& spread);

}  // namespace achilles
