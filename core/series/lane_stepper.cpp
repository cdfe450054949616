#include "series/lane_stepper.hpp"

#include <algorithm>

#include "program/machine.hpp"
#include "series/lane_kinds.hpp"
#include "series/lane_steps.hpp"

namespace achilles {

// With the vectors that every processor has.
template struct LaneKind<16>;

namespace {

// A tolerance below rounding is raised to it.
double resolved(double tolerance) { return std::max(tolerance, 0x1p-53); }

#ifdef ACHILLES_HAS_AVX512
const bool has_avx512 = [] {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx512f") != 0;
}();
#endif

}  // namespace

std::vector<Vectors> possible_vectors() {
    const std::optional<Width> of_code = best_width();
    std::vector<Vectors> all;
#ifdef ACHILLES_HAS_AVX512
    if (of_code == Width::eight) all.push_back(Vectors::avx512_with_machine_code);
#endif
    if (of_code) all.push_back(Vectors::portable_with_machine_code);
#ifdef ACHILLES_HAS_AVX512
    if (has_avx512) all.push_back(Vectors::avx512);
#endif
    all.push_back(Vectors::portable);
    return all;
}

#ifdef ACHILLES_HAS_AVX512

void sine_and_cosine_of_lanes(const Double8* angle, Double8* sine, Double8* cosine) {
    (has_avx512 ? Avx512Lanes::sine_and_cosine : PortableLanes::sine_and_cosine)(angle, sine, cosine);
}

#else

void sine_and_cosine_of_lanes(const Double8* angle, Double8* sine, Double8* cosine) {
    PortableLanes::sine_and_cosine(angle, sine, cosine);
}

#endif

std::unique_ptr<LaneStepper> make_lane_stepper(const LanePrograms& programs, double tolerance, Vectors vectors) {
    const double least = resolved(tolerance);
    switch (vectors) {
#ifdef ACHILLES_HAS_AVX512
        case Vectors::avx512:
            return Avx512Lanes::make_stepper(programs, least, {});
        case Vectors::avx512_with_machine_code:
            return Avx512Lanes::make_stepper(programs, least, Width::eight);
#endif
        case Vectors::portable_with_machine_code:
            return PortableLanes::make_stepper(programs, least, Width::four);
        default:
            return PortableLanes::make_stepper(programs, least, {});
    }
}

}  // namespace achilles
