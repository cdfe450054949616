// Falsified certificates. A comparison must detect each of them.
#pragma once

#include "certify/truth.hpp"

namespace achilles::test {

enum class FalseCertificate {
    earliest_time,  // times 100
    latest_time,    // this and the next five: divided by 100
    position,
    velocity,
    shadowing_position,
    shadowing_velocity,
    uniform_position,
    swapped_accelerations,  // a_min for a_max in the interval of tau_inf, and the reverse
    eta_with_M              // |M g'|/W in the paper's c3 instead of |M^-1 g'|/W
};
constexpr FalseCertificate lies[] = {
    FalseCertificate::earliest_time,    FalseCertificate::latest_time,           FalseCertificate::position,
    FalseCertificate::velocity,         FalseCertificate::shadowing_position,    FalseCertificate::shadowing_velocity,
    FalseCertificate::uniform_position, FalseCertificate::swapped_accelerations, FalseCertificate::eta_with_M};

// The certificate that a program with this error would issue.
Certificate falsified(Certificate certificate, FalseCertificate lie, const Collision& collision, const Run& run,
                      const Model& model);

}  // namespace achilles::test
