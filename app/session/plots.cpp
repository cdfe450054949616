#include "session/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "figure/axes.hpp"
#include "session/command.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

constexpr int max_columns = 4, max_rows = 4;

ViewDescription view_of(const std::string& name, const std::string& x, const std::vector<std::string>& y) {
    ViewDescription view{name, {x, {}}, {}};
    for (const std::string& text : y) view.y.push_back({text, {}});
    return view;
}

bool same_expressions(const ViewDescription& a, const ViewDescription& b) {
    return a.x.text == b.x.text && std::equal(a.y.begin(), a.y.end(), b.y.begin(), b.y.end(),
                                              [](const Text& p, const Text& q) { return p.text == q.text; });
}

// Generic views: every coordinate and rate over time, the phase planes, the planes of two coordinates, and the gap.
std::vector<ViewDescription> more_views(const Model& model) {
    std::vector<ViewDescription> views;
    const auto add = [&](const std::string& x, const std::string& y) {
        views.push_back(view_of("", x, {y}));
        views.back().name = name_of(views.back());
    };
    const auto& coordinates = model.description().coordinates;
    for (const auto& c : coordinates) add("t", c.name);
    for (const auto& c : coordinates) add("t", c.name + "'");
    for (const auto& c : coordinates) add(c.name, c.name + "'");
    const auto of_gaps = [&](std::string_view quantity) { return output_names(model.description(), quantity); };
    for (const char* rate : {"gap'", "gap''"})
        for (const std::string& y : of_gaps(rate)) add("t", y);
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        for (std::size_t j = i + 1; j < coordinates.size(); ++j) add(coordinates[i].name, coordinates[j].name);
    const std::vector<std::string> gaps = of_gaps("gap"), rates = of_gaps("gap'"), forces = of_gaps("lambda");
    for (std::size_t i = 0; i < gaps.size(); ++i)
        for (const std::string& y : {rates[i], forces[i], std::string("energy")}) add(gaps[i], y);
    for (std::size_t i = 0; i < gaps.size(); ++i)
        for (const std::string& y : {gaps[i], forces[i]}) add(coordinates[0].name, y);
    add(coordinates[0].name, "energy");
    for (const std::string& y : gaps) add(coordinates[0].name + "'", y);
    add(coordinates[0].name + "'", "energy");
    return views;
}

}  // namespace

Plots::Plots(std::shared_ptr<const Model> model) : model_(std::move(model)), choices_(model_->description().views) {
    // One view per contact: "gap" or, with several contacts, "gap knee".
    const bool is_one = model_->contacts() == 1;
    for (const auto& [name, quantity] : {std::pair{"gap", "gap"}, {"contact force", "lambda"}}) {
        const std::vector<std::string> expressions = output_names(model_->description(), quantity);
        for (std::size_t i = 0; i < expressions.size(); ++i)
            offer(view_of(is_one ? name : fmt::format("{} {}", name, model_->description().constraints[i].name), "t",
                          {expressions[i]}));
    }
    offer(view_of("energy", "t", {"energy"}));
    // Enough distinct views for the largest grid.
    for (const ViewDescription& view : more_views(*model_))
        if (choices_.size() < max_columns * max_rows) offer(view);
    const std::size_t own = model_->description().views.size();
    columns_ = own > 2 ? 2 : 1;
    rows_ = own > 1 ? 2 : 1;
    fill();
}

// Adds a choice unless it is already present.
void Plots::offer(const ViewDescription& view) {
    if (std::none_of(choices_.begin(), choices_.end(), [&](const auto& c) { return same_expressions(c, view); }))
        choices_.push_back(view);
}

// Fills the grid with distinct plots, in the order of the choices.
void Plots::fill() {
    const auto places = static_cast<std::size_t>(columns_ * rows_);
    if (list_.size() > places) list_.resize(places);
    for (std::size_t i = 0; list_.size() < places; ++i) {
        const ViewDescription& view = choices_[i % choices_.size()];
        const bool is_there = i < choices_.size() && std::any_of(list_.begin(), list_.end(), [&](const Plot& plot) {
                                  return same_expressions(plot.view, view);
                              });
        if (!is_there) list_.push_back(prepared(view));
    }
}

