#include "study/sweep_data.hpp"

#include <algorithm>

namespace achilles {

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
}

void SweepData::add(const Rows& more) {
    const auto append = [](auto& list, const auto& after) { list.insert(list.end(), after.begin(), after.end()); };
    append(rows.points, more.points);
    append(rows.numbers, more.numbers);
    append(rows.held, more.held);
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
    rows.ends.push_back(more.ends[row]);
    rows.signatures.push_back(more.signatures[row]);
    if (!is_section()) return;
    rows.times.push_back(more.times[row]);
    rows.contacts.push_back(more.contacts[row]);
}

}  // namespace achilles
