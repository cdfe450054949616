// The rows of a sweep, against single runs, closed forms and sections, for any chunks and threads.
#include "analysis/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "analysis/chunks.hpp"
#include "core/systems.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

SweepTable table_of(const std::string& system, const std::string& text) {
    const auto model = test::load(system);
    return {model, read_sweep(text, model->description())};
}

bool is_nan(double x) { return std::isnan(x); }

// On a flat floor the first Zeno time is t1 + 2 e v1/(g (1 - e)), and there is no second one.
TEST(SweepTable, KnowsTheFlatFloor) {
    const SweepTable table = table_of("ball_on_floor",
                                      "--over e=0:0.9:31 --print \"zeno_time(1)\" --print \"zeno_time(2)\" --print "
                                      "\"impact_speed(3)/impact_speed(1)\" --print \"impact_time(1)\" --print held "
                                      "--print releases --print zeno_points --end 20");
    const Rows rows = table.rows(0, table.sweep().count());
    const double fall = 1.0 - 0.06, g = 9.81, t1 = std::sqrt(2.0 * fall / g), v1 = g * t1;
    ASSERT_EQ(rows.count(), 31u);
    for (std::size_t i = 0; i < rows.count(); ++i) {
        const double e = table.sweep().value(0, i);
        const double* numbers = &rows.numbers[6 * i];
        EXPECT_NEAR(numbers[0], t1 + 2.0 * e * v1 / (g * (1.0 - e)), 1e-9) << e;
        EXPECT_TRUE(is_nan(numbers[1]));
        EXPECT_EQ(is_nan(numbers[2]), i <= 1) << "there are fewer impacts than three";
        if (i > 1) {
            EXPECT_NEAR(numbers[2], e * e, 1e-9);
        }
        EXPECT_NEAR(numbers[3], t1, 1e-12);
        EXPECT_EQ(rows.held[i], ContactSet::of(0));
        EXPECT_EQ(numbers[4], 0.0);
        EXPECT_EQ(numbers[5], 1.0);
        EXPECT_EQ(rows.ends[i], RunEnd(Outcome::Kind::end_time));
    }
}

void expect_single_runs(const SweepTable& table, double tolerance) {
    const std::uint64_t count = table.sweep().count();
    const Rows rows = table.rows(0, count);
    ASSERT_EQ(rows.count(), count);
    const SweepPoints points(table.sweep(), table.model().description());
    const auto model = std::make_shared<const Model>(table.model().description());
    for (std::size_t i = 0; i < count; ++i) {
        const Trajectory alone = simulate(model, points.run(i));
        const auto sequence = sequence_of(alone);
        std::array<double, 3> counts{};
        double last_zeno = std::nan("");
        for (const EventRecord& one : sequence) {
            ++counts[static_cast<std::size_t>(one.kind)];
            if (one.kind == Event::Kind::zeno) last_zeno = one.t;
        }
        const double* numbers = &rows.numbers[6 * i];
        EXPECT_NEAR(numbers[0], alone.end.q[0], tolerance) << i;
        EXPECT_NEAR(numbers[1], alone.end.v[0], tolerance) << i;
        for (std::size_t kind = 0; kind < 3; ++kind) EXPECT_EQ(numbers[2 + kind], counts[kind]) << i;
        EXPECT_EQ(rows.held[i], alone.end_mode.held()) << i;
        EXPECT_EQ(rows.signatures[i], signature_of(sequence, RunEnd(alone.outcome.kind))) << i;
        EXPECT_EQ(is_nan(numbers[5]), is_nan(last_zeno)) << i;
        if (is_nan(last_zeno)) continue;
        EXPECT_NEAR(numbers[5], last_zeno, 1e-6) << i;
    }
}

constexpr const char* six =
    " --print x --print \"x'\" --print impacts --print zeno_points --print releases --print "
    "zeno_time";

// The valley that contains the ball at t = 20, at random points. bench_sweep tests more of them.
TEST(SweepTable, HoldsWhatSingleRunsGive) {
    expect_single_runs(
        table_of("ball_on_sine", std::string("--over x=-3:3 --over \"x'=-2:2\" --random 60 --tolerance 1e-12") + six),
        1e-8);
}

