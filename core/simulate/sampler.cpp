#include "simulate/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "model/model.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/flow.hpp"

namespace achilles {

Mode mode_before(const Trajectory& trajectory, std::size_t event) {
    return event == 0 ? trajectory.phases.front().mode : trajectory.events[event - 1].mode;
}

ContactSet load_bearing_contacts(const Trajectory& trajectory, Mode mode, double t) {
    if (mode.held().count() < 2) return mode.held();
    const auto fits = [&](const Phase& one) { return one.start <= t && one.mode == mode; };
    const auto phase = std::find_if(trajectory.phases.rbegin(), trajectory.phases.rend(), fits);
    return phase == trajectory.phases.rend() ? mode.held() : phase->load_bearing;
}

// Projects samples in contact onto h = 0, hdot = 0, because dense output leaves the surface by its own error.
struct Sampler::Projection {
    explicit Projection(const Trajectory& trajectory)
        : surfaces(*trajectory.model, trajectory.run), work(*trajectory.model, trajectory.run) {}
    ContactCache surfaces;
    WorkIntegrator work;
};

Sampler::Sampler(const Trajectory& trajectory)
    : trajectory_(trajectory), projection_(std::make_unique<Projection>(trajectory)) {}
Sampler::~Sampler() = default;

Sample Trajectory::operator()(double t) const { return Sampler(*this).at(t); }

State Sampler::state(const DenseSegment& piece, double t) const {
    const State state = state_in(piece, trajectory_.coefficients, trajectory_.run.q.size(), t);
    if (!(piece.mode == Mode())) {
        State projected = state;
        if (projection_->surfaces.settle(projected, piece.motion())) return projected;
    }
    return state;
}

void Sampler::set_work(Sample& sample, const DenseSegment& piece) const {
    const EnergyFlow flow = projection_->work.along(piece, trajectory_.coefficients, sample.t);
    sample.work = piece.work + flow.work;
    sample.heat = piece.heat + flow.heat;
}

Sample Sampler::at(double t) {
    if (std::isnan(t)) throw InputError("the time", {}, "it is not a number");
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
        sample.mode = trajectory_.end_mode;
        sample.load_bearing = trajectory_.phases.back().load_bearing;
        sample.inactive = trajectory_.end_inactive;
        sample.latched = trajectory_.end_latched;
        sample.contact = !sample.mode.is_free();
        sample.state = trajectory_.end;
        sample.work = trajectory_.work;
        sample.loss = trajectory_.loss;
        sample.heat = trajectory_.heat;
        return sample;
    }
    sample.contact = !std::prev(piece)->mode.is_free();
    sample.mode = std::prev(piece)->mode;
    sample.load_bearing = std::prev(piece)->load_bearing;
    sample.inactive = std::prev(piece)->inactive;
    sample.latched = std::prev(piece)->latched;
    sample.state = state(*std::prev(piece), t);
    set_work(sample, *std::prev(piece));
    sample.loss = std::prev(piece)->loss;
    // The last step may end at an impact after which no step was made.
    if (t == trajectory_.end_time) {
        const auto& events = trajectory_.events;
        const Model& model = *trajectory_.model;
        if ((model.contacts() > 1 || model.has_friction() || model.has_jumps()) && !events.empty() &&
            events.back().t == t) {
            sample.mode = events.back().mode;
            sample.load_bearing = trajectory_.phases.back().load_bearing;
            sample.contact = !sample.mode.is_free();
        }
        sample.inactive = trajectory_.end_inactive;
        sample.latched = trajectory_.end_latched;
        sample.state = trajectory_.end;
        sample.work = trajectory_.work;
        sample.loss = trajectory_.loss;
        sample.heat = trajectory_.heat;
    }
    return sample;
}

Sample Sampler::in(const DenseSegment& piece, double t, bool with_work) const {
    Sample sample;
    sample.t = t;
    sample.phase = piece.mode.is_free() ? Phase::Kind::hybrid : Phase::Kind::constrained;
    sample.contact = !piece.mode.is_free();
    sample.mode = piece.mode;
    sample.load_bearing = piece.load_bearing;
    sample.inactive = piece.inactive;
    sample.latched = piece.latched;
    sample.state = state(piece, t);
    if (with_work) set_work(sample, piece);
    sample.loss = piece.loss;
    return sample;
}

