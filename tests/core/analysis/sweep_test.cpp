// A sweep: its points, its text form, and invalid ones.
#include "analysis/sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "analysis/measures.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

const SystemDescription& ball() {
    static const auto model = test::load("ball_on_sine");
    return model->description();
}

SweepSpec asked(const SweepOptions& asked) { return make_sweep(asked, default_run(ball()), ball()); }

TEST(Sweep, HasItsPointsInOrderAndItsEndsExactly) {
    const SweepSpec sweep = asked({.over = {"e=0.1:0.7:4", "x'=log:1e-3:10:5"}, .prints = {"t"}});
    EXPECT_EQ(sweep.count(), 20u);
    EXPECT_EQ(sweep.value(0, 0), 0.1);
    EXPECT_EQ(sweep.value(0, 4), 0.1) << "the first is the slowest";
    EXPECT_EQ(sweep.value(0, 5), 0.1 + (0.7 - 0.1) * 1.0 / 3.0);
    EXPECT_EQ(sweep.value(0, 19), 0.7);
    EXPECT_EQ(sweep.value(1, 0), 1e-3);
    EXPECT_NEAR(sweep.value(1, 7), 0.1, 1e-15);
    EXPECT_EQ(sweep.value(1, 19), 10.0);
    const SweepPoints points(sweep, ball());
    const auto run = points.run(7);
    auto expected = sweep.base;
    expected.parameters[2] = sweep.value(0, 7);
    expected.v[0] = sweep.value(1, 7);
    EXPECT_EQ(run, expected);
}

TEST(Sweep, VariesOptionsThatAreNumbers) {
    const SweepSpec sweep = asked({.over = {"end=1:5:3", "eps=log:1e-8:1e-4:3", "x=0:2*pi:2"}, .prints = {"t"}});
    const auto run = SweepPoints(sweep, ball()).run(17);
    EXPECT_EQ(run.options.end_time, 5.0);
    EXPECT_EQ(run.options.truncation.eps_q, 1e-4);
    EXPECT_EQ(run.options.truncation.eps_t, 1e-4);
    EXPECT_EQ(run.q[0], 2.0 * std::numbers::pi);
}

TEST(Sweep, DrawsPointsThatDependOnTheSeedAlone) {
    const SweepOptions box{.over = {"e=0.2:0.4", "g=log:1:100"}, .prints = {"t"}, .random = "4000", .seed = "7"};
    const SweepSpec sweep = asked(box);
    ASSERT_EQ(sweep.count(), 4000u);
    double sum = 0.0, sum_of_logarithms = 0.0, product = 0.0;
    std::set<double> values;
    for (std::uint64_t i = 0; i < sweep.count(); ++i) {
        const double e = sweep.value(0, i), g = sweep.value(1, i);
        ASSERT_TRUE(e >= 0.2 && e <= 0.4 && g >= 1.0 && g <= 100.0);
        values.insert(e);
        sum += e;
        sum_of_logarithms += std::log10(g);
        product += (e - 0.3) * (std::log10(g) - 1.0);
    }
    EXPECT_EQ(values.size(), 4000u);
    EXPECT_NEAR(sum / 4000, 0.3, 0.004);
    EXPECT_NEAR(sum_of_logarithms / 4000, 1.0, 0.04);
    EXPECT_NEAR(product / 4000, 0.0, 0.003) << "axes are independent";
    SweepOptions other = box;
    other.seed = "8";
    EXPECT_NE(asked(other).value(0, 0), sweep.value(0, 0));
    other.seed.reset();
    EXPECT_EQ(asked(other).random->seed, 1u);
}

TEST(Sweep, IsALineOfText) {
    auto base = default_run(ball());
    base.v[0] = 1.25;
    base.options.end_time = 30.0;
    base.options.truncation.conditions = Conditions::paper;
    const std::vector<std::pair<SweepOptions, std::string>> cases{
        {{.over = {" e = 0 : 0.95 : 200 "}, .prints = {" zeno_time(2) "}},
         "--over e=0:0.95:200 --print \"zeno_time(2)\" --set \"x'=1.25\" --end 30 --conditions paper"},
        {{.over = {"x'=log:1/1000:0.9:3", "y=1:2:2"}, .prints = {"x'", "energy"}, .at = "x - pi", .after = "10/4"},
         "--over \"x'=log:0.001:0.9:3\" --over y=1:2:2 --print \"x'\" --print energy --at \"x - pi\" --after 2.5 "
         "--end 30 --conditions paper"},
        {{.over = {"e=0:1"}, .prints = {"held"}, .at = "zeno", .random = "1e6", .seed = "18446744073709551615"},
         "--over e=0:1 --random 1000000 --seed 18446744073709551615 --print held --at zeno --set \"x'=1.25\" --end 30 "
         "--conditions paper"}};
    for (const auto& [sweep, text] : cases) {
        const SweepSpec made = make_sweep(sweep, base, ball());
        EXPECT_EQ(to_text(made, ball()), text);
        EXPECT_EQ(read_sweep(text, ball()), made) << text;
    }
}

