// The derivatives of a smooth motion after a time by its initial state, its start time and the parameters.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "sensitivity/gradient.hpp"
#include "series/series_over.hpp"

namespace achilles {

class FlowSensitivity {
 public:
    virtual ~FlowSensitivity() = default;

    // Expands values and derivatives at a state, at least to this order. Orders are added until, after `length` (s),
    // the last term is below the tolerance and the one before nearly. Returns the length for which this holds, which
    // may be shorter.
    virtual double expand(const State& state, double length, int min_order) = 0;
    // Order of the last expansion.
    virtual int order() const = 0;
    // Coefficient k of q and v, then of the gap of each open contact (from k = 2 on).
    virtual double coefficient(int k, std::size_t i) const = 0;
    // Sets the rows of q, v, and of the open contacts' h and u after a time; other rows are unchanged.
    virtual void slope_after(double span, Mode mode, RowMatrix& S) = 0;
};

// Computes derivatives from the Taylor series of the motion with its variational equation (theory-derivatives.md 2).
// `varied` marks the parameters that may vary; if it is empty, all may.
std::unique_ptr<FlowSensitivity> make_flow_slope(const Model& model, Mode mode, const TangentLayout& tangent,
                                                 std::span<const double> parameters, const std::vector<bool>& varied,
                                                 double tolerance);

// The Taylor coefficients of one mode at a state, to any order: the series of the run's steps, and the terms that these
// omit. Rows: q and v, then each contact's event function, its gap if it is open, hddot if it is held.
class MotionSeries : public SeriesOver<double> {
 public:
    // The series of this mode.
    MotionSeries(const Model& model, Mode mode, std::span<const double> parameters);

    // Expands at a state; 1 <= order <= highest_order.
    void expand(const State& state, int order);
    // The highest order up to which all coefficients are finite. The terms of a series may overflow even if the
    // function does not, as for cosh(x)^2.
    int finite_order() const;
    // The sum of the terms of orders first .. last after a time.
    double sum(int first, int last, std::size_t i, double span) const;

 private:
    std::vector<double> start_;  // q and v of the last expansion
    int order_ = 0;              // its order
};

// Derivatives accurate to a few digits, from differences of series that start nearby. They use the machine code of
// runs, at a fraction of the cost of accurate derivatives. Columns of parameters are 0.
class FlowDifference : public FlowSensitivity {
 public:
    FlowDifference(const Model& model, Mode mode, const TangentLayout& tangent, std::span<const double> parameters);

    double expand(const State& state, double length, int min_order) override;
    int order() const override { return order_; }
    // Coefficients of the motion itself, not of a neighboring one.
    double coefficient(int k, std::size_t i) const override { return motion_.coefficient(k, i); }
    void slope_after(double span, Mode mode, RowMatrix& S) override;

    // The part of q and v after a time that polynomials of this degree omit, from the state of the last expansion on.
    // It is the sum of the following terms. If these fall too slowly, it is the difference from two steps of half the
    // length; if that is not enough, from as many shorter steps as needed. NaN if these do not succeed.
    void left_out(int degree, double span, RowMatrix& delta);
    static constexpr int more_orders = 8;  // orders beyond `degree` to which the motion must be expanded

 private:
    // The motion from a start that differs in one coordinate.
    struct NearbyMotion {
        Eigen::Index column;  // the coordinate: an entry of q or v, or t
        double distance;      // its change, in its unit
        MotionSeries motion;
    };
    // Expands the neighboring motions, each with one coordinate x of this state changed by about 2^-20 (1 + |x|).
    void expand_nearby(const State& state);
    bool by_halves(int degree, double span, RowMatrix& delta);
    void by_parts(int degree, double span, RowMatrix& delta);
    double open_terms(const MotionSeries& motion, double span) const;
    static double reach(const MotionSeries& motion, int order, std::size_t rows, double size);
    double last_terms(double length) const;
    int finite_order() const;
    // Difference quotient of coefficient k.
    double slope(const NearbyMotion& nearby, int k, std::size_t i) const {
        return (nearby.motion.coefficient(k, i) - motion_.coefficient(k, i)) / nearby.distance;
    }

    TangentLayout tangent_;
    MotionSeries motion_, part_;
    State state_;  // of the last expansion
    std::vector<NearbyMotion> nearby_motions_;
    int order_ = 0;        // of the motion
    int slope_order_ = 6;  // of the neighboring motions; at least that of the step before minus 1
};

}  // namespace achilles
