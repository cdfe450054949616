#include "floor/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/model.hpp"

namespace achilles::test {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Without recorded events, the phases show which contacts have come to rest and which were released.
void read_phases(const Trajectory& trajectory, Outline& outline) {
    for (std::size_t i = 1; i < trajectory.phases.size(); ++i) {
        const ContactSet before = trajectory.phases[i - 1].mode.held(), after = trajectory.phases[i].mode.held();
        for (std::size_t contact = 0; contact < outline.contacts.size(); ++contact) {
            Outline::ContactOutline& known = outline.contacts[contact];
            if (after.without(before).contains(contact)) ++known.zenos;
            if (before.without(after).contains(contact)) known.leaves.push_back(trajectory.phases[i].start);
        }
    }
}

// Impact speeds below this are not compared if there are several contacts. Contacts that touch without force may have
// impacts below the accuracy of the gap.
constexpr double slowest = 1e-6;

void read_event(const Event& event, std::size_t contact, bool several, Outline::ContactOutline& known) {
    if (several && event.kind == Event::Kind::impact && event.impact_speed < slowest && event.opened.empty()) return;
    if (event.opened.contains(contact)) known.leaves.push_back(event.t);
    if (!event.contacts.contains(contact)) return;
    if (event.kind == Event::Kind::release) known.leaves.push_back(event.t);
    if (event.kind == Event::Kind::impact) known.bounces.back().impacts.push_back(event.t);
    if (event.kind != Event::Kind::zeno) return;
    known.bounces.back().zeno_low = event.certificate->zeno_low;
    known.bounces.back().zeno_high = event.certificate->zeno_high;
    ++known.zenos;
    known.bounces.emplace_back();
}

void compare(const Outline::ContactOutline& a, const Outline::ContactOutline& b, bool ends_alone,
             const std::string& name, Distance& difference) {
    if (a.zenos != b.zenos || a.leaves.size() != b.leaves.size())
        difference.add(infinity, fmt::format("{}{} Zeno points and {} releases against {} and {}", name, a.zenos,
                                             a.leaves.size(), b.zenos, b.leaves.size()));
    for (std::size_t phase = 0; !ends_alone && phase < std::min(a.bounces.size(), b.bounces.size()); ++phase) {
        const auto &x = a.bounces[phase], &y = b.bounces[phase];
        const bool both_end = phase < a.zenos && phase < b.zenos;
        if (!both_end && x.impacts.size() != y.impacts.size())
            difference.add(infinity, fmt::format("{}{} impacts against {} in phase {}", name, x.impacts.size(),
                                                 y.impacts.size(), phase));
        for (std::size_t i = 0; i < std::min(x.impacts.size(), y.impacts.size()); ++i)
            difference.add(std::abs(x.impacts[i] - y.impacts[i]),
                           fmt::format("{}impact {} of phase {}, t = {:.9g}", name, i + 1, phase, x.impacts[i]));
        if (both_end)
            difference.add(std::max({0.0, x.zeno_low - y.zeno_high, y.zeno_low - x.zeno_high}),
                           fmt::format("{}Zeno point {}, t = {:.9g}", name, phase + 1, x.zeno_low));
    }
    for (std::size_t i = 0; i < std::min(a.leaves.size(), b.leaves.size()); ++i)
        difference.add(std::abs(a.leaves[i] - b.leaves[i]),
                       fmt::format("{}release {}, t = {:.9g}", name, i + 1, a.leaves[i]));
}

}  // namespace

void Distance::add(double more, const std::string& place) {
    if (std::isnan(more)) more = infinity;
    if (more <= size) return;
    size = more;
    where = place;
}

Outline outline_of(const Trajectory& trajectory) {
    Outline outline;
    outline.contacts.resize(trajectory.model->contacts());
    outline.ends_alone = trajectory.pieces.empty();
    if (outline.ends_alone) read_phases(trajectory, outline);
    for (const Event& event : trajectory.events)
        for (std::size_t contact = 0; contact < outline.contacts.size(); ++contact)
            read_event(event, contact, outline.contacts.size() > 1, outline.contacts[contact]);
    outline.end.resize(2 * trajectory.end.q.size());
    outline.end << trajectory.end.q, trajectory.end.v;
    return outline;
}

Outline outline_of(const TrueExecution& truth) {
    Outline outline;
    Outline::ContactOutline& known = outline.contacts.emplace_back();
    for (const TrueEvent& event : truth.events) {
        const double t = static_cast<double>(event.t);
        if (event.kind == Event::Kind::impact) known.bounces.back().impacts.push_back(t);
        if (event.kind == Event::Kind::release) known.leaves.push_back(t);
        if (event.kind != Event::Kind::zeno) continue;
        known.bounces.back().zeno_low = known.bounces.back().zeno_high = t;
        ++known.zenos;
        known.bounces.emplace_back();
    }
    const std::size_t n = truth.end.q.size();
    outline.end.resize(static_cast<Eigen::Index>(2 * n));
    for (std::size_t i = 0; i < n; ++i) {
        outline.end[static_cast<Eigen::Index>(i)] = static_cast<double>(truth.end.q[i]);
        outline.end[static_cast<Eigen::Index>(n + i)] = static_cast<double>(truth.end.v[i]);
    }
    return outline;
}

Distance between(const Outline& a, const Outline& b) {
    Distance difference;
    for (std::size_t i = 0; i < a.contacts.size(); ++i)
        compare(a.contacts[i], b.contacts[i], a.ends_alone || b.ends_alone,
                a.contacts.size() > 1 ? fmt::format("contact {}: ", i) : "", difference);
    difference.add((a.end - b.end).cwiseAbs().maxCoeff(), "end state");
    return difference;
}

}  // namespace achilles::test
