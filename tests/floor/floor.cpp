#include "floor/floor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "floor/laws.hpp"
#include "simulate/batch.hpp"
#include "simulate/impact.hpp"

namespace achilles::test {

Starts::Starts(std::shared_ptr<const Model> model, unsigned seed) : model_(std::move(model)), random_(seed) {
    look(model_->default_run());
}

void Starts::look(const Run& run) {
    gaps_.clear();
    for (std::size_t i = 0; i < model_->contacts(); ++i)
        gaps_.push_back(model_->evaluator(model_->gap(i), run.parameters));
    start_time_ = run.options.start_time;
}

double Starts::uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

double Starts::within(const std::array<double, 2>& range) { return uniform(range[0], range[1]); }

std::optional<State> Starts::in_the_air(int tries) {
    const auto& coordinates = model_->description().coordinates;
    State state{Vector(model_->dof()), Vector(model_->dof()), start_time_};
    for (; tries > 0; --tries) {
        for (Eigen::Index i = 0; i < state.q.size(); ++i) {
            const auto& coordinate = coordinates[static_cast<std::size_t>(i)];
            state.q[i] = within(coordinate.range);
            state.v[i] = within(coordinate.rate_range);
        }
        const bool open = std::all_of(gaps_.begin(), gaps_.end(), [&](Evaluator<double>& gap) {
            set_state(gap, state);
            gap.run();
            return gap.output(0) > 1e-6;
        });
        if (open) return state;
    }
    return std::nullopt;
}

State Starts::next() {
    if (const auto state = in_the_air(100000)) return *state;
    throw std::runtime_error("the ranges of " + model_->description().file + " show no state in the air");
}

Run Starts::next_run() {
    for (int tries = 0; tries < 1000; ++tries) {
        Run run = model_->default_run();
        for (std::size_t i = 0; i < run.parameters.size(); ++i)
            run.parameters[i] = within(model_->description().parameters[i].range);
        const double from = run.options.start_time, to = run.options.end_time;
        if (!model_->equations().autonomous) run.options.start_time = uniform(from, to);
        run.options.end_time = run.options.start_time + uniform(0.0, to - from);
        look(run);
        const auto state = in_the_air(100);
        if (!state) continue;
        run.q = state->q;
        run.v = state->v;
        return run;
    }
    throw std::runtime_error("the ranges of " + model_->description().file + " show no state in the air");
}

std::string start_of(const Model& model, const Run& run) {
    std::string text;
    const SystemDescription& description = model.description();
    for (Eigen::Index i = 0; i < run.q.size(); ++i) {
        const std::string& name = description.coordinates[static_cast<std::size_t>(i)].name;
        text += fmt::format(" --set {}={} --set \"{}'={}\"", name, run.q[i], name, run.v[i]);
    }
    const Run usual = model.default_run();
    for (std::size_t i = 0; i < usual.parameters.size(); ++i)
        if (run.parameters[i] != usual.parameters[i])
            text += fmt::format(" --set {}={}", description.parameters[i].name, run.parameters[i]);
    const Options& options = run.options;
    if (options.start_time != usual.options.start_time) text += fmt::format(" --start-time {}", options.start_time);
    return text + fmt::format(" --end {} --tolerance {} --method {} --eps-q {} --eps-v {}", options.end_time,
                              options.tolerance, to_text(options.method), options.truncation.eps_q,
                              options.truncation.eps_v);
}

std::string start_of(const Trajectory& trajectory) { return start_of(*trajectory.model, trajectory.run); }

namespace {

// Evaluators of the gaps at the parameters of a run.
std::vector<Evaluator<double>> gaps_of(const Trajectory& trajectory) {
    std::vector<Evaluator<double>> gaps;
    for (std::size_t i = 0; i < trajectory.model->contacts(); ++i)
        gaps.push_back(trajectory.model->evaluator(trajectory.model->gap(i), trajectory.run.parameters));
    return gaps;
}

// The smallest gap of the contacts that count.
double least_of(std::vector<Evaluator<double>>& gaps, const State& state, ContactSet inactive) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (inactive.contains(i)) continue;
        Evaluator<double>& gap = gaps[i];
        set_state(gap, state);
        gap.run();
        if (!(gap.output(0) >= least)) least = gap.output(0);
    }
    return least;
}

}  // namespace

std::string below_the_floor(const Trajectory& trajectory) {
    auto gaps = gaps_of(trajectory);
    for (const Event& event : trajectory.events) {
        if (event.kind != Event::Kind::impact) continue;
        const double least = least_of(gaps, {event.q, event.v_before, event.t}, event.inactive);
        const double terms = std::max(1.0, event.q.cwiseAbs().maxCoeff());
        if (!(least >= -1e-12 * terms))
            return fmt::format("the impact at t = {:.17g} is stored at h = {:.3g}", event.t, least);
    }
    return {};
}

