// The derivatives of one smooth motion after a time by the state where it starts and the start's time, to a few digits: from the
// series of motions that start beside it, by the code that runs have.
#pragma once

#include "depend/flow_slope.hpp"
#include "depend/motion_series.hpp"

namespace achilles {

// Columns of parameters are 0.
class FlowDifference : public FlowSlope {
 public:
    FlowDifference(const Model& model, ContactSet held, const Tangent& tangent, std::span<const double> parameters);

    double expand(const State& state, double length, int least_order) override;
    int order() const override { return order_; }
    // Of the motion itself.
    double coefficient(int k, std::size_t i) const override { return motion_.coefficient(k, i); }
    void slope_after(double span, ContactSet held, RowMatrix& S) override;

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
