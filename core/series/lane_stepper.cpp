#include "series/lane_stepper.hpp"

#include <algorithm>

#include "program/machine.hpp"
#include "series/evaluator.hpp"
#include "series/lane_kinds.hpp"

namespace achilles {

namespace {

// A tolerance below rounding is raised to it.
double resolved(double tolerance) { return std::max(tolerance, 0x1p-53); }

#ifdef ACHILLES_HAS_WIDE_LANES
// What the processor and the system support, whether machine code is switched on or not.
const bool has_avx2 = [] {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") != 0;
}();
const bool has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") != 0;

const auto sine_and_cosine_by_best = has_avx512 ? Avx512Lanes::sine_and_cosine
                                     : has_avx2 ? Avx2Lanes::sine_and_cosine
                                                : PortableLanes::sine_and_cosine;
const auto start_by_best = has_avx512 ? Avx512Lanes::start : has_avx2 ? Avx2Lanes::start : PortableLanes::start;
#else
const auto start_by_best = PortableLanes::start;
const auto sine_and_cosine_by_best = PortableLanes::sine_and_cosine;
#endif

}  // namespace

std::vector<Vectors> possible_vectors() {
    const std::optional<Width> of_code = best_width();
    std::vector<Vectors> all;
#ifdef ACHILLES_HAS_WIDE_LANES
    if (of_code == Width::eight) all.push_back(Vectors::avx512_with_machine_code);
    if (of_code) all.push_back(Vectors::avx2_with_machine_code);
#endif
    if (of_code) all.push_back(Vectors::portable_with_machine_code);
#ifdef ACHILLES_HAS_WIDE_LANES
    if (has_avx512) all.push_back(Vectors::avx512);
    if (has_avx2) all.push_back(Vectors::avx2);
#endif
    all.push_back(Vectors::portable);
    return all;
}

void sine_and_cosine_of_lanes(const Double8* angle, Double8* sine, Double8* cosine) {
    sine_and_cosine_by_best(angle, sine, cosine);
}

void start_of_lanes(const SeriesProgram& program, Double8* registers, const Double8* coefficients,
                    std::array<Double8, 3>* factors) {
    start_by_best(program, registers, coefficients, factors);
}

std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance, Vectors vectors) {
    const double least = resolved(tolerance);
    switch (vectors) {
#ifdef ACHILLES_HAS_WIDE_LANES
        case Vectors::avx512:
            return Avx512Lanes::make_stepper(programs, least, {});
        case Vectors::avx512_with_machine_code:
            return Avx512Lanes::make_stepper(programs, least, Width::eight);
        case Vectors::avx2:
            return Avx2Lanes::make_stepper(programs, least, {});
        case Vectors::avx2_with_machine_code:
            return Avx2Lanes::make_stepper(programs, least, Width::four);
#endif
        case Vectors::portable_with_machine_code:
            return PortableLanes::make_stepper(programs, least, Width::four);
        default:
            return PortableLanes::make_stepper(programs, least, {});
    }
}

}  // namespace achilles
