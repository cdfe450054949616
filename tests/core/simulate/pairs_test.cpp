// Two chattering contacts come to rest (theory-gaps.md 2.6 and 3).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "certify/two_contacts.hpp"
#include "contacts/moreau.hpp"
#include "core/systems.hpp"
#include "floor/laws.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

std::shared_ptr<const Model> system_of(const std::string& coordinates, const std::string& lagrangian,
                                       const std::string& gaps) {
    return std::make_shared<const Model>(
        parse_system("title = \"two contacts\"\n" + coordinates + "[lagrangian]\n" + lagrangian + gaps));
}

// A rod of length 1, mass 1 and this moment of inertia above a floor: W12/W11 = (J - 1/4)/(J + 1/4), g = 1. The floor
// may rise at a constant rate, and the rod with it.
std::shared_ptr<const Model> rod(const std::string& inertia, const std::string& e_left = "0.5",
                                 const std::string& rise = "0") {
    return system_of(
        "[[coordinate]]\nname = \"y\"\nstart = 1\nrate = " + rise + "\n[[coordinate]]\nname = \"th\"\n",
        "kinetic = \"y'^2/2 + " + inertia + "/2*th'^2\"\npotential = \"y\"\n",
        "[[constraint]]\nname = \"left\"\ngap = \"y - " + rise + "*t - sin(th)/2\"\nrestitution = " + e_left +
            "\n[[constraint]]\nname = \"right\"\ngap = \"y - " + rise + "*t + sin(th)/2\"\nrestitution = 0.5\n");
}

// A ball between two planes of this slope.
std::shared_ptr<const Model> wedge(const std::string& slope) {
    return system_of(
        "[[coordinate]]\nname = \"x\"\nstart = 0.1\nrate = 0.3\n[[coordinate]]\nname = \"y\"\nstart = 1.5\n",
        "kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n",
        "[[constraint]]\nname = \"left\"\ngap = \"y + " + slope + "*x\"\nrestitution = 0.5\n" +
            "[[constraint]]\nname = \"right\"\ngap = \"y - " + slope + "*x\"\nrestitution = 0.5\n");
}

Trajectory run_to(const std::shared_ptr<const Model>& model, double end, double tilt = 0.0) {
    auto run = model->default_run();
    run.options.end_time = end;
    if (tilt != 0.0) run.q[1] = tilt;
    return simulate(model, run);
}

const ContactSet both = ContactSet::of(0).with(1);

// Dropped flat, the rod falls for sqrt(2) s and bounces for another 2 sqrt(2) s. The certificate encloses that time.
TEST(Pairs, ARodDroppedFlatComesToRest) {
    for (const char* inertia : {"(1/12)", "0.5"}) {  // acute, obtuse contact pair (sign of W12)
        const Trajectory trajectory = run_to(rod(inertia), 10.0);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        EXPECT_EQ(trajectory.end_mode.held(), both);
        const auto rests = test::events_of(trajectory, Event::Kind::zeno);
        ASSERT_EQ(rests.size(), 1u);
        EXPECT_EQ(rests[0].contacts, both);
        EXPECT_EQ(rests[0].mode.held(), both);
        EXPECT_NEAR(rests[0].t, 3.0 * std::sqrt(2.0), 1e-9);
        EXPECT_LE(rests[0].certificate->zeno_low, 3.0 * std::sqrt(2.0));
        EXPECT_GE(rests[0].certificate->zeno_high, 3.0 * std::sqrt(2.0));
        EXPECT_LE(rests[0].certificate->zeno_high - rests[0].certificate->zeno_low, 2e-6);
        EXPECT_NEAR(trajectory.loss, 1.0, 1e-12);  // the whole initial energy
    }
}

