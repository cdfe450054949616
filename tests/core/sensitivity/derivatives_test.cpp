// Derivatives of whole runs against pinned numbers, and runs without derivatives.
#include "sensitivity/derivatives.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/systems.hpp"
#include "sensitivity/chain.hpp"

namespace achilles::test {
namespace {

using Row = std::vector<double>;

// A system of the gallery with a replacement in its file.
std::shared_ptr<const Model> changed(const std::string& name, const std::string& from, const std::string& to) {
    std::ifstream file(source_file("assets/systems/" + name + ".toml"));
    std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    return typed(text.replace(at, from.size(), to));
}

// The ball with the height of the waves as a parameter.
std::shared_ptr<const Model> ball_of_height() {
    return changed("ball_on_sine", "]\n\nlagrangian", "    {name = \"A\", value = 1.0},\n]\n\nlagrangian");
}
std::shared_ptr<const Model> waves() {
    SystemDescription system = ball_of_height()->description();
    system.constraints[0].gap.text = "y - A*sin(x)";
    return std::make_shared<const Model>(std::move(system));
}

Run exact(const Model& model, double eps = 1e-9) {
    Run run = model.default_run();
    run.options.tolerance = 1e-14;
    for (double* each : {&run.options.truncation.eps_q, &run.options.truncation.eps_v, &run.options.truncation.eps_t})
        *each = eps;
    return run;
}

// Derivatives at the k-th event of a kind, counted from 1.
const achilles::Derivatives::EventSensitivity& at(const achilles::Derivatives& d, const Trajectory& trajectory,
                                                  Event::Kind kind, int k) {
    for (std::size_t i = 0; i < trajectory.events.size(); ++i)
        if (trajectory.events[i].kind == kind && --k == 0) return d.events.at(i);
    throw std::out_of_range("no such event");
}

template <class Values>
void expect_row(const Values& found, const Row& expected, double relative, const std::string& what) {
    ASSERT_EQ(static_cast<std::size_t>(found.size()), expected.size()) << what;
    for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(found[static_cast<Eigen::Index>(k)], expected[k], relative * std::max(std::abs(expected[k]), 1e-3))
            << what << ", direction " << k;
}

// The parameter a of a force a/1000 has derivatives a thousand times smaller than those by k, computed beside them.
TEST(Derivatives, OfASmallForceAreAsAccurateAsThoseOfALargeOne) {
    const auto by_second_parameter = [](const std::string& force, double value) {
        const auto model =
            typed(fmt::format("title = \"small\"\ncoordinate = [{{name = \"x\", start = 1.0}}]\n"
                              "parameter = [{{name = \"k\", value = 1.0}}, {{name = \"a\", value = {}}}]\n"
                              "lagrangian = {{kinetic = \"x'^2/2\", potential = \"-k*cos(x) + {}*sin(3*x)\"}}\n"
                              "run = {{end_time = 20.0, tolerance = 1e-8}}\n",
                              value, force));
        const auto d = differentiate(simulate(model, model->default_run()));
        return std::pair(d.end->q(0, 3), d.end->q(0, 2));
    };
    const auto [small, beside] = by_second_parameter("a/1000", 1.0);
    const auto [large, same] = by_second_parameter("a", 0.001);
    EXPECT_GT(std::abs(beside), 0.5);
    EXPECT_LT(std::abs(small), 0.1);
    EXPECT_NEAR(beside, same, 1e-6 * std::abs(same));
    EXPECT_NEAR(small, large / 1000.0, 1e-6 * std::abs(small));
}

// theory-derivatives.md 11. The fifth parameter is the ball's mass, which affects nothing.
TEST(Derivatives, OfTheBallAreThePinnedOnes) {
    const auto model = waves();
    const Trajectory trajectory = simulate(model, exact(*model));
    const auto d = differentiate(trajectory);
    EXPECT_EQ(d.directions, (std::vector<std::string>{"x", "y", "x'", "y'", "m", "g", "e", "A"}));
    ASSERT_EQ(d.broken, "");
    ASSERT_EQ(d.events.size(), trajectory.events.size());
    constexpr double relative = 1e-10;  // the cut at w = 5e-5 leaves 3e-12
    expect_row(at(d, trajectory, Event::Kind::zeno, 1).t,
               {-4.027091187773081, -2.697356496533931, -7.425133529045672, -5.040636781659622, 0, 4.206279060416729,
                1.344126195328468, 0.9367161062715721},
               relative, "first Zeno time");
    expect_row(at(d, trajectory, Event::Kind::zeno, 2).t,
               {15.87553773274612, 14.88785767309844, 32.10721879802504, 24.81330659911919, 0, -30.31330158465276,
                15.87319157395134, -4.974847406230267},
               relative, "second Zeno time");
    expect_row(d.end->q.row(0),
               {-4.947980848111053, -4.424376591778259, -10.04887448278819, -7.280676764345585, 0, 6.123710783881202,
                2.011895474797504, 2.172469560354003},
               relative, "x(20)");
    EXPECT_NEAR(*d.margins.a_inf, 1.0206340050942826, 1e-9);
    EXPECT_NEAR(*d.margins.grazing_speed, trajectory.events[0].impact_speed, 1e-12);
    EXPECT_GT(*d.margins.release_jerk, 0.0);
}

TEST(Derivatives, OfThePendulumAreThePinnedOnes) {
    const auto model = load("double_pendulum");
    const Trajectory trajectory = simulate(model, exact(*model));
    const auto d = differentiate(trajectory);
    ASSERT_EQ(d.broken, "");
    constexpr double relative = 1e-10;
    expect_row(at(d, trajectory, Event::Kind::zeno, 1).t,
               {-1.436345415460432, 1.829649327383753, 1.323671580962791, 1.084716412824232, -0.2484826728821202,
                0.2484826728821202, 1.362305398710409, 0.4835297109713372, -1.845835109681746, 4.824904862933728},
               relative, "first Zeno time");
    expect_row(at(d, trajectory, Event::Kind::zeno, 3).t,
               {1.965921553551324, 0.5600851584271768, 2.248636904625183, 0.6647490738593512, -0.4701700656843121,
                0.4701700656843121, 5.174084642257617, 4.173928281026661, -9.348012923284237, 4.840457981616952},
               relative, "third Zeno time");
    expect_row(d.end->q.row(0),
               {-1.129592259103113, -0.3148959148993539, -1.03167992133345, -0.2976922688375623, 0.582014318975376,
                -0.582014318975376, -2.696508854781714, -1.848232264823671, 4.544741119605387, 0.05226012929827332},
               relative, "theta1(20)");
    for (Eigen::Index k = 0; k < 10; ++k) {  // the knee is locked
        EXPECT_EQ(d.end->q(1, k), 0.0);
        EXPECT_EQ(d.end->v(1, k), 0.0);
    }
}

// The error of dx(20)/dx of the ball is of order w^3 if the bouncing is cut at speed w (theory-derivatives.md 4).
TEST(Derivatives, ErrOfThirdOrderInTheSpeedAtTheCut) {
    const auto model = waves();
    const double truth = -4.947980848111053;
    std::vector<std::pair<double, double>> errors;
    for (const double eps : {1e-4, 1e-6, 1e-7, 1e-8}) {
        const Trajectory trajectory = simulate(model, exact(*model, eps));
        const auto d = differentiate(trajectory);
        double w = 0.0;
        for (const Event& event : trajectory.events)
            if (event.truncation) w = std::max(w, event.truncation->impact_speed);
        errors.emplace_back(w, std::abs(d.end->q(0, 0) - truth));
    }
    for (std::size_t i = 1; i < errors.size(); ++i) {
        const double slope =
            std::log(errors[i - 1].second / errors[i].second) / std::log(errors[i - 1].first / errors[i].first);
        EXPECT_NEAR(slope, 3.0, 0.25) << errors[i].first << ": " << errors[i].second;
    }
}

// A start moved along the motion, with the start time moved by as much, gives the same run. So the derivative of every
// event is zero at fixed time.
TEST(Derivatives, AlongTheMotionAreATimeShift) {
    const auto model = load("double_pendulum");
    const Trajectory trajectory = simulate(model, exact(*model));
    Chain chain(trajectory);
    const Eigen::VectorXd F = chain.rate();
    const TangentLayout& tangent = chain.tangent();
    Eigen::MatrixXd along = Eigen::MatrixXd::Zero(4 + 6 + 1, 1);
    along.topRows(4) = F.segment(tangent.q(0), 4);
    along(10, 0) = 1.0;
    const auto d = differentiate(trajectory, along);
    for (std::size_t i = 0; i < d.events.size(); ++i) {
        // (X' + c F, t' + c): zero at fixed time, so the event does not move.
        EXPECT_NEAR(d.events[i].t[0], 0.0, 1e-10) << i;
        EXPECT_LT(d.events[i].q.norm() + d.events[i].v_after.norm(), 1e-10) << i;
    }
    EXPECT_LT(d.end->q.norm() + d.end->v.norm(), 1e-10);
}

TEST(Derivatives, OfARunThatStartsInContactAreThoseAlongTheSurface) {
    const auto model = load("ball_on_sine");
    achilles::Run run = exact(*model);
    run.q << 0.8, std::sin(0.8);
    run.v << -0.1, -0.1 * std::cos(0.8);
    const Trajectory trajectory = simulate(model, run);
    ASSERT_EQ(trajectory.phases.front().kind, Phase::Kind::constrained);
    const auto d = differentiate(trajectory);
    for (std::size_t k = 0; k < 4; ++k)  // a change of one coordinate leaves the surface
        EXPECT_NE(d.refused[k].find(k < 2 ? "changes the gap" : "changes the gap rate"), std::string::npos)
            << d.refused[k];
    EXPECT_EQ(d.refused[5], "");
    EXPECT_TRUE(std::isnan(d.end->q(0, 0)));
    EXPECT_TRUE(std::isfinite(d.end->q(0, 5)));
    // Along the surface the derivatives exist, and predict a neighboring run.
    Eigen::MatrixXd along = Eigen::MatrixXd::Zero(4 + 3 + 1, 1);
    along.col(0).head(4) << 1.0, std::cos(0.8), 0.0, 0.1 * std::sin(0.8);
    const auto tangent = differentiate(trajectory, along);
    EXPECT_EQ(tangent.refused[0], "");
    const auto end_of = [&](double x) {
        achilles::Run beside = run;
        beside.q << x, std::sin(x);
        beside.v << -0.1, -0.1 * std::cos(x);
        return simulate(model, beside).end.q[0];
    };
    const double h = 1e-4;
    const double difference =
        (8.0 * (end_of(0.8 + h) - end_of(0.8 - h)) - (end_of(0.8 + 2 * h) - end_of(0.8 - 2 * h))) / (12 * h);
    EXPECT_NEAR(tangent.end->q(0, 0), difference, 1e-9 * std::abs(difference));
}

TEST(Derivatives, AreRefusedPastTheEuclideanProjection) {
    const auto model = load("double_pendulum");
    achilles::Run run = model->default_run();
    run.options.truncation.reinitialization = Reinitialization::euclidean;
    const Trajectory trajectory = simulate(model, run);
    try {
        differentiate(trajectory);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("kinetic"), std::string::npos) << error.what();
    }
}

// Two contacts that close at the same time: the order of their impacts depends on the direction of the change.
TEST(Derivatives, EndWhereThereAreNone) {
    const auto model = load("box_dropped_flat");
    const Trajectory trajectory = simulate(model, model->default_run());
    const auto d = differentiate(trajectory);
    EXPECT_NE(d.broken.find("close at the same time"), std::string::npos) << d.broken;
    EXPECT_FALSE(d.end.has_value());
    EXPECT_LT(d.events.size(), trajectory.events.size());
}

// A gap that falls to about 0.03 and rises again: the margin reports its minimum.
TEST(Derivatives, MarginsTellALowPass) {
    const auto model = model_of(PlaneSystem{
        .potential = "0", .gap = "b - 1 + a^2/100", .a = -5.0, .b = 0.9, .a_rate = 1.0, .b_rate = 0.03, .end = 6.0});
    const auto d = differentiate(simulate(model, model->default_run()));
    // h = 0.9 + 0.03 t - 1 + (t - 5)^2/100, minimal at t = 3.5.
    EXPECT_NEAR(d.margins.gap_minimum.value_or(-1.0), 0.9 + 0.105 - 1.0 + 0.0225, 1e-12);
}

}  // namespace
}  // namespace achilles::test
