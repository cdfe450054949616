// A sentence for every event, and the energy in it.
#include "output/event_descriptions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/multi_contact.hpp"
#include "core/systems.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

Trajectory run_of(const std::string& system) {
    const auto model = test::load(system);
    return simulate(model, model->default_run());
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class GalleryDescriptions : public testing::TestWithParam<std::string> {};

// A sentence says "certified" exactly for certified events, with a bound that the certificate's time interval
// satisfies.
TEST_P(GalleryDescriptions, ProveNoMoreThanTheCertificate) {
    const Trajectory trajectory = run_of(GetParam());
    const EventDescriptions sentences(trajectory);
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        const std::string text = sentences.of(i);
        const std::string proved = "certified to ";
        const std::size_t at = text.find(proved);
        const bool may = event.kind == Event::Kind::zeno && !is_plastic_landing(event) && event.certificate->certified;
        ASSERT_EQ(at != std::string::npos, may) << text;
        if (!may) continue;
        const double bound = std::strtod(text.c_str() + at + proved.size(), nullptr);
        EXPECT_LE(event.certificate->zeno_high - event.t, bound) << text;
        EXPECT_LE(event.t - event.certificate->zeno_low, bound) << text;
        EXPECT_LE(bound, 1.11 * *proved_time(event)) << text;
        EXPECT_TRUE(holds(text, " s from the cut")) << text;
    }
}

// Contacts are named if there are several, and the impacts of a bounce sequence are counted.
TEST_P(GalleryDescriptions, NameContactsAndCountImpacts) {
    const Trajectory trajectory = run_of(GetParam());
    const Model& model = *trajectory.model;
    const EventDescriptions sentences(trajectory);
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        const std::string text = sentences.of(i);
        if (model.contacts() > 1) {
            for (const std::string& name : contact_names(model, event.contacts)) EXPECT_TRUE(holds(text, name)) << text;
        }
        for (const std::string& name : contact_names(model, event.opened)) EXPECT_TRUE(holds(text, name)) << text;
        if (event.kind == Event::Kind::zeno && !is_plastic_landing(event) && model.contacts() == 1) {
            EXPECT_EQ(bounce_sequence_of(trajectory, i).impacts, event.impacts) << text;
        }
    }
}

// The losses of all events sum to the loss of the run. The loss of a bounce sequence is that of its impacts.
TEST_P(GalleryDescriptions, LeaveNoEnergyOut) {
    const Trajectory trajectory = run_of(GetParam());
    double all = 0.0;
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const double lost = energy_lost(trajectory, i);
        EXPECT_GE(lost, -1e-10 * std::max(1.0, trajectory.loss)) << i;
        all += lost;
        if (trajectory.events[i].kind != Event::Kind::zeno || trajectory.model->contacts() > 1) continue;
        const BounceSequence pile = bounce_sequence_of(trajectory, i);
        EXPECT_NEAR(pile.loss,
                    trajectory.events[i].loss - (pile.first > 0 ? trajectory.events[pile.first - 1].loss : 0.0),
                    1e-12 * std::max(1.0, trajectory.loss));
    }
    EXPECT_NEAR(all, trajectory.loss, 1e-12 * std::max(1.0, trajectory.loss));
    // E(t) - E(start) = work - loss at any instant.
    EnergyBalance balance(*trajectory.model, trajectory.run);
    Sampler sampler(trajectory);
    const double start = trajectory.run.options.start_time;
    const Energies first = balance.at(sampler.at(start));
    for (const double share : {0.21, 0.5, 0.83, 1.0}) {
        const Energies now = balance.at(sampler.at(start + share * (trajectory.end_time - start)));
        const double size = std::max({1.0, std::abs(now.kinetic), std::abs(now.potential), std::abs(now.work)});
        EXPECT_NEAR(now.total() - first.total(), now.work - now.loss, 1e-6 * size) << share;
    }
}

INSTANTIATE_TEST_SUITE_P(Systems, GalleryDescriptions,
                         testing::Values("ball_on_sine", "double_pendulum_two_stops", "kneed_leg", "box_dropped_flat",
                                         "driven_double_pendulum", "ball_on_table"));