// Collects the visited samples, and `between` instants inside each step.
std::vector<Sample> Sampler::listed(const Selection& selection, int between) const {
    std::vector<Sample> samples;
    visit(selection, [&](const Sample& sample, const DenseSegment* piece) {
        for (int k = 1; k <= between && piece != nullptr; ++k) {
            const double t = piece->start + (piece->end - piece->start) * k / (between + 1);
            Sample inside = in(*piece, t);
            inside.j = sample.j;
            inside.phase = sample.phase;
            samples.push_back(inside);
        }
        samples.push_back(sample);
    });
    return samples;
}

std::vector<Sample> Sampler::all(int between) { return listed(whole_run(), between); }

std::vector<Sample> Sampler::some(std::size_t most_steps, int between) {
    if (trajectory_.pieces.size() <= most_steps) return all(between);  // also of a run without a step
    Selection selection = whole_run();
    selection.stride = 1 + (trajectory_.pieces.size() - 1) / most_steps;
    std::vector<bool>& whole = selection.whole;
    whole = blocks_with_events(selection.stride);
    if (static_cast<std::size_t>(std::count(whole.begin(), whole.end(), true)) * selection.stride > most_steps)
        whole.clear();
    return listed(selection, between);
}

void Sampler::walk(double from, double to, bool with_work, const Visitor& take) const {
    Selection selection = whole_run();
    selection.from = std::max(from, selection.from);
    selection.to = std::min(to, selection.to);
    selection.with_work = with_work;
    visit(selection, take);
}

Sampler::Selection Sampler::whole_run() const {
    return {trajectory_.run.options.start_time, trajectory_.end_time, true, 1, {}};
}