// Tilted rods too. With an obtuse pair, Zeno points of single contacts are undone by the other one until both rest.
TEST(Pairs, TiltedRodsAndBallsInWedgesComeToRest) {
    for (const double tilt : {0.05, 0.2, -0.3})
        for (const char* inertia : {"(1/12)", "0.1", "0.3", "0.5"}) {
            const Trajectory trajectory = run_to(rod(inertia), 40.0, tilt);
            ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << inertia << " " << trajectory.outcome.message;
            EXPECT_EQ(trajectory.end_mode.held(), both) << inertia << " " << tilt;
            EXPECT_NEAR(trajectory.end.q.norm() + trajectory.end.v.norm(), 0.0, 1e-12);
        }
    for (const char* slope : {"0.2", "0.3", "1", "3"}) {
        const Trajectory trajectory = run_to(wedge(slope), 60.0);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << slope << " " << trajectory.outcome.message;
        EXPECT_EQ(trajectory.end_mode.held(), both) << slope;
        EXPECT_NEAR(trajectory.end.q.norm() + trajectory.end.v.norm(), 0.0, 1e-12);
    }
    const Trajectory wide = run_to(wedge("0.2"), 60.0);
    EXPECT_GT(test::events_of(wide, Event::Kind::zeno).size(), 10u);
}

// With constant a and W the bound is proportional to r0, and no chatter lasts longer. Both contacts bouncing together
// take 2 e w/(a (1 - e)).
TEST(Pairs, TheBoundHoldsForThoseThatBounceTogether) {
    for (const double c : {-0.8, -0.3, 0.0, 0.25, 0.8})
        for (const double e : {0.1, 0.5, 0.8}) {
            PairAtCollision pair;
            const double w = 1e-3;
            pair.a = {Interval(1.0), Interval(1.0)};
            pair.lambda = {Interval(1.0 / (1.0 + c)), Interval(1.0 / (1.0 + c))};
            pair.e = {Interval(e), Interval(e)};
            pair.W = {{{Interval(1.0), Interval(c)}, {Interval(c), Interval(1.0)}}};
            pair.r0 = Interval(w * std::sqrt(2.0 / (1.0 + c)));
            const auto bound = pair_bound(pair);
            ASSERT_TRUE(bound) << c << " " << e;
            EXPECT_GE(bound->T.hi(), 2.0 * e * w / (1.0 - e));
            pair.r0 = Interval(2.0) * pair.r0;
            EXPECT_NEAR(pair_bound(pair)->T.hi() / bound->T.hi(), 2.0, 1e-12);
            EXPECT_NEAR(pair_bound(pair)->J.hi() / bound->J.hi(), 8.0, 1e-12);
            // With varying a and W the bound is larger, until nothing is proved.
            pair.Delta = Interval(1e-6);
            pair.omega = Interval(1e-6);
            const auto rough = pair_bound(pair);
            ASSERT_TRUE(rough);
            EXPECT_GE(rough->T.hi(), 2.0 * bound->T.hi());
            pair.Delta = pair.omega = Interval(0.3);
            EXPECT_FALSE(pair_bound(pair));
        }
}

// A simultaneous impact takes at least the part (1 - e)/(1 + e) of p' W p/2, where e is the larger restitution. Also p'
// W p >= ((1 + e_i) hdot_i)^2/W_ii. The bound for unequal restitutions is based on these two.
TEST(Pairs, AnImpactOfBothTakesItsPart) {
    std::mt19937 random(5);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    double least = 10.0;
    for (int i = 0; i < 10000; ++i) {
        ContactMatrix<double> W(2, 2);
        const double ratio = uniform(0.3, 3.0), c = uniform(-0.99, 0.99) * ratio;
        W << 1.0, c, c, ratio * ratio;
        ContactVector<double> hdot(2), e(2);
        hdot << -uniform(0.0, 1.0), -uniform(0.0, 1.0);
        e << uniform(0.0, 1.0), uniform(0.0, 1.0);
        const auto impact = moreau_impact(W, hdot, e, {});
        ASSERT_TRUE(impact);
        const double part = (1.0 - e.maxCoeff()) / (1.0 + e.maxCoeff());
        for (int k = 0; k < 2; ++k) {
            const double speed = (1.0 + e[k]) * hdot[k], bound = part * speed * speed / (2.0 * W(k, k));
            EXPECT_GE(impact->loss, bound * (1.0 - 1e-12));
            least = std::min(least, impact->loss / bound);
        }
    }
    EXPECT_LT(least, 1.01);  // the bound is attained
}