// Rows do not depend on how many are computed at once.
TEST(SweepTable, IsTheSameInAnyChunks) {
    for (const char* text : {"--over x=-3:3:9 --over y=-2:2:7 --print x --print \"zeno_time(2)\" --print held --end 9",
                             "--over x=-3:3:5 --over y=1:2:2 --print x --print least_gap --end 6",
                             "--over x=-3:3:5 --over y=-2:2:3 --print \"x'\" --at impact --after 1 --end 6"}) {
        const SweepTable table = table_of("ball_on_sine", text);
        const Rows whole = table.rows(0, table.sweep().count());
        SweepData data(table);
        const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
            return a.size() == b.size() &&
                   (a.empty() || 0 == std::memcmp(a.data(), b.data(), a.size() * sizeof(double)));
        };
        for (std::uint64_t first = 0; first < table.sweep().count(); first += 4)
            data.add(table.rows(first, std::min<std::uint64_t>(4, table.sweep().count() - first)));
        const Rows& parts = data.rows;
        EXPECT_EQ(parts.points, whole.points);
        EXPECT_TRUE(same(parts.numbers, whole.numbers)) << text;
        EXPECT_EQ(parts.held, whole.held);
        EXPECT_EQ(parts.ends, whole.ends);
        EXPECT_EQ(parts.signatures, whole.signatures);
        EXPECT_TRUE(same(parts.times, whole.times)) << text;
    }
}

// Filling the data by chunks or row by row gives the same as the whole table.
TEST(SweepData, IsFilledByAndBy) {
    for (const char* text : {"--over x=-3:3:5 --over y=-2:2:3 --print \"x'\" --print held --end 3",
                             "--over x=-3:3:5 --over y=1:2:2 --print \"x'\" --print y --at impact --end 3"}) {
        const SweepTable table = table_of("ball_on_sine", text);
        const Rows whole = table.rows(0, table.sweep().count());
        SweepData chunks(table), rows(table);
        for (std::uint64_t i = 0; i < table.sweep().count(); ++i) chunks.add(table.rows(i, 1));
        for (std::size_t row = 0; row < whole.count(); ++row) rows.add(whole, row);
        for (const SweepData* data : {&chunks, &rows}) {
            EXPECT_EQ(data->count(), whole.count());
            EXPECT_EQ(data->rows.points, whole.points);
            EXPECT_EQ(data->rows.held, whole.held);
            EXPECT_EQ(data->rows.ends, whole.ends);
            EXPECT_EQ(data->rows.signatures, whole.signatures);
            EXPECT_EQ(data->rows.contacts, whole.contacts);
            EXPECT_EQ(data->rows.times.size(), whole.times.size());
            ASSERT_EQ(data->rows.numbers.size(), whole.numbers.size());
            for (std::size_t i = 0; i < whole.numbers.size(); ++i)
                EXPECT_TRUE(data->rows.numbers[i] == whole.numbers[i] || is_nan(whole.numbers[i]));
        }
        EXPECT_EQ(chunks.names, (std::vector<std::string>{"x(0)", "y(0)"}));
        EXPECT_EQ(chunks.units, (std::vector<std::string>{"m", "m"}));
    }
}

TEST(SweepTable, KeepsRunsThatCannotStart) {
    const SweepTable table = table_of("ball_on_sine", "--over y=-3:3:3 --print y --print held --end 1");
    const Rows rows = table.rows(0, 3);
    EXPECT_EQ(rows.ends[0].text(), "cannot start");
    EXPECT_TRUE(is_nan(rows.numbers[0]));
    EXPECT_EQ(rows.ends[2].text(), "end time");
    EXPECT_NEAR(rows.numbers[2], 2.5, 1e-12);
}

