// No letter is clipped and none overlaps another: in the draw data every glyph lies within its clip rectangle, except
// in scrolled text, and beside its neighbors.
#include <imgui.h>
#include <imgui_internal.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "app/open.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {
namespace {

// Maps a quad's texture coordinates to glyphs of the font atlas.
class Atlas {
 public:
    Atlas() {
        for (ImFont* font : ImGui::GetIO().Fonts->Fonts)
            for (const ImFontGlyph& glyph : glyphs_of(font))
                if (glyph.Visible != 0) glyphs_.push_back(&glyph);
        std::sort(glyphs_.begin(), glyphs_.end(), [](auto* a, auto* b) { return a->V0 < b->V0; });
    }
    // The glyph that contains this part of the texture; null for a fill or a line.
    const ImFontGlyph* at(ImVec2 low, ImVec2 high) const {
        constexpr float slip = 1e-6F;
        for (const ImFontGlyph* glyph : glyphs_) {
            if (glyph->V0 > low.y + slip) break;
            if (low.x >= glyph->U0 - slip && high.x <= glyph->U1 + slip && high.y <= glyph->V1 + slip) return glyph;
        }
        return nullptr;
    }

 private:
    std::vector<const ImFontGlyph*> glyphs_;
};

std::string utf8(ImWchar code) {
    char text[5] = {};
    ImTextCharToUtf8(text, code);
    return text;
}

struct ClippedText {
    std::string window, letters;
};

// A letter on the screen.
struct LetterBox {
    ImVec2 from, to;
    ImWchar code;
};

// True if letters of different words overlap. Letters of one word may touch, and dots may be above theirs.
bool is_on(const LetterBox& a, const LetterBox& b) {
    const auto width = [](const LetterBox& letter) { return letter.to.x - letter.from.x; };
    const auto height = [](const LetterBox& letter) { return letter.to.y - letter.from.y; };
    return std::min(a.to.x, b.to.x) - std::max(a.from.x, b.from.x) > 0.6F * std::min(width(a), width(b)) &&
           std::min(a.to.y, b.to.y) - std::max(a.from.y, b.from.y) > 0.5F * std::max(height(a), height(b));
}

std::string letters_on_others(std::vector<LetterBox> letters) {
    std::string found;
    std::sort(letters.begin(), letters.end(),
              [](const LetterBox& a, const LetterBox& b) { return a.from.x < b.from.x; });
    for (std::size_t i = 0; i < letters.size(); ++i)
        for (std::size_t j = i + 1; j < letters.size() && letters[j].from.x < letters[i].to.x; ++j)
            if (is_on(letters[i], letters[j])) found += utf8(letters[i].code) + utf8(letters[j].code) + " ";
    return found;
}

// A scrollable window may clip its text vertically, but not horizontally, except the editor, whose long lines scroll.
bool is_editor(const char* name) { return std::string(name).find("##text") != std::string::npos; }
bool scrolls(const char* name) {
    const ImGuiWindow* window = ImGui::FindWindowByName(name);
    return window != nullptr && window->ScrollMax.y > 0.0F && (window->Flags & ImGuiWindowFlags_NoScrollWithMouse) == 0;
}

std::vector<ClippedText> cut_letters(const ImDrawData& data) {
    const Atlas atlas;
    std::vector<ClippedText> cuts;
    for (int n = 0; n < data.CmdListsCount; ++n) {
        const ImDrawList& list = *data.CmdLists[n];
        if (list._OwnerName != nullptr && is_editor(list._OwnerName)) continue;
        const bool scrolled = list._OwnerName != nullptr && scrolls(list._OwnerName);
        ClippedText cut{list._OwnerName != nullptr ? list._OwnerName : "", ""};
        std::vector<LetterBox> placed;
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback != nullptr) continue;
            for (unsigned i = 0; i + 6 <= command.ElemCount;) {
                const ImDrawIdx* index = &list.IdxBuffer[static_cast<int>(command.IdxOffset + i)];
                const ImDrawVert* v = &list.VtxBuffer[static_cast<int>(command.VtxOffset)];
                const bool is_quad = index[1] == index[0] + 1 && index[2] == index[0] + 2 && index[3] == index[0] &&
                                     index[4] == index[2] && index[5] == index[0] + 3;
                const ImVec2 low = v[index[0]].uv, high = v[index[2]].uv;
                const ImFontGlyph* glyph = is_quad && low.x < high.x && low.y < high.y ? atlas.at(low, high) : nullptr;
                if (glyph == nullptr) {
                    i += 3;
                    continue;
                }
                ImVec2 from = v[index[0]].pos, to = from;
                for (int k = 0; k < 4; ++k) {
                    const ImVec2 p = v[index[0] + k].pos;
                    from = {std::min(from.x, p.x), std::min(from.y, p.y)};
                    to = {std::max(to.x, p.x), std::max(to.y, p.y)};
                }
                // A glyph's quad may have an empty pixel at its edge.
                const ImVec4& clip = command.ClipRect;
                constexpr float slip = 1.01F, cut_uv = 1e-4F;
                if (to.x > clip.x && from.x < clip.z && to.y > clip.y && from.y < clip.w)
                    placed.push_back({from, to, static_cast<ImWchar>(glyph->Codepoint)});
                const bool sideways = from.x < clip.x - slip || to.x > clip.z + slip || low.x > glyph->U0 + cut_uv ||
                                      high.x < glyph->U1 - cut_uv;
                const bool upright = from.y < clip.y - slip || to.y > clip.w + slip || low.y > glyph->V0 + cut_uv ||
                                     high.y < glyph->V1 - cut_uv;
                if (sideways || (upright && !scrolled)) cut.letters += utf8(static_cast<ImWchar>(glyph->Codepoint));
                i += 6;
            }
        }
        cut.letters += letters_on_others(std::move(placed));
        if (!cut.letters.empty()) cuts.push_back(cut);
    }
    return cuts;
}

