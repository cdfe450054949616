#include "figure/sweep_panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "figure/axes.hpp"
#include "figure/label.hpp"
#include "output/contacts.hpp"

namespace achilles {

ColumnView::ColumnView(const SweepData& data, std::size_t column) : data_(&data), kind_(Kind::sequence) {
    if (column == sequence_column) {
        name_ = "sequence of events";
        return;
    }
    using ColumnKind = RunMeasures::Column::Kind;
    const RunMeasures::Column& one = data.columns[column];
    switch (one.kind) {
        case ColumnKind::number:
            kind_ = Kind::number;
            break;
        case ColumnKind::held:
            kind_ = Kind::held;
            break;
        case ColumnKind::outcome:
            kind_ = Kind::outcome;
            break;
        case ColumnKind::modes:
            kind_ = Kind::modes;
            modes_ = data.rows.modes;
            std::sort(modes_.begin(), modes_.end());
            modes_.erase(std::unique(modes_.begin(), modes_.end()), modes_.end());
            break;
    }
    name_ = one.name;
    unit_ = shown_unit(one.unit);
    quantity_ = one.quantity;
    by_ = one.by;
    if (kind_ != Kind::number) return;
    const auto before = data.columns.begin() + static_cast<std::ptrdiff_t>(column);
    number_ = static_cast<std::size_t>(std::count_if(
        data.columns.begin(), before, [](const auto& other) { return other.kind == ColumnKind::number; }));
}

bool ColumnView::is_count() const { return is_count_of_events(name_); }

std::string ColumnView::label() const { return kind_ == Kind::number ? with_unit(name(), unit_.text) : name(); }

namespace {

// Text of a quantity in a label: "Zeno time 2" for zeno_time(2).
std::string words_of(const std::string& print) {
    const std::size_t bracket = std::min(print.find('('), print.size());
    const std::string word = print.substr(0, bracket), k = print.substr(bracket);
    for (const auto& [written, read] :
         {std::pair{"zeno_time", "Zeno time"}, std::pair{"impact_time", "impact time"},
          std::pair{"impact_speed", "impact speed"}, std::pair{"release_time", "release time"},
          std::pair{"zeno_points", "Zeno points"}, std::pair{"least_gap", "least gap"}}) {
        if (word != written) continue;
        if (k.empty()) return read;
        if (k.find(')') + 1 == k.size()) return std::string(read) + " " + k.substr(1, k.size() - 2);
    }
    return typeset(print);
}

}  // namespace

std::string ColumnView::name() const {
    if (!by_.empty()) return "\u2202(" + words_of(quantity_) + ")/\u2202" + typeset(by_);
    return kind_ == Kind::number ? words_of(name_) : name_;
}

std::vector<double> ColumnView::numbers() const {
    std::vector<double> all;
    all.reserve(data_->count());
    for (std::size_t row = 0; row < data_->count(); ++row)
        if (const double x = number(row); std::isfinite(x)) all.push_back(x);
    return all;
}

std::array<double, 2> ColumnView::range() const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> all = numbers();
    if (all.empty()) return {nan, nan};
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    return {*low, *high};
}

std::optional<std::uint64_t> ColumnView::code(std::size_t row) const {
    const RunEnd end = data_->rows.ends[row];
    if (kind_ == Kind::outcome) return end.code();
    if (end == RunEnd()) return std::nullopt;  // the row has no run
    if (kind_ == Kind::modes)
        return static_cast<std::uint64_t>(std::lower_bound(modes_.begin(), modes_.end(), data_->rows.modes[row]) -
                                          modes_.begin());
    return kind_ == Kind::held ? std::bit_cast<std::uint32_t>(data_->rows.held[row]) : data_->rows.signatures[row];
}

bool ColumnView::has_value(std::size_t row) const {
    return is_number() ? std::isfinite(number(row)) : code(row).has_value();
}

std::string ColumnView::class_name(std::uint64_t code, std::size_t place, double share) const {
    if (kind_ == Kind::outcome) return std::string(RunEnd::from(static_cast<std::uint8_t>(code)).text());
    if (kind_ == Kind::sequence) return fmt::format("{}. ({:.{}f} %)", place + 1, 100.0 * share, share < 0.095 ? 1 : 0);
    std::string names;
    if (kind_ == Kind::modes) names = modes_text(data_->sliding, modes_[code]);
    for (std::size_t i = 0; i < data_->contacts.size() && kind_ == Kind::held; ++i)
        if ((code >> i & 1u) != 0) names += (names.empty() ? "" : " + ") + data_->contacts[i];
    return names.empty() ? "no contact" : names;
}

