// The left column: the system, and all values and options that the user can change.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "panels/panels.hpp"
#include "panels/slider.hpp"
#include "panels/widgets.hpp"
#include "session/replay_script.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// "double pendulum" for the file double_pendulum.toml; short enough for the column.
std::string short_name(const std::string& system) {
    std::string name = std::filesystem::path(system).stem().string();
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

void choose_system(const Session& session, PanelState& state, Commands& commands, float width) {
    ImGui::SetNextItemWidth(width);
    const std::string whole = short_name(session.system());
    const std::string name = fitted(whole, width - ImGui::GetFrameHeight() - 2.0F * ImGui::GetStyle().FramePadding.x);
    const bool is_down = ImGui::BeginCombo("##system", name.c_str(), ImGuiComboFlags_HeightLargest);
    remember(state, "systems");
    if (!is_down && name != whole) tooltip(whole);
    if (is_down) {
        std::string group;
        for (const SystemEntry& entry : state.systems) {
            if (entry.group != std::exchange(group, entry.group)) section(entry.group.c_str());
            const bool is_open = entry.name == session.system();
            if (ImGui::Selectable((entry.title + "##" + entry.name).c_str(), is_open))
                request(session, state, command::Open{entry.name}, commands);
            remember(state, "open " + entry.name);
        }
        close_by_escape(state);
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

// The first heading, with a "reset all" button at its right end if any value differs from the file.
void first_section(const char* title, const Session& session, const Run& file, PanelState& state, Commands& commands) {
    const char* text = "reset all";
    const bool changed = session.run() != file;
    const float width = ImGui::CalcTextSize(text).x;
    section(title, changed ? width + units(8.0F) : 0.0F);
    if (!changed) return;
    const ImVec2 low = ImGui::GetItemRectMin();
    const float right = ImGui::GetWindowPos().x + content_right();
    ImGui::SameLine(0.0F, 0.0F);
    ImGui::SetCursorScreenPos({right - width, low.y});
    if (ImGui::InvisibleButton("reset all", {width, ImGui::GetTextLineHeight()}))
        commands.emplace_back(command::Reset{});
    remember(state, "reset all");
    tooltip("reset every value to that of the file");
    const Color color = ImGui::IsItemHovered() ? text_color() : current_theme().accent;
    ImGui::GetWindowDrawList()->AddText({std::floor(right - width), low.y}, packed(color), text);
}

// An option as a slider or as a row of buttons, one of which is selected.
struct OptionRow {
    const char* key;
    const char* id;  // name of its area, for a slider
    const char* title;
    const char* about;
    double low = 0.0, high = 1.0;  // range of the slider
    int digits = 3;                // digits of a dragged value
};

void choice(const OptionRow& row, const Options& now, const Options& file, PanelState& state, Commands& commands) {
    const Option& chosen = option(row.key);
    const auto choose = [&](const OptionValue& value) {
        Options changed = now;
        chosen.set(changed, value);
        commands.emplace_back(command::SetOption(chosen, changed));
    };
    label(row.title, units(row_name_width));
    tooltip(row.about);
    if (chosen.get(now) != chosen.get(file)) {
        mark_changed();
        if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) choose(chosen.get(file));
    }
    ImGui::SameLine(0.0F, 0.0F);
    const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemInnerSpacing.x) /
                        static_cast<float>(chosen.words.size());
    for (const std::string_view word : chosen.words) {
        if (word != chosen.words[0]) ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
        const bool is_down = chosen.get(now) == OptionValue(word);
        ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(is_down ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg));
        if (ImGui::Button(fmt::format("{}##{}", word, row.key).c_str(), {width, 0.0F}) && !is_down) choose(word);
        ImGui::PopStyleColor();
        remember(state, fmt::format("{} {}", row.key, word));
        tooltip(row.about);
    }
}

double number_in(const OptionValue& value) {
    const auto* count = std::get_if<int>(&value);
    return count != nullptr ? *count : std::get<double>(value);
}

// Shows the slider of an option in `options`. Returns true if the user moved it.
bool moved(const OptionRow& row, Options& options, const Options& file, PanelState& state) {
    const Option& slid = option(row.key);
    const bool is_of_cut = slid.table == "truncation", is_count = std::holds_alternative<int>(slid.get(options));
    Slider slider{row.title,
                  row.id,
                  is_of_cut ? "" : std::string(slid.unit),
                  row.about,
                  number_in(slid.get(options)),
                  row.low,
                  row.high,
                  number_in(slid.get(file)),
                  1.0,
                  row.digits};
    if (!moved(slider, state)) return false;
    if (is_count)
        slid.set(options, static_cast<int>(std::lround(std::clamp(slider.value, 1.0, 1e9))));
    else
        slid.set(options, slider.value);
    return true;
}

