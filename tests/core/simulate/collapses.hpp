// Runs whose impacts collapse, and the certificates of early cuts against cuts at the resolution of double precision.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/systems.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {

// All three errors of a cut are at most eps.
inline Trajectory run_cut_at(const std::shared_ptr<const Model>& model, double eps, Method method = Method::taylor) {
    auto run = model->default_run();
    run.options.method = method;
    run.options.tolerance = 1e-13;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = eps;
    return simulate(model, run);
}

inline std::vector<Event> collapses_of(const Trajectory& trajectory) {
    return events_of(trajectory, Event::Kind::collapse);
}

// How many early cuts were compared with late ones, how many of these were early enough to differ, and the largest part
// of a bound that was used.
struct EarlyCuts {
    int compared = 0, resolved = 0;
    double closest = 0.0;

    // The time of the first collapse is in the interval of its certificate, and the states just after both collapses
    // differ by no more than the shadowing bounds.
    void compare(const std::shared_ptr<const Model>& model) {
        const Trajectory early = run_cut_at(model, 0.01), late = run_cut_at(model, 1e-12);
        const auto rough = collapses_of(early), exact = collapses_of(late);
        if (rough.empty() || exact.empty() || !rough[0].certificate->decision) return;
        const Certificate& certificate = *rough[0].certificate;
        ++compared;
        EXPECT_LE(certificate.zeno_low, exact[0].t + 1e-13);
        EXPECT_GE(certificate.zeno_high, exact[0].t - 1e-13);
        EXPECT_EQ(rough[0].mode, exact[0].mode);
        const double t = std::max(rough[0].t, exact[0].t);
        const Sample one = early(t), other = late(t);
        const double q = (one.state.q - other.state.q).norm(), v = (one.state.v - other.state.v).norm();
        EXPECT_LE(q, *certificate.shadowing_position + 1e-13);
        EXPECT_LE(v, *certificate.shadowing_velocity + 1e-12);
        if (q + v > 1e-9) ++resolved;
        closest = std::max({closest, q / *certificate.shadowing_position, v / *certificate.shadowing_velocity});
    }
};

}  // namespace achilles::test
