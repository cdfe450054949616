// Under the mechanism: what came out of the run, in a line or two. Every Zeno point, release and opening impact is pressed to go
// there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "output/contacts.hpp"
#include "output/output.hpp"
#include "paint/marker.hpp"
#include "panels/turns.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr float padding = 6.0F, sign_width = 18.0F, between = 14.0F;
// Always so many lines in this width: nothing moves where another run has more results.
int lines_in(float width) { return width < units(360.0F) ? 3 : 2; }

struct Result {
    std::size_t event = 0;
    std::string text, rest;        // what may be cut, and what may not
    float x = 0.0F, width = 0.0F;  // pixels
    int line = 0;
};

// A certificate in its symbols; the sentence itself is plain text, for terminals.
std::string typeset_sentence(const Trajectory& trajectory, const Event& event) {
    std::string text = sentence(*event.certificate, trajectory.model->description());
    for (const auto& [plain, symbol] :
         {std::pair{"tau_inf", "\u03c4\u221e"}, std::pair{"tau_k", "\u03c4\u2096"}, std::pair{"_inf", "\u221e"},
          std::pair{"; ", "\n"}, std::pair{" - ", " \u2212 "}, std::pair{"e-0", "e\u22120"},
          std::pair{"e-1", "e\u22121"}})
        for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at + 1))
            text.replace(at, std::string_view(plain).size(), symbol);
    return text;
}

std::string explanation(const Trajectory& trajectory, const Event& event) {
    const std::string contacts = contacts_told(trajectory, event), of = contacts.empty() ? "" : " of " + contacts;
    if (event.kind == Event::Kind::release)
        return fmt::format("release{} at t = {:.10g} s: the contact force falls through zero. Click: why", of, event.t);
    if (event.kind == Event::Kind::impact)
        return fmt::format("impact{} at t = {:.10g} s opens {}. Click: why", of, event.t,
                           joined_names(*trajectory.model, event.opened));
    if (is_plastic_landing(event))
        return fmt::format("landing{} at t = {:.10g} s\n{}", of, event.t, typeset_sentence(trajectory, event));
    const std::string proof = event.certificate ? typeset_sentence(trajectory, event) : "Nothing is proved of it.";
    return fmt::format("{}{} at t = {:.10g} s after {} impacts\n{}\n{}", event_name(event), of, event.t, event.impacts,
                       proof, precision_text());
}

// "Zeno 2", "landing", "release knee", "wall opens knee".
std::string name_of(const Trajectory& trajectory, const Event& event, int& zeno) {
    const std::string contacts = contacts_told(trajectory, event), space = contacts.empty() ? "" : " ";
    if (is_plastic_landing(event)) return "landing" + space + contacts;
    if (event.kind == Event::Kind::zeno) return fmt::format("Zeno {}{}{}", ++zeno, space, contacts);
    if (event.kind == Event::Kind::release) return "release" + space + contacts;
    return fmt::format("{} opens {}", contacts, joined_names(*trajectory.model, event.opened));
}

// In lines as wide as there is room, each with the gap before it.
std::vector<Result> results_of(const Trajectory& trajectory, float width) {
    constexpr std::size_t most = 400;  // more than anybody reads, and a frame has no time for
    std::vector<Result> results;
    int zeno = 0, line = 0;
    const std::vector<Chatter> chatters = chatters_of(trajectory);
    auto chatter = chatters.begin();
    float x = 0.0F;
    for (const std::size_t turn : turns(trajectory, true)) {
        if (results.size() == most) break;
        const Event& event = trajectory.events[turn];
        while (chatter != chatters.end() && turn >= chatter->last_event) ++chatter;
        // Of contacts that come to rest and are opened again and again only how it ends.
        if (chatter != chatters.end() && turn >= chatter->first_event && turn + 1 < chatter->last_event) {
            zeno += event.kind == Event::Kind::zeno && !is_plastic_landing(event) ? 1 : 0;
            continue;
        }
        Result result{turn, name_of(trajectory, event, zeno), "  " + time_text(trajectory, turn)};
        const auto length = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
        result.text = fitted(result.text, std::max(width - units(sign_width) - length(result.rest), units(40.0F)));
        result.width = units(sign_width) + length(result.text + result.rest);
        if (x > 0.0F && x + result.width > width) x = 0.0F, ++line;
        result.x = x;
        result.line = line;
        x += result.width + units(between);
        results.push_back(result);
    }
    return results;
}

// What is to be seen: the chosen event, or the last one that the present has reached; else the first.
std::size_t wanted(const Session& session, const std::vector<Result>& results) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const bool is_chosen = session.selected() == static_cast<int>(results[i].event) + 1;
        const double time = session.trajectory().events[results[i].event].t;
        if (is_chosen || (session.selected() == 0 && time <= session.time())) found = i;
    }
    return found;
}

// The results that stand in so many lines, from the first line that is shown on.
struct Shown {
    std::size_t begin, end;
    int first;
};
Shown shown_in(const std::vector<Result>& results, std::size_t wanted, int lines) {
    const int first = std::clamp(results[wanted].line - lines + 1, 0, std::max(0, results.back().line - lines + 1));
    Shown shown{results.size(), results.size(), first};
    for (std::size_t i = results.size(); i-- > 0;) {
        if (results[i].line >= first + lines) shown.end = i;
        if (results[i].line >= first) shown.begin = i;
    }
    return shown;
}

