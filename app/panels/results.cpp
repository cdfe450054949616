// The strip of results below the mechanism, from left to right. Every Zeno point, release and opening impact has a cell
// with its name and time; a click goes there. The strip follows the time, and can be moved by drag or wheel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "output/contacts.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr float strip_padding = 6.0F, sign_width = 18.0F, cell_spacing = 12.0F, max_of_strip = 0.6F,
                arrow_width = 30.0F;

// Text and width of a cell. In a strip of one line the time is beside the name.
struct ResultCell {
    std::string name, time;
    float width = 0.0F;
};
struct StripLayout {
    float room = 0.0F;  // pixels, between its ends
    bool is_low = false;
};
ResultCell cell_of(const Session& session, const ListedResult& result, const StripLayout& strip) {
    const Trajectory& trajectory = session.trajectory();
    const EventTime time = event_time(session, result.event);
    const int decimals = decimals_of_times(trajectory);
    // A proof made by itself moves nothing: Zeno points have room for it, and other times keep their number of digits.
    const bool is_zeno = is_zeno_point(trajectory.events[result.event]), is_asked = session.proof() != nullptr;
    const bool is_told = time.is_proved && (is_zeno || is_asked);
    ResultCell cell{result_name(trajectory, result), is_told ? time.short_text : time.text(), 0.0F};
    if (time.is_proved && !is_told)
        cell.time = fmt::format("{:.{}f}", std::strtod(time.digits.c_str(), nullptr), std::min(decimals, 9));
    const std::string before = event_time(trajectory, result.event, session.precision().of_event(result.event)).text();
    const std::string after =
        is_zeno ? fmt::format("{:.{}f}(8)", trajectory.events[result.event].t, decimals) : std::string();
    const std::string& widest = width_of(before) < width_of(after) ? after : before;
    const float reserved = width_of(strip.is_low ? cell.name + "  " + widest : widest);
    if (is_told) cell.name += ", proved";
    if (strip.is_low) cell.name += "  " + std::exchange(cell.time, {});
    // A long name leaves room for a neighbor; a time never loses its tolerance.
    cell.name = fitted(cell.name, (strip.is_low ? 1.0F : max_of_strip) * strip.room - units(sign_width));
    cell.time = fitted(cell.time, strip.room - units(sign_width));
    cell.width = units(sign_width) + std::max({width_of(cell.name), width_of(cell.time), reserved});
    return cell;
}

// The visible cells: results [begin, begin + size). Only these are measured, since a run may have thousands.
struct VisibleResults {
    std::size_t begin = 0;
    std::vector<ResultCell> cells;
};

// As many as fit from `begin` on; at the end of the run the strip is filled with earlier ones.
VisibleResults shown_from(const Session& session, const std::vector<ListedResult>& results, std::size_t begin,
                          const StripLayout& strip) {
    VisibleResults shown{begin, {}};
    float x = 0.0F;
    const auto fits = [&](const ResultCell& cell) { return shown.cells.empty() || x + cell.width <= strip.room; };
    for (std::size_t i = begin; i < results.size(); ++i) {
        ResultCell cell = cell_of(session, results[i], strip);
        if (!fits(cell)) return shown;
        x += cell.width + units(cell_spacing);
        shown.cells.push_back(std::move(cell));
    }
    while (shown.begin > 0) {
        ResultCell cell = cell_of(session, results[shown.begin - 1], strip);
        if (!fits(cell)) break;
        x += cell.width + units(cell_spacing);
        shown.cells.insert(shown.cells.begin(), std::move(cell));
        --shown.begin;
    }
    return shown;
}

// The cells around result `seen`, which is near the middle.
VisibleResults shown_around(const Session& session, const std::vector<ListedResult>& results, std::size_t seen,
                            const StripLayout& strip) {
    std::size_t begin = seen;
    float x = 0.5F * cell_of(session, results[seen], strip).width;
    while (begin > 0) {
        x += cell_of(session, results[begin - 1], strip).width + units(cell_spacing);
        if (x > 0.5F * strip.room) break;
        --begin;
    }
    return shown_from(session, results, begin, strip);
}

