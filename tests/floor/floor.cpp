#include "floor/floor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "simulate/impact.hpp"

#include "simulate/many.hpp"

namespace achilles::test {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The events of an execution as times: the impacts of every hybrid phase, when it ended, when contact ended.
struct Outline {
    struct Hybrid {
        std::vector<double> impacts;
        double zeno_low = 0.0, zeno_high = 0.0;
    };
    std::vector<Hybrid> bounces;  // the last one may lack its Zeno point
    std::vector<double> releases;
    std::size_t zenos = 0;
    Vector end;
    bool ends_alone = false;  // no times are kept
};

Outline outline_of(const Trajectory& trajectory) {
    Outline outline;
    outline.bounces.emplace_back();
    outline.ends_alone = trajectory.pieces.empty();
    if (outline.ends_alone) {
        for (std::size_t i = 1; i < trajectory.phases.size(); ++i) {
            const bool contact = trajectory.phases[i].kind == Phase::Kind::constrained;
            outline.zenos += contact ? 1 : 0;
            if (!contact) outline.releases.push_back(trajectory.phases[i].start);
        }
    }
    for (const Event& event : trajectory.events) {
        if (event.kind == Event::Kind::impact) outline.bounces.back().impacts.push_back(event.t);
        if (event.kind == Event::Kind::release) outline.releases.push_back(event.t);
        if (event.kind != Event::Kind::zeno) continue;
        auto& bounces = outline.bounces.back();
        bounces.zeno_low = event.certificate->zeno_low;
        bounces.zeno_high = event.certificate->zeno_high;
        ++outline.zenos;
        outline.bounces.emplace_back();
    }
    outline.end.resize(2 * trajectory.end.q.size());
    outline.end << trajectory.end.q, trajectory.end.v;
    return outline;
}

Outline outline_of(const TrueExecution& truth) {
    Outline outline;
    outline.bounces.emplace_back();
    for (const TrueEvent& event : truth.events) {
        const double t = static_cast<double>(event.t);
        if (event.kind == Event::Kind::impact) outline.bounces.back().impacts.push_back(t);
        if (event.kind == Event::Kind::release) outline.releases.push_back(t);
        if (event.kind != Event::Kind::zeno) continue;
        outline.bounces.back().zeno_low = outline.bounces.back().zeno_high = t;
        ++outline.zenos;
        outline.bounces.emplace_back();
    }
    const std::size_t n = truth.end.q.size();
    outline.end.resize(static_cast<Eigen::Index>(2 * n));
    for (std::size_t i = 0; i < n; ++i) {
        outline.end[static_cast<Eigen::Index>(i)] = static_cast<double>(truth.end.q[i]);
        outline.end[static_cast<Eigen::Index>(n + i)] = static_cast<double>(truth.end.v[i]);
    }
    return outline;
}

struct Difference {
    double size = 0.0;
    std::string where;
    void add(double more, const std::string& place) {
        if (std::isnan(more)) more = infinity;
        if (more <= size) return;
        size = more;
        where = place;
    }
};

// How far `b` is from `a`. A bouncing may have been cut at another impact, so those that both have are compared.
Difference between(const Outline& a, const Outline& b) {
    Difference difference;
    if (a.zenos != b.zenos || a.releases.size() != b.releases.size())
        difference.add(infinity, fmt::format("{} Zeno points and {} releases against {} and {}", a.zenos,
                                             a.releases.size(), b.zenos, b.releases.size()));
    for (std::size_t phase = 0; !a.ends_alone && phase < std::min(a.bounces.size(), b.bounces.size()); ++phase) {
        const auto &x = a.bounces[phase], &y = b.bounces[phase];
        const bool both_end = phase < a.zenos && phase < b.zenos;
        if (!both_end && x.impacts.size() != y.impacts.size())
            difference.add(infinity,
                           fmt::format("{} impacts against {} in phase {}", x.impacts.size(), y.impacts.size(), phase));
        for (std::size_t i = 0; i < std::min(x.impacts.size(), y.impacts.size()); ++i)
            difference.add(std::abs(x.impacts[i] - y.impacts[i]),
                           fmt::format("impact {} of phase {}, t = {:.9g}", i + 1, phase, x.impacts[i]));
        if (both_end)
            difference.add(std::max({0.0, x.zeno_low - y.zeno_high, y.zeno_low - x.zeno_high}),
                           fmt::format("Zeno point {}, t = {:.9g}", phase + 1, x.zeno_low));
    }
    for (std::size_t i = 0; i < std::min(a.releases.size(), b.releases.size()); ++i)
        difference.add(std::abs(a.releases[i] - b.releases[i]),
                       fmt::format("release {}, t = {:.9g}", i + 1, a.releases[i]));
    difference.add((a.end - b.end).cwiseAbs().maxCoeff(), "end state");
    return difference;
}

}  // namespace

Starts::Starts(std::shared_ptr<const Model> model, unsigned seed)
    : model_(std::move(model)),
      gap_(model_->evaluator(model_->gap(), model_->default_run().parameters)),
      random_(seed) {}

