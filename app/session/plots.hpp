// The plots of the explorer: a grid of views with their axes. A plain value, independent of any run.
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
    // Starts with the file's views, as many as fit a grid of four; the others are offered as choices.
    explicit Plots(std::shared_ptr<const Model> model);
    // The same selection for an edited text of the system. Views with names that no longer exist are dropped.
    Plots carried_over(const std::shared_ptr<const Model>& model) const;

    // Plot `number` (from 1) alone. Throws InputError if there is no such plot.
    Plots only(int number) const;

    const std::vector<Plot>& list() const { return list_; }  // row by row, columns() * rows() plots
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    bool linked() const { return linked_; }  // plots over time share one time axis
    // The file's views, then generic ones: gap, contact force, energy, and enough others to fill the largest grid.
    const std::vector<ViewDescription>& choices() const { return choices_; }

    // Each applies a command and increments revision(). Throws InputError and changes nothing if the command is
    // invalid.
    void perform(const command::SetGrid& command);
    void perform(const command::PlotView& command);
    void perform(const command::Zoom& command);
    void perform(const command::SetRange& command);
    void perform(const command::Fit& command);
    void perform(const command::AxisScale& command);
    void perform(const command::ShowCurve& command);
    void perform(const command::Link& command);
    void perform(const command::PlotDifference& command);

    // Builds the panels of one run from `samples`, which are plot_samples() of the whole run. On the screen, titles and
    // legends are widgets beside the panels. In print, `page` is the picture size: titles and legends are in the
    // panels, and curves are sampled for that size. Curves are pale after `horizon`, where the estimated error is too
    // large. Coarse curves go straight through some samples.
    std::vector<Panel> compose(const Trajectory& trajectory, std::span<const Sample> samples, const Theme& theme,
                               std::optional<double> horizon = {}, const std::optional<Resolution>& page = {},
                               bool is_coarse = false) const;
    int revision() const { return revision_; }
    const std::shared_ptr<const Model>& model() const { return model_; }
    // True if both show the same, regardless of their histories.
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

// A plot of a pinned run, with the name and place of the run.
struct PinnedPanel {
    const Panel* panel = nullptr;
    std::string name;
    int place = 1;
};
// Draws the curves of pinned runs below those of the current run, each in its own hue and wider, so that both are
// visible. A single current curve is then drawn in the ink color. Limits that are not set by the user cover all curves.
Panel with_pinned(Panel panel, std::span<const PinnedPanel> pinned, const Framing& framing, const Theme& theme);

// Commands that lead from the initial plots of the model to these. With `always_grid` the `grid` command is always
// included, otherwise only if the grid differs.
std::vector<Command> steps_to(const Plots& plots, bool always_grid = false);
// The same from other plots of the model.
std::vector<Command> steps_between(const Plots& from, const Plots& to);

// Text form of the plots, part of to_text(Session).
std::string to_text(const Plots& plots);

}  // namespace achilles
