// Sensitivities in the explorer: request, background job, panel, and tangent of a sweep.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "app/hands.hpp"
#include "panels/slider.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

using test::Hands;

Session asking(const std::string& system, const std::string& quantity = {}) {
    Session session = test::session(system);
    session.apply(command::Show{"depend", true});
    if (!quantity.empty()) session.apply(command::ShowSensitivity{quantity});
    EXPECT_EQ(session.error(), "");
    session.settle();
    return session;
}

double by(const Session& session, const std::string& name) { return session.sensitivities()->find(name)->derivative; }

TEST(SensitivityCommand, StartsWithTheLastZenoTime) {
    Session session = asking("ball_on_sine");
    EXPECT_EQ(session.depend_text(), "zeno_time(2)");
    ASSERT_TRUE(session.sensitivities_are_current());
    EXPECT_EQ(session.sensitivities()->unit, "s");
    EXPECT_NEAR(session.sensitivities()->quantity.value, 12.465775, 1e-6);
    EXPECT_NEAR(by(session, "x"), 15.87553773274613, 1e-4);
    EXPECT_NEAR(by(session, "x'"), 32.10721879802504, 1e-4);
    EXPECT_NEAR(by(session, "g"), -30.31330158465276, 1e-4);
    session.apply(command::SetEndTime{1.0});
    session.settle();
    EXPECT_EQ(session.depend_text(), "x");
    EXPECT_EQ(session.sensitivities()->quantity.expression, "x");
}

// t1 + 2 e v1/(g (1 - e)), with v1 = sqrt(2 g (y - r)) and t1 = v1/g.
TEST(SensitivityCommand, AgreesWithTheClosedForm) {
    const Session session = asking("ball_on_floor", "zeno_time");
    const double g = 9.81, e = 0.7, fall = 0.94, v = std::sqrt(2.0 * g * fall), k = (1.0 + e) / (1.0 - e);
    EXPECT_NEAR(session.sensitivities()->quantity.value, k * v / g, 1e-8);
    EXPECT_NEAR(by(session, "y"), k / v, 1e-8);
    EXPECT_NEAR(by(session, "r"), -k / v, 1e-8);
    EXPECT_NEAR(by(session, "g"), -0.5 * k * v / g / g, 1e-8);
    EXPECT_NEAR(by(session, "e"), 2.0 / (1.0 - e) / (1.0 - e) * v / g, 1e-5);
    EXPECT_NEAR(by(session, "m"), 0.0, 1e-12);
    EXPECT_NEAR(by(session, "x"), 0.0, 1e-12);
}

TEST(SensitivityCommand, ComparesOverWholeSlidersInTheirOrder) {
    const Session session = asking("ball_on_floor", "zeno_time");
    const Sensitivities& known = *session.sensitivities();
    std::string order;
    for (const Sensitivities::Sensitivity& one : known.all) order += one.name + " ";
    EXPECT_EQ(order, "m r g e x x' y y' ");
    EXPECT_DOUBLE_EQ(known.find("y")->change_over_slider, by(session, "y") * (3.0 - 0.06));
    // Sliders with a logarithmic scale.
    EXPECT_TRUE(has_log_scale(0.1, 20.0));
    EXPECT_FALSE(has_log_scale(0.0, 20.0));
    EXPECT_DOUBLE_EQ(known.find("g")->change_over_slider, by(session, "g") * 9.81 * std::log(20.0 / 0.1));
    double most = 0.0;
    for (const Sensitivities::Sensitivity& one : known.all) {
        Slider slider;
        slider.varies = one.name;
        put_bar(session, slider);
        ASSERT_TRUE(slider.bar) << one.name;
        EXPECT_FALSE(slider.bar_is_old);
        most = std::max(most, std::abs(double{*slider.bar}));
        EXPECT_NEAR(*slider.bar, one.change_over_slider / known.largest(), 1e-6);
    }
    EXPECT_EQ(most, 1.0);
}

