// The displayed motion is within its bounds at every instant: the uniform bound of the sharp conditions, the impact at
// which bouncing is cut, and the Zeno time to third order (theory-truncation.md 2 to 4).
#include <gtest/gtest.h>

#include <cmath>

#include "certify/truncation.hpp"
#include "core/systems.hpp"
#include "output/output.hpp"
#include "simulate/impact.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

std::shared_ptr<const Model> falling_ball() {
    return test::typed(R"(
title = "Ball"
[[coordinate]]
name = "y"
start = 1.0
rate = 0.0
[[parameter]]
name = "e"
value = 0.8
[lagrangian]
kinetic = "1/2*y'^2"
potential = "9.81*y"
[[constraint]]
gap = "y"
restitution = "e"
)");
}

// Exact height of that ball.
double true_height(double t, double e) {
    constexpr double g = 9.81;
    double start = -std::sqrt(2.0 / g), up = std::sqrt(2.0 * g);  // the start as the top of an earlier bounce
    while (up > 1e-12) {
        const double length = 2.0 * up / g;
        if (t < start + length) return up * (t - start) - 0.5 * g * (t - start) * (t - start);
        start += length;
        up *= e;
    }
    return 0.0;
}

// On a flat floor every bound is attained, so time, position and velocity at tau_inf meet their tolerances at the first
// impact. The uniform bound does not, and determines the cut.
TEST(Truncation, ATextbookBallBounces) {
    const auto model = falling_ball();
    const Trajectory trajectory = simulate(model, model->default_run());
    ASSERT_EQ(trajectory.phases.size(), 2u);
    EXPECT_GE(trajectory.phases[0].impacts, 25);
    Sampler sampler(trajectory);
    double furthest = 0.0;
    for (int i = 0; i <= 100000; ++i) {
        const double t = 1e-4 * i;
        furthest = std::max(furthest, std::abs(sampler.at(t).state.q[0] - true_height(t, 0.8)));
    }
    EXPECT_LE(furthest, 1e-6);
    const auto zenos = test::events_of(trajectory, Event::Kind::zeno);
    ASSERT_EQ(zenos.size(), 1u);
    const Certificate& c = *zenos[0].certificate;
    EXPECT_LE(furthest, *c.uniform_position);
    EXPECT_GE(furthest, 0.99 * *c.uniform_position);  // the height of the first bounce that is left out
    EXPECT_NEAR(zenos[0].t, std::sqrt(2.0 / 9.81) * (1.0 + 2.0 * 0.8 / 0.2), 1e-9);
}

TEST(Truncation, TheImpactAtTheCutIsAnImpactLikeAnyOther) {
    for (const double e : {0.5, 0.0}) {
        const auto model = test::load("ball_on_sine");
        auto run = model->default_run();
        for (std::size_t i = 0; i < run.parameters.size(); ++i)
            if (model->description().parameters[i].name == "e") run.parameters[i] = e;
        const Trajectory trajectory = simulate(model, run);
        long impacts = 0;
        for (const Phase& phase : trajectory.phases) impacts += phase.impacts;
        EXPECT_EQ(impacts, trajectory.statistics.impacts);
        ContactKinematics surface(*model, run);
        int zenos = 0, since = 0;
        for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
            const Event& event = trajectory.events[i];
            if (event.kind == Event::Kind::impact) ++since;
            if (event.kind != Event::Kind::zeno) continue;
            ++zenos;
            ASSERT_GE(i, 1u);
            const Event& cut = trajectory.events[i - 1];
            ASSERT_EQ(cut.kind, Event::Kind::impact);
            EXPECT_EQ(event.impacts, since);
            since = 0;
            EXPECT_EQ(cut.t, event.truncation->t);
            EXPECT_EQ(cut.q, event.truncation->q);
            EXPECT_EQ(cut.v_before, event.truncation->v_before);
            EXPECT_EQ(cut.impact_speed, event.truncation->impact_speed);
            const Contact after = surface.at({cut.q, cut.v_after});
            EXPECT_NEAR(after.hdot, e * cut.impact_speed, 1e-13);  // Newton's law, not the restart
        }
        EXPECT_GE(zenos, 2);
    }
}

