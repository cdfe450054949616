// Chains of rods: many coordinates, all coupled by the mass matrix.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>

#include "algebra/vanishes.hpp"
#include "core/systems.hpp"
#include "model/model.hpp"
#include "sensitivity/derivatives.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

// Sanitizers make derivations several times slower.
#ifdef __SANITIZE_ADDRESS__
constexpr int max_seconds = 100;
#else
constexpr int max_seconds = 10;
#endif

enum class Angles { absolute, relative };

// A chain of uniform rods (1 kg, 0.5 m) that hangs at the origin, with a wall at a distance from the origin that the
// last end may touch. It is typed with differences of angles: T = sum of J_ij/2 cos(a_i - a_j) a_i' a_j'.
std::string chain(int links, Angles angles, double wall, double end_time) {
    const bool is_relative = angles == Angles::relative;
    const auto name = [](int i) { return fmt::format("a{}", i + 1); };
    const auto sum = [&](int first, int last, const char* prime) {  // of the coordinates first to last
        std::string text = name(first) + prime;
        for (int k = first + 1; k <= last; ++k) text += " + " + name(k) + prime;
        return "(" + text + ")";
    };
    const auto angle = [&](int i, const char* prime) { return is_relative ? sum(0, i, prime) : name(i) + prime; };
    std::string text = fmt::format("title = \"A chain of {} links\"\ncoordinate = [\n", links);
    for (int i = 0; i < links; ++i)
        text += fmt::format("    {{name = \"{}\", start = {}, unit = \"rad\"}},\n", name(i),
                            is_relative && i > 0 ? 0.0 : 0.5);
    std::string kinetic = "0", potential = "0", reach = fmt::format("{}", wall);
    for (int i = 0; i < links; ++i) {
        const int below = links - 1 - i;
        kinetic += fmt::format(" + m*l^2/2*({} + 1/3)*{}^2", below, angle(i, "'"));
        for (int j = 0; j < i; ++j)
            kinetic +=
                fmt::format(" + m*l^2*({} + 1/2)*cos({})*{}*{}", below,
                            is_relative ? sum(j + 1, i, "") : name(i) + " - " + name(j), angle(i, "'"), angle(j, "'"));
        potential += fmt::format(" - ({} + 1/2)*m*g*l*cos({})", below, angle(i, ""));
        reach += fmt::format(" + l*sin({})", angle(i, ""));
    }
    return text +
           "]\nparameter = [{name = \"m\", value = 1.0}, {name = \"l\", value = 0.5}, {name = \"g\", value = 9.81}]\n" +
           "lagrangian.kinetic = \"" + kinetic + "\"\nlagrangian.potential = \"" + potential +
           "\"\nconstraint = [{name = \"wall\", gap = \"" + reach + "\", restitution = 0.5}]\n" +
           fmt::format("run = {{end_time = {}}}\n", end_time);
}

// The same in relative angles, typed as bodies. With fewer coordinates than links, the angles repeat. `masses`: each link
// has a mass of its own, so that the terms of two links do not meet.
std::string chain_of_bodies(int links, int coordinates, double end_time, bool has_masses = false) {
    std::string text = "coordinate = [\n", masses;
    for (int i = 1; i <= coordinates; ++i)
        text += fmt::format("    {{name = \"a{}\", start = {}, unit = \"rad\"}},\n", i, i == 1 ? 0.5 : 0.0);
    for (int i = 1; has_masses && i <= links; ++i) masses += fmt::format(", {{name = \"m{}\", value = 1.0}}", i);
    text += "]\nparameter = [{name = \"m\", value = 1.0}, {name = \"l\", value = 0.5}, {name = \"g\", value = 9.81}" +
            masses + "]\nworld = {gravity = [0, \"-g\"]}\nbody = [\n";
    for (int i = 1; i <= links; ++i)
        text +=
            fmt::format("    {{name = \"link{}\", mass = \"m{}\", rod = [[0, 0], [0, \"-l\"]], angle = \"a{}\"{}}},\n",
                        i, has_masses ? std::to_string(i) : "", (i - 1) % coordinates + 1,
                        i == 1 ? "" : fmt::format(", on = \"link{}\", at = \"end\"", i - 1));
    return text + fmt::format(
                      "]\nground = [{{name = \"wall\", line = [[-10, 0], [-10, -1]]}}]\n"
                      "constraint = [{{between = [\"link{}.end\", \"wall\"], restitution = 0.5}}]\n"
                      "run = {{end_time = {}}}\n",
                      links, end_time);
}

std::shared_ptr<const Model> free_chain(int links, Angles angles) { return test::typed(chain(links, angles, 10, 20)); }

