#include "certify/slope.hpp"

#include <cmath>
#include <stdexcept>

#include "simulate/impact.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

namespace {

const Event& zeno_event(const Trajectory& trajectory, std::size_t which) {
    for (const Event& event : trajectory.events)
        if (event.kind == Event::Kind::zeno && which-- == 0) return event;
    throw std::invalid_argument("the run has not so many Zeno points");
}

std::size_t only(ContactSet contacts) {
    std::size_t i = 0;
    while (!contacts.contains(i)) ++i;
    return i;
}

}  // namespace

Slope restart_slope(const std::shared_ptr<const Model>& model, Reinitialization kind, std::size_t zeno,
                    const std::vector<double>& speeds, double later) {
    const Run run = model->default_run();
    const Trajectory trajectory = simulate(model, run);
    const Event& event = zeno_event(trajectory, zeno);
    const std::size_t which = only(event.contacts);
    const Mode others = event.mode.without(event.contacts);
    const Contact contact = ContactKinematics(*model, run, which, others).at({event.q, event.v_after, event.t});
    TrueMotion motion(*model, run, 1e300, which, others);
    double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0;
    Slope slope;
    for (const double w : speeds) {
        const Point collision = motion.collision({event.q, event.v_after - w * contact.impulse_direction, event.t});
        const auto truth = motion.zeno(collision);
        if (!truth) return {};
        const Point there = motion.constrained(truth->point, later - truth->time, 1e-28);
        const Point here = motion.constrained(motion.restart(collision, kind), later, 1e-28);
        const auto error = static_cast<double>(distance(there.q, here.q) + distance(there.v, here.v));
        const double x = std::log(w), y = std::log(error);
        sx += x, sy += y, sxx += x * x, sxy += x * y, ++count;
        slope.factor = error / (w * w * w);
    }
    slope.order = (count * sxy - sx * sy) / (count * sxx - sx * sx);
    return slope;
}

}  // namespace achilles::test
