// The sequence of events of a run as one number: two runs of different signatures differ by more than times and places.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "run/trajectory.hpp"

namespace achilles {

// Bits that depend on all bits of a number, well mixed: what random points and signatures are made of.

// One step of splitmix64.
constexpr std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

// How the run of a point ended: the kind of an Outcome, or a start that it cannot have.
class RunEnd {
 public:
    RunEnd() = default;  // cannot start
    explicit RunEnd(Outcome::Kind kind) : code_(static_cast<std::uint8_t>(1 + static_cast<int>(kind))) {}
    static RunEnd from(std::uint8_t code);
    std::uint8_t code() const { return code_; }
    std::string_view text() const;  // "end time", ..., "cannot start"
    friend bool operator==(const RunEnd&, const RunEnd&) = default;

 private:
    std::uint8_t code_ = 0;
};

// A hash of the events in their order, of each its kind and contacts, and of how the run ended. Left out are the impacts by
// which contacts come to rest: those after which, until the Zeno points of all their contacts, nothing else happens than such
// impacts and Zeno points. How many of them there are depends on where the bouncing is cut, and not on the motion.
std::uint64_t signature_of(std::span<const Passage> sequence, RunEnd end);

}  // namespace achilles
