// The study of many runs. A cross hair marks the current run; a click or drag makes the run under the mouse
// the current one.
#include "panels/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "expression/parse.hpp"
#include "figure/axes.hpp"
#include "figure/label.hpp"
#include "figure/sweep_figure.hpp"
#include "output/contacts.hpp"
#include "paint/paint.hpp"
#include "panels/slider.hpp"
#include "panels/widgets.hpp"
#include "session/sweep_text.hpp"
#include "system/units.hpp"

namespace achilles {

// ---- choice of axes and printed quantities ----

namespace {

constexpr std::array<const char*, 2> popups{"sweep x", "sweep y"};

// Text fields for the limits of one axis, in the unit of its slider; true if they are submitted.
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
    SweepSpec sweep = session.sweep();
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
        if (ImGui::Selectable(("##" + name).c_str(), chosen, 0, {units(200.0F), 0.0F}) && !chosen) {
            SweepSpec changed = sweep;
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

void show_moments(const SweepSpec& sweep, const Session& session, PanelState& state, Commands& commands) {
    const auto ask = [&](std::optional<Section> at) {
        SweepSpec changed = sweep;
        changed.at = std::move(at);
        if (!changed.at && changed.axes.empty())
            return commands.emplace_back(command::ShowSweep{default_sweep(session.description())}), void();
        // Quantities of a whole run do not apply to the points of a section, and vice versa.
        if (changed.at && !sweep.at) changed.prints = {session.description().coordinates.front().name};
        if (!changed.at && sweep.at) changed.prints = {"zeno_time(1)"};
        if (changed.at && changed.axes.size() > 1) changed.axes.resize(1);  // sections of a map cannot be drawn
        commands.emplace_back(showing(changed, session.description()));
    };
    if (ImGui::RadioButton("at the end of the run", !sweep.at)) ask({});
    remember(state, "sweep at end");
    for (const EventNames& names : possible_events(*session.model())) {
        const std::string name = fmt::format("at every {}", names.name);
        if (ImGui::RadioButton(name.c_str(), sweep.at && sweep.at->event == names.kind))
            ask(Section{names.kind, {}, sweep.at ? sweep.at->after : std::nullopt});
        remember(state, "sweep " + name);
    }
    std::string& zero = state.sweep.zero;
    if (text_row("where", "sweep zero", zero, 150.0F, state) && !zero.empty()) ask(Section{{}, zero, {}});
    tooltip("where this expression crosses zero upward, such as gap' or x - 1. Press Enter to apply");
}

void show_print_menu(const Session& session, PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup("sweep print")) return;
    const SweepSpec sweep = session.sweep();
    const SystemDescription& description = session.description();
    const auto ask = [&](const std::string& print) {
        SweepSpec changed = sweep;
        // For a single run the quantity is plotted over the first coordinate.
        const bool is_alone = sweep.axes.empty();
        changed.prints = {print};
        if (is_alone && sweep.prints.front() != print) changed.prints = {sweep.prints.front(), print};
        commands.emplace_back(showing(changed, description));
    };
    for (const std::string& print : offered_prints(description, sweep)) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        if (ImGui::Selectable(("##" + print).c_str(), sweep.prints.back() == print, 0, {units(230.0F), 0.0F}))
            ask(print);
        remember(state, "sweep print " + print);
        paint_label(ImGui::GetWindowDrawList(), at.x, at.y, typeset(print), text_color(), ImGui::GetFontSize());
    }
    std::string& typed = state.sweep.print;
    if (text_row("other", "sweep expression", typed, 150.0F, state) && !typed.empty()) ask(typed);
    tooltip("an expression at the end, such as zeno_time(1), or its derivative, d(zeno_time(1), e)");
    if (!session.error().empty()) show_message(session.error(), units(240.0F));
    ImGui::Separator();
    show_moments(sweep, session, state, commands);
    close_by_escape(state);
    ImGui::EndPopup();
}

}  // namespace