void show_result(const Session& session, const Result& result, ImVec2 at, const Rectangle& strip, PanelState& state,
                 Commands& commands) {
    const Event& event = session.trajectory().events[result.event];
    const int number = static_cast<int>(result.event) + 1;
    const float height = ImGui::GetTextLineHeightWithSpacing(), line = ImGui::GetTextLineHeight();
    ImGui::SetCursorScreenPos(at);
    ImGui::PushID(number);
    const bool pressed = ImGui::InvisibleButton("result", {result.width, height});
    ImGui::PopID();
    remember(state, "result " + std::to_string(number));
    ImDrawList* list = ImGui::GetWindowDrawList();
    const bool is_chosen = session.selected() == number;
    if (is_chosen || ImGui::IsItemHovered())
        list->AddRectFilled({at.x - units(4.0F), at.y}, {at.x + result.width + units(4.0F), at.y + height},
                            is_chosen ? ImGui::GetColorU32(ImGuiCol_Header) : packed(text_color(), 0.06F), units(3.0F));
    const float top = at.y + 0.5F * (height - line);
    paint_marker(list, event_markers(session.theme(), event.kind), {at.x + units(6.0F), top + 0.5F * line},
                 units(1.0F));
    list->AddText({std::floor(at.x + units(sign_width)), std::floor(top)}, packed(text_color()),
                  (result.text + result.rest).c_str());
    tooltip(explanation(session.trajectory(), event),
            {at.x, strip.y, result.width, strip.height});  // the other results stay in sight
    if (pressed) commands.emplace_back(command::Select{is_chosen ? 0 : number});
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
    if (is_early)
        text = fmt::format("{} at t = {:.6g} s: {}", to_text(trajectory.outcome.kind), trajectory.end_time,
                           trajectory.outcome.message);
    ImGui::SetCursorScreenPos({at.x, at.y + units(1.0F)});
    ImGui::TextDisabled("%s", fitted(text, width).c_str());
    if (is_early) tooltip(trajectory.outcome.message);
}

// "3 before, 12 more".
std::string hidden_text(std::size_t before, std::size_t after) {
    return fmt::format("{}{}{}", before > 0 ? fmt::format("{} before", before) : "",
                       before > 0 && after > 0 ? ", " : "", after > 0 ? fmt::format("{} more", after) : "");
}

// To two digits, and not below what it was.
std::string rounded_up(double bound) {
    const double unit = std::pow(10.0, std::floor(std::log10(bound)) - 1.0);
    std::string text = fmt::format("{:.2g}", std::ceil(bound / unit) * unit);
    if (const std::size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
    return text;
}

}  // namespace

std::string precision_text() {
    return "\u00b1: proved of the Zeno time from the computed state at the cut.\n"
           "The integration and the cuts before it are not covered: where an\n"
           "estimate of theirs is larger, that stands here, and nothing is proved of it.";
}

std::string time_text(const Trajectory& trajectory, std::size_t index) {
    const Event& event = trajectory.events[index];
    const bool is_proved = event.certificate && event.certificate->certified;
    const double low = is_proved ? event.certificate->zeno_low : 0.0,
                 high = is_proved ? event.certificate->zeno_high : 0.0;
    const double half = 0.5 * (high - low);
    if (!is_proved || !(half > 0.0)) return number(event.t, "{:.6f}");
    const double integration = integration_error_of_time(trajectory, index);  // digits that it may change mean nothing
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(std::max(half, integration)))), 0, 12);
    const std::string text = fmt::format("{:.{}f}", event.t, digits);
    const double value = std::strtod(text.c_str(), nullptr);
    return text + " \u00b1 " + rounded_up(std::max({high - value, value - low, integration}));
}

float results_height(float width) {
    return static_cast<float>(lines_in(width)) * ImGui::GetTextLineHeightWithSpacing() + 2.0F * units(padding);
}

void show_results(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle area = remaining();
    ImGui::GetWindowDrawList()->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height},
                                              packed(session.theme().background), units(4.0F));
    const float left = area.x + units(12.0F), width = area.width - units(24.0F);
    const float height = ImGui::GetTextLineHeightWithSpacing();
    const std::vector<Result> results = results_of(session.trajectory(), width);
    if (results.empty()) return show_none(session, {left, area.y + units(padding)}, width);
    // A window stands on whole pixels: a strip of results_height() may have one less.
    const auto fitting = static_cast<int>((area.height + 1.0F - 2.0F * units(padding)) / height);
    const int lines_shown = std::min(lines_in(area.width), fitting);
    if (lines_shown < 1) return;
    const std::size_t all = turns(session.trajectory(), true).size();
    const auto width_of = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
    // Where not all are shown the last line ends with a word of the others: what is in its way gives place, but for what
    // is to be seen, which stands in a line before then.
    const std::size_t seen = wanted(session, results);
    Shown shown = shown_in(results, seen, lines_shown);
    std::string more;
    const auto has_room = [&] {
        more = hidden_text(shown.begin, all - (shown.end - shown.begin) - shown.begin);
        const Result& last = results[shown.end - 1];
        return more.empty() || last.line - shown.first + 1 < lines_shown ||
               last.x + last.width + units(between) + width_of(more) <= width;
    };
    while (!has_room() && shown.end - 1 > std::max(seen, shown.begin)) --shown.end;
    if (!has_room() && lines_shown > 1) shown = shown_in(results, seen, lines_shown - 1);
    const bool is_told = has_room() && !more.empty();
    for (std::size_t i = shown.begin; i < shown.end; ++i)
        show_result(
            session, results[i],
            {left + results[i].x, area.y + units(padding) + height * static_cast<float>(results[i].line - shown.first)},
            area, state, commands);
    if (!is_told) return;
    ImGui::SetCursorScreenPos({std::floor(left + width - width_of(more)),
                               area.y + units(padding) + height * static_cast<float>(lines_shown - 1) + units(2.0F)});
    ImGui::TextDisabled("%s", more.c_str());
    tooltip("the list of events has them all");
}

}  // namespace achilles