// The user's scroll position, until the current time reaches another result.
VisibleResults shown_by(const Session& session, PanelState& state, const std::vector<ListedResult>& results,
                        std::size_t seen, const StripLayout& strip) {
    ResultStrip& by_hand = state.strip;
    if (by_hand.seen != results[seen].event || by_hand.count != results.size()) {
        by_hand = {};
        by_hand.seen = results[seen].event, by_hand.count = results.size();
    }
    if (!by_hand.begin) return shown_around(session, results, seen, strip);
    return shown_from(session, results, std::min(*by_hand.begin, results.size() - 1), strip);
}

// A drag scrolls by whole cells, the wheel by one.
void use_hand(const VisibleResults& shown, std::size_t count, bool is_hovered, PanelState& state) {
    ResultStrip& strip = state.strip;
    const ImGuiIO& io = ImGui::GetIO();
    const auto move = [&](int cells) {
        const int last = static_cast<int>(count) - 1, to = static_cast<int>(shown.begin) + cells;
        // Stop at the last result.
        if (cells > 0 && shown.begin + shown.cells.size() >= count) return;
        strip.begin = static_cast<std::size_t>(std::clamp(to, 0, last));
    };
    const float wheel = io.MouseWheel + io.MouseWheelH;
    if (is_hovered && wheel != 0.0F) move(wheel > 0.0F ? -1 : 1);
    if (is_hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) strip.is_held = true, strip.dragged = 0.0F;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        strip.is_held = false;
        return;
    }
    if (!strip.is_held) return;
    strip.dragged += io.MouseDelta.x;
    const float step = shown.cells.front().width + units(cell_spacing);
    while (std::abs(strip.dragged) > 0.5F * step) {
        const bool back = strip.dragged > 0.0F;
        move(back ? -1 : 1);
        strip.dragged += back ? -step : step;
        strip.was_dragged = true;
    }
}

void show_result(const Session& session, const ListedResult& result, const ResultCell& cell, ImVec2 at,
                 const Rectangle& strip, bool is_present, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[result.event];
    const int number = static_cast<int>(result.event) + 1;
    const float line = ImGui::GetTextLineHeightWithSpacing(), height = cell.time.empty() ? line : 2.0F * line;
    ImGui::SetCursorScreenPos(at);
    ImGui::PushID(number);
    const bool pressed = ImGui::InvisibleButton("result", {cell.width, height});
    ImGui::PopID();
    remember(state, "result " + std::to_string(number));
    ImDrawList* list = ImGui::GetWindowDrawList();
    const bool is_chosen = session.selected() == number;
    const ImVec2 low{at.x - units(6.0F), at.y}, high{at.x + cell.width + units(6.0F), at.y + height};
    if (is_chosen || ImGui::IsItemHovered())
        list->AddRectFilled(low, high, is_chosen ? ImGui::GetColorU32(ImGuiCol_Header) : packed(text_color(), 0.06F),
                            units(3.0F));
    // The last result up to the current time is marked; later ones are faint.
    if (is_present) list->AddRectFilled({low.x, high.y - units(2.0F)}, high, packed(text_color()));
    const bool is_to_come = event.t > session.time();
    paint_marker(list, event_markers(session.theme(), event.kind), {at.x + units(6.0F), at.y + 0.5F * line},
                 units(1.0F));
    const float x = std::floor(at.x + units(sign_width));
    const auto put = [&](float y, const std::string& text, const Color& color) {
        list->AddText({x, std::floor(at.y + y)}, packed(color), text.c_str());
    };
    put(0.5F * (line - ImGui::GetTextLineHeight()), cell.name, is_to_come ? faint_color() : text_color());
    put(line - units(1.0F), cell.time, is_to_come ? faint_color() : text_color());
    tooltip(result_explanation(session, result.event), {at.x, strip.y, cell.width, strip.height},
            true);  // the other results and the timeline stay visible
    if (pressed && !state.strip.was_dragged) commands.emplace_back(command::Select{is_chosen ? 0 : number});
}

