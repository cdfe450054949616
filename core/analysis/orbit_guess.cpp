// Where the search for a periodic orbit starts, and at which instant of a found one its period begins.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/measures.hpp"
#include "analysis/return_map.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

using Eigen::Index, Eigen::VectorXd;

namespace {

VectorXd stacked(const State& state) {
    VectorXd x(2 * state.q.size());
    x << state.q, state.v;
    return x;
}

State state_at(const Trajectory& run, double t) {
    State state = Sampler(run).at(t).state;
    state.t = t;
    return state;
}

// A motion between two events.
struct MotionPhase {
    double start = 0.0, end = 0.0;
    bool after_release = false;
    Mode mode;
};
// The longest part of a motion in contact in which its held contacts count: elsewhere a start would not be held. Returns
// false if the motion has no such part.
bool keep_where_contacts_count(const Trajectory& run, MotionPhase& phase) {
    const Model& model = *run.model;
    ContactSet conditional;
    for (const std::size_t i : phase.mode.held())
        if (model.is_conditional(i)) conditional = conditional.with(i);
    if (conditional.empty()) return true;
    auto guards = model.evaluator(model.guards(), run.run.parameters);
    constexpr int instants = 64;
    int first = 0, best_first = 0, best = 0;  // instants that count in succession
    const double length = phase.end - phase.start;
    for (int k = 0; k <= instants; ++k) {
        set_state(guards, state_at(run, phase.start + length * k / instants));
        guards.run();
        bool counts = true;
        for (const std::size_t i : conditional) counts = counts && guards.output(model.guard_of_contact(i)) > 0.0;
        if (!counts) {
            first = k + 1;
        } else if (k - first > best) {
            best_first = first;
            best = k - first;
        }
    }
    phase.end = phase.start + length * (best_first + best) / instants;
    phase.start += length * best_first / instants;
    return best > 0;
}

// The flights of a run; if there are none but short ones, as of a foot that is put down, the motions in contact.
std::vector<MotionPhase> flights_of(const Trajectory& run) {
    std::vector<MotionPhase> flights, in_contact;
    double from = run.run.options.start_time;
    Mode mode = run.phases.front().mode;
    bool released = false;
    const auto add = [&](double to) {
        if (to > from) (is_flight(mode) ? flights : in_contact).push_back({from, to, released, mode});
    };
    for (const Event& event : run.events) {
        // The last impact before a truncation is followed by its Zeno point; there is no flight between them.
        add(event.is_zeno() ? from : event.t);
        from = event.t;
        mode = event.mode;
        released = event.is_release();
    }
    add(run.end_time);
    const double shortest = 1e-3 * (run.end_time - run.run.options.start_time);
    const bool flies = std::any_of(flights.begin(), flights.end(),
                                   [&](const MotionPhase& flight) { return flight.end - flight.start > shortest; });
    if (flies || in_contact.empty()) return flights;
    std::erase_if(in_contact, [&](MotionPhase& phase) { return !keep_where_contacts_count(run, phase); });
    return in_contact;
}

ShootingPoint lap_from(const ReturnMap& map, const State& state, double period, Mode mode = {}) {
    return {stacked(state), state.t, period, map.run().parameters, mode.is_free() ? Mode() : mode};
}

// The longest flight that starts before this time.
std::optional<MotionPhase> longest(const std::vector<MotionPhase>& flights, double before) {
    std::optional<MotionPhase> best;
    for (const MotionPhase& flight : flights)
        if (flight.start < before && (!best || flight.end - flight.start > best->end - best->start)) best = flight;
    return best;
}

// Whether the run starts in a flight that is not too short.
bool begins_in_flight(const std::vector<MotionPhase>& flights, const Trajectory& run, double period) {
    return !flights.empty() && flights.front().start == run.run.options.start_time &&
           flights.front().end - flights.front().start > 1e-3 * period;
}

// A guess at the start, or in the middle of the longest flight that starts in [from, from + period].
ShootingPoint in_flight(const ReturnMap& map, const Trajectory& run, double period, double from) {
    std::vector<MotionPhase> flights = flights_of(run);
    const bool at_start = from == run.run.options.start_time;
    if (at_start && begins_in_flight(flights, run, period) && flights.front().mode.is_free())
        return lap_from(map, run.run.start(), period);
    std::erase_if(flights, [&](const MotionPhase& flight) { return flight.start < from; });
    const auto flight = longest(flights, from + period);
    if (!flight) throw OrbitNotFound("the run has no motion between its events in which a period could begin");
    return lap_from(map, state_at(run, 0.5 * (flight->start + flight->end)), period, flight->mode);
}

// The distance between state b and state a moved by the shift, relative to the size of the states.
double return_distance(const ReturnMap& map, const State& scale, const State& a, const State& b) {
    double sum = 0.0;
    const double q = std::max(scale.q.maxCoeff(), 1e-300), v = std::max(scale.v.maxCoeff(), 1e-300);
    for (Index i = 0; i < a.q.size(); ++i) {
        sum += std::pow((b.v[i] - a.v[i]) / v, 2);
        if (map.is_free(i)) continue;
        const double shift = map.shift(static_cast<std::size_t>(i), map.run().parameters).value;
        // A shifted coordinate is measured by its shift.
        const double size = shift != 0.0 ? std::abs(shift) : q;
        sum += std::pow((b.q[i] - a.q[i] - shift) / size, 2);
    }
    return std::sqrt(sum);
}

// A guess between the two most similar releases.
std::optional<ShootingPoint> from_releases(const ReturnMap& map, const Trajectory& run) {
    std::vector<std::size_t> releases;
    for (std::size_t i = 0; i < run.events.size(); ++i)
        if (run.events[i].is_release() && run.events[i].mode.is_free()) releases.push_back(i);
    if (releases.size() < 2) return std::nullopt;
    const State scale = scale_of(run);
    const auto state = [&](std::size_t i) {
        const Event& event = run.events[releases[i]];
        return State{event.q, event.v_after, event.t};
    };
    double least = std::numeric_limits<double>::infinity();
    const auto each = [&](const auto& take) {
        for (std::size_t between = 1; between < releases.size(); ++between)
            for (std::size_t i = releases.size() - between; i-- > 0;)
                if (take(i, i + between, return_distance(map, scale, state(i), state(i + between)))) return;
    };
    each([&](std::size_t, std::size_t, double distance) {
        least = std::min(least, distance);
        return false;
    });
    std::optional<ShootingPoint> best;
    each([&](std::size_t i, std::size_t j, double distance) {
        if (distance > 2.0 * least + 1e-6) return false;
        const double t = state(i).t;
        const double next = run.events[releases[i] + 1].t;
        best = lap_from(map, state_at(run, 0.5 * (t + next)), state(j).t - t);
        return true;
    });
    return best;
}

// A guess from the start to the closest return after the run has been far away.
ShootingPoint from_recurrence(const ReturnMap& map, const Trajectory& run) {
    const ShootingPoint begin =
        in_flight(map, run, run.end_time - run.run.options.start_time, run.run.options.start_time);
    const State first = state_at(run, begin.start_time), scale = scale_of(run);
    constexpr int instants = 4000;
    Sampler sampler(run);
    std::vector<double> distance;
    const double length = run.end_time - begin.start_time;
    for (int i = 1; i <= instants; ++i)
        distance.push_back(
            return_distance(map, scale, first, sampler.at(begin.start_time + length * i / instants).state));
    const double far = *std::max_element(distance.begin(), distance.end());
    auto from = std::find_if(distance.begin(), distance.end(), [&](double d) { return d > 0.5 * far; });
    const double near = *std::min_element(from, distance.end());
    while (from != distance.end() && *from > near + 0.1 * far) ++from;
    while (from + 1 != distance.end() && from[1] < *from) ++from;
    ShootingPoint lap = begin;
    lap.period = length * static_cast<double>(from - distance.begin() + 1) / instants;
    return lap;
}

}  // namespace

