// The Zeno lens in place of the plots: the impacts before the selected Zeno point over a logarithmic time axis without
// end.
#include "figure/lens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/output.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr float lens_margin = 12.0F;

std::string explanation(const Lens& lens) {
    return fmt::format(
        "Each flight lasts e = {} times as long as the one before and is e\u00b2 times as high. With time as "
        "\u2212log(\u03c4\u221e \u2212 t) and the gap over the impact speed squared, infinitely many bounces become an "
        "endless row of equal arcs.",
        number(lens.restitution(), "{:.4g}"));
}

// Buttons that scroll to the start of the sequence, the cut, and the certified interval.
void show_places(const Lens& lens, double width, PanelState& state, Commands& commands) {
    const auto place = [&](const char* name, double x, const char* about) {
        if (ImGui::Button(name)) commands.emplace_back(command::ShowLens{x});
        remember(state, std::string("lens ") + name);
        tooltip(about);
    };
    place("first impact", lens.first() - 0.05 * width, "where the row begins");
    ImGui::SameLine();
    place("cut", lens.cut() - 0.3 * width, "where the impact sequence was cut and the contact began");
    if (lens.interval()) {
        ImGui::SameLine();
        place("certified interval", *lens.interval() - 0.5 * width, "the certified interval of the Zeno time");
    }
}

// Drag scrolls; the wheel scrolls by a quarter of a decade per notch.
void use_mouse(const Lens& lens, double low, double width, const Rectangle& inside, Commands& commands) {
    const ImGuiIO& io = ImGui::GetIO();
    double moved = 0.0;
    if (ImGui::IsItemHovered()) moved -= 0.25 * double{io.MouseWheel};
    if (ImGui::IsItemActive() && inside.width > 1.0F) moved -= width * double{io.MouseDelta.x} / double{inside.width};
    if (moved != 0.0) commands.emplace_back(command::ShowLens{std::max(low + moved, lens.first() - 0.5 * width)});
}

void show_row(const Session& session, const Lens& lens, float height, PanelState& state, Commands& commands) {
    const Lens::LensPart overview = lens.overview();
    const double width = overview.high - overview.low, low = session.scene().lens().value_or(overview.low);
    const Panel panel = lens.panel(low, low + width, session.theme());
    Rectangle area = remaining();
    area.height = height;
    area.width -= units(lens_margin);
    const Rectangle inside = paint(panel, screen_style(session.theme()), ImGui::GetWindowDrawList(), area, units(1.0F));
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton("lens", {std::max(area.width, 1.0F), std::max(area.height, 1.0F)});
    remember(state, "lens");
    use_mouse(lens, low, width, inside, commands);
    tooltip("drag, or use the wheel, to move along the row");
    ImGui::SetCursorScreenPos({area.x, area.y + area.height + units(6.0F)});
    show_places(lens, width, state, commands);
}

// The cut, and the bound of the Zeno time, in words.
void show_interval(const Session& session, std::size_t index, float width) {
    const Event& zeno = session.trajectory().events[index];
    if (zeno.truncation)
        paragraph(fmt::format("Cut {:.3g} s before \u03c4\u221e, after {} impacts.", zeno.t - zeno.truncation->t,
                              zeno.impacts),
                  width, text_color());
    if (!zeno.certificate || !zeno.certificate->certified || session.precision().is_beyond(zeno.t)) return;
    const EventTime time = event_time(session, index);
    paragraph(fmt::format("{}\n\u03c4\u221e = {} s.",
                          time.is_proved ? "Proved:" : "Certified from the computed state at the cut:", time.text()),
              width, event_markers(session.theme(), Event::Kind::zeno).fill);
}

}  // namespace

bool lens_is_open(const Session& session) {
    return session.scene().shows("lens") && session.selected_zeno() != nullptr;
}

void show_lens(const Session& session, PanelState& state, Commands& commands) {
    const auto index = static_cast<std::size_t>(session.selected() - 1);
    const Event& zeno = session.trajectory().events[index];
    const Rectangle card = remaining();
    ImGui::GetWindowDrawList()->AddRectFilled({card.x, card.y}, {card.x + card.width, card.y + card.height},
                                              packed(session.theme().background), units(4.0F));
    const float edge = units(lens_margin), width = card.width - 2.0F * edge;
    if (width < units(80.0F) || card.height < units(120.0F)) return;
    ImGui::SetCursorScreenPos({card.x + edge, card.y + edge});
    ImGui::BeginGroup();
    if (show_card_title("Zeno lens",
                        fmt::format("event {}, {} = {} s", index + 1, is_plastic_landing(zeno) ? "t" : "\u03c4\u221e",
                                    event_time(session, index).text()),
                        state, 2.0F * edge))
        commands.emplace_back(command::Show{"lens", false});
    const auto lens = Lens::at(session.trajectory(), index);
    if (!lens) {
        paragraph(is_plastic_landing(zeno)    ? "A plastic impact: with restitution 0 there are no bounces to show."
                  : zeno.contacts.count() > 1 ? "Several contacts come to rest together: there is no row of equal arcs."
                                              : "A single impact: there are no bounces to show.",
                  width, faint_color());
    } else {
        paragraph(explanation(*lens), width, faint_color());
        ImGui::Dummy({0.0F, units(2.0F)});
        const float below = ImGui::GetFrameHeight() + 3.0F * ImGui::GetTextLineHeightWithSpacing() + 2.0F * edge;
        const float height = card.y + card.height - ImGui::GetCursorScreenPos().y - below;
        show_row(session, *lens, std::clamp(height, units(60.0F), 0.75F * width), state, commands);
        show_interval(session, index, width);
    }
    ImGui::EndGroup();
}

}  // namespace achilles
