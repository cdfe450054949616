// What a sweep varies and asks is chosen here.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

#include "expression/parse.hpp"
#include "figure/label.hpp"
#include "figure/shown_unit.hpp"
#include "paint/label.hpp"
#include "panels/slider.hpp"
#include "panels/sweep.hpp"
#include "panels/widgets.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

constexpr std::uint64_t points = 512;
constexpr std::array<const char*, 2> popups{"sweep x", "sweep y"};

// What most people ask of a run, and the derivative of the first by what varies along x.
std::vector<std::string> usual_prints(const SystemDescription& description, const Sweep& sweep) {
    const bool is_section = sweep.at.has_value();
    std::vector<std::string> prints;
    if (!is_section) prints = {"zeno_time(1)", "zeno_time(2)", "zeno_points", "impacts", "releases", "least_gap"};
    for (const CoordinateDescription& coordinate : description.coordinates) {
        prints.push_back(coordinate.name);
        prints.push_back(coordinate.name + "'");
    }
    prints.emplace_back("energy");
    if (!is_section) prints.insert(prints.end(), {"held", "outcome"});
    Run run = default_run(description);
    const bool has_slope = !sweep.axes.empty() && find_value(description, run, sweep.axes.front().name) != nullptr &&
                           (!is_section || sweep.at->kind != Section::Kind::zero);
    if (has_slope) prints.push_back(fmt::format("d({}, {})", prints.front(), sweep.axes.front().name));
    return prints;
}

// The limits of one axis, as they are typed, in the unit of its slider; true when they are entered.
bool limits_entered(const SystemDescription& description, SweepAxis& axis, SweepMenu& menu, std::size_t place,
                    PanelState& state) {
    const std::string unit = unit_of_axis(description, axis.name);
    const ShownUnit shown = shown_unit_of_setting(description, axis.name);
    const auto text_of = [&](double limit) { return fmt::format("{:.12g}", shown.factor * limit); };
    if (menu.of != axis) {
        menu.of = axis;
        menu.low = text_of(axis.low), menu.high = text_of(axis.high);
        menu.wrong.clear();
    }
    const std::string which = place == 0 ? "x" : "y";
    bool entered = false;
    for (const auto& [name, text] : {std::pair("from", &menu.low), std::pair("to", &menu.high)}) {
        entered = text_row(name, "sweep " + which + " " + name, *text, 120.0F, state) || entered;
        if (shown.text.empty()) continue;
        ImGui::SameLine();
        ImGui::TextUnformatted(shown.text.c_str());
    }
    bool logarithmic = axis.logarithmic;
    if (ImGui::Checkbox("logarithmic", &logarithmic)) entered = true;
    remember(state, "sweep " + which + " logarithmic");
    if (!menu.wrong.empty()) show_message(menu.wrong, units(240.0F));
    if (!entered) return false;
    try {
        for (const auto& [text, limit] : {std::pair(&menu.low, &axis.low), std::pair(&menu.high, &axis.high)})
            if (*text != text_of(*limit)) *limit = typed_number(*text, unit, shown.factor);
        axis.logarithmic = logarithmic;
        menu.wrong.clear();
        return true;
    } catch (const ParseError& problem) {
        menu.wrong = problem.what();
        return false;
    }
}

void show_axis_menu(const Session& session, std::size_t place, PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup(popups[place])) return;
    Sweep sweep = session.sweep();
    const SystemDescription& description = session.description();
    const bool has_axis = place < sweep.axes.size();
    const auto is_other = [&](const std::string& name) {
        return std::any_of(sweep.axes.begin(), sweep.axes.end(),
                           [&](const SweepAxis& axis) { return axis.name == name; }) &&
               !(has_axis && sweep.axes[place].name == name);
    };
    std::vector<std::string> names = settable_names(description);
    names.emplace_back("end");
    for (const std::string& name : names) {
        if (is_other(name)) continue;
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const bool chosen = has_axis && sweep.axes[place].name == name;
        if (ImGui::Selectable(("##" + name).c_str(), chosen, ImGuiSelectableFlags_DontClosePopups,
                              {units(200.0F), 0.0F}) &&
            !chosen) {
            Sweep changed = sweep;
            changed.axes.resize(std::max(changed.axes.size(), place + 1));
            changed.axes[place] = *axis_for(session, name);
            commands.emplace_back(showing(changed, description));
        }
        remember(state, std::string(popups[place]) + " " + name);
        paint_label(ImGui::GetWindowDrawList(), at.x, at.y, typeset(name), text_color(), ImGui::GetFontSize());
    }
    if (place == 1 || sweep.at) {
        if (ImGui::Selectable("none", !has_axis) && has_axis) {
            sweep.axes.erase(sweep.axes.begin() + static_cast<std::ptrdiff_t>(place));
            commands.emplace_back(showing(sweep, description));
        }
        remember(state, std::string(popups[place]) + " nothing");
        tooltip(place == 1 ? "a curve over x" : "the points of the present run only");
    }
    if (has_axis && place < sweep.axes.size()) {
        ImGui::Separator();
        SweepAxis& axis = sweep.axes[place];
        if (limits_entered(description, axis, state.sweep.menus[place], place, state))
            commands.emplace_back(showing(sweep, description));
        if (!session.error().empty()) show_message(session.error(), units(240.0F));
    }
    close_by_escape(state);
    ImGui::EndPopup();
}

