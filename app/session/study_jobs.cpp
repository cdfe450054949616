#include "session/study_jobs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <new>
#include <span>
#include <utility>

#include "analysis/chunks.hpp"
#include "analysis/measures.hpp"
#include "figure/sweep_figure.hpp"
#include "model/model.hpp"

namespace achilles {

// ---- derivatives ----

namespace {

// The derivative of one slider's input, scaled by the range and position of the slider.
Sensitivities::Sensitivity sensitivity(const std::string& name, const std::array<double, 2>& range, double value,
                                       const Quantity& quantity, const Derivatives& derivatives) {
    const auto at = std::find(derivatives.directions.begin(), derivatives.directions.end(), name);
    const auto k = static_cast<std::size_t>(at - derivatives.directions.begin());
    Sensitivities::Sensitivity one{name, quantity.derivatives[static_cast<Eigen::Index>(k)], 0.0, ""};
    const double reach =
        has_log_scale(range[0], range[1]) ? value * std::log(range[1] / range[0]) : range[1] - range[0];
    one.change_over_slider = one.derivative * reach;
    if (std::isfinite(one.derivative)) return one;
    one.reason = !derivatives.refused[k].empty() ? derivatives.refused[k]
                 : !quantity.refused.empty()     ? quantity.refused
                                                 : "it does not exist there";
    return one;
}

}  // namespace

bool has_log_scale(double low, double high) { return low > 0.0 && high / low >= 100.0; }

const Sensitivities::Sensitivity* Sensitivities::find(const std::string& name) const {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Sensitivity& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
}

double Sensitivities::largest() const {
    double most = 0.0;
    for (const Sensitivity& one : all)
        if (std::isfinite(one.change_over_slider)) most = std::max(most, std::abs(one.change_over_slider));
    return most;
}

Sensitivities sensitivities_of(const std::string& quantity, const std::shared_ptr<const Trajectory>& run) {
    const Derivatives derivatives = differentiate(*run);
    Sensitivities result{run, Quantities(run->model, {quantity}).of(*run, derivatives).front(), {}, {}};
    SweepSpec sweep;  // only to find the unit
    sweep.prints = {quantity};
    result.unit = RunMeasures(run->model, sweep).columns().front().unit;
    const SystemDescription& system = run->model->description();
    const auto add = [&](const std::string& name, const std::array<double, 2>& range, double value) {
        result.all.push_back(sensitivity(name, range, value, result.quantity, derivatives));
    };
    for (std::size_t i = 0; i < system.parameters.size(); ++i)
        add(system.parameters[i].name, system.parameters[i].range, run->run.parameters[i]);
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
        const CoordinateDescription& c = system.coordinates[i];
        add(c.name, c.range, run->run.q[static_cast<Eigen::Index>(i)]);
        add(c.name + "'", c.rate_range, run->run.v[static_cast<Eigen::Index>(i)]);
    }
    // Below 1e-12 of the largest change or of the quantity itself, a derivative is rounding noise: it becomes 0.
    const double size = std::max(result.largest(), std::abs(result.quantity.value));
    for (Sensitivities::Sensitivity& one : result.all)
        if (std::abs(one.change_over_slider) < 1e-12 * size) one.derivative = one.change_over_slider = 0.0;
    return result;
}

std::string default_quantity(const Trajectory& run) {
    const auto count =
        std::count_if(run.events.begin(), run.events.end(), [](const Event& event) { return event.is_zeno(); });
    if (count > 0) return "zeno_time(" + std::to_string(count) + ")";
    return run.model->description().coordinates.front().name;
}

double TangentLine::at(double other_x) const {
    return y + slope * (logarithmic ? x * std::log(other_x / x) : other_x - x);
}

bool SensitivitiesJob::ask(const std::shared_ptr<const Trajectory>& run, const std::string& quantity) {
    if (requested_ && requested_->run == run && requested_->quantity == quantity) return false;
    requested_ = SensitivityRequest{run, quantity};
    problem_.clear();
    const Sensitivities* const known = sensitivities();
    if (known != nullptr && (known->quantity.expression != quantity || known->run->model != run->model)) job_.drop();
    if (!running_) begin();
    return true;
}