void show_sweep_menus(const Session& session, const Rectangle& row, PanelState& state, Commands& commands) {
    const SweepSpec sweep = session.sweep();
    const float right = row.x + row.width, third = row.width / 3.0F;
    std::string printed;
    for (const std::string& print : sweep.prints) printed += (printed.empty() ? "" : ", ") + typeset(print);
    float x = menu_button("sweep print", printed, row.x, row, row.x + 1.4F * third, state);
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

// ---- pictures ----

namespace {

// The panel, composed once per picture, not per frame.
const Panel& composed(const Session& session, SweepState& state) {
    const auto& data = session.sweep_job().data();
    if (state.of == data && state.dark == session.theme().dark && state.panel) return *state.panel;
    state.of = data;
    state.dark = session.theme().dark;
    SweepLook look;
    look.dark = state.dark;
    look.transparent = true;
    try {
        // For a single run the second quantity is plotted over the first.
        if (!data->columns.empty() && !data->sweep.axes.empty()) look.columns = {0};
        state.panel = std::make_shared<const Panel>(compose_sweep(*data, look).panels.front());
        state.problem.clear();
    } catch (const InputError& problem) {
        state.panel = std::make_shared<const Panel>();
        state.problem = problem.what();
    }
    return *state.panel;
}

// The current run's value of the plotted quantity, as displayed; empty while the run is under way or if undefined.
std::optional<double> present_number(const Session& session, SweepState& state) {
    if (session.under_way() != nullptr || session.shows_start()) return std::nullopt;
    const SweepSpec sweep = session.sweep();
    if (state.measured_run == session.trajectory().run && state.measured == sweep.prints) return state.measure;
    state.measured_run = session.trajectory().run;
    state.measured = sweep.prints;
    state.measure.reset();
    const RunMeasures measures(session.model(), sweep);
    if (measures.columns().front().kind != RunMeasures::Column::Kind::number) return std::nullopt;
    std::vector<double> numbers;
    MeasureEvaluator(measures).at_end(session.trajectory(), numbers);
    if (std::isfinite(numbers.front()))
        state.measure = shown_unit(measures.columns().front().unit).factor * numbers.front();
    return state.measure;
}

// The tangent to the curve at the cross hair. It is straight if the axes have the scale of the derivative.
void show_tangent(const Session& session, const SweepData& data, const Rectangle& area, const PanelMap& map,
                  ImDrawList* list) {
    const std::optional<TangentLine> tangent = session.sweep_tangent();
    if (!tangent) return;
    const double along = shown_unit_of_axis(data, 0).factor, up = shown_unit(data.columns.front().unit).factor;
    const double x = map.x(along * tangent->x), y = map.y(up * tangent->y), step = x > area.x + 1.0 ? -1.0 : 1.0;
    const double rise = (map.y(up * tangent->at(map.x.value(x + step) / along)) - y) / step;
    const double reach = std::min<double>(0.3 * area.width, 2.0 * area.height / std::max(std::abs(rise), 1e-9));
    const auto point = [&](double side) {
        return ImVec2{static_cast<float>(x + side * reach), static_cast<float>(y + side * reach * rise)};
    };
    list->AddLine(point(-1.0), point(1.0), packed(session.theme().background, 0.75F), units(3.5F));
    list->AddLine(point(-1.0), point(1.0), packed(text_color()), units(1.5F));
}

void show_cross_hair(const Session& session, const SweepData& data, const Rectangle& area, const PanelMap& map,
                     SweepState& state) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    const auto line = [&](const ImVec2& from, const ImVec2& to) {
        list->AddLine(from, to, packed(session.theme().background, 0.75F), units(3.0F));
        list->AddLine(from, to, packed(text_color(), 0.8F), units(1.0F));
    };
    const auto present_on = [&](std::size_t axis) {
        std::optional<double> value = present_value(session, data.sweep.axes[axis]);
        if (value) *value *= shown_unit_of_axis(data, axis).factor;
        return value;
    };
    const std::optional<double> x = present_on(0);
    const float across = x ? std::floor(static_cast<float>(map.x(*x))) + 0.5F : -1.0F;
    if (x) line({across, area.y}, {across, area.y + area.height});
    std::optional<double> y;
    if (data.sweep.axes.size() > 1) {
        y = present_on(1);
        if (y) {
            const float down = std::floor(static_cast<float>(map.y(*y))) + 0.5F;
            line({area.x, down}, {area.x + area.width, down});
        }
    } else if (!data.is_section() && session.sweep_job().is_current()) {
        y = present_number(session, state);
        show_tangent(session, data, area, map, list);
    }
    if (x && y) {
        const ImVec2 center{across, static_cast<float>(map.y(*y))};
        list->AddCircleFilled(center, units(5.0F), packed(session.theme().background), 20);
        list->AddCircleFilled(center, units(3.5F), packed(text_color()), 20);
    }
    list->PopClipRect();
}

void tell(const Session& session, const SweepData& data, const std::vector<double>& values, SweepState& state) {
    const std::optional<std::size_t> row = sweep_row_at(data, values);
    if (!row) return;
    const std::uint64_t point = data.rows.points[*row];
    if (state.described_data != &data || state.described_point != point) {
        state.described_data = &data;
        state.described_point = point;
        SweepSpec sweep = data.sweep;
        state.tooltip.clear();
        for (std::size_t i = 0; i < sweep.axes.size(); ++i)
            state.tooltip += fmt::format("{} = {}\n", data.names[i],
                                         sweep_quantity_text(sweep.value(i, point), shown_unit_of_axis(data, i)));
        if (!data.is_section()) {
            if (const std::string measured = sweep_row_text(data, *row); !measured.empty())
                state.tooltip += measured + "\n";
        }
        state.tooltip += events_at(session, SweepPoints(sweep, session.description()).run(point));
    }
    tooltip(state.tooltip);
}

// A slider's name dropped on an axis becomes the quantity along that axis.
void take_dropped_name(const Session& session, std::size_t place, const Rectangle& area, Commands& commands) {
    if (area.width < 1.0F || area.height < 1.0F || ImGui::GetDragDropPayload() == nullptr) return;
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton(place == 0 ? "sweep x axis" : "sweep y axis", {area.width, area.height});
    if (!ImGui::BeginDragDropTarget()) return;
    if (const ImGuiPayload* const dropped = ImGui::AcceptDragDropPayload(dragged_name)) {
        const std::string name(static_cast<const char*>(dropped->Data), static_cast<std::size_t>(dropped->DataSize));
        SweepSpec sweep = session.sweep();
        const std::size_t at = std::min(place, sweep.axes.size());
        const auto twice = std::find_if(sweep.axes.begin(), sweep.axes.end(),
                                        [&](const SweepAxis& axis) { return axis.name == name; });
        if (const auto axis = axis_for(session, name)) {
            if (twice != sweep.axes.end() && at < sweep.axes.size())
                std::iter_swap(twice, sweep.axes.begin() + static_cast<std::ptrdiff_t>(at));  // swap the axes
            else if (twice == sweep.axes.end())
                sweep.axes.resize(std::max(sweep.axes.size(), at + 1)), sweep.axes[at] = *axis;
            commands.emplace_back(showing(sweep, session.description()));
        }
    }
    ImGui::EndDragDropTarget();
}

void use_mouse(const Session& session, const SweepData& data, const Rectangle& area, const PanelMap& map,
               PanelState& state, Commands& commands) {
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton("sweep picture", {area.width, area.height});
    remember(state, "sweep picture");
    if (data.sweep.axes.empty()) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::vector<double> values{map.x.value(std::clamp<double>(mouse.x, area.x, area.x + area.width))};
    if (data.sweep.axes.size() > 1)
        values.push_back(map.y.value(std::clamp<double>(mouse.y, area.y, area.y + area.height)));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] /= shown_unit_of_axis(data, i).factor;
    const bool has_moved = ImGui::GetIO().MouseDelta.x != 0.0F || ImGui::GetIO().MouseDelta.y != 0.0F;
    if (ImGui::IsItemActive() && (has_moved || ImGui::IsItemActivated())) go_to_point(data, values, commands);
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) tell(session, data, values, state.sweep);
}