// The blocks of `stride` steps that contain an event, or have one at an end.
std::vector<bool> Sampler::blocks_with_events(std::size_t stride) const {
    const std::vector<DenseSegment>& pieces = trajectory_.pieces;
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

// Visits one step of each block of `stride` consecutive steps, at varying positions in the block, because the motion
// may have that period. Blocks marked `whole` are visited completely.
void Sampler::visit(const Selection& selection, const Visitor& visitor) const {
    const std::size_t stride = selection.stride, count = trajectory_.pieces.size();
    const std::vector<Event>& events = trajectory_.events;
    const std::vector<DenseSegment>& pieces = trajectory_.pieces;
    const auto before = [](const Event& event, double t) { return event.t < t; };
    auto j = static_cast<std::size_t>(std::lower_bound(events.begin(), events.end(), selection.from, before) -
                                      events.begin());
    const auto kind = [&](double start) {
        const auto later = [](double t, const Phase& phase) { return t < phase.start; };
        const auto after = std::upper_bound(trajectory_.phases.begin(), trajectory_.phases.end(), start, later);
        return after == trajectory_.phases.begin() ? after->kind : std::prev(after)->kind;
    };
    std::optional<std::pair<double, std::size_t>> last;  // t and j of the last sample
    const auto take = [&](const Sample& sample, const DenseSegment* piece) {
        visitor(sample, piece);
        last = {sample.t, j};
    };
    const auto sample_in = [&](const DenseSegment& piece, double t, Phase::Kind phase) {
        Sample sample = in(piece, t, selection.with_work);
        sample.j = static_cast<int>(j);
        sample.phase = phase;
        return sample;
    };
    // Passes events up to a time. An impact that no step leads to (a run may start with one) also gets a sample before
    // it.
    const auto pass_events = [&](double until) {
        bool any = false;
        for (; j < events.size() && events[j].t <= until; any = true) {
            const Event& event = events[j];
            const bool shown = last && last->first == event.t && last->second == j;
            const bool is_left_out = stride > 1 && event.t < until;
            if (event.is_impact() && !shown && !is_left_out) {
                const Mode mode = mode_before(trajectory_, j);
                take({event.t, static_cast<int>(j), mode.is_free() ? Phase::Kind::hybrid : Phase::Kind::constrained,
                      !mode.is_free(), mode, State{event.q, event.v_before, event.t}, j == 0 ? 0.0 : events[j - 1].work,
                      j == 0 ? 0.0 : events[j - 1].loss, load_bearing_contacts(trajectory_, mode, event.t),
                      j == 0 ? 0.0 : events[j - 1].heat, j == 0 ? trajectory_.start_inactive : events[j - 1].inactive,
                      j == 0 ? trajectory_.start_latched : events[j - 1].latched},
                     nullptr);
            }
            ++j;
        }
        return any;
    };
    Mode mode;
    const auto take_step = [&](const DenseSegment& piece) {
        const double start = std::max(piece.start, selection.from), end = std::min(piece.end, selection.to);
        const bool fresh = pass_events(start) || !last || piece.mode != mode || (stride > 1 && last->first != start);
        mode = piece.mode;
        const Phase::Kind phase = kind(piece.start);
        if (fresh) take(sample_in(piece, start, phase), nullptr);
        take(sample_in(piece, end, phase), &piece);
    };
    const auto is_before = [](double t, const DenseSegment& piece) { return t < piece.start; };
    const auto first_step = std::upper_bound(pieces.begin(), pieces.end(), selection.from, is_before);
    const auto begin = static_cast<std::size_t>(first_step - pieces.begin());
    for (std::size_t block = (begin > 0 ? begin - 1 : 0) / stride; block * stride < count; ++block) {
        const std::size_t first = block * stride, end = std::min(first + stride, count);
        if (pieces[first].start > selection.to) break;
        if (block < selection.whole.size() && selection.whole[block])
            std::for_each(pieces.begin() + static_cast<std::ptrdiff_t>(first),
                          pieces.begin() + static_cast<std::ptrdiff_t>(end), take_step);
        else
            take_step(pieces[std::min(first + block * 7919 % stride, count - 1)]);
    }
    if (selection.to < trajectory_.end_time && last) return;
    if (pass_events(trajectory_.end_time) || !last)
        take({trajectory_.end_time, static_cast<int>(j), trajectory_.end_phase, !trajectory_.end_mode.is_free(),
              trajectory_.end_mode, trajectory_.end, trajectory_.work, trajectory_.loss,
              trajectory_.phases.back().load_bearing, trajectory_.heat, trajectory_.end_inactive,
              trajectory_.end_latched},
             nullptr);
}

namespace {

struct Height {
    double t, h, hdot;
};

class GapAlong {
 public:
    GapAlong(const Trajectory& trajectory, std::size_t contact)
        : trajectory_(trajectory),
          contact_(trajectory.model->evaluator(trajectory.model->programs_of(contact).contact_terms,
                                               trajectory.run.parameters)) {}

    Height at(const State& state) {
        set_state(contact_, state);
        contact_.run();
        return {state.t, contact_.h(), contact_.hdot()};
    }

    // The smallest gap inside the piece if it is below `least`; otherwise `least`. Steps of both methods are so short
    // that the gap has at most one minimum in each of a few parts.
    double below(double least, const DenseSegment& piece) {
        constexpr int parts = 8;
        Height before = at(piece, piece.start);
        for (int i = 1; i <= parts; ++i) {
            const Height after = at(piece, piece.start + (piece.end - piece.start) * i / parts);
            if (i < parts) least = std::min(least, after.h);
            if (before.hdot <= 0.0 && after.hdot > 0.0 && where_tangents_meet(before, after) < least)
                least = std::min(least, minimum(piece, before, after));
            before = after;
        }
        return least;
    }

 private:
    Height at(const DenseSegment& piece, double t) {
        return at(state_in(piece, trajectory_.coefficients, trajectory_.run.q.size(), t));
    }

    // Lower bound for a convex function with these values and rates.
    static double where_tangents_meet(const Height& a, const Height& b) {
        const double t = (b.h - a.h + a.hdot * a.t - b.hdot * b.t) / (a.hdot - b.hdot);
        return a.h + a.hdot * (std::clamp(t, a.t, b.t) - a.t);
    }

    // The minimum between a falling and a rising point, by bisection.
    double minimum(const DenseSegment& piece, Height falling, Height rising) {
        for (int i = 0; i < 60; ++i) {
            const double t = 0.5 * (falling.t + rising.t);
            if (t <= falling.t || t >= rising.t) break;
            const Height middle = at(piece, t);
            (middle.hdot < 0.0 ? falling : rising) = middle;
        }
        return std::min(falling.h, rising.h);
    }

    const Trajectory& trajectory_;
    ContactTerms<Evaluator<double>> contact_;
};

}  // namespace

double least_gap(const Trajectory& trajectory) {
    double least =
        trajectory.statistics.steps > 0 ? trajectory.statistics.least_gap : std::numeric_limits<double>::infinity();
    for (std::size_t contact = 0; contact < trajectory.model->contacts(); ++contact) {
        GapAlong gap(trajectory, contact);
        if (!trajectory.start_inactive.contains(contact)) least = std::min(least, gap.at(trajectory.run.start()).h);
        for (const DenseSegment& piece : trajectory.pieces)
            if (!piece.mode.is_held(contact) && !piece.inactive.contains(contact)) least = gap.below(least, piece);
    }
    return least;
}

}  // namespace achilles