TEST(Pairs, UnequalRestitutionsComeToRestToo) {
    for (const char* inertia : {"(1/12)", "0.1", "0.3", "0.5"})
        for (const double tilt : {0.0, 0.05, -0.2}) {
            auto run = rod(inertia, "0.3")->default_run();
            run.options.end_time = 40.0;
            run.q[1] = tilt;
            const Trajectory trajectory = simulate(rod(inertia, "0.3"), run);
            ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << inertia << " " << trajectory.outcome.message;
            EXPECT_EQ(trajectory.end_mode.held(), both) << inertia << " " << tilt;
            EXPECT_NEAR(trajectory.loss, 1.0, 1e-9);
            // With an earlier cut, the certificate encloses the time of rest.
            run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-4;
            const Trajectory early = simulate(rod(inertia, "0.3"), run);
            const auto certificate = test::events_of(early, Event::Kind::zeno).back().certificate;
            const auto rest = test::events_of(trajectory, Event::Kind::zeno).back();
            EXPECT_LE(certificate->zeno_low, rest.certificate->zeno_high);
            EXPECT_GE(certificate->zeno_high, rest.certificate->zeno_low);
        }
}

// A pair restarts from another position and velocity: the energy balance includes the change by both, and the work of a
// rising floor.
TEST(Pairs, TheirRestBalancesTheEnergy) {
    for (const char* rise : {"0", "0.7"})
        for (const char* inertia : {"(1/12)", "0.5"})
            for (const double tilt : {0.0, 0.05, 0.2}) {
                const auto model = rod(inertia, "0.5", rise);
                auto run = model->default_run();
                run.options.tolerance = 1e-12;
                run.options.end_time = 40.0;
                run.q[1] = tilt;
                run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-4;
                const Trajectory trajectory = simulate(model, run);
                ASSERT_EQ(trajectory.end_mode.held(), both) << trajectory.outcome.message;
                const auto violations = test::energy(trajectory);
                EXPECT_TRUE(violations.empty()) << rise << " " << inertia << " " << tilt << ": " << violations.front();
                EXPECT_NEAR(trajectory.loss, 1.0, 1e-8);
            }
}

// Three equal balls exchange infinitely many impacts in a finite time if e < 7 - 4 sqrt 3, without any force. Their
// limit is known: equal speeds, after the time of theory-collapse.md 1.
TEST(Pairs, ThreeBallsCollapseWithoutAForce) {
    for (const double e : {0.001, 0.01, 0.05}) {
        const auto model = system_of(
            "[[coordinate]]\nname = \"x1\"\nrate = 1\n[[coordinate]]\nname = \"x2\"\nstart = 1.001\n"
            "[[coordinate]]\nname = \"x3\"\nstart = 2.003\n",
            "kinetic = \"(x1'^2 + x2'^2 + x3'^2)/2\"\npotential = \"0\"\n",
            fmt::format("[[constraint]]\nname = \"first\"\ngap = \"x2 - x1 - 1\"\nrestitution = {0}\n"
                        "[[constraint]]\nname = \"second\"\ngap = \"x3 - x2 - 1\"\nrestitution = {0}\n",
                        e));
        const Trajectory trajectory = simulate(model, model->default_run());
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << e << " " << trajectory.outcome.message;
        const auto collapses = test::events_of(trajectory, Event::Kind::collapse);
        ASSERT_EQ(collapses.size(), 1u) << e;
        const double k = (1.0 + e) / 2.0, sum = k * k - 2.0 * e;
        const double mu = 0.5 * (sum + std::sqrt(sum * sum - 4.0 * e * e)), nu = (mu + e) / (mu * k);
        EXPECT_NEAR(collapses[0].t, 0.001 + 0.002 / (k - nu * e), 1e-9) << e;
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(trajectory.end.v[i], 1.0 / 3.0, 1e-12) << e;
        EXPECT_NEAR(trajectory.loss, 1.0 / 3.0, 1e-12) << e;
    }
}

