// What JSON, CSV and sentences say of dry friction.
#include <gtest/gtest.h>

#include <string>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/contacts.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"
#include "sensitivity/error_estimate.hpp"
#include "simulate/simulate.hpp"
#include "system/units.hpp"

namespace achilles {
namespace {

Trajectory run_of(const std::string& text, double end) {
    const auto model = derive(parse_system(text));
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    return simulate(model, run);
}

Trajectory sliding_block() {
    return run_of(R"-(coordinate = [{name = "x", rate = -1}, {name = "y"}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - x/2"
constraint = [{name = "foot", gap = "y", restitution = 0, slip = "x'", friction = 0.3}]
friction = [{name = "air", slip = "x'", level = 0.01}]
)-",
                  3.0);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(FrictionOutput, JsonNamesModesEventsAndHeat) {
    const std::string json = to_json(sliding_block());
    EXPECT_TRUE(has(json, R"("kind": "reversal")"));
    EXPECT_TRUE(has(json, R"("direction": 1)"));
    EXPECT_TRUE(has(json, R"("foot": "slip-")"));
    EXPECT_TRUE(has(json, R"("foot": "slip+")"));
    EXPECT_TRUE(has(json, R"("air": "slip+")"));
    EXPECT_TRUE(has(json, R"("heat": )"));
}

// The block goes up to t = 1/(0.5 + 0.3 + 0.01) against friction, and comes back.
TEST(FrictionOutput, TheSummaryTellsHeatFromLosses) {
    const Trajectory run = sliding_block();
    const std::string text = summary(run);
    EXPECT_TRUE(has(text, "loss 0 at impacts, heat of friction 0.")) << text;
}

// The two feet of a box stick together and share their friction force. While they slide, each has its own.
TEST(FrictionOutput, APhaseOfSharedFrictionIsNotUnique) {
    const Trajectory run = run_of(R"-(coordinate = [{name = "x", rate = 1}, {name = "y", start = 1}, {name = "phi"}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2)/2"
lagrangian.potential = "y"
[[constraint]]
name = "left"
gap = "y - sin(phi) - cos(phi)"
restitution = 0
slip = "x' + (sin(phi) + cos(phi))*phi'"
friction = 0.5
[[constraint]]
name = "right"
gap = "y + sin(phi) - cos(phi)"
restitution = 0
slip = "x' - (sin(phi) - cos(phi))*phi'"
friction = 0.5
)-",
                                  3.0);
    ASSERT_EQ(run.phases.size(), 2u);
    EXPECT_FALSE(has_nonunique_forces(run.phases[0]));
    EXPECT_TRUE(has_nonunique_forces(run.phases[1]));
    EXPECT_TRUE(has(to_json(run), R"("not_unique": true)"));
    EXPECT_TRUE(has(summary(run), ", forces not unique"));
}

TEST(FrictionOutput, CsvHasSlipForceModesAndHeat) {
    const std::string csv = to_csv(sliding_block());
    const std::string heading = csv.substr(0, csv.find('\n'));
    EXPECT_EQ(
        heading,
        "t,phase,x,y,x',y',gap,gap rate,lambda,slip_foot,friction_force_foot,slip_air,friction_force_air,energy,j,"
        "modes,work,loss,heat");
    EXPECT_TRUE(has(csv, ",foot:slip-+air:slip-,"));
    EXPECT_TRUE(has(csv, ",foot:slip++air:slip+,"));
}

// A block that is thrown up an incline: normal gravity 1, tangential gravity `pull`.
Trajectory block_on_incline(const std::string& pull) {
    return run_of(
        "coordinate = [{name = \"x\", rate = -1, unit = \"m\"}, {name = \"y\", unit = \"m\"}]\n"
        "parameter = [{name = \"m\", value = 1, unit = \"kg\"}]\n"
        "lagrangian.kinetic = \"m*(x'^2 + y'^2)/2\"\n"
        "lagrangian.potential = \"m*(y - " +
            pull +
            "*x)\"\n"
            "constraint = [{gap = \"y\", restitution = 0.5, slip = \"x'\", friction = 0.3}]\n",
        3.0);
}

TEST(FrictionSentences, OneContactNeedsNoName) {
    const Trajectory stays = block_on_incline("0.2"), returns = block_on_incline("0.5");
    const EventDescriptions of_staying(stays), of_returning(returns);
    ASSERT_EQ(stays.events.size(), 1u);
    EXPECT_EQ(of_staying.of(0), "sticks");
    EXPECT_EQ(of_staying.start(), "start at 0 s: in contact and sliding to the left");
    EXPECT_EQ(of_staying.state_at_end(), "in contact and sticking");
    ASSERT_EQ(returns.events.size(), 1u);
    EXPECT_EQ(of_returning.of(0), "reverses and slides to the right");
    EXPECT_EQ(of_returning.change(0), of_returning.of(0));
    EXPECT_EQ(of_returning.state_at_end(), "in contact and sliding to the right");
}

TEST(FrictionSentences, SeveralHaveTheirNames) {
    const Trajectory trajectory = sliding_block();
    const EventDescriptions sentences(trajectory);
    ASSERT_EQ(trajectory.events.size(), 1u);
    EXPECT_EQ(sentences.of(0), "foot reverses and slides to the right, air reverses and slides to the right");
    EXPECT_EQ(sentences.state_at_start(), "held by foot (slides to the left), air slides to the left");
    EXPECT_EQ(sentences.end(), "end at 3 s: foot slides to the right, air slides to the right");
}

// A belt that carries a block: there is no contact that could be open. It slides against the belt.
TEST(FrictionSentences, AJointDoesNotFly) {
    const Trajectory trajectory = run_of(R"-(coordinate = [{name = "x", rate = 0.2}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{name = "belt", slip = "x' - 0.2", level = "1/(1 + 3*slip)", static_level = 1}]
)-",
                                         12.0);
    const EventDescriptions sentences(trajectory);
    ASSERT_EQ(trajectory.events.size(), 2u);
    EXPECT_EQ(sentences.state_at_start(), "sticking");
    EXPECT_EQ(sentences.of(0), "starts to slide to the left");
    EXPECT_EQ(sentences.of(1), "sticks");
    EXPECT_EQ(sentences.end(), "end at 12 s: sticking");
}

