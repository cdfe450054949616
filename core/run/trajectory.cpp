// Evaluation and summary quantities of a trajectory, and the names of its kinds.
#include "run/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "number/inner_loops.hpp"

namespace achilles {

bool is_plastic_landing(const Event& event) {
    return event.is_zeno() && event.truncation && event.truncation->t == event.t && event.certificate &&
           event.certificate->zeno_low == event.certificate->zeno_high;
}

State state_in(const DenseSegment& piece, std::span<const double> coefficients, Eigen::Index dof, double t) {
    using Pair = Pack<double, 2>;
    const double theta =
        piece.end > piece.start ? std::clamp((t - piece.start) / (piece.end - piece.start), 0.0, 1.0) : 0.0;
    const auto n = static_cast<std::size_t>(dof);
    std::array<Pair::Value, max_coordinates> pairs{};  // adjacent components of (q, v)
    const double* block = coefficients.data() + piece.first + 2 * n * (piece.degree + std::size_t{1});
    for (std::uint32_t k = piece.degree + 1; k-- > 0;) {
        block -= 2 * n;
        for (std::size_t i = 0; i < n; ++i) pairs[i] = pairs[i] * theta + Pair::load(block + 2 * i);
    }
    std::array<double, 2 * max_coordinates> values;
    std::memcpy(values.data(), pairs.data(), sizeof values);
    return {Eigen::Map<const Vector>(values.data(), dof), Eigen::Map<const Vector>(values.data() + n, dof), t};
}

double integration_error_of_time(const Trajectory& trajectory, std::size_t zeno_event) {
    const Event& zeno = trajectory.events[zeno_event];
    const Event* first = nullptr;  // first impact of the sequence
    for (std::size_t i = zeno_event; i-- > 0 && trajectory.events[i].is_impact();)
        if (trajectory.events[i].contacts.without(zeno.contacts).empty()) first = &trajectory.events[i];
    if (first == nullptr || !(first->impact_speed > 0.0)) return 0.0;
    const auto& pieces = trajectory.pieces;
    const auto after = std::lower_bound(pieces.begin(), pieces.end(), first->t,
                                        [](const DenseSegment& piece, double t) { return piece.start < t; });
    const Options& used = trajectory.rerun_options ? *trajectory.rerun_options : trajectory.run.options;
    constexpr double generous = 30.0;
    double state = generous * integration_error(used, std::max(1.0, static_cast<double>(after - pieces.begin())));
    for (std::size_t i = 0; i < zeno_event; ++i)
        if (const auto& cut = trajectory.events[i].certificate)
            state += std::max(cut->shadowing_position.value_or(0.0), cut->shadowing_velocity.value_or(0.0));
    return state * (1.0 + zeno.t - first->t) / first->impact_speed;
}

double bytes_of(const Trajectory& trajectory) {
    const auto n = static_cast<std::size_t>(trajectory.run.q.size());
    const std::size_t event = sizeof(Event) + 3 * (n * sizeof(double) + 2 * sizeof(void*));
    return static_cast<double>(trajectory.coefficients.size() * sizeof(double) +
                               trajectory.pieces.size() * sizeof(DenseSegment) + trajectory.events.size() * event +
                               trajectory.phases.size() * sizeof(Phase) +
                               trajectory.passages.size() * sizeof(EventRecord));
}

State scale_of(const Trajectory& trajectory) {
    State scale{trajectory.run.q.cwiseAbs(), trajectory.run.v.cwiseAbs()};
    const auto take = [&](const Vector& q, const Vector& v) {
        scale.q = scale.q.cwiseMax(q.cwiseAbs());
        scale.v = scale.v.cwiseMax(v.cwiseAbs());
    };
    for (const Event& event : trajectory.events) {
        take(event.q_before(), event.v_before);
        take(event.q, event.v_after);
    }
    take(trajectory.end.q, trajectory.end.v);
    return scale;
}

std::vector<EventRecord> sequence_of(const Trajectory& trajectory) {
    if (trajectory.events.empty()) return trajectory.passages;
    std::vector<EventRecord> sequence;
    sequence.reserve(trajectory.events.size());
    for (const Event& event : trajectory.events)
        sequence.push_back({{event.kind},
                            event.contacts,
                            event.t,
                            event.impact_speed,
                            event.jump ? static_cast<int>(event.jump->number) : -1});
    return sequence;
}

double flush_noise_to_zero(double value, double scale) { return std::abs(value) < noise * scale ? 0.0 : value; }

std::string_view to_text(Certificate::Tail tail) {
    switch (tail) {
        case Certificate::Tail::none:
            return "none";
        case Certificate::Tail::slip:
            return "slip";
        case Certificate::Tail::stick:
            return "stick";
        case Certificate::Tail::stick_then_slip:
            return "stick then slip";
    }
    return "";
}

std::string_view to_text(Phase::Kind kind) { return kind == Phase::Kind::hybrid ? "hybrid" : "constrained"; }

const Inequality& Certificate::Decision::closest() const {
    const Inequality& earlier = position.ratio() > time.ratio() ? position : time;
    return velocity.ratio() > earlier.ratio() ? velocity : earlier;
}

std::vector<Inequality> Certificate::inequalities() const {
    std::vector<Inequality> all;
    if (decision) all = {decision->time, decision->position, decision->velocity};
    all.insert(all.end(), assumptions.begin(), assumptions.end());
    return all;
}

std::string_view to_text(Outcome::Kind kind) {
    switch (kind) {
        case Outcome::Kind::end_time:
            return "end time";
        case Outcome::Kind::too_many_impacts:
            return "too many impacts";
        case Outcome::Kind::too_many_steps:
            return "too many steps";
        case Outcome::Kind::out_of_memory:
            return "out of memory";
        case Outcome::Kind::not_a_number:
            return "not a number";
        case Outcome::Kind::left_the_domain:
            return "left the domain";
        case Outcome::Kind::step_too_small:
            return "step too small";
        case Outcome::Kind::simultaneous_impacts:
            return "simultaneous impacts";
        case Outcome::Kind::redundant_contacts:
            return "redundant contacts";
        case Outcome::Kind::painleve:
            return "painleve";
        case Outcome::Kind::impact_not_unique:
            return "impact not unique";
        case Outcome::Kind::energy_gain:
            return "energy gain";
        case Outcome::Kind::too_many_events:
            return "too many events";
        case Outcome::Kind::cancelled:
            return "cancelled";
        case Outcome::Kind::undecided:
            return "undecided";
    }
    return "undecided";
}

}  // namespace achilles