std::string fault(const Trajectory& trajectory, double between) {
    using enum Outcome::Kind;
    const Outcome::Kind kind = trajectory.outcome.kind;
    // A run in which several contacts chatter together may end as undecided (theory-gaps.md 2.6), and one with friction
    // at a Zeno point, at Painleve's paradox, or with forces that are not unique.
    const bool rough = trajectory.model->has_friction(), may_be_undecided = rough || trajectory.model->contacts() > 1;
    // Jumps may follow one another without end, or leave a gap negative.
    const bool jumps = trajectory.model->has_jumps();
    if (kind != end_time && !(may_be_undecided && kind == undecided) &&
        !(rough && (kind == painleve || kind == redundant_contacts || kind == impact_not_unique)) &&
        !(jumps && (kind == too_many_events || kind == left_the_domain || kind == undecided)))
        return fmt::format("{}: {}", to_text(trajectory.outcome.kind), trajectory.outcome.message);
    if (!(trajectory.statistics.least_gap >= -1e-12))
        return fmt::format("least gap {} at the end of a step", trajectory.statistics.least_gap);
    const std::string stored = below_the_floor(trajectory);
    if (!stored.empty()) return stored;
    auto gaps = gaps_of(trajectory);
    for (const DenseSegment& piece : trajectory.pieces) {
        if (!piece.mode.held().empty()) continue;  // samples in contact are projected
        for (const double theta : {0.0625, 0.125, 0.25, 0.5, 0.75, 0.875, 0.9375}) {
            const double t = piece.start + theta * (piece.end - piece.start);
            const double least =
                least_of(gaps, state_in(piece, trajectory.coefficients, trajectory.model->dof(), t), piece.inactive);
            if (!(least >= -between))
                return fmt::format("gap {} inside the step from t = {} to {}", least, piece.start, piece.end);
        }
    }
    return {};
}

std::string broken_law(const Trajectory& trajectory) {
    for (const auto law : {energy, gap, phases, contact_force, friction})
        if (const Violations violations = law(trajectory); !violations.empty()) return violations.front();
    return {};
}

Trajectory by_eight(const std::shared_ptr<const Model>& model, const Run& run) {
    Trajectory end;
    simulate_ends(
        model, 1, [&](std::size_t) { return run; },
        [&](std::size_t, RunResult&& attempt) { end = std::get<Trajectory>(std::move(attempt)); }, 1);
    return end;
}

Judge::Judge(std::shared_ptr<const Model> model, const Run& run) : model_(std::move(model)), truth_(*model_, run) {}

Comparison Judge::compare(const Trajectory& trajectory) {
    constexpr double moved = 1e-7;
    const Run& run = trajectory.run;
    const Outline own = outline_of(trajectory);
    Comparison result;
    const TrueExecution truth = truth_.run(point_of({run.q, run.v}), run.options.end_time);
    const Distance error = between(own, outline_of(truth));
    result.error = error.size;
    result.where = error.where;
    for (Eigen::Index i = 0; i < 2 * run.q.size(); ++i) {
        for (const double by : {-moved, moved}) {
            Run other = run;
            (i < run.q.size() ? other.q[i] : other.v[i - run.q.size()]) += by;
            result.sensitivity =
                std::max(result.sensitivity, between(own, outline_of(simulate(model_, other))).size / moved);
        }
    }
    return result;
}

GrazingStarts::GrazingStarts(std::shared_ptr<const Model> model, unsigned seed)
    : model_(std::move(model)),
      run_(model_->default_run()),
      soon_(std::min(3.0, run_.options.end_time)),
      starts_(model_, seed),
      flight_(model_->evaluator(model_->motion({}).program, run_.parameters)),
      gap_(model_->evaluator(model_->gap(), run_.parameters)),
      truth_(*model_, run_) {}

std::optional<Grazing> GrazingStarts::next(double least_gap) {
    for (int tries = 0; tries < 2000; ++tries) {
        const State start = starts_.next();
        if (!dips_near_the_floor(start)) continue;
        if (auto found = tune(start, least_gap)) return found;
    }
    return std::nullopt;
}

// Quick check by Heun's method: most starts have no minimum near the floor, and the reference is expensive.
bool GrazingStarts::dips_near_the_floor(const State& start) {
    const auto rate = [&](const State& state) {
        set_state(flight_, state);
        flight_.run();
        Vector a(state.q.size());
        for (Eigen::Index i = 0; i < a.size(); ++i) a[i] = flight_.output(static_cast<std::size_t>(i));
        return a;
    };
    constexpr double dt = 0.01, near = 0.1;
    State state = start;
    double before = std::numeric_limits<double>::infinity();
    bool falling = false;
    for (double t = 0.0; t < soon_; t += dt) {
        state.t = t;
        set_state(gap_, state);
        gap_.run();
        const double h = gap_.output(0);
        if (falling && h > before) return std::abs(h) < near;
        falling = h < before && t > 0.0;
        before = h;
        const Vector a = rate(state), v = state.v + dt * a;
        const Vector b = rate({state.q + dt * state.v, v, t + dt});
        state.q += 0.5 * dt * (state.v + v);
        state.v += 0.5 * dt * (a + b);
    }
    return false;
}

// Moves the start along the normal until the minimum has the given value, by the secant method to the last digits of q.
std::optional<Grazing> GrazingStarts::tune(State start, double least_gap) {
    ContactKinematics surface(*model_, run_);
    double slope = 1.0, before = 0.0, step = 0.0;
    for (int round = 0; round < 20; ++round) {
        const auto dip = truth_.first_dip(point_of(start), soon_);
        if (!dip || !(dip->curvature > 0.1)) return std::nullopt;
        const double miss = static_cast<double>(dip->gap - Real(least_gap));
        if (std::abs(miss) <= 1e-2 * std::abs(least_gap)) {
            const bool in_the_air = surface.at(start).h > 1e-3 && dip->t > 1e-3;
            return in_the_air ? std::optional(Grazing{start, *dip}) : std::nullopt;
        }
        if (round > 0 && step != 0.0) slope = (miss - before) / step;
        if (!(std::abs(slope) > 1e-3)) return std::nullopt;
        before = miss;
        const Contact contact = surface.at(start);
        step = -miss / slope;
        start.q += step * contact.impulse_direction;
    }
    return std::nullopt;
}

}  // namespace achilles::test
