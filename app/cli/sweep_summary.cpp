#include "cli/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace achilles {

void SweepSummary::note(const Rows& rows) {
    const std::size_t width = columns_.size();
    for (std::size_t row = 0; row < rows.count(); ++row) {
        const std::uint64_t point = rows.points[row];
        const bool has_moment = !table_->is_section() || std::isfinite(rows.times[row]);
        if (has_moment) ++totals_.rows;
        if (totals_.last_point != point) {
            ++totals_.runs;
            if (rows.ends[row] == RunEnd(Outcome::Kind::end_time)) ++totals_.whole;
            totals_.last_point = point;
        }
        for (std::size_t i = 0; i < width; ++i) {
            const double x = rows.numbers[row * width + i];
            Column one;
            if (std::isfinite(x))
                one.count = 1, one.first = one.last = point, one.low = one.high = x;
            else
                one.missing = 1, one.first_missing = one.last_missing = point;
            add(columns_[i], one);
        }
    }
}

void SweepSummary::add(Column& column, const Column& more) {
    if (more.count > 0) {
        column.low = column.count > 0 ? std::min(column.low, more.low) : more.low;
        column.high = column.count > 0 ? std::max(column.high, more.high) : more.high;
        column.first = std::min(column.first, more.first);
        column.last = std::max(column.last, more.last);
    }
    column.first_missing = std::min(column.first_missing, more.first_missing);
    column.last_missing = std::max(column.last_missing, more.last_missing);
    column.count += more.count;
    column.missing += more.missing;
}

std::string SweepSummary::behind(std::string bytes) const {
    bytes.append(reinterpret_cast<const char*>(&totals_), sizeof totals_);
    if (!columns_.empty())
        bytes.append(reinterpret_cast<const char*>(columns_.data()), columns_.size() * sizeof(Column));
    return bytes;
}

std::string SweepSummary::take(std::string bytes) {
    std::vector<Column> columns(columns_.size());
    const std::size_t size = columns.size() * sizeof(Column);
    Totals totals;
    const char* const begin = bytes.data() + bytes.size() - size - sizeof totals;
    std::memcpy(&totals, begin, sizeof totals);
    if (size > 0) std::memcpy(columns.data(), begin + sizeof totals, size);
    totals_.runs += totals.runs;
    totals_.whole += totals.whole;
    totals_.rows += totals.rows;
    for (std::size_t i = 0; i < columns.size(); ++i) add(columns_[i], columns[i]);
    bytes.resize(bytes.size() - size - sizeof totals);
    return bytes;
}

const RunMeasures::Column& SweepSummary::column_of(std::size_t number) const {
    const auto& columns = table_->measures().columns();
    const auto is_number = [&](const RunMeasures::Column& column) {
        return column.kind == RunMeasures::Column::Kind::number && number-- == 0;
    };
    return *std::find_if(columns.begin(), columns.end(), is_number);
}

std::string SweepSummary::name_of(std::size_t number) const { return column_of(number).name; }

std::string SweepSummary::unit_of(std::size_t number) const {
    const std::string& unit = column_of(number).unit;
    return unit.empty() ? "" : " " + unit;
}

// "e >= 0.7125" where one axis has it at one end, else the first point; "" over no axis.
std::string SweepSummary::where_missing(const Column& column) const {
    const Sweep& sweep = table_->sweep();
    if (sweep.axes.empty()) return "";
    const auto at = [&](std::size_t axis, std::uint64_t point) {
        return fmt::format("{:.6g}", sweep.value(axis, point));
    };
    const SweepAxis& axis = sweep.axes.front();
    if (sweep.axes.size() == 1 && !sweep.random) {
        const bool is_up = axis.low < axis.high;
        if (column.last < column.first_missing)
            return fmt::format("{} {} {}", axis.name, is_up ? ">=" : "<=", at(0, column.first_missing));
        if (column.last_missing < column.first)
            return fmt::format("{} {} {}", axis.name, is_up ? "<=" : ">=", at(0, column.last_missing));
    }
    std::string where;
    for (std::size_t i = 0; i < sweep.axes.size(); ++i)
        where += fmt::format("{}{} = {}", i == 0 ? "first at " : ", ", sweep.axes[i].name, at(i, column.first_missing));
    return where;
}

std::string SweepSummary::text() const {
    const std::string& title = table_->model().description().title;
    const bool is_section = table_->is_section();
    std::string text =
        fmt::format("{}: {} run{}, {}{}\n", title, totals_.runs, totals_.runs == 1 ? "" : "s",
                    totals_.whole == totals_.runs ? "all reached the end time"
                                                  : fmt::format("{} reached the end time", totals_.whole),
                    is_section ? fmt::format("; {} rows", totals_.rows) : "");
    std::size_t width = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) width = std::max(width, name_of(i).size());
    const char* const things = is_section ? "rows" : "runs";
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const Column& column = columns_[i];
        text += fmt::format("  {:<{}}   ", name_of(i), width);
        if (column.count == 0) {
            text += fmt::format("exists in none of the {} runs\n", totals_.runs);
            continue;
        }
        const std::string low = fmt::format("{:.6g}", column.low), high = fmt::format("{:.6g}", column.high);
        text += low == high ? low : low + " to " + high;
        text += fmt::format("{} in {} {}", unit_of(i), column.count, things);
        if (column.missing > 0 && !is_section)
            text += fmt::format("; does not exist in {} ({})", column.missing, where_missing(column));
        text += '\n';
    }
    return text;
}

std::vector<std::string> SweepSummary::nowhere() const {
    std::vector<std::string> sentences;
    for (std::size_t i = 0; i < columns_.size(); ++i)
        if (columns_[i].count == 0 && totals_.runs > 0)
            sentences.push_back(fmt::format("{} exists in none of the {} runs", name_of(i), totals_.runs));
    return sentences;
}

}  // namespace achilles
