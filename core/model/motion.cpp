#include "model/motion.hpp"

#include <utility>

#include "contacts/contact_law.hpp"

namespace achilles {

namespace {

// The motion's acceleration as it was derived, and as it follows from the forces of what is held.
std::pair<Expressions, Expressions> accelerations(const ModeEquations& motion) {
    for (std::size_t i = 0; i < motion.contacts.size(); ++i)
        if (motion.mode.held() == ContactSet::of(i)) return {motion.f, motion.contacts[i].f_by_force};
    return {motion.f, {}};
}

// The event function of what the law of a contact watches.
Expression event_function(const ContactEquations& contact, WatchedFunction watched) {
    switch (watched) {
        case WatchedFunction::gap:
            return contact.gap;
        case WatchedFunction::normal_force:
            return contact.hddot;
    }
    return {};
}

// The pivots of M in a motion's graph.
Expressions pivots_of(const Equations& equations, Graph& graph) {
    Expressions pivots;
    for (const Expression pivot : equations.pivots) pivots.push_back(graph.adopt(pivot));
    return pivots;
}

// The motion with these event functions, in the way that takes fewer products.
SeriesProgram series_of(const ModeEquations& motion, const Expressions& event_functions, const Expressions& pivots,
                        const Layout& layout) {
    const auto with = [&](const Expressions& acceleration) {
        return SeriesProgram(Program(joined({acceleration, event_functions, pivots}), layout.slots()), layout.dof,
                             event_functions.size());
    };
    const auto [f, by_force] = accelerations(motion);
    SeriesProgram series = with(f);
    if (!by_force.empty()) {
        SeriesProgram other = with(by_force);
        if (other.inner_sums() < series.inner_sums()) series = std::move(other);
    }
    return series;
}

}  // namespace

SeriesProgram make_hddot_series(const ModeEquations& motion, const Equations& equations, const Layout& layout) {
    Expressions hddot;
    for (const ContactEquations& contact : motion.contacts) hddot.push_back(contact.hddot);
    return series_of(motion, hddot, pivots_of(equations, motion.f.front().graph()), layout);
}

Motion make_motion(const ModeEquations& motion, const Equations& e, const Layout& layout) {
    const Slots slots = layout.slots();
    Graph& graph = motion.f.front().graph();
    const Expressions pivots = pivots_of(e, graph);
    Expressions hddot, jerks, event_functions;
    for (std::size_t i = 0; i < motion.contacts.size(); ++i) {
        const ContactEquations& c = motion.contacts[i];
        hddot.push_back(c.hddot);
        const WatchedFunction watched = law_of(motion.mode.state(i)).watched;
        event_functions.push_back(event_function(c, watched));
        if (watched == WatchedFunction::normal_force) jerks.push_back(jerk_of(c, layout));
    }
    SeriesProgram series = series_of(motion, event_functions, pivots, layout);
    return {motion.mode, ProgramOf<MotionTerms>::of(slots, motion.f, pivots, joined({hddot, jerks})),
            std::move(series)};
}

}  // namespace achilles
