#include "model/motion.hpp"

#include <utility>

namespace achilles {

namespace {

// The motion's acceleration as it was derived, and as it follows from the forces of what is held.
std::pair<Expressions, Expressions> accelerations(const HeldEquations& motion) {
    for (std::size_t i = 0; i < motion.contacts.size(); ++i)
        if (motion.held == ContactSet::of(i)) return {motion.f, motion.contacts[i].f_by_force};
    return {motion.f, {}};
}

}  // namespace

Motion make_motion(const HeldEquations& motion, const Equations& e, const Layout& layout) {
    const Slots slots = layout.slots();
    Graph& graph = motion.f.front().graph();
    Expressions pivots, hddot, jerks, event_functions;
    for (const Expression pivot : e.pivots) pivots.push_back(graph.adopt(pivot));
    for (std::size_t i = 0; i < motion.contacts.size(); ++i) {
        const ContactEquations& c = motion.contacts[i];
        hddot.push_back(c.hddot);
        event_functions.push_back(motion.held.contains(i) ? c.hddot : c.gap);
        if (motion.held.contains(i)) jerks.push_back(jerk_of(c, layout));
    }
    const auto series_of = [&](const Expressions& acceleration) {
        return SeriesProgram(Program(joined({acceleration, event_functions, pivots}), slots), layout.dof,
                             event_functions.size());
    };
    const auto [f, by_force] = accelerations(motion);
    SeriesProgram series = series_of(f);
    if (!by_force.empty()) {  // two ways to say the same; one takes fewer products
        SeriesProgram other = series_of(by_force);
        if (other.inner_sums() < series.inner_sums()) series = std::move(other);
    }
    return {motion.held, ProgramOf<MotionTerms>::of(slots, f, pivots, joined({hddot, jerks})), std::move(series)};
}

}  // namespace achilles