struct CutError {
    double w, estimate_error, half_width, first_order_half_width;
};

// Enclosures of the first Zeno time from each impact before it.
std::vector<CutError> cuts_of(const std::string& system) {
    const auto model = test::load(system);
    auto run = model->default_run();
    run.options.tolerance = 1e-14;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-13;
    const Trajectory trajectory = simulate(model, run);
    const Event zeno = test::events_of(trajectory, Event::Kind::zeno).at(0);
    ContactKinematics surface(*model, run);
    const auto conditions = truncation_conditions(*model, run);
    const Interval e(0.5);
    std::vector<CutError> cuts;
    for (const Event& event : trajectory.events) {
        if (event.t >= zeno.t || event.kind != Event::Kind::impact) break;
        const State before{event.q, event.v_before, event.t};
        const Contact contact = surface.at(before);
        const Vector s = reinitialize(contact, before.v, Reinitialization::kinetic);
        const auto c = conditions->prove_any({before, -contact.hdot, s, s});
        if (!c) continue;
        EXPECT_LE(c->zeno_low, zeno.t);
        EXPECT_GE(c->zeno_high, zeno.t);
        const AccumulationTime accumulation_time =
            accumulation_time_bounds(e, Interval(c->a_min), Interval(c->a_max), Interval(event.impact_speed));
        cuts.push_back({event.impact_speed, std::abs(c->zeno_time - zeno.t), 0.5 * (c->zeno_high - c->zeno_low),
                        0.5 * (accumulation_time.latest.hi() - accumulation_time.earliest.lo())});
    }
    return cuts;
}

double slope(const CutError& a, const CutError& b, double CutError::*value) {
    return std::log(a.*value / (b.*value)) / std::log(a.w / b.w);
}

TEST(Truncation, TheZenoTimeIsEnclosedToThirdOrder) {
    for (const auto& problem : test::problems) {
        const std::vector<CutError> cuts = cuts_of(problem.asset);
        const CutError *large = nullptr, *small = nullptr;
        for (const CutError& cut : cuts) {
            if (cut.w < 2e-2 && large == nullptr) large = &cut;
            if (cut.w > 3e-4) small = &cut;
        }
        ASSERT_TRUE(large != nullptr && small != nullptr && small->w < 0.1 * large->w);
        EXPECT_GT(slope(*large, *small, &CutError::half_width), 2.8) << problem.key;
        EXPECT_GT(slope(*large, *small, &CutError::estimate_error), 2.8) << problem.key;
        EXPECT_NEAR(slope(*large, *small, &CutError::first_order_half_width), 2.0, 0.5) << problem.key;
        EXPECT_LT(small->half_width, 0.1 * small->first_order_half_width) << problem.key;
        // The estimate is not an endpoint of the interval but well inside.
        EXPECT_LT(small->estimate_error, 0.1 * small->half_width) << problem.key;
    }
}

// A decision without a report leaves out the enclosure of third order, except where only that one is narrow enough.
// Everything that the further motion depends on is the same.
TEST(Truncation, ADecisionAloneLeavesTheMotionAsItIs) {
    int wider = 0, as_narrow = 0;
    for (const auto& problem : test::problems) {
        const auto model = test::load(problem.asset);
        auto run = model->default_run();
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-13;
        const Trajectory trajectory = simulate(model, run);
        ContactKinematics surface(*model, run);
        run.options.truncation.eps_q = run.options.truncation.eps_v = 1e-2;
        for (const double eps_t : {1e-3, 1e-5, 1e-7, 1e-9}) {
            run.options.truncation.eps_t = eps_t;
            const auto reports = truncation_conditions(*model, run), decisions = truncation_conditions(*model, run);
            for (const Event& event : test::events_of(trajectory, Event::Kind::impact)) {
                const State before{event.q, event.v_before, event.t};
                const Contact contact = surface.at(before);
                const Vector s = reinitialize(contact, before.v, Reinitialization::kinetic);
                const Collision collision{before, -contact.hdot, s, s};
                const auto report = reports->certify(collision);
                const auto decision = decisions->certify(collision, CertificateScope::decision);
                ASSERT_EQ(decision.has_value(), report.has_value()) << problem.key << ", " << eps_t << ", " << event.t;
                if (!report) continue;
                EXPECT_EQ(decision->zeno_time, report->zeno_time);
                EXPECT_EQ(decision->shadowing_position, report->shadowing_position);
                EXPECT_EQ(decision->shadowing_velocity, report->shadowing_velocity);
                EXPECT_LE(decision->zeno_low, report->zeno_low);
                EXPECT_GE(decision->zeno_high, report->zeno_high);
                const bool same = decision->zeno_high - decision->zeno_low == report->zeno_high - report->zeno_low;
                ++(same ? as_narrow : wider);
            }
        }
    }
    EXPECT_GT(wider, 10);
    EXPECT_GT(as_narrow, 10);
}