void SensitivitiesJob::forget() {
    job_.forget();
    requested_.reset(), running_.reset();
    problem_.clear();
}

void SensitivitiesJob::begin() {
    running_ = requested_;
    job_.start([request = *requested_](const StopMonitor&) { return sensitivities_of(request.quantity, request.run); });
}

void SensitivitiesJob::update(Timeout patience) {
    using Clock = std::chrono::steady_clock;
    const auto began = Clock::now();
    const auto left = [&]() -> Timeout {
        if (!patience) return patience;
        return std::max(0.0, *patience - std::chrono::duration<double>(Clock::now() - began).count());
    };
    while (running_) {
        std::string problem;
        try {
            if (!job_.update(left())) return;
        } catch (const InputError& error) {
            problem = error.message + (error.hint.empty() ? "" : ": " + error.hint);
        } catch (const std::bad_alloc&) {
            problem = "there is not enough memory for the derivatives of this run";
        }
        const SensitivityRequest of = *std::exchange(running_, std::nullopt);
        const bool is_wanted = of.quantity == requested_->quantity && of.run->model == requested_->run->model;
        if (is_wanted) problem_ = problem;
        if (!is_wanted || !problem.empty()) job_.drop();
        if (of == *requested_) return;
        begin();
        if (left() == 0.0) return;  // show each result, even if the next one is soon ready
    }
}

// ---- a proof ----

void ProofJob::begin(const std::shared_ptr<const Model>& model, const InitialUncertainty& spread,
                     const EnclosureProblem& claim) {
    model_ = model;
    drop();
    const auto watch = std::make_shared<ProofMonitor>();
    watch->time = claim.run.options.start_time;
    start(
        [model, spread, claim](ProofMonitor& monitor) {
            return Proof{spread, claim, prove(model, claim, &monitor)};
        },
        watch);
}

command::Prove prove_command(const InitialUncertainty& spread) {
    command::Prove command{spread.width, {}};
    for (const InitialUncertainty::VariableRange& side : spread.sides) command.intervals.push_back(to_text(side));
    return command;
}

bool same_to_a_proof(const Run& a, const Run& b) {
    const Options &x = a.options, &y = b.options;
    return a.q == b.q && a.v == b.v && a.parameters == b.parameters && x.start_time == y.start_time &&
           x.end_time == y.end_time && x.max_steps == y.max_steps && x.max_impacts == y.max_impacts;
}

// ---- a sweep ----

namespace {

// Points along one axis, per level. The first level appears at once; each finer one costs so much more that the levels
// before it do not matter.
constexpr std::uint64_t map_steps[] = {16, 64, 160}, curve_steps[] = {32, 128}, section_steps[] = {16, 64};
constexpr double lengths[] = {1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0};  // for a single run

struct JobStopped {};  // thrown to the Job, which discards it

SweepData table_of(const std::shared_ptr<const Model>& model, const SweepSpec& sweep, const std::stop_token& stop) {
    const SweepTable table(model, sweep);
    SweepData data(table);
    std::mutex mutex;
    std::map<std::uint64_t, SweepData> waiting;  // finished chunks, by their first point
    const std::atomic<bool> never{false};
    const auto go_on = [&] {
        if (stop.stop_requested()) throw JobStopped();
    };
    const auto task = [&](Chunk chunk) {
        SweepData part(table);
        part.add(table.rows(chunk.first, chunk.count, go_on));
        const std::scoped_lock lock(mutex);
        waiting.emplace(chunk.first, std::move(part));
        return std::string();
    };
    const auto write = [&](Chunk chunk, const std::string&) {
        const std::scoped_lock lock(mutex);
        data.add(waiting.extract(chunk.first).mapped().rows);
        if (data.count() > max_drawn_rows)
            throw InputError("sweep", {},
                             fmt::format("there are more than {} rows, the most that can be drawn", max_drawn_rows),
                             "use shorter runs, or fewer; achilles sweep --csv F writes the whole table");
    };
    do_chunks(0, sweep.count(), 0, task, write, never);
    return data;
}

}  // namespace

