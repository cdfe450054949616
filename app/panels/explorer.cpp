// The frame: what stands where.
#include <algorithm>
#include <string>

#include "panels/print.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr ImGuiWindowFlags fixed_window = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus;
constexpr ImGuiWindowFlags still_window =
    fixed_window | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

constexpr float card_padding = 10.0F;

// A window that fills its part of the surface.
template <class Content>
void part(const char* name, const Rectangle& area, ImGuiWindowFlags flags, const Content& content) {
    ImGui::SetNextWindowPos({area.x, area.y});
    ImGui::SetNextWindowSize({std::max(area.width, 1.0F), std::max(area.height, 1.0F)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    if (ImGui::Begin(name, nullptr, flags)) content();
    ImGui::End();
    ImGui::PopStyleVar();
}

struct Parts {
    Rectangle controls, caption, mechanism, timeline, plots, events, status, error;
};

float card_height(const std::string& message, float width) {
    const float inside = width - 2.0F * (ImGui::GetStyle().WindowPadding.x + units(card_padding));
    return ImGui::GetStyle().WindowPadding.y + 2.0F * units(card_padding) + message_height(message, inside);
}

// Everything from the size of the surface and of the text. The centre and the plots share what the controls leave; the
// events get what they need to be read, or more where there is room.
Parts lay_out(const Session& session, const PanelState& state, const std::string& message) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float padding = ImGui::GetStyle().WindowPadding.y;
    const float status = ImGui::GetFrameHeight() + units(8.0F);
    const bool wide = session.shows_editor();  // a text needs room for its lines
    const float left = wide ? std::floor(std::min(std::max(0.36F * size.x, units(420.0F)), 0.6F * size.x))
                            : std::floor(std::clamp(0.2F * size.x, units(288.0F), units(340.0F)));
    const float events = std::floor(std::max(units(180.0F), 0.27F * size.y));
    const float width = size.x - left, height = size.y - status - events;
    const float centre = std::floor(0.46F * width);
    const float timeline = timeline_height() + 2.0F * padding;
    Parts parts;
    // Beside a text the events would be too narrow for what a certificate says: they stand below it.
    parts.controls = {0.0F, 0.0F, left, wide ? height : size.y - status};
    const float error = message.empty() ? 0.0F : card_height(message, centre);
    const float said = caption_height(session, state, centre - 2.0F * padding);
    const float caption = said > 0.0F ? said + padding : 0.0F;
    parts.error = {left, 0.0F, centre, error};
    parts.caption = {left, error, centre, caption};
    parts.mechanism = {left, error + caption, centre, height - timeline - error - caption};
    parts.timeline = {left, height - timeline, centre, timeline};
    parts.plots = {left + centre, 0.0F, width - centre, height};
    parts.events = wide ? Rectangle{0.0F, height, size.x, events} : Rectangle{left, height, width, events};
    parts.status = {0.0F, size.y - status, size.x, status};
    return parts;
}

// What the last command was refused for; without the editor also why its text is no system.
std::string card_text(const Session& session) {
    const auto& problems = session.document().problems;
    if (!session.error().empty()) return session.error();
    if (session.shows_editor() || problems.empty()) return session.notice();
    return problems.front().what();
}

void show_card(const Session& session, const std::string& message) {
    Rectangle area = remaining();
    area.height += ImGui::GetStyle().WindowPadding.y;
    const float width = area.width - 2.0F * units(card_padding);
    const bool is_good = message == session.notice();
    if (!is_good) paint_error_card(area);
    ImGui::SetCursorScreenPos({area.x + units(card_padding), area.y + units(card_padding)});
    ImGui::BeginGroup();
    if (is_good)
        paragraph(message, width, text_color());
    else
        show_message(message, width);
    ImGui::EndGroup();
}

// Ctrl+Z and Ctrl+Shift+Z or Ctrl+Y, unless a text field has them.
void use_keys(const Session& session, Commands& commands) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || !io.KeyCtrl) return;
    const bool z = ImGui::IsKeyPressed('Z'), again = ImGui::IsKeyPressed('Y') || (z && io.KeyShift);
    if (again && session.can_redo()) commands.emplace_back(command::Redo{});
    if (z && !io.KeyShift && session.can_undo()) commands.emplace_back(command::Undo{});
}

// What the last command copied goes to the clipboard, once.
void copy(const Session& session, PanelState& state) {
    if (session.copies() == state.copies) return;
    state.copies = session.copies();
    ImGui::SetClipboardText(session.copied().c_str());
}

}  // namespace

std::vector<Command> explorer(const Session& session, PanelState& state) {
    Commands commands;
    const std::string message = card_text(session);
    const Parts parts = lay_out(session, state, message);
    part("controls", parts.controls, session.shows_editor() ? still_window : fixed_window, [&] {
        show_system(session, state, commands);
        if (session.shows_editor())
            show_editor(session, state, commands);
        else
            show_controls(session, state, commands);
        show_dialogs(session, state, commands);
    });
    if (parts.error.height > 0.0F) {
        part("error", parts.error, still_window, [&] { show_card(session, message); });
    }
    if (parts.caption.height > 0.0F)
        part("caption", parts.caption, still_window, [&] { show_caption(session, state, commands); });
    part("mechanism", parts.mechanism, still_window, [&] { show_mechanism(session, state, commands); });
    part("timeline", parts.timeline, still_window, [&] { show_timeline(session, state, commands); });
    part("plots", parts.plots, still_window, [&] {
        if (lens_is_open(session))
            show_lens(session, state, commands);
        else
            show_plots(session, state, commands);
    });
    part("events", parts.events, still_window, [&] { show_events(session, state, commands); });
    part("status", parts.status, still_window, [&] { show_status(session, state); });
    use_keys(session, commands);
    copy(session, state);
    return commands;
}

}  // namespace achilles
