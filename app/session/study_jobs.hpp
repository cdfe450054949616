// Studies of the current run that take longer than a frame, each on its own thread: sensitivities, proof, sweep,
// periodic orbit.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/orbit.hpp"
#include "analysis/table.hpp"
#include "figure/proof.hpp"
#include "sensitivity/quantities.hpp"
#include "session/command.hpp"
#include "session/worker.hpp"

namespace achilles {

// Sensitivities of a quantity.

// True if a slider over this range has a logarithmic scale.
bool has_log_scale(double low, double high);

// A quantity of one run and its derivatives with respect to all parameters and initial values, in the file's units.
struct Sensitivities {
    std::shared_ptr<const Trajectory> run;
    Quantity quantity;
    std::string unit;  // unit of the quantity; "" if unknown
    struct Sensitivity {
        std::string name;         // of a parameter, or of the initial coordinate x or rate x'
        double derivative = 0.0;  // of the quantity; NaN if it does not exist
        // Linear estimate of the change of the quantity over the whole slider range. For a logarithmic slider the
        // derivative is that with respect to the logarithm.
        double change_over_slider = 0.0;
        std::string reason;  // why there is no derivative; else empty
    };
    std::vector<Sensitivity> all;  // in the order of the sliders

    const Sensitivity* find(const std::string& name) const;
    // The largest |change_over_slider|; 0 if no derivative exists.
    double largest() const;
};

// Throws InputError if the expression is invalid, or if the run has no derivatives at all.
Sensitivities sensitivities_of(const std::string& quantity, const std::shared_ptr<const Trajectory>& run);
// The initial choice: the last Zeno time or, without one, the final value of the first coordinate.
std::string default_quantity(const Trajectory& run);

// Tangent to the curve of a sweep at the current run.
struct TangentLine {
    double x = 0.0, y = 0.0, slope = 0.0;  // dy/dx, in the file's units
    bool logarithmic = false;              // the line is straight over ln x
    double at(double other_x) const;
};

class SensitivitiesJob {
 public:
    // Sets what to compute. Returns true if the request differs from the last one. Work under way is finished first, so
    // that results still appear while a slider is being dragged.
    bool ask(const std::shared_ptr<const Trajectory>& run, const std::string& quantity);
    void forget();
    // Receives a finished result and starts the pending request. Without a timeout: waits until that is finished, too.
    void update(Timeout patience);
    // `ready` is called on another thread when update() would receive a result.
    void on_ready(std::function<void()> ready) { job_.on_ready(std::move(ready)); }

    // The last result: for the quantity requested last, but possibly for an earlier run. Null: none yet.
    const Sensitivities* sensitivities() const { return job_.result().get(); }
    bool is_busy() const { return running_.has_value(); }
    const std::string& problem() const { return problem_; }  // why there is no result; else empty

 private:
    struct SensitivityRequest {
        std::shared_ptr<const Trajectory> run;
        std::string quantity;
        friend bool operator==(const SensitivityRequest&, const SensitivityRequest&) = default;
    };
    void begin();
    std::optional<SensitivityRequest> requested_, running_;  // the last request, and the one under way
    std::string problem_;
    Job<Sensitivities> job_;
};

// A proof of a whole run.
class ProofJob : public Job<Proof, ProofMonitor> {
 public:
    // Starts a proof for a run of this model and drops the last one. update() throws InputError if proofs do not cover
    // the system.
    void begin(const std::shared_ptr<const Model>& model, const InitialUncertainty& spread,
               const EnclosureProblem& claim);
    // The model of the last proof; null before the first.
    const std::shared_ptr<const Model>& model() const { return model_; }

 private:
    std::shared_ptr<const Model> model_;
};

// The command that requests a proof with this spread.
command::Prove prove_command(const InitialUncertainty& spread);

// True if a proof for run `a` also holds for run `b`: integration options do not matter.
bool same_to_a_proof(const Run& a, const Run& b);

// The sweep of the window, computed from coarse to fine and repeated after changes.

// The sweep with increasing numbers of points; the first gives the first picture, the last is `sweep` itself. A section
// of a single run uses increasing run lengths instead.
std::vector<SweepSpec> coarse_to_fine(const SweepSpec& sweep);

class SweepJob {
 public:
    // Sets the sweep of this model to compute; empty: stop. Work and data of the same sweep are kept; the base's values
    // of the swept inputs are ignored in this comparison.
    void ask(const std::shared_ptr<const Model>& model, std::optional<SweepSpec> sweep);
    // Stops the work under way, since nobody sees its result. Finished data are kept.
    void pause();
    // Receives a finished level and starts the next finer one. Without a timeout: waits for the finest.
    void update(Timeout patience);
    // `ready` is called on another thread when update() would receive a result.
    void on_ready(std::function<void()> ready) { job_.on_ready(std::move(ready)); }

    // Null: no data yet. While a new sweep is computed: the data of the previous one, if its columns are the same.
    const std::shared_ptr<const SweepData>& data() const { return job_.result(); }
    bool is_busy() const { return next_ < levels_.size(); }
    // True if the data, even if coarse, belong to the sweep requested last.
    bool is_current() const { return is_current_; }
    double share() const;                                    // finished fraction of the work
    const std::string& problem() const { return problem_; }  // why the sweep failed; empty: it did not

 private:
    void begin();  // the next level
    std::shared_ptr<const Model> model_;
    std::optional<SweepSpec> sweep_;
    std::vector<SweepSpec> levels_;
    std::size_t next_ = 0;  // the level under way
    bool is_current_ = false;
    std::string problem_;
    Job<SweepData> job_;
};

// The search for a periodic orbit and its branch, on its own thread.

// The result of an orbit search, and its request.
struct OrbitJobResult {
    std::string text;  // arguments of the command
    Run base;          // the run it started from
    OrbitResult answer;

    // The points to browse: those of the branch or, without one, the orbit alone. Empty: none found.
    std::size_t count() const { return answer.branch ? answer.branch->points.size() : answer.orbit ? 1 : 0; }
    const OrbitPoint& point(std::size_t i) const { return answer.branch ? answer.branch->points[i] : *answer.orbit; }
    // Index of the point that the search found, from which the branch was followed.
    std::size_t first() const;
};

// A copy of `run` that starts on this periodic orbit, has its parameters, and lasts at least one period.
Run run_on(const OrbitPoint& point, Run run);

class OrbitJob : public Job<OrbitJobResult, OrbitMonitor> {
 public:
    // Starts a search. Drops the last result and stops a search under way.
    void begin(const std::shared_ptr<const Model>& model, const std::string& text, const Run& base,
               OrbitRequest question);
};

}  // namespace achilles
