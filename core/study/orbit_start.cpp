#include "study/orbit_start.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/sampler.hpp"

namespace achilles {

using Eigen::Index, Eigen::VectorXd;

namespace {

VectorXd stacked(const State& state) {
    VectorXd x(2 * state.q.size());
    x << state.q, state.v;
    return x;
}

// A stretch of flight, between two events.
struct Flight {
    double start = 0.0, end = 0.0;
    bool after_release = false;
};
std::vector<Flight> flights_of(const Trajectory& run) {
    std::vector<Flight> flights;
    double from = run.run.options.start_time;
    ContactSet held = run.phases.front().held;
    bool released = false;
    const auto add = [&](double to) {
        if (held.empty() && to > from) flights.push_back({from, to, released});
    };
    for (const Event& event : run.events) {
        // What follows the collision at which a bouncing is cut is its Zeno point.
        add(event.kind == Event::Kind::zeno ? from : event.t);
        from = event.t;
        held = event.held;
        released = event.kind == Event::Kind::release;
    }
    add(run.end_time);
    return flights;
}

State state_at(const Trajectory& run, double t) {
    State state = Sampler(run).at(t).state;
    state.t = t;
    return state;
}

Lap lap_from(const ReturnMap& map, const State& state, double period) {
    return {stacked(state), state.t, period, map.run().parameters};
}

// The longest flight of a stretch of the run.
std::optional<Flight> longest(const std::vector<Flight>& flights, double before) {
    std::optional<Flight> best;
    for (const Flight& flight : flights)
        if (flight.start < before && (!best || flight.end - flight.start > best->end - best->start)) best = flight;
    return best;
}

// Whether the run begins well inside a flight.
bool begins_in_flight(const std::vector<Flight>& flights, const Trajectory& run, double period) {
    return !flights.empty() && flights.front().start == run.run.options.start_time &&
           flights.front().end - flights.front().start > 1e-3 * period;
}

// The start, or the middle of a flight behind it; from a time on, for a period at most.
Lap in_flight(const ReturnMap& map, const Trajectory& run, double period, double from) {
    std::vector<Flight> flights = flights_of(run);
    const bool at_start = from == run.run.options.start_time;
    if (at_start && begins_in_flight(flights, run, period)) return lap_from(map, run.run.start(), period);
    std::erase_if(flights, [&](const Flight& flight) { return flight.start < from; });
    const auto flight = longest(flights, from + period);
    if (!flight) throw NoOrbit("the run never leaves contact, but the section must lie in free flight");
    return lap_from(map, state_at(run, 0.5 * (flight->start + flight->end)), period);
}

// How far two states are from one being the other moved on, by their size.
double missed(const ReturnMap& map, const State& scale, const State& a, const State& b) {
    double sum = 0.0;
    const double q = std::max(scale.q.maxCoeff(), 1e-300), v = std::max(scale.v.maxCoeff(), 1e-300);
    for (Index i = 0; i < a.q.size(); ++i) {
        const double shift = map.shift(static_cast<std::size_t>(i), map.run().parameters).value;
        // A coordinate that is moved on is as large as it has come far.
        const double size = shift != 0.0 ? std::abs(shift) : q;
        sum += std::pow((b.q[i] - a.q[i] - shift) / size, 2) + std::pow((b.v[i] - a.v[i]) / v, 2);
    }
    return std::sqrt(sum);
}

// From one release to that which is most like it.
std::optional<Lap> from_releases(const ReturnMap& map, const Trajectory& run) {
    std::vector<std::size_t> releases;
    for (std::size_t i = 0; i < run.events.size(); ++i)
        if (run.events[i].kind == Event::Kind::release && run.events[i].held.empty()) releases.push_back(i);
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
                if (take(i, i + between, missed(map, scale, state(i), state(i + between)))) return;
    };
    each([&](std::size_t, std::size_t, double distance) {
        least = std::min(least, distance);
        return false;
    });
    std::optional<Lap> best;
    each([&](std::size_t i, std::size_t j, double distance) {
        if (distance > 2.0 * least + 1e-6) return false;
        const double t = state(i).t;
        const double next = run.events[releases[i] + 1].t;
        best = lap_from(map, state_at(run, 0.5 * (t + next)), state(j).t - t);
        return true;
    });
    return best;
}

// From the start to where the run comes nearest to it, once it has been far.
Lap from_recurrence(const ReturnMap& map, const Trajectory& run) {
    const Lap begin = in_flight(map, run, run.end_time - run.run.options.start_time, run.run.options.start_time);
    const State first = state_at(run, begin.start_time), scale = scale_of(run);
    constexpr int instants = 4000;
    Sampler sampler(run);
    std::vector<double> distance;
    const double length = run.end_time - begin.start_time;
    for (int i = 1; i <= instants; ++i)
        distance.push_back(missed(map, scale, first, sampler.at(begin.start_time + length * i / instants).state));
    const double far = *std::max_element(distance.begin(), distance.end());
    auto from = std::find_if(distance.begin(), distance.end(), [&](double d) { return d > 0.5 * far; });
    const double near = *std::min_element(from, distance.end());
    while (from != distance.end() && *from > near + 0.1 * far) ++from;
    while (from + 1 != distance.end() && from[1] < *from) ++from;
    Lap lap = begin;
    lap.period = length * static_cast<double>(from - distance.begin() + 1) / instants;
    return lap;
}

}  // namespace

