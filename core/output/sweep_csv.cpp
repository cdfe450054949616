#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "output/contacts.hpp"
#include "output/sweep_files.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

using Column = RunMeasures::Column;

// The shortest form that reads back the same double; empty where it is not finite.
void append(std::string& text, double x) {
    if (std::isfinite(x)) fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), x + 0.0);
}

// A cell as RFC 4180 has it: in quotes where it holds a comma or a quote, which is doubled.
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
    // A start that is also printed at the end would be a column of the same name.
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
    std::size_t next = 0;  // number
    const Sweep& sweep = table.sweep();
    for (std::size_t row = 0; row < rows.count(); ++row) {
        for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis) {
            if (axis > 0) text += ',';
            append(text, sweep.value(axis, rows.points[row]));
        }
        if (table.is_section()) {
            if (!sweep.axes.empty()) text += ',';
            append(text, rows.times[row]);
            text += ',';
            text += joined_names(table.model(), rows.contacts[row], "+");
        }
        for (const Column& column : table.measures().columns()) {
            if (column.kind == Column::Kind::outcome) continue;
            text += ',';
            if (column.kind == Column::Kind::number) append(text, rows.numbers[next++]);
            if (column.kind == Column::Kind::held && !rows.held[row].empty())
                text += joined_names(table.model(), rows.held[row], "+");
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

// The lists one after the other, behind their length.
std::string to_bytes(const Rows& rows) {
    std::string bytes;
    const std::uint64_t count = rows.count();
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    put(bytes, rows.points);
    put(bytes, rows.numbers);
    put(bytes, rows.held);
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