// The accelerations of the chain in absolute angles, by the mass matrix in numbers.
Vector accelerations(const Vector& a, const Vector& rate) {
    const Eigen::Index n = a.size();
    Eigen::MatrixXd M(n, n);
    Eigen::VectorXd right(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        right[i] = -9.81 * 0.5 * (static_cast<double>(n - 1 - i) + 0.5) * std::sin(a[i]);
        for (Eigen::Index j = 0; j < n; ++j) {
            const double J = 0.25 * (static_cast<double>(n - 1 - std::max(i, j)) + (i == j ? 1.0 / 3.0 : 0.5));
            M(i, j) = J * std::cos(a[i] - a[j]);
            right[i] -= J * std::sin(a[i] - a[j]) * rate[j] * rate[j];
        }
    }
    return M.ldlt().solve(right);
}

Vector differences(const Vector& x) {
    Vector result = x;
    for (Eigen::Index i = 1; i < x.size(); ++i) result[i] = x[i] - x[i - 1];
    return result;
}

// Below and above the number of coupled coordinates from which M^-1 is preconditioned (theory.md 1).
TEST(Chains, HaveTheAccelerationsOfTheMassMatrix) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-2.0, 2.0);
    for (const int links : {3, 4, 5, 8, 12})
        for (const Angles angles : {Angles::absolute, Angles::relative}) {
            const auto model = free_chain(links, angles);
            MotionTerms<Evaluator<double>> motion =
                model->evaluator(model->motion({}).program, model->default_run().parameters);
            for (int k = 0; k < 20; ++k) {
                State state{Vector(links), Vector(links)};
                for (double& x : state.q) x = any(random);
                for (double& x : state.v) x = any(random);
                Vector expected = accelerations(state.q, state.v);
                const double size = 1.0 + expected.norm();
                if (angles == Angles::relative) {
                    expected = differences(expected);
                    state.q = differences(state.q);
                    state.v = differences(state.v);
                }
                set_state(motion, state);
                motion.run();
                for (std::size_t i = 0; i < static_cast<std::size_t>(links); ++i)
                    EXPECT_NEAR(motion.acceleration(i), expected[static_cast<Eigen::Index>(i)], 1e-11 * size) << links;
            }
        }
}

// Over a box of width 2e-9, the enclosure of the accelerations is at most 5e8 times as wide: interval elimination in M
// would make it 1e10 and 1e15 times as wide.
TEST(Chains, HaveNarrowEnclosures) {
    for (const Angles angles : {Angles::absolute, Angles::relative}) {
        const auto model = free_chain(12, angles);
        const MotionTerms<Evaluator<Interval>> terms =
            model->evaluator<Interval>(model->motion({}).program, model->default_run().parameters);
        MotionTerms<Evaluator<Interval>> motion = terms;
        for (std::size_t i = 0; i < 12; ++i) {
            const double a = std::sin(3.0 * static_cast<double>(i)), r = 1e-9;
            motion.input(i) = Interval(a - r, a + r);
            motion.input(12 + i) = Interval(1.0 + a - r, 1.0 + a + r);
        }
        motion.run();
        for (std::size_t i = 0; i < 12; ++i) {
            EXPECT_LE(width(motion.acceleration(i)), 1.0) << i;
            EXPECT_TRUE(certainly_positive(motion.pivot(i))) << i;
        }
    }
}

// M = m (1 + delta_ij), so that (M^-1)_11 = 5/(6 m). The simplified equations do not contain the preconditioner.
TEST(Chains, SimplifyAsIfEliminated) {
    std::string coordinates, all = "x1'", kinetic = "m/2*x1'^2";
    for (int i = 1; i <= 5; ++i) coordinates += fmt::format("{{name = \"x{}\", start = 1}},", i);
    for (int i = 2; i <= 5; ++i) {
        all += fmt::format(" + x{}'", i);
        kinetic += fmt::format(" + m/2*x{}'^2", i);
    }
    const auto model =
        test::typed("title = \"five\"\ncoordinate = [" + coordinates +
                    "]\nparameter = [{name = \"m\", value = 3}]\nlagrangian.kinetic = \"" + kinetic + " + m/2*(" + all +
                    ")^2\"\nlagrangian.potential = \"0\"\nconstraint = [{gap = \"x1\", "
                    "restitution = 0}]\n");
    const Expression W = model->equations().free.contacts[0].W;
    Graph& graph = W.graph();
    const Expression m = graph.symbol(model->layout().parameter(0));
    EXPECT_TRUE(vanishes(W - graph.number(5, 6) / m));
    EXPECT_FALSE(vanishes(W - graph.number(5, 7) / m));
    EXPECT_NEAR(model->evaluator(Program(std::span(&W, 1), model->layout().slots()), std::vector{3.0}).output(0),
                5.0 / 18.0, 1e-15);
}

// Processor time, to which other programs of the machine add nothing.
class Stopwatch {
 public:
    double seconds() const { return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }

 private:
    std::clock_t begin_ = std::clock();
};

TEST(Chains, OfTwelveLinksAreDerivedInSeconds) {
    for (const Angles angles : {Angles::absolute, Angles::relative}) {
        const Stopwatch watch;
        const auto model = free_chain(12, angles);
        model->motion({});
        model->motion(Mode::holding(ContactSet::of(0)));
        model->bouncing();
        EXPECT_LT(watch.seconds(), max_seconds);
        EXPECT_LT(4 * model->equations().energy.graph().size(), 6000000u);
    }
}

