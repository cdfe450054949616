// The rows of a sweep as columns in memory, as CSV, and as bytes.
#include "output/sweep_columns.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <mutex>
#include <stdexcept>

#include "analysis/chunks.hpp"
#include "expression/name_suggestions.hpp"
#include "model/model.hpp"
#include "output/contacts.hpp"
#include "output/sweep_files.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

using Kind = RunMeasures::Column::Kind;

// Appends row `row` to the columns.
void append(const SweepTable& table, const Rows& rows, std::size_t row, std::vector<SweepColumn>& columns) {
    std::size_t next = 0;
    const auto number = [&](double value) { columns[next++].numbers.push_back(value); };
    const auto names = [&](ContactSet set) {
        columns[next++].words.push_back(set.empty() ? std::string() : joined_names(table.model(), set, "+"));
    };
    const SweepSpec& sweep = table.sweep();
    for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis) number(sweep.value(axis, rows.points[row]));
    if (table.is_section()) {
        number(rows.times[row]);
        names(rows.contacts[row]);
    }
    std::size_t measure = row * table.measures().numbers();
    for (const RunMeasures::Column& column : table.measures().columns()) {
        if (column.kind == Kind::number) number(rows.numbers[measure++]);
        if (column.kind == Kind::held) names(rows.held[row]);
        if (column.kind == Kind::modes) columns[next++].words.push_back(modes_text(table.model(), rows.modes[row]));
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

SweepColumns sweep_columns(const std::shared_ptr<const Model>& model, const SweepSpec& sweep, int threads,
                           const std::function<bool(std::uint64_t done)>& go_on) {
    const SweepTable table(model, sweep);
    SweepColumns result;
    for (const SweepHeading& heading : sweep_headings(table))
        result.all.push_back({heading.name, heading.unit, {}, {}});
    // Chunks are stored here until all earlier ones are done.
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

namespace {

using Column = RunMeasures::Column;

// In the shortest form that is read back as the same double; empty if it is not finite.
void append_number(std::string& text, double x) {
    if (std::isfinite(x)) fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), x + 0.0);
}

// A cell by RFC 4180: in quotes if it contains a comma or a quote; quotes are doubled.
std::string quoted_cell(const std::string& text) {
    if (text.find_first_of(",\"") == text.npos) return text;
    std::string cell = "\"";
    for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
    return cell + "\"";
}

}  // namespace

std::vector<SweepHeading> sweep_headings(const SweepTable& table) {
    std::vector<SweepHeading> headings;
    const std::vector<std::string>& prints = table.sweep().prints;
    // An axis whose name is also printed at the end of the run gets the suffix (0).
    const auto name_of = [&](const SweepAxis& axis) {
        return axis.name + (std::find(prints.begin(), prints.end(), axis.name) == prints.end() ? "" : "(0)");
    };
    for (const SweepAxis& axis : table.sweep().axes)
        headings.push_back({name_of(axis), unit_of_axis(table.model().description(), axis.name)});
    if (table.is_section()) headings.insert(headings.end(), {{"t", "s"}, {"contact", ""}});
    for (const Column& column : table.measures().columns())
        if (column.kind != Column::Kind::outcome) headings.push_back({column.name, column.unit});
    headings.push_back({"outcome", ""});
    return headings;
}

std::string sweep_csv_heading(const SweepTable& table, bool units) {
    std::string names, of_them;
    for (const SweepHeading& heading : sweep_headings(table)) {
        const char* const comma = names.empty() ? "" : ",";
        names += comma + quoted_cell(heading.name);
        of_them += comma + printable(heading.unit);
    }
    return names + "\n" + (units ? of_them + "\n" : "");
}

std::string sweep_csv(const SweepTable& table, const Rows& rows) {
    std::string text;
    text.reserve(rows.count() * (table.sweep().axes.size() + table.measures().columns().size() + 1) * 20);
    std::size_t next = 0;  // index of the next number
    const SweepSpec& sweep = table.sweep();
    for (std::size_t row = 0; row < rows.count(); ++row) {
        for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis) {
            if (axis > 0) text += ',';
            append_number(text, sweep.value(axis, rows.points[row]));
        }
        if (table.is_section()) {
            if (!sweep.axes.empty()) text += ',';
            append_number(text, rows.times[row]);
            text += ',';
            text += joined_names(table.model(), rows.contacts[row], "+");
        }
        for (const Column& column : table.measures().columns()) {
            if (column.kind == Column::Kind::outcome) continue;
            text += ',';
            if (column.kind == Column::Kind::number) append_number(text, rows.numbers[next++]);
            if (column.kind == Column::Kind::held && !rows.held[row].empty())
                text += joined_names(table.model(), rows.held[row], "+");
            if (column.kind == Column::Kind::modes) text += modes_text(table.model(), rows.modes[row]);
        }
        text += ',';
        text += rows.ends[row].text();
        text += '\n';
    }
    return text;
}

// ---- bytes ----

namespace {

template <class Element>
void put(std::string& bytes, const std::vector<Element>& list) {
    static_assert(std::is_trivially_copyable_v<Element>);
    if (!list.empty()) bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(Element));
}

template <class Element>
void take(std::string_view& bytes, std::vector<Element>& list, std::size_t count) {
    if (bytes.size() < count * sizeof(Element)) throw std::runtime_error("the rows are incomplete");
    if (count == 0) return;
    list.resize(count);
    std::memcpy(list.data(), bytes.data(), count * sizeof(Element));
    bytes.remove_prefix(count * sizeof(Element));
}

}  // namespace

// The number of rows, then the lists.
std::string to_bytes(const Rows& rows) {
    std::string bytes;
    const std::uint64_t count = rows.count();
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    put(bytes, rows.points);
    put(bytes, rows.numbers);
    put(bytes, rows.held);
    put(bytes, rows.modes);
    put(bytes, rows.ends);
    put(bytes, rows.signatures);
    put(bytes, rows.times);
    put(bytes, rows.contacts);
    return bytes;
}

Rows rows_from(std::string_view bytes, const SweepTable& table) {
    std::uint64_t count = 0;
    if (bytes.size() < sizeof count) throw std::runtime_error("the rows are incomplete");
    std::memcpy(&count, bytes.data(), sizeof count);
    bytes.remove_prefix(sizeof count);
    if (count > bytes.size()) throw std::runtime_error("the rows are incomplete");
    Rows rows;
    take(bytes, rows.points, count);
    take(bytes, rows.numbers, count * table.measures().numbers());
    take(bytes, rows.held, count);
    if (table.measures().prints_modes()) take(bytes, rows.modes, count);
    take(bytes, rows.ends, count);
    take(bytes, rows.signatures, count);
    if (table.is_section()) {
        take(bytes, rows.times, count);
        take(bytes, rows.contacts, count);
    }
    if (!bytes.empty()) throw std::runtime_error("the rows belong to a different table");
    return rows;
}

}  // namespace achilles
