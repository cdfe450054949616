// What the user's hands did, in order, handed to ImGui a frame at a time. ImGui 1.86 sees only the state at the start
// of a frame: a click or key shorter than a frame would be lost, so a second change of the same kind waits for the
// next.
#pragma once

#include <deque>
#include <string>

#include "surface/frame.hpp"

namespace achilles {

class Events {
 public:
    void mouse_at(double x, double y);
    void mouse_left();                   // left the window
    void button(int number, bool down);  // 0 left, 1 right, 2 middle
    void wheel(double sideways, double clicks);
    void key(int code, bool down);
    void character(unsigned code_point);
    // Nothing is held any more: the window lost the keyboard.
    void release_all();

    bool empty() const { return waiting_.empty(); }
    // The hand during the next frame. While somebody is typing, all the letters that have come are in it: a slow frame
    // must not fall behind the hand. Keys that do something else wait for the letters before them.
    Input next(bool is_typing = false);

 private:
    struct Event {
        enum class Kind { mouse, button, wheel, key, character };
        Kind kind;
        int code = 0;
        bool down = false;
        double x = 0.0, y = 0.0;
    };
    void apply(const Event& event);
    bool is_letter(const Event& event) const;

    std::deque<Event> waiting_;
    Input held_;
};

}  // namespace achilles