TEST(Chains, OfEightLinksRunInLessThanASecond) {
    for (const Angles angles : {Angles::absolute, Angles::relative}) {
        const auto model = free_chain(8, angles);
        const Stopwatch watch;
        const Trajectory run = simulate(model, model->default_run());
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time);
#ifndef __SANITIZE_ADDRESS__
        EXPECT_LT(watch.seconds(), 1.0);
#endif
        EXPECT_LT(run.statistics.energy_drift, 1e-10);
    }
}

TEST(ChainsOfBodies, OfTwelveLinksAreDerivedInSeconds) {
    const Stopwatch watch;
    const auto model = test::typed(chain_of_bodies(12, 12, 1));
    model->motion({});
    model->motion(Mode::holding(ContactSet::of(0)));
    model->bouncing();
    EXPECT_LT(watch.seconds(), max_seconds);
    EXPECT_LT(4 * model->equations().energy.graph().size(), 6000000u);
}

TEST(ChainsOfBodies, MoveAsTheTypedChainDoesInLessThanASecond) {
    const auto model = test::typed(chain_of_bodies(8, 8, 20));
    const Stopwatch watch;
    const Trajectory run = simulate(model, model->default_run());
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time);
#ifndef __SANITIZE_ADDRESS__
    EXPECT_LT(watch.seconds(), 1.0);
#endif
    const auto typed = test::typed(chain(8, Angles::relative, 10, 2));
    const auto short_run = test::typed(chain_of_bodies(8, 8, 2));
    const State one = simulate(typed, typed->default_run()).end,
                two = simulate(short_run, short_run->default_run()).end;
    EXPECT_LT((one.q - two.q).norm(), 1e-8);
    EXPECT_LT((one.v - two.v).norm(), 1e-7);
}

// Too many coordinates, and equations that are too large, end with a message within seconds.
TEST(ChainsOfBodies, OfFortyLinksAreRefused) {
    const Stopwatch watch;
    const std::string forty = test::told(chain_of_bodies(40, 40, 1));
    EXPECT_EQ(forty.find("f.toml:18:14: more than 16 coordinates\n"), 0U) << forty;
    const std::string large = test::told(chain_of_bodies(40, 16, 1, true));
    EXPECT_NE(large.find("too large: it takes more than"), large.npos) << large;
    EXPECT_NE(large.find("link"), large.npos) << large;
    const std::string kinetic = test::told(chain_of_bodies(40, 16, 1));
    EXPECT_NE(kinetic.find("the kinetic energy of the bodies is too large: it takes more than"), kinetic.npos)
        << kinetic;
    EXPECT_LT(watch.seconds(), max_seconds);
}

// The same motion in both coordinates, with impacts, certified Zeno points and contact.
TEST(Chains, BounceAtAWall) {
    for (const int links : {8, 12}) {
        std::vector<Trajectory> runs;
        for (const Angles angles : {Angles::absolute, Angles::relative}) {
            const auto model = test::typed(chain(links, angles, 0.8, 2.6));
            runs.push_back(simulate(model, model->default_run()));
            EXPECT_EQ(runs.back().outcome.kind, Outcome::Kind::end_time) << runs.back().outcome.message;
        }
        std::vector<double> zeno[2];
        for (std::size_t k = 0; k < 2; ++k)
            for (const Event& event : runs[k].events)
                if (event.is_zeno()) {
                    zeno[k].push_back(event.t);
                    EXPECT_TRUE(event.certificate->certified);
                }
        ASSERT_GE(zeno[0].size(), 1u) << links;
        ASSERT_EQ(zeno[0].size(), zeno[1].size()) << links;
        for (std::size_t i = 0; i < zeno[0].size(); ++i) EXPECT_NEAR(zeno[0][i], zeno[1][i], 1e-6);
        EXPECT_NEAR((differences(runs[0].end.q) - runs[1].end.q).norm(), 0.0, 1e-5);
    }
}

TEST(Chains, HaveDerivatives) {
    const auto model = test::typed(chain(8, Angles::absolute, 0.8, 1.2));
    const Trajectory run = simulate(model, model->default_run());
    ASSERT_GE(run.events.size(), 1u);  // an impact
    const Derivatives derivatives = differentiate(run);
    ASSERT_EQ(derivatives.broken, "");
    auto other = model->default_run();
    constexpr double step = 1e-5;
    other.q[0] += step;
    const Vector up = simulate(model, other).end.q;
    other.q[0] -= 2 * step;
    const Vector down = simulate(model, other).end.q;
    for (Eigen::Index i = 0; i < 8; ++i)
        EXPECT_NEAR(derivatives.end->q(i, 0), (up[i] - down[i]) / (2 * step), 1e-4) << i;
}

}  // namespace
}  // namespace achilles