// Quantities that the final state does not determine come from recorded runs.
TEST(SweepTable, TellsTheLeastGapAndTheWork) {
    const SweepTable gaps = table_of("ball_on_sine", "--over y=1.5:2:2 --print least_gap --end 1");
    const Rows rows = gaps.rows(0, 2);
    const SweepPoints points(gaps.sweep(), gaps.model().description());
    const auto model = test::load("ball_on_sine");
    EXPECT_NEAR(rows.numbers[1], least_gap(simulate(model, points.run(1))), 1e-12);
    const SweepTable work =
        table_of("vibrating_table", "--over om=1.5:2:2 --print work --print loss --print energy --end 3");
    const Rows driven = work.rows(0, 2);
    const SweepPoints drives(work.sweep(), work.model().description());
    const auto table = test::load("vibrating_table");
    for (std::size_t i = 0; i < 2; ++i) {
        const Trajectory alone = simulate(table, drives.run(i));
        EXPECT_NEAR(driven.numbers[3 * i], alone.work, 1e-12);
        EXPECT_NEAR(driven.numbers[3 * i + 1], alone.loss, 1e-12);
    }
    EXPECT_FALSE(table_of("ball_on_sine", "--over y=1.5:2:2 --print loss --print work").measures().needs_everything());
}

TEST(SweepSections, AreTheEventsOfARun) {
    const SweepTable table = table_of("ball_on_sine",
                                      "--over y=1.5:2:2 --at impact --after 2 --print x --print impacts --print "
                                      "impact_speed --print zeno_points");
    const Rows rows = table.rows(1, 1);
    const auto model = test::load("ball_on_sine");
    const Trajectory run = simulate(model, model->default_run());
    std::size_t row = 0, impacts = 0, zeno_points = 0;
    for (const Event& event : run.events) {
        if (event.kind == Event::Kind::zeno) ++zeno_points;
        if (event.kind != Event::Kind::impact) continue;
        ++impacts;
        if (event.t < 2.0) continue;
        ASSERT_LT(row, rows.count());
        EXPECT_EQ(rows.times[row], event.t);
        EXPECT_EQ(rows.contacts[row], ContactSet::of(0));
        EXPECT_EQ(rows.numbers[4 * row], event.q[0]);
        EXPECT_EQ(rows.numbers[4 * row + 1], static_cast<double>(impacts));
        EXPECT_EQ(rows.numbers[4 * row + 2], event.impact_speed);
        EXPECT_EQ(rows.numbers[4 * row + 3], static_cast<double>(zeno_points));
        EXPECT_EQ(rows.points[row++], 1u);
    }
    EXPECT_EQ(row, rows.count());
    EXPECT_GT(row, 10u);
}

TEST(SweepTable, HasNoInfinities) {
    const SweepTable table = table_of("ball_on_floor", "--over e=0:0.5:2 --print log(e) --print 1/e --end 1");
    const Rows rows = table.rows(0, 2);
    EXPECT_TRUE(is_nan(rows.numbers[0]) && is_nan(rows.numbers[1]));
    EXPECT_NEAR(rows.numbers[2], std::log(0.5), 1e-15);
    EXPECT_EQ(rows.numbers[3], 2.0);
}

