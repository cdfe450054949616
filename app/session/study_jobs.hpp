// What a window asks of the present run that takes longer than a frame, each on threads of its own: the derivatives of a
// quantity, a proof, a sweep, a periodic run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depend/quantities.hpp"
#include "figure/proof.hpp"
#include "session/command.hpp"
#include "session/worker.hpp"
#include "study/orbit.hpp"
#include "study/table.hpp"

namespace achilles {

// On what a quantity of a run depends: its derivatives as a person compares them.

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
    void on_ready(std::function<void()> ready) { job_.on_ready(std::move(ready)); }

    // The last that are known: of the quantity that was asked for last, but maybe of a run before. Null: there are none yet.
    const Influences* influences() const { return job_.result().get(); }
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
    std::string problem_;
    Job<Influences> job_;
};

// A proof of a whole run.
class ProofJob : public Job<Proof, ProofWatch> {
 public:
    // A proof of a run of this model. The last proof is forgotten. update() throws InputError for a system that no
    // proof covers.
    void begin(const std::shared_ptr<const Model>& model, const Spread& spread, const Claim& claim);
    // Of the last proof; null before the first.
    const std::shared_ptr<const Model>& model() const { return model_; }

 private:
    std::shared_ptr<const Model> model_;
};

// What a person writes for it.
command::Prove prove_command(const Spread& spread);

// Of two runs of a model whether what is proved of one is proved of the other: how they are computed means nothing to it.
bool same_to_a_proof(const Run& a, const Run& b);

// The runs of a sweep as a window wants them: coarse to fine, and anew when something changes.

// Its first picture comes from the first of these, which are the same sweep with fewer points; the last is the sweep. A
// section of one run alone is that of shorter and shorter runs.
std::vector<Sweep> coarse_to_fine(const Sweep& sweep);

class SweepJob {
 public:
    // What is to be computed of this model; nothing: no more. Goes on with what is under way, or is there, if it is the same: what
    // the base has in place of an axis does not matter.
    void ask(const std::shared_ptr<const Model>& model, std::optional<Sweep> sweep);
    // Takes in what is ready and begins what is finer. Without patience: until the finest is there.
    void update(Patience patience);
    // Called on another thread when update() would take something in.
    void on_ready(std::function<void()> ready) { job_.on_ready(std::move(ready)); }

    // Null: there is nothing to see yet. While it is made anew that of the sweep before it, if its columns are the same.
    const std::shared_ptr<const SweepData>& data() const { return job_.result(); }
    bool is_busy() const { return next_ < levels_.size(); }
    // Whether the data are those of what was asked last, be they coarse.
    bool is_current() const { return is_current_; }
    double share() const;                                    // of the work, that is done
    const std::string& problem() const { return problem_; }  // why it cannot be; empty: it can

 private:
    void begin();  // the next level
    std::shared_ptr<const Model> model_;
    std::optional<Sweep> sweep_;
    std::vector<Sweep> levels_;
    std::size_t next_ = 0;  // the level under way
    bool is_current_ = false;
    std::string problem_;
    Job<SweepData> job_;
};

// The search for a periodic run, and its branch, on a thread of their own.

// What was found, and how it was asked for.
struct FoundOrbit {
    std::string text;  // of the command
    Run base;          // of which that was asked
    OrbitAnswer answer;

    // What is told as one after the other: the points of the branch or, without one, the orbit alone. Empty: there is none.
    std::size_t count() const { return answer.branch ? answer.branch->points.size() : answer.orbit ? 1 : 0; }
    const OrbitPoint& point(std::size_t i) const { return answer.branch ? answer.branch->points[i] : *answer.orbit; }
    // Which of them the search had found, before a branch was followed.
    std::size_t first() const;
};

// `run` on this periodic run: its start and parameters; no shorter than a period.
Run run_on(const OrbitPoint& point, Run run);

class OrbitJob : public Job<FoundOrbit, OrbitWatch> {
 public:
    // The last orbit is forgotten, and a search under way stopped.
    void begin(const std::shared_ptr<const Model>& model, const std::string& text, const Run& base,
               OrbitQuestion question);
};

}  // namespace achilles
