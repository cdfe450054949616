#include "figure/plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "figure/ticks.hpp"
#include "figure/values.hpp"

namespace achilles {

namespace {

ViewDescription view_of(const PlaneTexts& texts) {
    ViewDescription view;
    view.x.text = texts.first;
    view.y.push_back({texts.second, {}});
    return view;
}

std::string trimmed(const std::string& text) {
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

PlaneAxis axis_of(const SystemDescription& description, const std::string& written, double factor) {
    PlaneAxis axis{trimmed(written), factor};
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const std::string& name = description.coordinates[i].name;
        axis.is_rate = axis.text == name + "'";
        if (axis.text != name && !axis.is_rate) continue;
        axis.coordinate = static_cast<Eigen::Index>(i);
        return axis;
    }
    const std::vector<std::string> gaps = output_names(description, "gap");
    const auto found = std::find(gaps.begin(), gaps.end(), axis.text);
    if (found != gaps.end()) axis.gap = static_cast<std::size_t>(found - gaps.begin());
    return axis;
}

}  // namespace

std::vector<PlaneTexts> planes_of(const SystemDescription& description) {
    std::vector<PlaneTexts> all;
    const auto& coordinates = description.coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        for (std::size_t j = i + 1; j < coordinates.size(); ++j)
            all.emplace_back(coordinates[i].name, coordinates[j].name);
    for (const CoordinateDescription& c : coordinates) all.emplace_back(c.name, c.name + "'");
    const std::vector<std::string> gaps = output_names(description, "gap"), rates = output_names(description, "gap'");
    for (std::size_t i = 0; i < gaps.size(); ++i) all.emplace_back(gaps[i], rates[i]);
    return all;
}

Plane::Plane(const Model& model, const PlaneTexts& texts)
    : model_(&model),
      view_(model, view_of(texts)),
      x_(axis_of(model.description(), texts.first, view_.quantities()[0].factor)),
      y_(axis_of(model.description(), texts.second, view_.quantities()[1].factor)) {
    const Equations& equations = model.equations();
    if (x_.text == y_.text) x_.coordinate.reset(), y_.coordinate.reset();  // a line is no plane
    std::vector<std::uint32_t> of_axes;
    for (const PlaneAxis* axis : {&x_, &y_})
        if (is_of_states() && !axis->is_rate) of_axes.push_back(static_cast<std::uint32_t>(*axis->coordinate));
    std::vector<Expression> shown;
    for (const Expression& gap : equations.gaps) {
        is_shown_.push_back(!of_axes.empty() && depends_on(gap, of_axes));
        if (is_shown_.back()) shown.push_back(gap);
    }
    surface_slots_ = slots_of(shown);
    if (is_of_states())
        level_slots_ = slots_of(std::array{is_of_coordinates() ? equations.potential : equations.energy});
}

// Of the state, other than the axes.
std::vector<std::size_t> Plane::slots_of(std::span<const Expression> expressions) const {
    const Layout& layout = model_->layout();
    std::vector<std::size_t> slots;
    const auto ask = [&](std::size_t slot) {
        const auto asked = static_cast<std::uint32_t>(slot);
        if (std::any_of(expressions.begin(), expressions.end(), [&](const Expression& e) {
                return depends_on(e, {&asked, 1});
            }))
            slots.push_back(slot);
    };
    for (std::size_t i = 0; i < 2 * layout.dof; ++i) {
        const auto is_it = [&](const PlaneAxis& axis) {
            return axis.coordinate && i == static_cast<std::size_t>(*axis.coordinate) + (axis.is_rate ? layout.dof : 0);
        };
        if (!is_it(x_) && !is_it(y_)) ask(i);
    }
    ask(layout.t());
    return slots;
}

std::vector<double> Plane::values_at(const State& state, const std::vector<std::size_t>& slots) const {
    const auto n = static_cast<std::size_t>(state.q.size());
    std::vector<double> values;
    for (const std::size_t slot : slots)
        values.push_back(slot < n       ? state.q[static_cast<Eigen::Index>(slot)]
                         : slot < 2 * n ? state.v[static_cast<Eigen::Index>(slot - n)]
                                        : state.t);
    return values;
}

// Over the plane; nothing if the plane does not tell it.
std::optional<PlaneFunction> Plane::gap(std::size_t contact, std::span<const double> parameters,
                                        const State& state) const {
    if (x_.gap == contact) return [factor = x_.factor](const Point& p) { return p.x / factor; };
    if (y_.gap == contact) return [factor = y_.factor](const Point& p) { return p.y / factor; };
    if (!is_shown_[contact]) return std::nullopt;
    auto gap = model_->evaluator(model_->gap(contact), parameters);
    return [gap, x = x_, y = y_, here = State(state)](const Point& p) mutable {
        x.of(here) = p.x / x.factor;
        y.of(here) = p.y / y.factor;
        set_state(gap, here);
        gap.run();
        return gap.output(0);
    };
}

Plane::Surfaces Plane::surfaces(std::span<const double> parameters, const State& state, const Drawing& limits) const {
    std::vector<std::size_t> contacts;
    std::vector<PlaneFunction> gaps;
    std::vector<Field> fields;
    for (std::size_t i = 0; i < model_->contacts(); ++i) {
        auto gap = this->gap(i, parameters, state);
        if (!gap) continue;
        contacts.push_back(i);
        gaps.push_back(std::move(*gap));
        fields.emplace_back(limits, gaps.back());
    }
    if (contacts.empty()) return {};
    Surfaces result;
    result.open = Field::least(fields).not_negative();
    std::vector<std::vector<Point>> lines = borders(fields, gaps);
    for (std::size_t i = 0; i < contacts.size(); ++i) result.lines.push_back({contacts[i], std::move(lines[i])});
    return result;
}

std::vector<Plane::Level> Plane::levels(std::span<const double> parameters, const State& state,
                                        const Drawing& limits) const {
    if (!is_of_states()) return {};
    auto energy = model_->evaluator(model_->energy(), parameters);
    const bool is_potential = is_of_coordinates();
    State here = state;
    constexpr int columns = 80, rows = 60;  // while time passes, a frame makes them anew
    const PlaneFunction value = [&](const Point& p) {
        x_.of(here) = p.x / x_.factor;
        y_.of(here) = p.y / y_.factor;
        set_state(energy, here);
        energy.run();
        return is_potential ? energy.potential() : energy.total();
    };
    const Field field(limits, value, columns, rows);
    const auto [low, high] = field.range();
    constexpr double rounding = 1e-12;  // of what is the same everywhere
    if (!(high - low > rounding * std::max(std::abs(low), std::abs(high)))) return {};
    Axis axis;
    constexpr int most = 12;
    set_ticks(axis, low, high, 0.0, most);
    std::vector<Level> levels;
    for (const Tick& tick : axis.ticks) {
        if (tick.label.empty()) continue;
        std::vector<Point> points = field.level_line(tick.value);
        if (!points.empty()) levels.push_back({tick.label, std::move(points)});
    }
    return levels;
}

std::vector<ImpactArrow> impact_arrows(const Trajectory& trajectory, const PreparedView& view, const Panel& panel,
                                       double width, double height, double least) {
    constexpr std::size_t most = 20000;  // looked at
    Values values(view, trajectory);
    Sampler sampler(trajectory);
    const auto point = [&](const Sample& sample) {
        values.set(sample);
        return Point{values[0], values[1]};
    };
    const double unit_x = width / (panel.x.high - panel.x.low), unit_y = height / (panel.y.high - panel.y.low);
    std::set<std::array<long, 4>> taken;
    std::vector<ImpactArrow> arrows;
    std::size_t looked_at = 0;
    double last = trajectory.run.options.start_time;  // when an impact was
    for (const Event& event : trajectory.events) {
        if (event.kind != Event::Kind::impact) continue;
        if (++looked_at > most) break;
        constexpr double little = 0.1;  // of a flight
        const Point coming = point(sampler.at(event.t - little * (event.t - last)));
        last = event.t;
        Sample before = sampler.at(std::nextafter(event.t, -std::numeric_limits<double>::infinity()));
        before.state = {event.q, event.v_before, event.t};
        const ImpactArrow arrow{point(before), point(sample_at(trajectory, event)), coming};
        const std::array in_plot{arrow.from.x * unit_x, arrow.from.y * unit_y, arrow.to.x * unit_x,
                                 arrow.to.y * unit_y};
        // What is not finite is not as long as that either.
        if (!(std::hypot(in_plot[2] - in_plot[0], in_plot[3] - in_plot[1]) >= least)) continue;
        std::array<long, 4> cell{};
        std::transform(in_plot.begin(), in_plot.end(), cell.begin(), [&](double x) { return std::lround(x / least); });
        if (taken.insert(cell).second) arrows.push_back(arrow);
    }
    return arrows;
}

}  // namespace achilles
