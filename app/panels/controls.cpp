// The left column: which system, and every value a hand may change.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "figure/label.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr double degrees_per_radian = 180.0 / std::numbers::pi;
// The columns of a row, at scale 1: what it is, the slider, its value.
constexpr float label_width = 76.0F, value_width = 78.0F;

// One slider: what is shown and how.
struct Slider {
    std::string label, id, unit, about;
    double value = 0.0, low = 0.0, high = 1.0;
    int digits = 4;
};

bool is_logarithmic(double low, double high) { return low > 0.0 && high / low >= 100.0; }

double rounded(double value, int digits) { return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr); }

// A thin track behind a slider whose own frame is invisible.
void paint_track(float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float y = std::floor(at.y + 0.5F * ImGui::GetFrameHeight()), half = units(2.0F);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, y - half}, {at.x + width, y + half},
                                              ImGui::GetColorU32(ImGuiCol_Border), half);
}

// The slider alone. ImGui would write the value over the grab; ours stands beside it, so its text is hidden, except
// while it is typed over (Ctrl and click). Fifteen digits: ImGui takes the precision of a logarithmic scale from here.
bool slid(Slider& slider, float width) {
    const std::string id = "##" + slider.id;
    const bool typing = ImGui::TempInputIsActive(ImGui::GetID(id.c_str()));
    if (!typing) paint_track(width);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, typing ? ImGui::GetColorU32(ImGuiCol_FrameBg) : 0U);
    ImGui::PushStyleColor(ImGuiCol_FrameBgActive, typing ? ImGui::GetColorU32(ImGuiCol_FrameBg) : 0U);
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, 0U);
    ImGui::PushStyleColor(ImGuiCol_Text, typing ? ImGui::GetColorU32(ImGuiCol_Text) : 0U);
    ImGui::SetNextItemWidth(width);
    const double before = slider.value;
    ImGui::SliderScalar(id.c_str(), ImGuiDataType_Double, &slider.value, &slider.low, &slider.high, "%.15g",
                        is_logarithmic(slider.low, slider.high) ? ImGuiSliderFlags_Logarithmic : 0);
    ImGui::PopStyleColor(4);
    if (slider.value == before) return false;
    if (!typing) slider.value = rounded(slider.value, slider.digits);
    return slider.value != before;
}

// Shows one; true where the hand has changed the value.
bool moved(Slider& slider, PanelState& state) {
    const std::string about = slider.about + (slider.about.empty() ? "" : "\n") + "Ctrl and click to type a value";
    label(slider.label, units(label_width));
    tooltip(about);
    ImGui::SameLine(0.0F, 0.0F);
    const float width = ImGui::GetContentRegionAvail().x - units(value_width);
    const bool changed = slid(slider, width);
    remember(state, slider.id);
    tooltip(about);
    ImGui::SameLine(0.0F, 0.0F);
    const std::string text = number(rounded(slider.value, slider.digits + 2), "{:.6g}") +
                             (slider.unit.empty() || slider.unit[0] == '\xc2' ? slider.unit : "\u00a0" + slider.unit);
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text.c_str());
    return changed;
}

// A typographer's unit: m/s^2 becomes m/s\u00b2.
// "double pendulum" for the file double_pendulum.toml: short enough for the column, whatever the title.
std::string short_name(const std::string& system) {
    std::string name = std::filesystem::path(system).stem().string();
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

void paragraph(const std::string& text, const Color& color) {
    if (text.empty()) return;
    ImGui::PushStyleColor(ImGuiCol_Text, packed(color));
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
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

// Three lines: what can be taken away, and the tours.
void show_menu_button(const Session& session, PanelState& state, Commands& commands) {
    const float size = ImGui::GetFrameHeight();
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(ImGuiCol_FrameBg));
    if (ImGui::Button("##menu", {size, size})) ImGui::OpenPopup("menu");
    ImGui::PopStyleColor();
    remember(state, "menu");
    tooltip("take away a figure, the run, a journal, a command line; tours");
    const ImVec2 low = ImGui::GetItemRectMin();
    for (int i = -1; i <= 1; ++i) {
        const float y = std::floor(low.y + 0.5F * size + units(5.0F) * static_cast<float>(i));
        ImGui::GetWindowDrawList()->AddRectFilled({low.x + units(7.0F), y},
                                                  {low.x + size - units(7.0F), y + units(2.0F)}, packed(text_color()));
    }
    if (!ImGui::BeginPopup("menu")) return;
    ImGui::TextDisabled("Take it away");
    show_take_away_items(session, state, commands);
    if (!state.tours.empty()) {
        ImGui::Separator();
        ImGui::TextDisabled("Tours");
        show_tour_items(session, state, commands);
    }
    ImGui::EndPopup();
}

void describe_system(const Session& session) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {units(8.0F), units(2.0F)});
    paragraph(session.description().title, text_color());
    paragraph(session.description().source, faint_color());
    ImGui::PopStyleVar();
}

void parameters(const Session& session, PanelState& state, Commands& commands) {
    const auto& all = session.description().parameters;
    if (all.empty()) return;
    section("Parameters");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const ParameterDescription& p = all[i];
        const bool is_angle = p.unit == "rad";
        const double factor = is_angle ? degrees_per_radian : 1.0;
        Slider slider{typeset_name(p.name),
                      "set " + p.name,
                      is_angle ? "\u00b0" : typeset_unit(p.unit),
                      p.about.empty() ? p.name : p.name + ": " + p.about,
                      session.run().parameters[i] * factor,
                      p.range[0] * factor,
                      p.range[1] * factor};
        if (moved(slider, state)) commands.emplace_back(command::Set{p.name, slider.value / factor});
    }
}

