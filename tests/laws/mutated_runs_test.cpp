// Tests of the laws themselves: a falsified execution must violate the law that it breaks.
#include "laws/laws.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {
namespace {

Trajectory truth() {
    const auto model = model_of("ball_on_sine");
    auto run = model->default_run();
    run.options.end_time = 5.0;  // a Zeno point at 2.7, a release at 3.7
    return simulate(model, run);
}

Event& first(Trajectory& trajectory, Event::Kind kind) {
    for (Event& event : trajectory.events)
        if (event.kind == kind) return event;
    throw std::logic_error("no such event");
}

// Coefficient number i of the piece after the first impact. The order is: constant terms of x, y, x', y', then linear
// terms.
double& coefficient(Trajectory& trajectory, std::size_t i) {
    const double t = trajectory.events.front().t;
    for (const DenseSegment& piece : trajectory.pieces)
        if (piece.start >= t) return trajectory.coefficients[piece.first + i];
    throw std::logic_error("no such piece");
}

TEST(MutatedRuns, TheTruthViolatesNothing) {
    const Trajectory trajectory = truth();
    for (const auto& law : {energy, gap, phases, contact_force}) EXPECT_TRUE(law(trajectory).empty());
}

TEST(MutatedRuns, Energy) {
    Trajectory fast = truth();
    coefficient(fast, 4 + 2) += 1e-6;  // linear term of x'
    EXPECT_FALSE(energy(fast).empty());
    Trajectory lively = truth();
    first(lively, Event::Kind::impact).v_after[1] += 1e-12;
    EXPECT_FALSE(energy(lively).empty());
    Trajectory dull = truth();
    first(dull, Event::Kind::impact).v_after[1] -= 1e-12;
    EXPECT_FALSE(energy(dull).empty());
}

TEST(MutatedRuns, Gap) {
    Trajectory low = truth();
    coefficient(low, 1) -= 1e-11;
    EXPECT_FALSE(gap(low).empty());
}

TEST(MutatedRuns, Phases) {
    const auto lie = [](const char* name, void (*change)(Trajectory&)) {
        Trajectory trajectory = truth();
        change(trajectory);
        EXPECT_FALSE(phases(trajectory).empty()) << name;
    };
    lie("an impact is left out", [](Trajectory& t) { t.events.erase(t.events.begin() + 1); });
    lie("a Zeno point is left out", [](Trajectory& t) {
        const auto at = &first(t, Event::Kind::zeno) - t.events.data();
        t.events.erase(t.events.begin() + at);
    });
    lie("a release is left out", [](Trajectory& t) {
        const auto at = &first(t, Event::Kind::release) - t.events.data();
        t.events.erase(t.events.begin() + at);
    });
    lie("two impacts change places", [](Trajectory& t) { std::swap(t.events[0], t.events[1]); });
    lie("phases leave a hole", [](Trajectory& t) { t.phases[1].start += 1e-9; });
    lie("two phases of one kind", [](Trajectory& t) { t.phases[1].kind = Phase::Kind::hybrid; });
    lie("the end is missing", [](Trajectory& t) { t.phases.back().end -= 1e-9; });
    lie("another velocity after an impact", [](Trajectory& t) { t.events[0].v_after[0] += 1e-12; });
    lie("an impact above the surface", [](Trajectory& t) { t.events[0].q[1] += 1e-11; });
    lie("an impact that leaves", [](Trajectory& t) { std::swap(t.events[0].v_before, t.events[0].v_after); });
    lie("a Zeno point outside its interval",
        [](Trajectory& t) { first(t, Event::Kind::zeno).certificate->zeno_high = 2.725; });
    lie("a Zeno point without proof",
        [](Trajectory& t) { first(t, Event::Kind::zeno).certificate->certified = false; });
    lie("a Zeno point that still moves away", [](Trajectory& t) { first(t, Event::Kind::zeno).v_after[1] += 1e-11; });
    lie("a jump at a release", [](Trajectory& t) { first(t, Event::Kind::release).v_before[0] += 1e-15; });
}

TEST(MutatedRuns, ContactForce) {
    Trajectory early = truth();
    Event& release = first(early, Event::Kind::release);
    const State before = Sampler(early).at(release.t - 1e-9).state;
    release.q = before.q;
    release.v_after = before.v;
    EXPECT_FALSE(contact_force(early).empty());
    // A contact phase extended into the flight.
    Trajectory late = truth();
    for (DenseSegment& piece : late.pieces)
        if (piece.start >= late.phases[1].end) piece.mode = Mode::holding(ContactSet::of(0));
    late.phases[1].end += 0.3;
    EXPECT_FALSE(contact_force(late).empty());
}

// ---- several contacts, a drive and dampers ----

Trajectory truth_of_two_stops() {
    const auto model = model_of("double_pendulum_two_stops");
    auto run = model->default_run();
    run.options.end_time = 7.0;  // the knee locks at 4.85, an impact on the wall opens it at 6.65
    return simulate(model, run);
}

Event& blow(Trajectory& trajectory) {
    for (Event& event : trajectory.events)
        if (!event.opened.empty()) return event;
    throw std::logic_error("no such event");
}

TEST(MutatedRuns, TheTruthOfTwoStopsViolatesNothing) {
    const Trajectory trajectory = truth_of_two_stops();
    for (const auto& law : {energy, gap, phases, contact_force}) EXPECT_TRUE(law(trajectory).empty());
}

TEST(MutatedRuns, TwoStops) {
    const auto lie = [](const char* name, Violations (*law)(const Trajectory&), void (*change)(Trajectory&)) {
        Trajectory trajectory = truth_of_two_stops();
        change(trajectory);
        EXPECT_FALSE(law(trajectory).empty()) << name;
    };
    lie("the knee is said to stay locked", phases, [](Trajectory& t) {
        Event& event = blow(t);
        event.mode = Mode::holding(event.opened);
        event.opened = {};
    });
    lie("another contact is held", phases, [](Trajectory& t) { t.phases[1].mode = Mode::holding(ContactSet::of(1)); });
    lie("another contact strikes", phases, [](Trajectory& t) { blow(t).contacts = ContactSet::of(0); });
    lie("the knee is left where it is", phases, [](Trajectory& t) {
        Event& event = blow(t);
        event.v_after[1] = 0.0;
    });
    lie("work that nobody did", energy, [](Trajectory& t) {
        for (DenseSegment& piece : t.pieces)
            if (piece.start > 5.0) piece.work += 1e-6;
    });
    lie("a loss that was none", energy, [](Trajectory& t) { blow(t).loss += 1e-9; });
    lie("a gap that closes unseen", gap, [](Trajectory& t) {
        for (const DenseSegment& piece : t.pieces)
            if (piece.mode.held().empty()) t.coefficients[piece.first] += 0.4;  // theta1 beyond the wall
    });
    lie("a wall that pulls", contact_force, [](Trajectory& t) {
        // Holding the wall as well would need a pulling force: the weight exceeds the motor torque.
        const Mode both = Mode::holding(ContactSet::of(0).with(1));
        for (DenseSegment& piece : t.pieces)
            if (!piece.mode.held().empty()) piece.mode = both;
        t.phases[1].mode = both;
    });
}

// ---- dry friction ----

Trajectory truth_of_friction() {
    const auto model = model_of("block_on_incline");  // sticks at 0.42
    return simulate(model, model->default_run());
}

TEST(MutatedRuns, TheTruthOfFrictionViolatesNothing) {
    const Trajectory trajectory = truth_of_friction();
    EXPECT_EQ(trajectory.phases.size(), 2u);
    for (const auto& law : {energy, gap, phases, contact_force, friction}) EXPECT_TRUE(law(trajectory).empty());
}

TEST(MutatedRuns, Friction) {
    const auto lie = [](const char* name, Violations (*law)(const Trajectory&), void (*change)(Trajectory&)) {
        Trajectory trajectory = truth_of_friction();
        change(trajectory);
        EXPECT_FALSE(law(trajectory).empty()) << name;
    };
    lie("it slides on where it sticks", phases, [](Trajectory& t) { t.events.clear(); });
    lie("it is said to start to slide", phases, [](Trajectory& t) { t.events[0].kind = Event::Kind::slip; });
    lie("it stops with a jump", phases, [](Trajectory& t) { t.events[0].v_before[0] = 1e-12; });
    // Samples are projected to u = 0, which takes their kinetic energy.
    lie("it is said to stick where it slides", energy, [](Trajectory& t) {
        for (DenseSegment& piece : t.pieces) piece.mode = Mode::holding(ContactSet::of(0));
        t.phases[0].mode = Mode::holding(ContactSet::of(0));
    });
    lie("it is said to slide to the other side", friction, [](Trajectory& t) {
        const Mode other = Mode().with(0, ContactState::slip_plus);
        for (DenseSegment& piece : t.pieces)
            if (piece.start < t.phases[0].end) piece.mode = other;
        t.phases[0].mode = other;
    });
    lie("it sticks outside the cone", friction, [](Trajectory& t) { t.run.parameters[2] = 0.4; });  // mu < tan 25 deg
    lie("heat is taken back", friction, [](Trajectory& t) {
        for (DenseSegment& piece : t.pieces)
            if (piece.start > 0.4) piece.heat -= 1.0;
    });
    lie("heat that was none", energy, [](Trajectory& t) {
        for (DenseSegment& piece : t.pieces)
            if (piece.start > 0.4) piece.heat += 1e-6;
    });
}

}  // namespace
}  // namespace achilles::test
