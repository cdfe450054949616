// Invariance of the motion under a constant added to the potential, other units of energy, time and coordinates, and a
// gap multiplied by a positive function; with friction, the slip and the friction of joints change with them. The texts
// of the system are rewritten, so everything is derived and certified again.
#include <algorithm>
#include <cctype>

#include "laws/laws.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {
namespace {

class Invariance : public Law {
 protected:
    SystemDescription description() const { return model_of(GetParam().system)->description(); }

    // Simulates the rewritten system, whose time runs `faster` times as fast and whose coordinates are `larger` times
    // as large. Returns the trajectory in the units of the file.
    Trajectory rewritten(const SystemDescription& description, double faster = 1.0, double larger = 1.0) const {
        auto run = run_of(GetParam());
        run.options.tolerance = 1e-11;
        run.options.end_time /= faster;
        run.q *= larger;
        run.v *= larger * faster;
        auto& truncation = run.options.truncation;
        truncation.eps_q = 1e-7 * larger;
        truncation.eps_v = 1e-7 * larger * faster;
        truncation.eps_t = 1e-7 / faster;
        Trajectory trajectory = simulate(std::make_shared<const Model>(description), run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        for (Event& event : trajectory.events) event.t *= faster;
        trajectory.end = {trajectory.end.q / larger, trajectory.end.v / (larger * faster)};
        return trajectory;
    }
};

// Steps and the impacts at which sequences are cut may differ, since error norms depend on the units.
void expect_same(const Trajectory& a, const Trajectory& b) {
    EXPECT_LE(distance(a.end, b.end), 1e-6);
    std::vector<Event> of_a, of_b;
    for (const auto& [from, to] : {std::pair(&a, &of_a), std::pair(&b, &of_b)})
        for (const Event& event : from->events)
            if (event.kind != Event::Kind::impact) to->push_back(event);
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        EXPECT_EQ(of_a[i].kind, of_b[i].kind);
        EXPECT_NEAR(of_a[i].t, of_b[i].t, 1e-7);
    }
}

void wrap(Text& text, const std::string& before, const std::string& after) { text.text = before + text.text + after; }

// Factors to insert in a text before every coordinate, every rate, and t.
struct Factors {
    std::string coordinate = "1", rate = "1", time = "1";
};
std::string rescaled(const SystemDescription& system, const std::string& text, const Factors& factors) {
    std::string result;
    const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() && is_part(text[end])) ++end;
        end = std::max(end, i + 1);
        const std::string word = text.substr(i, end - i);
        bool coordinate = false;
        for (const auto& c : system.coordinates) coordinate = coordinate || c.name == word;
        const bool rate = coordinate && end < text.size() && text[end] == '\'';
        if (rate) ++end;
        const std::string factor = rate          ? factors.rate
                                   : coordinate  ? factors.coordinate
                                   : word == "t" ? factors.time
                                                 : "1";
        result += factor == "1" ? text.substr(i, end - i) : "(" + factor + "*" + text.substr(i, end - i) + ")";
        i = end;
    }
    return result;
}

// All texts of a system that may contain coordinates, rates or t.
std::vector<Text*> texts_of(SystemDescription& system) {
    std::vector<Text*> texts{&system.kinetic, &system.potential, &system.dissipation};
    for (CoordinateDescription& coordinate : system.coordinates) texts.push_back(&coordinate.force);
    for (ConstraintDescription& constraint : system.constraints) {
        for (Text* text : {&constraint.gap, &constraint.slip, &constraint.friction, &constraint.when})
            texts.push_back(text);
        if (!constraint.latch.contact) texts.push_back(&constraint.latch.on);
        if (constraint.static_friction) texts.push_back(&*constraint.static_friction);
    }
    for (FrictionDescription& joint : system.frictions) {
        for (Text* text : {&joint.slip, &joint.level}) texts.push_back(text);
        if (joint.static_level) texts.push_back(&*joint.static_level);
    }
    for (JumpDescription& jump : system.jumps) {
        if (!jump.on.contact) texts.push_back(&jump.on.on);
        texts.push_back(&jump.when);
        for (JumpDescription::Assignment& set : jump.set) texts.push_back(&set.value);
    }
    texts.erase(std::remove_if(texts.begin(), texts.end(), [](const Text* text) { return text->text.empty(); }),
                texts.end());
    return texts;
}

// Multiplies the slip of a contact or joint, and divides it again in the coefficient or level.
void multiply_slip(Text& slip, Text& level, const std::string& factor) {
    if (level.text.empty()) return;
    wrap(slip, factor + "*(", ")");
    level.text = with_slip(level.text, "slip/" + factor);
}

// Multiplies what jumps set: coordinates and rates.
void multiply_jumps(SystemDescription& system, const std::string& coordinates, const std::string& rates) {
    for (JumpDescription& jump : system.jumps)
        for (JumpDescription::Assignment& set : jump.set)
            wrap(set.value, (set.place < system.coordinates.size() ? coordinates : rates) + "*(", ")");
}