TEST(SensitivityCommand, ShowsAnglesAsTheSlidersDo) {
    const Session session = asking("double_pendulum", "theta1");
    const Sensitivities& known = *session.sensitivities();
    const auto text = [&](const char* name) {
        return derivative_text(session.description(), known, *known.find(name));
    };
    const double degree = 180.0 / 3.14159265358979323846;
    EXPECT_EQ(text("theta1"), fmt::format("\u2212{:.4g}\u00b0 per \u00b0", -by(session, "theta1")));
    EXPECT_EQ(text("L1"), fmt::format("\u2212{:.4g}\u00b0 per m", -by(session, "L1") * degree));
    EXPECT_EQ(text("e"), fmt::format("{:.4g}\u00b0", by(session, "e") * degree));
    const Session time = asking("double_pendulum", "zeno_time(1)");
    EXPECT_EQ(derivative_text(time.description(), *time.sensitivities(), *time.sensitivities()->find("theta1'")),
              fmt::format("{:.4g}\u00a0s per \u00b0/s", by(time, "theta1'") / degree));
}

TEST(SensitivityCommand, ReportsWhyThereIsNoDerivative) {
    Session session = asking("ball_on_sine", "work");
    EXPECT_EQ(session.sensitivities()->quantity.refused, "derivatives of work are not computed");
    session.apply(command::ShowSensitivity{"zeno_time(7)"});
    session.settle();
    EXPECT_EQ(session.sensitivities()->quantity.refused, "the quantity does not exist in this run");
    Slider slider;
    slider.varies = "g";
    put_bar(session, slider);
    EXPECT_FALSE(slider.bar);
    EXPECT_EQ(slider.bar_about, "no derivative here: the quantity does not exist in this run");
    session.apply(command::SetReinitialization{Reinitialization::euclidean});
    session.settle();
    EXPECT_EQ(session.sensitivities(), nullptr);
    EXPECT_NE(session.sensitivities_job().problem().find("uclidean"), std::string::npos);
    session.apply(command::SetReinitialization{Reinitialization::kinetic});
    session.apply(command::ShowSensitivity{"x"});
    session.settle();
    EXPECT_EQ(session.sensitivities_job().problem(), "");
    EXPECT_TRUE(session.sensitivities_are_current());
    // At rest on the floor: derivatives for starts that leave the constraint do not exist, those along it do.
    Session resting = test::session("ball_on_floor");
    resting.apply(command::SetStart{{{"y", 0.06}, {"x'", 0.5}}});
    resting.apply(command::ShowSensitivity{"x"});
    resting.settle();
    EXPECT_NE(resting.sensitivities()->find("y")->reason.find("changes the gap"), std::string::npos);
    EXPECT_TRUE(resting.sensitivities()->find("x'")->reason.empty());
}

TEST(SensitivityCommand, RejectsInvalidQuantitiesAndKeepsTheLastOne) {
    Session session = asking("ball_on_sine", "zeno_time(1)");
    for (const char* wrong : {"zeno_tme(1)", "held", "x +", ""}) {
        session.apply(command::ShowSensitivity{wrong});
        EXPECT_NE(session.error(), "") << wrong;
        EXPECT_EQ(session.depend_text(), "zeno_time(1)");
    }
    // Another system may or may not have the quantity.
    session.apply(command::ShowSensitivity{"y"});
    session.apply(command::Open{"double_pendulum"});
    session.settle();
    EXPECT_EQ(session.depend_text(), "zeno_time(3)");
    EXPECT_TRUE(session.sensitivities_are_current());
    session.apply(command::Show{"depend", false});
    EXPECT_EQ(session.sensitivities(), nullptr);
}

