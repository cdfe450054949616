// Contact forces and gap accelerations, against finite differences along runs.
#include "simulate/contact_forces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/multi_contact.hpp"
#include "simulate/explain.hpp"

namespace achilles {
namespace {

// Along the ball in the box: a = -(0, 1) + sum lambda_i g_i', and hddot of every gap.
TEST(ContactForces, AreWhatTheMotionShows) {
    const Trajectory trajectory = test::run_gaps("ball_in_box");
    const Model& model = *trajectory.model;
    Sampler sampler(trajectory);
    ContactForces forces(model, trajectory.run.parameters);
    std::vector<ContactTerms<Evaluator<double>>> gaps;
    for (std::size_t i = 0; i < model.contacts(); ++i)
        gaps.push_back(model.evaluator(model.programs_of(i).contact_terms, trajectory.run.parameters));
    const auto rate = [&](std::size_t i, const State& state) {
        set_state(gaps[i], state);
        gaps[i].run();
        return gaps[i].hdot();
    };
    constexpr double h = 1e-4;
    int in_contact = 0;
    for (const Phase& phase : trajectory.phases) {
        if (phase.impacts > 0 || phase.end - phase.start < 10 * h) continue;
        const double t = 0.5 * (phase.start + phase.end);
        const Sample now = sampler.at(t), before = sampler.at(t - h), after = sampler.at(t + h);
        forces.set(now);
        const Vector a = (after.state.v - before.state.v) / (2 * h);
        Vector expected = forces.generalized_force();
        expected[1] -= 1.0;
        EXPECT_NEAR((a - expected).norm(), 0.0, 1e-6);
        for (std::size_t i = 0; i < model.contacts(); ++i) {
            EXPECT_NEAR(forces.acceleration(i), (rate(i, after.state) - rate(i, before.state)) / (2 * h), 1e-6) << i;
            EXPECT_EQ(forces.force(i) > 0.0, now.mode.held().contains(i));
        }
        in_contact += now.mode.held().empty() ? 0 : 1;
    }
    EXPECT_GE(in_contact, 1);
}

// The table moves as in vibrating_table but is the second contact. Its work is the same.
TEST(ContactForces, AnyContactThatMovesDoesWork) {
    const auto alone = test::run_gaps("vibrating_table");
    const auto model = test::typed(R"toml(
title = "Ball on a vibrating table under a ceiling"
[[coordinate]]
name = "y"
start = 0.0
rate = 0.6
[[parameter]]
name = "a"
value = 0.3
[[parameter]]
name = "om"
value = 2.0
[lagrangian]
kinetic = "1/2*y'^2"
potential = "y"
[[constraint]]
name = "ceiling"
gap = "9 - y"
restitution = 0.3
[[constraint]]
name = "table"
gap = "y - a*sin(om*t)"
restitution = 0.3
[run]
end_time = 8.0
tolerance = 1e-10
)toml");
    const Trajectory second = simulate(model, model->default_run());
    EXPECT_NEAR(second.end.q[0], alone.end.q[0], 1e-8);
    EXPECT_NEAR(second.work, alone.work, 1e-8);
    EXPECT_LT(second.statistics.energy_drift, 1e-9);
    ASSERT_GT(std::abs(alone.work), 0.001);
}

// The work of a sample includes that of all steps before its own.
TEST(Samples, HaveTheWorkSinceTheStart) {
    const auto model = test::load("ball_on_vibrating_table");
    auto run = model->default_run();
    run.options.end_time = 0.45;
    const Trajectory trajectory = simulate(model, run);
    Sampler sampler(trajectory);
    double largest = 0.0;
    for (const double t : {0.3, 0.4, 0.45}) {
        const Sample sample = sampler.at(t);
        auto part = run;
        part.options.end_time = t;
        EXPECT_NEAR(sample.work, simulate(model, part).work, 1e-8) << t;
        largest = std::max(largest, std::abs(sample.work));
    }
    EXPECT_GT(largest, 1e-3);
}

// With several contacts a view receives the contact forces. Power is the rate of work.
TEST(ContactForces, AreToldToViews) {
    const Trajectory trajectory = test::run_gaps("bowl_and_post");
    const Model& model = *trajectory.model;
    const std::vector<Text> texts{{"lambda_bowl", {}}, {"lambda_post", {}}, {"gap_post''", {}},
                                  {"power", {}},       {"work", {}},        {"loss", {}}};
    const Program program = model.compile_view(texts);
    auto view = model.evaluator(program, trajectory.run.parameters);
    ContactForces forces(model, trajectory.run.parameters);
    Sampler sampler(trajectory);
    constexpr double h = 1e-5;
    for (const double t : {3.0, 10.0, 14.5}) {
        const Sample sample = sampler.at(t);
        forces.run_view(view, sample);
        forces.set(sample);
        EXPECT_EQ(view.output(0), forces.force(0));
        EXPECT_EQ(view.output(1), forces.force(1));
        EXPECT_EQ(view.output(2), forces.acceleration(1));
        EXPECT_EQ(view.output(1) > 0.0, t == 10.0);
        EXPECT_EQ(view.output(2) == 0.0, t == 10.0);
        EXPECT_NEAR(view.output(3), (sampler.at(t + h).work - sampler.at(t - h).work) / (2 * h), 1e-7);
        EXPECT_EQ(view.output(4), sample.work);
        EXPECT_EQ(view.output(5), sample.loss);
    }
}

TEST(EventExplanations, EventsOfSeveralContacts) {
    for (const char* name : test::gap_systems) {
        SCOPED_TRACE(name);
        const Trajectory trajectory = test::run_gaps(name);
        for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
            const Event& event = trajectory.events[i];
            if (event.kind == Event::Kind::impact) {
                const ImpactReason reason = explain_impact(trajectory, i);
                EXPECT_EQ(reason.cut, i + 1 < trajectory.events.size() && trajectory.events[i + 1].truncation &&
                                          trajectory.events[i + 1].truncation->t == event.t);
                EXPECT_EQ(reason.contact.has_value(), event.opened.empty());
                if (!reason.cut) continue;
                ASSERT_TRUE(reason.attempt);
                for (const Inequality& inequality : reason.attempt->inequalities())
                    EXPECT_LT(inequality.left, inequality.right) << inequality.name;
            }
            if (event.kind != Event::Kind::release) continue;
            const ReleaseReason reason = explain_release(trajectory, i);
            EXPECT_TRUE(event.contacts.contains(reason.contact));
            EXPECT_NEAR(reason.lambda, 0.0, 1e-8);
            EXPECT_GT(reason.jerk, 0.0);
            const auto& [t, lambda] = reason.force[reason.force.size() - 2];
            EXPECT_NEAR(reason.lambda_rate, lambda / (t - event.t), 0.2 * std::abs(reason.lambda_rate));
            EXPECT_EQ(reason.force.size(), 61u);
            for (std::size_t k = 1; k < 60; ++k) EXPECT_GT(reason.force[k].second, 0.0) << k;
        }
    }
}

}  // namespace
}  // namespace achilles
