// Invariance of motions with forces, time dependence and several gaps. The motion must not depend on the numbering of
// contacts, a gap that is never reached, another system in the same file, the frame, or the start time.
#include <fmt/format.h>

#include "core/systems.hpp"
#include "laws/laws.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {
namespace {

Trajectory to_its_end(const SystemDescription& system, const std::function<void(achilles::Run&)>& change = {}) {
    const auto model = std::make_shared<const Model>(system);
    auto run = model->default_run();
    if (change) change(run);
    Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    return trajectory;
}

// Contact i of the one run is contact as[i] of the other.
ContactSet renamed(ContactSet set, const std::vector<std::size_t>& as) {
    ContactSet result;
    for (std::size_t i = 0; i < as.size(); ++i)
        if (set.contains(i)) result = result.with(as[i]);
    return result;
}

void expect_same_run(const Trajectory& a, const Trajectory& b, double tolerance, std::vector<std::size_t> as = {},
                     double later = 0.0) {
    if (as.empty())
        for (std::size_t i = 0; i < max_contacts; ++i) as.push_back(i);
    EXPECT_LE(distance(a.end, b.end), tolerance);
    EXPECT_NEAR(a.work, b.work, tolerance);
    EXPECT_NEAR(a.loss, b.loss, tolerance);
    EXPECT_EQ(renamed(a.end_mode.held(), as), b.end_mode.held());
    ASSERT_EQ(a.events.size(), b.events.size());
    for (std::size_t i = 0; i < a.events.size(); ++i) {
        SCOPED_TRACE(fmt::format("event {} at {}", i, a.events[i].t));
        const Event &x = a.events[i], &y = b.events[i];
        ASSERT_EQ(x.kind, y.kind);
        EXPECT_EQ(renamed(x.contacts, as), y.contacts);
        EXPECT_EQ(renamed(x.mode.held(), as), y.mode.held());
        EXPECT_EQ(renamed(x.opened, as), y.opened);
        EXPECT_NEAR(x.t + later, y.t, tolerance);
        EXPECT_LE(distance({x.q, x.v_after}, {y.q, y.v_after}), tolerance);
    }
}

class GapLaws : public testing::TestWithParam<const char*> {
 protected:
    SystemDescription description() const { return model_of(GetParam())->description(); }
};

TEST_P(GapLaws, RenumberingContactsRenamesAndChangesNothing) {
    const SystemDescription original = description();
    const Trajectory expected = to_its_end(original);
    const std::size_t count = original.constraints.size();
    SystemDescription turned = original;
    std::vector<std::size_t> as;
    for (std::size_t i = 0; i < count; ++i) {
        as.push_back((i + 1) % count);
        turned.constraints[(i + 1) % count] = original.constraints[i];
    }
    expect_same_run(expected, to_its_end(turned), 1e-12, as);
}

// All bits agree if the Taylor series of the added gap ends before the others. Otherwise steps may be shorter.
TEST_P(GapLaws, AGapThatIsNeverReachedChangesNothing) {
    const Trajectory expected = to_its_end(description());
    for (const auto& [motion, tolerance] : {std::pair("", 0.0), std::pair(" + sin(t)", 1e-10)}) {
        SystemDescription more = description();
        ConstraintDescription& far = more.constraints.emplace_back();
        far.name = "far";
        far.gap.text = more.coordinates[0].name + " + 50" + motion;
        far.restitution.text = "0.5";
        const Trajectory found = to_its_end(more);
        expect_same_run(expected, found, tolerance);
        if (tolerance == 0.0) {
            EXPECT_EQ(found.statistics.steps, expected.statistics.steps);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Reference, GapLaws, testing::ValuesIn(reference_systems),
                         [](const auto& one) { return std::string(one.param); });

// Two systems in one file. To keep names distinct, coordinates and parameters of the second get a prefix.
SystemDescription joined_systems(const SystemDescription& a, SystemDescription b) {
    const auto renamed_in = [&](std::string text) {
        std::string result;
        for (std::size_t i = 0; i < text.size();) {
            std::size_t end = i;
            while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
                ++end;
            end = std::max(end, i + 1);
            std::string word = text.substr(i, end - i);
            for (const auto& c : b.coordinates)
                if (word == c.name) word = "other_" + word;
            for (const auto& p : b.parameters)
                if (word == p.name) word = "other_" + word;
            result += word;
            i = end;
        }
        return result;
    };
    SystemDescription both = a;
    for (CoordinateDescription c : b.coordinates) {
        c.force.text = renamed_in(c.force.text);
        c.name = "other_" + c.name;
        both.coordinates.push_back(c);
    }
    for (ParameterDescription p : b.parameters) {
        p.name = "other_" + p.name;
        both.parameters.push_back(p);
    }
    for (ConstraintDescription c : b.constraints) {
        c.name = "other_" + c.name;
        c.gap.text = renamed_in(c.gap.text);
        c.restitution.text = renamed_in(c.restitution.text);
        c.drawings.clear();
        both.constraints.push_back(c);
    }
    const auto add = [&](Text& to, const Text& from) {
        if (!from.text.empty()) to.text = (to.text.empty() ? "" : to.text + " + ") + renamed_in(from.text);
    };
    add(both.kinetic, b.kinetic);
    add(both.potential, b.potential);
    add(both.dissipation, b.dissipation);
    both.drawings.clear();
    both.views.clear();
    for (auto& constraint : both.constraints) constraint.drawings.clear();
    return both;
}

// The steps and the impacts at which sequences are cut may differ.
TEST(IndependentSystems, InOneFileRunAsEachAlone) {
    const std::pair<const char*, const char*> pairs[] = {{"travelling_wave", "driven_damped_pendulum"},
                                                         {"ball_in_box", "vibrating_table"},
                                                         {"bowl_and_post", "ball_on_sine"}};
    for (const auto& [one, other] : pairs) {
        SCOPED_TRACE(std::string(one) + " and " + other);
        const SystemDescription a = model_of(one)->description(), b = model_of(other)->description();
        const auto set = [](achilles::Run& run) {
            run.options.end_time = 7.5;
            run.options.tolerance = 1e-13;
            auto& truncation = run.options.truncation;
            truncation.eps_q = truncation.eps_v = truncation.eps_t = 1e-9;
        };
        const Trajectory both = to_its_end(joined_systems(a, b), set),
                         alone[] = {to_its_end(a, set), to_its_end(b, set)};
        const std::size_t first = a.constraints.size();
        const auto n = static_cast<Eigen::Index>(a.coordinates.size());
        EXPECT_LT((both.end.q.head(n) - alone[0].end.q).norm(), 1e-8);
        EXPECT_LT((both.end.v.head(n) - alone[0].end.v).norm(), 1e-8);
        EXPECT_LT((both.end.q.tail(alone[1].end.q.size()) - alone[1].end.q).norm(), 1e-8);
        EXPECT_LT((both.end.v.tail(alone[1].end.q.size()) - alone[1].end.v).norm(), 1e-8);
        EXPECT_NEAR(both.work, alone[0].work + alone[1].work, 1e-8);
        EXPECT_NEAR(both.loss, alone[0].loss + alone[1].loss, 1e-8);
        for (const int which : {0, 1}) {
            std::vector<Event> expected, found;
            for (const Event& event : alone[which].events)
                if (event.kind != Event::Kind::impact) expected.push_back(event);
            for (const Event& event : both.events)
                for (std::size_t i = 0; i < both.model->contacts(); ++i)
                    if (event.kind != Event::Kind::impact && event.contacts.contains(i) && (i >= first) == (which == 1))
                        found.push_back(event);
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                EXPECT_EQ(found[i].kind, expected[i].kind);
                EXPECT_NEAR(found[i].t, expected[i].t, 1e-8);
            }
        }
    }
}

PlaneSystem ball_over_waves() {
    PlaneSystem ball;
    ball.gap = "b - 0.3*sin(a)";
    ball.a = 0.3;
    ball.b = 1.0;
    ball.a_rate = 0.4;
    ball.a_force = "0.5*cos(1.3*t) - 0.2*a'^3";
    ball.end = 8.0;
    return ball;
}

// Galilean transformation: b = B + u t, B' = b' - u.
TEST(MovingGaps, WithConstantSpeedAreGapsInAMovingFrame) {
    const double u = 0.4;
    PlaneSystem moving = ball_over_waves();
    moving.gap = "b - 0.4*t - 0.3*sin(a)";
    moving.b_rate = u;
    const Trajectory still = to_its_end(achilles::test::model_of(ball_over_waves())->description());
    Trajectory seen = to_its_end(achilles::test::model_of(moving)->description());
    for (Event& event : seen.events) {
        event.q[1] -= u * event.t;
        event.v_after[1] -= u;
    }
    seen.end.q[1] -= u * seen.end_time;
    seen.end.v[1] -= u;
    seen.work = still.work;  // work depends on the frame; the loss at impacts does not
    expect_same_run(still, seen, 1e-9);
}

// b = B + alpha t^2/2: in the frame of the gap, gravity is larger by alpha.
TEST(MovingGaps, WithConstantAccelerationAreGravity) {
    PlaneSystem heavy = ball_over_waves(), moving = heavy;
    heavy.potential = "1.5*b";
    moving.gap = "b - 0.25*t^2 - 0.3*sin(a)";
    const Trajectory expected = to_its_end(achilles::test::model_of(heavy)->description());
    Trajectory seen = to_its_end(achilles::test::model_of(moving)->description());
    for (Event& event : seen.events) {
        event.q[1] -= 0.25 * event.t * event.t;
        event.v_after[1] -= 0.5 * event.t;
    }
    seen.end.q[1] -= 0.25 * seen.end_time * seen.end_time;
    seen.end.v[1] -= 0.5 * seen.end_time;
    seen.work = expected.work;
    expect_same_run(expected, seen, 1e-9);
}

TEST(StartTime, ShiftsAnAutonomousRun) {
    for (const std::string system : {"ball_in_box", "bowl_and_post", "double_pendulum"}) {
        SCOPED_TRACE(system);
        const SystemDescription description = model_of(system)->description();
        const Trajectory now = to_its_end(description);
        for (const double shift : {-20.0, 1024.0}) {
            const Trajectory then = to_its_end(description, [&](achilles::Run& run) {
                run.options.start_time = shift;
                run.options.end_time += shift;
            });
            EXPECT_EQ(then.phases.front().start, shift);
            expect_same_run(now, then, 1e-9, {}, shift);
        }
    }
}

// For a system that depends on time, a run from start time 7 equals a run from 0 of the system with t + 7 in place of
// t.
TEST(StartTime, IsTheTimeThatForcesAndGapsSee) {
    const auto shifted = [](const std::string& by) {
        PlaneSystem ball = ball_over_waves();
        ball.gap = "b - 0.3*sin(a - 1.1*(t + " + by + "))";
        ball.a_force = "0.5*cos(1.3*(t + " + by + ")) - 0.2*a'^3";
        return achilles::test::model_of(ball)->description();
    };
    const Trajectory now = to_its_end(shifted("7"));
    const Trajectory then = to_its_end(shifted("0"), [](achilles::Run& run) {
        run.options.start_time = 7.0;
        run.options.end_time += 7.0;
    });
    expect_same_run(now, then, 1e-9, {}, 7.0);
    EXPECT_GT(distance(now.end, to_its_end(shifted("0")).end), 1e-3);
}

// E(end) - E(start) = work - loss, with moving gaps, held contacts, impacts and reinitializations.
TEST(PowerBalance, HoldsWithEveryContactThatMoves) {
    const auto with_gaps = [](const char* name, const std::vector<std::string>& gaps) {
        SystemDescription system = model_of(name)->description();
        for (std::size_t i = 0; i < gaps.size(); ++i) system.constraints[i].gap.text = gaps[i];
        return system;
    };
    // A ball on a moving floor hits an inclined wall, and part of the impulse is passed on to the floor.
    PlaneSystem carried;
    carried.gap = "b - 0.1*sin(3*t)";
    carried.e = "0";
    carried.b_rate = 0.3;
    carried.a_rate = 1.0;
    carried.end = 6.0;
    SystemDescription walls = achilles::test::model_of(carried)->description();
    walls.constraints[0].name = "floor";
    for (const auto& [name, gap] :
         {std::pair("right", "1.5 - a - 0.3*b - 0.1*sin(2*t)"), std::pair("left", "a + 1 - 0.3*b")}) {
        ConstraintDescription& wall = walls.constraints.emplace_back();
        wall.name = name;
        wall.gap.text = gap;
        wall.restitution.text = "0.5";
    }
    const std::pair<const char*, SystemDescription> systems[] = {
        {"carried ball", walls},
        {"moving bowl and post",
         with_gaps("bowl_and_post", {"z - r^2/2 - 0.05*sin(1.7*t)", "r - 1 - 0.3*cos(phi - 0.4*t)"})},
        {"pendulum and a moving wall", with_gaps("pendulum_two_stops", {"th2", "0.35 + 0.1*sin(t) - th1"})},
        {"box and table",
         joined_systems(model_of("ball_in_box")->description(), model_of("vibrating_table")->description())}};
    for (const auto& [name, system] : systems)
        for (const Reinitialization kind : {Reinitialization::kinetic, Reinitialization::euclidean}) {
            SCOPED_TRACE(std::string(name) + ", " + std::string(to_text(kind)));
            const Trajectory run = to_its_end(system, [&](achilles::Run& it) {
                it.options.tolerance = 1e-12;
                it.options.truncation.reinitialization = kind;
            });
            auto energy = run.model->evaluator(run.model->energy(), run.run.parameters);
            const auto energy_at = [&](const State& state) {
                set_state(energy, state);
                energy.run();
                return energy.total();
            };
            const double change = energy_at(run.end) - energy_at(run.run.start());
            EXPECT_NEAR(change, run.work - run.loss, 1e-9);
            EXPECT_LT(run.statistics.energy_drift, 1e-10);
            EXPECT_GT(std::abs(run.work), 1e-2);
            EXPECT_GE(run.loss, 0.0);
            bool struck_while_held = false;
            for (const Event& event : run.events)
                struck_while_held =
                    struck_while_held || (event.kind == Event::Kind::impact && !event.mode.held().empty());
            EXPECT_TRUE(struck_while_held || std::string(name).starts_with("pendulum"));
        }
}

}  // namespace
}  // namespace achilles::test
