// What moves on a run's page: the mechanism with its trail, and in every plot dots at the present values. It is drawn by
// the code of the films, and written as JSON for the player (player.js) and as CSS classes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "figure/axes.hpp"
#include "figure/compose.hpp"
#include "figure/keyframes.hpp"

namespace achilles {

class PlayerDrawings {
 public:
    // Keeps a reference to the trajectory.
    explicit PlayerDrawings(const Trajectory& trajectory);

    // Units of all pictures per pixel: coordinates are whole numbers.
    static constexpr double fineness = 10.0;
    // False if the system has no drawing.
    bool has_mechanism() const { return !mechanism_.is_empty(); }
    double width() const { return width_; }  // of the mechanism's picture, pixels
    double height() const { return height_; }
    // Adds a plot whose panel is drawn with the area inside its axes at `inner` (pixels).
    void add_plot(const ViewDescription& view, const Panel& panel, const Rectangle& inner);

    // The data of the player, and the classes of its shapes. Drawings are within `tolerance` (pixels) of the run; of a long
    // run that would need a larger page, they are less exact.
    struct Written {
        std::string json, css;
        double tolerance = 0.0;
    };
    Written write();

 private:
    struct PlotDots {
        PreparedView view;
        Values values;
        PanelMap map;
        Rectangle inner;
        PlotDots(const Trajectory& trajectory, const ViewDescription& description, const Panel& panel,
                 const Rectangle& area)
            : view(*trajectory.model, description), values(view, trajectory), map(panel, area), inner(area) {}
    };
    std::vector<PictureShape> shapes_at(const Sample& now, const Theme& theme);
    void add_dots(std::vector<PictureShape>& shapes, std::size_t plot, const Sample& now, const Theme& theme);
    DrawnShape on_page(DrawnShape shape) const;
    std::string written(const std::vector<MotionClip>& clips);
    std::string written(const MotionClip& clip);
    std::string written_trail();
    std::string look(const DrawnShape& light, const DrawnShape& dark);
    std::size_t shape_number(const std::string& json, std::size_t copy);

    const Trajectory& trajectory_;
    std::vector<Sample> samples_;
    Mechanism mechanism_;
    MechanismScene stage_;
    double width_ = 1000.0, height_ = 0.0;
    Drawing seen_;
    Point origin_;  // of the world, in units of the picture
    double unit_ = 1.0;
    std::vector<std::unique_ptr<PlotDots>> plots_;
    std::map<std::pair<std::string, std::size_t>, std::size_t> shapes_;  // number of a shape by its JSON
    std::vector<std::string> shape_list_;
    std::map<std::string, std::size_t> looks_;  // number of a class by its rules
    std::string light_, dark_;                  // the rules
};

// A string of JSON that may stand in a <script>.
std::string json_text(std::string_view text);

}  // namespace achilles
