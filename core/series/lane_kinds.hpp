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
#include "series/slope_plan.hpp"

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

// The kinds of vectors by which series are differentiated in eight directions at once, as those of lanes.

// A number that depends on the parameters alone, and what it rises by.
struct SlopeCoefficient {
    double value = 0.0;
    bool rises = false;
    Eight rise;
};

// What is read and written.
struct SlopeTables {
    const SlopeCoefficient* coefficients = nullptr;
    const double* scales = nullptr;  // by/d_0 and lead/d_0 of each rule
    const double* now = nullptr;     // order k of all series
    const double* knowns = nullptr;  // each factor, order by order
    Eight* risings = nullptr;  // what they rise by: all orders of each factor, `orders` of them, one after the other
    Eight* rise = nullptr;     // what order k of each series does
    Eight* states = nullptr;   // what q, v and the event functions do, order by order
    static constexpr std::size_t orders = 33;
    std::size_t factors = 0;
    double known(std::uint32_t factor, std::size_t order) const { return knowns[order * factors + factor]; }
    Eight* rising(std::uint32_t factor) const { return risings + factor * orders; }
};

template <std::size_t Bytes>
struct SlopeKind {
    // Order k >= 1 of all, and into row k of the states, where order 1 of q and v stands; by code for the rules where there is any.
    static void make_order(const SlopePlan& plan, const SlopeTables& tables, const SlopeOrderCode* code, std::size_t k);
    // Order 0 of what has no register in the program.
    static void make_hidden(const SlopePlan& plan, const SlopeTables& tables);
    // Whether one of these, each times the weight, is larger than its limit.
    static bool any_above(const Eight* slopes, const Eight* limits, std::size_t count, double weight);
    // sum_{first<=k<=last} weight_k row_k
    static void add_up(const Eight* column, std::size_t width, const double* weights, int first, int last,
                       Eight* result);
};

}  // namespace achilles
