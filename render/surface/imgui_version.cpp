#include "surface/imgui_version.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace achilles {

namespace {

#if IMGUI_VERSION_NUM < 18700
constexpr ImGuiKey_ keypad_enter = ImGuiKey_KeyPadEnter;
#else
constexpr ImGuiKey keypad_enter = ImGuiKey_KeypadEnter;
#endif

// The keys that ImGui's widgets use.
constexpr std::pair<decltype(keypad_enter), int> widget_keys[] = {{ImGuiKey_Tab, key::tab},
                                                                  {ImGuiKey_LeftArrow, key::left},
                                                                  {ImGuiKey_RightArrow, key::right},
                                                                  {ImGuiKey_UpArrow, key::up},
                                                                  {ImGuiKey_DownArrow, key::down},
                                                                  {ImGuiKey_PageUp, key::page_up},
                                                                  {ImGuiKey_PageDown, key::page_down},
                                                                  {ImGuiKey_Home, key::home},
                                                                  {ImGuiKey_End, key::end},
                                                                  {ImGuiKey_Insert, key::insert},
                                                                  {ImGuiKey_Delete, key::remove},
                                                                  {ImGuiKey_Backspace, key::backspace},
                                                                  {ImGuiKey_Space, ' '},
                                                                  {ImGuiKey_Enter, key::enter},
                                                                  {ImGuiKey_Escape, key::escape},
                                                                  {keypad_enter, key::keypad_enter},
                                                                  {ImGuiKey_A, 'A'},
                                                                  {ImGuiKey_C, 'C'},
                                                                  {ImGuiKey_V, 'V'},
                                                                  {ImGuiKey_X, 'X'},
                                                                  {ImGuiKey_Y, 'Y'},
                                                                  {ImGuiKey_Z, 'Z'}};

// ImGui's characters have 16 bits.
ImWchar letter_of(char32_t code) { return static_cast<ImWchar>(code <= 0xFFFF ? code : 0xFFFD); }

}  // namespace

#if IMGUI_VERSION_NUM < 18700

void prepare_keys(ImGuiIO& io) {
    for (const auto& [name, code] : widget_keys) io.KeyMap[name] = code;
}