// A system with names of 25 letters.
const char* const long_names =
    R"toml(title = "A ball with names of twenty-five letters and a long title that may not fit"
[[coordinate]]
name = "horizontal_displacement_x"
rate = 0.7
unit = "m"
[[coordinate]]
name = "vertical_displacement_of_"
start = 1.0
unit = "m"
[[coordinate]]
name = "angular_displacement_of_b"
start = 0.5
rate = 0.2
unit = "rad"
[[parameter]]
name = "gravitational_acceleratio"
value = 9.81
unit = "m/s^2"
[lagrangian]
kinetic = "1/2*(horizontal_displacement_x'^2 + vertical_displacement_of_'^2 + angular_displacement_of_b'^2)"
potential = "gravitational_acceleratio*vertical_displacement_of_ + angular_displacement_of_b^2"
[[constraint]]
name = "the_floor_under_everythin"
gap = "vertical_displacement_of_"
restitution = 0.6
[[constraint]]
name = "the_wall_at_the_far_right"
gap = "2 - horizontal_displacement_x"
restitution = 0.3
[run]
end_time = 5
)toml";
// A system with a world as large as a planet.
std::string large_world() {
    std::string text = R"toml(title = "A ball around a planet"
[[coordinate]]
name = "x"
rate = 1e9
unit = "m"
[[coordinate]]
name = "y"
start = 1e9
unit = "m"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "9.81e9*y"
[[constraint]]
gap = "y"
restitution = 0.6
[run]
end_time = 3
)toml";
    return text;
}

struct State {
    const char* name;
    const char* system;
    std::vector<const char*> journal;
};