std::string refused(const SweepOptions& sweep) {
    try {
        const auto model = std::make_shared<const Model>(ball());
        RunMeasures(model, asked(sweep));
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing is wrong";
}

TEST(Sweep, SaysWhatCannotBe) {
    const std::vector<std::string> over{"e=0:1:5"}, t{"t"};
    const std::vector<std::pair<SweepOptions, std::string>> cases{
        {{.over = {}, .prints = t}, "--over: nothing is varied"},
        {{.over = {"e"}, .prints = t}, "--over e: the values are missing\nwrite --over NAME=LOW:HIGH:COUNT"},
        {{.over = {"e=3"}, .prints = t},
         "this is a single value\nwrite --over e=LOW:HIGH:COUNT; for one value use --set e=3"},
        {{.over = {"e=0:0.1:0.9"}, .prints = t}, "not LOW:STEP:HIGH\nwrite --over e=0:0.9:10"},
        {{.over = {"e=0.1:0.1:0.5"}, .prints = t}, "not LOW:STEP:HIGH\nwrite --over e=0.1:0.5:5"},
        {{.over = {"e=0:0.01:1"}, .prints = t}, "not LOW:STEP:HIGH\nwrite --over e=0:1:101"},
        {{.over = {"e=0..0.9:10"}, .prints = t}, "write --over e=0:0.9:10"},
        {{.over = {"e=[0, 0.9, 10]"}, .prints = t}, "write --over e=0:0.9:10"},
        {{.over = {"e=linspace(0,0.9,10)"}, .prints = t}, "write --over e=0:0.9:10"},
        {{.over = {"e", "0", "0.9", "10"}, .prints = t}, "write --over e=0:0.9:10"},
        {{.over = {"e:0:0.9:10"}, .prints = t}, "write --over e=0:0.9:10"},
        {{.over = over, .prints = {"e"}}, "--print e: e is varied: it is already a column"},
        {{.over = over, .prints = {"x, y"}}, "write --print x --print y"},
        {{.over = over, .prints = t, .fixed = {"e"}}, "--over e: it is both varied and fixed, by --set e"},
        {{.over = {"end=1:2:3"}, .prints = t, .fixed = {"--end"}}, "--over end: it is both varied and fixed, by --end"},
        {{.over = over, .prints = t, .at = "5"}, "write --at \"t - 5\""},
        {{.over = {"e=0:1:2:3"}, .prints = t}, "two limits and a number of values are expected"},
        {{.over = {"e=0:1"}, .prints = t}, "the number of values is missing"},
        {{.over = {"e=0:1:0"}, .prints = t}, "must be a whole number of at least 2, not 0"},
        {{.over = {"e=0:1:1"}, .prints = t}, "for one value use --set"},
        {{.over = {"e=0:1:2.5"}, .prints = t}, "must be a whole number of at least 2, not 2.5"},
        {{.over = {"e=0:1:x"}, .prints = t}, "'x' is not a finite number"},
        {{.over = {"e=0,1:1:3"}, .prints = t}, "write a decimal point, 0.1"},
        {{.over = {"e=0:1:1e10"}, .prints = t}, "a sweep has at most 1000000000 points"},
        {{.over = {"e=0:1:1e5", "g=1:2:1e5"}, .prints = t}, "too many points: 1e+10"},
        {{.over = {"e=0.5:1/2:3"}, .prints = t}, "both limits are 0.5: nothing varies"},
        {{.over = {"e=log:0:1:3"}, .prints = t}, "the limits of a logarithmic axis must be positive"},
        {{.over = {"x=-1e308:1e308:3"}, .prints = t}, "too far apart"},
        {{.over = {"e=0:1:3", "e=0:2:3"}, .prints = t}, "--over e=0:2:3: e is already varied"},
        {{.over = {"f=0:1:3"}, .prints = t}, "'f' is not a parameter, coordinate or rate of this system"},
        {{.over = {"xx=0:1:3"}, .prints = t}, "did you mean 'x'?"},
        {{.over = {"e=0:1 deg:3"}, .prints = t}, "'deg' is allowed only where the unit is rad"},
        {{.over = {"tolerance=0:1:3"}, .prints = t}, "tolerance must be positive, but 0 is not"},
        {{.over = {"method=0:1:3"}, .prints = t}, "'method' is an option of the run"},
        {{.over = over, .prints = {}}, "--print: name at least one quantity to print"},
        {{.over = over, .prints = {" "}}, "an expression is missing"},
        {{.over = over, .prints = {"x", " x"}}, "--print x: it is already printed"},
        {{.over = over, .prints = {"zeno_tme(2)"}},
         "unknown function 'zeno_tme'; did you mean 'zeno_time'?\n    "
         "zeno_tme(2)\n    ^"},
        {{.over = over, .prints = {"t + impcts"}},
         "unknown name 'impcts'; did you mean 'impacts'?\n    t + impcts\n  "
         "      ^"},
        {{.over = over, .prints = {"zeno_time(0)"}}, "zeno_time(k) needs a whole number of at least 1"},
        {{.over = over, .prints = {"zeno_time(1.5)"}}, "zeno_time(k) needs a whole number of at least 1"},
        {{.over = over, .prints = {"zeno_time(x)"}}, "zeno_time(k) needs a whole number of at least 1"},
        {{.over = over, .prints = {"zeno_time(99999999999)"}}, "zeno_time(k) needs a whole number of at least 1"},
        {{.over = over, .prints = {"zeno_time(2"}}, "this '(' is never closed"},
        {{.over = over, .prints = {"held + 1"}}, "'held' is text: use it alone, not in an expression"},
        {{.over = over, .prints = t, .after = "3"}, "--after 3: this needs --at"},
        {{.over = {"tolerence=1e-9:1e-6:3"}, .prints = t}, "there is no 'tolerence'; did you mean 'tolerance'?"},
        {{.over = over, .prints = t, .at = "impact", .after = "soon"}, "'soon' is not a finite number"},
        {{.over = over, .prints = t, .at = ""}, "impact, zeno, release or an expression is expected"},
        {{.over = over, .prints = t, .at = "impakt"}, "--at impakt: unknown event\nwrite --at impact"},
        {{.over = over, .prints = t, .at = "zeno_time(1)"}, "unknown function 'zeno_time'"},
        {{.over = over, .prints = t, .random = "10"}, "so the number of values is not allowed\nwrite --over e=0:1"},
        {{.over = {"e=0:1"}, .prints = t, .random = "0"}, "a whole number of at least 1, not 0"},
        {{.over = {"e=0:1"}, .prints = t, .random = "10", .seed = "-1"}, "a whole number of at least 0 is expected"},
        {{.over = over, .prints = t, .seed = "1"}, "--seed 1: this has an effect only with --random N"},
    };
    for (const auto& [sweep, wrong] : cases) {
        const std::string told = refused(sweep);
        EXPECT_NE(told.find(wrong), std::string::npos) << "expected: " << wrong << "\ntold: " << told;
    }
    for (const char* text : {"--over", "over e=0:1:3", "--over \"e=0:1:3", "--over e=0:1:3 --print t --at x --at y",
                             "--over e=0:1:3 --print t --end -1", "--over e=0:1:3 --print t --method euler"})
        EXPECT_THROW(read_sweep(text, ball()), InputError) << text;
}

// Every count and time of events is a quantity of the systems that can have such events, and of no others.
TEST(RunQuantities, AreOfSystemsThatCanHaveThem) {
    for (const char* name : {"ball_on_sine", "newtons_cradle", "block_on_incline", "simplest_walker"}) {
        const auto model = test::load(name);
        const SystemDescription& system = model->description();
        for (const NamedRunQuantity& one : run_quantities()) {
            const std::string print(one.name), absent = why_absent(one.quantity, system);
            try {
                const RunMeasures measures(
                    model, make_sweep({.over = {"end=1:2:2"}, .prints = {print}}, default_run(system), system));
                EXPECT_EQ(absent, "") << name << " " << print;
                const bool is_time = one.quantity.kind == RunQuantity::Kind::time;
                EXPECT_EQ(measures.columns().at(0).unit == "s", is_time) << name << " " << print;
            } catch (const InputError& error) {
                EXPECT_NE(absent, "") << error.what();
                EXPECT_NE(error.message.find("'" + print + "' " + absent), std::string::npos) << error.message;
            }
        }
    }
    for (const char* count : {"impacts", "zeno_points", "sticks", "collapses", "jumps", "passes"})
        EXPECT_TRUE(is_count_of_events(count)) << count;
    for (const char* other : {"impact_time", "least_gap", "impact_speed", "e", ""})
        EXPECT_FALSE(is_count_of_events(other)) << other;
}

}  // namespace
}  // namespace achilles
