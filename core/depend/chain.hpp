// A finished run as a chain of linear maps: what a small change of its start, or of a parameter, becomes of it, event by event
// (theory-derivatives.md 1). It is made from what the run has recorded, so that every decision is the run's.
//
//     Chain chain(trajectory);
//     RowMatrix Z = ...;  chain.complete(Z);               one column a change, its rows as Tangent says
//     while (const Link* link = chain.next()) link->apply(Z);
//
// Z after a link is the change following the event, (t', X'): that of the state where the run stands then, which each member of
// the change reaches at its own time. At a fixed time it is  X' - F t', F = chain.rate().
//
// Who carries something else through the run, the error that steps have made and its covariance (theory-enclosure.md 9), takes
// the same links: e := J e + what the link has left out, P := J P J' + ...
#pragma once

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "depend/derivatives.hpp"
#include "depend/flow_slope.hpp"
#include "depend/gradient.hpp"
#include "run/trajectory.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

struct Link {
    enum class Kind {
        step,      // a step of smooth motion, or a part of one, for a fixed time: Z := J Z
        crossing,  // every member goes on, or back, to where the event is its own: Z := Z - F (G Z)/(G F)
        jump       // what happens at the event at once: Z := J Z
    };
    Kind kind = Kind::step;
    std::optional<std::size_t> event;  // of the trajectory; a crossing and then a jump have it
    double length = 0.0;               // s, of a step

    RowMatrix J;               // of a step and a jump
    Eigen::Index changed = 0;  // its first rows: those of parameters, behind them, are as they were
    Eigen::VectorXd F;         // of a crossing: the rates of all components before the event,
    Eigen::RowVectorXd G;      // the gradient of what vanishes there,
    double residual = 0.0;     // and its value
    // Where errors are followed, besides. Of a step, in the rows of q and v: the terms that the run's polynomials leave
    // out, (c_{K+1} + c_{K+2} t + ...) t^(K+1). Of the crossing at an impact: the gradient of the gap by q and t, where the
    // step, before it was moved onto the surface, had come to `residual`; G, the gap once more, is of the gap's own series.
    Eigen::VectorXd left_out;
    Eigen::RowVectorXd by_place;
    // Of the jump at which a bouncing is cut.
    struct Completion {
        std::size_t contact;
        Mode others;       // in which the contact is open
        double speed;      // w
        RowMatrix newton;  // the impact that is drawn there, in place of the J that the run goes on from
    };
    std::optional<Completion> completion;

    void apply(RowMatrix& Z) const;
};

inline void take_least(std::optional<double>& least, double x) { least = least ? std::min(*least, x) : x; }

class Chain {
 public:
    struct Options {
        // For errors in place of changes: links tell what steps leave out, follow the state where the run takes it for its
        // gaps, and are no more exact than an estimate asks for; parameters do not change, there are no margins.
        bool errors = false;
        // The parameters that a change may have, if not all may: steps are cheaper for eight variables at a time.
        std::vector<bool> parameters{};
    };
    // The trajectory, of which everything must have been kept, outlives this. Throws InputError where bouncings were restarted by
    // the Euclidean projection: their derivatives converge no faster than O(w ln w).
    explicit Chain(const Trajectory& trajectory) : Chain(trajectory, Options{}) {}
    Chain(const Trajectory& trajectory, Options options);
    ~Chain();
    // Throws the same of a run that has not been made yet.
    static void check(const Run& run);

    const Tangent& tangent() const { return tangent_; }
    // Fills the rows of h and u at the start from those of t, q, v and p.
    void complete(RowMatrix& Z);
    // The contacts on which the run starts at rest: a change must leave their h and u at 0.
    ContactSet resting_at_start() const { return resting_; }

    // The next link, which stands until the next call; null at the end of the run, or where there is no derivative any more.
    const Link* next();
    // Why there is none from where the run now stands; empty where the chain goes on.
    const std::string& broken() const { return broken_; }
    // Where the run stands after the last link, and F there.
    const State& state() const { return state_; }
    Eigen::VectorXd rate();
    Mode mode() const { return mode_; }
    const DerivativeMargins& margins() const { return margins_; }

 private:
    void step();
    void happen(std::size_t event);
    void land(std::size_t event);
    void reach_zeno_point(std::size_t event);
    void release(std::size_t event);
    void break_off(std::string reason) { broken_ = std::move(reason); }

    Link& add(Link::Kind kind, std::optional<std::size_t> event = {});
    Link& cross(std::size_t event, Eigen::RowVectorXd G, double residual);
    void meet_surface(std::size_t contact, Mode others, Link& crossing);
    double residual_before(std::size_t contact);
    void retract(RowMatrix& J, Mode onto);
    Eigen::RowVectorXd wait_row(const RowMatrix& J, std::size_t contact, Mode others, double speed);
    std::optional<std::string> next_completion(std::size_t event, ContactSet& joins) const;
    void set_gaps();
    void watch_minima(const FlowSlope& slope, double span);

    ContactGradient& surface(std::size_t contact, Mode mode);
    FlowSlope& slope(Mode mode);

    const Trajectory* trajectory_;
    const Model* model_;
    Options options_;
    Tangent tangent_;
    Surfaces surfaces_;
    std::map<ContactInMode, std::unique_ptr<ContactGradient>> contacts_;
    std::map<ContactInMode, std::unique_ptr<Gradient>> trends_, normals_;
    std::map<std::size_t, std::unique_ptr<Gradient>> restitutions_;
    std::map<Mode, std::unique_ptr<FlowSlope>> slopes_;
    std::map<Mode, std::unique_ptr<FlowDifference>> differences_;  // in their place, for errors
    Model::MotionEvaluators motions_;

    State state_;
    Mode mode_;
    ContactSet resting_;
    std::size_t next_piece_ = 0, next_event_ = 0;
    bool waiting_ = false;       // between a cut and its Zeno point
    std::vector<double> h_, u_;  // of every contact, at the state
    std::deque<Link> links_;     // whose room is used again
    std::size_t made_ = 0, given_ = 0;
    std::string broken_;
    DerivativeMargins margins_;
};

}  // namespace achilles
