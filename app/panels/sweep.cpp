// Under the plots: many runs beside the present one, which is a cross hair in them. A click or a drag makes the run under
// the hand the present one.
#include "panels/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "figure/axes.hpp"
#include "figure/label.hpp"
#include "figure/sweep_figure.hpp"
#include "paint/label.hpp"
#include "paint/paint.hpp"
#include "panels/print.hpp"
#include "panels/widgets.hpp"
#include "session/refusal.hpp"

namespace achilles {

namespace {

// What the session has along an axis, in the unit of the file.
std::optional<double> present(const Session& session, const SweepAxis& axis) {
    if (const auto value = session.value(axis.name)) return value;
    const std::vector<const Option*> options = options_of_axis(axis.name);
    if (options.empty()) return std::nullopt;
    const OptionValue value = options.front()->get(session.run().options);
    if (const double* const number = std::get_if<double>(&value)) return *number;
    if (const int* const count = std::get_if<int>(&value)) return static_cast<double>(*count);
    return std::nullopt;
}

// Composed once for each picture, not for each frame.
const Panel& composed(const Session& session, SweepState& state) {
    const auto& data = session.sweep_job().data();
    if (state.of == data && state.dark == session.theme().dark && state.panel) return *state.panel;
    state.of = data;
    state.dark = session.theme().dark;
    SweepLook look;
    look.dark = state.dark;
    look.transparent = true;
    try {
        // Of one run alone the second print stands over the first.
        if (!data->columns.empty() && !data->sweep.axes.empty()) look.columns = {0};
        state.panel = std::make_shared<const Panel>(compose_sweep(*data, look).panels.front());
        state.problem.clear();
    } catch (const InputError& problem) {
        state.panel = std::make_shared<const Panel>();
        state.problem = problem.what();
    }
    return *state.panel;
}

// The number, as it is shown, that the present run has for what a curve shows; nothing while it is under way, or where it has
// none.
std::optional<double> present_number(const Session& session, SweepState& state) {
    if (session.under_way() != nullptr || session.shows_start()) return std::nullopt;
    const Sweep sweep = session.sweep();
    if (state.measured_run == session.trajectory().run && state.measured == sweep.prints) return state.measure;
    state.measured_run = session.trajectory().run;
    state.measured = sweep.prints;
    state.measure.reset();
    const RunMeasures measures(session.model(), sweep);
    if (measures.columns().front().kind != RunMeasures::Column::Kind::number) return std::nullopt;
    std::vector<double> numbers;
    Measuring(measures).at_end(session.trajectory(), numbers);
    if (std::isfinite(numbers.front()))
        state.measure = shown_unit(measures.columns().front().unit).factor * numbers.front();
    return state.measure;
}

// At the cross hair the line that touches the curve: straight, as the picture's axes go as the line does.
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
        std::optional<double> value = present(session, data.sweep.axes[axis]);
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

// The commands that make another run of it: values together, as the run in between might be none.
void go_to(const SweepData& data, const std::vector<double>& values, Commands& commands) {
    command::Start start;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const SweepAxis& axis = data.sweep.axes[i];
        const double value = std::clamp(values[i], std::min(axis.low, axis.high), std::max(axis.low, axis.high));
        const std::vector<const Option*> options = options_of_axis(axis.name);
        if (options.empty()) {
            start.values.emplace_back(axis.name, value);
            continue;
        }
        Options changed = data.sweep.base.options;
        for (const Option* option : options) option->set(changed, value);
        commands.emplace_back(command::UseOption(*options.front(), changed));
    }
    if (!start.values.empty()) commands.emplace_back(std::move(start));
}

// "3 impacts before the cut, Zeno point at 2.7251 s, release at 3.7318 s": the events of the run at a point. What is told
// beside a pointer must be there within the frame: of a long run the beginning.
std::string events_of(const Session& session, const Run& run) {
    constexpr int most_impacts = 2000, most_steps = 20000, most_told = 6;
    Run shorter = run;
    shorter.options.max_impacts = std::min(shorter.options.max_impacts, most_impacts);
    shorter.options.max_steps = std::min(shorter.options.max_steps, most_steps);
    std::vector<std::string> told;
    int impacts = 0;
    const auto tell_impacts = [&](const char* before) {
        if (impacts > 0) told.push_back((impacts == 1 ? "an impact" : fmt::format("{} impacts", impacts)) + before);
        impacts = 0;
    };
    try {
        const Trajectory trajectory = simulate(session.model(), shorter);
        for (const Event& event : trajectory.events) {
            if (event.kind == Event::Kind::impact) {
                ++impacts;
                continue;
            }
            const bool is_landing = is_plastic_landing(event), is_cut = event.truncation && !is_landing;
            tell_impacts(is_cut ? " before the cut" : "");
            const char* const name = is_landing                           ? "landing"
                                     : event.kind == Event::Kind::zeno    ? "Zeno point"
                                     : event.kind == Event::Kind::release ? "release"
                                                                          : "event";
            told.push_back(fmt::format("{} at {} s", name, number(event.t, "{:.5g}")));
        }
        tell_impacts("");
        if (trajectory.outcome.kind != Outcome::Kind::end_time) told.emplace_back("\u2026");
    } catch (const InputError& problem) {
        return problem.message;
    }
    if (told.empty()) return "no event";
    std::string text;
    // Two a line: a line that ImGui had to break could end in the middle of a number.
    for (std::size_t i = 0; i < told.size() && i < most_told; ++i)
        text += (i == 0 ? "" : i % 2 == 0 ? ",\n" : ", ") + told[i];
    return told.size() > most_told ? text + ", \u2026" : text;
}

// The row of the point nearest to the pointer on each axis, where it is there.
std::optional<std::size_t> row_at(const SweepData& data, const std::vector<double>& values) {
    std::uint64_t point = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const SweepAxis& axis = data.sweep.axes[i];
        double share = (values[i] - axis.low) / (axis.high - axis.low);
        if (axis.logarithmic) share = std::log(values[i] / axis.low) / std::log(axis.high / axis.low);
        if (!(share >= -0.01 && share <= 1.01)) return std::nullopt;
        const double last = static_cast<double>(axis.count - 1);
        point = point * axis.count + static_cast<std::uint64_t>(std::clamp(std::round(share * last), 0.0, last));
    }
    const auto& points = data.rows.points;
    const auto found = std::lower_bound(points.begin(), points.end(), point);
    if (found == points.end() || *found != point) return std::nullopt;
    return static_cast<std::size_t>(found - points.begin());
}