bool operator==(const Plots& a, const Plots& b) {
    return a.columns_ == b.columns_ && a.rows_ == b.rows_ && a.linked_ == b.linked_ &&
           std::equal(a.list_.begin(), a.list_.end(), b.list_.begin(), b.list_.end(), [](const Plot& p, const Plot& q) {
               return p.view.name == q.view.name && same_expressions(p.view, q.view) && p.framing == q.framing;
           });
}

Plot Plots::prepared(const ViewDescription& view) const {
    return {view, std::make_shared<const PreparedView>(*model_, view), {}};
}

Plots Plots::carried_over(const std::shared_ptr<const Model>& model) const {
    Plots result(model);
    const auto& before = model_->description().views;
    const auto& after = model->description().views;
    // If the text itself has changed the views, show those of the text.
    if (!std::equal(before.begin(), before.end(), after.begin(), after.end(), same_expressions)) return result;
    result.columns_ = columns_;
    result.rows_ = rows_;
    result.linked_ = linked_;
    result.revision_ = revision_ + 1;
    result.list_.clear();
    try {
        for (const Plot& plot : list_) {
            result.list_.push_back(result.prepared(plot.view));
            result.list_.back().framing = plot.framing;
        }
    } catch (const InputError&) {  // the text no longer has a name that is used
        return Plots(model);
    }
    return result;
}

Plots Plots::only(int number) const {
    Plots one = *this;
    one.list_ = {one.at(number)};
    one.columns_ = one.rows_ = 1;
    return one;
}

Plot& Plots::at(int number) {
    if (number < 1 || static_cast<std::size_t>(number) > list_.size())
        throw refusal(fmt::format("there is no plot {}: the grid has {}", number, list_.size()));
    return list_[static_cast<std::size_t>(number - 1)];
}

void Plots::perform(const command::SetGrid& command) {
    if (command.columns < 1 || command.columns > max_columns || command.rows < 1 || command.rows > max_rows)
        throw refusal(fmt::format("a grid of {} by {} plots cannot be shown", command.columns, command.rows),
                      fmt::format("there can be up to {} columns and {} rows", max_columns, max_rows));
    columns_ = command.columns;
    rows_ = command.rows;
    fill();
    ++revision_;
}

void Plots::perform(const command::PlotView& command) {
    Plot& plot = at(command.plot);
    ViewDescription view = view_of("", command.x, command.y);
    const auto choice = std::find_if(choices_.begin(), choices_.end(),
                                     [&](const ViewDescription& c) { return same_expressions(c, view); });
    view.name = choice != choices_.end() ? choice->name : name_of(view);
    const Framing::Limits time = plot.framing.x;
    const bool was_over_time = plot.over_time();
    plot = or_refuse<command::PlotView>([&] { return prepared(view); });
    if (was_over_time && plot.over_time() && linked_) plot.framing.x = time;
    ++revision_;
}

void Plots::perform(const command::Zoom& command) {
    const Framing before = at(command.plot).framing;
    perform(command::SetRange{command.plot, false, command.y_low, command.y_high});
    try {
        perform(command::SetRange{command.plot, true, command.x_low, command.x_high});
    } catch (const InputError&) {
        at(command.plot).framing = before;
        throw;
    }
}

void Plots::perform(const command::SetRange& command) {
    Plot& plot = at(command.plot);
    if (!(command.low < command.high) || !std::isfinite(command.high - command.low))
        throw refusal(fmt::format("an axis cannot go from {} to {}", command.low, command.high));
    (command.is_x ? plot.framing.x : plot.framing.y) = {command.low, command.high};
    if (command.is_x && linked_ && plot.over_time())
        for (Plot& other : list_)
            if (other.over_time()) other.framing.x = plot.framing.x;
    ++revision_;
}

void Plots::perform(const command::Fit& command) {
    Plot& plot = at(command.plot);
    plot.framing.x.reset();
    plot.framing.y.reset();
    if (linked_ && plot.over_time())
        for (Plot& other : list_)
            if (other.over_time()) other.framing.x.reset();
    ++revision_;
}

