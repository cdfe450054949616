// The left column: which system, and every value a hand may change.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "panels/print.hpp"
#include "panels/slider.hpp"
#include "panels/widgets.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// "double pendulum" for the file double_pendulum.toml: short enough for the column, whatever the title.
std::string short_name(const std::string& system) {
    std::string name = std::filesystem::path(system).stem().string();
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

void choose_system(const Session& session, PanelState& state, Commands& commands, float width) {
    ImGui::SetNextItemWidth(width);
    const bool is_down =
        ImGui::BeginCombo("##system", short_name(session.system()).c_str(), ImGuiComboFlags_HeightLargest);
    remember(state, "systems");
    if (is_down) {
        for (const SystemEntry& entry : state.systems) {
            const bool is_open = entry.name == session.system();
            if (ImGui::Selectable((entry.title + "##" + entry.name).c_str(), is_open))
                request(session, state, command::Open{entry.name}, commands);
            remember(state, "open " + entry.name);
        }
        ImGui::EndCombo();
    }
}

void describe_system(const Session& session) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {units(8.0F), units(2.0F)});
    const float width = ImGui::GetContentRegionAvail().x;
    const SystemDescription& description = session.description();
    if (!description.title.empty()) paragraph(description.title, width, text_color());
    if (!description.source.empty()) paragraph(description.source, width, faint_color());
    ImGui::PopStyleVar();
}

bool same(const Truncation& a, const Truncation& b) {
    return a.eps_q == b.eps_q && a.eps_v == b.eps_v && a.eps_t == b.eps_t && a.conditions == b.conditions &&
           a.reinitialization == b.reinitialization;
}

// Whether every value is as the file has it.
bool is_original(const Run& run, const Run& file) {
    return run.parameters == file.parameters && run.q == file.q && run.v == file.v &&
           run.options.end_time == file.options.end_time && run.options.tolerance == file.options.tolerance &&
           same(run.options.truncation, file.options.truncation);
}

// The first heading; at its right end what puts all values back, if there is something to put back.
void first_section(const char* title, const Session& session, const Run& file, PanelState& state, Commands& commands) {
    const char* text = "reset all";
    const bool changed = !is_original(session.run(), file);
    const float width = ImGui::CalcTextSize(text).x;
    section(title, changed ? width + units(8.0F) : 0.0F);
    if (!changed) return;
    const ImVec2 low = ImGui::GetItemRectMin();
    const float right = ImGui::GetWindowPos().x + ImGui::GetContentRegionMax().x;
    ImGui::SameLine(0.0F, 0.0F);
    ImGui::SetCursorScreenPos({right - width, low.y});
    if (ImGui::InvisibleButton("reset all", {width, ImGui::GetTextLineHeight()}))
        commands.emplace_back(command::Reset{});
    remember(state, "reset all");
    tooltip("every value as the file has it");
    const Color color = ImGui::IsItemHovered() ? text_color() : current_theme().accent;
    ImGui::GetWindowDrawList()->AddText({std::floor(right - width), low.y}, packed(color), text);
}

void parameters(const Session& session, const Run& file, PanelState& state, Commands& commands) {
    const auto& all = session.description().parameters;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const ParameterDescription& p = all[i];
        const bool is_angle = p.unit == "rad";
        Slider slider{typeset_name(p.name),
                      "set " + p.name,
                      is_angle ? "\u00b0" : typeset_unit(p.unit),
                      p.about.empty() ? p.name : p.name + ": " + p.about,
                      session.run().parameters[i],
                      p.range[0],
                      p.range[1],
                      file.parameters[i],
                      is_angle ? degrees(1.0) : 1.0};
        if (moved(slider, state)) commands.emplace_back(command::Set{p.name, slider.value});
    }
}

// A coordinate's start, or the rate at the start.
void start_value(const Session& session, const Run& file, std::size_t i, bool is_rate, PanelState& state,
                 Commands& commands) {
    const CoordinateDescription& c = session.description().coordinates[i];
    const bool is_angle = c.unit == "rad";
    const auto& range = is_rate ? c.rate_range : c.range;
    const auto at = static_cast<Eigen::Index>(i);
    const std::string name = is_rate ? c.name + "'" : c.name;
    std::string unit = is_angle ? "\u00b0" : typeset_unit(c.unit);
    if (is_rate && !unit.empty()) unit += "/s";
    Slider slider{typeset_name(name) + "(0)",
                  "set " + name,
                  unit,
                  fmt::format("{} of {} at the start", is_rate ? "rate" : "value", c.name),
                  is_rate ? session.run().v[at] : session.run().q[at],
                  range[0],
                  range[1],
                  is_rate ? file.v[at] : file.q[at],
                  is_angle ? degrees(1.0) : 1.0};
    if (moved(slider, state)) commands.emplace_back(command::Set{name, slider.value});
}

