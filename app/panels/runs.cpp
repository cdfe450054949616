// The list of the current and the pinned runs, and their comparison.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "figure/palette.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

// ---- below the sliders: each run with its color and its differences ----

namespace {

constexpr float run_sign_width = 20.0F, word_gap = 10.0F;

// A faint text button that ends at x on the line at y; x becomes its left end.
bool word(const char* text, const std::string& name, const std::string& about, float& x, float y, PanelState& state) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    x = std::floor(x - size.x);
    ImGui::SetCursorScreenPos({x, y});
    const bool pressed = ImGui::InvisibleButton(name.c_str(), {size.x, ImGui::GetTextLineHeight()});
    remember(state, name);
    tooltip(about);
    const Color color = ImGui::IsItemHovered() ? text_color() : current_theme().accent;
    ImGui::GetWindowDrawList()->AddText({x, y}, packed(color), text);
    x -= units(word_gap);
    return pressed;
}

// A line as thick as in the plots; hollow if the run is hidden.
void paint_sign(const ImVec2& at, const Color& color, bool shown) {
    const float middle = std::floor(at.y + 0.5F * ImGui::GetTextLineHeight()), half = units(3.0F);
    const ImVec2 low{at.x, middle - half}, high{at.x + units(14.0F), middle + half};
    if (shown)
        ImGui::GetWindowDrawList()->AddRectFilled(low, high, packed(color), units(1.5F));
    else
        ImGui::GetWindowDrawList()->AddRect({low.x + 0.5F, low.y + 0.5F}, {high.x - 0.5F, high.y - 0.5F}, packed(color),
                                            units(1.5F));
}

void show_heading(const Session& session, PanelState& state, Commands& commands) {
    const float free = ImGui::CalcTextSize("table").x + ImGui::CalcTextSize("unpin all").x + units(2.0F * word_gap);
    section("Runs", free);
    const float y = ImGui::GetItemRectMin().y;
    const ImVec2 next = ImGui::GetCursorScreenPos();
    float right = ImGui::GetWindowPos().x + content_right();
    if (word("unpin all", "unpin all", "Unpin all runs", right, y, state)) commands.emplace_back(command::UnpinAll{});
    const bool open = session.scene().shows("runs");
    if (word("table", "runs table",
             open ? "close the table of the runs" : "show the differences between the runs in a table below", right, y,
             state)) {
        commands.emplace_back(command::Show{"runs", !open});
        // It shares the place of the event cards and lower panels.
        if (!open && session.selected() > 0) commands.emplace_back(command::Select{0});
        for (const std::string& other : command::studies)
            if (!open && session.scene().shows(other)) commands.emplace_back(command::Show{other, false});
        if (!open && !session.scene().shows("events")) commands.emplace_back(command::Show{"events", true});
    }
    ImGui::SetCursorScreenPos(next);
}

void show_run(const PinnedRun& run, const Session& session, PanelState& state, Commands& commands) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::max(ImGui::GetContentRegionAvail().x, 1.0F), line = ImGui::GetTextLineHeight();
    const std::string number = std::to_string(run.place);
    float right = at.x + width;
    if (word("\u00d7", "unpin " + number, "unpin this run", right, at.y, state))
        commands.emplace_back(command::Unpin{run.place});
    const bool is_present = run.trajectory->run == session.run();
    if (!is_present &&
        word("use", "recall " + number, "make it the present run: all sliders return to its values (Ctrl+Z to undo)",
             right, at.y, state))
        commands.emplace_back(command::Recall{run.place});
    ImGui::SetCursorScreenPos(at);
    if (ImGui::InvisibleButton(("pinned " + number).c_str(), {std::max(1.0F, right - at.x), line}))
        commands.emplace_back(command::ShowPinned{run.place, !run.shown});
    remember(state, "pinned " + number);
    const bool is_hovered = ImGui::IsItemHovered();
    const std::string name = run.name.empty() ? "same as present run" : run.name;
    tooltip(name + (run.shown ? ": pinned. Click to hide it" : ": pinned, hidden. Click to show it"));
    paint_sign(at, run_color(session.theme(), run.place), run.shown);
    const std::string fitted_name = fitted(name, right - at.x - units(run_sign_width));
    cell({at.x + units(run_sign_width), at.y}, fitted_name, right - at.x - units(run_sign_width) + 1.0F,
         run.shown || is_hovered ? text_color() : faint_color());
    ImGui::SetCursorScreenPos({at.x, at.y + ImGui::GetTextLineHeightWithSpacing()});
}