void Plots::perform(const command::AxisScale& command) {
    Framing& framing = at(command.plot).framing;
    (command.is_x ? framing.log_x : framing.log_y) = command.logarithmic;
    (command.is_x ? framing.x : framing.y).reset();
    ++revision_;
}

void Plots::perform(const command::ShowCurve& command) {
    Plot& plot = at(command.plot);
    if (command.curve < 1 || static_cast<std::size_t>(command.curve) > plot.view.y.size())
        throw refusal(fmt::format("plot {} has no curve {}", command.plot, command.curve));
    const auto curve = static_cast<std::size_t>(command.curve - 1);
    if (command.shown)
        plot.framing.hidden.erase(curve);
    else
        plot.framing.hidden.insert(curve);
    ++revision_;
}

void Plots::perform(const command::PlotDifference& command) {
    Framing& framing = at(command.plot).framing;
    if (framing.difference == command.on) return;
    framing.difference = command.on;
    framing.x.reset();
    framing.y.reset();
    ++revision_;
}

void Plots::perform(const command::Link& command) {
    linked_ = command.on;
    ++revision_;
}

std::vector<Panel> Plots::compose(const Trajectory& trajectory, std::span<const Sample> samples, const Theme& theme,
                                  std::optional<double> horizon, const std::optional<Resolution>& page,
                                  bool is_coarse) const {
    std::vector<Panel> panels;
    for (const Plot& plot : list_) {
        Framing framing = plot.framing;
        // Axis settings of the quantities do not apply to their differences.
        if (framing.difference) framing.x.reset(), framing.y.reset();
        framing.legend = false;
        framing.for_print = page.has_value();
        // On a large screen the grid is about as wide as a page; each plot gets its part of it.
        framing.size.width /= std::sqrt(columns_);
        framing.size.height /= std::sqrt(rows_);
        framing.is_coarse = is_coarse;
        if (page) framing.size = *page;
        panels.push_back(achilles::compose(trajectory, samples, *plot.prepared, theme, framing, horizon));
        if (!page) panels.back().title.clear();
    }
    return panels;
}

Panel with_pinned(Panel panel, std::span<const PinnedPanel> pinned, const Framing& framing, const Theme& theme) {
    if (pinned.empty()) return panel;
    constexpr double gap = std::numeric_limits<double>::quiet_NaN();
    if (panel.curves.size() == panel.courses)
        for (std::vector<Curve>* const curves : {&panel.curves, &panel.beyond.curves})
            for (Curve& curve : *curves) {
                const std::uint8_t alpha = curve.stroke.color.a;
                curve.stroke.color = theme.ink;
                curve.stroke.color.a = alpha;
            }
    std::vector<Curve> under;
    std::array<double, 2> x{panel.x.low, panel.x.high}, y{panel.y.low, panel.y.high};
    for (std::size_t i = 0; i < pinned.size(); ++i) {
        const Panel& other = *pinned[i].panel;
        for (Curve curve : other.curves) {
            curve.label.clear();
            curve.stroke = pinned_stroke(theme, curve.stroke, pinned[i].place);
            under.push_back(std::move(curve));
        }
        for (Curve curve : other.beyond.curves) {
            const std::uint8_t alpha = curve.stroke.color.a;
            curve.stroke = pinned_stroke(theme, curve.stroke, pinned[i].place);
            curve.stroke.color.a = alpha;
            panel.beyond.curves.push_back(std::move(curve));
        }
        // Each boundary reaches only to the limits of its own panel: join both.
        if (!panel.boundary.points.empty() && !other.boundary.points.empty()) {
            panel.boundary.points.push_back({gap, gap});
            panel.boundary.points.insert(panel.boundary.points.end(), other.boundary.points.begin(),
                                         other.boundary.points.end());
        }
        x = {std::min(x[0], other.x.low), std::max(x[1], other.x.high)};
        y = {std::min(y[0], other.y.low), std::max(y[1], other.y.high)};
    }
    panel.curves.insert(panel.curves.begin(), under.begin(), under.end());
    if (!framing.x) set_ticks(panel.x, x[0], x[1], 0.0);
    if (!framing.y) set_ticks(panel.y, y[0], y[1], 0.0);
    return panel;
}

