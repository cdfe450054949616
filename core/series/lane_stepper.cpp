#include "series/lane_stepper.hpp"

#include <algorithm>

#include "program/machine.hpp"
#include "series/lane_kinds.hpp"

namespace achilles {

namespace {

// No tolerance is below rounding.
double resolved(double tolerance) { return std::max(tolerance, 0x1p-53); }

#ifdef ACHILLES_HAS_AVX512
const bool has_avx512 = [] {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx512f") != 0;
}();
#endif

}  // namespace

#ifdef ACHILLES_HAS_AVX512

void sine_and_cosine_of_lanes(const Eight* angle, Eight* sine, Eight* cosine) {
    (has_avx512 ? Avx512Lanes::sine_and_cosine : PortableLanes::sine_and_cosine)(angle, sine, cosine);
}

std::vector<Vectors> possible_vectors() {
    if (!has_avx512) return {Vectors::portable};
    if (best_width() != Width::eight) return {Vectors::avx512, Vectors::portable};
    return {Vectors::avx512_with_machine_code, Vectors::avx512, Vectors::portable};
}

std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance, Vectors vectors) {
    if (vectors == Vectors::portable) return PortableLanes::make_stepper(programs, resolved(tolerance), false);
    const bool machine_code = vectors == Vectors::avx512_with_machine_code;
    return Avx512Lanes::make_stepper(programs, resolved(tolerance), machine_code);
}

#else

void sine_and_cosine_of_lanes(const Eight* angle, Eight* sine, Eight* cosine) {
    PortableLanes::sine_and_cosine(angle, sine, cosine);
}

std::vector<Vectors> possible_vectors() { return {Vectors::portable}; }

std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance, Vectors) {
    return PortableLanes::make_stepper(programs, resolved(tolerance), false);
}

#endif

}  // namespace achilles