std::string told_number(double value, const ShownUnit& unit) {
    return number_with_unit(number(unit.factor * value), unit.text);
}

std::string told_of(const SweepData& data, std::size_t row) {
    std::size_t number_place = 0;
    std::string text;
    for (const RunMeasures::Column& column : data.columns) {
        std::string value;
        if (column.kind == RunMeasures::Column::Kind::number) {
            const double x = data.number(row, number_place++);
            value = std::isfinite(x) ? told_number(x, shown_unit(column.unit)) : "no value";
        } else if (column.kind == RunMeasures::Column::Kind::outcome) {
            value = data.rows.ends[row].text();
        } else {
            for (std::size_t i = 0; i < data.contacts.size(); ++i)
                if (data.rows.held[row].contains(i)) value += (value.empty() ? "" : ", ") + data.contacts[i];
            if (value.empty()) value = "nothing";
        }
        text += (text.empty() ? "" : "\n") + column.name + " = " + value;
    }
    return text;
}

void tell(const Session& session, const SweepData& data, const std::vector<double>& values, SweepState& state) {
    const std::optional<std::size_t> row = row_at(data, values);
    if (!row) return;
    const std::uint64_t point = data.rows.points[*row];
    if (state.told_of != &data || state.told_point != point) {
        state.told_of = &data;
        state.told_point = point;
        Sweep sweep = data.sweep;
        state.told.clear();
        for (std::size_t i = 0; i < sweep.axes.size(); ++i)
            state.told += fmt::format("{} = {}\n", data.names[i],
                                      told_number(sweep.value(i, point), shown_unit_of_axis(data, i)));
        if (!data.is_section()) {
            if (const std::string measured = told_of(data, *row); !measured.empty()) state.told += measured + "\n";
        }
        state.told += events_of(session, SweepPoints(sweep, session.description()).run(point));
    }
    tooltip(state.told);
}