TEST(SweepSections, AreNotAllBehindTheEnd) {
    const auto refused = [](const std::string& more) -> std::string {
        try {
            table_of("ball_on_sine", "--over e=0.3:0.5:2 --print t --at impact " + more);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refused("--after 20"), "--after 20: the runs end at 20");
    EXPECT_EQ(refused("--after 20 --end 21"), "");
    EXPECT_EQ(refused("--after 20 --over end=10:30:2"), "");
}

TEST(SweepSections, AreZerosOfAnExpressionUpwards) {
    // x = x'(0) t in flight passes pi/7 once, at a known time. sin(40*t) has 12 upward zeros. The gap only touches
    // zero. y' jumps at impacts, which does not count as a zero.
    const auto times = [](const std::string& zero, const std::string& after = "") {
        const SweepTable table =
            table_of("ball_on_floor", "--over \"x'=0.5:1:2\" --end 2 --print t --at \"" + zero + "\"" + after);
        return table.rows(0, 1).times;
    };
    const std::vector<double> once = times("x - pi/7");
    ASSERT_EQ(once.size(), 1u);
    EXPECT_NEAR(once[0], std::numbers::pi / 3.5, 1e-12);
    const std::vector<double> waves = times("sin(40*t)");
    ASSERT_EQ(waves.size(), 12u) << "not at the start, where it begins with zero";
    for (std::size_t k = 0; k < waves.size(); ++k)
        EXPECT_NEAR(waves[k], static_cast<double>(k + 1) * std::numbers::pi / 20.0, 1e-12);
    EXPECT_EQ(times("sin(40*t)", " --after 1"), std::vector<double>(waves.begin() + 6, waves.end()));
    for (const char* never : {"gap", "y'", "pi/7 - x", "0*t - 1", "gap'"}) {
        const std::vector<double> none = times(never);
        ASSERT_EQ(none.size(), 1u) << never;
        EXPECT_TRUE(is_nan(none[0])) << never;
    }
    EXPECT_EQ(times("-y'").size(), 4u) << "at the top of flights, and nowhere else";
    for (const char* pole : {"-tan(10*t)", "1/(y - 0.3)", "tanh(1e15*(y - 0.3))"}) {
        const std::vector<double> none = times(pole);
        ASSERT_EQ(none.size(), 1u) << pole;
        EXPECT_TRUE(is_nan(none[0])) << pole;
    }
}

// A step may take seconds: no event ends it while a ball is in flight or at rest.
TEST(SweepSections, MissNoZeroOfLongSteps) {
    const auto count = [](const std::string& system, const std::string& zero, double end,
                          const std::string& more = "") {
        const SweepTable table =
            table_of(system, "--over e=0.3:0.5:2 --print t --at \"" + zero + "\" --end " + std::to_string(end) + more);
        return table.rows(0, 1).times.size();
    };
    EXPECT_EQ(count("ball_on_incline", "sin(x)", 8.0), 16u);  // x increases by 100.7
    EXPECT_EQ(count("ball_on_floor", "sin(t)", 100.0, " --after 50"), 8u);
    EXPECT_EQ(count("ball_on_floor", "sin(30*t)", 3.2), 15u);
    EXPECT_EQ(count("ball_on_sine", "sin(50*t)", 200.0), 1591u);
    EXPECT_EQ(count("impact_oscillator", "sin(200*t)", 20.0), 636u);
    // The only step may end at zeros.
    const SweepTable fall =
        table_of("ball_on_floor", "--over e=0.3:0.5:2 --set g=1 --print t --at \"t*(t - 1)*(0.5 - t)\" --end 1");
    ASSERT_EQ(fall.rows(0, 1).times.size(), 1u);
    EXPECT_NEAR(fall.rows(0, 1).times[0], 0.5, 1e-12);
    // The search terminates for expressions that only touch zero, or stay at zero within rounding.
    EXPECT_EQ(count("ball_on_floor", "sin(t)^2 + cos(t)^2 - 1 + gap", 20.0), 1u);
    EXPECT_EQ(count("ball_on_floor", "sin(5*t) - 1", 20.0), 1u);
    EXPECT_EQ(count("double_pendulum", "sin(theta1)^2 + cos(theta1)^2 - 1", 20.0), 1u);
}

// ---- chunks ----

std::string bytes_of(Chunk chunk) {
    std::string text;
    for (std::uint64_t i = chunk.first; i < chunk.first + chunk.count; ++i) text += std::to_string(i) + " ";
    return text;
}

TEST(Chunks, AreWrittenInOrder) {
    std::string expected;
    for (int i = 5; i < 2000; ++i) expected += std::to_string(i) + " ";
    for (const int threads : {1, 2, 3}) {
        std::string written;
        const std::atomic<bool> stop{false};
        EXPECT_TRUE(do_chunks(
            5, 2000, threads, bytes_of, [&](Chunk, const std::string& bytes) { written += bytes; }, stop));
        EXPECT_EQ(written, expected);
    }
}

TEST(Chunks, StopBetweenChunks) {
    std::atomic<bool> stop{false};
    std::uint64_t done = 0;
    const auto write = [&](Chunk chunk, const std::string&) {
        EXPECT_EQ(chunk.first, done);
        done = chunk.first + chunk.count;
        stop = true;
    };
    EXPECT_FALSE(do_chunks(0, 100000, 2, bytes_of, write, stop));
    EXPECT_GT(done, 0u);
    EXPECT_LT(done, 100000u);
    struct Full {};
    stop = false;
    EXPECT_THROW(do_chunks(
                     0, 1000, 2, bytes_of, [](Chunk, const std::string&) { throw Full(); }, stop),
                 Full);
}

}  // namespace
}  // namespace achilles
