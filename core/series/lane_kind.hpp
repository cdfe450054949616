// What a kind of vectors offers (lane_kinds.hpp), to be included and instantiated by its file alone.
#pragma once

#include "number/lanes.hpp"
#include "series/lane_kinds.hpp"
#include "series/lane_steps.hpp"

namespace achilles {

template <std::size_t Bytes>
std::unique_ptr<LaneStepper> LaneKind<Bytes>::make_stepper(const LanePrograms& programs, double tolerance,
                                                           std::optional<Width> machine_code) {
    return std::make_unique<LaneStepperOver<Lanes<Bytes>>>(programs, tolerance, machine_code);
}

template <std::size_t Bytes>
void LaneKind<Bytes>::sine_and_cosine(const Eight* angle, Eight* sine, Eight* cosine) {
    Lanes<Bytes> s, c;
    achilles::sine_and_cosine(Lanes<Bytes>(*angle), s, c);
    *sine = s;
    *cosine = c;
}

}  // namespace achilles