void bounds(const Options& now, const Options& file, PanelState& state, Commands& commands) {
    // One slider for all three bounds, and one for each.
    constexpr double low = 1e-12, high = 1e-1;
    const OptionRow all{"eps_q", "eps", "\u03b5, all", "set all three bounds below together", low, high};
    const OptionRow each[] = {
        {"eps_q", "eps q", "   position", "bound on the error of the position from the cut to the Zeno time", low,
         high},
        {"eps_v", "eps v", "   velocity", "bound on the error of the velocity at the Zeno time", low, high},
        {"eps_t", "eps t", "   time", "bound on the error of the Zeno time, s", low, high}};
    Options changed = now;
    const bool all_moved = moved(all, changed, file, state);
    const OptionValue common = option("eps_q").get(changed);
    if (all_moved) changed = now;
    for (const OptionRow& row : each) moved(row, changed, file, state);
    if (all_moved)
        for (const OptionRow& row : each) option(row.key).set(changed, common);
    if (changed != now) commands.emplace_back(command::SetOption(option("eps_q"), changed));
}

// A slider for one option.
void slide(const OptionRow& row, const Session& session, const Run& file, PanelState& state, Commands& commands) {
    Options changed = session.run().options;
    if (moved(row, changed, file.options, state)) commands.emplace_back(command::SetOption(option(row.key), changed));
}

// Options in the accuracy section.
constexpr const char* accuracy_keys[] = {"eps_q",     "eps_v",  "eps_t",       "conditions", "reinitialization",
                                         "tolerance", "method", "max_impacts", "max_steps"};

// Summary of the folded section: "ε 1e-06, sharp, tol 1e-10".
std::string accuracy_text(const Options& options) {
    const Truncation& t = options.truncation;
    const bool alike = t.eps_q == t.eps_v && t.eps_v == t.eps_t;
    return fmt::format("\u03b5 {}, {}, tol {}", alike ? fmt::format("{:.3g}", t.eps_q) : "mixed", to_text(t.conditions),
                       fmt::format("{:.3g}", options.tolerance));
}

// The heading that folds and unfolds the section; folded, it shows the summary. A colored dot means that an option
// differs from the file.
bool accuracy_heading(const Session& session, const Run& file, PanelState& state, Commands& commands) {
    const bool open = session.scene().shows("accuracy");
    const Options& now = session.run().options;
    ImGui::Dummy({0.0F, units(4.0F)});
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, line = ImGui::GetTextLineHeight();
    if (ImGui::InvisibleButton("accuracy", {std::max(width, 1.0F), line}))
        commands.emplace_back(command::Show{"accuracy", !open});
    remember(state, "accuracy");
    const bool changed = std::any_of(std::begin(accuracy_keys), std::end(accuracy_keys), [&](const char* key) {
        return option(key).get(now) != option(key).get(file.options);
    });
    const Color color = ImGui::IsItemHovered() ? text_color() : faint_color();
    tooltip(open ? "close" : "where the impact sequence is cut, and the integration tolerance");
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float r = units(4.0F);
    const ImVec2 c{at.x + r, std::floor(at.y + 0.5F * line) + 1.0F};
    if (open)
        list->AddTriangleFilled({c.x - r, c.y - 0.6F * r}, {c.x + r, c.y - 0.6F * r}, {c.x, c.y + r}, packed(color));
    else
        list->AddTriangleFilled({c.x - 0.6F * r, c.y - r}, {c.x - 0.6F * r, c.y + r}, {c.x + r, c.y}, packed(color));
    const char* const title = "Accuracy";
    const float text_at = at.x + units(14.0F), after = text_at + ImGui::CalcTextSize(title).x + units(8.0F);
    list->AddText({text_at, at.y}, packed(color), title);
    const float right = at.x + width;
    if (open) {
        list->AddLine({after, c.y}, {right, c.y}, ImGui::GetColorU32(ImGuiCol_Border));
        return true;
    }
    const std::string text = fitted(accuracy_text(now), right - after);
    list->AddText({std::floor(right - ImGui::CalcTextSize(text.c_str()).x), at.y},
                  packed(changed ? current_theme().accent : text_color()), text.c_str());
    return false;
}

// Options of the truncation and of the integration.
void accuracy(const Session& session, const Run& file, PanelState& state, Commands& commands) {
    if (!accuracy_heading(session, file, state, commands)) return;
    const Options& now = session.run().options;
    bounds(now, file.options, state, commands);
    choice({"conditions", "", "conditions",
            "what must be certified before a cut: the paper's inequalities (Def. 7), or the sharp ones"},
           now, file.options, state, commands);
    choice({"reinitialization", "", "restart",
            "velocity after a cut: the paper's Euclidean projection, or that of a plastic impact"},
           now, file.options, state, commands);
    slide({"tolerance", "tolerance", "tolerance", "integration tolerance: local error per step, absolute and relative",
           1e-14, 1e-4},
          session, file, state, commands);
    choice({"method", "", "method",
            "integration method: Taylor series, with an error estimate, or the Dormand-Prince formula"},
           now, file.options, state, commands);
    slide({"max_impacts", "max impacts", "impacts \u2264", "maximum number of impacts in the run", 100.0, 1e7}, session,
          file, state, commands);
    slide({"max_steps", "max steps", "steps \u2264", "maximum number of integration steps in the run", 1e3, 1e8},
          session, file, state, commands);
}

