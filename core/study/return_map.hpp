// The map from a start over one period, as Newton's method asks for it (theory-derivatives.md 9): where the run comes back to, and
// how that depends on the start, the period and the parameters. The start is in a flight, so that every direction has a
// derivative; that two of them are forgotten at a Zeno point makes no difference to the equations.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "depend/derivatives.hpp"
#include "model/model.hpp"
#include "system/description.hpp"

namespace achilles {

struct Closing;
struct OrbitWatch;

// Why there is no periodic run: a sentence for a person.
struct NoOrbit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A start, and how long its period is taken to be.
struct Lap {
    Eigen::VectorXd x;  // q, v
    double start_time = 0.0, period = 0.0;
    std::vector<double> parameters;
};

// A run over one period.
struct Shot {
    Trajectory run;
    Eigen::VectorXd defect;  // x(T) - x(0) - shift
    Eigen::MatrixXd M;       // of x(T) by x(0): the monodromy where the defect is 0
    Eigen::MatrixXd P;       // of x(T) - shift by the parameters, T fixed
    Eigen::VectorXd F0, F1;  // dx/dt at the start and at the end
    Derivatives derivatives;
    std::uint64_t word = 0;  // of its events (study/measures.hpp)
};

class ReturnMap {
 public:
    // Throws InputError for a closing that is none, also where the system has a drive and no period is given.
    // What is watched outlives it.
    ReturnMap(std::shared_ptr<const Model> model, const Run& run, const Closing& closing, OrbitWatch* watch = nullptr);

    const std::shared_ptr<const Model>& model() const { return model_; }
    const Run& run() const { return run_; }
    Eigen::Index dof() const { return model_->dof(); }
    bool is_driven() const { return !model_->equations().autonomous; }
    // What the closing says at these parameters, and its derivatives by them; a period of 0: nothing.
    struct Value {
        double value = 0.0;
        Eigen::RowVectorXd slope;
    };
    Value period(const std::vector<double>& parameters) const { return value(0, parameters); }
    Value shift(std::size_t coordinate, const std::vector<double>& parameters) const {
        return value(1 + coordinate, parameters);
    }

    // Throws NoOrbit where the run stops early, starts in contact, or has no derivative. By all parameters, or by one alone.
    Shot shoot(const Lap& lap, std::optional<std::size_t> parameter = {}) const;
    // The run alone. Throws NoOrbit where it cannot start, or nobody waits any more.
    Trajectory run_of(const Lap& lap, double length) const;
    Eigen::VectorXd rate(const std::vector<double>& parameters, const State& state, Mode mode) const;

 private:
    Value value(std::size_t output, const std::vector<double>& parameters) const;
    void check_repeats() const;

    std::shared_ptr<const Model> model_;
    Run run_;
    Program closing_;  // the period, then the shift by coordinate
    OrbitWatch* watch_;
};

// A lap that closes.
struct ClosedLap {
    Lap lap;
    Shot shot;
    int iterations = 0;
    double error = 0.0;       // the last step, scaled
    Eigen::VectorXd tangent;  // of the branch, scaled, of length 1
};

class Newton {
 public:
    // `scale`: of x, T, and the parameter.
    Newton(const ReturnMap& map, Eigen::VectorXd scale, std::size_t parameter)
        : map_(map), scale_(std::move(scale)), parameter_(parameter) {}
    // Throws NoOrbit. `normal`, `predicted`: a plane in scaled (x, T, p) that the lap lies in; without them the parameter stands.
    // `before`: the tangent of which the new one keeps the sense; else the parameter grows along it.
    ClosedLap close(Lap lap, const Eigen::VectorXd& normal = {}, const Eigen::VectorXd& predicted = {},
                    const Eigen::VectorXd& before = {}, int most = 40) const;
    Eigen::VectorXd scaled(const Lap& lap) const;
    Lap lap_at(const Lap& like, const Eigen::VectorXd& scaled) const;
    const Eigen::VectorXd& scale() const { return scale_; }

 private:
    Eigen::MatrixXd matrix(const Shot& shot, const Lap& lap, const Eigen::VectorXd& F_ref,
                           const Eigen::VectorXd& normal) const;
    const ReturnMap& map_;
    Eigen::VectorXd scale_;
    std::size_t parameter_;
};

// Where a search for a periodic run begins, and where a lap of one may begin as well.

// Where to begin, once the run has gone on for so many periods: in a flight; of which period, if that is not known, from one
// release to that which is most like it, or from where the run comes back to most nearly. Throws NoOrbit.
Lap guess_of(const ReturnMap& map, int periods = 0);
// Lengths that the state, the period and a parameter are measured by along such a run.
Eigen::VectorXd scale_of(const ReturnMap& map, const Lap& lap, double of_parameter);

// A lap that closes as many periods earlier, as far as the start time.
Lap earlier(const ReturnMap& map, Lap lap);
// A lap that closes from the middle of its flight, or where that is too short of the longest; or past a release, where there is one.
Lap rebased(const ReturnMap& map, const Lap& lap, bool past_a_release = false);

}  // namespace achilles
