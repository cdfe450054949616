// Proofs do not depend on the floating-point mode of the caller's thread: rounding and denormals are set, then
// restored.
#include "number/float_environment.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cstring>
#include <mutex>
#include <ostream>

#include "certify/truncation.hpp"
#include "core/systems.hpp"
#include "output/output.hpp"
#include "simulate/batch.hpp"
#include "simulate/impact.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>

namespace achilles {
namespace {

constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040, rounding_bits = 0x6000;
constexpr unsigned watched_bits = flush_to_zero | denormals_are_zero | rounding_bits;

struct Mode {
    std::string name;
    unsigned control;  // of MXCSR
    int rounding;
};
void PrintTo(const Mode& mode, std::ostream* out) { *out << mode.name; }

const Mode modes[] = {{"upward", 0, FE_UPWARD},
                      {"downward", 0, FE_DOWNWARD},
                      {"toward_zero", 0, FE_TOWARDZERO},
                      {"flush_to_zero", flush_to_zero, FE_TONEAREST},
                      {"denormals_are_zero", denormals_are_zero, FE_TONEAREST},
                      {"all", flush_to_zero | denormals_are_zero, FE_UPWARD}};

// Sets this floating-point mode for its lifetime; `untouched` tells whether the mode is still set.
class Computing {
 public:
    explicit Computing(const Mode& mode) : before_(_mm_getcsr()) {
        std::fesetround(mode.rounding);
        _mm_setcsr(_mm_getcsr() | mode.control);
        set_ = _mm_getcsr() & watched_bits;
        rounding_ = mode.rounding;
    }
    ~Computing() {
        std::fesetround(FE_TONEAREST);
        _mm_setcsr(before_);
    }
    bool untouched() const { return (_mm_getcsr() & watched_bits) == set_ && std::fegetround() == rounding_; }

