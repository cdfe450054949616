// The explorer's frame: widgets read the session and return what the user wants. One function builds it, for the window
// and for pictures, so both show the same bytes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "paint/paint.hpp"
#include "session.hpp"

namespace achilles {

struct SystemEntry {
    std::string name, title;
};

// What belongs to the view and not to the session, so is in no journal.
struct PanelState {
    std::vector<SystemEntry> systems;         // to choose from
    bool in_window = false;                   // a window may show how long the run took; a picture must not
    bool show_impacts = true;                 // in the event list
    bool loop = false;                        // at the end of the run the player begins again
    int followed = -1;                        // the row the event list scrolled to last
    std::map<std::string, Rectangle> places;  // where the last frame put a control ("set g", "play"): tests look here
};

// One frame over the whole surface: call between ImGui::NewFrame() and ImGui::Render().
std::vector<Command> explorer(const Session& session, PanelState& state);

// Its parts, each inside a window of its own that the explorer has begun.
using Commands = std::vector<Command>;
void show_controls(const Session& session, PanelState& state, Commands& commands);
void show_error(const Session& session);
float error_height(const Session& session, float width);
void show_mechanism(const Session& session);
void show_timeline(const Session& session, PanelState& state, Commands& commands);
float timeline_height();
void show_plots(const Session& session, PanelState& state, Commands& commands);
void show_events(const Session& session, PanelState& state, Commands& commands);
// What is proved at a Zeno event: the facts, line by line, and every inequality with both sides and the one that
// decided.
std::vector<std::string> certificate_lines(const Event& event);
void show_certificate(const Event& event, int number, PanelState& state, Commands& commands);
void show_status(const Session& session, const PanelState& state);

}  // namespace achilles