const State states[] = {
    {"as it opens", "ball_on_sine", {}},
    {"a certificate", "ball_on_sine", {"select 12", "set g 2"}},
    {"an impact", "double_pendulum", {"select 3"}},
    {"a release", "ball_on_sine", {"select 13"}},
    {"the lens", "ball_on_sine", {"show lens", "select 12"}},
    {"long names", "long", {}},
    {"long names and an impact", "long", {"select 5"}},
    {"long names compared", "long", {"pin", "set gravitational_acceleratio 5"}},
    {"a large world", "large", {"seek 2.5"}},
    {"many sliders", "triple_pendulum", {"seek 1.5", "set g 3"}},
    {"the editor", "double_pendulum", {"show editor", "seek 2"}},
    {"the editor and a certificate", "ball_on_sine", {"show editor", "select 12"}},
    {"mistakes in the editor", "ball_on_sine", {"show editor", "text \"title = 3\\nx = 4\""}},
    {"a value refused", "ball_on_sine", {"set y -5", "set e 7"}},
    {"a run compared", "ball_on_sine", {"pin", "set e 0.4", "seek 5"}},
    {"six runs compared",
     "double_pendulum",
     {"pin", "set e 0.4", "pin", "set theta1 0.3", "pin", "set g 3", "pin", "eps 1e-3", "pin", "set e 0.7", "pin",
      "set e 0.2", "difference 2 on", "pinned 3 off", "seek 5"}},
    {"long names of runs",
     "long",
     {"pin", "set gravitational_acceleratio 5", "pin", "set gravitational_acceleratio 7"}},
    {"a difference to nothing", "ball_on_sine", {"difference 1 on"}},
    {"six plots", "double_pendulum", {"grid 3 2", "plot 1 t theta1 theta2 gap", "seek 5"}},
    {"nine plots", "ball_on_sine", {"grid 3 3", "seek 5"}},
    {"the picture alone", "swinging_leg", {"hide plots", "hide events", "hide controls"}},
    {"wide controls", "falling_rod", {"size controls 0.6", "seek 1"}},
    {"narrow panels", "ball_on_table", {"size controls 0.01", "size plots 0.9", "size events 0.01"}},
    {"the plane", "triple_pendulum", {"show plane", "show accuracy", "seek 2"}},
    {"contours in the plane", "double_pendulum_two_stops", {"show plane", "show contours", "seek 3"}},
    {"three walls in the plane", "ball_in_sloped_box", {"show plane", "show contours", "hide plots", "seek 3"}},
    {"a phase plane", "ball_on_vibrating_table", {"plane y y'", "show contours", "hide plots", "seek 1.3"}},
    {"a plane of expressions",
     "double_pendulum",
     {"plane \"L1*sin(theta1) + L2*sin(theta1 + theta2)\" \"-L1*cos(theta1) - L2*cos(theta1 + theta2)\"", "seek 3"}},
    {"long names in the plane", "long", {"show plane", "show contours"}},
    {"a certificate of angles", "double_pendulum", {"select 11", "pin"}},
    {"to a class", "ball_on_sine", {"present on", "seek 3"}},
    {"a contact to a class", "double_pendulum", {"present on", "select 11"}},
    {"a caption to a class", "double_pendulum", {"present on", "say \"The knee locks, and opens at the vertical.\""}},
    {"the energy", "ball_on_sine", {"show energy", "seek 3"}},
    {"the energy of long names", "long", {"show energy", "seek 3"}},
    {"the energy to a class", "driven_double_pendulum", {"show energy", "present on", "seek 9"}},
    {"dozens of results", "driven_double_pendulum", {"end 60", "seek 31"}},
    {"a tour about the results", "driven_double_pendulum", {"say \"What came out.\"", "highlight results", "seek 7"}},
    {"all that differs",
     "triple_pendulum",
     {"show accuracy", "set g 3", "eps 1e-3 1e-4 1e-5", "method dopri5", "memory 2e8"}},
    {"the help", "ball_on_sine", {"show help"}},
    {"all commands", "ball_on_sine", {"show palette"}},
    {"taking away", "ball_on_sine", {"show export"}},
    {"the gallery", "ball_on_sine", {"show gallery"}},
    {"a long usage", "ball_on_sine", {"find \"export\""}},
    {"no command", "ball_on_sine", {"find \"qqq\""}},
    {"systems to open", "ball_on_sine", {"find \"open \""}},
    {"equations", "double_pendulum", {"show equations", "seek 4.5"}},
    {"equations of several contacts", "double_pendulum_two_stops", {"show equations"}},
    {"equations of long names", "long", {"show equations"}},
    {"equations in a narrow place", "ball_on_table", {"show equations", "show editor", "size editor 0.6"}},
    {"close to a Zeno point", "ball_on_sine", {"camera zeno", "seek 2.72", "show strobe"}},
    {"with the body", "double_pendulum_two_stops", {"camera follow", "seek 2", "show strobe"}},
    {"two sides", "ball_on_egg_crate", {"show sides", "seek 1"}},
    {"two sides narrow", "ball_on_egg_crate", {"show sides", "size controls 0.6"}},
    {"a run that stops early", "ball_on_sine", {"set e 1", "end 3000", "set g 15"}},
    {"what it depends on", "double_pendulum", {"depend \"zeno_time(3)\""}},
    {"a sweep", "ball_on_sine", {"sweep \"--over e=0:0.9:16 --print zeno_time(1)\""}},
    {"a periodic run", "ball_down_a_wave", {"orbit \"\"", "branch 1"}},
    {"no periodic run", "ball_on_floor", {"orbit \"\""}},
    {"a branch", "ball_down_a_wave", {"set e 0.3", "orbit \"--continue b=0.05:0.08\"", "branch 9"}},
    {"a branch beside the editor", "driven_double_pendulum", {"show editor", "orbit \"--continue e=0.6:0.8\""}},
};

