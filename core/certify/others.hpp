// Whether the other contacts stay as they are while one bounces (theory-gaps.md 2.3).
#pragma once

#include <optional>
#include <vector>

#include "model/model.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// What the program of these neighbours proves, which has run. Nothing where one is not proved pressed, or open. Those that are
// known to need no force (theory-gaps.md 2.7), `unpressed`, need not be pressed.
std::optional<Certificate::Others> others_proved(const Neighbours& neighbours, const Evaluator<Interval>& program,
                                                 ContactSet unpressed);

// kappa of held contact i of these for the one that bounces, of a program that has run.
Interval transmission(const Neighbours& neighbours, const Evaluator<Interval>& program, std::size_t i);

class OthersStay {
 public:
    OthersStay(const Model& model, const Run& run, std::size_t contact, ContactSet held, ContactSet unpressed);

    // Over a box of the variables of Bouncing: proved where every held contact is pressed and impulses press it more, and every
    // other gap is open. Nothing where that is not proved.
    std::optional<Certificate::Others> prove(const std::vector<Interval>& box);
    // There is no other contact.
    bool is_alone() const { return !neighbours_; }

 private:
    ContactSet unpressed_;
    const Neighbours* neighbours_ = nullptr;
    std::vector<std::uint32_t> variables_;
    Evaluator<Interval> program_;
};

}  // namespace achilles
