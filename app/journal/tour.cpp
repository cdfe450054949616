#include "journal/tour.hpp"

#include <algorithm>
#include <iterator>

namespace achilles {

namespace {

bool says(const Command& command) {
    const auto* say = std::get_if<command::Say>(&command);
    return say != nullptr && !say->text.empty();
}

template <class Commands>
std::size_t sentences_in(const Commands& commands) {
    return static_cast<std::size_t>(std::count_if(commands.begin(), commands.end(), says));
}

bool may_be_done_again(const Command& command) {
    return !std::holds_alternative<command::Save>(command) && !std::holds_alternative<command::Export>(command) &&
           !std::holds_alternative<command::Copy>(command) && !std::holds_alternative<command::Replay>(command);
}

}  // namespace

void Tour::keep(const Command& command) {
    const auto* wait = std::get_if<command::Wait>(&command);
    auto* const last = done_.empty() ? nullptr : std::get_if<command::Wait>(&done_.back());
    if (wait != nullptr && last != nullptr)
        last->seconds += wait->seconds;
    else
        done_.push_back(command);
}

std::vector<Command> Tour::advance(double seconds) {
    std::vector<Command> due;
    while (!left_.empty()) {
        auto* const wait = std::get_if<command::Wait>(&left_.front());
        if (wait == nullptr) {
            due.push_back(left_.front());
            keep(left_.front());
            left_.pop_front();
            if (std::holds_alternative<command::Replay>(due.back())) break;  // what it holds comes first
            continue;
        }
        const double passed = std::min(wait->seconds, seconds);
        if (passed > 0.0) keep(due.emplace_back(command::Wait{passed}));
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
    keep(rest);
    left_.pop_front();
    return {rest};
}

std::size_t Tour::said() const { return sentences_in(done_); }
std::size_t Tour::sentences() const { return said() + sentences_in(left_); }

void Tour::begin(const std::vector<Command>& journal) {
    const bool is_named = !done_.empty() && std::holds_alternative<command::Replay>(done_.back());
    if (is_named)
        done_.pop_back();
    else if (left_.empty())
        done_.clear();  // of another tour, which has come to its end
    left_.insert(left_.begin(), journal.begin(), journal.end());
}

std::vector<Command> Tour::back() {
    const std::size_t now = said();
    if (now < 2) return {};
    auto from = done_.begin();
    for (std::size_t count = 0; from != done_.end(); ++from)
        if (says(*from) && ++count == now - 1) break;
    // A wait of which a part has passed is whole again.
    auto* const rest = left_.empty() ? nullptr : std::get_if<command::Wait>(&left_.front());
    auto* const passed = std::get_if<command::Wait>(&done_.back());
    if (rest != nullptr && passed != nullptr) {
        passed->seconds += rest->seconds;
        left_.pop_front();
    }
    left_.insert(left_.begin(), from, done_.end());
    done_.erase(from, done_.end());
    std::vector<Command> again;
    std::copy_if(done_.begin(), done_.end(), std::back_inserter(again), may_be_done_again);
    return again;
}

}  // namespace achilles