void hold_keys(ImGuiIO& io, const std::vector<int>& codes) {
    std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
    for (const int code : codes)
        if (code >= 0 && code < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[code] = true;
    io.KeyCtrl = io.KeysDown[key::left_control] || io.KeysDown[key::right_control];
    io.KeyShift = io.KeysDown[key::left_shift] || io.KeysDown[key::right_shift];
    io.KeyAlt = io.KeysDown[key::left_alt] || io.KeysDown[key::right_alt];
    io.KeySuper = io.KeysDown[key::left_super] || io.KeysDown[key::right_super];
}

bool is_pressed(int code, bool repeat) { return ImGui::IsKeyPressed(code, repeat); }

float& time_held(int code) { return ImGui::GetIO().KeysDownDuration[code]; }

#else

namespace {

constexpr int first_code = ' ', last_code = key::right_super;

ImGuiKey name_of(int code) {
    if (code >= 'A' && code <= 'Z') return static_cast<ImGuiKey>(ImGuiKey_A + (code - 'A'));
    if (code >= '0' && code <= '9') return static_cast<ImGuiKey>(ImGuiKey_0 + (code - '0'));
    if (code == '=' || code == '-') return code == '=' ? ImGuiKey_Equal : ImGuiKey_Minus;
    if (code >= key::f1 && code < key::f1 + 12) return static_cast<ImGuiKey>(ImGuiKey_F1 + (code - key::f1));
    for (const auto& [name, known] : widget_keys)
        if (known == code) return name;
    return ImGuiKey_None;
}

}  // namespace

// ImGui must process all events of a frame at once, because Events has already separated those that conflict.
void prepare_keys(ImGuiIO& io) { io.ConfigInputTrickleEventQueue = false; }

void hold_keys(ImGuiIO& io, const std::vector<int>& codes) {
    const auto held = [&codes](int code) { return std::find(codes.begin(), codes.end(), code) != codes.end(); };
    io.AddKeyEvent(ImGuiMod_Ctrl, held(key::left_control) || held(key::right_control));
    io.AddKeyEvent(ImGuiMod_Shift, held(key::left_shift) || held(key::right_shift));
    io.AddKeyEvent(ImGuiMod_Alt, held(key::left_alt) || held(key::right_alt));
    io.AddKeyEvent(ImGuiMod_Super, held(key::left_super) || held(key::right_super));
    for (int code = first_code; code <= last_code; ++code)
        if (const ImGuiKey name = name_of(code); name != ImGuiKey_None) io.AddKeyEvent(name, held(code));
}

bool is_pressed(int code, bool repeat) {
    const ImGuiKey name = name_of(code);
    return name != ImGuiKey_None && ImGui::IsKeyPressed(name, repeat);
}

float& time_held(int code) { return ImGui::GetKeyData(name_of(code))->DownDuration; }

#endif

#if IMGUI_VERSION_NUM < 19200

void use_clipboard(Clipboard& clipboard) {
    ImGuiIO& io = ImGui::GetIO();
    io.ClipboardUserData = clipboard.owner;
    io.GetClipboardTextFn = clipboard.get;
    io.SetClipboardTextFn = clipboard.set;
}

FontTexture font_texture(ImFontAtlas& atlas) {
    unsigned char* pixels = nullptr;
    FontTexture texture{};
    atlas.GetTexDataAsRGBA32(&pixels, &texture.width, &texture.height);
    texture.rgba = pixels;
    return texture;
}

void name_font_texture(ImFontAtlas& atlas, unsigned name) {
    atlas.SetTexID(reinterpret_cast<ImTextureID>(std::uintptr_t{name}));
}

unsigned texture_of(const ImDrawCmd& command) {
    return static_cast<unsigned>(reinterpret_cast<std::uintptr_t>(command.GetTexID()));
}

void push_font_texture(ImDrawList* list) { list->PushTextureID(ImGui::GetIO().Fonts->TexID); }

void pop_font_texture(ImDrawList* list) { list->PopTextureID(); }

float size_of(const ImFont* font) { return font->FontSize; }

float ascent_of(ImFont* font) { return font->Ascent; }

const ImFontGlyph& glyph_of(ImFont* font, char32_t code) { return *font->FindGlyph(letter_of(code)); }

const ImVector<ImFontGlyph>& glyphs_of(ImFont* font) { return font->Glyphs; }

void push_font(ImFont* font) { ImGui::PushFont(font); }

float content_right() { return ImGui::GetContentRegionMax().x; }

bool is_behind_dialog() {
    ImGuiWindow* dialog = ImGui::GetTopMostPopupModal();
    return dialog != nullptr && !ImGui::IsWindowWithinBeginStackOf(ImGui::GetCurrentWindowRead(), dialog);
}

float scrolled_sideways(const ImGuiInputTextState& input) { return input.ScrollX; }

int line_of_cursor(const ImGuiInputTextState& input, const std::string&) {
    const ImWchar* begin = input.TextW.Data;
    return 1 + static_cast<int>(std::count(begin, begin + std::min(input.Stb.cursor, input.CurLenW), ImWchar{'\n'}));
}

#else

namespace {

// The glyphs at the size with which the font was added; there are no other sizes.
ImFontBaked& letters_of(ImFont* font) { return *font->GetFontBaked(font->LegacySize); }

Clipboard& used_clipboard() { return *static_cast<Clipboard*>(ImGui::GetPlatformIO().Platform_ClipboardUserData); }

}  // namespace

void use_clipboard(Clipboard& clipboard) {
    ImGuiPlatformIO& io = ImGui::GetPlatformIO();
    io.Platform_ClipboardUserData = &clipboard;
    io.Platform_GetClipboardTextFn = [](ImGuiContext*) { return used_clipboard().get(used_clipboard().owner); };
    io.Platform_SetClipboardTextFn = [](ImGuiContext*, const char* text) {
        used_clipboard().set(used_clipboard().owner, text);
    };
}

// Uses the functions underneath those that 1.92 declares obsolete and that may be disabled.
FontTexture font_texture(ImFontAtlas& atlas) {
    if (!atlas.TexIsBuilt) ImFontAtlasBuildMain(&atlas);
    const ImTextureData& data = *atlas.TexData;  // 32 bits per pixel by default
    return {data.Pixels, data.Width, data.Height};
}

void name_font_texture(ImFontAtlas& atlas, unsigned name) { atlas.TexData->SetTexID(static_cast<ImTextureID>(name)); }

unsigned texture_of(const ImDrawCmd& command) { return static_cast<unsigned>(command.GetTexID()); }

void push_font_texture(ImDrawList* list) { list->PushTexture(ImGui::GetIO().Fonts->TexRef); }

void pop_font_texture(ImDrawList* list) { list->PopTexture(); }

float size_of(const ImFont* font) { return font->LegacySize; }

float ascent_of(ImFont* font) { return letters_of(font).Ascent; }

const ImFontGlyph& glyph_of(ImFont* font, char32_t code) { return *letters_of(font).FindGlyph(letter_of(code)); }

const ImVector<ImFontGlyph>& glyphs_of(ImFont* font) { return letters_of(font).Glyphs; }

void push_font(ImFont* font) { ImGui::PushFont(font, font->LegacySize); }

float content_right() {
    return ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x - ImGui::GetWindowPos().x;
}

float scrolled_sideways(const ImGuiInputTextState& input) { return input.Scroll.x; }

int line_of_cursor(const ImGuiInputTextState& input, const std::string& text) {
    const auto before = std::min(static_cast<std::size_t>(std::max(input.GetCursorPos(), 0)), text.size());
    return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(before), '\n'));
}

