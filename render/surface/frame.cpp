#include "surface/frame.hpp"

#include <algorithm>

namespace achilles {

namespace {

constexpr double away = -1e6;  // see Input

void append_utf8(std::string& text, unsigned c) {
    const auto put = [&text](unsigned byte) { text.push_back(static_cast<char>(byte)); };
    if (c < 0x80) {
        put(c);
    } else if (c < 0x800) {
        put(0xC0 | (c >> 6));
        put(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
        put(0xE0 | (c >> 12));
        put(0x80 | ((c >> 6) & 0x3F));
        put(0x80 | (c & 0x3F));
    } else if (c < 0x110000) {
        put(0xF0 | (c >> 18));
        put(0x80 | ((c >> 12) & 0x3F));
        put(0x80 | ((c >> 6) & 0x3F));
        put(0x80 | (c & 0x3F));
    }
}

}  // namespace

void Events::mouse_at(double x, double y) { waiting_.push_back({InputEvent::Kind::mouse, 0, false, x, y}); }
void Events::mouse_left() { mouse_at(away, away); }
void Events::button(int number, bool down) { waiting_.push_back({InputEvent::Kind::button, number, down}); }
void Events::wheel(double sideways, double clicks) {
    waiting_.push_back({InputEvent::Kind::wheel, 0, false, sideways, clicks});
}
void Events::key(int code, bool down) { waiting_.push_back({InputEvent::Kind::key, code, down}); }
void Events::character(unsigned code_point) {
    waiting_.push_back({InputEvent::Kind::character, static_cast<int>(code_point)});
}

void Events::release_all() {
    for (const int code : held_.keys) key(code, false);
    for (const int number : {0, 1, 2}) button(number, false);
}

bool Events::are_moves() const {
    return std::all_of(waiting_.begin(), waiting_.end(),
                       [](const InputEvent& event) { return event.kind == InputEvent::Kind::mouse; });
}

// Whether a key only matters through its character.
bool Events::is_letter(const InputEvent& event) const {
    const auto is_held = [this](int code) {
        return std::find(held_.keys.begin(), held_.keys.end(), code) != held_.keys.end();
    };
    for (const int code :
         {key::left_control, key::right_control, key::left_alt, key::right_alt, key::left_super, key::right_super})
        if (is_held(code)) return false;
    return event.code < 256 || event.code == key::left_shift || event.code == key::right_shift;
}

Input Events::next(bool is_typing) {
    held_.wheel = held_.wheel_sideways = 0.0;
    held_.text.clear();
    bool clicked = false, pressed = false;
    for (; !waiting_.empty(); waiting_.pop_front()) {
        const InputEvent& event = waiting_.front();
        const bool is_button = event.kind == InputEvent::Kind::button, is_key = event.kind == InputEvent::Kind::key;
        // In a frame ImGui processes a move before a click. A move after a click must therefore wait for the next
        // frame, or it would drag; a click after a move hits the new position.
        if ((is_button || event.kind == InputEvent::Kind::mouse) && clicked) break;
        if (is_key && pressed) break;
        // In a text field characters come first. Keys that act on them wait, and characters wait for keys that came
        // before.
        const bool is_free = is_typing && is_key && is_letter(event);
        if (is_typing && (is_button || (is_key && !is_free)) && !held_.text.empty()) break;
        if (is_typing && event.kind == InputEvent::Kind::character && (pressed || clicked)) break;
        clicked = clicked || is_button;
        pressed = pressed || (is_key && !is_free);
        apply(event);
    }
    return held_;
}

void Events::apply(const InputEvent& event) {
    switch (event.kind) {
        case InputEvent::Kind::mouse:
            held_.mouse_x = event.x;
            held_.mouse_y = event.y;
            break;
        case InputEvent::Kind::button:
            if (event.code == 0) held_.left = event.down;
            if (event.code == 1) held_.right = event.down;
            if (event.code == 2) held_.middle = event.down;
            break;
        case InputEvent::Kind::wheel:
            held_.wheel_sideways += event.x;
            held_.wheel += event.y;
            break;
        case InputEvent::Kind::key:
            std::erase(held_.keys, event.code);
            if (event.down) held_.keys.push_back(event.code);
            break;
        case InputEvent::Kind::character:
            append_utf8(held_.text, static_cast<unsigned>(event.code));
            break;
    }
}

}  // namespace achilles
