#include "figure/plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "figure/axes.hpp"
#include "figure/compose.hpp"
#include "figure/field.hpp"
#include "simulate/contact_forces.hpp"

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
    if (x_.text == y_.text) x_.coordinate.reset(), y_.coordinate.reset();  // two equal axes span a line only
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

// Input slots of the state that expressions depend on, except those of the axes.
std::vector<std::size_t> Plane::slots_of(std::span<const Expression> expressions) const {
    const Layout& layout = model_->layout();
    std::vector<std::size_t> slots;
    const auto ask = [&](std::size_t slot) {
        const auto input = static_cast<std::uint32_t>(slot);
        if (std::any_of(expressions.begin(), expressions.end(), [&](const Expression& e) {
                return depends_on(e, {&input, 1});
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

// The gap as a function over the plane; nullopt if it does not depend on the axes.
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
    std::vector<ScalarField> fields;
    for (std::size_t i = 0; i < model_->contacts(); ++i) {
        auto gap = this->gap(i, parameters, state);
        if (!gap) continue;
        contacts.push_back(i);
        gaps.push_back(std::move(*gap));
        fields.emplace_back(limits, gaps.back());
    }
    if (contacts.empty()) return {};
    Surfaces result;
    result.open = ScalarField::least(fields).not_negative();
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
    constexpr int columns = 80, rows = 60;  // coarse, because it is recomputed in every frame of a playback
    const PlaneFunction value = [&](const Point& p) {
        x_.of(here) = p.x / x_.factor;
        y_.of(here) = p.y / y_.factor;
        set_state(energy, here);
        energy.run();
        return is_potential ? energy.potential() : energy.total();
    };
    const ScalarField field(limits, value, columns, rows);
    const auto [low, high] = field.range();
    constexpr double rounding = 1e-12;  // relative rounding error of a constant function
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
    constexpr std::size_t most = 20000;  // maximum number of impacts that are examined
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
    double last = trajectory.run.options.start_time;  // time of the previous impact, s
    for (const Event& event : trajectory.events) {
        if (!event.is_impact()) continue;
        if (++looked_at > most) break;
        constexpr double little = 0.1;  // fraction of a flight
        const Point coming = point(sampler.at(event.t - little * (event.t - last)));
        last = event.t;
        Sample before = sampler.at(std::nextafter(event.t, -std::numeric_limits<double>::infinity()));
        before.state = {event.q, event.v_before, event.t};
        const ImpactArrow arrow{point(before), point(sample_at(trajectory, event)), coming};
        const std::array in_plot{arrow.from.x * unit_x, arrow.from.y * unit_y, arrow.to.x * unit_x,
                                 arrow.to.y * unit_y};
        // Also rejects arrows that are not finite.
        if (!(std::hypot(in_plot[2] - in_plot[0], in_plot[3] - in_plot[1]) >= least)) continue;
        std::array<long, 4> cell{};
        std::transform(in_plot.begin(), in_plot.end(), cell.begin(), [&](double x) { return std::lround(x / least); });
        if (taken.insert(cell).second) arrows.push_back(arrow);
    }
    return arrows;
}

// ---- the boundaries h = 0 in the picture of a path ----

namespace {

using Pair = std::array<std::size_t, 2>;

// Two coordinates and the rectangle in which they are sampled.
struct PlaneRegion {
    Pair pair;
    Drawing box;
};

bool moves(const Model& model, std::size_t contact) {
    const std::uint32_t t = model.layout().t();
    return depends_on(model.equations().gaps[contact], {&t, 1});
}

// Contacts whose gaps depend on no other coordinates, and on time only if `also_moving`.
std::vector<std::size_t> contacts_of(const Model& model, const Pair& pair, bool also_moving) {
    std::vector<std::uint32_t> others;
    for (std::size_t i = 0; i < model.layout().dof; ++i)
        if (i != pair[0] && i != pair[1]) others.push_back(static_cast<std::uint32_t>(model.layout().q(i)));
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < model.contacts(); ++i)
        if (!depends_on(model.equations().gaps[i], others) && (also_moving || !moves(model, i))) found.push_back(i);
    return found;
}

// Evaluates the first two quantities of a view at given values of two coordinates and zero rates.
class PairPlane {
 public:
    PairPlane(const Trajectory& trajectory, const PreparedView& view, const Pair& pair)
        : run_(trajectory.model->evaluator(view.program(), trajectory.run.parameters)),
          forces_(*trajectory.model, trajectory.run.parameters),
          quantities_(view.quantities()),
          sample_{0.0,   0,  Phase::Kind::hybrid,
                  false, {}, {trajectory.run.q, Eigen::VectorXd::Zero(trajectory.run.v.size()), 0.0}},
          pair_(pair) {}
    Point operator()(const Point& q, double t = 0.0, double rate = 0.0) {
        State& state = sample_.state;
        state.q[static_cast<Eigen::Index>(pair_[0])] = q.x;
        state.q[static_cast<Eigen::Index>(pair_[1])] = q.y;
        state.v.setConstant(rate);
        state.t = t;
        forces_.run_view(run_, sample_);
        return {run_.output(0) * quantities_[0].factor, run_.output(1) * quantities_[1].factor};
    }

 private:
    Evaluator<double> run_;
    ContactForces forces_;
    std::span<const PreparedView::ViewQuantity> quantities_;
    Sample sample_;
    Pair pair_;
};

// Range of a coordinate in the samples, extended by half on each side; a full turn if it is an angle.
std::array<double, 2> reach(std::span<const Sample> samples, const CoordinateDescription& coordinate, Eigen::Index i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Sample& sample : samples) {
        low = std::min(low, sample.state.q[i]);
        high = std::max(high, sample.state.q[i]);
    }
    const double around = coordinate.unit == "rad" ? std::numbers::pi - 0.5 * (high - low) : 0.0;
    const double more = std::max(0.5 * (high - low), around);
    return {low - more, high + more};
}

std::optional<PlaneRegion> part_of(const Trajectory& trajectory, std::span<const Sample> samples,
                                   const PreparedView& view, const Panel& panel) {
    const Model& model = *trajectory.model;
    const auto& quantities = view.quantities();
    if (quantities.size() != 2 || samples.empty()) return std::nullopt;
    const auto& x = quantities[0].coordinate;
    const auto& y = quantities[1].coordinate;
    PlaneRegion part;
    if (x && y && *x != *y) {
        part.pair = {*x, *y};
        part.box.x_low = panel.x.low / quantities[0].factor, part.box.x_high = panel.x.high / quantities[0].factor;
        part.box.y_low = panel.y.low / quantities[1].factor, part.box.y_high = panel.y.high / quantities[1].factor;
        return part;
    }
    if (model.dof() != 2) return std::nullopt;
    part.pair = {0, 1};
    const auto& coordinates = model.description().coordinates;
    const auto first = reach(samples, coordinates[0], 0), second = reach(samples, coordinates[1], 1);
    part.box.x_low = first[0], part.box.x_high = first[1];
    part.box.y_low = second[0], part.box.y_high = second[1];
    // The quantities must depend on the coordinates only, and on both: equal values at other times and rates, different
    // ones elsewhere.
    PairPlane place(trajectory, view, part.pair);
    const Point here{trajectory.run.q[0], trajectory.run.q[1]};
    const Point at_rest = place(here), moving = place(here, 1.25, 0.75);
    const bool is_place = at_rest.x == moving.x && at_rest.y == moving.y && !quantities[0].is_time;
    return is_place ? std::optional(part) : std::nullopt;
}

// Refines the line h = 0 between two of its points until its chords look straight in the picture. The first point is
// not added.
class Straightener {
 public:
    Straightener(PlaneFunction gap, PairPlane& place, const Panel& panel)
        : gap_(std::move(gap)), place_(place), panel_(panel) {}
    void add(const Point& a, const Point& b, std::vector<Point>& line, int halvings = 0) {
        constexpr int most = 8;
        constexpr double flat = 1e-4;  // fraction of the picture: a tenth of a pixel
        const auto middle = zero_near(a, b);
        if (middle && halvings < most) {
            const Point p = in_picture(a), q = in_picture(*middle), r = in_picture(b);
            const double x = r.x - p.x, y = r.y - p.y, length = std::hypot(x, y);
            const double off = length > 0.0 ? std::abs(x * (q.y - p.y) - y * (q.x - p.x)) / length : 0.0;
            if (off > flat && off < 1.0) {
                add(a, *middle, line, halvings + 1);
                return add(*middle, b, line, halvings + 1);
            }
        }
        line.push_back(place_(b));
    }

 private:
    Point in_picture(const Point& q) {
        const Point p = place_(q);
        return {(p.x - panel_.x.low) / (panel_.x.high - panel_.x.low),
                (p.y - panel_.y.low) / (panel_.y.high - panel_.y.low)};
    }
    // Zero of the gap perpendicular to the chord at its midpoint, at most a chord length away. nullopt if the secant
    // method does not find one.
    std::optional<Point> zero_near(const Point& a, const Point& b) {
        const Point middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}, aside{a.y - b.y, b.x - a.x};
        const auto at = [&](double s) { return Point{middle.x + s * aside.x, middle.y + s * aside.y}; };
        constexpr int rounds = 20;
        constexpr double near = 1e-6;
        double s = 0.0, before = 1e-2, h = gap_(at(s)), h_before = gap_(at(before));
        for (int round = 0; round < rounds; ++round) {  // secant method
            const double step = -h * (s - before) / (h - h_before);
            if (!std::isfinite(step)) return h == 0.0 ? std::optional(at(s)) : std::nullopt;
            before = s, h_before = h;
            s += step;
            if (std::abs(s) > 1.0) return std::nullopt;
            h = gap_(at(s));
            if (std::abs(step) < near) return at(s);
        }
        return std::nullopt;
    }
    PlaneFunction gap_;
    PairPlane& place_;
    const Panel& panel_;
};

}  // namespace

bool has_moving_gap(const Model& model) {
    for (std::size_t i = 0; i < model.contacts(); ++i)
        if (moves(model, i)) return true;
    return false;
}

std::vector<Point> boundary(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
                            const Panel& panel, std::optional<double> t, const Resolution& size) {
    const auto part = part_of(trajectory, samples, view, panel);
    if (!part) return {};
    const Model& model = *trajectory.model;
    const std::vector<std::size_t> contacts = contacts_of(model, part->pair, t.has_value());
    const State here{trajectory.run.q, trajectory.run.v, t.value_or(trajectory.run.options.start_time)};
    std::vector<PlaneFunction> gaps;
    for (const std::size_t contact : contacts) {
        auto gap = model.evaluator(model.gap(contact), trajectory.run.parameters);
        set_state(gap, here);
        gaps.emplace_back([gap, pair = part->pair](const Point& p) mutable {
            gap.input(pair[0]) = p.x;
            gap.input(pair[1]) = p.y;
            gap.run();
            return gap.output(0);
        });
    }
    // A crest narrower than a few cells would be cut off.
    constexpr double cell = 2.5;  // pixels
    constexpr int min_columns = 160, min_rows = 120, most = 640;
    const int columns = std::clamp(static_cast<int>(size.width / cell), min_columns, most),
              rows = std::clamp(static_cast<int>(size.height / cell), min_rows, most);
    std::vector<ScalarField> fields;
    for (const PlaneFunction& gap : gaps) fields.emplace_back(part->box, gap, columns, rows);
    const std::vector<std::vector<Point>> lines = borders(fields, gaps);
    PairPlane place(trajectory, view, part->pair);
    std::vector<Point> line;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        Straightener straightener(gaps[i], place, panel);
        const Point* before = nullptr;
        for (const Point& point : lines[i]) {
            if (!std::isfinite(point.x))
                line.push_back(point);
            else if (before == nullptr || !std::isfinite(before->x))
                line.push_back(place(point));
            else
                straightener.add(*before, point, line);
            before = &point;
        }
    }
    return line;
}

}  // namespace achilles
