// The return map over one period and its derivatives, for Newton's method (theory-derivatives.md 9): the state to which
// a run returns, as a function of its start, period and parameters. The start is in a flight, so that every direction
// has a derivative. The equations are not affected by the two dimensions that a Zeno point forgets. If the run never
// leaves contact, as of a walker, the start is in contact, and its changes are those along the surfaces.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "sensitivity/derivatives.hpp"
#include "system/description.hpp"

namespace achilles {

struct ReturnCondition;
struct OrbitMonitor;

// No periodic orbit was found; the reason is a sentence.
struct OrbitNotFound : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Where a period may start: no contact is closed and no joint sticks, so that all directions have derivatives.
inline bool is_flight(Mode mode) { return mode.is_free() && mode.elements_in(ContactState::held).empty(); }

// Unknowns of the shooting method: initial state, period, parameters.
struct ShootingPoint {
    Eigen::VectorXd x;  // q, v
    double start_time = 0.0, period = 0.0;
    std::vector<double> parameters;
    Mode mode;  // of the start
};

// A run over one period, with its derivatives.
struct ShootingResult {
    Trajectory run;
    Eigen::VectorXd defect;  // x(T) - x(0) - shift
    Eigen::VectorXd shift;   // of each coordinate; a free one is what the run gives
    Eigen::MatrixXd M;       // derivative of x(T) by x(0): the monodromy matrix if the defect is 0
    Eigen::MatrixXd P;       // derivative of x(T) - shift by the parameters, at fixed T
                             // In contact x(0) is projected onto the surfaces first.
    Eigen::VectorXd F0, F1;  // dx/dt at the start and at the end
    Derivatives derivatives;
    std::uint64_t event_signature = 0;  // signature of its events (analysis/measures.hpp)
};

class ReturnMap {
 public:
    // Throws InputError for an ill-posed return condition, for example a driven system without a period. `watch` must
    // outlive this object.
    ReturnMap(std::shared_ptr<const Model> model, const Run& run, const ReturnCondition& closing,
              OrbitMonitor* watch = nullptr);

    const std::shared_ptr<const Model>& model() const { return model_; }
    const Run& run() const { return run_; }
    Eigen::Index dof() const { return model_->dof(); }
    bool is_driven() const { return !model_->equations().autonomous; }
    // The value of an expression of the return condition at these parameters, and its derivatives by them. A period of
    // 0 means that none is given.
    struct Value {
        double value = 0.0;
        Eigen::RowVectorXd slope;
    };
    Value period(const std::vector<double>& parameters) const { return value(0, parameters); }
    Value shift(std::size_t coordinate, const std::vector<double>& parameters) const {
        return value(1 + coordinate, parameters);
    }
    // The coordinates on which nothing depends and whose shift is what the motion makes of it. Their start is kept.
    const std::vector<std::size_t>& free_coordinates() const { return free_; }
    bool is_free(Eigen::Index coordinate) const;
    // dx(T)/dx(0) - 1 for the equations of return: a row that keeps its start for each free coordinate.
    Eigen::MatrixXd return_matrix(const ShootingResult& shot) const;
    // Sets the rows of free coordinates to zero.
    Eigen::MatrixXd without_free(Eigen::MatrixXd rows) const;

    // Simulates one period and differentiates it by all parameters, or by only one. Throws OrbitNotFound if the run
    // stops early, starts or ends in another mode, or has no derivative.
    ShootingResult shoot(const ShootingPoint& lap, std::optional<std::size_t> parameter = {}) const;
    // The run without derivatives. Throws OrbitNotFound if it cannot start or the search was stopped.
    Trajectory run_of(const ShootingPoint& lap, double length) const;
    Eigen::VectorXd rate(const std::vector<double>& parameters, const State& state, Mode mode) const;
    // Moves a start onto the surfaces of the contacts that its mode holds, if it is in contact.
    void settle(ShootingPoint& lap) const;

 private:
    Value value(std::size_t output, const std::vector<double>& parameters) const;
    void check_repeats() const;
    void check_mode(const ShootingPoint& lap, Mode begins, Mode ends) const;
    Eigen::MatrixXd directions_at(const ShootingPoint& lap) const;

    std::shared_ptr<const Model> model_;
    Run run_;
    Program closing_;                // the period, then the shift by coordinate
    std::vector<std::size_t> free_;  // their shift in closing_ is 0
    OrbitMonitor* watch_;
};

// A converged orbit.
struct ConvergedOrbit {
    ShootingPoint lap;
    ShootingResult shot;
    int iterations = 0;
    double error = 0.0;       // the last step, scaled
    Eigen::VectorXd tangent;  // unit tangent of the branch, in scaled variables
};

class ShootingSolver {
 public:
    // `scale`: of x, T, and the parameter.
    ShootingSolver(const ReturnMap& map, Eigen::VectorXd scale, std::size_t parameter)
        : map_(map), scale_(std::move(scale)), parameter_(parameter) {}
    // Solves the return condition; throws OrbitNotFound if it does not converge. `normal` and `predicted` define a
    // plane in scaled (x, T, p) that contains the solution; without them the parameter is fixed. The new tangent has
    // the orientation of `before`; without it, the parameter increases along it.
    ConvergedOrbit close(ShootingPoint lap, const Eigen::VectorXd& normal = {}, const Eigen::VectorXd& predicted = {},
                         const Eigen::VectorXd& before = {}, int most = 40) const;
    Eigen::VectorXd scaled(const ShootingPoint& lap) const;
    ShootingPoint lap_at(const ShootingPoint& like, const Eigen::VectorXd& scaled) const;
    const Eigen::VectorXd& scale() const { return scale_; }

 private:
    Eigen::MatrixXd matrix(const ShootingResult& shot, const ShootingPoint& lap, const Eigen::VectorXd& F_ref,
                           const Eigen::VectorXd& normal) const;
    const ReturnMap& map_;
    Eigen::VectorXd scale_;
    std::size_t parameter_;
};

// ---- initial guesses ----

// An initial guess in a flight, after the run has continued for this many periods. If the period is unknown, it is
// estimated between the two most similar releases, or from the closest return to the start. Throws OrbitNotFound.
ShootingPoint guess_of(const ReturnMap& map, int periods = 0);
// Scales of the state, the period and a parameter along such a run.
Eigen::VectorXd scale_of(const ReturnMap& map, const ShootingPoint& lap, double of_parameter);

// The same orbit, started as many periods earlier as the start time allows.
ShootingPoint earlier(const ReturnMap& map, ShootingPoint lap);
// The same orbit, started in the middle of its flight, or of the longest one if that flight is too short. With
// past_a_release, it prefers a flight after a release.
ShootingPoint rebased(const ReturnMap& map, const ShootingPoint& lap, bool past_a_release = false);

}  // namespace achilles
