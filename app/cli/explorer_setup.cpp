#include "cli/explorer_setup.hpp"

#include <algorithm>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/entries.hpp"
#include "cli/manual.hpp"
#include "panels/widgets.hpp"
#include "pictures/thumbnails.hpp"
#include "session/recipe.hpp"

namespace achilles {

std::vector<Command> opening(const Session& session, const ExploreOptions& options) {
    std::vector<Command> commands{command::Open{session.system()}};
    for (const auto group : options_by_command(session.description().options, session.run().options)) {
        const bool is_given = std::any_of(group.begin(), group.end(), [&](const Option& option) {
            return options.overrides.given(option) != nullptr;
        });
        if (is_given) commands.emplace_back(command::UseOption(group[0], session.run().options));
    }
    for (const std::string& setting : options.settings) {
        std::string name = setting.substr(0, setting.find('='));
        name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
        if (const auto value = session.value(name)) commands.emplace_back(command::Set{name, *value});
    }
    return commands;
}

SurfaceOptions surface_options(const ExploreOptions& options) {
    SurfaceOptions surface;
    surface.width = options.width;
    surface.height = options.height;
    surface.scale = options.scale;
    surface.figure_text_size = screen_text_size;
    surface.fonts = assets() / "fonts";
    return surface;
}

PanelState panel_state(bool in_window) {
    PanelState state;
    state.systems = known_systems();
    state.tours = known_tours();
    for (const ManualTopic& topic : manual_topics()) state.manual.push_back({topic.name, topic.title});
    state.manual_page = [](const std::string& topic) { return manual_page(topic); };
    state.in_window = state.reads_folders = in_window;
    state.thumbnails = std::make_shared<Thumbnails>(find_system, !in_window);
    return state;
}

}  // namespace achilles