 private:
    unsigned before_, set_ = 0;
    int rounding_ = 0;
};

class FloatEnvironments : public testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, FloatEnvironments, testing::ValuesIn(modes),
                         [](const auto& mode) { return mode.param.name; });

// Not inlined, so that the product is computed here, at run time.
[[gnu::noinline]] Interval product(double a, double b) { return Interval(a) * Interval(b); }

TEST_P(FloatEnvironments, HoldAProductOfSmallNumbers) {
    volatile double a = 1e-300, b = 1e-10;
    const Computing computing(GetParam());
    Interval on_the_ground;
    {
        const FloatEnvironmentGuard ground;
        on_the_ground = product(a, b);
    }
    EXPECT_TRUE(computing.untouched());
    const FloatEnvironmentGuard ground;
    EXPECT_GT(on_the_ground.hi(), 1e-310);
    EXPECT_LT(on_the_ground.lo(), 1e-310);
}

// Without Ground the product is lost: flush-to-zero breaks the enclosure.
TEST(FloatEnvironmentGuard, IsMissedWhereDenormalsVanish) {
    volatile double a = 1e-300, b = 1e-10;
    Interval lost;
    {
        const Computing computing(modes[3]);
        lost = product(a, b);
    }
    EXPECT_FALSE(lost.contains(1e-310));
}

TEST_P(FloatEnvironments, AreRestoredAfterExceptions) {
    const Computing computing(GetParam());
    try {
        const FloatEnvironmentGuard ground;
        const FloatEnvironmentGuard inner;
        throw 1;
    } catch (int) {
    }
    EXPECT_TRUE(computing.untouched());
}

TEST(FloatEnvironmentGuard, KeepsTheExceptionsThatWereRaised) {
    const Computing computing(modes[5]);
    std::feclearexcept(FE_ALL_EXCEPT);
    {
        const FloatEnvironmentGuard ground;
        volatile double zero = 0.0, quotient = 1.0 / zero;
        (void)quotient;
    }
    EXPECT_NE(std::fetestexcept(FE_DIVBYZERO), 0);
}

std::vector<std::pair<std::shared_ptr<const Model>, Run>> some_runs() {
    std::vector<std::pair<std::shared_ptr<const Model>, Run>> runs;
    for (const char* name : {"ball_on_sine", "double_pendulum"}) {
        const auto model = test::load(name);
        for (const Method method : test::both_methods)
            for (const Conditions conditions : {Conditions::sharp, Conditions::paper}) {
                auto run = model->default_run();
                run.options.method = method;
                run.options.truncation.conditions = conditions;
                runs.emplace_back(model, run);
            }
    }
    return runs;
}

TEST_P(FloatEnvironments, GiveTheSameBytesOfARun) {
    for (const auto& [model, run] : some_runs()) {
        const std::string usual = to_json(simulate(model, run));
        const std::string usual_rows = to_csv(simulate(model, run));
        const Computing computing(GetParam());
        const Trajectory trajectory = simulate(model, run);
        const std::string now = to_json(trajectory), rows = to_csv(trajectory);
        EXPECT_TRUE(computing.untouched());
        EXPECT_EQ(now, usual);
        EXPECT_EQ(rows, usual_rows);
    }
}

TEST_P(FloatEnvironments, GiveTheSameSystemFromItsFile) {
    const auto usual = test::load("double_pendulum");
    const std::string bytes = to_json(simulate(usual, usual->default_run()));
    const Computing computing(GetParam());
    const auto model = test::load("double_pendulum");
    EXPECT_EQ(to_json(simulate(model, model->default_run())), bytes);
    EXPECT_TRUE(computing.untouched());
}

TEST_P(FloatEnvironments, GiveTheSameEndsOfManyRuns) {
    const auto model = test::load("double_pendulum");
    const auto run_of = [&](std::size_t i) {
        auto run = model->default_run();
        run.q[0] = 0.25 * static_cast<double>(i % 8) / 8.0;
        run.options.end_time = 8.0;
        return run;
    };
    const auto ends = [&] {
        std::vector<Vector> found(24);
        std::mutex lock;
        simulate_ends(
            model, found.size(), run_of,
            [&](std::size_t i, RunResult&& attempt) {
                const std::lock_guard guard(lock);
                found[i] = std::get<Trajectory>(attempt).end.q;
            },
            2);
        return found;
    };
    const auto usual = ends();
    const Computing computing(GetParam());
    const auto now = ends();
    EXPECT_TRUE(computing.untouched());
    for (std::size_t i = 0; i < usual.size(); ++i)
        EXPECT_EQ(std::memcmp(usual[i].data(), now[i].data(), sizeof(double) * 2), 0) << i;
}

// The conditions alone, as the explanation of an impact evaluates them.
TEST_P(FloatEnvironments, GiveTheSameCertificate) {
    for (const auto& [model, run] : some_runs()) {
        const Trajectory trajectory = simulate(model, run);
        const Event zeno = test::events_of(trajectory, Event::Kind::zeno).at(0);
        const Event::TruncationRecord& cut = *zeno.truncation;
        Collision collision{{cut.q, cut.v_before, cut.t}, cut.impact_speed, cut.v, cut.v};
        const auto asked = [&, &system = *model, &asking = run] {
            const auto conditions = truncation_conditions(system, asking);
            return std::pair(conditions->certify(collision), conditions->prove_any(collision));
        };
        const auto usual = asked();
        const Computing computing(GetParam());
        const auto now = asked();
        EXPECT_TRUE(computing.untouched());
        ASSERT_TRUE(usual.first && usual.second && now.first && now.second);
        for (const auto& [a, b] : {std::pair(*usual.first, *now.first), std::pair(*usual.second, *now.second)}) {
            EXPECT_EQ(a.zeno_low, b.zeno_low);
            EXPECT_EQ(a.zeno_high, b.zeno_high);
            EXPECT_EQ(a.position_bound, b.position_bound);
            EXPECT_EQ(a.velocity_bound, b.velocity_bound);
            EXPECT_EQ(a.a_min, b.a_min);
            EXPECT_EQ(a.a_max, b.a_max);
        }
    }
}

// Certificates with denormal bounds, of a gap with tiny units, are the same as well. Without Ground they would be zero.
TEST_P(FloatEnvironments, HoldCertificatesOfDenormalSize) {
    const auto model = test::drop();
    auto run = model->default_run();
    run.parameters[0] = 1e-290;
    const Vector q = Vector::Constant(1, 0.0), v = Vector::Constant(1, -1e-295), s = Vector::Constant(1, 0.0);
    const Collision collision{{q, v}, 1e-295, s, s};
    const auto usual = truncation_conditions(*model, run)->prove_any(collision);
    const Computing computing(GetParam());
    const auto now = truncation_conditions(*model, run)->prove_any(collision);
    const FloatEnvironmentGuard ground;
    ASSERT_TRUE(usual && now);
    EXPECT_GT(usual->position_bound, 0.0);
    EXPECT_EQ(now->position_bound, usual->position_bound);
    EXPECT_EQ(now->zeno_high, usual->zeno_high);
}

}  // namespace
}  // namespace achilles

#endif