TEST(SensitivityCommand, BelongsToTheShownRunOrIsMarkedOutdated) {
    Session session = asking("ball_on_sine", "zeno_time(1)");
    const double before = by(session, "g");
    for (const double g : {1.1, 1.2, 1.3}) {
        session.apply(command::Set{"g", g});
        const Sensitivities* const known = session.sensitivities();
        ASSERT_NE(known, nullptr);  // some result is always available
        EXPECT_EQ(session.sensitivities_are_current(), known->run.get() == &session.trajectory());
        if (!session.sensitivities_are_current()) {
            EXPECT_FALSE(session.sweep_tangent());
        }
    }
    session.settle();
    EXPECT_TRUE(session.sensitivities_are_current());
    EXPECT_EQ(session.sensitivities()->run->run.parameters, session.run().parameters);
    EXPECT_NE(by(session, "g"), before);
}

// While a slider is dragged, finished results appear; in the end those of the last request.
TEST(SensitivityCommand, FinishesTheRequestInProgress) {
    const Session session = test::session("ball_on_sine");
    const auto run_of = [&](double g) {
        achilles::Run run = session.run();
        *find_value(session.description(), run, "g") = g;
        return std::make_shared<const Trajectory>(simulate(session.model(), run));
    };
    const auto first = run_of(1.0), second = run_of(1.1), third = run_of(1.2);
    SensitivitiesJob job;
    EXPECT_TRUE(job.ask(first, "x"));
    EXPECT_TRUE(job.ask(second, "x"));
    EXPECT_TRUE(job.ask(third, "x"));
    while (job.sensitivities() == nullptr) job.update(0.0);
    EXPECT_EQ(job.sensitivities()->run, first);
    EXPECT_TRUE(job.is_busy());
    job.update({});
    EXPECT_EQ(job.sensitivities()->run, third);
    EXPECT_FALSE(job.is_busy());
    EXPECT_FALSE(job.ask(third, "x"));
    job.ask(third, "y");  // results of another quantity are dropped
    EXPECT_EQ(job.sensitivities(), nullptr);
    job.forget();
    EXPECT_FALSE(job.is_busy());
}

TEST(SensitivityCommand, IsInTheRecipe) {
    Session session = asking("ball_on_sine", "zeno_time(2) - zeno_time(1)");
    EXPECT_NE(to_text(session).find("zeno_time(2) - zeno_time(1) = "), std::string::npos);
    Session again = test::session("ball_on_sine");
    for (const Command& command : recipe(session)) again.apply(command);
    again.settle();
    EXPECT_EQ(to_text(again), to_text(session));
    EXPECT_EQ(to_text(Command(command::ShowSensitivity{"x"})), "depend \"x\"");
}

// ---- tangent in the sweep ----

// Compares the tangent with five sweep points around the current run.
void touches(const std::string& system, const std::string& quantity, const std::string& name, double step) {
    Session session = asking(system, quantity);
    const double x = *session.value(name);
    session.apply(command::ShowSweep{
        fmt::format("--over {}={}:{}:5 --print \"{}\"", name, x - 2.0 * step, x + 2.0 * step, quantity)});
    ASSERT_EQ(session.error(), "");
    session.settle();
    const auto tangent = session.sweep_tangent();
    ASSERT_TRUE(tangent) << name;
    const SweepData& data = *session.sweep_job().data();
    const auto y = [&](std::size_t row) { return data.number(row, 0); };
    EXPECT_NEAR(tangent->at(data.value(0, 2)), y(2), 1e-8) << name;
    const double slope = (8.0 * (y(3) - y(1)) - (y(4) - y(0))) / (12.0 * step);
    EXPECT_NEAR(tangent->slope, slope, 2e-4 * std::max(1.0, std::abs(slope))) << quantity << " by " << name;
    // Tangency: the distance to the curve is of second order.
    const double near = std::abs(tangent->at(data.value(0, 3)) - y(3));
    const double far = std::abs(tangent->at(data.value(0, 4)) - y(4));
    EXPECT_LT(near, 0.4 * far + 1e-8) << name;
}

