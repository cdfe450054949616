#include "model/motion.hpp"

#include <stdexcept>
#include <utility>

namespace achilles {

Motion make_motion(ContactSet held, const Equations& e, const Layout& layout) {
    const Slots slots = layout.slots();
    const auto series_of = [&](const Expressions& acceleration, const Expressions& event_functions) {
        return SeriesProgram(Program(joined({acceleration, event_functions, e.pivots}), slots), layout.dof,
                             event_functions.size());
    };
    if (held.empty())
        return {held, ProgramOf<MotionTerms>::of(slots, e.f, e.pivots, Expressions{e.hddot}), series_of(e.f, {e.gap})};
    if (held != ContactSet::of(0)) throw std::out_of_range("a contact that the system does not have");
    // Two ways to say the same; one takes fewer products.
    SeriesProgram direct = series_of(e.f_c, {e.hddot}), by_force = series_of(e.f_by_force, {e.hddot});
    const bool is_cheaper = by_force.inner_sums() < direct.inner_sums();
    return {held, ProgramOf<MotionTerms>::of(slots, e.f_c, e.pivots, Expressions{e.hddot, e.jerk}),
            std::move(is_cheaper ? by_force : direct)};
}

}  // namespace achilles
