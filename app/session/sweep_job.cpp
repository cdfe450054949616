#include "session/sweep_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <new>
#include <span>
#include <utility>

#include "figure/sweep_figure.hpp"
#include "study/chunks.hpp"

namespace achilles {

namespace {

// Points along one axis, of one level and the next: a first picture that comes at once, and each finer one costs so much
// more that those before it do not count.
constexpr std::uint64_t map_steps[] = {16, 64, 160}, curve_steps[] = {32, 128}, section_steps[] = {16, 64};
constexpr double lengths[] = {1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0};  // of one run

struct Stopped {};

std::shared_ptr<const SweepData> table_of(const std::shared_ptr<const Model>& model, const Sweep& sweep,
                                          const std::stop_token& stop) {
    const SweepTable table(model, sweep);
    auto data = std::make_shared<SweepData>(table);
    std::mutex mutex;
    std::map<std::uint64_t, SweepData> waiting;  // chunks that are made, by their first points
    const std::atomic<bool> never{false};
    const auto go_on = [&] {
        if (stop.stop_requested()) throw Stopped();
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
        data->add(waiting.extract(chunk.first).mapped().rows);
        if (data->count() > most_drawn_rows)
            throw InputError("sweep", {},
                             fmt::format("there are more than {} rows, the most that can be drawn", most_drawn_rows),
                             "use shorter runs, or fewer; achilles sweep --csv F writes the whole table");
    };
    do_chunks(0, sweep.count(), 0, task, write, never);
    return data;
}

}  // namespace

std::vector<Sweep> coarse_to_fine(const Sweep& sweep) {
    std::vector<Sweep> levels;
    if (sweep.axes.empty()) {
        for (const double share : lengths) {
            Sweep shorter = sweep;
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
        Sweep coarse = sweep;
        for (SweepAxis& axis : coarse.axes) axis.count = std::min(axis.count, most);
        if (coarse.random) coarse.random->count = std::min(coarse.random->count, most * most);
        if (coarse != sweep) levels.push_back(std::move(coarse));
    }
    levels.push_back(sweep);
    return levels;
}

void SweepJob::ask(const std::shared_ptr<const Model>& model, std::optional<Sweep> sweep) {
    if (sweep && !sweep->axes.empty()) sweep->base = SweepPoints(*sweep, model->description()).run(0);
    if (model == model_ && sweep == sweep_) return;
    const bool alike = model == model_ && sweep && sweep_ && sweep->prints == sweep_->prints && sweep->at == sweep_->at;
    model_ = model;
    sweep_ = std::move(sweep);
    if (!alike) data_.reset();
    is_current_ = false;
    problem_.clear();
    levels_ = sweep_ ? coarse_to_fine(*sweep_) : std::vector<Sweep>();
    next_ = 0;
    begin();
}

void SweepJob::begin() {
    if (next_ == levels_.size()) {
        if (levels_.empty()) worker_.start([](const std::stop_token&) { return std::shared_ptr<const SweepData>(); });
        return;
    }
    worker_.start([model = model_, level = levels_[next_]](const std::stop_token& stop) {
        try {
            return table_of(model, level, stop);
        } catch (const Stopped&) {
            return std::shared_ptr<const SweepData>();
        }
    });
}

void SweepJob::update(Patience patience) {
    while (is_busy()) {
        try {
            const auto made = worker_.take(patience);
            if (!made) return;
            data_ = *made;
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
    const auto work = [](const Sweep& sweep) {
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

}  // namespace achilles
