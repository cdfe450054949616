#include "figure/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "figure/axes.hpp"
#include "figure/compose.hpp"
#include "number/float_environment.hpp"
#include "output/proof.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

constexpr double least_seen = 1.0 / 150.0;  // fraction of the panel's height, perpendicular to the curve: a narrower
                                            // tube is hidden by its curve

// The name of a quantity of the first contact in views; "" if there is none.
std::string name_of_first_contact(const SystemDescription& system, std::string_view quantity) {
    const std::vector<std::string> names = output_names(system, quantity);
    return names.empty() ? "" : names.front();
}

// Whether the members of the enclosure are in contact at an instant.
enum class ContactCertainty { no, yes, either };

// Quantities of a view over the boxes of a proof, x first, in displayed units.
class EnclosedValues {
 public:
    EnclosedValues(const Trajectory& run, const Proof& proof, const PreparedView& view)
        : layout_(run.model->layout()), events_(proof.enclosure.events), view_(view), evaluator_(view.program()) {
        for (std::size_t i = 0; i < proof.claim.parameters.size(); ++i)
            evaluator_.input(layout_.parameter(i)) = proof.claim.parameters[i];
        evaluator_.fix();
        starts_in_contact_ = !run.phases.empty() && run.phases.front().kind == Phase::Kind::constrained;
        gap_ = name_of_first_contact(run.model->description(), "gap");
        force_ = name_of_first_contact(run.model->description(), "lambda");
    }

    std::vector<Interval> at(const EnclosedState& state) {
        const ContactCertainty contact = contact_at(state.t);
        std::vector<Interval> values;
        if (contact != ContactCertainty::yes) values = at(state, false);
        if (contact == ContactCertainty::no) return values;
        const std::vector<Interval> held = at(state, true);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = hull(values[i], held[i]);
        return values.empty() ? held : values;
    }

 private:
    ContactCertainty contact_at(double t) const {
        ContactCertainty contact = starts_in_contact_ ? ContactCertainty::yes : ContactCertainty::no;
        for (const EnclosedEvent& event : events_) {
            if (event.is_impact()) continue;
            if (event.t.contains(t)) return ContactCertainty::either;
            if (event.t.lo() > t) break;
            contact = event.is_zeno() ? ContactCertainty::yes : ContactCertainty::no;
        }
        return contact;
    }

    std::vector<Interval> at(const EnclosedState& state, bool in_contact) {
        for (std::size_t i = 0; i < state.q.size(); ++i) {
            evaluator_.input(layout_.q(i)) = state.q[i];
            evaluator_.input(layout_.v(i)) = state.v[i];
        }
        evaluator_.clock() = Interval(state.t);
        evaluator_.input(layout_.contact()) = Interval(in_contact ? 1.0 : 0.0);
        // A proof has no bounds on these.
        evaluator_.input(layout_.work()) = evaluator_.input(layout_.loss()) = Interval::everything();
        evaluator_.run();
        std::vector<Interval> values;
        for (std::size_t i = 0; i < view_.quantities().size(); ++i) {
            Interval value = evaluator_.output(i);
            // No member penetrates the surface; in contact the gap is 0 and the force is not negative.
            const std::string& text = view_.quantities()[i].text;
            if (in_contact && (text == gap_ || text == gap_ + "'")) value = Interval(0.0);
            if (in_contact && text == force_) value = Interval(std::max(value.lo(), 0.0), std::max(value.hi(), 0.0));
            if (!in_contact && text == gap_ && value.hi() >= 0.0)
                value = Interval(std::max(value.lo(), 0.0), value.hi());
            values.push_back(value * Interval(view_.quantities()[i].factor));
        }
        return values;
    }

    const Layout& layout_;
    const std::vector<EnclosedEvent>& events_;
    const PreparedView& view_;
    Evaluator<Interval> evaluator_;
    bool starts_in_contact_ = false;
    std::string gap_, force_;
};

bool is_within(const Axis& axis, double x) { return x >= axis.low && x <= axis.high; }

// Proved bounds of the quantities at an instant, and the values of the run just before and just after it, which differ
// at an event.
struct EnclosedSample {
    double t = 0.0;
    std::vector<Interval> proved;
    std::vector<double> before, after;
    bool is_event = false;  // some members have had the event by then, others have not
};

std::vector<EnclosedSample> known_of(const Trajectory& run, const Proof& proof, const PreparedView& view) {
    EnclosedValues enclosed(run, proof, view);
    Values values(view, run);
    Sampler sampler(run);
    const auto at = [&](double t) {
        values.set(sampler.at(t));
        std::vector<double> all;
        for (std::size_t i = 0; i < view.quantities().size(); ++i) all.push_back(values[i]);
        return all;
    };
    std::vector<EnclosedSample> known;
    auto event = proof.enclosure.events.begin();
    const auto add = [&](const EnclosedState& state) {
        while (event != proof.enclosure.events.end() && event->t.hi() < state.t) ++event;
        const bool is_event = event != proof.enclosure.events.end() && event->t.contains(state.t);
        known.push_back({state.t, enclosed.at(state), at(std::nextafter(state.t, -HUGE_VAL)), at(state.t), is_event});
    };
    for (const EnclosedState& state : proof.enclosure.samples) add(state);
    // A run that stopped early has no curve after its end.
    const auto& end = proof.enclosure.end;
    if (end && run.end_time >= end->t) add(*end);
    return known;
}