// A slip without a coordinate x or y, or between two bodies, has no direction that could be named.
TEST(FrictionSentences, OtherSlipsHaveASign) {
    for (const char* slip : {"x1' - x2'", "phi'"}) {
        const Trajectory trajectory = run_of(
            R"-(coordinate = [{name = "x1", rate = 1}, {name = "x2"}, {name = "phi", rate = 1, unit = "rad"}]
lagrangian.kinetic = "(x1'^2 + x2'^2 + phi'^2)/2"
lagrangian.potential = 0
friction = [{name = "pad", level = 1, slip = ")-" +
                std::string(slip) + "\"}]\n",
            0.1);
        EXPECT_EQ(EventDescriptions(trajectory).state_at_start(), "sliding with slip > 0") << slip;
    }
    const Trajectory up = run_of(R"-(coordinate = [{name = "y_a", rate = -1}, {name = "xi"}]
lagrangian.kinetic = "(y_a'^2 + xi'^2)/2"
lagrangian.potential = 0
friction = [{name = "guide", slip = "y_a' + 2*xi'", level = 1}]
)-",
                                 0.1);
    EXPECT_EQ(EventDescriptions(up).state_at_start(), "sliding down");
}

// A point hits the floor at the velocity (1, -1) with mu = 0.5, e = 0.5: p = 1.5, p_T = -0.75, slip 1 -> 0.25. The loss
// is (1 - 0.25)/2 and the heat 0.75 (1 + 0.25)/2 = 0.46875.
TEST(FrictionSentences, AnImpactTellsHeatFromLoss) {
    const Trajectory trajectory =
        run_of(R"-(coordinate = [{name = "x", rate = 1, unit = "m"}, {name = "y", start = 1, unit = "m"}]
parameter = [{name = "m", value = 1, unit = "kg"}]
lagrangian.kinetic = "m*(x'^2 + y'^2)/2"
lagrangian.potential = "m*y/2"
constraint = [{gap = "y", restitution = 0.5, slip = "x'", friction = 0.5}]
)-",
               2.5);
    ASSERT_EQ(trajectory.events.size(), 1u);
    EXPECT_NEAR(Slips(trajectory).heat_of_impact(trajectory.events[0]), 0.46875, 1e-12);
    EXPECT_NEAR(trajectory.heat, 0.46875, 1e-12);
    const std::string sentence = EventDescriptions(trajectory).of(0);
    EXPECT_TRUE(has(sentence, ", 0.375 J lost, heat of friction 0.469 J")) << sentence;
}