// Maximum number of lines of a list that follows. The list alone must not cause a scroll bar, which would move the rows
// under the mouse. If there is a scroll bar anyway, all lines.
std::size_t lines_that_fit(std::size_t lines) {
    const float below = ImGui::GetWindowHeight() - ImGui::GetCursorPosY() - units(8.0F);
    if (below <= 0.0F) return lines;
    const float heading = ImGui::GetTextLineHeightWithSpacing() + units(12.0F);
    const float room = std::max(0.0F, below - heading) / ImGui::GetTextLineHeightWithSpacing();
    return std::min(lines, static_cast<std::size_t>(room));
}

// One difference from the file on a line, with the file's value. A click restores that value.
void show_difference(const RunDifference& difference, const std::string& of, PanelState& state, Commands& commands) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::max(ImGui::GetContentRegionAvail().x, 1.0F), line = ImGui::GetTextLineHeight();
    if (ImGui::InvisibleButton(("put back " + difference.name).c_str(), {width, line}))
        commands.push_back(difference.back);
    remember(state, "put back " + difference.name);
    const bool is_hovered = ImGui::IsItemHovered();
    tooltip(fmt::format("{}; the {} has {}. Click to reset it", difference.text(), of, difference.other));
    const std::string file_has = of + ": " + difference.other;
    const float other = std::min(std::ceil(width_of(file_has)), 0.5F * width);
    cell(at, difference.text(), width - other - units(8.0F), current_theme().accent);
    cell({std::floor(at.x + width - other), at.y}, file_has, other, is_hovered ? text_color() : faint_color());
}

void end_time(const Session& session, const Run& file, PanelState& state, Commands& commands) {
    // Based on the file, not on the run: a range that grew with the value would move under the mouse.
    const double longest = std::max(50.0, 2.0 * file.options.end_time);
    slide({"end_time", "end", "end", "end time of the run", 0.1, longest, 4}, session, file, state, commands);
}

}  // namespace

void show_value_slider(const Session& session, const std::string& name, PanelState& state, Commands& commands) {
    const SystemDescription& system = session.description();
    const auto parameter = std::find_if(system.parameters.begin(), system.parameters.end(),
                                        [&](const ParameterDescription& one) { return one.name == name; });
    const bool is_start = parameter == system.parameters.end(), is_rate = is_start && name.ends_with('\'');
    const std::string about =
        is_start ? fmt::format("initial {} of {}", is_rate ? "rate" : "value", name.substr(0, name.find('\'')))
                 : parameter->name + (parameter->about.empty() ? "" : ": " + parameter->about);
    const ShownUnit unit = shown_unit_of_setting(system, name);
    const SweepAxis range = *axis_for(session, name);
    Run file = session.file_run();
    Slider slider{typeset_name(name) + (is_start ? "(0)" : ""),
                  "set " + name,
                  unit.text,
                  about,
                  *session.value(name),
                  range.low,
                  range.high,
                  *find_value(system, file, name),
                  unit.factor};
    slider.varies = name;
    put_bar(session, slider);
    if (moved(slider, state)) commands.emplace_back(command::Set{name, slider.value});
}

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

void show_changes(const Session& session, const std::string& of, std::size_t lines, PanelState& state,
                  Commands& commands) {
    const std::vector<RunDifference> all = differences(session.description(), session.run(), session.file_run());
    const std::size_t count = std::min(lines, all.size());
    if (count == 0) return;
    section(("Differs from the " + of).c_str());
    // The tail of an italic y extends beyond the left edge.
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const ImVec2 low = list->GetClipRectMin();
    list->PushClipRect({low.x - units(2.0F), low.y}, list->GetClipRectMax());
    for (std::size_t i = 0; i < count; ++i) show_difference(all[i], of, state, commands);
    list->PopClipRect();
}

void show_controls(const Session& session, PanelState& state, Commands& commands) {
    describe_system(session);
    // Dense rows, so that most systems need no scrolling.
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, units(3.0F)});
    const Run& file = session.file_run();
    const bool has_parameters = !file.parameters.empty();
    if (has_parameters) first_section("Parameters", session, file, state, commands);
    for (const ParameterDescription& parameter : session.description().parameters)
        show_value_slider(session, parameter.name, state, commands);
    if (has_parameters)
        section("Start and end");
    else
        first_section("Start and end", session, file, state, commands);
    for (const CoordinateDescription& coordinate : session.description().coordinates)
        for (const char* prime : {"", "'"}) show_value_slider(session, coordinate.name + prime, state, commands);
    end_time(session, file, state, commands);
    accuracy(session, file, state, commands);
    show_runs(session, state, commands);
    // If not all lines fit, the other differences still have their markers and "reset all".
    show_changes(session, "file", lines_that_fit(differences(session.description(), session.run(), file).size()), state,
                 commands);
    ImGui::PopStyleVar();
}

}  // namespace achilles