TEST(Sentences, SayWhatAPersonWould) {
    const Trajectory trajectory = run_of("ball_on_sine");
    const EventDescriptions sentences(trajectory);
    std::size_t zeno = 0;
    while (trajectory.events[zeno].kind != Event::Kind::zeno) ++zeno;
    const std::string text = sentences.of(zeno);
    EXPECT_EQ(text.find("contact begins: 9 impacts before the cut, 0.301 J lost, certified to "), 0U) << text;
    EXPECT_TRUE(holds(text, " J lost, certified to ")) << text;
    EXPECT_EQ(sentences.of(zeno + 1), "contact ends: the contact force reaches zero");
    EXPECT_TRUE(holds(sentences.of(0), "impact at gap speed ")) << sentences.of(0);
    EXPECT_TRUE(holds(sentences.of(0), " m/s, ")) << sentences.of(0);
    EXPECT_TRUE(holds(sentences.of(zeno - 1), "; the impact sequence is cut here")) << sentences.of(zeno - 1);
    EXPECT_EQ(sentences.start(), "start at 0 s: in free flight");
    EXPECT_EQ(sentences.end(), "end at 20 s: in contact");
    EXPECT_TRUE(holds(summary(trajectory), text)) << "the command line says the same";
    EXPECT_EQ(sentences.impacts(), "21 impacts before the cuts");
    EXPECT_TRUE(holds(summary(trajectory), "\n21 impacts before the cuts, ")) << summary(trajectory);
}

// Uncertified events are not called certified, and sentences mention conventions that decided.
TEST(Sentences, SayWhatIsNotProved) {
    Trajectory trajectory = run_of("ball_on_sine");
    std::size_t zeno = 0;
    while (trajectory.events[zeno].kind != Event::Kind::zeno) ++zeno;
    trajectory.events[zeno].certificate->certified = false;
    EXPECT_TRUE(holds(EventDescriptions(trajectory).of(zeno), "not certified"));
    EXPECT_FALSE(holds(EventDescriptions(trajectory).of(zeno), "certified to"));
    trajectory.events[zeno].certificate->certified = true;
    auto joint = std::make_shared<MultiContactInfo>();
    joint->order_matters = true;
    trajectory.events[0].joint = joint;
    EXPECT_TRUE(holds(EventDescriptions(trajectory).of(zeno), "given Moreau's law at event 1"));
    EXPECT_TRUE(holds(EventDescriptions(trajectory).of(0), "order-dependent outcome"));
}

TEST(Sentences, TellLandingsAndEarlyEnds) {
    const auto model = test::load("ball_on_floor");
    achilles::Run run = model->default_run();
    const auto& names = model->description().parameters;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].name == "e") run.parameters[i] = 0.0;
    const Trajectory landing = simulate(model, run);
    std::string all;
    for (std::size_t i = 0; i < landing.events.size(); ++i) all += EventDescriptions(landing).of(i) + "\n";
    EXPECT_TRUE(holds(all, "contact begins: plastic impact\n")) << all;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].name == "e") run.parameters[i] = 1.0;
    run.options.max_impacts = 3;
    const Trajectory elastic = simulate(model, run);
    EXPECT_FALSE(holds(EventDescriptions(elastic).of(0), "lost"))
        << "an elastic impact loses nothing: " << EventDescriptions(elastic).of(0);
    EXPECT_TRUE(holds(EventDescriptions(elastic).end(), "the run ends early: too many impacts"))
        << EventDescriptions(elastic).end();
}

TEST(Sentences, HaveTheWordsOfTheFile) {
    const Trajectory trajectory = run_of("double_pendulum");
    const EventDescriptions sentences(trajectory);
    std::size_t zeno = 0;
    while (trajectory.events[zeno].kind != Event::Kind::zeno) ++zeno;
    EXPECT_EQ(sentences.of(zeno).find("knee locks: 10 impacts before the cut, "), 0U) << sentences.of(zeno);
    EXPECT_EQ(sentences.of(zeno + 1), "knee opens: its contact force reaches zero");
}

}  // namespace
}  // namespace achilles
