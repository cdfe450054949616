#include "output/sweep_columns.hpp"

#include <fmt/format.h>

#include <map>
#include <mutex>

#include "expression/nearest.hpp"
#include "model/model.hpp"
#include "output/contacts.hpp"
#include "output/sweep_files.hpp"
#include "study/chunks.hpp"

namespace achilles {

namespace {

using Kind = RunMeasures::Column::Kind;

// Row `row` of some, at the end of every column.
void append(const SweepTable& table, const Rows& rows, std::size_t row, std::vector<SweepColumn>& columns) {
    std::size_t next = 0;
    const auto number = [&](double value) { columns[next++].numbers.push_back(value); };
    const auto names = [&](ContactSet set) {
        columns[next++].words.push_back(set.empty() ? std::string() : joined_names(table.model(), set, "+"));
    };
    const Sweep& sweep = table.sweep();
    for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis) number(sweep.value(axis, rows.points[row]));
    if (table.is_section()) {
        number(rows.times[row]);
        names(rows.contacts[row]);
    }
    std::size_t measure = row * table.measures().numbers();
    for (const RunMeasures::Column& column : table.measures().columns()) {
        if (column.kind == Kind::number) number(rows.numbers[measure++]);
        if (column.kind == Kind::held) names(rows.held[row]);
    }
    columns[next].words.emplace_back(rows.ends[row].text());
}

}  // namespace

const SweepColumn& SweepColumns::operator[](std::string_view name) const {
    std::vector<std::string> names;
    for (const SweepColumn& column : all) {
        if (column.name == name) return column;
        names.push_back(column.name);
    }
    throw InputError({}, {}, fmt::format("the sweep has no column '{}'{}", name, did_you_mean(name, names)));
}

SweepColumns sweep_columns(const std::shared_ptr<const Model>& model, const Sweep& sweep, int threads,
                           const std::function<bool(std::uint64_t done)>& go_on) {
    const SweepTable table(model, sweep);
    SweepColumns result;
    for (const SweepHeading& heading : sweep_headings(table))
        result.all.push_back({heading.name, heading.unit, {}, {}});
    // Rows are kept here until it is their turn; there are no bytes.
    std::mutex mutex;
    std::map<std::uint64_t, Rows> made;
    std::atomic<bool> stop{false};
    const auto task = [&](Chunk chunk) {
        Rows rows = table.rows(chunk.first, chunk.count);
        const std::scoped_lock lock(mutex);
        made.emplace(chunk.first, std::move(rows));
        return std::string();
    };
    const auto take = [&](Chunk chunk, const std::string&) {
        std::unique_lock lock(mutex);
        const Rows rows = std::move(made.extract(chunk.first).mapped());
        lock.unlock();
        for (std::size_t row = 0; row < rows.count(); ++row) append(table, rows, row, result.all);
        if (go_on && !go_on(chunk.first + chunk.count)) stop = true;
    };
    do_chunks(0, sweep.count(), threads, task, take, stop);
    return result;
}

}  // namespace achilles
