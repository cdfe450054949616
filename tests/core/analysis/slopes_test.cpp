// d(QUANTITY, NAME) in a sweep, against `simulate --derivatives` and against differences of runs.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/table.hpp"
#include "core/systems.hpp"
#include "output/sweep_files.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

std::string quoted_print(const std::string& print) { return " --print \"" + print + "\""; }

// One row of a sweep over one axis with these prints, and its runs.
struct SweepFixture {
    SweepFixture(const std::string& system, const std::string& over, const std::vector<std::string>& prints,
                 const std::string& more = {})
        : model(test::load(system)) {
        std::string text = "--over " + over;
        for (const std::string& print : prints) text += quoted_print(print);
        sweep = read_sweep(text + more, model->description());
        table = std::make_unique<SweepTable>(model, sweep);
        rows = table->rows(0, sweep.count());
    }
    double number(std::size_t row, std::size_t print) const {
        return rows.numbers[row * table->measures().numbers() + print];
    }
    Run run(std::size_t point) const { return SweepPoints(sweep, model->description()).run(point); }

    std::shared_ptr<const Model> model;
    SweepSpec sweep;
    std::unique_ptr<SweepTable> table;
    Rows rows;
};

std::size_t direction_of(const Derivatives& derivatives, const std::string& name) {
    const auto& all = derivatives.directions;
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin());
}

// The quantity in a run with one value changed.
double value_of(const std::shared_ptr<const Model>& model, Run run, const std::string& quantity,
                const std::string& name, double change) {
    *find_value(model->description(), run, name) += change;
    run.options.tolerance = 1e-14;
    const Trajectory trajectory = simulate(model, run);
    return Quantities(model, {quantity}).of(trajectory, differentiate(trajectory)).front().value;
}

struct SlopeCase {
    std::string quantity, name;
    std::string print() const { return "d(" + quantity + ", " + name + ")"; }
};

// Bit-identical to differentiate(), and equal to differences of runs.
void check(const std::string& system, const std::string& over, const std::vector<SlopeCase>& asked) {
    std::vector<std::string> prints;
    for (const SlopeCase& one : asked) prints.push_back(one.print());
    const SweepFixture swept(system, over, prints);
    std::size_t numbers = 0;
    for (std::size_t row = 0; row < swept.sweep.count(); ++row) {
        const Run run = swept.run(row);
        const Trajectory trajectory = simulate(swept.model, run);
        const Derivatives derivatives = differentiate(trajectory);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            const Quantity quantity = Quantities(swept.model, {asked[i].quantity}).of(trajectory, derivatives).front();
            const double exact =
                quantity.derivatives[static_cast<Eigen::Index>(direction_of(derivatives, asked[i].name))];
            const double printed = swept.number(row, i);
            if (!std::isfinite(exact)) {
                EXPECT_TRUE(std::isnan(printed)) << prints[i];
                continue;
            }
            ++numbers;
            EXPECT_EQ(printed, exact) << prints[i];
            constexpr double h = 1e-5;
            const auto at = [&](double change) {
                return value_of(swept.model, run, asked[i].quantity, asked[i].name, change);
            };
            const double difference = (8.0 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12.0 * h);
            // The differences have an error of 1e-11 from the tolerance of cuts: eps_t is 1e-6, but its effect is alike
            // on both sides.
            EXPECT_NEAR(printed, difference, 1e-5 * std::max(1.0, std::abs(difference))) << system << " " << prints[i];
        }
    }
    EXPECT_GT(numbers, asked.size()) << "most of them exist";
}

TEST(SweepSlopes, AreThoseOfSingleRunsAndOfDifferences) {
    check("ball_on_sine", "e=0.3:0.5:2",
          {{"zeno_time(1)", "e"},
           {"impact_time(2)", "x'"},
           {"impact_speed(3)", "g"},
           {"release_time(1)", "y"},
           {"x + 2*zeno_time(1)", "e"},
           {"energy", "m"}});
    check("ball_on_floor", "g=9:10:2", {{"zeno_time", "g"}, {"impact_time(1)", "y"}, {"y*g", "g"}});
}

TEST(SweepSlopes, FollowTheEventsOfSections) {
    const SweepFixture swept("ball_on_sine", "e=0.3:0.5:3",
                             {"t", "d(t, e)", "d(x, e)", "d(gap, e)", "d(y', g)", "d(zeno_time, e)"}, " --at impact");
    std::size_t row = 0;
    for (std::size_t point = 0; point < 3; ++point) {
        const Trajectory trajectory = simulate(swept.model, swept.run(point));
        const Derivatives derivatives = differentiate(trajectory);
        const auto e = static_cast<Eigen::Index>(direction_of(derivatives, "e")),
                   g = static_cast<Eigen::Index>(direction_of(derivatives, "g"));
        bool is_after_zeno = false;
        for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
            const Event& event = trajectory.events[i];
            is_after_zeno = is_after_zeno || event.kind == Event::Kind::zeno;
            if (event.kind != Event::Kind::impact) continue;
            ASSERT_LT(row, swept.rows.count());
            EXPECT_EQ(swept.number(row, 0), event.t);
            EXPECT_EQ(swept.number(row, 1), derivatives.events[i].t[e]);
            EXPECT_EQ(swept.number(row, 2), derivatives.events[i].q(0, e));
            EXPECT_NEAR(swept.number(row, 3), 0.0, 1e-9) << "an impact stays on the surface";
            EXPECT_EQ(swept.number(row, 4), derivatives.events[i].v_after(1, g));
            EXPECT_EQ(std::isnan(swept.number(row, 5)), !is_after_zeno) << "the last one so far";
            ++row;
        }
    }
    EXPECT_EQ(row, swept.rows.count());
}

