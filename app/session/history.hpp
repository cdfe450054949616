// Undo history: the states before each change. The many commands of one slider drag form one step.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "session/command.hpp"

namespace achilles {

template <class UndoState>
class History {
 public:
    bool can_undo() const { return !undone_to_.empty(); }
    bool can_redo() const { return !redone_to_.empty(); }

    // Records a command that led from state `before` to `now`. Commands without an effect are not recorded, and a step
    // is dropped again if later commands of it restore the original state.
    void remember(const Command& command, const UndoState& before, const UndoState& now) {
        constexpr std::size_t most = 200;
        if (undo_policy_of(command) < command::UndoPolicy::own_step) {
            // Any other command ends the merging of changes. Seek does not, since it is part of dragging.
            if (!std::holds_alternative<command::Seek>(command)) changed_by_.reset();
            return;
        }
        if (now == before) return;
        if (!changed_by_ || !continues_edit(*changed_by_, command)) undone_to_.push_back(before);
        if (undone_to_.size() > most) undone_to_.erase(undone_to_.begin());
        redone_to_.clear();
        changed_by_ = command;
        if (undone_to_.back() != now) return;
        undone_to_.pop_back();
        changed_by_.reset();
    }

    // Returns the state to go to; `now` is the current state. Requires can_undo() or can_redo().
    UndoState undo(UndoState now) { return go(undone_to_, redone_to_, std::move(now)); }
    UndoState redo(UndoState now) { return go(redone_to_, undone_to_, std::move(now)); }

 private:
    UndoState go(std::vector<UndoState>& from, std::vector<UndoState>& to, UndoState now) {
        to.push_back(std::move(now));
        UndoState back = std::move(from.back());
        from.pop_back();
        changed_by_.reset();
        return back;
    }

    std::vector<UndoState> undone_to_, redone_to_;
    std::optional<Command> changed_by_;  // the last change, which the next command may continue
};

}  // namespace achilles
