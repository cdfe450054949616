// What undo takes back: the moments before each change. A drag's many commands are one change.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "session/command.hpp"

namespace achilles {

template <class Moment>
class History {
 public:
    bool can_undo() const { return !undone_to_.empty(); }
    bool can_redo() const { return !redone_to_.empty(); }

    // A command has been done, which led from one moment to another. What changed nothing, or in the end brought back
    // what was there, is nothing to undo.
    void remember(const Command& command, const Moment& before, const Moment& now) {
        constexpr std::size_t most = 200;
        if (change_of(command) < command::Change::alone) {
            // Something else was done in between: the next change is one of its own. (Seeking is part of dragging.)
            if (!std::holds_alternative<command::Seek>(command)) changed_by_.reset();
            return;
        }
        if (now == before) return;
        if (!changed_by_ || !goes_on(*changed_by_, command)) undone_to_.push_back(before);
        if (undone_to_.size() > most) undone_to_.erase(undone_to_.begin());
        redone_to_.clear();
        changed_by_ = command;
        if (undone_to_.back() != now) return;
        undone_to_.pop_back();
        changed_by_.reset();
    }

    // The moment to go to, from the present one. There must be one.
    Moment undo(Moment now) { return go(undone_to_, redone_to_, std::move(now)); }
    Moment redo(Moment now) { return go(redone_to_, undone_to_, std::move(now)); }

 private:
    Moment go(std::vector<Moment>& from, std::vector<Moment>& to, Moment now) {
        to.push_back(std::move(now));
        Moment back = std::move(from.back());
        from.pop_back();
        changed_by_.reset();
        return back;
    }

    std::vector<Moment> undone_to_, redone_to_;
    std::optional<Command> changed_by_;  // the last change, which more of its kind go on with
};

}  // namespace achilles