// A row of buttons of which one is down.
template <class Value, class Make>
void choice(const char* id, const std::string& title, const std::string& about, Value now, Value original,
            std::initializer_list<Value> all, PanelState& state, Commands& commands, const Make& make) {
    label(title, units(label_width));
    tooltip(about);
    if (now != original) {
        mark_changed();
        if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right))
            commands.emplace_back(make(original));
    }
    ImGui::SameLine(0.0F, 0.0F);
    const float width =
        (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemInnerSpacing.x) / static_cast<float>(all.size());
    bool first = true;
    for (const Value value : all) {
        if (!first) ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
        first = false;
        const std::string word(to_text(value));
        const ImGuiCol color = value == now ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg;
        ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(color));
        if (ImGui::Button((word + "##" + id).c_str(), {width, 0.0F}) && value != now)
            commands.emplace_back(make(value));
        ImGui::PopStyleColor();
        remember(state, std::string(id) + " " + word);
        tooltip(about);
    }
}

void truncation(const Session& session, const Run& file, PanelState& state, Commands& commands) {
    const Truncation &t = session.run().options.truncation, &own = file.options.truncation;
    section("Truncation of the bouncing");
    const auto eps = [&](const char* name, const char* id, double value, double original, const char* about) {
        Slider slider{name, id, "", about, value, 1e-12, 1e-1, original, 1.0, 3};
        return moved(slider, state) ? slider.value : value;
    };
    // One slider for all three, and one for each.
    const double all = eps("\u03b5, all", "eps", t.eps_q, own.eps_q, "all three bounds below at once");
    const double q =
        eps("   position", "eps q", t.eps_q, own.eps_q, "bound on the error of the position at the Zeno point");
    const double v =
        eps("   velocity", "eps v", t.eps_v, own.eps_v, "bound on the error of the velocity at the Zeno point");
    const double time = eps("   time", "eps t", t.eps_t, own.eps_t, "bound on the error of the Zeno time, s");
    if (all != t.eps_q)
        commands.emplace_back(command::Eps{all, all, all});
    else if (q != t.eps_q || v != t.eps_v || time != t.eps_t)
        commands.emplace_back(command::Eps{q, v, time});
    choice<Conditions>(
        "conditions", "conditions",
        "what must be proved before the bouncing is cut short: the paper's inequalities (Def. 7), or the sharp ones, "
        "which choose their own neighbourhood and certify the restarted motion",
        t.conditions, own.conditions, {Conditions::paper, Conditions::sharp}, state, commands,
        [](Conditions c) { return command::UseConditions{c}; });
    choice<Reinitialization>("reinitialization", "restart",
                             "the velocity the constrained motion starts with: the paper's "
                             "euclidean projection, or the kinetic one of a plastic impact",
                             t.reinitialization, own.reinitialization,
                             {Reinitialization::euclidean, Reinitialization::kinetic}, state, commands,
                             [](Reinitialization r) { return command::UseReinitialization{r}; });
}

void integration(const Session& session, const Run& file, PanelState& state, Commands& commands) {
    const Options& o = session.run().options;
    section("Integration");
    Slider tolerance{"tolerance", "tolerance",
                     "",          "local error per step, absolute and relative",
                     o.tolerance, 1e-14,
                     1e-4,        file.options.tolerance,
                     1.0,         3};
    if (moved(tolerance, state)) commands.emplace_back(command::Tolerance{tolerance.value});
    // Of the file, not of the run: a range that grew with the value would run away under the hand.
    const double longest = std::max(50.0, 2.0 * file.options.end_time);
    Slider end{"end", "end", "s", "the run stops here at the latest", o.end_time, 0.1, longest, file.options.end_time};
    if (moved(end, state)) commands.emplace_back(command::End{end.value});
}

}  // namespace

void show_system(const Session& session, PanelState& state, Commands& commands) {
    const float width = units(52.0F), space = ImGui::GetStyle().ItemInnerSpacing.x;
    choose_system(session, state, commands, ImGui::GetContentRegionAvail().x - width - space);
    ImGui::SameLine(0.0F, space);
    const bool shown = session.shows_editor();
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(shown ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg));
    if (ImGui::Button("text", {width, 0.0F})) toggle_editor(session, state, commands);
    ImGui::PopStyleColor();
    remember(state, "editor");
    tooltip(shown ? "back to the sliders (Ctrl+E)" : "edit the text of the system (Ctrl+E)");
}

void show_controls(const Session& session, PanelState& state, Commands& commands) {
    describe_system(session);
    // Rows close enough that most systems need no scrolling.
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, units(3.0F)});
    const Run& file = session.file_run();
    const bool has_parameters = !file.parameters.empty();
    if (has_parameters) first_section("Parameters", session, file, state, commands);
    parameters(session, file, state, commands);
    if (has_parameters)
        section("Start");
    else
        first_section("Start", session, file, state, commands);
    for (std::size_t i = 0; i < session.description().coordinates.size(); ++i)
        for (const bool is_rate : {false, true}) start_value(session, file, i, is_rate, state, commands);
    truncation(session, file, state, commands);
    integration(session, file, state, commands);
    ImGui::PopStyleVar();
}

}  // namespace achilles
