// A run as one page for a browser: the mechanism in motion, plots and events, with a player. The page needs no other file,
// no server and no network, and has the same bytes each time.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "run/trajectory.hpp"
#include "sensitivity/error_estimate.hpp"
#include "system/description.hpp"

namespace achilles {

struct PlayerTexts {
    std::string answer;   // what `simulate` prints about the run; its first line begins with the title
    std::string command;  // the command line that makes the page
};

// The page. Texts of a system are never markup or script: they are escaped, and the page forbids every script but its own
// and every access to the network. Throws InputError if a view cannot be evaluated.
std::string player_page(const Trajectory& trajectory, const ErrorEstimate& estimate,
                        std::span<const ViewDescription> views, const PlayerTexts& texts);

// The command line `achilles html` for this run of a system, by its name, with these views.
std::string player_command(const Trajectory& trajectory, const std::string& system,
                           const std::vector<std::string>& views);

// Text for HTML, also inside a quoted attribute. Control characters become '?'.
std::string html_escaped(std::string_view text);

}  // namespace achilles
