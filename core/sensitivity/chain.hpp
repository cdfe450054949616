// A finished run as a chain of linear maps, which carry a small change of its start or parameters through all steps and
// events (theory-derivatives.md 1). The chain is made from the recorded trajectory, so all decisions are those of the
// run.
//
//     Chain chain(trajectory);
//     RowMatrix Z = ...;  chain.complete(Z);               one column for each change, rows as in TangentLayout
//     while (const ChainLink* link = chain.next()) link->apply(Z);
//
// After a link, Z is the change (t', X') that follows the event: each perturbed run reaches this point at its own time.
// The change at a fixed time is X' - F t', with F = chain.rate().
//
// The same links carry other quantities, such as the accumulated error and its covariance (theory-enclosure.md 9): e :=
// J e + the terms omitted by the link, P := J P J' + ...
#pragma once

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "run/trajectory.hpp"
#include "sensitivity/derivatives.hpp"
#include "sensitivity/flow_sensitivity.hpp"
#include "sensitivity/gradient.hpp"
#include "simulate/contact_cache.hpp"

namespace achilles {

struct ChainLink {
    enum class Kind {
        step,      // a step of smooth motion, or a part of one, of fixed length: Z := J Z
        crossing,  // moves every perturbed run to its own event: Z := Z - F (G Z)/(G F)
        jump       // the jump at the event: Z := J Z
    };
    Kind kind = Kind::step;
    std::optional<std::size_t> event;  // index in the trajectory; set for a crossing and the jump after it
    double length = 0.0;               // s, for a step

    RowMatrix J;               // for a step or a jump
    Eigen::Index changed = 0;  // number of leading rows that change; the rows of parameters, at the end, never do
    Eigen::VectorXd F;         // for a crossing or a Zeno point: the rates of all components before the event;
    Eigen::RowVectorXd G;      // for a crossing: the gradient of the function that vanishes at the event,
    double residual = 0.0;     // and its value
    // Only with Options::errors. For a step, left_out has in the rows of q and v the terms that the run's polynomials
    // omit, (c_{K+1} + c_{K+2} t + ...) t^(K+1). For the crossing at an impact, by_place is the gradient of the gap by
    // q and t. `residual` is then the gap that the step reached before the projection onto the surface, and G refers to
    // the gap as a component of its own.
    Eigen::VectorXd left_out;
    Eigen::RowVectorXd by_place;
    // Data of the jump at a truncation.
    struct PendingCompletion {
        BouncingKey key;
        State tangential;  // q and s, without the drift of a contact that sticks
        double speed;      // w
        RowMatrix newton;  // J of the simulated impact, whereas the run continues with J above
    };
    std::optional<PendingCompletion> completion;

    void apply(RowMatrix& Z) const;
};

inline void take_least(std::optional<double>& least, double x) { least = least ? std::min(*least, x) : x; }

class Chain {
 public:
    struct ChainOptions {
        // Compute links for errors instead of changes. Links then contain the omitted terms of steps, use the gaps of
        // the run's states, and are only as accurate as an estimate requires. Parameters do not change, and there are
        // no margins.
        bool errors = false;
        // Marks the parameters that may change; empty: all. Steps are cheaper with fewer variables, in groups of eight.
        std::vector<bool> parameters{};
    };
    // The trajectory must be recorded in full and outlive this object. Throws InputError if bouncings were restarted by
    // the Euclidean projection: their derivatives converge no faster than O(w ln w).
    explicit Chain(const Trajectory& trajectory) : Chain(trajectory, ChainOptions{}) {}
    Chain(const Trajectory& trajectory, ChainOptions options);
    ~Chain();
    // Throws the same InputError before the run is made.
    static void check(const Run& run);

    const TangentLayout& tangent() const { return tangent_; }
    // Fills the rows of h and u at the start from those of t, q, v and p.
    void complete(RowMatrix& Z);
    // The contacts that are closed at rest at the start: a change must not change their h and u.
    ContactSet resting_at_start() const { return resting_; }
    // The contacts and joints whose slip is 0 at the start and whose friction would jump with it: a change must not
    // change these slips. They slide from there, or only static friction holds them. Then the derivatives of a slip by
    // the components there.
    ContactSet critical_slips_at_start() const { return critical_slips_; }
    Eigen::RowVectorXd slip_row_at_start(std::size_t which);

    // The next link, valid until the next call; null at the end of the run, or once the chain is broken.
    const ChainLink* next();
    // The reason why there are no derivatives from here on; empty if there are.
    const std::string& broken() const { return broken_; }
    // The state after the last link, and F there.
    const State& state() const { return state_; }
    Eigen::VectorXd rate();
    Mode mode() const { return mode_; }
    const DerivativeMargins& margins() const { return margins_; }