// A slider's name that is let go over an axis is what varies along it.
void take_dropped_name(const Session& session, std::size_t place, const Rectangle& area, Commands& commands) {
    if (area.width < 1.0F || area.height < 1.0F || ImGui::GetDragDropPayload() == nullptr) return;
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton(place == 0 ? "sweep x axis" : "sweep y axis", {area.width, area.height});
    if (!ImGui::BeginDragDropTarget()) return;
    if (const ImGuiPayload* const dropped = ImGui::AcceptDragDropPayload(dragged_name)) {
        const std::string name(static_cast<const char*>(dropped->Data), static_cast<std::size_t>(dropped->DataSize));
        Sweep sweep = session.sweep();
        const std::size_t at = std::min(place, sweep.axes.size());
        const auto twice = std::find_if(sweep.axes.begin(), sweep.axes.end(),
                                        [&](const SweepAxis& axis) { return axis.name == name; });
        if (const auto axis = axis_for(session, name)) {
            if (twice != sweep.axes.end() && at < sweep.axes.size())
                std::iter_swap(twice, sweep.axes.begin() + static_cast<std::ptrdiff_t>(at));  // they change places
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
    if (ImGui::IsItemActive() && (has_moved || ImGui::IsItemActivated())) go_to(data, values, commands);
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) tell(session, data, values, state.sweep);
}

// How far it is, and the cross that hides the panel.
float show_progress(const Session& session, const Rectangle& row, PanelState& state, Commands& commands) {
    const float size = ImGui::GetFontSize(), cross = row.height;
    ImGui::SetCursorScreenPos({row.x + row.width - cross, row.y});
    if (ImGui::InvisibleButton("hide sweep", {cross, row.height})) commands.emplace_back(command::Show{"sweep", false});
    remember(state, "hide sweep");
    const bool lit = ImGui::IsItemHovered();
    tooltip("hide the sweep");
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 middle{row.x + row.width - 0.5F * cross, row.y + 0.5F * row.height};
    const float arm = units(4.0F);
    for (const float sign : {1.0F, -1.0F})
        list->AddLine({middle.x - arm, middle.y - sign * arm}, {middle.x + arm, middle.y + sign * arm},
                      packed(lit ? text_color() : faint_color()), units(1.3F));
    float right = row.x + row.width - cross - units(6.0F);
    const SweepJob& job = session.sweep_job();
    if (!job.is_busy()) return right;
    const std::string text = fmt::format("{:.0f} %", 100.0 * job.share());
    right -= label_width(text, size);
    paint_label(list, right, row.y + 0.5F * (row.height - 1.2F * size), text, faint_color(), size);
    return right - units(8.0F);
}

}  // namespace

void show_sweep(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle cell = remaining();
    const auto [row, inner] = paint_plot_card(cell);
    if (inner.width < 2.0F || inner.height < 2.0F) return;
    const float right = show_progress(session, row, state, commands);
    show_sweep_menus(session, {row.x, row.y, right - row.x, row.height}, state, commands);
    const SweepJob& job = session.sweep_job();
    const auto message = [&](const std::string& text) {
        ImGui::SetCursorScreenPos({inner.x, inner.y + units(6.0F)});
        show_message(text, inner.width);
    };
    if (!job.problem().empty()) return message(job.problem());
    if (!job.data()) return;
    const Panel& panel = composed(session, state.sweep);
    if (!state.sweep.problem.empty()) return message(state.sweep.problem);
    Rectangle below = inner;
    if (panel.legend && panel.legend_above) {  // it ends at the right, where the cross is, and the menus may be as long
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