// A run to be pinned that is not finished yet.
void show_waiting(int place, const Session& session, PanelState& state, Commands& commands) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::max(ImGui::GetContentRegionAvail().x, 1.0F);
    float right = at.x + width;
    if (word("\u00d7", "unpin " + std::to_string(place), "do not pin this run", right, at.y, state))
        commands.emplace_back(command::Unpin{place});
    paint_sign(at, run_color(session.theme(), place), false);
    cell({at.x + units(run_sign_width), at.y}, "still under way", right - at.x - units(run_sign_width), faint_color());
    ImGui::SetCursorScreenPos({at.x, at.y + ImGui::GetTextLineHeightWithSpacing()});
}

}  // namespace

float name_runs(const Session& session, const Rectangle& row, float right) {
    const Scene& scene = session.scene();
    const bool are_named = scene.shows("controls") && !scene.shows("editor") && !scene.presents();
    if (session.pinned().empty() || are_named) return right;
    const float size = 0.87F * ImGui::GetFontSize(), sign = units(16.0F), space = units(10.0F);
    const float y = row.y + 0.5F * (row.height - 1.2F * size), middle = std::floor(row.y + 0.5F * row.height) + 0.5F;
    const float room = right - (row.x + 0.35F * row.width);  // leaves room for the title
    // Collected from the right; the current run comes first.
    std::vector<std::pair<std::string, Color>> names;
    for (auto run = session.pinned().rbegin(); run != session.pinned().rend(); ++run)
        if (run->shown) names.emplace_back(run->name, run_color(session.theme(), run->place));
    names.emplace_back(session.name_of_run(), session.theme().ink);
    const float each = room / static_cast<float>(names.size()) - sign - space;
    if (each < units(24.0F)) return right;
    for (const auto& [name, color] : names) {
        const std::string text = fitted(name.empty() ? "the same" : name, each / 0.87F);
        right -= label_width(text, size) + sign + space;
        ImDrawList* list = ImGui::GetWindowDrawList();
        list->AddLine({right, middle}, {right + sign - units(4.0F), middle}, packed(color), units(3.0F));
        paint_label(list, right + sign, y, text, text_color(), size);
    }
    return right;
}

void show_runs(const Session& session, PanelState& state, Commands& commands) {
    const std::vector<int> waiting = session.pins_under_way();
    if (session.pinned().empty() && waiting.empty()) return;
    show_heading(session, state, commands);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::max(ImGui::GetContentRegionAvail().x, 1.0F);
    paint_sign(at, session.theme().ink, true);
    cell({at.x + units(run_sign_width), at.y},
         session.name_of_run().empty() ? "present run" : "present: " + session.name_of_run(),
         width - units(run_sign_width), text_color());
    ImGui::Dummy({width, ImGui::GetTextLineHeight()});
    for (const PinnedRun& run : session.pinned()) show_run(run, session, state, commands);
    for (const int place : waiting) show_waiting(place, session, state, commands);
    ImGui::Dummy({1.0F, 0.0F});  // an item must follow the last one for the layout
}

// ---- table beside the event list, one column per run, differences highlighted ----