// The formulas of theory-gaps.md 3 with r0 = 1 and Delta = omega = 0, evaluated by another program.
TEST(Pairs, TheBoundIsThatOfTheTheory) {
    struct PairReference {
        double a[2], W[3], e[2], T;
    };
    const PairReference all[] = {{{1.0, 1.0}, {1.0, 0.5, 1.0}, {0.5, 0.5}, 78.044111382075},
                                 {{1.0, 1.3}, {1.0, -0.6, 2.0}, {0.5, 0.5}, 46.927026349887},
                                 {{1.0, 1.3}, {1.0, 0.4, 2.0}, {0.3, 0.6}, 88.202842317443},
                                 // no force closes the second gap while the first one is open
                                 {{1.0, 0.0}, {1.0, -1.0, 1.5}, {0.5, 0.4}, 151.816179201},
                                 {{1.5, -0.02}, {2.0, -0.5, 1.0}, {0.3, 0.6}, 166.003114177}};
    for (const auto& [a, W, e, T] : all) {
        PairAtCollision pair;
        const double det = W[0] * W[2] - W[1] * W[1];
        pair.a = {Interval(a[0]), Interval(a[1])};
        pair.lambda = {Interval((W[2] * a[0] - W[1] * a[1]) / det), Interval((W[0] * a[1] - W[1] * a[0]) / det)};
        pair.e = {Interval(e[0]), Interval(e[1])};
        pair.W = {{{Interval(W[0]), Interval(W[1])}, {Interval(W[1]), Interval(W[2])}}};
        pair.r0 = Interval(1.0);
        ASSERT_TRUE(pair_bound(pair));
        EXPECT_NEAR(pair_bound(pair)->T.hi(), T, 2e-9 * T);
    }
}

// One block falls on another. In flight both fall equally, so hddot of the upper contact is 0.
std::shared_ptr<const Model> two_blocks(const std::string& lower, const std::string& upper, int height = 0) {
    return system_of("[[coordinate]]\nname = \"y1\"\nstart = 0.3\n[[coordinate]]\nname = \"y2\"\nstart = " +
                         std::to_string(height + 1) +
                         "\n"
                         "[[parameter]]\nname = \"m1\"\nvalue = 1.0\n[[parameter]]\nname = \"m2\"\nvalue = 2.0\n",
                     "kinetic = \"(m1*y1'^2 + m2*y2'^2)/2\"\npotential = \"9.81*(m1*y1 + m2*y2)\"\n",
                     "[[constraint]]\nname = \"floor\"\ngap = \"y1\"\nrestitution = " + lower +
                         "\n[[constraint]]\nname = \"top\"\ngap = \"y2 - y1 - 0.2 - " + std::to_string(height) +
                         "\"\nrestitution = " + upper + "\n[run]\nend_time = 8\n");
}

TEST(Pairs, ABlockOnABlockComesToRest) {
    for (const auto& [lower, upper] : {std::pair("0.5", "0.4"), {"0.2", "0.7"}, {"0.8", "0.0"}, {"0.0", "0.3"}}) {
        const auto model = two_blocks(lower, upper);
        auto run = model->default_run();
        std::vector<Trajectory> trajectories;
        for (const Method method : test::both_methods) {
            run.options.method = method;
            trajectories.push_back(simulate(model, run));
            const Trajectory& trajectory = trajectories.back();
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
            EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(0).with(1)) << lower << ", " << upper;
            EXPECT_NEAR(trajectory.loss, 9.81 * (0.3 + 2.0 * 0.8), 1e-9);
        }
        ASSERT_EQ(trajectories[0].events.size(), trajectories[1].events.size());
        EXPECT_NEAR(trajectories[0].events.back().t, trajectories[1].events.back().t, 1e-6);
    }
}

// The gap is known only to 1e-13, so rounding would keep the blocks bouncing forever. The sequence is cut at the
// resolution.
TEST(Pairs, RoundingsDoNotKeepBlocksBouncing) {
    const auto model = two_blocks("0.5", "0.4", 1000);
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_LT(trajectory.statistics.impacts, 100);
    ASSERT_TRUE(trajectory.events.back().certificate);
    EXPECT_TRUE(trajectory.events.back().certificate->cut_at_resolution);
}

TEST(Pairs, NothingIsClaimedOfElasticImpactsOrOfWhatIsNotPressed) {
    PairAtCollision pair;
    pair.a = pair.lambda = {Interval(1.0), Interval(1.0)};
    pair.W = {{{Interval(1.0), Interval(0.0)}, {Interval(0.0), Interval(1.0)}}};
    pair.r0 = Interval(1e-3);
    pair.e = {Interval(0.5), Interval(1.0)};
    EXPECT_FALSE(pair_bound(pair));
    pair.e = {Interval(0.5), Interval(0.5)};
    const double equal = pair_bound(pair)->T.hi();
    pair.e = {Interval(0.5), Interval(0.6)};
    EXPECT_GT(pair_bound(pair)->T.hi(), equal);
    pair.a[1] = Interval(-1.0);
    EXPECT_FALSE(pair_bound(pair));
}

}  // namespace
}  // namespace achilles
