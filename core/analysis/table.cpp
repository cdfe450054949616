#include "analysis/table.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <limits>

#include "number/float_environment.hpp"

namespace achilles {

namespace {

std::uint64_t signature_of(const Trajectory& trajectory) {
    const RunEnd end(trajectory.outcome.kind);
    return trajectory.events.empty() ? signature_of(trajectory.passages, end)
                                     : signature_of(sequence_of(trajectory), end);
}

const std::uint64_t signature_of_nothing = signature_of(std::span<const EventRecord>(), RunEnd());

}  // namespace

struct SweepTable::Worker {
    explicit Worker(const SweepTable& table) : measuring(table.measures_), runs(table.model_) {}
    MeasureEvaluator measuring;
    FinalStateSimulator runs;
};

struct SweepTable::Workers {
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> of_threads;
};

SweepTable::SweepTable(std::shared_ptr<const Model> model, SweepSpec sweep)
    : model_(std::move(model)),
      sweep_(std::move(sweep)),
      points_(sweep_, model_->description()),
      measures_(model_, sweep_),
      workers_(std::make_unique<Workers>()) {}

SweepTable::~SweepTable() = default;

Rows SweepTable::rows(std::uint64_t first, std::uint64_t count, const std::function<void()>& before_each) const {
    const FloatEnvironmentGuard ground;
    std::unique_ptr<Worker>& worker = workers_->of_threads.local();
    if (!worker) worker = std::make_unique<Worker>(*this);
    const RunProvider run_of = [&](std::size_t i) {
        if (before_each) before_each();
        return points_.run(first + i);
    };
    try {
        return measures_.needs_everything() ? one_by_one(*worker, first, count, run_of)
                                            : ends(*worker, first, count, run_of);
    } catch (...) {
        worker.reset();  // its state is inconsistent after an exception
        throw;
    }
}

// Eight runs at a time. They finish in any order; each result is stored at its index.
Rows SweepTable::ends(Worker& worker, std::uint64_t first, std::uint64_t count, const RunProvider& run_of) const {
    const std::size_t n = count, width = measures_.numbers();
    Rows rows;
    rows.points.resize(n);
    rows.numbers.assign(n * width, std::numeric_limits<double>::quiet_NaN());
    rows.held.resize(n);
    if (measures_.prints_modes()) rows.modes.resize(n);
    rows.ends.resize(n);
    rows.signatures.assign(n, signature_of_nothing);
    std::vector<double> numbers;
    const auto take = [&](std::size_t i, RunResult&& attempt) {
        rows.points[i] = first + i;
        const auto* trajectory = std::get_if<Trajectory>(&attempt);
        if (trajectory == nullptr) return;
        numbers.clear();
        worker.measuring.at_end(*trajectory, numbers);
        std::copy(numbers.begin(), numbers.end(), rows.numbers.begin() + static_cast<std::ptrdiff_t>(i * width));
        rows.held[i] = trajectory->end_mode.held();
        if (measures_.prints_modes()) rows.modes[i] = trajectory->end_mode;
        rows.ends[i] = RunEnd(trajectory->outcome.kind);
        rows.signatures[i] = signature_of(*trajectory);
    };
    worker.runs.simulate(n, run_of, take);
    return rows;
}

void SweepTable::add_nothing(std::uint64_t point, RunEnd end, std::uint64_t signature, Rows& rows) const {
    rows.points.push_back(point);
    rows.numbers.insert(rows.numbers.end(), measures_.numbers(), std::numeric_limits<double>::quiet_NaN());
    rows.held.emplace_back();
    if (measures_.prints_modes()) rows.modes.emplace_back();
    rows.ends.push_back(end);
    rows.signatures.push_back(signature);
    if (!is_section()) return;
    rows.times.push_back(std::numeric_limits<double>::quiet_NaN());
    rows.contacts.emplace_back();
}

void SweepTable::add_sections(MeasureEvaluator& measuring, const Trajectory& trajectory, std::uint64_t point,
                              Rows& rows) const {
    const RunEnd end(trajectory.outcome.kind);
    const std::uint64_t signature = signature_of(trajectory);
    const std::vector<SectionPoint> moments = measuring.moments(trajectory, *sweep_.at);
    if (moments.empty()) return add_nothing(point, end, signature, rows);
    for (const SectionPoint& moment : moments) {
        rows.points.push_back(point);
        measuring.at(trajectory, moment, rows.numbers);
        rows.held.push_back(moment.sample.mode.held());
        if (measures_.prints_modes()) rows.modes.push_back(moment.sample.mode);
        rows.ends.push_back(end);
        rows.signatures.push_back(signature);
        rows.times.push_back(moment.sample.t);
        rows.contacts.push_back(moment.contacts);
    }
}

Rows SweepTable::one_by_one(Worker& worker, std::uint64_t first, std::uint64_t count, const RunProvider& run_of) const {
    Rows rows;
    for (std::uint64_t point = first; point < first + count; ++point) {
        const Run run = run_of(point - first);
        std::optional<Trajectory> trajectory;
        try {
            trajectory = simulate(model_, run);
        } catch (const InputError&) {
            add_nothing(point, RunEnd(), signature_of_nothing, rows);
            continue;
        }
        if (is_section()) {
            add_sections(worker.measuring, *trajectory, point, rows);
            continue;
        }
        rows.points.push_back(point);
        worker.measuring.at_end(*trajectory, rows.numbers);
        rows.held.push_back(trajectory->end_mode.held());
        if (measures_.prints_modes()) rows.modes.push_back(trajectory->end_mode);
        rows.ends.emplace_back(trajectory->outcome.kind);
        rows.signatures.push_back(signature_of(*trajectory));
    }
    return rows;
}

SweepData::SweepData(const SweepTable& table)
    : sweep(table.sweep()), columns(table.measures().columns()), numbers(table.measures().numbers()) {
    const SystemDescription& description = table.model().description();
    for (const SweepAxis& axis : sweep.axes) {
        const bool is_of_start =
            std::any_of(description.coordinates.begin(), description.coordinates.end(),
                        [&](const auto& c) { return axis.name == c.name || axis.name == c.name + "'"; });
        names.push_back(axis.name + (is_of_start ? "(0)" : ""));
        units.push_back(unit_of_axis(description, axis.name));
    }
    for (const auto& constraint : description.constraints) contacts.push_back(constraint.name);
    for (const SlidingPlace& place : sliding_places(description)) sliding.emplace_back(place.number, place.name);
}

void SweepData::add(const Rows& more) {
    const auto append = [](auto& list, const auto& after) { list.insert(list.end(), after.begin(), after.end()); };
    append(rows.points, more.points);
    append(rows.numbers, more.numbers);
    append(rows.held, more.held);
    append(rows.modes, more.modes);
    append(rows.ends, more.ends);
    append(rows.signatures, more.signatures);
    append(rows.times, more.times);
    append(rows.contacts, more.contacts);
}

void SweepData::add(const Rows& more, std::size_t row) {
    rows.points.push_back(more.points[row]);
    const auto number = more.numbers.begin() + static_cast<std::ptrdiff_t>(row * numbers);
    rows.numbers.insert(rows.numbers.end(), number, number + static_cast<std::ptrdiff_t>(numbers));
    rows.held.push_back(more.held[row]);
    if (!more.modes.empty()) rows.modes.push_back(more.modes[row]);
    rows.ends.push_back(more.ends[row]);
    rows.signatures.push_back(more.signatures[row]);
    if (!is_section()) return;
    rows.times.push_back(more.times[row]);
    rows.contacts.push_back(more.contacts[row]);
}

}  // namespace achilles