// Multiplies energies, dissipation and forces by factors.
void strengthen(SystemDescription& system, const std::string& energy, const std::string& dissipation,
                const std::string& force) {
    if (!system.potential.text.empty()) wrap(system.potential, energy + "*(", ")");
    if (!system.dissipation.text.empty()) wrap(system.dissipation, dissipation + "*(", ")");
    for (CoordinateDescription& coordinate : system.coordinates)
        if (!coordinate.force.text.empty()) wrap(coordinate.force, force + "*(", ")");
}

// Multiplies the friction forces of joints.
void strengthen_joints(SystemDescription& system, const std::string& factor) {
    for (FrictionDescription& joint : system.frictions) {
        wrap(joint.level, factor + "*(", ")");
        if (joint.static_level) wrap(*joint.static_level, factor + "*(", ")");
    }
}

TEST_P(Invariance, AnotherZeroOfThePotential) {
    SystemDescription changed = description();
    wrap(changed.potential, "", " + 7.25");
    expect_same(rewritten(changed), rewritten(description()));
}

TEST_P(Invariance, LInOtherUnitsOfEnergy) {
    SystemDescription changed = description();
    wrap(changed.kinetic, "1000*(", ")");
    strengthen(changed, "1000", "1000", "1000");
    strengthen_joints(changed, "1000");
    expect_same(rewritten(changed), rewritten(description()));
    if (changed.constraints.empty()) return;
    // The contact force scales with the unit of energy.
    const auto force = [&](const SystemDescription& system) {
        const Model model(system);
        const auto run = model.default_run();
        auto lambda = model.evaluator(model.force(), run.parameters);
        set_state(lambda, run.start());
        lambda.run();
        return lambda.output(0);
    };
    EXPECT_NEAR(force(changed), 1000.0 * force(description()), 1e-9 * std::abs(force(changed)));
}

// Another unit of time. With minutes, for example, rates are 60 times as large, accelerations 3600 times.
TEST_P(Invariance, OtherUnitsOfTime) {
    SystemDescription changed = description();
    for (Text* text : texts_of(changed))
        if (text != &changed.kinetic) text->text = rescaled(changed, text->text, {"1", "1/60", "60"});
    strengthen(changed, "3600", "216000", "3600");
    strengthen_joints(changed, "3600");
    for (ConstraintDescription& constraint : changed.constraints)
        multiply_slip(constraint.slip, constraint.friction, "60");
    for (FrictionDescription& joint : changed.frictions) multiply_slip(joint.slip, joint.level, "60");
    multiply_jumps(changed, "1", "60");
    expect_same(rewritten(changed, 60.0), rewritten(description()));
}

// Coordinates, including angles, in units that are smaller by a factor of 100. Gaps and slips keep their values, and so
// do the friction forces of joints.
TEST_P(Invariance, OtherUnitsOfTheCoordinates) {
    SystemDescription changed = description();
    for (Text* text : texts_of(changed)) text->text = rescaled(changed, text->text, {"0.01", "0.01", "1"});
    strengthen(changed, "1", "1", "0.01");
    multiply_jumps(changed, "100", "100");
    const auto changing = [](const SystemDescription& system) {
        return !system.constraints.empty() ? system.constraints[0].gap.text
               : !system.frictions.empty() ? system.frictions[0].slip.text
                                           : system.jumps[0].on.on.text;
    };
    ASSERT_NE(changing(changed), changing(description()));
    expect_same(rewritten(changed, 1.0, 100.0), rewritten(description()));
}

// A gap times a positive function of the coordinates has the same zero set. Its gradient differs, but impacts, Zeno
// points and releases are the same. With friction the slip is multiplied by the same function (theory-friction.md 1).
TEST_P(Invariance, TheGapTimesAPositiveFunction) {
    // No force decides there whether the balls stay in contact: that hddot is 0 is read off the text of the gap.
    if (GetParam().system == "three_balls") return;
    const auto events = [&](const SystemDescription& system) {
        auto run = run_of(GetParam());
        run.options.tolerance = 1e-13;
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-9;
        const Trajectory trajectory = simulate(std::make_shared<const Model>(system), run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        std::vector<Event> result;
        for (const Event& event : trajectory.events)
            if (event.kind != Event::Kind::impact) result.push_back(event);
        return result;
    };
    const std::vector<Event> expected = events(description());
    const std::string q = description().coordinates[0].name;
    for (const std::string& factor : {"(2 + sin(" + q + "))", "exp(" + q + ")"}) {
        SystemDescription changed = description();
        for (ConstraintDescription& constraint : changed.constraints) {
            wrap(constraint.gap, factor + "*(", ")");
            multiply_slip(constraint.slip, constraint.friction, factor);
        }
        const std::vector<Event> found = events(changed);
        ASSERT_EQ(found.size(), expected.size()) << factor;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].kind, expected[i].kind) << factor;
            EXPECT_NEAR(found[i].t, expected[i].t, 1e-8) << factor << ", event " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(ExecutionAutomaton, Invariance, testing::ValuesIn(all_cases()), name_of);

}  // namespace
}  // namespace achilles::test
