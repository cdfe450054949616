#include "surface/interface.hpp"

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <set>
#include <stdexcept>

#include "figure/label.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

// Characters of labels: Latin, combining dots, Greek, punctuation, superscripts and subscripts, arrows, mathematics,
// play and pause symbols. Static, because ImGui reads it while it builds the fonts.
constexpr ImWchar glyphs[] = {0x0020, 0x017F, 0x02D9, 0x02D9, 0x0300, 0x0308, 0x0370, 0x03FF, 0x2010,
                              0x206F, 0x2070, 0x209C, 0x2102, 0x2135, 0x2190, 0x21FF, 0x2200, 0x22FF,
                              0x25A0, 0x25FF, 0x2758, 0x275E, 0x27E8, 0x27E9, 0xFFFD, 0xFFFD, 0};

constexpr const char* proportional = "DejaVuSans.ttf";
constexpr const char* monospaced = "DejaVuSansMono.ttf";

ImVec4 mixed(const Color& color, const Color& with, float share) {
    const auto part = [share](std::uint8_t a, std::uint8_t b) {
        return (static_cast<float>(a) + share * (static_cast<float>(b) - static_cast<float>(a))) / 255.0F;
    };
    return {part(color.r, with.r), part(color.g, with.g), part(color.b, with.b), 1.0F};
}

// A single accent color on the grays of the theme: controls under the mouse are blended toward it.
void colors(ImGuiStyle& style, const Theme& theme) {
    if (theme.dark)
        ImGui::StyleColorsDark(&style);
    else
        ImGui::StyleColorsLight(&style);
    const auto plain = [](const Color& color) { return mixed(color, color, 0.0F); };
    const auto touched = [&theme](float share) { return mixed(theme.frame, theme.accent, share); };
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = plain(theme.ink);
    c[ImGuiCol_TextDisabled] = plain(theme.faint);
    c[ImGuiCol_WindowBg] = c[ImGuiCol_MenuBarBg] = plain(theme.page);
    c[ImGuiCol_PopupBg] = plain(theme.background);
    c[ImGuiCol_Border] = c[ImGuiCol_Separator] = plain(theme.border);
    c[ImGuiCol_FrameBg] = plain(theme.frame);
    c[ImGuiCol_FrameBgHovered] = touched(0.12F);
    c[ImGuiCol_FrameBgActive] = touched(0.24F);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgCollapsed] = c[ImGuiCol_TitleBgActive] = plain(theme.frame);
    c[ImGuiCol_CheckMark] = c[ImGuiCol_SliderGrab] = plain(theme.accent);
    c[ImGuiCol_SliderGrabActive] = mixed(theme.accent, theme.ink, 0.3F);
    c[ImGuiCol_Button] = plain(theme.frame);
    c[ImGuiCol_ButtonHovered] = touched(0.2F);
    c[ImGuiCol_ButtonActive] = touched(0.36F);
    c[ImGuiCol_Header] = plain(theme.selected);
    c[ImGuiCol_HeaderHovered] = mixed(theme.selected, theme.accent, 0.08F);
    c[ImGuiCol_HeaderActive] = mixed(theme.selected, theme.accent, 0.16F);
    c[ImGuiCol_ScrollbarBg] = {0.0F, 0.0F, 0.0F, 0.0F};
    c[ImGuiCol_ScrollbarGrab] = plain(theme.border);
    c[ImGuiCol_ScrollbarGrabHovered] = mixed(theme.border, theme.ink, 0.25F);
    c[ImGuiCol_ScrollbarGrabActive] = mixed(theme.border, theme.ink, 0.4F);
    c[ImGuiCol_TextSelectedBg] = touched(0.34F);
}

void shape(ImGuiStyle& style) {
    style.WindowRounding = style.ChildRounding = 0.0F;  // panels tile the window
    style.FrameRounding = style.GrabRounding = style.PopupRounding = style.TabRounding = 4.0F;
    style.ScrollbarRounding = 6.0F;
    style.GrabMinSize = 10.0F;  // ImGui's own value is 12 since 1.88
    style.WindowBorderSize = 1.0F;
    style.FramePadding = {8.0F, 4.0F};
    style.ItemSpacing = {8.0F, 6.0F};
    style.WindowPadding = {10.0F, 10.0F};
}

}  // namespace

