// Vector sizes for eight runs. Each size has a source file that compiles lane_steps.hpp, and all templates over the
// number type that it uses, for Lanes<Bytes>: with the 128 bits of every processor, the 256 of AVX2 and the 512 of
// AVX-512.
//
// No other file may include lane_steps.hpp: it would compile the functions of all sizes that it uses without their
// vectors, and the linker may keep those.
//
// Never pass lanes by value between source files: each size has its own calling convention. A source file of one size
// must not define a function that another file also defines, because the linker keeps only one of them. All of its
// functions that are not inlined therefore have Lanes<Bytes> in their names.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "number/double8.hpp"
#include "program/machine.hpp"
#include "series/lane_stepper.hpp"

#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__)
#define ACHILLES_HAS_WIDE_LANES
#endif

namespace achilles {

template <std::size_t Bytes>
struct LaneKind {
    static std::unique_ptr<LaneStepper> make_stepper(const LanePrograms& programs, double tolerance,
                                                     std::optional<Width> machine_code);
    static void sine_and_cosine(const Double8* angle, Double8* sine, Double8* cosine);
    // Does what SeriesProgram::start() does.
    static void start(const SeriesProgram& program, Double8* registers, const Double8* coefficients,
                      std::array<Double8, 3>* factors);
};
using PortableLanes = LaneKind<16>;
using Avx2Lanes = LaneKind<32>;
using Avx512Lanes = LaneKind<64>;

}  // namespace achilles