// The slip of a rolling disc adds a length times an angle to a length: its unit is that of its gap per time.
TEST(FrictionSentences, ARollingDiscHasUnits) {
    const Trajectory trajectory = run_of(R"-(coordinate = [
    {name = "x", rate = 1, unit = "m"}, {name = "y", start = 0.5, unit = "m"}, {name = "phi", unit = "rad"},
]
parameter = [{name = "m", value = 1, unit = "kg"}, {name = "R", value = 0.5, unit = "m"}]
lagrangian.kinetic = "m*(x'^2 + y'^2 + R^2*phi'^2/2)/2"
lagrangian.potential = "9.81*m*y"
constraint = [{gap = "y - R", restitution = 0.5, slip = "x' + R*phi'", friction = 0.5}]
)-",
                                         0.1);
    const SystemDescription& description = trajectory.model->description();
    EXPECT_EQ(unit_of_expression(description, "slip"), "m/s");
    EXPECT_EQ(unit_of_expression(description, "friction_force"), unit_of_expression(description, "lambda"));
    EXPECT_NE(unit_of_expression(description, "friction_force"), "");
}

// A plastic impact of a block that slides on: the sentence tells what friction does next.
TEST(FrictionSentences, ALandingTellsWhetherItSticks) {
    for (const auto& [rate, after] : {std::pair{"3", "contact begins, sliding to the right: plastic impact"},
                                      std::pair{"0.2", "contact begins, sticking: plastic impact"}}) {
        const Trajectory trajectory =
            run_of("coordinate = [{name = \"x\", rate = " + std::string(rate) +
                       "}, {name = \"y\", start = 0.5}]\n"
                       "lagrangian.kinetic = \"(x'^2 + y'^2)/2\"\nlagrangian.potential = \"y\"\n"
                       "constraint = [{gap = \"y\", restitution = 0, slip = \"x'\", friction = 0.5}]\n",
                   1.5);
        const EventDescriptions sentences(trajectory);
        bool is_found = false;
        for (std::size_t i = 0; i < trajectory.events.size(); ++i) is_found = is_found || sentences.of(i) == after;
        EXPECT_TRUE(is_found) << after << ", not " << sentences.of(trajectory.events.size() - 1);
    }
}

TEST(FrictionSentences, TheAnswerTellsHeatFromLossAndOffersNoProof) {
    const Trajectory trajectory = block_on_incline("0.2");
    const std::string text = answer(trajectory, estimate_error(trajectory), "achilles prove it");
    EXPECT_TRUE(has(text, "simulated to t = 3 s, in contact and sticking at the end\n")) << text;
    // The deceleration 0.2 + 0.3 stops it after 1 m, against a friction force of 0.3 N.
    EXPECT_TRUE(has(text, "\nHeat of friction 0.3 J, loss at impacts 0 J.\n")) << text;
    EXPECT_FALSE(has(text, "prove")) << text;
    const std::string details = summary(trajectory);
    EXPECT_TRUE(has(details, "in contact and sliding to the left, t = 0 to 2 s\n")) << details;
    EXPECT_TRUE(has(details, "loss 0 J at impacts, heat of friction 0.3 J\n")) << details;
}

}  // namespace
}  // namespace achilles