// "‹ 3" or "12 ›": the number of results before or after the visible ones; a click scrolls by one strip.
void show_more(bool is_before, std::size_t count, ImVec2 at, const VisibleResults& shown, PanelState& state) {
    if (count == 0) return;
    const bool is_low = shown.cells.front().time.empty();
    const float height = (is_low ? 1.0F : 2.0F) * ImGui::GetTextLineHeightWithSpacing();
    ImGui::SetCursorScreenPos(at);
    const bool pressed = ImGui::InvisibleButton(is_before ? "before" : "after", {units(arrow_width), height});
    remember(state, is_before ? "results before" : "results after");
    const Color color = ImGui::IsItemHovered() ? text_color() : faint_color();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float r = units(4.0F), x = at.x + 0.5F * units(arrow_width), line = ImGui::GetTextLineHeightWithSpacing();
    const float y = at.y + 0.5F * line, tip = is_before ? -r : r;
    list->AddTriangleFilled({x - 0.6F * tip, y - r}, {x - 0.6F * tip, y + r}, {x + 0.8F * tip, y}, packed(color));
    const std::string text = count > 999 ? "\u2026" : std::to_string(count);
    if (!is_low)
        list->AddText(
            {std::floor(x - 0.5F * ImGui::CalcTextSize(text.c_str()).x), std::floor(at.y + line - units(1.0F))},
            packed(color), text.c_str());
    tooltip(fmt::format("{} {}; drag the strip, or use the wheel, to scroll", count, is_before ? "before" : "more"));
    if (!pressed || state.strip.was_dragged) return;
    const std::size_t step = std::max<std::size_t>(1, shown.cells.size() - 1);
    state.strip.begin = is_before ? shown.begin - std::min(step, shown.begin) : shown.begin + step;
}

void show_none(const Session& session, ImVec2 at, float width) {
    const Trajectory& trajectory = session.trajectory();
    const auto impacts = trajectory.statistics.impacts;
    const bool is_early = trajectory.outcome.kind != Outcome::Kind::end_time;
    std::string text = fmt::format("{}, no Zeno point until t = {:.6g} s",
                                   impacts == 0   ? std::string("no impact")
                                   : impacts == 1 ? std::string("one impact")
                                                  : fmt::format("{} impacts", impacts),
                                   trajectory.end_time);
    if (session.shows_start())
        text = "the run is under way";
    else if (is_early)
        text = fmt::format("{} at t = {:.6g} s: {}", to_text(trajectory.outcome.kind), trajectory.end_time,
                           trajectory.outcome.message);
    ImGui::SetCursorScreenPos({at.x, at.y + units(1.0F)});
    ImGui::TextDisabled("%s", fitted(text, width).c_str());
    if (is_early && !session.shows_start()) tooltip(trajectory.outcome.message);
}

}  // namespace

float results_height(const Session& session) {
    if (session.scene().presents()) return 0.0F;
    return 2.0F * ImGui::GetTextLineHeightWithSpacing() + 2.0F * units(strip_padding);
}

void show_results(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle area = remaining();
    ImGui::GetWindowDrawList()->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height},
                                              packed(session.theme().background), units(4.0F));
    const float left = area.x + units(12.0F), width = area.width - units(24.0F), top = area.y + units(strip_padding);
    // Windows are aligned to whole pixels, so a strip of results_height() may be one pixel lower.
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const auto lines = static_cast<int>((area.height + 1.0F - 2.0F * units(strip_padding)) / line);
    if (lines < 1) return;
    const std::vector<ListedResult> results = results_of(session.trajectory());
    if (results.empty()) return show_none(session, {left, top}, width);
    const std::size_t seen = present_result(session, results);
    // Always reserve room for both arrows, so that the cells do not jump when one appears.
    const float inset = units(arrow_width + 6.0F);
    const bool is_low = lines < 2;
    VisibleResults shown = shown_from(session, results, 0, {width, is_low});
    const bool has_all = shown.cells.size() == results.size();
    if (!has_all) shown = shown_by(session, state, results, seen, {width - 2.0F * inset, is_low});
    const bool is_hovered = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    float x = left + (has_all ? 0.0F : inset);
    const auto& events = session.trajectory().events;
    for (std::size_t i = 0; i < shown.cells.size(); ++i) {
        const std::size_t at = shown.begin + i;
        const bool is_present = session.selected() == 0 && at == seen && events[results[at].event].t <= session.time();
        show_result(session, results[at], shown.cells[i], {x, top}, area, is_present, state, commands);
        x += shown.cells[i].width + units(cell_spacing);
    }
    if (has_all) return;
    const std::size_t before = shown.begin, after = results.size() - shown.begin - shown.cells.size();
    show_more(true, before, {left - units(6.0F), top}, shown, state);
    show_more(false, after, {left + width - units(arrow_width - 6.0F), top}, shown, state);
    use_hand(shown, results.size(), is_hovered, state);
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) state.strip.was_dragged = false;
}

}  // namespace achilles