void show_moments(const Sweep& sweep, const Session& session, PanelState& state, Commands& commands) {
    constexpr std::array<const char*, 3> names{"at every impact", "at every Zeno point", "at every release"};
    const auto ask = [&](std::optional<Section> at) {
        Sweep changed = sweep;
        changed.at = std::move(at);
        if (!changed.at && changed.axes.empty())
            return commands.emplace_back(command::ShowSweep{default_sweep(session.description())}), void();
        // What is known of a whole run is nothing of a moment.
        if (changed.at && !sweep.at) changed.prints = {session.description().coordinates.front().name};
        if (!changed.at && sweep.at) changed.prints = {"zeno_time(1)"};
        if (changed.at && changed.axes.size() > 1) changed.axes.resize(1);  // sections of a map have no picture
        commands.emplace_back(showing(changed, session.description()));
    };
    if (ImGui::RadioButton("at the end of the run", !sweep.at)) ask({});
    remember(state, "sweep at end");
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto kind = static_cast<Section::Kind>(i);
        if (ImGui::RadioButton(names[i], sweep.at && sweep.at->kind == kind))
            ask(Section{kind, {}, sweep.at ? sweep.at->after : std::nullopt});
        remember(state, std::string("sweep ") + names[i]);
    }
    std::string& zero = state.sweep.zero;
    if (text_row("where", "sweep zero", zero, 150.0F, state) && !zero.empty())
        ask(Section{Section::Kind::zero, zero, {}});
    tooltip("where this expression crosses zero upward, such as gap' or x - 1. Press Enter to apply");
}

void show_print_menu(const Session& session, PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup("sweep print")) return;
    const Sweep sweep = session.sweep();
    const SystemDescription& description = session.description();
    const auto ask = [&](const std::string& print) {
        Sweep changed = sweep;
        // Of one run alone what is asked stands over the first coordinate.
        const bool is_alone = sweep.axes.empty();
        changed.prints = {print};
        if (is_alone && sweep.prints.front() != print) changed.prints = {sweep.prints.front(), print};
        commands.emplace_back(showing(changed, description));
    };
    for (const std::string& print : usual_prints(description, sweep)) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        if (ImGui::Selectable(("##" + print).c_str(), sweep.prints.back() == print, 0, {units(230.0F), 0.0F}))
            ask(print);
        remember(state, "sweep print " + print);
        paint_label(ImGui::GetWindowDrawList(), at.x, at.y, typeset(print), text_color(), ImGui::GetFontSize());
    }
    std::string& typed = state.sweep.print;
    if (text_row("other", "sweep expression", typed, 150.0F, state) && !typed.empty()) ask(typed);
    tooltip(
        "an expression at the end of the run, with zeno_time(k), impact_time(k), impact_speed(k), release_time(k), or "
        "its derivative with respect to a parameter or a start, d(zeno_time(1), e). Press Enter to apply");
    if (!session.error().empty()) show_message(session.error(), units(240.0F));
    ImGui::Separator();
    show_moments(sweep, session, state, commands);
    close_by_escape(state);
    ImGui::EndPopup();
}

}  // namespace

command::ShowSweep showing(const Sweep& sweep, const SystemDescription& description) {
    Sweep bare = sweep;
    bare.base = default_run(description);
    return {to_text(bare, description)};
}

std::optional<SweepAxis> axis_for(const Session& session, const std::string& name) {
    const SystemDescription& description = session.description();
    const auto over = [&](const std::array<double, 2>& range) {
        return SweepAxis{name, range[0], range[1], points, false};
    };
    for (const ParameterDescription& parameter : description.parameters)
        if (parameter.name == name) return over(parameter.range);
    for (const CoordinateDescription& coordinate : description.coordinates) {
        if (coordinate.name == name) return over(coordinate.range);
        if (coordinate.name + "'" == name) return over(coordinate.rate_range);
    }
    const Options& options = session.run().options;
    if (name == "end") return over({options.start_time, options.end_time});
    return std::nullopt;
}

void show_sweep_menus(const Session& session, const Rectangle& row, PanelState& state, Commands& commands) {
    const Sweep sweep = session.sweep();
    const float right = row.x + row.width, third = row.width / 3.0F;
    std::string asked;
    for (const std::string& print : sweep.prints) asked += (asked.empty() ? "" : ", ") + typeset(print);
    float x = menu_button("sweep print", asked, row.x, row, row.x + 1.4F * third, state);
    tooltip("quantity to compute for each run");
    show_print_menu(session, state, commands);
    for (std::size_t place = 0; place < 2; ++place) {
        if (place > sweep.axes.size() || (sweep.at && place == 1)) break;
        const std::string name = place < sweep.axes.size() ? typeset(sweep.axes[place].name) : "\u2026";
        x = menu_button(popups[place], (place == 0 ? "over " : "and ") + name, x, row, right, state);
        tooltip(place == 0 ? "quantity along x; you can also drag a slider's name onto the axis"
                           : "quantity along y, for a map");
        show_axis_menu(session, place, state, commands);
    }
}

}  // namespace achilles