std::vector<SweepSpec> coarse_to_fine(const SweepSpec& sweep) {
    std::vector<SweepSpec> levels;
    if (sweep.axes.empty()) {
        for (const double share : lengths) {
            SweepSpec shorter = sweep;
            const double start = sweep.base.options.start_time,
                         end = start + share * (sweep.base.options.end_time - start);
            if (sweep.at && sweep.at->after && !(*sweep.at->after < end)) continue;
            shorter.base.options.end_time = end;
            levels.push_back(std::move(shorter));
        }
    }
    const std::span<const std::uint64_t> steps = sweep.at                ? std::span<const std::uint64_t>(section_steps)
                                                 : sweep.axes.size() > 1 ? std::span<const std::uint64_t>(map_steps)
                                                                         : std::span<const std::uint64_t>(curve_steps);
    for (const std::uint64_t most : steps) {
        SweepSpec coarse = sweep;
        for (SweepAxis& axis : coarse.axes) axis.count = std::min(axis.count, most);
        if (coarse.random) coarse.random->count = std::min(coarse.random->count, most * most);
        if (coarse != sweep) levels.push_back(std::move(coarse));
    }
    levels.push_back(sweep);
    return levels;
}

void SweepJob::ask(const std::shared_ptr<const Model>& model, std::optional<SweepSpec> sweep) {
    if (sweep && !sweep->axes.empty()) sweep->base = SweepPoints(*sweep, model->description()).run(0);
    if (model == model_ && sweep == sweep_) return;
    const bool alike = model == model_ && sweep && sweep_ && sweep->prints == sweep_->prints && sweep->at == sweep_->at;
    model_ = model;
    sweep_ = std::move(sweep);
    if (!alike) job_.drop();
    is_current_ = false;
    problem_.clear();
    levels_ = sweep_ ? coarse_to_fine(*sweep_) : std::vector<SweepSpec>();
    next_ = 0;
    begin();
}

void SweepJob::pause() {
    if (is_busy()) ask(model_, {});
}

void SweepJob::begin() {
    if (!is_busy()) return job_.stop();
    job_.start([model = model_, level = levels_[next_]](const StopMonitor& monitor) {
        return table_of(model, level, monitor.stop);
    });
}

void SweepJob::update(Timeout patience) {
    while (is_busy()) {
        try {
            if (!job_.update(patience)) return;
            is_current_ = true;
            ++next_;
        } catch (const InputError& problem) {
            problem_ = problem.what();
            next_ = levels_.size();
        } catch (const std::bad_alloc&) {
            problem_ = "there is not enough memory for so many points";
            next_ = levels_.size();
        }
        if (is_busy()) begin();
    }
}

double SweepJob::share() const {
    const auto work = [](const SweepSpec& sweep) {
        return static_cast<double>(sweep.count()) *
               (sweep.axes.empty() ? sweep.base.options.end_time - sweep.base.options.start_time : 1.0);
    };
    double done = 0.0, all = 0.0;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        all += work(levels_[i]);
        if (i < next_) done += work(levels_[i]);
    }
    return all > 0.0 ? done / all : 1.0;
}

std::size_t OrbitJobResult::first() const {
    for (std::size_t i = 0; i < count(); ++i)
        if (point(i).parameters == answer.orbit->parameters) return i;
    return 0;
}

Run run_on(const OrbitPoint& point, Run run) {
    const double length = std::max(run.options.end_time - run.options.start_time, point.period);
    run.parameters = point.parameters;
    run.q = point.flight.q;
    run.v = point.flight.v;
    // A driven system keeps the phase of its drive. An autonomous one starts at the start time of the given run.
    if (!point.is_autonomous) run.options.start_time = point.flight.t;
    run.options.end_time = run.options.start_time + length;
    return run;
}

void OrbitJob::begin(const std::shared_ptr<const Model>& model, const std::string& text, const Run& base,
                     OrbitRequest question) {
    drop();
    start([model, text, base, question = std::move(question)](OrbitMonitor& watch) {
        OrbitJobResult found{text, base, {}};
        try {
            found.answer = solve_orbit_request(question, model, &watch);
        } catch (const InputError& problem) {  // of an attempted start
            found.answer.reason = problem.message;
        }
        return found;
    });
}

}  // namespace achilles
