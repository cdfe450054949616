// Beside the list of events: the present run and the pinned ones in a table, a column each. What differs stands out.
#include <algorithm>
#include <cmath>

#include "figure/palette.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr float run_name_width = 132.0F, widest_column = 190.0F, least_column = 74.0F, sign_width = 15.0F;

// The columns of a table as wide as the panel.
struct Columns {
    float first = 0.0F, each = 0.0F;
    std::size_t count = 0;  // runs, and behind them the change where there is one
    float at(std::size_t i) const { return first + each * static_cast<float>(i); }
};

Columns columns_of(const Session& session) {
    Columns columns;
    const std::size_t runs = session.pinned().size() + 1;
    columns.count = runs == 2 ? 3 : runs;
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
    columns.first = std::min(units(run_name_width), 0.28F * room);
    columns.each = std::min(units(widest_column), (room - columns.first) / static_cast<float>(columns.count));
    return columns;
}

void paint_sign(const ImVec2& at, const Color& color) {
    const float middle = std::floor(at.y + 0.5F * ImGui::GetTextLineHeight()) + 0.5F;
    ImGui::GetWindowDrawList()->AddLine({at.x, middle}, {at.x + units(10.0F), middle}, packed(color), units(3.0F));
}

// Names and colours of the runs; the line stays while the table scrolls.
void show_head(const Session& session, const Columns& columns) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const auto title = [&](std::size_t i, const std::string& name, const Color* color) {
        const float x = at.x + columns.at(i), side = color != nullptr ? units(sign_width) : 0.0F;
        if (color != nullptr) paint_sign({x, at.y}, *color);
        cell({x + side, at.y}, name, columns.each - side - units(6.0F),
             color != nullptr ? text_color() : faint_color());
    };
    const Color ink = session.theme().ink;
    title(0, session.name_of_run().empty() ? "present" : session.name_of_run(), &ink);
    for (std::size_t i = 0; i < session.pinned().size(); ++i) {
        const PinnedRun& run = session.pinned()[i];
        const Color color = run_color(session.theme(), run.place);
        title(i + 1, run.name.empty() ? "pinned" : run.name, &color);
    }
    if (session.pinned().size() == 1) title(2, "change", nullptr);
    ImGui::Dummy({columns.at(columns.count), ImGui::GetTextLineHeight()});
}

// Strong where it is another than the present run's, which is strong where any differs.
void show_row(const RunTable::Row& row, const Columns& columns) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool any = std::find(row.differs.begin(), row.differs.end(), true) != row.differs.end();
    cell(at, row.name, columns.first - units(6.0F), any ? text_color() : faint_color());
    for (std::size_t i = 0; i < row.values.size(); ++i)
        cell({at.x + columns.at(i), at.y}, row.values[i], columns.each - units(6.0F),
             row.differs[i] || (i == 0 && any) ? text_color() : faint_color());
    if (any && row.values.size() == 2)
        cell({at.x + columns.at(2), at.y}, row.change, columns.each - units(6.0F), text_color());
    ImGui::Dummy({columns.at(columns.count), ImGui::GetTextLineHeight()});
}

// The colour of the run, then what it does.
void show_parting(const PinnedRun& run, const std::string& sentence, float width, const Session& session) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    paint_sign(at, run_color(session.theme(), run.place));
    cell({at.x + units(sign_width), at.y}, sentence, width - units(sign_width), text_color());
    ImGui::Dummy({width, ImGui::GetTextLineHeight()});
}

}  // namespace

float comparison_width(const Session& session) {
    const std::size_t runs = session.pinned().size() + 1;
    return units(run_name_width + least_column * static_cast<float>(runs == 2 ? 3 : runs));
}

void show_comparison(const Session& session, PanelState& state, Commands& commands) {
    const RunTable& table = session.run_table();
    if (show_card_title(
            session.pinned().size() == 1 ? "Comparison with the pinned run" : "Comparison with the pinned runs", "",
            state))
        commands.emplace_back(command::Show{"runs", false});
    const Columns columns = columns_of(session);
    show_head(session, columns);
    const float line = ImGui::GetTextLineHeightWithSpacing();  // none is cut at the bottom
    const float room = std::max(line, std::floor(ImGui::GetContentRegionAvail().y / line) * line);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::BeginChild("table", {0.0F, room}, false);
    const float width = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
    bool was_cause = false;
    for (const RunTable::Row& row : table.rows) {
        // A line between what differs and what follows.
        if (was_cause && !row.is_cause) {
            const ImVec2 at = ImGui::GetCursorScreenPos();
            const float y = std::floor(at.y - 0.5F * ImGui::GetStyle().ItemSpacing.y) + 0.5F;
            ImGui::GetWindowDrawList()->AddLine({at.x, y}, {at.x + std::min(width, columns.at(columns.count)), y},
                                                ImGui::GetColorU32(ImGuiCol_Border));
        }
        was_cause = row.is_cause;
        show_row(row, columns);
    }
    for (const auto& [run, sentence] : table.partings)
        show_parting(session.pinned()[run - 1], sentence, width, session);
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

}  // namespace achilles
