// Impacts of several contacts, simultaneous and sequential: examples with known results, and laws on random systems.
#include "contacts/moreau.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "contacts/complementarity.hpp"
#include "core/contacts/some_contacts.hpp"

namespace achilles {
namespace {

using Matrix = ContactMatrix<double>;
using Forces = ContactVector<double>;
using Eigen::Index;
using SequenceEnd = ImpactSequence::SequenceEnd;

constexpr ContactSet nobody;

bool order_matters(const Matrix& W, const Matrix& radius, const Forces& e, ContactSet held, ContactSet landing) {
    return order_dependence(enclosure(W, radius), e, held, landing).matters();
}

void expect_near(const Forces& x, const Forces& expected) {
    ASSERT_EQ(x.size(), expected.size());
    for (Index j = 0; j < x.size(); ++j) EXPECT_NEAR(x[j], expected[j], 4e-16) << j;
}

// ---- the numbers of theory-gaps.md 2.4 ----

TEST(Moreau, RodDroppedFlat) {
    const Matrix W = pair_with(-0.5);
    const Forces e = numbers({0.5, 0.5}), before = numbers({-1.0, -1.0});
    EXPECT_EQ(moreau_impact(W, before, e, nobody)->hdot_after, numbers({0.5, 0.5}));
    const auto other = alternatives(W, before, e, nobody);
    ASSERT_EQ(other.size(), 2u);
    EXPECT_EQ(other[0].hdot_after, numbers({0.40625, 0.265625}));
    EXPECT_EQ(other[1].hdot_after, numbers({0.265625, 0.40625}));
    EXPECT_EQ(other[0].impacts, 3);
    EXPECT_EQ(other[0].end, SequenceEnd::finite);
}

TEST(Moreau, TallBlockDroppedFlat) {
    const Matrix W = pair_with(0.25);
    const Forces e = numbers({0.0, 0.0}), before = numbers({-1.0, -1.0});
    EXPECT_EQ(moreau_impact(W, before, e, nobody)->hdot_after, numbers({0.0, 0.0}));
    const auto other = alternatives(W, before, e, nobody);
    ASSERT_EQ(other.size(), 2u);
    EXPECT_EQ(other[0].hdot_after, numbers({0.1875, 0.0}));
    EXPECT_EQ(other[1].hdot_after, numbers({0.0, 0.1875}));
}

TEST(Moreau, LandingBesideAContactThatIsHeldOrNearlyHeld) {
    const Matrix W = pair_with(-0.3);
    const Forces e = numbers({0.5, 0.5}), before = numbers({0.0, -1.0});
    const auto held = moreau_impact(W, before, e, contacts({0}));
    EXPECT_EQ(held->hdot_after, numbers({0.0, 0.5}));
    EXPECT_TRUE(held->opened.empty());
    EXPECT_NEAR(held->impulses[0], 0.3 * held->impulses[1], 1e-15);
    expect_near(impacts_in_turn(W, before, e, nobody, 1)->hdot_after, numbers({0.225, 0.2975}));
    expect_near(impacts_in_turn(W, before, e, contacts({0}), 1)->hdot_after, numbers({0.0, 0.5}));
}

// Three equal balls with gaps x2 - x1 and x3 - x2. The first ball arrives with velocity 1.
TEST(Moreau, CradleOfThree) {
    Matrix W(2, 2);
    W << 2.0, -1.0, -1.0, 2.0;
    const Forces e = numbers({1.0, 1.0}), before = numbers({-1.0, 0.0});
    const auto velocities = [](const Forces& p) { return numbers({1.0 - p[0], p[0] - p[1], p[1]}); };
    const auto together = moreau_impact(W, before, e, nobody);
    expect_near(velocities(together->impulses), numbers({-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0}));
    const auto other = alternatives(W, before, e, nobody);
    ASSERT_EQ(other.size(), 1u);
    EXPECT_EQ(velocities(other[0].impulses), numbers({0.0, 0.0, 1.0}));
    EXPECT_TRUE(order_matters(W, Matrix::Zero(2, 2), e, nobody, contacts({0, 1})));
}

TEST(Moreau, OpensAHeldContactThatWouldHaveToPull) {
    const auto impact = moreau_impact(pair_with(0.5), numbers({0.0, -1.0}), numbers({0.3, 0.5}), contacts({0}));
    EXPECT_EQ(impact->hdot_after, numbers({0.75, 0.5}));
    EXPECT_EQ(impact->opened, contacts({0}));
    EXPECT_EQ(impact->active, contacts({1}));
    EXPECT_EQ(impact->impulses, numbers({0.0, 1.5}));
    EXPECT_EQ(impact->loss, 0.5 * 1.5 * 0.5);
}

// Rounding errors of hdot or W open no held contact.
TEST(Moreau, HoldsWhatIsHeldExactly) {
    const auto impact = moreau_impact(pair_with(1e-16), numbers({1e-17, -1.0}), numbers({0.5, 0.5}), contacts({0}));
    EXPECT_EQ(impact->hdot_after, numbers({0.0, 0.5}));
    EXPECT_TRUE(impact->opened.empty());
}

TEST(Moreau, SeparatingContactsGetNoImpulse) {
    const auto impact = moreau_impact(pair_with(-0.5), numbers({0.2, -1.0}), numbers({1.0, 1.0}), nobody);
    EXPECT_EQ(impact->impulses, numbers({0.0, 2.0}));
    EXPECT_EQ(impact->hdot_after, numbers({-0.8, 1.0}));  // a further impact follows
}

// A duplicated gap shares the impulse. In a slot without clearance no impulse satisfies the law.
TEST(Moreau, DependentGradients) {
    const auto twice = moreau_impact(pair_with(1.0), numbers({-1.0, -1.0}), numbers({0.5, 0.5}), nobody);
    EXPECT_FALSE(twice->unique);
    EXPECT_NEAR(twice->impulses[0], 0.75, 1e-15);
    EXPECT_NEAR(twice->impulses[1], 0.75, 1e-15);
    EXPECT_EQ(twice->hdot_after, numbers({0.5, 0.5}));
    EXPECT_EQ(twice->loss, 0.375);
    EXPECT_FALSE(moreau_impact(pair_with(-1.0), numbers({-1.0, -0.5}), numbers({1.0, 1.0}), nobody));
}

// Three equal balls: the impact sequence is infinite, without any force, if e <= 7 - 4 sqrt 3 = 0.0718 (theory-gaps.md
// 2.6).
TEST(Moreau, EndlessImpactsAreTakenToTheirLimit) {
    Matrix W(2, 2);
    W << 2.0, -1.0, -1.0, 2.0;
    const auto collapse = impacts_in_turn(W, numbers({-1.0, 0.0}), numbers({0.05, 0.05}), nobody, 0);
    EXPECT_EQ(collapse->end, SequenceEnd::limit);
    EXPECT_GT(collapse->impacts, 10);
    EXPECT_LT(collapse->hdot_after.maxCoeff(), 1e-10);
    EXPECT_GE(collapse->hdot_after.minCoeff(), 0.0);
    const auto separate = impacts_in_turn(W, numbers({-1.0, 0.0}), numbers({0.08, 0.08}), nobody, 0);
    EXPECT_EQ(separate->end, SequenceEnd::finite);
    // Elastic impacts in a narrow wedge: their number is about pi divided by the wedge angle.
    const auto wedge =
        impacts_in_turn(pair_with(-std::cos(0.001)), numbers({-1.0, 0.0}), numbers({1.0, 1.0}), nobody, 0);
    EXPECT_EQ(wedge->end, SequenceEnd::cut);
    EXPECT_EQ(wedge->impacts, ImpactSequence::most_impacts);
}

// After the first impact the other two contacts tie; their numbering must not decide the order.
TEST(Moreau, EqualClosingSpeedsCollideTogether) {
    Matrix W = Matrix::Constant(3, 3, -0.3);
    W.diagonal().setOnes();
    const auto turns = impacts_in_turn(W, -Forces::Ones(3), Forces::Constant(3, 0.5), nobody, 0);
    EXPECT_EQ(turns->hdot_after[1], turns->hdot_after[2]);
    EXPECT_NE(turns->hdot_after[0], turns->hdot_after[1]);
}

// ---- random systems ----

// Contacts of a random system with M = 1. v- is such that held contacts have hdot = 0.
struct Scene {
    Matrix G, W;
    Forces before, e;
    ContactSet held, landing;
};
Scene random_scene(std::mt19937& random) {
    const Index m = 1 + static_cast<Index>(random() % 8), n = m + static_cast<Index>(random() % 3) % (9 - m);
    Scene scene;
    scene.G = random_matrix(m, n, random);
    scene.W = scene.G * scene.G.transpose();
    scene.held = some_of(m, random);
    scene.before = -random_matrix(m, 1, random).cwiseAbs();
    scene.e = Forces::Zero(m);
    const bool plastic = random() % 3 == 0;
    for (Index j = 0; j < m; ++j) {
        if (!plastic) scene.e[j] = static_cast<double>(random() % 5) / 4.0;
        if (contains(scene.held, j)) scene.before[j] = 0.0;
        if (!contains(scene.held, j)) scene.landing = with(scene.landing, j);
    }
    return scene;
}

// Change of energy by the impulses p, where v+ = v- + G' p.
double change_of_energy(const Scene& scene, const Forces& p) { return p.dot(scene.before + 0.5 * scene.W * p); }

TEST(Moreau, LawsAtRandom) {
    std::mt19937 random(5);
    int opened = 0, unopened = 0;
    for (int run = 0; run < 10'000; ++run) {
        const Scene s = random_scene(random);
        const auto impact = moreau_impact(s.W, s.before, s.e, s.held);
        ASSERT_TRUE(impact) << run;
        const double size = impact->impulses.maxCoeff() * s.W.diagonal().maxCoeff() + s.before.cwiseAbs().maxCoeff();
        ASSERT_GE(impact->impulses.minCoeff(), 0.0) << run;
        ASSERT_GE(impact->loss, 0.0) << run;
        ASSERT_LE((s.before + s.W * impact->impulses - impact->hdot_after).cwiseAbs().maxCoeff(), 1e-12 * size) << run;
        for (Index j = 0; j < s.e.size(); ++j) {
            ASSERT_GE(impact->hdot_after[j], -s.e[j] * s.before[j]) << run;
            const bool bounces = impact->hdot_after[j] == -s.e[j] * s.before[j];
            ASSERT_TRUE(bounces || !contains(impact->active, j)) << run;
        }
        ASSERT_NEAR(change_of_energy(s, impact->impulses), -impact->loss, 1e-12 * impact->impulses.maxCoeff() * size);
        (impact->opened.empty() ? unopened : opened) += 1;

        const Order order = random_order(s.e.size(), random);
        const auto same = moreau_impact(renumbered(s.W, order), renumbered(s.before, order), renumbered(s.e, order),
                                        renumbered(s.held, order, s.e.size()));
        ASSERT_LE((same->hdot_after - renumbered(impact->hdot_after, order)).cwiseAbs().maxCoeff(), 1e-11 * size)
            << run;
        ASSERT_EQ(same->opened, renumbered(impact->opened, order, s.e.size())) << run;
    }
    EXPECT_GT(opened, 1000);
    EXPECT_GT(unopened, 1000);
}

// g_i n_i^A = 1 and g_j n_i^A = 0. If no kappa is negative, v+ = v- - (1 + e_i) hdot_i n_i^A.
TEST(Moreau, TransmissionAtRandom) {
    std::mt19937 random(6);
    int stays = 0;
    for (int run = 0; run < 2'000; ++run) {
        const Scene s = random_scene(random);
        const Index m = s.e.size(), i = static_cast<Index>(random() % static_cast<unsigned>(m));
        const ContactSet held = without(all_contacts(m), i);
        const auto block = HeldBlock<double>::of(s.W, held);
        ASSERT_TRUE(block) << run;
        const auto [kappa, W] = block->transmission(s.W, i);
        if (W < 1e-4) continue;
        const Matrix n = (s.G.row(i).transpose() + s.G.transpose() * kappa) / W;
        const Forces along = s.G * n;
        for (Index j = 0; j < m; ++j) ASSERT_NEAR(along[j], j == i ? 1.0 : 0.0, 1e-9) << run;
        Forces before = Forces::Zero(m);
        before[i] = -1.0;
        const auto impact = moreau_impact(s.W, before, s.e, held);
        const bool pulls = kappa.minCoeff() < 0.0;
        ASSERT_EQ(impact->opened.empty(), !pulls) << run;
        if (pulls) continue;
        ++stays;
        Forces expected = (1.0 + s.e[i]) / W * kappa;
        expected[i] = (1.0 + s.e[i]) / W;
        ASSERT_EQ(impact->impulses, expected) << run;
        const auto solved = solve_complementarity(s.W, (before + s.e.cwiseProduct(before)).eval());
        ASSERT_LE((solved->p - impact->impulses).cwiseAbs().maxCoeff(), 1e-9 * impact->impulses.maxCoeff()) << run;
    }
    EXPECT_GT(stays, 200);
}

// If the order is proved not to matter, every choice of the first contact gives the result of Moreau's law.
TEST(Moreau, IndependentLandingsEndAlikeInAnyOrder) {
    std::mt19937 random(7);
    int independent = 0, dependent = 0;
    for (int run = 0; run < 8'000; ++run) {
        Scene s = random_scene(random);
        const Index m = s.e.size();
        if (s.landing.count() < 2) continue;
        if (random() % 2 == 0) {  // impacting contacts coupled only through held contacts
            for (Index i = 0; i < m; ++i)
                for (Index k = 0; k < m; ++k)
                    if (i != k && contains(s.landing, i) != contains(s.held, k)) s.W(i, k) = s.W(k, i) = 0.0;
            if (random() % 2 == 0)
                for (Index i = 0; i < m; ++i)
                    for (Index k = 0; k < m; ++k)
                        if (i != k && contains(s.landing, i) && contains(s.landing, k)) s.W(i, k) = 0.0;
        }
        if (!HeldBlock<double>::of(s.W, all_contacts(m), 1e-3)) continue;
        const bool matters = order_matters(s.W, Matrix::Zero(m, m), s.e, s.held, s.landing);
        const auto together = moreau_impact(s.W, s.before, s.e, s.held);
        double apart = 0.0;
        for (const ImpactSequence& turns : alternatives(s.W, s.before, s.e, s.held))
            apart = std::max(apart, (turns.hdot_after - together->hdot_after).cwiseAbs().maxCoeff());
        ASSERT_TRUE(matters || apart <= 1e-9 * (1.0 + together->hdot_after.maxCoeff())) << run;
        independent += !matters;
        dependent += matters && apart > 1e-6;
    }
    EXPECT_GT(independent, 120);
    EXPECT_GT(dependent, 1200);
}

// Energy never increases, whichever contact comes first.
TEST(Moreau, SequencesLoseEnergy) {
    std::mt19937 random(8);
    int finite = 0;
    for (int run = 0; run < 2'000; ++run) {
        const Scene s = random_scene(random);
        if (!HeldBlock<double>::of(s.W, all_contacts(s.e.size()), 1e-4)) continue;
        for (const ImpactSequence& turns : alternatives(s.W, s.before, s.e, s.held)) {
            if (turns.end == SequenceEnd::cut) continue;
            ++finite;
            ASSERT_GE(turns.hdot_after.minCoeff(), 0.0) << run;
            ASSERT_GE(turns.impulses.minCoeff(), 0.0) << run;
            ASSERT_LE(change_of_energy(s, turns.impulses), 1e-9 * turns.impulses.maxCoeff()) << run;
        }
    }
    EXPECT_GT(finite, 1000);
}

// The order of the impacts depends neither on the numbering of the contacts nor on the units of their gaps.
TEST(Moreau, SequencesDoNotDependOnNumbersOrUnits) {
    std::mt19937 random(10);
    int compared = 0;
    for (int run = 0; run < 500; ++run) {
        const Scene s = random_scene(random);
        const Index m = s.e.size();
        if (!HeldBlock<double>::of(s.W, all_contacts(m), 1e-2)) continue;
        const Order order = random_order(m, random);
        Forces unit(m);
        for (Index j = 0; j < m; ++j) unit[j] = std::exp2(static_cast<double>(random() % 11) - 5.0);
        const Matrix W = renumbered((unit.asDiagonal() * s.W * unit.asDiagonal()).eval(), order);
        const Forces before = renumbered(unit.cwiseProduct(s.before).eval(), order);
        const ContactSet held = renumbered(s.held, order, m);
        for (Index i = 0; i < m; ++i) {
            if (contains(held, i)) continue;
            const auto turns = impacts_in_turn(s.W, s.before, s.e, s.held, at(order, i));
            const auto same = impacts_in_turn(W, before, renumbered(s.e, order), held, i);
            ASSERT_EQ(turns->end, same->end) << run;
            const Forces expected = renumbered(unit.cwiseProduct(turns->hdot_after).eval(), order);
            ASSERT_LE((same->hdot_after - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.maxCoeff() + 1e-8) << run;
            ++compared;
        }
    }
    EXPECT_GT(compared, 500);
}

// ---- dependence on the order of impacts ----

TEST(ImpactOrder, DependsOnTheSignOfTheCoupling) {
    const Matrix exact = Matrix::Zero(2, 2);
    const Forces plastic = numbers({0.0, 0.0}), elastic = numbers({0.0, 0.5});
    const ContactSet both = contacts({0, 1});
    EXPECT_FALSE(order_matters(pair_with(0.0), exact, elastic, nobody, both));
    EXPECT_TRUE(order_matters(pair_with(-0.3), exact, elastic, nobody, both));
    EXPECT_FALSE(order_matters(pair_with(-0.3), exact, plastic, nobody, both));
    EXPECT_TRUE(order_matters(pair_with(0.3), exact, plastic, nobody, both));
    // One contact impacts, the other is held: kappa = -W12.
    EXPECT_FALSE(order_matters(pair_with(-0.3), exact, elastic, contacts({0}), contacts({1})));
    EXPECT_TRUE(order_matters(pair_with(0.3), exact, elastic, contacts({0}), contacts({1})));
    // Coupling through a held contact A: W12^A = W12 - W1A WA2/WAA.
    Matrix W = Matrix::Identity(3, 3);
    W(0, 1) = W(1, 0) = 0.0625;
    W(0, 2) = W(2, 0) = W(1, 2) = W(2, 1) = -0.25;
    EXPECT_FALSE(order_matters(W, Matrix::Zero(3, 3), numbers({0.5, 0.5, 0.5}), contacts({2}), both));
    W(0, 1) = W(1, 0) = 0.0;
    EXPECT_TRUE(order_matters(W, Matrix::Zero(3, 3), numbers({0.5, 0.5, 0.5}), contacts({2}), both));
}

TEST(ImpactOrder, CountsRoundingAsZeroAndSaysSo) {
    const Forces e = numbers({0.5, 0.5});
    const ContactSet both = contacts({0, 1});
    const auto with_radius = [&](double W12, double radius) {
        Matrix radii = Matrix::Zero(2, 2);
        radii(0, 1) = radii(1, 0) = radius;
        return order_dependence(enclosure(pair_with(W12), radii), e, nobody, both);
    };
    EXPECT_FALSE(with_radius(1e-16, 1e-15).matters());
    EXPECT_TRUE(with_radius(1e-16, 1e-15).rounded_zero);
    EXPECT_FALSE(with_radius(0.0, 0.0).rounded_zero);
    EXPECT_FALSE(with_radius(0.0, 0.0).matters());
    EXPECT_TRUE(with_radius(1e-15, 1e-16).matters());  // proved nonzero
    EXPECT_TRUE(with_radius(0.0, 1e-12).matters());    // possibly nonzero
    EXPECT_FALSE(with_radius(0.0, 1e-12).rounded_zero);
    // With linearly dependent held contacts nothing is proved.
    const auto twice = order_dependence(enclosure(pair_with(1.0), Matrix::Zero(2, 2)), e, both, nobody);
    EXPECT_TRUE(twice.by_transmission);
}

// Equal elastic balls in a row exchange velocities until these are in order. The fastest approach is resolved next.
TEST(Moreau, InTurnTheFastestIsNext) {
    ContactMatrix<double> W(3, 3);
    W << 2, -1, 0, -1, 2, -1, 0, -1, 2;
    ContactVector<double> hdot(3), e(3);
    hdot << -1, 0, -0.3;  // velocities 0, -1, -1, -1.3
    e << 1, 1, 1;
    const auto sequence = impacts_in_turn(W, hdot, e, {}, 0);
    ASSERT_TRUE(sequence);
    EXPECT_EQ(sequence->impacts, 5);
    EXPECT_NEAR(sequence->hdot_after[0], 0.3, 1e-12);
    EXPECT_NEAR(sequence->hdot_after[1], 0.0, 1e-12);
    EXPECT_NEAR(sequence->hdot_after[2], 1.0, 1e-12);
}

}  // namespace
}  // namespace achilles
