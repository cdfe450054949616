// Dry friction in the explorer: events in words, legend, energy panel, sliders.
#include <gtest/gtest.h>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "figure/palette.hpp"

namespace achilles {
namespace {

using test::Folder;
using test::Hands;

const std::string carried_block = R"toml(title = "Block on a belt"
coordinate = [{name = "x", start = 0.5, rate = 0.2, unit = "m", range = [-2, 2], rate_range = [-2, 2]}]
parameter = [{name = "F", value = 1.0, unit = "N", range = [0.1, 5.0]}]
world  = {points = {wall = [-3, 0.25]}}
body   = [{name = "block", mass = 1, box = [0.8, 0.5], at = ["x", 0.25]}]
spring = [{between = ["world.wall", "block"], stiffness = 1, rest = 3}]
friction = [{name = "belt", slip = "x' - 0.2", level = "F/(1 + 3*slip)", static_level = "F"}]
run = {end_time = 20}
)toml";

const std::string block_on_ramp = R"toml(title = "Block on a ramp"
coordinate = [
    {name = "x", rate = -1, unit = "m", range = [-5, 5], rate_range = [-5, 5]},
    {name = "y", unit = "m", range = [0, 2], rate_range = [-2, 2]},
]
parameter = [{name = "m", value = 1, unit = "kg"}, {name = "mu", value = 0.6, range = [0.0, 1.5]}]
lagrangian.kinetic = "m*(x'^2 + y'^2)/2"
lagrangian.potential = "m*(y - x/2)"
constraint = [{name = "ramp", gap = "y", restitution = 0.5, slip = "x'", friction = "mu"}]
run = {end_time = 3}
)toml";

// An explorer of a system typed here.
struct RoughHands {
    explicit RoughHands(const std::string& text) : hands("ball_on_sine", test::surface(1600, 1000)) {
        folder.put("rough.toml", text);
        hands.session.apply(command::Open{(folder.path() / "rough.toml").string()});
        hands.session.settle();
        hands.rest(3);
    }
    Folder folder;
    Hands hands;
};

TEST(FrictionPanels, EventsAndLegendTellStickFromSlip) {
    RoughHands belt(carried_block);
    ASSERT_GE(belt.hands.session.trajectory().events.size(), 3u);
    for (const char* words : {"starts to slide to the left", "sticks", "start: sticking", "sticking", "sliding"})
        EXPECT_TRUE(belt.hands.says(words)) << words;
    // Nothing can fly or bounce.
    for (const char* words : {"in flight", "in contact", "Zeno point"}) EXPECT_FALSE(belt.hands.says(words)) << words;
}

TEST(FrictionPanels, TheEnergyPanelTellsHeatFromImpactLoss) {
    RoughHands ramp(block_on_ramp);
    ramp.hands.session.apply(parse_command("show energy"));
    ramp.hands.session.apply(parse_command("seek 3"));
    ramp.hands.rest(2);
    EXPECT_TRUE(ramp.hands.says("friction heat"));
    EXPECT_TRUE(ramp.hands.says("impact loss"));
    EXPECT_FALSE(ramp.hands.says("work done")) << "only gravity acts";
    // It stops after 1/(2 (0.6 + 0.5)) m, against a force of 0.6 N.
    const double heat = 0.6 / (2.0 * 1.1);
    EXPECT_NEAR(ramp.hands.session.trajectory().heat, heat, 1e-9);
    EXPECT_TRUE(ramp.hands.says("0.2727 J"));
    Hands smooth("ball_on_sine");
    smooth.session.apply(parse_command("show energy"));
    smooth.rest(2);
    EXPECT_FALSE(smooth.says("friction heat"));
}

// The force jumps from 0.6 N, up to which it could rest, to 0.5 N.
TEST(FrictionPanels, TheCardOfAnEventTellsTheForces) {
    RoughHands ramp(block_on_ramp);
    ramp.hands.session.apply(command::Select{1});
    ramp.hands.rest(2);
    for (const char* words : {"Stick, event 1", "friction force", "its limit", "It sticks."})
        EXPECT_TRUE(ramp.hands.says(words)) << words;
    ramp.hands.click("close card");
    EXPECT_EQ(ramp.hands.session.selected(), 0);
}

// It falls from 1/2 m, to w = 1 m/s and the slip 1.5 m/s: p = 1.5, p_T = -0.9, loss p w/4, heat 0.9*(1.5 + 0.6)/2.
TEST(FrictionPanels, TheCardOfAnImpactTellsHeatFromLoss) {
    std::string text = block_on_ramp;
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("{name = \"y\",", "{name = \"y\", start = 0.5,");
    replace("rate = -1,", "rate = 1,");
    RoughHands ramp(text);
    ASSERT_TRUE(ramp.hands.session.trajectory().events.at(0).is_impact());
    ramp.hands.session.apply(command::Select{1});
    ramp.hands.rest(2);
    for (const char* words :
         {"energy lost0.375", "heat of friction0.945", "Not cut: with friction a cut needs a proof"})
        EXPECT_TRUE(ramp.hands.says(words)) << words << "\n" << ramp.hands.letters();
    EXPECT_FALSE(ramp.hands.says("several contacts take part"));
}

// Below tan(angle) = 0.5 it does not stay: the run and its sentences change while the slider moves.
TEST(FrictionPanels, TheSliderOfMuActsAtOnce) {
    RoughHands ramp(block_on_ramp);
    EXPECT_EQ(ramp.hands.session.trajectory().events.at(0).kind, Event::Kind::stick);
    EXPECT_TRUE(ramp.hands.says("start: in contact and sliding to the left"));
    ramp.hands.click("set mu", 0.2);
    const double mu = ramp.hands.session.run().parameters[1];
    ASSERT_GT(mu, 0.0);
    ASSERT_LT(mu, 0.5);
    ramp.hands.session.settle();
    ramp.hands.rest(2);
    const Event& event = ramp.hands.session.trajectory().events.at(0);
    EXPECT_EQ(event.kind, Event::Kind::reversal);
    EXPECT_NEAR(event.t, 1.0 / (0.5 + mu), 1e-9);
    EXPECT_TRUE(ramp.hands.says("reverses and slides to the right"));
}

// The button of proofs is disabled and says why; the command is refused as on the command line.
TEST(FrictionPanels, NoProofIsOffered) {
    RoughHands ramp(block_on_ramp);
    const std::string refusal = "Runs with dry friction cannot be proved";
    ramp.hands.click("tab proof");
    for (const char* button : {"prove", "spreads"}) {
        ramp.hands.click(button);
        EXPECT_EQ(ramp.hands.session.proof_under_way(), nullptr) << button;
        EXPECT_EQ(ramp.hands.session.error(), "") << button;
        EXPECT_FALSE(ramp.hands.says("this start only")) << button;
        EXPECT_TRUE(ramp.hands.says(refusal)) << button;
    }
    ramp.hands.click("tab events");
    ramp.hands.click("compare");
    EXPECT_EQ(ramp.hands.session.error(), "");
    EXPECT_TRUE(ramp.hands.session.pinned().empty());
    ramp.hands.session.apply(parse_command("prove"));
    EXPECT_NE(ramp.hands.session.error().find("a proof does not cover dry friction"), std::string::npos);
    EXPECT_EQ(ramp.hands.session.proof_under_way(), nullptr);
}

}  // namespace
}  // namespace achilles