// Points of one quantity in a panel over time, in phases of every look.
std::vector<Point> course_of(const Panel& panel, std::size_t quantity) {
    std::vector<Point> course;
    for (const Curve& curve : std::span(panel.curves).subspan(quantity * panel.courses, panel.courses))
        for (const Point& point : curve.points)
            if (std::isfinite(point.x + point.y) && is_within(panel.x, point.x)) course.push_back(point);
    std::stable_sort(course.begin(), course.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    return course;
}

// Slices of the tube of one quantity. At the instants they have the proved bounds. Between two instants the distance of
// the bounds from the curve is interpolated; beside an event it is that at the other end. These interpolated bounds are
// at least `least`.
std::vector<Tube::Slice> slices_of(const std::vector<EnclosedSample>& known, std::size_t quantity,
                                   const std::vector<Point>& course, double least) {
    const std::size_t y = quantity + 1;
    std::vector<Tube::Slice> slices;
    auto point = course.begin();
    for (std::size_t k = 0; k < known.size(); ++k) {
        const EnclosedSample& here = known[k];
        const Interval& proved = here.proved[y];
        const bool is_there = proved.is_defined() && std::isfinite(proved.lo()) && std::isfinite(proved.hi());
        slices.push_back(
            {here.t, is_there ? proved.lo() : break_of_curve.x, is_there ? proved.hi() : break_of_curve.x});
        if (k + 1 == known.size()) break;
        const EnclosedSample& next = known[k + 1];
        while (point != course.end() && point->x <= here.t) ++point;
        for (; is_there && point != course.end() && point->x < next.t; ++point) {
            if (here.is_event && next.is_event) continue;
            const double between = (point->x - here.t) / (next.t - here.t);
            const double share = here.is_event ? 1.0 : next.is_event ? 0.0 : between;
            const auto off = [&](double from, double to) {
                return point->y + (1.0 - share) * (from - here.after[y]) + share * (to - next.before[y]);
            };
            slices.push_back({point->x, std::max(off(proved.lo(), next.proved[y].lo()), least),
                              std::max(off(proved.hi(), next.proved[y].hi()), least)});
        }
    }
    return slices;
}

// Lower bound of a quantity: gaps and contact forces are not negative.
double least_of(const PreparedView& view, const Trajectory& run, std::size_t quantity) {
    const std::string& text = view.quantities()[quantity].text;
    const SystemDescription& description = run.model->description();
    const bool is_positive =
        text == name_of_first_contact(description, "gap") || text == name_of_first_contact(description, "lambda");
    return is_positive ? 0.0 : -HUGE_VAL;
}

// Position of a value along an axis, 0 to 1; at the start of a logarithmic axis for values below it.
double share_within(const Axis& axis, double value) {
    if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
    return std::log(std::max(value, axis.low) / axis.low) / std::log(axis.high / axis.low);
}

// Whether a tube is wide enough to be visible somewhere. Its thickness is measured perpendicular to its direction, as a
// fraction of the panel's height, for a panel about twice as wide as high. The thickness of a jump is its duration.
bool is_seen(const Tube& tube, const Panel& panel) {
    constexpr double wide = 2.0;
    const auto middle = [&](const Tube::Slice& at) {
        return 0.5 * (share_within(panel.y, at.low) + share_within(panel.y, at.high));
    };
    for (std::size_t i = 0; i + 1 < tube.slices.size(); ++i) {
        const Tube::Slice &at = tube.slices[i], &next = tube.slices[i + 1];
        if (!is_within(panel.x, at.x)) continue;
        const double along = wide * (share_within(panel.x, next.x) - share_within(panel.x, at.x)),
                     up = middle(next) - middle(at),
                     high = share_within(panel.y, at.high) - share_within(panel.y, at.low);
        if (along > 0.0 && high * along / std::hypot(along, up) > least_seen) return true;
    }
    return false;
}

// Widens the limits for tubes that exceed them, up to a maximum. Slices at events are ignored, because they enclose the
// whole jump.
void give_room(Panel& panel, const std::vector<EnclosedSample>& known) {
    constexpr double most = 0.5, margin = 0.02;
    const auto is_event = [&](double t) {
        const auto at =
            std::lower_bound(known.begin(), known.end(), t, [](const EnclosedSample& a, double b) { return a.t < b; });
        return at != known.end() && at->t == t && at->is_event;
    };
    const double span = panel.y.high - panel.y.low;
    double low = panel.y.low, high = panel.y.high;
    for (const Tube& tube : panel.tubes)
        for (const Tube::Slice& at : tube.slices)
            if (is_within(panel.x, at.x) && std::isfinite(at.low + at.high) && !is_event(at.x))
                low = std::min(low, at.low), high = std::max(high, at.high);
    if (low < panel.y.low) low -= margin * span;
    if (high > panel.y.high) high += margin * span;
    low = std::max(low, panel.y.low - most * span), high = std::min(high, panel.y.high + most * span);
    if (low < panel.y.low || high > panel.y.high) set_ticks(panel.y, low, high, 0.0);
}

Markers undecided_mark(const Theme& theme, const Enclosure& proof) {
    Markers mark;
    mark.label = fmt::format("undecided from {} s on", reach_text(proof));
    mark.shape = Markers::MarkerShape::bar;
    mark.fill = mark.edge = theme.error;
    return mark;
}

bool is_undecided(const Enclosure& proof) { return proof.outcome.kind == Enclosure::ProofOutcome::Kind::undecided; }

// The sample times of the curves, each once, at most 2000 of them.
std::vector<double> instants_of(const Trajectory& run) {
    constexpr std::size_t most = 2000;
    std::vector<double> times;
    for (const Sample& sample : plot_samples(run))
        if (sample.t < run.end_time && (times.empty() || sample.t > times.back())) times.push_back(sample.t);
    if (times.size() <= most) return times;
    std::vector<double> some;
    for (std::size_t i = 0; i < most; ++i) some.push_back(times[i * (times.size() - 1) / (most - 1)]);
    return some;
}

}  // namespace

