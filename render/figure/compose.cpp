#include "figure/compose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "figure/label.hpp"
#include "figure/ticks.hpp"

namespace achilles {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// Evaluates all of a view's quantities at a sample.
class Values {
 public:
    Values(const Program& program, const Trajectory& trajectory)
        : evaluator_(trajectory.model->evaluator(program, trajectory.run.parameters)),
          layout_(trajectory.model->layout()) {}
    void set(const Sample& sample) {
        put(evaluator_, sample.state);
        evaluator_.input(layout_.t()) = sample.t;
        evaluator_.input(layout_.contact()) = sample.contact ? 1.0 : 0.0;
        evaluator_.run();
    }
    double operator[](std::size_t i) const { return evaluator_.output(i); }

 private:
    Evaluator<double> evaluator_;
    const Layout& layout_;
};

// The range of all finite values.
struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    void include(double x) {
        if (!std::isfinite(x)) return;
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

Sample at_event(const Event& event) {
    Sample sample;
    sample.t = event.t;
    sample.state = {event.q, event.v_after};
    sample.contact = event.kind == Event::Kind::zeno;
    return sample;
}

}  // namespace

PreparedView::PreparedView(const Model& model, const ViewDescription& view) : name_(view.name) {
    std::vector<Text> texts{view.x};
    texts.insert(texts.end(), view.y.begin(), view.y.end());
    program_ = model.compile_view(texts);
    for (const Text& text : texts) quantities_.push_back(quantity(model.description(), text.text));
}

PreparedView::Quantity PreparedView::quantity(const SystemDescription& description, const std::string& text) {
    Quantity result{typeset(text), "", 1.0, text == "t"};
    bool units = false;
    for (const CoordinateDescription& c : description.coordinates) {
        units = units || !c.unit.empty();
        const bool is_rate = text == c.name + "'";
        if (text != c.name && !is_rate) continue;
        result.unit = c.unit == "rad" ? "deg" : c.unit;
        if (c.unit == "rad") result.factor = 180.0 / std::numbers::pi;
        if (is_rate && !result.unit.empty()) result.unit += "/s";
    }
    if (result.is_time && units) result.unit = "s";
    return result;
}

std::vector<Sample> plot_samples(const Trajectory& trajectory) {
    // A few thousand points fill any screen; between the step ends of a short run there is room for more.
    constexpr std::size_t wanted = 4000;
    const std::size_t steps = std::max<std::size_t>(1, trajectory.pieces.size());
    const int between = static_cast<int>(std::min<std::size_t>(24, wanted / steps));
    return Sampler(trajectory).all(between);
}

Panel compose(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
              const Theme& theme) {
    const auto& quantities = view.quantities_;
    const std::size_t curves = quantities.size() - 1;
    Panel panel;
    panel.title = view.name_;
    Values values(view.program_, trajectory);
    Range x_range, y_range;
    // Two curves for each quantity: its hybrid and its constrained parts, broken where the phase changes.
    for (std::size_t i = 0; i < curves; ++i) {
        for (const Phase::Kind kind : {Phase::Kind::hybrid, Phase::Kind::constrained}) {
            Curve curve;
            curve.stroke = phase_stroke(theme, kind, i, curves);
            const bool first = kind == Phase::Kind::hybrid;
            curve.label = curves == 1 ? legend_text(kind) : first ? quantities[i + 1].label : "";
            panel.curves.push_back(curve);
        }
    }
    const Sample* previous = nullptr;
    std::vector<double> last(quantities.size()), now(quantities.size());
    for (const Sample& sample : samples) {
        values.set(sample);
        for (std::size_t i = 0; i < now.size(); ++i) now[i] = values[i] * quantities[i].factor;
        const bool changed = previous == nullptr || previous->phase != sample.phase;
        x_range.include(now[0]);
        for (std::size_t i = 0; i < curves; ++i) {
            Curve& curve = panel.curves[2 * i + (sample.phase == Phase::Kind::hybrid ? 0 : 1)];
            if (changed) {
                if (!curve.points.empty()) curve.points.push_back({nothing, nothing});
                if (previous != nullptr) curve.points.push_back({last[0], last[i + 1]});
            }
            const Point point{now[0], now[i + 1]};
            curve.points.push_back(std::isfinite(point.x) && std::isfinite(point.y) ? point : Point{nothing, nothing});
            y_range.include(now[i + 1]);
        }
        previous = &sample;
        last = now;
    }
    for (const Event::Kind kind : {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release}) {
        Markers markers = event_markers(theme, kind);
        for (const Event& event : trajectory.events) {
            if (event.kind != kind) continue;
            values.set(at_event(event));
            for (std::size_t i = 0; i < curves; ++i)
                markers.points.push_back({values[0] * quantities[0].factor, values[i + 1] * quantities[i + 1].factor});
        }
        panel.markers.push_back(markers);
    }
    if (quantities[0].is_time) x_range.low = 0.0;
    set_ticks(panel.x, x_range.low, x_range.high, quantities[0].is_time ? 0.0 : 0.05);
    set_ticks(panel.y, y_range.low, y_range.high, 0.07);
    panel.x.label = with_unit(quantities[0].label, quantities[0].unit);
    if (curves == 1) panel.y.label = with_unit(quantities[1].label, quantities[1].unit);
    if (curves > 1) place_legend(panel);
    return panel;
}

void place_legend(Panel& panel) {
    panel.legend = true;
    constexpr double width = 0.3, height = 0.3;  // the part of a panel that a legend covers, at most
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (const std::array<double, 2> corner : {std::array{1.0, 1.0}, {0.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}}) {
        std::size_t covered = 0;
        for (const Curve& curve : panel.curves) {
            for (const Point& point : curve.points) {
                const double x = (point.x - panel.x.low) / (panel.x.high - panel.x.low);
                const double y = (point.y - panel.y.low) / (panel.y.high - panel.y.low);
                if (std::abs(x - corner[0]) < width && std::abs(y - corner[1]) < height) ++covered;
            }
        }
        if (covered >= least) continue;
        least = covered;
        panel.legend_at = corner;
    }
    if (least == 0) return;
    panel.legend_at = {1.0, 1.0};
    set_ticks(panel.y, panel.y.low, panel.y.high + height / (1.0 - height) * (panel.y.high - panel.y.low), 0.0);
}

Figure compose(const Trajectory& trajectory, std::span<const ViewDescription> views, const Theme& theme, int columns) {
    Figure figure;
    figure.columns = columns;
    figure.background = theme.background;
    figure.ink = theme.ink;
    figure.grid = theme.grid;
    const std::vector<Sample> samples = plot_samples(trajectory);
    for (const ViewDescription& view : views)
        figure.panels.push_back(compose(trajectory, samples, PreparedView(*trajectory.model, view), theme));
    return figure;
}

}  // namespace achilles