// Where a force begins to see the contact at the Zeno point, the distances depend on the enclosure of that time, too.
// If the wider one does not suffice for them, the decision is made with that of third order, as in a report.
TEST(Truncation, ADecisionAboutDistancesHasTheThirdOrderIfItNeedsIt) {
    const auto model = test::typed(R"toml(title = "floor that pushes"
coordinate = [{name = "x", rate = 1, force = "100*held(floor)"}, {name = "y", force = "-1 - x"}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2)", potential = "0"}
constraint = [{name = "floor", gap = "y", restitution = 0.5}]
)toml");
    auto run = model->default_run();
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1.0;
    const Vector q = Vector::Zero(2), s = Vector::Unit(2, 0);
    const Collision collision{{q, s - 1e-3 * Vector::Unit(2, 1)}, 1e-3, s, s};
    const auto report = truncation_conditions(*model, run)->certify(collision);
    const auto wider = truncation_conditions(*model, run)->certify(collision, CertificateScope::decision);
    ASSERT_TRUE(report && wider);
    ASSERT_GT(*wider->uniform_position, 2.0 * *report->uniform_position);
    run.options.truncation.eps_q = 1.5 * *report->uniform_position;
    const auto decision = truncation_conditions(*model, run)->certify(collision, CertificateScope::decision);
    ASSERT_TRUE(decision);
    EXPECT_EQ(decision->zeno_low, report->zeno_low);
    EXPECT_EQ(decision->zeno_high, report->zeno_high);
    EXPECT_EQ(decision->uniform_position, report->uniform_position);
}

// With units so small that a_min^2 underflows, time and position of the Zeno point are bounded but the shadowing error
// is not. Then no shadowing bound is reported, and none may cause a cut.
TEST(Truncation, NothingIsClaimedOfAShadowWithoutABound) {
    const auto model = test::drop();
    auto run = model->default_run();
    run.parameters[0] = 1e-290;
    const Vector q = Vector::Constant(1, 0.0), v = Vector::Constant(1, -1e-295), s = Vector::Constant(1, 0.0);
    const Collision collision{{q, v}, 1e-295, s, s};
    const auto conditions = truncation_conditions(*model, run);
    EXPECT_FALSE(conditions->certify(collision));
    const auto widest = conditions->prove_any(collision);
    ASSERT_TRUE(widest);
    EXPECT_GT(widest->position_bound, 0.0);
    EXPECT_FALSE(widest->shadowing_position || widest->shadowing_velocity || widest->uniform_position);
}

// Term (E) follows from the exact identity: -T0^2 (b/(3a) + c/6) = w^2 (cC - cD - cF + cG).
TEST(Truncation, TheEstimateIsThatOfTheIdentity) {
    const AccelerationTrend trend{2.0, 0.3, 0.7};
    const double e = 0.5, w = 1e-2, a = trend.a, b = trend.b, c = trend.c, K = (1 + e) / (1 - e);
    const double cB = -b * K / (2 * a * a), cC = -(b / (a * a) + c / a) / (2 * a);
    const double cD = -K * (b / (2 * a * a) + c / a) / (3 * a), cF = cB / a;
    const double cG = -cC + (cD + cF) * (1 + e * e) / (1 - e * e);
    EXPECT_NEAR(estimated_accumulation_time(trend, e, w), 2 * e * w / (a * (1 - e)) + w * w * (cC - cD - cF + cG),
                1e-17);
}

