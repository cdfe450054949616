// The derivatives of one smooth motion after a time by the state where it starts, the parameters and the start's time.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "depend/gradient.hpp"
#include "model/model.hpp"
#include "series/series_over.hpp"

namespace achilles {

class FlowSlope {
 public:
    virtual ~FlowSlope() = default;

    // Expands at a state to at least this order, and so far that of the sum after `length` (s), values and derivatives, the last
    // term is below the tolerance and the one before nearly; or after as much of it as is returned.
    virtual double expand(const State& state, double length, int least_order) = 0;
    // Of the last expansion.
    virtual int order() const = 0;
    // Coefficient k of q and v, then of the gap of each open contact (from k = 2 on).
    virtual double coefficient(int k, std::size_t i) const = 0;
    // The rows of q, v, and of the open contacts' h and u after a time, whatever the others are.
    virtual void slope_after(double span, Mode mode, RowMatrix& S) = 0;
};

// By the Taylor series of runs over numbers with their slopes (theory-derivatives.md 2). Of the motion that holds these
// contacts; by those parameters that may vary, or, if that is empty, by all.
std::unique_ptr<FlowSlope> make_flow_slope(const Model& model, Mode mode, const Tangent& tangent,
                                           std::span<const double> parameters, const std::vector<bool>& varied,
                                           double tolerance);

// The Taylor coefficients of one motion at a state, to any order: what a run's steps are made of, and the terms that they
// leave out. Rows: q and v, then each contact's event function, its gap where it is open, hddot where it is held.
class MotionSeries : public SeriesOver<double> {
 public:
    // Of the motion that holds these contacts.
    MotionSeries(const Model& model, Mode mode, std::span<const double> parameters);

    // Expands at a state; 1 <= order <= highest_order.
    void expand(const State& state, int order);
    // The highest order up to which all coefficients are numbers: a function may overflow, as cosh(x)^2 does, in the
    // terms of a series alone.
    int finite_order() const;
    // The sum of the terms of orders first .. last after a time.
    double sum(int first, int last, std::size_t i, double span) const;

 private:
    std::vector<double> start_;  // q and v of the last expansion
    int order_ = 0;              // and its order
};

// To a few digits: from the series of motions that start beside it, by the machine code of runs, which costs a fifth of
// numbers with their slopes. Columns of parameters are 0.
class FlowDifference : public FlowSlope {
 public:
    FlowDifference(const Model& model, Mode mode, const Tangent& tangent, std::span<const double> parameters);

    double expand(const State& state, double length, int least_order) override;
    int order() const override { return order_; }
    // Of the motion itself.
    double coefficient(int k, std::size_t i) const override { return motion_.coefficient(k, i); }
    void slope_after(double span, Mode mode, RowMatrix& S) override;

    // What polynomials of this degree leave out of q and v after a time, from the state of the last expansion on: the terms
    // that follow; where these fall too slowly, the difference to two steps of half the length; and where the series of
    // these does not reach so far either, to as many shorter ones as it takes. Not a number where those do not get there.
    void left_out(int degree, double span, RowMatrix& delta);
    static constexpr int more_orders = 8;  // to which it must have been expanded

 private:
    struct Beside {
        Eigen::Index column;
        double distance;
        MotionSeries motion;
    };
    void expand_beside(const State& state);
    bool by_halves(int degree, double span, RowMatrix& delta);
    void by_parts(int degree, double span, RowMatrix& delta);
    double open_terms(const MotionSeries& motion, double span) const;
    static double reach(const MotionSeries& motion, int order, std::size_t rows, double size);
    double last_terms(double length) const;
    int finite_order() const;
    double slope(const Beside& beside, int k, std::size_t i) const {
        return (beside.motion.coefficient(k, i) - motion_.coefficient(k, i)) / beside.distance;
    }

    Tangent tangent_;
    MotionSeries motion_, part_;
    State state_;  // of the last expansion
    std::vector<Beside> beside_;
    int order_ = 0;        // of the motion
    int slope_order_ = 6;  // of what is beside it: as the step before had it, or more
};

}  // namespace achilles