VectorXd scale_of(const ReturnMap& map, const Lap& lap, double of_parameter) {
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

Lap earlier(const ReturnMap& map, Lap lap) {
    while (lap.start_time >= map.run().options.start_time + lap.period) {
        lap.start_time -= lap.period;
        for (Index i = 0; i < map.dof(); ++i) lap.x[i] -= map.shift(static_cast<std::size_t>(i), lap.parameters).value;
    }
    return lap;
}

Lap guess_of(const ReturnMap& map, int periods) {
    const Options& options = map.run().options;
    const double T = map.period(map.run().parameters).value;
    const double length = T > 0.0 ? (periods + 2) * T : (periods + 1) * (options.end_time - options.start_time);
    const Trajectory run = map.run_of(lap_from(map, map.run().start(), T), length);
    if (run.outcome.kind != Outcome::Kind::end_time && run.events.empty()) throw NoOrbit(run.outcome.message);
    if (map.is_driven()) return earlier(map, in_flight(map, run, T, options.start_time + periods * T));
    if (T > 0.0) {
        int before = periods;
        for (const Flight& flight : flights_of(run))
            if (flight.after_release && before-- == 0)
                return lap_from(map, state_at(run, 0.5 * (flight.start + flight.end)), T);
        return in_flight(map, run, T, options.start_time + periods * T);
    }
    if (auto found = from_releases(map, run)) return *found;
    return from_recurrence(map, run);
}

Lap rebased(const ReturnMap& map, const Lap& lap, bool past_a_release) {
    // Two periods: what begins in one and ends in the next is one flight.
    const Trajectory run = map.run_of(lap, 2.0 * lap.period);
    const double end = lap.start_time + lap.period;
    std::optional<Flight> best;
    for (const Flight& flight : flights_of(run)) {
        if (flight.start == lap.start_time || flight.start >= end) continue;
        constexpr double too_short = 1e-3;
        if (!past_a_release && flight.end > end && flight.end - flight.start > too_short * lap.period) {
            best = flight;  // that in which it begins now
            break;
        }
        const bool better = !best || (past_a_release && flight.after_release != best->after_release
                                          ? flight.after_release
                                          : flight.end - flight.start > best->end - best->start);
        if (better) best = flight;
    }
    if (!best) return lap;
    Lap moved = lap_from(map, state_at(run, 0.5 * (best->start + best->end)), lap.period);
    moved.parameters = lap.parameters;
    return moved;
}

}  // namespace achilles
