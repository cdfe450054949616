// Long work on a page, which has one thread: one piece of work after the other, between frames. While a piece runs, the
// page neither draws nor takes input, so a piece that takes too long is given up.
//
// All work that takes long polls a std::stop_token, the one in web/standard. There it meets the end of its time.
#pragma once

#include <functional>

namespace achilles {

// A piece of work is given up after this time, s.
constexpr double longest_work = 10.0;
// No piece begins later in a frame than this, s, unless something waits for it.
constexpr double frame_budget = 0.012;

void begin_frame();
// Whether the frame still has time for work that nothing waits for.
bool frame_has_time();

// Does a piece of work with limited time. Throws InputError if the work has thrown WorkTooLong.
void do_page_work(const std::function<void()>& work);

// Pieces of work that wait to be done; while there are some, frames must continue.
class WaitingWork {
 public:
    WaitingWork();
    ~WaitingWork();
    WaitingWork(const WaitingWork&) = delete;
    WaitingWork& operator=(const WaitingWork&) = delete;
    static bool exists();
};

}  // namespace achilles
