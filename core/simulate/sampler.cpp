#include "simulate/sampler.hpp"

#include <algorithm>
#include <cmath>

#include "model/model.hpp"
#include "simulate/surfaces.hpp"
#include "simulate/work.hpp"

namespace achilles {

ContactSet held_before(const Trajectory& trajectory, std::size_t event) {
    return event == 0 ? trajectory.phases.front().held : trajectory.events[event - 1].held;
}

ContactSet carriers_of(const Trajectory& trajectory, ContactSet held, double t) {
    if (held.count() < 2) return held;
    const auto fits = [&](const Phase& one) { return one.start <= t && one.held == held; };
    const auto phase = std::find_if(trajectory.phases.rbegin(), trajectory.phases.rend(), fits);
    return phase == trajectory.phases.rend() ? held : phase->carriers;
}

// A sample in contact is brought back to h = 0, hdot = 0: the dense output leaves the surface by its own error.
struct Sampler::Projection {
    explicit Projection(const Trajectory& trajectory)
        : surfaces(*trajectory.model, trajectory.run), work(*trajectory.model, trajectory.run) {}
    Surfaces surfaces;
    Work work;
};

Sampler::Sampler(const Trajectory& trajectory)
    : trajectory_(trajectory), projection_(std::make_unique<Projection>(trajectory)) {}
Sampler::~Sampler() = default;

Sample Trajectory::operator()(double t) const { return Sampler(*this).at(t); }

State Sampler::state(const Piece& piece, double t) const {
    const State state = state_in(piece, trajectory_.coefficients, trajectory_.run.q.size(), t);
    if (!piece.held.empty()) {
        State projected = state;
        if (projection_->surfaces.project(projected, piece.carriers, piece.carriers)) return projected;
    }
    return state;
}

double Sampler::work(const Piece& piece, double t) const {
    return piece.work + projection_->work.along(piece, trajectory_.coefficients, piece.start, t);
}

Sample Sampler::at(double t) {
    if (std::isnan(t)) throw InputError("the time", {}, "it is no number");
    t = std::clamp(t, trajectory_.run.options.start_time, trajectory_.end_time);
    const auto later = [](double time, const auto& x) { return time < x.start; };
    const auto event = std::upper_bound(trajectory_.events.begin(), trajectory_.events.end(), t,
                                        [](double time, const Event& x) { return time < x.t; });
    const auto phase = std::upper_bound(trajectory_.phases.begin(), trajectory_.phases.end(), t, later);
    const auto piece = std::upper_bound(trajectory_.pieces.begin(), trajectory_.pieces.end(), t, later);
    Sample sample;
    sample.t = t;
    sample.j = static_cast<int>(event - trajectory_.events.begin());
    sample.phase = phase == trajectory_.phases.begin() ? trajectory_.end_phase : std::prev(phase)->kind;
    if (piece == trajectory_.pieces.begin()) {  // a run without a step
        sample.held = trajectory_.end_held;
        sample.carriers = trajectory_.phases.back().carriers;
        sample.contact = !sample.held.empty();
        sample.state = trajectory_.end;
        sample.work = trajectory_.work;
        sample.loss = trajectory_.loss;
        return sample;
    }
    sample.contact = !std::prev(piece)->held.empty();
    sample.held = std::prev(piece)->held;
    sample.carriers = std::prev(piece)->carriers;
    sample.state = state(*std::prev(piece), t);
    sample.work = work(*std::prev(piece), t);
    sample.loss = std::prev(piece)->loss;
    // The last piece may end at an impact after which no step was made.
    if (t == trajectory_.end_time) {
        const auto& events = trajectory_.events;
        if (trajectory_.model->contacts() > 1 && !events.empty() && events.back().t == t) {
            sample.held = events.back().held;
            sample.carriers = trajectory_.phases.back().carriers;
            sample.contact = !sample.held.empty();
        }
        sample.state = trajectory_.end;
        sample.work = trajectory_.work;
        sample.loss = trajectory_.loss;
    }
    return sample;
}

Sample Sampler::in(const Piece& piece, double t, bool with_work) const {
    Sample sample;
    sample.t = t;
    sample.phase = piece.held.empty() ? Phase::Kind::hybrid : Phase::Kind::constrained;
    sample.contact = !piece.held.empty();
    sample.held = piece.held;
    sample.carriers = piece.carriers;
    sample.state = state(piece, t);
    sample.work = with_work ? work(piece, t) : 0.0;
    sample.loss = piece.loss;
    return sample;
}

std::vector<Sample> Sampler::all(int between) { return of_every(1, between, {}); }

std::vector<Sample> Sampler::some(std::size_t most_steps, int between) {
    if (trajectory_.pieces.size() <= most_steps) return all(between);  // also of a run that ended before its first step
    const std::size_t stride = 1 + (trajectory_.pieces.size() - 1) / most_steps;
    std::vector<bool> whole = blocks_with_events(stride);
    if (static_cast<std::size_t>(std::count(whole.begin(), whole.end(), true)) * stride > most_steps) whole.clear();
    return of_every(stride, between, whole);
}

// Of the blocks of so many steps, those in which something happens, or at an end of which.
std::vector<bool> Sampler::blocks_with_events(std::size_t stride) const {
    const std::vector<Piece>& pieces = trajectory_.pieces;
    std::vector<bool> result((pieces.size() + stride - 1) / stride);
    std::size_t block = 0;
    const auto next_starts = [&] { return pieces[(block + 1) * stride].start; };
    for (const Event& event : trajectory_.events) {
        while (block + 1 < result.size() && next_starts() < event.t) ++block;
        result[block] = true;
        if (block + 1 < result.size() && next_starts() == event.t) result[block + 1] = true;
    }
    return result;
}

// One step of each `stride` that follow one another, and not always the same of them: a motion may have that period. Of a
// block that is to be `whole` every step.
std::vector<Sample> Sampler::of_every(std::size_t stride, int between, const std::vector<bool>& whole) {
    std::vector<Sample> samples;
    const std::vector<Event>& events = trajectory_.events;
    std::size_t j = 0, phase = 0;
    const auto kind = [&](double start) {
        while (phase + 1 < trajectory_.phases.size() && trajectory_.phases[phase + 1].start <= start) ++phase;
        return trajectory_.phases[phase].kind;
    };
    const auto add = [&](double t, Phase::Kind in, ContactSet held, ContactSet carriers, const State& state,
                         double work, double loss) {
        samples.push_back({t, static_cast<int>(j), in, !held.empty(), held, state, work, loss, carriers});
    };
    const auto add_from = [&](const Piece& piece, double t, Phase::Kind in) {
        add(t, in, piece.held, piece.carriers, state(piece, t), work(piece, t), piece.loss);
    };
    // Events up to a time; an impact that no step led to (a run may start with one) shows its state before.
    const auto pass_events = [&](double until) {
        bool any = false;
        for (; j < events.size() && events[j].t <= until; any = true) {
            const Event& event = events[j];
            const bool shown =
                !samples.empty() && samples.back().t == event.t && samples.back().j == static_cast<int>(j);
            const bool is_left_out = stride > 1 && event.t < until;
            if (event.kind == Event::Kind::impact && !shown && !is_left_out) {
                const ContactSet before = held_before(trajectory_, j);
                add(event.t, before.empty() ? Phase::Kind::hybrid : Phase::Kind::constrained, before,
                    carriers_of(trajectory_, before, event.t), {event.q, event.v_before, event.t},
                    j == 0 ? 0.0 : events[j - 1].work, j == 0 ? 0.0 : events[j - 1].loss);
            }
            ++j;
        }
        return any;
    };
    ContactSet held;
    const std::size_t count = trajectory_.pieces.size();
    const auto take = [&](const Piece& piece) {
        const bool fresh = pass_events(piece.start) || samples.empty() || piece.held != held ||
                           (stride > 1 && samples.back().t != piece.start);
        held = piece.held;
        const Phase::Kind in = kind(piece.start);
        if (fresh) add_from(piece, piece.start, in);
        for (int k = 1; k <= between; ++k) {
            const double t = piece.start + (piece.end - piece.start) * k / (between + 1);
            add_from(piece, t, in);
        }
        add_from(piece, piece.end, in);
    };
    for (std::size_t block = 0; block * stride < count; ++block) {
        const std::size_t first = block * stride, last = std::min(first + stride, count);
        if (block < whole.size() && whole[block])
            std::for_each(trajectory_.pieces.begin() + static_cast<std::ptrdiff_t>(first),
                          trajectory_.pieces.begin() + static_cast<std::ptrdiff_t>(last), take);
        else
            take(trajectory_.pieces[std::min(first + block * 7919 % stride, count - 1)]);
    }
    if (pass_events(trajectory_.end_time) || samples.empty())
        add(trajectory_.end_time, trajectory_.end_phase, trajectory_.end_held, trajectory_.phases.back().carriers,
            trajectory_.end, trajectory_.work, trajectory_.loss);
    return samples;
}

}  // namespace achilles