// NaN for a quantity that does not exist, for the end of a run that stopped early, and for a run that cannot start.
TEST(SweepSlopes, AreNaNIfTheyDoNotExist) {
    const std::vector<std::string> prints{"d(zeno_time(9), e)", "d(impact_time(1), e)", "d(impact_time(1), y)",
                                          "d(x, e)"};
    const SweepFixture whole("ball_on_sine", "e=0.3:0.5:2", prints);
    const SweepFixture early("ball_on_sine", "e=0.3:0.5:2", prints, " --max-impacts 3");
    for (std::size_t row = 0; row < 2; ++row) {
        EXPECT_TRUE(std::isnan(whole.number(row, 0)));
        EXPECT_EQ(whole.number(row, 1), 0.0) << "the first impact does not depend on e";
        EXPECT_GT(whole.number(row, 2), 0.0);
        EXPECT_TRUE(std::isfinite(whole.number(row, 3)));
        EXPECT_EQ(early.number(row, 1), whole.number(row, 1));
        EXPECT_EQ(early.number(row, 2), whole.number(row, 2));
        EXPECT_TRUE(std::isnan(early.number(row, 3))) << "when it stops depends on e";
    }
    const SweepFixture unable("ball_on_sine", "y=-3:3:2", {"d(x, e)"});
    EXPECT_TRUE(std::isnan(unable.number(0, 0))) << "it cannot start";
}

TEST(SweepSlopes, RejectQuantitiesWithoutDerivatives) {
    const auto refusal = [](const std::string& print, const std::string& more = {}) {
        try {
            const SweepFixture swept("ball_on_sine", "e=0.3:0.5:2", {print}, more);
        } catch (const InputError& problem) {
            return std::string(problem.what());
        }
        return std::string("nothing");
    };
    const std::pair<const char*, const char*> cases[] = {
        {"d(impacts, e)", "'impacts' is a whole number, and has no derivative"},
        {"d(2*zeno_points, e)", "'zeno_points' is a whole number"},
        {"d(releases, e)", "'releases' is a whole number"},
        {"d(outcome, e)", "'outcome' is text, and has no derivative"},
        {"d(held, e)", "'held' is text"},
        {"d(least_gap, e)", "derivatives of 'least_gap' are not computed"},
        {"d(loss, e)", "derivatives of 'loss' are not computed"},
        {"d(x, end)", "'end' is an option: there are no derivatives with respect to options"},
        {"d(x, z)", "'z'"},
        {"d(x)", "write d(QUANTITY, NAME)"},
        {"d(x,)", "write d(QUANTITY, NAME)"},
        {"d(x, e", "write d(QUANTITY, NAME)"},
        {"d(x, e)/2", "a derivative may not be part of an expression"},
        {"d(d(x, e), e)", "second derivatives are not computed"},
        {"d(xx, e)", "unknown name 'xx'"},
    };
    for (const auto& [print, message] : cases) {
        EXPECT_NE(refusal(print).find(message), std::string::npos) << print << ": " << refusal(print);
        EXPECT_EQ(refusal(print).find("--print "), 0u) << refusal(print);
    }
    EXPECT_NE(refusal("d(x, e)", " --at \"gap'\"").find("there are no derivatives at the zeros of 'gap''"),
              std::string::npos)
        << refusal("d(x, e)", " --at \"gap'\"");
    EXPECT_NE(refusal("d(x, e)", " --reinitialization euclidean").find("kinetic"), std::string::npos);
}

TEST(SweepSlopes, HaveAUnitAndAHeading) {
    const SweepFixture swept("ball_on_sine", "e=0.3:0.5:2",
                             {"d(zeno_time(1), e)", "x", "d(zeno_time(1), g)", "d(x, x')", "d(y', x)"});
    EXPECT_EQ(sweep_csv_heading(*swept.table, true),
              "e,\"d(zeno_time(1), e)\",x,\"d(zeno_time(1), g)\",\"d(x, x')\",\"d(y', x)\",outcome\n"
              ",s,m,s^3/m,s,1/s,\n");
    // The other numbers are in their columns.
    EXPECT_NEAR(swept.number(1, 1), simulate(swept.model, swept.run(1)).end.q[0], 1e-12);
    EXPECT_EQ(read_sweep(to_text(swept.sweep, swept.model->description()), swept.model->description()), swept.sweep);
}

}  // namespace
}  // namespace achilles