Interface::Interface(const SurfaceOptions& options) : options_(options) {
    // ImGui aborts if a font is missing.
    for (const char* name : {proportional, monospaced})
        if (const auto file = options.fonts / name; !std::filesystem::is_regular_file(file))
            throw std::runtime_error(file.string() + ": the font is missing; install the package fonts-dejavu-core");
    if (!(options.scale >= 0.1 && options.scale <= 20.0)) throw std::runtime_error("the scale must be 0.1 to 20");
    IMGUI_CHECKVERSION();
    ImGuiContext* before = ImGui::GetCurrentContext();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(before);
    const Active active(*this);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // nothing is stored between runs
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.ConfigInputTextCursorBlink = false;  // a window with an active text field can sleep
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    prepare_keys(io);
    restyle(options.scale, options.dark);
}

Interface::~Interface() { ImGui::DestroyContext(context_); }

Interface::Active::Active(const Interface& interface) : before_(ImGui::GetCurrentContext()) {
    ImGui::SetCurrentContext(interface.context_);
}

Interface::Active::~Active() { ImGui::SetCurrentContext(before_); }

void Interface::restyle(double scale, bool dark) {
    const Active active(*this);
    build_fonts(scale);
    ImGuiStyle style;  // from the defaults, because scaling twice would round twice
    shape(style);
    style.ScaleAllSizes(static_cast<float>(scale));
    ImGui::GetStyle() = style;
    use_theme(dark);
}

void Interface::build_fonts(double scale) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    const auto add = [&](const char* name, double pixels) {
        ImFontConfig config;
        config.OversampleH = config.OversampleV = 1;  // letters are at whole pixels
        config.PixelSnapH = true;
        const std::string file = (options_.fonts / name).string();
        atlas.AddFontFromFileTTF(file.c_str(), static_cast<float>(pixels), &config, glyphs);
    };
    // The first font is the default font of the interface.
    std::vector<double> sizes;
    for (const double size :
         {options_.text_size, options_.figure_text_size, options_.figure_text_size * double{script_size}}) {
        const double pixels = std::max(std::round(size * scale), 4.0);
        if (std::find(sizes.begin(), sizes.end(), pixels) == sizes.end()) sizes.push_back(pixels);
    }
    for (const double pixels : sizes) add(proportional, pixels);
    add(monospaced, std::max(std::round(0.9 * options_.text_size * scale), 4.0));  // the last font: monospace_font()
    font_texture(atlas);  // letters are also measured where no canvas draws them
}

const ImDrawData& Interface::frame(const FrameFunction& draw, int width, int height, double seconds) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DeltaTime = static_cast<float>(seconds);
    ImGui::NewFrame();
    draw();
    ImGui::Render();
    const ImVec4& color = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
    std::copy_n(&color.x, 3, background_);
    return *ImGui::GetDrawData();
}

void use_theme(bool dark) {
    static Theme themes[] = {light_theme(), dark_theme()};
    ImGui::GetIO().UserData = &themes[dark ? 1 : 0];
    colors(ImGui::GetStyle(), themes[dark ? 1 : 0]);
}

const Theme& current_theme() { return *static_cast<const Theme*>(ImGui::GetIO().UserData); }

void apply(const Input& input) {
    ImGuiIO& io = ImGui::GetIO();
    const bool away = input.mouse_x <= -1e5 || input.mouse_y <= -1e5;
    io.MousePos = away ? ImVec2(-FLT_MAX, -FLT_MAX)
                       : ImVec2(static_cast<float>(input.mouse_x), static_cast<float>(input.mouse_y));
    io.MouseDown[ImGuiMouseButton_Left] = input.left;
    io.MouseDown[ImGuiMouseButton_Right] = input.right;
    io.MouseDown[ImGuiMouseButton_Middle] = input.middle;
    io.MouseWheel = static_cast<float>(input.wheel);
    io.MouseWheelH = static_cast<float>(input.wheel_sideways);
    hold_keys(io, input.keys);
    if (!input.text.empty()) io.AddInputCharactersUTF8(input.text.c_str());
}

ImFont* font_for(double pixels) {
    ImFont* best = ImGui::GetIO().Fonts->Fonts.front();
    const auto distance = [pixels](const ImFont* font) { return std::abs(double{size_of(font)} - pixels); };
    for (ImFont* font : ImGui::GetIO().Fonts->Fonts)
        if (font != monospace_font() && distance(font) < distance(best)) best = font;
    return best;
}

ImFont* monospace_font() { return ImGui::GetIO().Fonts->Fonts.back(); }

}  // namespace achilles