// Progress, at the right end of the row. Returns its left end.
float show_progress(const Session& session, const Rectangle& row) {
    const SweepJob& job = session.sweep_job();
    float right = row.x + row.width;
    if (!job.is_busy()) return right;
    const float size = ImGui::GetFontSize();
    const std::string text = fmt::format("{:.0f} %", 100.0 * job.share());
    right -= label_width(text, size);
    paint_label(ImGui::GetWindowDrawList(), right, row.y + 0.5F * (row.height - 1.2F * size), text, faint_color(),
                size);
    return right - units(8.0F);
}

}  // namespace

void show_sweep(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle cell = remaining();
    const auto [row, inner] = paint_plot_card(cell);
    if (inner.width < 2.0F || inner.height < 2.0F) return;
    const float right = show_progress(session, row);
    show_sweep_menus(session, {row.x, row.y, right - row.x, row.height}, state, commands);
    const SweepJob& job = session.sweep_job();
    const auto message = [&area = inner](const std::string& text) {
        ImGui::SetCursorScreenPos({area.x, area.y + units(6.0F)});
        show_message(text, area.width);
    };
    if (!job.problem().empty()) return message(job.problem());
    if (!job.data()) return;
    const Panel& panel = composed(session, state.sweep);
    if (!state.sweep.problem.empty()) return message(state.sweep.problem);
    Rectangle below = inner;
    if (panel.legend && panel.legend_above) {  // it ends at the right, below the button; the menus may be as long
        const float clear = std::min(units(12.0F), inner.height);
        below.y += clear, below.height -= clear;
    }
    const Rectangle area = paint(panel, screen_style(session.theme()), ImGui::GetWindowDrawList(), below, units(1.0F));
    if (area.width < 2.0F || area.height < 2.0F) return;
    const PanelMap map(panel, area);
    if (!job.data()->sweep.axes.empty()) show_cross_hair(session, *job.data(), area, map, state.sweep);
    take_dropped_name(
        session, 0, {area.x, area.y + area.height, area.width, cell.y + cell.height - area.y - area.height}, commands);
    if (!job.data()->is_section())
        take_dropped_name(session, 1, {cell.x, area.y, area.x - cell.x, area.height}, commands);
    use_mouse(session, *job.data(), area, map, state, commands);
}

}  // namespace achilles