TEST(SensitivityCommand, TouchesTheCurveOfTheSweep) {
    for (const char* name : {"e", "g", "x", "y'"}) touches("ball_on_sine", "zeno_time(2)", name, 1e-3);
    for (const char* name : {"e", "L1", "theta1", "theta2'"}) {
        touches("double_pendulum", "zeno_time(1)", name, 1e-3);
        touches("double_pendulum", "theta1", name, 1e-3);
    }
}

TEST(SensitivityCommand, IsStraightAlongALogarithmicAxis) {
    const TangentLine line{2.0, 5.0, 3.0, true};
    EXPECT_EQ(line.at(2.0), 5.0);
    EXPECT_NEAR((line.at(2.0 + 1e-6) - line.at(2.0 - 1e-6)) / 2e-6, 3.0, 1e-6);
    EXPECT_NEAR(line.at(4.0) - line.at(2.0), line.at(2.0) - line.at(1.0), 1e-12);
}

TEST(SensitivityCommand, DrawsNoTangentOnOtherSweeps) {
    Session session = asking("ball_on_sine", "zeno_time(2)");
    for (const char* other :
         {"--over e=0.1:0.9:5 --print \"zeno_time(1)\"", "--over end=5:20:5 --print \"zeno_time(2)\"",
          "--over e=0.1:0.9:5 --over x=0:1:5 --print \"zeno_time(2)\"", "--over e=0.1:0.9:5 --at zeno --print x"}) {
        session.apply(command::ShowSweep{other});
        ASSERT_EQ(session.error(), "");
        EXPECT_FALSE(session.sweep_tangent()) << other;
    }
}

// ---- user input ----

TEST(SensitivityPanel, SweepsWhatIsClicked) {
    Hands hands("ball_on_sine");
    hands.press_with_control('5');
    hands.session.settle();
    hands.rest(3);
    EXPECT_TRUE(hands.says("s per m"));
    hands.click("depend x'");
    EXPECT_EQ(hands.session.sweep_text(), "--over \"x'=-5:5:512\" --print \"zeno_time(2)\"");
    EXPECT_TRUE(hands.session.scene().shows("sweep"));
    hands.session.settle();
    hands.rest(2);
    EXPECT_TRUE(hands.session.sweep_tangent());
}

TEST(SensitivityPanel, ComputesTheChosenOrTypedQuantity) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Show{"depend", true});
    hands.session.settle();
    hands.rest(3);
    hands.click("depend quantity");
    hands.click("depend quantity x'");
    EXPECT_EQ(hands.session.depend_text(), "x'");
    hands.session.settle();
    hands.rest(2);
    EXPECT_TRUE(hands.says("m/s per m"));
    hands.click("tab equations");
    EXPECT_FALSE(hands.session.scene().shows("depend"));
    EXPECT_EQ(hands.session.sensitivities(), nullptr);
    hands.press_with_control('5');
    EXPECT_FALSE(hands.session.scene().shows("equations"));
    hands.click("tab events");
    EXPECT_FALSE(hands.session.scene().shows("depend"));
}

TEST(SensitivityPanel, SaysThatWhatItShowsIsOld) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Show{"depend", true});
    hands.session.settle();
    hands.rest(2);
    EXPECT_FALSE(hands.says("from the previous run"));
    EXPECT_TRUE(hands.says("bars: its linear change over each whole slider"));
    hands.session.set_patience(0.0);
    test::ask_for_a_long_run(hands.session);
    hands.rest(2);
    EXPECT_NE(hands.session.under_way(), nullptr);
    EXPECT_TRUE(hands.says("from the previous run"));
    Slider slider;
    slider.varies = "g";
    put_bar(hands.session, slider);
    EXPECT_TRUE(slider.bar_is_old);
}

// Prints positions for depend_window_test.sh.
TEST(SensitivityPanel, TellsWhereItIs) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Show{"depend", true});
    hands.session.settle();
    hands.rest(3);
    const Point rate = hands.middle("depend x'");
    std::cout << "rate " << std::lround(rate.x) << " " << std::lround(rate.y) << "\n";
}

}  // namespace
}  // namespace achilles