// A coordinate's start, or the rate at the start.
void start_value(const Session& session, std::size_t i, bool is_rate, PanelState& state, Commands& commands) {
    const CoordinateDescription& c = session.description().coordinates[i];
    const bool is_angle = c.unit == "rad";
    const double factor = is_angle ? degrees_per_radian : 1.0;
    const auto& range = is_rate ? c.rate_range : c.range;
    const Vector& values = is_rate ? session.run().v : session.run().q;
    const std::string name = is_rate ? c.name + "'" : c.name;
    std::string unit = is_angle ? "\u00b0" : typeset_unit(c.unit);
    if (is_rate && !unit.empty()) unit += "/s";
    Slider slider{typeset_name(name) + "(0)",
                  "set " + name,
                  unit,
                  fmt::format("{} of {} at the start", is_rate ? "rate" : "value", c.name),
                  values[static_cast<Eigen::Index>(i)] * factor,
                  range[0] * factor,
                  range[1] * factor};
    if (moved(slider, state)) commands.emplace_back(command::Set{name, slider.value / factor});
}

// A row of buttons of which one is down.
template <class Value, class Make>
void choice(const char* id, const std::string& title, const std::string& about, Value now,
            std::initializer_list<Value> all, PanelState& state, Commands& commands, const Make& make) {
    label(title, units(label_width));
    tooltip(about);
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

void truncation(const Session& session, PanelState& state, Commands& commands) {
    const Truncation& t = session.run().options.truncation;
    section("Truncation of the bouncing");
    const auto eps = [&](const char* name, const char* id, double value, const char* about) {
        Slider slider{name, id, "", about, value, 1e-12, 1e-1, 3};
        return moved(slider, state) ? slider.value : value;
    };
    // One slider for all three, and one for each.
    const double all = eps("\u03b5, all", "eps", t.eps_q, "all three bounds below at once");
    const double q = eps("   position", "eps q", t.eps_q, "bound on the error of the position at the Zeno point");
    const double v = eps("   velocity", "eps v", t.eps_v, "bound on the error of the velocity at the Zeno point");
    const double time = eps("   time", "eps t", t.eps_t, "bound on the error of the Zeno time, s");
    if (all != t.eps_q)
        commands.emplace_back(command::Eps{all, all, all});
    else if (q != t.eps_q || v != t.eps_v || time != t.eps_t)
        commands.emplace_back(command::Eps{q, v, time});
    choice<Conditions>(
        "conditions", "conditions",
        "what must be proved before the bouncing is cut short: the paper's inequalities (Def. 7), or the sharp ones, "
        "which choose their own neighbourhood and certify the restarted motion",
        t.conditions, {Conditions::paper, Conditions::sharp}, state, commands,
        [](Conditions c) { return command::UseConditions{c}; });
    choice<Reinitialization>("reinitialization", "restart",
                             "the velocity the constrained motion starts with: the paper's "
                             "euclidean projection, or the kinetic one of a plastic impact",
                             t.reinitialization, {Reinitialization::euclidean, Reinitialization::kinetic}, state,
                             commands, [](Reinitialization r) { return command::UseReinitialization{r}; });
}

void integration(const Session& session, PanelState& state, Commands& commands) {
    const Options& o = session.run().options;
    section("Integration");
    Slider tolerance{"tolerance", "tolerance", "",   "local error per step, absolute and relative",
                     o.tolerance, 1e-14,       1e-4, 3};
    if (moved(tolerance, state)) commands.emplace_back(command::Tolerance{tolerance.value});
    // Of the file, not of the run: a range that grew with the value would run away under the hand.
    const double longest = std::max(50.0, 2.0 * session.description().options.end_time);
    Slider end{"end", "end", "s", "the run stops here at the latest", o.end_time, 0.1, longest, 4};
    if (moved(end, state)) commands.emplace_back(command::End{end.value});
}

}  // namespace

void show_system(const Session& session, PanelState& state, Commands& commands) {
    const float width = units(52.0F), space = ImGui::GetStyle().ItemInnerSpacing.x, menu = ImGui::GetFrameHeight();
    choose_system(session, state, commands, ImGui::GetContentRegionAvail().x - width - menu - 2.0F * space);
    ImGui::SameLine(0.0F, space);
    const bool shown = session.shows_editor();
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(shown ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg));
    if (ImGui::Button("text", {width, 0.0F})) toggle_editor(session, state, commands);
    ImGui::PopStyleColor();
    remember(state, "editor");
    tooltip(shown ? "back to the sliders (Ctrl+E)" : "edit the text of the system (Ctrl+E)");
    ImGui::SameLine(0.0F, space);
    show_menu_button(session, state, commands);
}

void show_controls(const Session& session, PanelState& state, Commands& commands) {
    describe_system(session);
    parameters(session, state, commands);
    section("Start");
    for (std::size_t i = 0; i < session.description().coordinates.size(); ++i) {
        start_value(session, i, false, state, commands);
        start_value(session, i, true, state, commands);
    }
    truncation(session, state, commands);
    integration(session, state, commands);
}

}  // namespace achilles