VectorXd scale_of(const ReturnMap& map, const ShootingPoint& lap, double of_parameter) {
    const Trajectory run = map.run_of(lap, lap.period);
    const State scale = achilles::scale_of(run);
    const double q = std::max(scale.q.maxCoeff(), 1e-6), v = std::max(scale.v.maxCoeff(), 1e-6);
    const Index n = map.dof();
    VectorXd s(2 * n + 2);
    for (Index i = 0; i < n; ++i) {
        s[i] = std::max(scale.q[i], 1e-2 * q);
        s[n + i] = std::max(scale.v[i], 1e-2 * v);
    }
    s[2 * n] = lap.period;
    s[2 * n + 1] = of_parameter;
    return s;
}

ShootingPoint earlier(const ReturnMap& map, ShootingPoint lap) {
    while (lap.start_time >= map.run().options.start_time + lap.period) {
        lap.start_time -= lap.period;
        for (Index i = 0; i < map.dof(); ++i) lap.x[i] -= map.shift(static_cast<std::size_t>(i), lap.parameters).value;
    }
    return lap;
}

ShootingPoint guess_of(const ReturnMap& map, int periods) {
    const Options& options = map.run().options;
    const double T = map.period(map.run().parameters).value;
    const double length = T > 0.0 ? (periods + 2) * T : (periods + 1) * (options.end_time - options.start_time);
    const Trajectory run = map.run_of(lap_from(map, map.run().start(), T), length);
    if (run.outcome.kind != Outcome::Kind::end_time && run.events.empty()) throw OrbitNotFound(run.outcome.message);
    if (map.is_driven()) return earlier(map, in_flight(map, run, T, options.start_time + periods * T));
    if (T > 0.0) {
        int before = periods;
        for (const MotionPhase& flight : flights_of(run))
            if (flight.after_release && before-- == 0)
                return lap_from(map, state_at(run, 0.5 * (flight.start + flight.end)), T, flight.mode);
        return in_flight(map, run, T, options.start_time + periods * T);
    }
    if (auto found = from_releases(map, run)) return *found;
    return from_recurrence(map, run);
}

ShootingPoint rebased(const ReturnMap& map, const ShootingPoint& lap, bool past_a_release) {
    // Two periods, so that a flight that extends into the next period is complete.
    const Trajectory run = map.run_of(lap, 2.0 * lap.period);
    const double end = lap.start_time + lap.period;
    std::optional<MotionPhase> best;
    for (const MotionPhase& flight : flights_of(run)) {
        if (flight.start == lap.start_time || flight.start >= end) continue;
        constexpr double too_short = 1e-3;
        if (!past_a_release && flight.end > end && flight.end - flight.start > too_short * lap.period) {
            best = flight;  // the flight of the present start
            break;
        }
        const bool better = !best || (past_a_release && flight.after_release != best->after_release
                                          ? flight.after_release
                                          : flight.end - flight.start > best->end - best->start);
        if (better) best = flight;
    }
    if (!best) return lap;
    ShootingPoint moved = lap_from(map, state_at(run, 0.5 * (best->start + best->end)), lap.period, best->mode);
    moved.parameters = lap.parameters;
    return moved;
}

}  // namespace achilles
