// On what a quantity of a run depends: its derivatives as a person compares them, and a thread of its own that makes them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depend/quantities.hpp"
#include "session/worker.hpp"

namespace achilles {

// Whether a slider over this range goes by ratios, not by differences.
bool goes_by_ratios(double low, double high);

// A quantity of one run and what each parameter and start does to it, all in the file's units.
struct Influences {
    std::shared_ptr<const Trajectory> run;
    Quantity quantity;
    std::string unit;  // of the quantity; "" where it is not known
    struct Of {
        std::string name;         // of the parameter, of the coordinate x or the rate x' at the start
        double derivative = 0.0;  // of the quantity by it; not a number where there is none
        // What the quantity would change by from one end of its slider to the other, at the slope of the derivative; along a
        // slider that goes by ratios at the slope over its track.
        double over_slider = 0.0;
        std::string reason;  // why there is none; else empty
    };
    std::vector<Of> all;  // as their sliders stand below one another

    const Of* find(const std::string& name) const;
    // The largest of |over_slider|; 0 where there is no derivative.
    double largest() const;
};

// Throws InputError for an expression that is none, and for a run that has no derivatives at all.
Influences influences_on(const std::string& quantity, const std::shared_ptr<const Trajectory>& run);
// What is asked of a run at first: its last Zeno time or, where it has none, where its first coordinate ends.
std::string default_quantity(const Trajectory& run);

// A line that touches the curve of a sweep where the present run is.
struct TangentLine {
    double x = 0.0, y = 0.0, slope = 0.0;  // dy/dx, in the file's units
    bool logarithmic = false;              // the axis of x: it is a line over ln x
    double at(double other_x) const;
};

class InfluencesJob {
 public:
    // What is to be known; true where that is something else than before. What is under way is finished first, so that a hand
    // that never rests sees something.
    bool ask(const std::shared_ptr<const Trajectory>& run, const std::string& quantity);
    void forget();
    // Takes in what is ready and begins what was asked for meanwhile. Without patience: until that is there.
    void update(Patience patience);
    // Called on another thread when update() would take something in.
    void on_ready(std::function<void()> ready) { worker_.on_ready(std::move(ready)); }

    // The last that are known: of the quantity that was asked for last, but maybe of a run before. Null: there are none yet.
    const Influences* influences() const { return made_.get(); }
    bool is_busy() const { return begun_.has_value(); }
    const std::string& problem() const { return problem_; }  // why there are none; else empty

 private:
    struct Asked {
        std::shared_ptr<const Trajectory> run;
        std::string quantity;
        friend bool operator==(const Asked&, const Asked&) = default;
    };
    void begin();
    std::optional<Asked> asked_, begun_;  // last; and what is under way
    std::shared_ptr<const Influences> made_;
    std::string problem_;
    Worker<std::shared_ptr<const Influences>> worker_;
};

}  // namespace achilles
