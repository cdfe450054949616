#include "session/glossary.hpp"

#include <algorithm>
#include <array>

namespace achilles {

namespace {

constexpr std::array terms{
    GlossaryTerm{"gap", "gap >= 0", "How far a contact is from closing. It is never negative.", "theory 1"},
    GlossaryTerm{"hybrid phase", "M*a + b = 0", "Free flight and impacts, as long as no contact is held.",
                 "paper (2), Def. 4"},
    GlossaryTerm{"impact", "v(after) = v(before) - (1 + e)*gap'*n",
                 "The gap closes, and the velocity jumps along n, the direction of the impulse.", "paper (4)"},
    GlossaryTerm{"impact speed", "w = -gap'(before)", "How fast the gap closes at an impact.", "theory 3"},
    GlossaryTerm{"restitution", "e = -gap'(after)/gap'(before)",
                 "The normal speed after an impact over that before: 0 is plastic, 1 is elastic.", "paper (4)"},
    GlossaryTerm{"normal acceleration", "gap''",
                 "The gap's acceleration in free motion. Where it is negative, the bodies are pressed together.",
                 "paper (8)"},
    GlossaryTerm{
        "Zeno point", "gap = 0, gap' = 0, gap'' < 0",
        "The limit of infinitely many impacts in finite time: with 0 < e < 1 each flight is about e times the last.",
        "paper, Thm. 2"},
    GlossaryTerm{"truncation", "w < c1, w < c2, w < c3",
                 "Impacts are cut at the first one where the error of the cut is certified to be small.",
                 "paper, Def. 7"},
    GlossaryTerm{
        "conditions", "a_min <= -gap'' <= a_max",
        "What is certified before the cut: the paper's inequalities, or sharp ones with their own neighborhood.",
        "paper (9)-(11); theory 6"},
    GlossaryTerm{"certificate", "t(Zeno) - t(cut) <= A*w",
                 "Interval bounds on the Zeno time, and on the distance of the true Zeno point from the computed one.",
                 "paper, Thm. 3; theory 4"},
    GlossaryTerm{
        "restart", "v(after) = v - gap'*n",
        "Where the motion continues after the cut: by a plastic impact (kinetic), or the paper's Euclidean projection.",
        "paper, Def. 7; theory 5"},
    GlossaryTerm{"constrained phase", "gap = 0, gap' = 0, lambda > 0",
                 "A phase in which the contact is held: the gap stays 0 and the contact force is positive.",
                 "paper (5), Def. 5"},
    GlossaryTerm{"contact force", "lambda = -gap''/W",
                 "The force that holds the gap closed. It can push, but not pull.", "paper (6)"},
    GlossaryTerm{"release", "lambda = 0", "The contact force has fallen to zero, and the gap opens.", "paper, Def. 5"},
    GlossaryTerm{"completion", "", "The whole run past its Zeno points: hybrid and constrained phases in turn.",
                 "paper, Defs. 4, 5"},
    GlossaryTerm{"stick", "slip = 0, |friction_force| <= mu_s*lambda",
                 "Friction keeps the sliding velocity at exactly 0, as long as its force is inside the friction cone.",
                 ""},
    GlossaryTerm{"slip", "friction_force = -mu*lambda*sign(slip)",
                 "A contact or bearing slides: slip+ forward, slip- backward. At a reversal the sign changes.", ""},
    GlossaryTerm{"heat", "energy = energy(0) + work - loss - heat",
                 "The work against dry friction, in contact and at impacts. Losses are those of the normal impulses.",
                 ""},
    GlossaryTerm{"work and loss", "energy = energy(0) + work - loss",
                 "Work is done by forces, dampers (negative) and moving contacts; loss is what impacts dissipate.", ""},
    GlossaryTerm{"undecided", "",
                 "Double precision cannot decide what comes next, even at the minimum tolerances: the run stops.",
                 "theory 6"},
};

}  // namespace

std::span<const GlossaryTerm> glossary() { return terms; }

std::span<const GalleryGroup> gallery() {
    static const std::vector<GalleryGroup> groups{
        {"the paper", {"ball_on_sine", "double_pendulum"}},
        {"teaching",
         {"ball_on_floor", "ball_on_incline", "ball_in_bowl", "ball_on_hills", "ball_down_a_wave", "ball_on_cylinder",
          "bead_in_ring", "superball", "ball_on_string", "ball_on_egg_crate", "disc_on_waves", "cart_pendulum",
          "triple_pendulum", "falling_rod"}},
        {"robots", {"swinging_leg", "kneed_leg", "arm_at_wall"}},
        {"walkers",
         {"rimless_wheel", "simplest_walker", "compass_gait", "compass_gait_floating", "kneed_walker", "slip_runner",
          "two_mass_hopper"}},
        {"driven",
         {"impact_oscillator", "impact_pair", "ball_on_table", "ball_on_vibrating_table", "two_mass_oscillator",
          "driven_double_pendulum", "ball_in_gusts", "bouncing_wheel", "slider_crank", "kapitza_pendulum"}},
        {"several contacts",
         {"double_pendulum_two_stops", "wavy_ramp", "ball_in_sloped_box", "ball_round_post", "ball_in_v",
          "box_dropped_flat", "cart_between_walls", "backlash", "newtons_cradle", "three_balls",
          "slider_crank_clearance", "seesaw", "table_on_legs"}},
        {"dry friction",
         {"block_on_incline", "stick_slip_belt", "spun_disc", "bead_on_rough_sine", "rough_pendulum", "rocking_block",
          "woodpecker", "ladder", "spinning_ball_between_walls", "impacting_stick", "bouncing_dimer", "painleve_rod",
          "slider_crank_friction"}}};
    return groups;
}

std::string_view group_of(std::string_view system) {
    for (const GalleryGroup& group : gallery())
        if (std::find(group.systems.begin(), group.systems.end(), system) != group.systems.end()) return group.title;
    return "others";
}

std::size_t place_in_gallery(std::string_view system) {
    std::size_t place = 0;
    for (const GalleryGroup& group : gallery())
        for (const std::string_view name : group.systems) {
            if (name == system) return place;
            ++place;
        }
    return place;
}

}  // namespace achilles
