// Tables for the clipboard and a spreadsheet: separated by tabs, with all digits, in displayed units.
#pragma once

#include <string>

#include "session/session.hpp"

namespace achilles {

// The selected event or, without one, all events: contacts, time, state after the event, energy lost, sentence and, if
// the run is proved, the proved interval of the time.
std::string events_table(const Session& session);
// The quantities of one plot at the instants of the run, or of all plots (number 0), one table after the other.
std::string plots_table(const Session& session, int number);

}  // namespace achilles
