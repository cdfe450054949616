// The kinds of vectors that eight runs are worked on by. Each has a file that compiles lane_steps.hpp, and all templates
// over the number that it stands on, for Lanes<Bytes>: with the 128 bits that every processor has, and for AVX-512.
// (256 bits are for machine code alone, where most of the time goes: beside it what the compiler makes with them is no
// faster than what it makes with 128.)
//
// Lanes must never be passed by value to or from what is compiled elsewhere: each kind has a calling convention of its
// own. Nor may a kind's file leave anything for the linker that another kind's file, or a file for any processor, also
// has: so all of its functions that are not a part of others have Lanes<Bytes> in their names.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "number/eight.hpp"
#include "program/machine.hpp"
#include "series/lane_stepper.hpp"

#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__)
#define ACHILLES_HAS_AVX512
#endif

namespace achilles {

template <std::size_t Bytes>
struct LaneKind {
    static std::unique_ptr<LaneStepper> make_stepper(const LanePrograms& programs, double tolerance,
                                                     std::optional<Width> machine_code);
    static void sine_and_cosine(const Eight* angle, Eight* sine, Eight* cosine);
};
using PortableLanes = LaneKind<16>;
using Avx512Lanes = LaneKind<64>;

}  // namespace achilles
