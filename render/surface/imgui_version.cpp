#include "surface/imgui_version.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <utility>

namespace achilles {

namespace {

#if IMGUI_VERSION_NUM < 18700
constexpr ImGuiKey_ keypad_enter = ImGuiKey_KeyPadEnter;
#else
constexpr ImGuiKey keypad_enter = ImGuiKey_KeypadEnter;
#endif

// The keys that ImGui's own widgets listen to.
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
    if (code >= key::f1 && code < key::f1 + 12) return static_cast<ImGuiKey>(ImGuiKey_F1 + (code - key::f1));
    for (const auto& [name, known] : widget_keys)
        if (known == code) return name;
    return ImGuiKey_None;
}

}  // namespace

// A frame takes all that it is told: what must not happen within one, Events has parted already.
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

}  // namespace achilles
