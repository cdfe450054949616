// The lecture (F11): what a class looks at. The arrangement leaves out everything else.
#include <algorithm>
#include <cmath>

#include "expression/parse.hpp"
#include "figure/label.hpp"
#include "panels/panels.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

constexpr std::size_t most_lecture_sliders = 3;

// Plays the value from one end of its slider to the other, or stops that.
void animation_button(const Session& session, const std::string& name, PanelState& state, Commands& commands) {
    const bool is_moving = session.animation() != nullptr && session.animation()->name == name;
    const float size = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Button(("##animate " + name).c_str(), {size, size})) {
        const SweepAxis range = *axis_for(session, name);
        // Stopped by hand, the value stays where it is, in a journal, too.
        if (is_moving)
            commands.insert(commands.end(),
                            {Command(command::StopAnimation{}), Command(command::Set{name, *session.value(name)})});
        else
            commands.emplace_back(command::Animate{name, range.low, range.high, 0.0});
    }
    remember(state, "animate " + name);
    tooltip(is_moving ? "stop" : "play from one end of the slider to the other");
    paint_play_sign({at.x + 0.5F * size, at.y + 0.5F * size}, is_moving);
}

}  // namespace

float lecture_title_height() { return 1.3F * ImGui::GetTextLineHeight(); }

void show_lecture_title(const Session& session) {
    const Rectangle area = remaining();
    const float size = 1.15F * ImGui::GetFontSize();
    const std::string& title = session.description().title;
    const float width = label_width(title, size);
    const std::string shown = width <= area.width ? title : fitted(title, area.width / 1.15F);
    paint_label(ImGui::GetWindowDrawList(), area.x, area.y, shown, text_color(), size);
}

// Chosen by `present on NAME ...`; else those that differ from the file; else the restitution or the first parameter.
std::vector<std::string> lecture_sliders(const Session& session) {
    if (!session.scene().lecture_sliders().empty()) return session.scene().lecture_sliders();
    std::vector<std::string> names;
    Run file = session.file_run();
    for (const std::string& name : settable_names(session.description()))
        if (names.size() < most_lecture_sliders &&
            session.value(name) != *find_value(session.description(), file, name))
            names.push_back(name);
    if (!names.empty()) return names;
    const SweepSpec usual = read_sweep(default_sweep(session.description()), session.description());
    return {usual.axes.front().name};
}

void show_lecture_sliders(const Session& session, PanelState& state, Commands& commands) {
    const std::vector<std::string> names = lecture_sliders(session);
    const Rectangle area = remaining();
    const float between = units(24.0F), count = static_cast<float>(std::max<std::size_t>(names.size(), 1));
    // One slider does not need the whole width.
    const float width = std::min((area.width - between * (count - 1.0F)) / count, units(420.0F));
    for (std::size_t i = 0; i < names.size(); ++i) {
        const float x = area.x + (width + between) * static_cast<float>(i), button = ImGui::GetFrameHeight();
        ImGui::SetCursorScreenPos({x, area.y});
        animation_button(session, names[i], state, commands);
        ImGui::SetCursorScreenPos({x + button + units(8.0F), area.y});
        ImGui::BeginChild(("lecture " + names[i]).c_str(), {width - button - units(8.0F), area.height}, false,
                          ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
        show_value_slider(session, names[i], state, commands);
        ImGui::EndChild();
    }
}

}  // namespace achilles