 private:
    void step();
    void handle_event(std::size_t event);
    void land(std::size_t event);
    ContactSet latched_before(std::size_t event) const;
    std::size_t cross_guard(std::size_t event, bool is_latch, std::size_t number);
    void reach_zeno_point(std::size_t event);
    Mode mode_after_cut(Mode held) const;
    void release(std::size_t event);
    // With dry friction (chain_friction.cpp, friction_impact_sensitivity.cpp).
    void find_critical_slips();
    void begin_with_friction();
    void end_with_friction();
    void change_friction(std::size_t event);
    void end_latch_with_friction(std::size_t event);
    std::optional<std::size_t> vanishing_function(std::size_t event);
    double slip_residual(std::size_t which, double at_event);
    void move_onto(RowMatrix& J, ContactSet surfaces);
    void settle(RowMatrix& J, Mode onto);
    void land_with_friction(std::size_t event);
    struct ImpactRows;
    bool add_loaded_contacts(const Event& now, ContactSet latched, ImpactRows& impact);
    bool add_slip(const Event& now, std::size_t contact, ImpactRows& impact);
    RowMatrix after_impact(const ImpactRows& impact, const RowMatrix& J) const;
    void bounce_with_friction(const Event& now, const ImpactRows& impact, RowMatrix& J);
    void come_to_rest(std::size_t event, const ImpactRows& impact, ChainLink& link);
    void truncate_with_friction(const BouncingKey& key, double speed, const ImpactRows& impact, ChainLink& link);
    void add_drift_of_slip(RowMatrix& J, const BouncingKey& key, double speed);
    ContactState state_of_bouncing(std::size_t event, std::size_t contact) const;
    double coefficient_rate(std::size_t which, double speed);
    // Jumps of the state, and passes (chain_jump.cpp).
    void jump(std::size_t event);
    bool continue_after_jump(const Event& now, const std::string& name);
    void pass(std::size_t event);
    void keep_zeros(std::optional<std::size_t> watched);
    ContactSet closed_here();
    Gradient& jump_map(std::size_t number);
    Gradient& guards();
    void break_off(std::string reason) { broken_ = std::move(reason); }

    ChainLink& add(ChainLink::Kind kind, std::optional<std::size_t> event = {});
    ChainLink& cross(std::size_t event, Eigen::RowVectorXd G, double residual);
    ChainLink& cross_surface(std::size_t event);
    void set_rate_rows(RowMatrix& J, std::size_t but);
    void meet_surface(std::size_t contact, Mode others, ChainLink& crossing);
    double residual_before(std::size_t contact);
    void retract(RowMatrix& J, Mode onto);
    Eigen::RowVectorXd accumulation_time_row(const RowMatrix& J, const BouncingKey& key, double speed);
    std::optional<std::string> next_completion(std::size_t event, ContactSet& joins) const;
    void set_gaps();
    void watch_minima(const FlowSensitivity& slope, double span, ContactSet but);

    ContactGradient& surface(std::size_t contact, Mode mode);
    SlipGradient& slip(std::size_t which);
    Gradient& sticking(const BouncingKey& key);
    Gradient& event_functions(Mode mode);
    Gradient& restitution(std::size_t contact);
    FlowSensitivity& slope(Mode mode);

    const Trajectory* trajectory_;
    const Model* model_;
    ChainOptions options_;
    TangentLayout tangent_;
    ContactCache surfaces_;
    std::map<ContactInMode, std::unique_ptr<ContactGradient>> contacts_;
    std::map<ContactInMode, std::unique_ptr<Gradient>> normals_;
    std::map<BouncingKey, std::unique_ptr<Gradient>> trends_, stickings_;
    std::map<std::size_t, std::unique_ptr<Gradient>> restitutions_;
    std::map<std::size_t, std::unique_ptr<SlipGradient>> slips_;
    std::map<std::size_t, std::pair<Program, std::optional<Evaluator<double>>>> coefficient_rates_;
    std::map<Mode, std::unique_ptr<Gradient>> event_functions_;
    std::map<std::size_t, std::unique_ptr<Gradient>> jump_maps_;
    std::unique_ptr<Gradient> guards_;
    State scale_;                    // of the run; empty until needed
    RowMatrix zeros_, since_zeros_;  // rows that vanish before the jumps of an instant; changes since then
    std::map<Mode, std::unique_ptr<FlowSensitivity>> slopes_;
    std::map<Mode, std::unique_ptr<FlowDifference>> differences_;  // used instead of slopes_ for errors
    Model::MotionEvaluators motions_;

    State state_;
    Mode mode_;
    ContactSet resting_, critical_slips_;
    bool begun_ = false;
    std::size_t next_piece_ = 0, next_event_ = 0;
    bool waiting_ = false;         // between a truncation and its Zeno point
    std::vector<double> h_, u_;    // of every contact, at state_
    std::deque<ChainLink> links_;  // reused storage
    std::size_t link_count_ = 0, next_link_ = 0;
    std::string broken_;
    DerivativeMargins margins_;
};

}  // namespace achilles