#endif

#if IMGUI_VERSION_NUM < 19280

void stroke(ImDrawList* list, const std::vector<ImVec2>& points, bool closed, unsigned color, float width) {
    list->AddPolyline(points.data(), static_cast<int>(points.size()), color,
                      closed ? ImDrawFlags_Closed : ImDrawFlags_None, width);
}

void stroke_rectangle(ImDrawList* list, const ImVec2& low, const ImVec2& high, unsigned color, float rounding,
                      float width) {
    list->AddRect(low, high, color, rounding, ImDrawFlags_None, width);
}

#else

void stroke(ImDrawList* list, const std::vector<ImVec2>& points, bool closed, unsigned color, float width) {
    list->AddPolyline(points.data(), static_cast<int>(points.size()), color, width,
                      closed ? ImDrawFlags_Closed : ImDrawFlags_None);
}

void stroke_rectangle(ImDrawList* list, const ImVec2& low, const ImVec2& high, unsigned color, float rounding,
                      float width) {
    list->AddRect(low, high, color, rounding, width);
}

#endif

unsigned item_id() { return GImGui->LastItemData.ID; }

bool item_is_enabled() { return (GImGui->CurrentItemFlags & ImGuiItemFlags_Disabled) == 0; }

unsigned window_of_item() { return GImGui->CurrentWindow->RootWindow->ID; }

void scroll_to_item() {
    ImGuiWindow* window = GImGui->CurrentWindow;
    const ImRect& item = GImGui->LastItemData.Rect;
    if (item.Min.y < window->InnerRect.Min.y || item.Max.y > window->InnerRect.Max.y) ImGui::SetScrollHereY(0.5F);
}

void scroll_next_window(float y, float content_height) {
    ImGui::SetNextWindowContentSize({0.0F, content_height});
    ImGui::SetNextWindowScroll({-1.0F, y});
}

unsigned active_item() { return GImGui->ActiveId; }

void let_go_of_item() { ImGui::ClearActiveID(); }

void press_item(unsigned id, bool takes_letters) {
    GImGui->NavNextActivateId = id;
    GImGui->NavNextActivateFlags = takes_letters ? ImGuiActivateFlags_PreferInput : ImGuiActivateFlags_None;
}

bool awaits_frame() {
    const auto& windows = GImGui->Windows;
    const bool is_new = std::any_of(windows.begin(), windows.end(), [](const ImGuiWindow* window) {
        // A part of a window that is scrolled out of view is hidden, too.
        return window->Active && (window->Flags & ImGuiWindowFlags_ChildWindow) == 0 &&
               (window->Appearing || window->Hidden || window->HiddenFramesCanSkipItems > 0 ||
                window->HiddenFramesCannotSkipItems > 0);
    });
    return is_new || GImGui->NavNextActivateId != 0 || front_popup() == unseen_popup;
}

unsigned front_dialog() {
    const auto& open = GImGui->OpenPopupStack;
    if (open.Size == 0) return 0;
    const ImGuiWindow* front = open.back().Window;
    return front != nullptr && (front->Flags & ImGuiWindowFlags_Modal) != 0 ? front->ID : 0;
}

unsigned front_popup() {
    const auto& open = GImGui->OpenPopupStack;
    if (open.Size == 0) return 0;
    return open.back().Window == nullptr ? unseen_popup : open.back().Window->ID;
}

unsigned popup_of_window() {
    const ImGuiWindow* window = GImGui->CurrentWindow;
    while (window != nullptr && (window->Flags & ImGuiWindowFlags_Popup) == 0)
        window = window->ParentWindowInBeginStack;
    return window == nullptr ? 0 : window->ID;
}

void walk_menus_by_keys(bool walk) {
    int& flags = ImGui::GetIO().ConfigFlags;
    flags = walk ? flags | ImGuiConfigFlags_NavEnableKeyboard : flags & ~ImGuiConfigFlags_NavEnableKeyboard;
#if IMGUI_VERSION_NUM < 18900
    // These versions activate items with Space only.
    if (walk && GImGui->NavId != 0 && is_pressed(key::enter, false)) press_item(GImGui->NavId, false);
#endif
}

bool begin_padded_child(const char* name, const ImVec2& size) {
#if IMGUI_VERSION_NUM < 19000
    return ImGui::BeginChild(name, size, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
#else
    return ImGui::BeginChild(name, size, ImGuiChildFlags_AlwaysUseWindowPadding);
#endif
}

}  // namespace achilles
