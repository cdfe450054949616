#include "journal/tour.hpp"

#include <algorithm>

namespace achilles {

std::vector<Command> Tour::advance(double seconds) {
    std::vector<Command> due;
    while (!left_.empty()) {
        auto* const wait = std::get_if<command::Wait>(&left_.front());
        if (wait == nullptr) {
            due.push_back(left_.front());
            left_.pop_front();
            if (std::holds_alternative<command::Replay>(due.back())) break;  // what it holds comes first
            continue;
        }
        const double passed = std::min(wait->seconds, seconds);
        if (passed > 0.0) due.emplace_back(command::Wait{passed});
        seconds -= passed;
        wait->seconds -= passed;
        if (wait->seconds > 0.0) break;
        left_.pop_front();
    }
    return due;
}

std::vector<Command> Tour::next() {
    if (left_.empty() || !std::holds_alternative<command::Wait>(left_.front())) return {};
    const Command rest = left_.front();
    left_.pop_front();
    return {rest};
}

}  // namespace achilles
