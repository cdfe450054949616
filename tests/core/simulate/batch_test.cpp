// Runs in a batch give the same results as single runs, for any number of threads.
#include "simulate/batch.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include "core/systems.hpp"

namespace achilles {
namespace {

// Starts that differ strongly in computational cost; some are below the floor.
std::vector<Run> balls(const Model& model, int count) {
    std::vector<Run> runs;
    for (int i = 0; i < count; ++i) {
        Run run = model.default_run();
        run.q << -3.0 + 6.0 * i / count, i % 10 == 9 ? -1.5 : 1.0 + 0.01 * i;
        run.v << 2.0 - 4.0 * ((i * 37) % count) / count, 0.0;
        run.parameters[2] = 0.1 + 0.8 * i / count;  // e
        run.options.end_time = i % 7 == 0 ? 40.0 : 4.0;
        run.options.truncation.conditions = i % 2 == 0 ? Conditions::sharp : Conditions::paper;
        runs.push_back(run);
    }
    return runs;
}

void put(std::string& bytes, const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
void put(std::string& bytes, double x) { put(bytes, &x, sizeof x); }
void put(std::string& bytes, const Vector& x) {
    put(bytes, x.data(), static_cast<std::size_t>(x.size()) * sizeof(double));
}

// Everything that a run computes except its wall time, bit for bit.
std::string content_of(const RunResult& attempt) {
    if (const auto* error = std::get_if<InputError>(&attempt)) return error->what();
    const auto& trajectory = std::get<Trajectory>(attempt);
    std::string bytes = trajectory.outcome.message;
    put(bytes, trajectory.coefficients.data(), trajectory.coefficients.size() * sizeof(double));
    for (const DenseSegment& piece : trajectory.pieces) put(bytes, piece.end);
    for (const Event& event : trajectory.events) {
        put(bytes, event.t);
        put(bytes, event.q);
        put(bytes, event.v_after);
        if (!event.certificate) continue;
        put(bytes, event.certificate->zeno_low);
        put(bytes, event.certificate->position_bound);
        put(bytes, event.certificate->velocity_bound);
    }
    put(bytes, trajectory.end.q);
    put(bytes, trajectory.end.v);
    put(bytes, trajectory.statistics.least_gap);
    put(bytes, static_cast<double>(trajectory.statistics.evaluations));
    return bytes;
}

TEST(ManyRuns, GiveTheSameBytesOnOneTwoAndEightThreads) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);  // also on two cores
    const auto model = test::load("ball_on_sine");
    const auto runs = balls(*model, 120);
    std::vector<std::string> alone;
    for (const auto& run : runs) {
        try {
            alone.push_back(content_of(simulate(model, run)));
        } catch (const InputError& error) {
            alone.push_back(error.what());
        }
    }
    EXPECT_EQ(std::set<std::string>(alone.begin(), alone.end()).size(), runs.size());  // the comparison is not void
    for (const int threads : {1, 2, 8}) {
        std::mutex mutex;
        std::set<std::thread::id> seen;
        // A new model each time, so that threads also meet while its programs are derived at first use.
        const auto together = simulate_many(
            test::load("ball_on_sine"), runs,
            [&](std::size_t, const RunResult& attempt) {
                const std::lock_guard lock(mutex);
                seen.insert(std::this_thread::get_id());
                return content_of(attempt);
            },
            threads);
        ASSERT_EQ(together.size(), alone.size());
        for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_TRUE(together[i] == alone[i]) << "run " << i;
        EXPECT_LE(seen.size(), static_cast<std::size_t>(threads));
        if (threads == 1) {
            EXPECT_EQ(*seen.begin(), std::this_thread::get_id());
        }
    }
}

TEST(ManyRuns, TellWhyOneCannotStartAndRunTheOthers) {
    const auto model = test::load("ball_on_sine");
    const auto runs = balls(*model, 20);
    const auto told = simulate_many(model, runs, [](std::size_t i, RunResult&& attempt) {
        const auto* error = std::get_if<InputError>(&attempt);
        EXPECT_EQ(error != nullptr, i % 10 == 9);
        return error != nullptr ? std::string(error->what()) : std::string();
    });
    EXPECT_NE(told[9].find("the gap is negative at the start"), std::string::npos) << told[9];
}

TEST(ManyRuns, DestroyEachTrajectoryAfterTake) {
    const auto model = test::load("ball_on_sine");
    std::vector<double> ends(500);
    simulate_many(
        model, ends.size(),
        [&](std::size_t i) {
            auto run = model->default_run();
            run.v[0] = 0.004 * static_cast<double>(i);
            run.options.end_time = 1.4;  // still in flight
            return run;
        },
        [&](std::size_t i, RunResult&& attempt) { ends[i] = std::get<Trajectory>(attempt).end.q[0]; });
    for (std::size_t i = 0; i < ends.size(); ++i) EXPECT_NEAR(ends[i], 1.4 * 0.004 * static_cast<double>(i), 1e-9);
    simulate_many(
        model, 0, [&](std::size_t) { return model->default_run(); }, [](std::size_t, RunResult&&) { FAIL(); });
}

// The end of a run does not depend on what is recorded.
TEST(ManyRuns, EndTheSameWhenOnlyTheEndIsKept) {
    const auto model = test::load("ball_on_sine");
    const auto runs = balls(*model, 40);
    const auto end_of = [](std::size_t, const RunResult& attempt) {
        if (const auto* error = std::get_if<InputError>(&attempt)) return std::string(error->what());
        const auto& trajectory = std::get<Trajectory>(attempt);
        std::string bytes = trajectory.outcome.message;
        put(bytes, trajectory.end_time);
        put(bytes, trajectory.end.q);
        put(bytes, trajectory.end.v);
        put(bytes, trajectory.statistics.least_gap);
        put(bytes, static_cast<double>(trajectory.statistics.steps + 1000 * trajectory.statistics.impacts));
        for (const Phase& phase : trajectory.phases) put(bytes, phase.start + phase.impacts);
        return bytes;
    };
    EXPECT_EQ(simulate_many(model, runs, end_of, 1, Recording::final_state), simulate_many(model, runs, end_of, 1));
    const auto kept = [](std::size_t, const RunResult& attempt) {
        const auto* trajectory = std::get_if<Trajectory>(&attempt);
        return trajectory == nullptr ? std::size_t{0} : trajectory->events.size() + trajectory->coefficients.size();
    };
    for (const std::size_t numbers : simulate_many(model, runs, kept, 1, Recording::final_state))
        EXPECT_EQ(numbers, 0u);
    const auto sequence = [](std::size_t, const RunResult& attempt) {
        const auto* trajectory = std::get_if<Trajectory>(&attempt);
        return trajectory == nullptr ? std::vector<EventRecord>() : sequence_of(*trajectory);
    };
    EXPECT_EQ(simulate_many(model, runs, sequence, 1, Recording::final_state), simulate_many(model, runs, sequence, 1));
}

TEST(ManyRuns, AreCancelledByAnException) {
    const auto model = test::load("ball_on_sine");
    struct Cancelled {};
    std::atomic<int> begun = 0;
    const auto run_of = [&](std::size_t) {
        ++begun;
        return model->default_run();
    };
    const auto take = [](std::size_t, RunResult&&) { throw Cancelled(); };
    EXPECT_THROW(simulate_many(model, 10000, run_of, take), Cancelled);
    EXPECT_LT(begun, 10000);
    begun = 0;
    EXPECT_THROW(simulate_ends(model, 10000, run_of, take), Cancelled);
    EXPECT_LT(begun, 10000);
}

}  // namespace
}  // namespace achilles
