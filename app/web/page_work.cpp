#include "web/page_work.hpp"

#include <emscripten.h>
#include <fmt/format.h>

#include <exception>
#include <limits>
#include <stop_token>

#include "system/input_error.hpp"

namespace achilles {

namespace {

// Ends work whose time is over. Nothing else catches it.
struct WorkTooLong : std::exception {
    const char* what() const noexcept override { return "a piece of work took too long"; }
};

constexpr double never = std::numeric_limits<double>::infinity();
double frame_end = 0.0, work_end = never;  // ms
int waiting = 0;

// The end of the time of the work under way.
class Deadline {
 public:
    Deadline() { work_end = emscripten_get_now() + 1e3 * longest_work; }
    ~Deadline() { work_end = never; }
    Deadline(const Deadline&) = delete;
    Deadline& operator=(const Deadline&) = delete;
};

}  // namespace

void begin_frame() { frame_end = emscripten_get_now() + 1e3 * frame_budget; }

bool frame_has_time() { return emscripten_get_now() < frame_end; }

void check_page_work() {
    if (work_end != never && emscripten_get_now() > work_end) throw WorkTooLong();
}

void do_page_work(const std::function<void()>& work) {
    try {
        const Deadline deadline;
        work();
    } catch (const WorkTooLong&) {
        throw InputError({}, {},
                         fmt::format("this takes longer than {} s, for which a page does not wait", longest_work),
                         "use the window: achilles explore");
    }
}

WaitingWork::WaitingWork() { ++waiting; }
WaitingWork::~WaitingWork() { --waiting; }
bool WaitingWork::exists() { return waiting > 0; }

}  // namespace achilles