Tube proof_tube(const Theme& theme) {
    Tube tube;
    tube.label = "proved";
    tube.fill = theme.dark ? Color{240, 205, 60, 84} : Color{240, 200, 40, 110};
    tube.edge = theme.dark ? Color{226, 190, 60, 190} : Color{170, 132, 0, 190};
    return tube;
}

EnclosureProblem problem_to_draw(const Trajectory& run, const InitialUncertainty& spread) {
    EnclosureProblem claim = problem_of(run.model->description(), run.run, spread);
    check(*run.model, claim);
    claim.times = instants_of(run);
    return claim;
}

Proof proof_of(const Trajectory& run, const InitialUncertainty& spread) {
    const EnclosureProblem claim = problem_to_draw(run, spread);
    return {spread, claim, prove(run.model, claim)};
}

Panel with_proof(Panel panel, const Trajectory& run, const Proof& proof, const PreparedView& view,
                 const Framing& framing, const Theme& theme) {
    if (!view.quantities()[0].is_time || framing.difference) return panel;
    const FloatEnvironmentGuard ground;
    panel.shows_proof = true;
    const std::size_t curves = view.quantities().size() - 1;
    const Enclosure& enclosure = proof.enclosure;
    const std::vector<EnclosedSample> known = known_of(run, proof, view);
    for (std::size_t i = 0; i < curves; ++i) {
        if (framing.hidden.contains(i)) continue;
        Tube tube = proof_tube(theme);
        tube.slices = slices_of(known, i, course_of(panel, i), least_of(view, run, i + 1));
        if (is_seen(tube, panel)) panel.tubes.push_back(std::move(tube));
    }
    if (!framing.y && !framing.log_y) give_room(panel, known);
    if (!is_undecided(enclosure)) return panel;
    Markers mark = undecided_mark(theme, enclosure);
    mark.points = {{enclosure.proved_until, panel.y.low}};
    panel.markers.push_back(mark);
    Color shade = theme.ink;
    shade.a = 16;
    panel.bands.push_back({mark.label, shade, enclosure.proved_until, std::numeric_limits<double>::max()});
    return panel;
}

void name_proof(Figure& figure, const Proof& proof, const Theme& theme) {
    const auto any_panel = [&](auto&& has) { return std::any_of(figure.panels.begin(), figure.panels.end(), has); };
    const bool is_shown = any_panel([](const Panel&panel) { return panel.shows_proof; }),
               is_drawn = any_panel([](const Panel&panel) { return !panel.tubes.empty(); });
    std::string name = "proved";
    if (!is_shown && is_undecided(proof.enclosure)) name += fmt::format(" until {} s", reach_text(proof.enclosure));
    if (const std::string about = describe(proof.spread); !about.empty()) name += ": " + about;
    if (!is_shown) name += " (tubes are drawn in plots over t only)";
    if (is_shown && !is_drawn) name += " (narrower than the curves)";
    figure.keys.push_back({name, proof_tube(theme)});
    if (!is_shown || !is_undecided(proof.enclosure)) return;
    const Markers mark = undecided_mark(theme, proof.enclosure);
    figure.keys.push_back({mark.label, mark});
}

}  // namespace achilles