double Starts::uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

State Starts::next() {
    const auto& coordinates = model_->description().coordinates;
    State state{Vector(model_->dof()), Vector(model_->dof())};
    for (int tries = 0; tries < 100000; ++tries) {
        for (Eigen::Index i = 0; i < state.q.size(); ++i) {
            const auto& coordinate = coordinates[static_cast<std::size_t>(i)];
            state.q[i] = uniform(coordinate.range[0], coordinate.range[1]);
            state.v[i] = uniform(coordinate.rate_range[0], coordinate.rate_range[1]);
        }
        set_state(gap_, state);
        gap_.run();
        if (gap_.output(0) > 1e-6) return state;
    }
    throw std::runtime_error("the ranges of " + model_->description().file + " show no state in the air");
}

std::string start_of(const Trajectory& trajectory) {
    std::string text;
    const auto& coordinates = trajectory.model->description().coordinates;
    for (Eigen::Index i = 0; i < trajectory.run.q.size(); ++i) {
        const std::string& name = coordinates[static_cast<std::size_t>(i)].name;
        text += fmt::format(" --set {}={} --set \"{}'={}\"", name, trajectory.run.q[i], name, trajectory.run.v[i]);
    }
    const Options& options = trajectory.run.options;
    return text + fmt::format(" --end {} --tolerance {} --method {} --eps-q {} --eps-v {}", options.end_time,
                              options.tolerance, to_text(options.method), options.truncation.eps_q,
                              options.truncation.eps_v);
}

std::string below_the_floor(const Trajectory& trajectory) {
    auto gap = trajectory.model->evaluator(trajectory.model->gap(), trajectory.run.parameters);
    for (const Event& event : trajectory.events) {
        if (event.kind != Event::Kind::impact) continue;
        set_state(gap, {event.q, event.v_before});
        gap.run();
        const double terms = std::max(1.0, event.q.cwiseAbs().maxCoeff());
        if (!(gap.output(0) >= -1e-12 * terms))
            return fmt::format("the impact at t = {:.17g} is stored at h = {:.3g}", event.t, gap.output(0));
    }
    return {};
}

std::string fault(const Trajectory& trajectory, double between) {
    if (trajectory.outcome.kind != Outcome::Kind::end_time)
        return fmt::format("{}: {}", to_text(trajectory.outcome.kind), trajectory.outcome.message);
    if (!(trajectory.statistics.least_gap >= -1e-12))
        return fmt::format("least gap {} at the end of a step", trajectory.statistics.least_gap);
    auto gap = trajectory.model->evaluator(trajectory.model->gap(), trajectory.run.parameters);
    const std::string stored = below_the_floor(trajectory);
    if (!stored.empty()) return stored;
    const auto n = static_cast<std::size_t>(trajectory.model->dof());
    for (const Piece& piece : trajectory.pieces) {
        if (!piece.held.empty()) continue;  // a sample is projected
        for (const double theta : {0.0625, 0.125, 0.25, 0.5, 0.75, 0.875, 0.9375}) {
            for (std::size_t i = 0; i < n; ++i) {
                double q = 0.0;
                for (std::size_t k = piece.degree + 1; k-- > 0;)
                    q = q * theta + trajectory.coefficients[piece.first + 2 * n * k + i];
                gap.input(i) = q;
            }
            gap.run();
            if (!(gap.output(0) >= -between))
                return fmt::format("gap {} inside the step from t = {} to {}", gap.output(0), piece.start, piece.end);
        }
    }
    return {};
}

Trajectory by_eight(const std::shared_ptr<const Model>& model, const Run& run) {
    Trajectory end;
    simulate_ends(
        model, 1, [&](std::size_t) { return run; },
        [&](std::size_t, Attempt&& attempt) { end = std::get<Trajectory>(std::move(attempt)); }, 1);
    return end;
}

Judge::Judge(std::shared_ptr<const Model> model, const Run& run) : model_(std::move(model)), truth_(*model_, run) {}

Comparison Judge::compare(const Trajectory& trajectory) {
    constexpr double moved = 1e-7;
    const Run& run = trajectory.run;
    const Outline own = outline_of(trajectory);
    Comparison result;
    const TrueExecution truth = truth_.run(point_of({run.q, run.v}), run.options.end_time);
    const Difference error = between(own, outline_of(truth));
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

// Most starts do not, which 34 digits need not find out: Heun's method will do.
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
        set_state(gap_, state);
        gap_.run();
        const double h = gap_.output(0);
        if (falling && h > before) return std::abs(h) < near;
        falling = h < before && t > 0.0;
        before = h;
        const Vector a = rate(state), v = state.v + dt * a;
        const Vector b = rate({state.q + dt * state.v, v});
        state.q += 0.5 * dt * (state.v + v);
        state.v += 0.5 * dt * (a + b);
    }
    return false;
}

// Moves the start along the normal until the dip is as deep as wanted: the secant method, whose last digits are those
// of q.
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
