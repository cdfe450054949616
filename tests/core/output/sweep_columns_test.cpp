// The library as documented in its header: names, the state at a time, a sweep in memory.
#include "output/sweep_columns.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "achilles.hpp"
#include "core/systems.hpp"
#include "output/sweep_files.hpp"

namespace achilles {
namespace {

std::string told(const std::function<void()>& wrong) {
    try {
        wrong();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing";
}

TEST(Library, SetsValuesByName) {
    const auto model = test::load("ball_on_sine");
    NamedRun run(model->description());
    EXPECT_EQ(run, model->default_run());
    run.set("e", 0.3).set("x'", 1.2).set("x", -0.5);
    auto by_hand = model->default_run();
    assign(by_hand, model->description(), "e=0.3");
    assign(by_hand, model->description(), "x'=1.2");
    assign(by_hand, model->description(), "x=-0.5");
    EXPECT_EQ(run, by_hand);
    EXPECT_EQ(run.get("x'"), 1.2);
    EXPECT_EQ(told([&] { run.set("rr", 1.0); }),
              "'rr' is not a parameter, coordinate or rate of this system; these may be set: x, x', y, y', m, g, e");
    EXPECT_NE(told([&] { run.set("y''", 1.0); }).find("'y''' is not a parameter"), std::string::npos);
    EXPECT_NE(told([&] { run.get("ee"); }).find("did you mean 'e'?"), std::string::npos);
    EXPECT_EQ(run, by_hand);
}

TEST(Library, KnowsTheStateAtATime) {
    const auto model = derive(parse_system(test::load("ball_on_sine")->description().source_text));
    const Trajectory trajectory = simulate(model, NamedRun(model->description()).set("e", 0.4));
    Sampler sampler(trajectory);
    for (const double t : {0.0, 1.3, trajectory.events.front().t, 5.0, 20.0, 99.0}) {
        const Sample one = trajectory(t), other = sampler.at(t);
        EXPECT_EQ(one.state.q, other.state.q) << t;
        EXPECT_EQ(one.state.v, other.state.v) << t;
        EXPECT_EQ(one.t, std::min(t, 20.0));
        EXPECT_EQ(one.mode, other.mode);
    }
}

// The columns equal the columns of the CSV.
void expect_as_csv(const std::string& text, int threads) {
    const auto model = test::load("ball_on_sine");
    const SweepSpec sweep = read_sweep(text, model->description());
    const SweepColumns columns = sweep_columns(model, sweep, threads);
    const SweepTable table(model, sweep);
    std::string lines, units;
    for (const SweepColumn& column : columns.all) {
        lines += (lines.empty() ? "" : ",") + column.name;
        units += (&column == columns.all.data() ? "" : ",") + column.unit;
    }
    lines += "\n" + units + "\n";
    for (std::size_t row = 0; row < columns.rows(); ++row)
        for (const SweepColumn& column : columns.all) {
            const bool is_number = column.words.empty();
            if (is_number && !std::isnan(column.numbers[row])) lines += fmt::format("{}", column.numbers[row] + 0.0);
            if (!is_number) lines += column.words[row];
            lines += &column == &columns.all.back() ? "\n" : ",";
        }
    EXPECT_EQ(lines, sweep_csv_heading(table, true) + sweep_csv(table, table.rows(0, sweep.count())));
}

TEST(Library, HasSweepsAsColumns) {
    const std::string ends =
        "--over x=-3:3:20 --over y=-1:2:7 --print x --print held --print outcome --print \"zeno_time(2)\" --end 9";
    for (const int threads : {1, 2}) expect_as_csv(ends, threads);
    expect_as_csv("--over x=-1:1:9 --at impact --after 3 --print \"x'\" --print held --end 8", 2);
}

TEST(Library, CallbackStopsASweep) {
    const auto model = test::load("ball_on_sine");
    const SweepSpec sweep =
        make_sweep({.over = {"x=-3:3:1e6"}, .prints = {"x"}}, NamedRun(model->description()), model->description());
    const SweepColumns columns = sweep_columns(model, sweep, 2, [](std::uint64_t done) { return done < 100; });
    EXPECT_GE(columns.rows(), 100u);
    EXPECT_LT(columns.rows(), 100000u);
    EXPECT_EQ(columns.all[0].numbers.size(), columns.rows());
    EXPECT_EQ(columns.all[0].name, "x(0)") << "the start, beside the x at the end";
    EXPECT_EQ(columns["outcome"].words[7], "end time");
    EXPECT_NE(told([&] { columns["outcme"]; }).find("the sweep has no column 'outcme'; did you mean 'outcome'?"),
              std::string::npos);
}

}  // namespace
}  // namespace achilles