std::vector<std::pair<std::uint64_t, std::string>> ColumnView::classes() const {
    std::map<std::uint64_t, std::size_t> counts;
    std::size_t all = 0;
    for (std::size_t row = 0; row < data_->count(); ++row)
        if (const auto one = code(row)) ++counts[*one], ++all;
    std::vector<std::pair<std::uint64_t, std::size_t>> sorted(counts.begin(), counts.end());
    if (kind_ == Kind::held)  // sets of few contacts first
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](const auto& a, const auto& b) { return std::popcount(a.first) < std::popcount(b.first); });
    else  // reaching the end time comes before all other outcomes
        std::stable_sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) {
            const auto is_whole = [&](std::uint64_t one) {
                return kind_ == Kind::outcome && one == RunEnd(Outcome::Kind::end_time).code();
            };
            return std::pair(is_whole(a.first), a.second) > std::pair(is_whole(b.first), b.second);
        });
    std::vector<std::pair<std::uint64_t, std::string>> classes;
    for (const auto& [one, count] : sorted)
        classes.emplace_back(one,
                             class_name(one, classes.size(), static_cast<double>(count) / static_cast<double>(all)));
    return classes;
}

namespace {

// The hues of phases, then those of events, then those of curves.
std::vector<Color> class_colors(const Theme& theme) {
    std::vector<Color> colors{phase_color(theme, Phase::Kind::hybrid), phase_color(theme, Phase::Kind::constrained),
                              event_markers(theme, Event::Kind::release).fill,
                              event_markers(theme, Event::Kind::zeno).fill};
    for (std::size_t i = 0; i < 5; ++i) colors.push_back(phase_stroke(theme, Phase::Kind::constrained, i, 8).color);
    return colors;
}

}  // namespace

SweepClasses::SweepClasses(const ColumnView& column, const Theme& theme) {
    const std::vector<Color> colors = class_colors(theme);
    for (const auto& [code, name] : column.classes())
        all.push_back({code, name, all.size() < colors.size() ? colors[all.size()] : theme.surface});
    named = all.size() <= colors.size() + 1 ? all.size() : colors.size();
    std::sort(all.begin() + static_cast<std::ptrdiff_t>(named), all.end(),
              [](const ClassStyle& a, const ClassStyle& b) { return a.code < b.code; });
}

std::size_t SweepClasses::place(std::uint64_t code) const {
    for (std::size_t i = 0; i < named; ++i)
        if (all[i].code == code) return i;
    return named;
}

Color SweepClasses::color(std::uint64_t code) const { return all[std::min(place(code), all.size() - 1)].color; }

std::vector<Markers> SweepClasses::keys() const {
    std::vector<Markers> keys;
    const auto add = [&](const std::string& name, const Color& color) {
        Markers markers;
        markers.label = name;
        markers.fill = color;
        markers.edge = {0, 0, 0, 0};
        markers.size = 11.0;
        keys.push_back(std::move(markers));
    };
    for (std::size_t i = 0; i < named; ++i) add(all[i].name, all[i].color);
    if (named < all.size()) add(fmt::format("{} others", all.size() - named), all.back().color);
    return keys;
}

ShownUnit shown_unit_of_axis(const SweepData& data, std::size_t index) {
    return shown_unit_of_setting(data.units[index], data.names[index] != data.sweep.axes[index].name);
}

SweepAxis shown_axis(const SweepData& data, std::size_t index) {
    SweepAxis axis = data.sweep.axes[index];
    const double factor = shown_unit_of_axis(data, index).factor;
    axis.low *= factor, axis.high *= factor;
    return axis;
}

Axis axis_of(const SweepData& data, std::size_t index) {
    const SweepAxis one = shown_axis(data, index);
    Axis axis;
    axis.label = with_unit(typeset(data.names[index]), shown_unit_of_axis(data, index).text);
    axis.logarithmic = one.logarithmic;
    const double low = std::min(one.low, one.high), high = std::max(one.low, one.high);
    set_ticks(axis, low, high, 0.0);
    return axis;
}

std::vector<std::uint32_t> rows_of_points(const SweepData& data) {
    std::vector<std::uint32_t> rows(data.sweep.count(), no_row);
    for (std::size_t row = 0; row < data.count(); ++row)
        if (data.rows.points[row] < rows.size()) rows[data.rows.points[row]] = static_cast<std::uint32_t>(row);
    return rows;
}

double edge_of(const SweepAxis& axis, double i) {
    const double parts = axis.count > 1 ? static_cast<double>(axis.count - 1) : 1.0;
    const double share = (i - 0.5) / parts;
    if (axis.logarithmic) return axis.low * std::pow(axis.high / axis.low, share);
    return axis.low + (axis.high - axis.low) * share;
}

Hatch nothing(const Theme& theme) { return {no_value, theme.border}; }

void set_limits(Axis& axis, const std::array<double, 2>& range, double margin) {
    set_ticks(axis, range[0], range[1], margin);
    if (!(range[0] <= range[1])) axis.ticks.clear();
}

}  // namespace achilles