namespace {

constexpr float run_name_width = 132.0F, widest_column = 190.0F, min_column = 74.0F, table_sign_width = 15.0F;

// Widths of the columns: the names, each run, and with one pinned run the changes. As wide as the panel allows.
std::vector<float> columns_of(const Session& session) {
    const std::size_t runs = session.pinned().size() + 1, count = runs == 2 ? 3 : runs;
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
    const float first = std::floor(std::min(units(run_name_width), 0.28F * room));
    std::vector<float> columns(count + 1,
                               std::floor(std::min(units(widest_column), (room - first) / static_cast<float>(count))));
    columns.front() = first;
    return columns;
}

void paint_table_sign(const ImVec2& at, const Color& color) {
    const float middle = std::floor(at.y + 0.5F * ImGui::GetTextLineHeight()) + 0.5F;
    ImGui::GetWindowDrawList()->AddLine({at.x, middle}, {at.x + units(10.0F), middle}, packed(color), units(3.0F));
}

// Names and colors of the runs; this line does not scroll.
void show_head(const Session& session, const std::vector<float>& columns) {
    const LineTable table("names", columns);
    table.next_row();
    table.put("", faint_color());
    const auto title = [&](const std::string& name, const Color& color) {
        paint_table_sign(table.put(name, text_color(), units(table_sign_width)), color);
    };
    title(session.name_of_run().empty() ? "present" : session.name_of_run(), session.theme().ink);
    for (const PinnedRun& run : session.pinned())
        title(run.name.empty() ? "pinned" : run.name, run_color(session.theme(), run.place));
    if (session.pinned().size() == 1) table.put("change", faint_color());
}

// Bright where the value differs from the current run's; that one is bright if any differs.
void show_row(const RunTable::Row& row, const LineTable& table) {
    const bool any = std::find(row.differs.begin(), row.differs.end(), true) != row.differs.end();
    table.next_row();
    table.put(row.name, any ? text_color() : faint_color());
    for (std::size_t i = 0; i < row.values.size(); ++i)
        table.put(row.values[i], row.differs[i] || (i == 0 && any) ? text_color() : faint_color());
    if (any && row.values.size() == 2) table.put(row.change, text_color());
}

// The inputs that differ, a line, and the results.
void show_rows(const RunTable& runs, const std::vector<float>& columns) {
    const auto show_part = [&](bool is_cause) {
        const LineTable table(is_cause ? "inputs" : "results", columns);
        for (const RunTable::Row& row : runs.rows)
            if (row.is_cause == is_cause) show_row(row, table);
    };
    show_part(true);
    if (!runs.rows.empty() && runs.rows.front().is_cause && !runs.rows.back().is_cause) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float y = std::floor(at.y - 0.5F * ImGui::GetStyle().ItemSpacing.y) + 0.5F;
        const float width = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
        const float end = at.x + std::min(width, std::accumulate(columns.begin(), columns.end(), 0.0F));
        ImGui::GetWindowDrawList()->AddLine({at.x, y}, {end, y}, ImGui::GetColorU32(ImGuiCol_Border));
    }
    show_part(false);
}

// A run's marker, then how it differs.
void show_parting(const PinnedRun& run, const std::string& sentence, float width, const Session& session) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    paint_table_sign(at, run_color(session.theme(), run.place));
    cell({at.x + units(table_sign_width), at.y}, sentence, width - units(table_sign_width), text_color());
    ImGui::Dummy({width, ImGui::GetTextLineHeight()});
}

}  // namespace

float comparison_width(const Session& session) {
    const std::size_t runs = session.pinned().size() + 1;
    return units(run_name_width + min_column * static_cast<float>(runs == 2 ? 3 : runs));
}

void show_comparison(const Session& session, PanelState& state, Commands& commands) {
    const RunTable& table = session.run_table();
    if (show_card_title(
            session.pinned().size() == 1 ? "Comparison with the pinned run" : "Comparison with the pinned runs", "",
            state))
        commands.emplace_back(command::Show{"runs", false});
    const std::vector<float> columns = columns_of(session);
    show_head(session, columns);
    const float line = ImGui::GetTextLineHeightWithSpacing();  // height of whole lines
    const float room = std::max(line, std::floor(ImGui::GetContentRegionAvail().y / line) * line);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::BeginChild("table", {0.0F, room}, false);
    const float width = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
    show_rows(table, columns);
    for (const auto& [run, sentence] : table.divergences)
        show_parting(session.pinned()[run - 1], sentence, width, session);
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

}  // namespace achilles
