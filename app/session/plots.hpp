// The plots of the explorer: a grid of views, and how each is looked at. A value: it knows no run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "figure/compose.hpp"
#include "session/command.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

struct Plot {
    ViewDescription view;
    std::shared_ptr<const PreparedView> prepared;
    Framing framing;
    bool over_time() const { return prepared->quantities()[0].is_time || framing.difference; }
};

class Plots {
 public:
    // As many of the file's views as a grid of four holds, the rest to choose from.
    explicit Plots(std::shared_ptr<const Model> model);
    // The same choice for another text of the system, as far as its expressions mean something there.
    Plots carried_over(const std::shared_ptr<const Model>& model) const;

    // One of them, from 1, alone. Throws InputError if there is none of this number.
    Plots only(int number) const;

    const std::vector<Plot>& list() const { return list_; }  // row by row: columns() * rows() of them
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    bool linked() const { return linked_; }  // plots over time show the same time
    // The file's views, then those that any system has: gap, contact force, energy, and enough others to fill a large grid.
    const std::vector<ViewDescription>& choices() const { return choices_; }

    // Each throws InputError and changes nothing where it makes no sense. Returns nothing; counts revision() up.
    void perform(const command::Grid& command);
    void perform(const command::PlotView& command);
    void perform(const command::Zoom& command);
    void perform(const command::Range& command);
    void perform(const command::Fit& command);
    void perform(const command::AxisScale& command);
    void perform(const command::ShowCurve& command);
    void perform(const command::Link& command);
    void perform(const command::PlotDifference& command);

    // The panels of one run; `samples` are plot_samples() of the whole. On the screen titles and legends are widgets beside the
    // panels. In print, where `page` is the size of the picture, they are in the panels, and curves are as fine as that size
    // needs. Pale after the horizon of the run, where that comes before its end.
    std::vector<Panel> compose(const Trajectory& trajectory, std::span<const Sample> samples, const Theme& theme,
                               std::optional<double> horizon = {}, const std::optional<Resolution>& page = {}) const;
    int revision() const { return revision_; }
    const std::shared_ptr<const Model>& model() const { return model_; }
    // Whether they show the same, whatever led there.
    friend bool operator==(const Plots& a, const Plots& b);

 private:
    Plot& at(int number);
    Plot prepared(const ViewDescription& view) const;
    void offer(const ViewDescription& view);
    void fill();

    std::shared_ptr<const Model> model_;
    std::vector<ViewDescription> choices_;
    std::vector<Plot> list_;
    int columns_ = 1, rows_ = 1, revision_ = 0;
    bool linked_ = true;
};

// A plot of a pinned run, its name and its place.
struct PinnedPanel {
    const Panel* panel = nullptr;
    std::string name;
    int place = 1;
};
// A plot with the curves of pinned runs under the present one's, each in its hue and wide enough to be seen beside what lies
// over it; then a single present curve is in ink. Where nothing else is asked for the limits hold all.
Panel with_pinned(Panel panel, std::span<const PinnedPanel> pinned, const Framing& framing, const Theme& theme);

// What leads to these plots from those that their model begins with; `grid` always, or only where it is another.
std::vector<Command> steps_to(const Plots& plots, bool always_grid = false);

// The plots as text, for the session's.
std::string to_text(const Plots& plots);

}  // namespace achilles