namespace {

// Applies each step as it records it, to know what is still missing.
struct Steps {
    explicit Steps(Plots from) : now(std::move(from)) {}
    template <class Kind>
    void take(const Kind& step) {
        now.perform(step);
        all.emplace_back(step);
    }
    Plots now;
    std::vector<Command> all;
};

void frame_as(const Plot& wanted, std::size_t at, Steps& steps) {
    const int number = static_cast<int>(at) + 1;
    const auto framing = [&]() -> const Framing& { return steps.now.list()[at].framing; };
    const Framing& goal = wanted.framing;
    if (framing().difference != goal.difference) steps.take(command::PlotDifference{number, goal.difference});
    if (framing().log_x != goal.log_x) steps.take(command::AxisScale{number, true, goal.log_x});
    if (framing().log_y != goal.log_y) steps.take(command::AxisScale{number, false, goal.log_y});
    if ((framing().x && !goal.x) || (framing().y && !goal.y)) steps.take(command::Fit{number});
    const bool x = goal.x && goal.x != framing().x, y = goal.y && goal.y != framing().y;
    if (x && y)
        steps.take(command::Zoom{number, (*goal.x)[0], (*goal.x)[1], (*goal.y)[0], (*goal.y)[1]});
    else if (x || y)
        steps.take(command::SetRange{number, x, (*(x ? goal.x : goal.y))[0], (*(x ? goal.x : goal.y))[1]});
    for (std::size_t curve = 0; curve < wanted.view.y.size(); ++curve)
        if (const bool hidden = goal.hidden.contains(curve); hidden != framing().hidden.contains(curve))
            steps.take(command::ShowCurve{number, static_cast<int>(curve) + 1, !hidden});
}

std::vector<Command> steps_between(const Plots& from, const Plots& plots, bool always_grid, bool one_by_one) {
    Steps steps(from);
    if (always_grid || steps.now.columns() != plots.columns() || steps.now.rows() != plots.rows())
        steps.take(command::SetGrid{plots.columns(), plots.rows()});
    for (std::size_t i = 0; i < plots.list().size(); ++i) {
        const ViewDescription& view = plots.list()[i].view;
        if (same_expressions(view, steps.now.list()[i].view)) continue;
        command::PlotView step{static_cast<int>(i) + 1, view.x.text, {}};
        for (const Text& y : view.y) step.y.push_back(y.text);
        steps.take(step);
    }
    if (steps.now.linked() && (one_by_one || !plots.linked())) steps.take(command::Link{false});
    for (std::size_t i = 0; i < plots.list().size(); ++i) frame_as(plots.list()[i], i, steps);
    if (steps.now.linked() != plots.linked()) steps.take(command::Link{plots.linked()});
    const bool done = std::equal(plots.list().begin(), plots.list().end(), steps.now.list().begin(),
                                 [](const Plot& a, const Plot& b) { return a.framing == b.framing; });
    // Time axes that were not always linked need separate commands for each axis.
    return done || one_by_one ? steps.all : steps_between(from, plots, always_grid, true);
}

}  // namespace

std::vector<Command> steps_to(const Plots& plots, bool always_grid) {
    return steps_between(Plots(plots.model()), plots, always_grid, false);
}

std::vector<Command> steps_between(const Plots& from, const Plots& to) { return steps_between(from, to, false, false); }

std::string to_text(const Plots& plots) {
    std::string text =
        fmt::format("grid {} {}{}\n", plots.columns(), plots.rows(), plots.linked() ? "" : ", not linked");
    for (const Plot& plot : plots.list()) {
        text += fmt::format("plot {}: {}", plot.view.name, plot.view.x.text);
        for (const Text& y : plot.view.y) text += " | " + y.text;
        const Framing& framing = plot.framing;
        for (const auto& [name, limits] : {std::pair{"x", framing.x}, {"y", framing.y}})
            if (limits) text += fmt::format(", {} {:.9g} to {:.9g}", name, (*limits)[0], (*limits)[1]);
        if (framing.difference) text += ", difference";
        if (framing.log_x) text += ", log x";
        if (framing.log_y) text += ", log y";
        for (const std::size_t curve : framing.hidden) text += fmt::format(", without {}", curve + 1);
        text += "\n";
    }
    return text;
}

}  // namespace achilles