class Clipping : public testing::TestWithParam<std::tuple<int, int, double>> {};

TEST_P(Clipping, CutsNoLetter) {
    const auto [width, height, scale] = GetParam();
    Interface interface(test::surface(width, height, scale));
    const Interface::Active active(interface);
    for (const State& state : states) {
        const bool is_own = std::string(state.system) == "long" || std::string(state.system) == "large";
        Session session = test::session(is_own ? "ball_on_sine" : state.system);
        if (is_own) session.apply(command::SetText{state.system[1] == 'o' ? long_names : large_world()});
        ASSERT_TRUE(session.document().problems.empty());
        for (const char* line : state.journal) session.apply(parse_command(line));
        interface.restyle(scale * session.scene().text_scale(width / scale, height / scale), false);
        for (const char* theme : {"theme light", "theme dark"}) {
            session.apply(parse_command(theme));
            // Apply only up to this command: its error message must be visible.
            for (const char* line : state.journal)
                if (std::string(line).find("set y -5") == 0) session.apply(parse_command(line));
            PanelState panels = test::panels();
            const ImDrawData* data = nullptr;
            for (int i = 0; i < 3; ++i) {
                apply(Input{});
                data = &interface.frame([&] { explorer(session, panels); }, width, height, 1.0 / 60.0);
            }
            for (const ClippedText& cut : cut_letters(*data))
                ADD_FAILURE() << state.name << ", " << theme << ": in '" << cut.window << "' \"" << cut.letters << "\"";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Clipping,
                         testing::Values(std::tuple(800, 600, 1.0), std::tuple(1024, 700, 1.0),
                                         std::tuple(1280, 800, 1.0), std::tuple(1600, 1000, 1.0),
                                         std::tuple(2560, 1600, 2.0), std::tuple(1600, 1000, 1.5)));

// Tests the test: text that is too long for its window is found, horizontally and vertically; text that fits is not.
TEST(Clipping, FindsWhatIsCut) {
    Interface interface(test::surface(400, 300));
    const Interface::Active active(interface);
    const auto letters = [&](float width, float height, const char* text) {
        const ImDrawData* data = nullptr;
        for (int i = 0; i < 3; ++i) {
            apply(Input{});
            data = &interface.frame(
                [&] {
                    ImGui::SetNextWindowPos({0.0F, 0.0F});
                    ImGui::SetNextWindowSize({width, height});
                    ImGui::Begin("one", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoScrollWithMouse);
                    ImGui::TextUnformatted(text);
                    ImGui::End();
                },
                400, 300, 1.0 / 60.0);
        }
        std::string all;
        for (const ClippedText& cut : cut_letters(*data)) all += cut.letters;
        return all;
    };
    EXPECT_EQ(letters(300.0F, 100.0F, "it fits"), "");
    EXPECT_NE(letters(60.0F, 100.0F, "too wide for it"), "");
    EXPECT_NE(letters(300.0F, 32.0F, "too low\nfor it"), "");
    const LetterBox one{{10, 10}, {18, 20}, 'a'};
    EXPECT_EQ(letters_on_others({one, {{16, 10}, {24, 20}, 'b'}, {{10, 5}, {18, 8}, '.'}}), "");
    EXPECT_EQ(letters_on_others({one, {{12, 12}, {20, 22}, 'b'}}), "ab ");
}

}  // namespace
}  // namespace achilles
