// All arithmetic on lanes, compiled for each kind of vectors that a processor may have: with the 128 bits that every
// one has, and for AVX-512. (Functions that are compiled for one kind and become a part of another do not use its
// vectors, so each kind has all of them. With 256 bits nothing would be faster than with 128.)
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "number/eight.hpp"
#include "number/polynomial.hpp"
#include "program/machine.hpp"
#include "program/program.hpp"
#include "series/lane_access.hpp"
#include "series/lane_order.hpp"
#include "series/lane_stepper.hpp"
#include "series/start.hpp"

#define IN_LANES [[gnu::always_inline]] inline
#define EACH_PART _Pragma("GCC unroll 4") for (std::size_t p = 0; p < sizeof(Eight) / VECTOR_BYTES; ++p)

#define VECTORS portable
#define VECTOR_BYTES 16
#include "series/lane_kernels.inc"
#undef VECTORS
#undef VECTOR_BYTES

#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__)
#define ACHILLES_HAS_AVX512
#pragma GCC push_options
#pragma GCC target("avx512f")
#define VECTORS avx512
#define VECTOR_BYTES 64
#include "series/lane_kernels.inc"
#undef VECTORS
#undef VECTOR_BYTES
#pragma GCC pop_options
#endif

namespace achilles {

#ifdef ACHILLES_HAS_AVX512

namespace {
const bool has_avx512 = [] {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx512f") != 0;
}();
}

void sine_and_cosine_of_lanes(const Eight* angle, Eight* sine, Eight* cosine) {
    (has_avx512 ? avx512::sine_and_cosine_of : portable::sine_and_cosine_of)(angle, sine, cosine);
}

std::vector<Vectors> possible_vectors() {
    if (!has_avx512) return {Vectors::portable};
    if (!best_width()) return {Vectors::avx512, Vectors::portable};
    return {Vectors::avx512_with_machine_code, Vectors::avx512, Vectors::portable};
}

std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance, Vectors vectors) {
    if (vectors == Vectors::portable) return std::make_unique<portable::Stepper>(programs, tolerance, false);
    return std::make_unique<avx512::Stepper>(programs, tolerance, vectors == Vectors::avx512_with_machine_code);
}

#else

void sine_and_cosine_of_lanes(const Eight* angle, Eight* sine, Eight* cosine) {
    portable::sine_and_cosine_of(angle, sine, cosine);
}

std::vector<Vectors> possible_vectors() { return {Vectors::portable}; }

std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance, Vectors) {
    return std::make_unique<portable::Stepper>(programs, tolerance, false);
}

#endif

}  // namespace achilles