// Compares the third-order enclosure with the formulas of theory-truncation.md 4, evaluated here independently: with
// none of the six terms of rho (0), with each alone, so that no other hides it (1 to 6), and with all (7).
void expect_third_order(double a_min, double a_max) {
    const AccelerationTrend trend{2.0, 0.3, 0.7};
    const double e = 0.5, w = 1e-2, T = 0.03, a = trend.a, b = trend.b, c = trend.c;
    const double K = (1 + e) / (1 - e), h_m = e * w * e * w / (2 * a_min);
    const double cA = -b / (a * a), cB = -b * K / (2 * a * a), cE = cB, cC = -(b / (a * a) + c / a) / (2 * a);
    const double cD = -K * (b / (2 * a * a) + c / a) / (3 * a), cF = cB / a;
    const double cG = -cC + (cD + cF) * (1 + e * e) / (1 - e * e);
    const double e2 = e * std::sqrt(a_max / a_min);  // e''
    const double z_m = w * std::sqrt(std::max(e, e2) * std::max(e, e2) + e * e * a / a_min);
    const double d_m = std::max(std::abs(a_max - a), std::abs(a - a_min));
    const double S = T * (std::abs(cA) + 1.09 * std::abs(cB) + std::abs(cE)) +
                     2 * z_m * (std::abs(cC) + std::abs(cD) + std::abs(cF) + std::abs(cG));
    for (int term = 0; term <= 7; ++term) {
        const auto size = [&](int of) { return term == of || term == 7 ? 0.4 + 0.1 * of : 0.0; };
        const double start = size(1), by_sigma = size(2), P = size(3), phi_mid = size(4), phi_rad = size(5),
                     xi = size(6);
        const AccelerationBounds drift{Interval(a - start, a + 0.5 * start), Interval(c - 0.5 * by_sigma, c + by_sigma),
                                       Interval(b - P, b + 0.5 * P), Interval(-phi_mid - phi_rad, -phi_mid + phi_rad),
                                       Interval(-xi, 0.5 * xi)};
        const double rho = start + by_sigma * w + P * T + phi_mid * h_m + phi_rad * w * T + xi * w * w * T;
        const double off = T * (2 * rho / (a * (1 - e)) + d_m * S), center = estimated_accumulation_time(trend, e, w);
        const Interval accumulation_time = third_order_accumulation_time(
            trend, drift, Interval(e), Interval(a_min), Interval(a_max), Interval(w), Interval(0.0, T));
        // Tolerance 1e-3, because the factor 1.09 of the theory is rounded up. Terms smaller than that beside S are
        // checked below, with b = c = d_m = 0.
        EXPECT_LE(accumulation_time.lo(), center - off) << term;
        EXPECT_GE(accumulation_time.hi(), center + off) << term;
        EXPECT_NEAR(accumulation_time.hi() - center, off, 1e-3 * off) << term;
        const Interval alone = third_order_accumulation_time(
            {a, 0.0, 0.0}, {drift.start, drift.by_sigma - Interval(c), drift.P - Interval(b), drift.Phi, drift.Xi},
            Interval(e), Interval(a), Interval(a), Interval(w), Interval(0.0, T));
        const double h_alone = e * w * e * w / (2 * a), T0 = 2 * e * w / (a * (1 - e));
        const double rho_alone = rho + phi_mid * (h_alone - h_m);
        EXPECT_NEAR(alone.hi() - T0, T * 2 * rho_alone / (a * (1 - e)), 1e-9 * T * rho_alone + 1e-15) << term;
    }
}

TEST(Truncation, TheThirdOrderIntervalIsThatOfTheTheory) {
    expect_third_order(1.9, 2.2);  // a = 2 is nearer to a_min
    expect_third_order(1.7, 2.1);  // and here to a_max
}

}  // namespace
}  // namespace achilles
