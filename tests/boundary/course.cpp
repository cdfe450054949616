#include "boundary/course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulate/impact.hpp"

namespace achilles::test {

namespace {

// Counts the impact at a cut, whether it is also stored as an event or not.
void cut_at(Stretch& stretch, double time) {
    while (!stretch.impacts.empty() && stretch.impacts.back() >= time) stretch.impacts.pop_back();
    stretch.impacts.push_back(time);
    stretch.cut = true;
}

void read_events(const Trajectory& trajectory, Course& course) {
    std::size_t at = 0;
    for (const Event& event : trajectory.events) {
        Stretch& stretch = course.stretches[std::min(at, course.stretches.size() - 1)];
        if (event.kind == Event::Kind::impact) {
            stretch.impacts.push_back(event.t);
            continue;
        }
        if (event.kind == Event::Kind::zeno) {
            cut_at(stretch, event.truncation->t);
            stretch.zeno_low = event.certificate->zeno_low;
            stretch.zeno_high = event.certificate->zeno_high;
        }
        ++at;
    }
    // A run may end between a cut and its Zeno point.
    const Phase& last = trajectory.phases.back();
    if (last.kind == Phase::Kind::constrained) return;
    for (std::size_t i = last.first_piece; i < trajectory.pieces.size(); ++i) {
        if (trajectory.pieces[i].mode.held().empty()) continue;
        cut_at(course.stretches.back(), trajectory.pieces[i].start);
        break;
    }
}

bool ends_on_the_surface(const Trajectory& trajectory) {
    const Contact contact = ContactKinematics(*trajectory.model, trajectory.run).at(trajectory.end);
    return std::abs(contact.h) < 1e-12 && std::abs(contact.hdot) < 1e-12;
}

// The time to the nearest neighbor in the sequence of impacts.
double room(const Stretch& truth, std::size_t i, double end) {
    const double before = i > 0 ? truth.impacts[i - 1] : truth.start;
    const double after = i + 1 < truth.impacts.size() ? truth.impacts[i + 1]
                         : truth.zeno_high > 0.0      ? truth.zeno_high
                                                      : end;
    return std::min(truth.impacts[i] - before, std::max(after - truth.impacts[i], 0.0));
}

using Kind = Difference::Kind;

std::optional<Difference> difference_in_flight(const Stretch& own, const Stretch& truth, std::size_t stretch,
                                               const Course& whole, const Impacts& same) {
    double drift = 1e-12, last = truth.start;
    const std::size_t common = std::min(own.impacts.size(), truth.impacts.size());
    std::size_t i = 0;
    for (; i < common; ++i) {
        const double late = own.impacts[i] - truth.impacts[i];
        if (!same.contains({stretch, i}) && std::abs(late) > 0.25 * room(truth, i, whole.end) + 100.0 * drift)
            return Difference{late > 0.0 ? Kind::missed_impact : Kind::extra_impact,
                              stretch,
                              i,
                              last,
                              std::min(own.impacts[i], truth.impacts[i]),
                              own.impacts[i]};
        drift = std::max(drift, std::abs(late));
        last = truth.impacts[i];
    }
    const bool settled = truth.cut;  // the reference's cut is an impact that it does not list
    if (i < own.impacts.size()) {
        if (settled) return std::nullopt;
        return Difference{Kind::extra_impact, stretch, i, last, own.impacts[i], {}};
    }
    if (own.cut) return std::nullopt;
    if (i < truth.impacts.size()) return Difference{Kind::missed_impact, stretch, i, last, truth.impacts[i], {}};
    if (settled) return Difference{Kind::missed_impact, stretch, i, last, truth.zeno_low, {}};
    return std::nullopt;
}

// Compares numbers of impacts only; which impact differs is not known here.
std::optional<Difference> difference_in_count(const Stretch& own, const Stretch& truth, std::size_t stretch) {
    if (own.count > truth.count && !truth.cut)
        return Difference{Kind::extra_impact, stretch, truth.count, truth.start, -1.0, {}};
    if (own.cut || (own.count >= truth.count && !truth.cut)) return std::nullopt;
    return Difference{Kind::missed_impact, stretch, own.count, truth.start, -1.0, {}};
}

// Both were cut in stretch i, and one of them reached its Zeno point. Without recorded events, the times are estimates
// and are compared with the tolerance `room`.
std::optional<Difference> difference_of_zeno(const Course& own, const Course& truth, std::size_t i) {
    constexpr double room = 1e-4;  // s
    const Stretch &a = own.stretches[i], &b = truth.stretches[i];
    const bool own_ends = i + 1 < own.stretches.size(), truth_ends = i + 1 < truth.stretches.size();
    const double cut = own.timed ? a.impacts.back() : own_ends ? own.stretches[i + 1].start : own.end;
    Difference difference{
        Kind::zeno_time, i, a.count, a.impacts.size() > 1 ? a.impacts[a.impacts.size() - 2] : b.start, cut, {}};
    if (!truth_ends) {
        if (!own_ends || (own.timed ? a.zeno_high : own.stretches[i + 1].start) >= truth.end - room)
            return std::nullopt;
        difference.kind = Kind::no_zeno;
        return difference;
    }
    const double low = !own_ends ? own.end - room : own.timed ? a.zeno_low : own.stretches[i + 1].start - room;
    const double high = !own_ends ? own.end + room : own.timed ? a.zeno_high : own.stretches[i + 1].start + room;
    if (low - 1e-12 <= b.zeno_low && b.zeno_low <= high + 1e-12) return std::nullopt;
    return difference;
}

// Removes a flight of zero height before the first phase in contact.
void forget_no_flight(Course& course) {
    if (course.stretches.size() < 2 || course.stretches[0].kind == Phase::Kind::constrained) return;
    if (course.stretches[1].start < 1e-9) course.stretches.erase(course.stretches.begin());
}

}  // namespace

Course course_of(const Trajectory& trajectory, bool from_contact) {
    Course course;
    course.end = trajectory.end_time;
    course.timed = !trajectory.pieces.empty();
    const std::size_t phases = trajectory.phases.size();
    for (std::size_t i = 0; i < phases; ++i) {
        const Phase& phase = trajectory.phases[i];
        Stretch stretch{phase.kind, phase.start, {}, static_cast<std::size_t>(phase.impacts), false, 0.0, 0.0};
        stretch.cut =
            phase.kind == Phase::Kind::hybrid && (i + 1 < phases || (!course.timed && ends_on_the_surface(trajectory)));
        course.stretches.push_back(stretch);
    }
    if (course.timed) read_events(trajectory, course);
    for (Stretch& stretch : course.stretches)
        if (course.timed) stretch.count = stretch.impacts.size();
    if (from_contact) forget_no_flight(course);
    return course;
}

Course course_of(const TrueExecution& truth, double end_time) {
    Course course;
    course.end = end_time;
    course.stretches.emplace_back();
    course.stretches.back().kind = truth.start_phase;
    for (const TrueEvent& event : truth.events) {
        const double t = static_cast<double>(event.t);
        Stretch& stretch = course.stretches.back();
        if (event.kind == Event::Kind::impact) {
            stretch.impacts.push_back(t);
            ++stretch.count;
            continue;
        }
        const bool settles = event.kind == Event::Kind::zeno;
        if (settles) {
            stretch.cut = true;
            stretch.zeno_low = stretch.zeno_high = t;
        }
        Stretch next;
        next.kind = settles ? Phase::Kind::constrained : Phase::Kind::hybrid;
        next.start = t;
        course.stretches.push_back(next);
    }
    return course;
}

Course until(Course course, double time) {
    while (course.stretches.size() > 1 && course.stretches.back().start > time) {
        course.stretches.pop_back();
        // Whether the sequence was cut before that time is determined by the impacts only.
        Stretch& last = course.stretches.back();
        if (last.kind == Phase::Kind::hybrid) last.zeno_low = last.zeno_high = 0.0;
    }
    Stretch& last = course.stretches.back();
    while (!last.impacts.empty() && last.impacts.back() > time) {
        last.impacts.pop_back();
        last.cut = false;
    }
    last.count = last.impacts.size();
    course.end = std::min(course.end, time);
    return course;
}

std::string to_text(const Course& course) {
    std::string text;
    for (const Stretch& stretch : course.stretches) {
        if (!text.empty()) text += ' ';
        text +=
            stretch.kind == Phase::Kind::constrained ? "C" : fmt::format("{}{}", stretch.count, stretch.cut ? "+" : "");
    }
    return text;
}

std::string to_text(Kind kind) {
    switch (kind) {
        case Kind::missed_impact:
            return "an impact is missed";
        case Kind::extra_impact:
            return "an impact too many";
        case Kind::missed_release:
            return "a release is missed";
        case Kind::extra_release:
            return "a release too many";
        case Kind::zeno_time:
            return "the Zeno time is outside its interval";
        case Kind::no_zeno:
            return "a Zeno point too many";
    }
    return {};
}

std::optional<Difference> first_difference(const Course& own, const Course& truth, const Impacts& same) {
    for (std::size_t i = 0; i < std::max(own.stretches.size(), truth.stretches.size()); ++i) {
        // Both have this stretch, so the one before ended with the same kind of event.
        const Stretch &a = own.stretches[i], &b = truth.stretches[i];
        const bool own_ends = i + 1 < own.stretches.size(), truth_ends = i + 1 < truth.stretches.size();
        if (a.kind != b.kind) {
            const bool stays = a.kind == Phase::Kind::constrained;
            return Difference{stays ? Kind::missed_release : Kind::extra_release, i, 0, 0.0, 0.0, {}};
        }
        if (a.kind == Phase::Kind::constrained) {
            if (truth_ends && !own_ends)
                return Difference{Kind::missed_release, i, 0, b.start, truth.stretches[i + 1].start, {}};
            if (own_ends && !truth_ends)
                return Difference{Kind::extra_release, i, 0, b.start, own.stretches[i + 1].start, {}};
            if (!own_ends) return std::nullopt;
            continue;
        }
        if (auto found = own.timed ? difference_in_flight(a, b, i, truth, same) : difference_in_count(a, b, i))
            return found;
        if (!own_ends && !truth_ends) return std::nullopt;
        if (auto found = difference_of_zeno(own, truth, i); found && !same.contains({i, zeno})) return found;
        // The sequence was cut, but the run ends before the Zeno point.
        if (!own_ends || !truth_ends) return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace achilles::test
