// The equations of motion of one system, derived symbolically once (theory.md 1) and compiled into programs.
//
//     M(q) a + b(q,v,t) = Q(q,v,t)             free motion,  f = M^-1 (Q - b)
//     g = dh,  W = g M^-1 g',  n = M^-1 g'/W    normal direction, g n = 1
//     hdot = g v + h_t,  hddot                  rate of the gap, normal acceleration of the free motion
//     lambda = -hddot/W,  f_c = f - n hddot     contact force, constrained acceleration
//     s = v - n hdot                            tangential velocity, unchanged by impacts
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "model/domain_boundaries.hpp"
#include "model/friction_bouncing.hpp"
#include "model/restitution.hpp"
#include "model/scopes.hpp"
#include "model/variation.hpp"
#include "program/program.hpp"
#include "program/terms.hpp"
#include "run/trajectory.hpp"
#include "series/lane_stepper.hpp"
#include "series/series.hpp"
#include "system/description.hpp"

namespace achilles {

class Model {
 public:
    // Derives and compiles the equations. Throws InputErrors, located in the file, if T, V, h or e is invalid.
    explicit Model(SystemDescription description);

    const SystemDescription& description() const { return description_; }
    const Layout& layout() const { return layout_; }
    int dof() const { return static_cast<int>(layout_.dof); }
    std::size_t contacts() const { return equations_.gaps.size(); }
    const Equations& equations() const { return equations_; }
    bool has_friction() const { return !equations_.friction.empty(); }
    bool has_jumps() const { return !equations_.jumps.empty(); }
    bool has_latches() const { return has_latches_; }
    // Whether there are jumps, latches, or contacts that count only sometimes.
    bool has_guards() const { return has_jumps() || has_latches_ || has_conditional_contacts_; }
    // Whether forces depend on which contacts are held.
    bool do_forces_see_contact() const { return layout_.forces_see_contact; }
    // A mode without the constraint of one of its held contacts (model/derive.hpp).
    Mode unconstrained(Mode mode, std::size_t contact) const {
        return achilles::unconstrained(mode, contact, equations_.in_forces);
    }
    // Whether some contact counts only sometimes.
    bool has_conditional_contacts() const { return has_conditional_contacts_; }
    bool is_conditional(std::size_t contact) const { return equations_.when[contact].has_value(); }
    std::span<const std::string> slot_names() const { return slot_names_; }

    // The equations of motion in a mode, compiled at first use. The reference stays valid as long as the model.
    const ModeDynamics& motion(Mode mode) const;
    LanePrograms lane_programs() const;
    // The same mode with hddot of every contact as event functions, for proofs (make_hddot_series).
    const SeriesProgram& hddot_series(Mode mode) const;

    // The motion together with its derivatives along `directions` groups of eight directions; each lane computes one
    // direction of a group. It is compiled at first use.
    const MotionVariation& variation(Mode mode, std::uint32_t directions) const;

    // The programs of one contact in a mode in which it is open, compiled at first use.
    struct ContactPrograms {
        Program gap;                  // h
        Program normal_acceleration;  // hddot
        Program force;                // lambda
        TypedProgram<ContactTerms> contact_terms;
        TypedProgram<ReleaseTerms> release_terms;
        TypedProgram<Definition7Terms> definition7_terms;
    };
    const ContactPrograms& programs_of(std::size_t contact, Mode mode = {}) const;
    // The slip of a contact or joint with friction in a mode in which it is open. Its input Layout::sliding_speed() is
    // the speed at which the coefficient is evaluated.
    const TypedProgram<SlipTerms>& slip_terms(std::size_t which, Mode mode = {}) const;
    // lambda, tau and their common factor, of a contact or joint that is not open in this mode (friction_force).
    const Program& friction_force(std::size_t which, Mode mode) const;
    // What ModeDynamics watches.
    const std::vector<WatchedGuard>& watched_guards() const { return watched_guards_; }
    // The watched guards, then `when` of every contact and of every jump; 1 where there is none.
    const Program& guards() const { return guards_; }
    std::size_t guard_of_contact(std::size_t contact) const { return watched_guards_.size() + contact; }
    std::size_t guard_of_jump(std::size_t jump) const { return watched_guards_.size() + contacts() + jump; }
    // q and v after a jump, from the state before.
    const Program& jump_map(std::size_t jump) const { return jump_maps_[jump]; }
    // The derivatives of each watched guard by q and v.
    const Program& guard_slopes() const { return guard_slopes_; }
    // The second rates of the watched guards along the motion in a mode.
    const Program& guard_curvatures(Mode mode) const;
    // Whether hddot of a contact in a mode is proved to be 0 wherever h = hdot = 0 for this contact and the held ones,
    // for all parameters. Its gap then stays 0 while theirs do, and its force is 0 (theory-gaps.md 2.7).
    bool stays_closed_without_force(std::size_t contact, Mode mode) const;

    // Programs of the free motion; compiled once.
    const Program& gap(std::size_t contact = 0) const { return programs_of(contact).gap; }
    const Program& normal_acceleration() const { return programs_of(0).normal_acceleration; }
    const Program& force() const { return programs_of(0).force; }
    const Program& restitution(std::size_t contact = 0) const { return restitutions_[contact]; }
    // The restitution of a contact at these parameters, clamped to [0, 1] if it is outside by rounding; below, its
    // interval enclosure.
    double restitution(std::span<const double> parameters, std::size_t contact) const {
        return without_rounding(evaluator(restitutions_[contact], parameters).output(0));
    }
    Interval restitution(std::span<const Interval> parameters, std::size_t contact) const;
    // Value and enclosure for every contact, evaluated once per run.
    std::vector<Restitution> restitutions(std::span<const double> parameters) const;
    const TypedProgram<ContactTerms>& contact_terms() const { return programs_of(0).contact_terms; }
    const TypedProgram<ReleaseTerms>& release_terms() const { return programs_of(0).release_terms; }
    const TypedProgram<Definition7Terms>& definition7_terms() const { return programs_of(0).definition7_terms; }
    const TypedProgram<EnergyTerms>& energy() const { return energy_; }
    // dE/dt in a mode: v'Q + dV/dt - sum lambda dh/dt over the held contacts (W). With friction it also subtracts tau
    // c, and the second output is the heat per time (theory-friction.md 5), which is not part of dE/dt.
    const Program& power(Mode mode) const;
    const SeriesProgram& power_series(Mode mode) const;

    // The derived parameters, in the order of the description.
    const Program& derived_parameters() const { return derived_parameters_; }

    // Functions whose edge the motion may reach, and the series of their distances from the edge.
    const std::vector<DomainBoundary>& edges() const { return edges_; }
    const SeriesProgram& edge_series() const { return edge_series_; }

    // The programs of the truncation conditions of a contact in a mode in which it is open, derived at first use.
    // Throws InputError if they are too large.
    const BouncingModel& bouncing(std::size_t contact = 0, Mode mode = {}) const { return bouncing({contact, mode}); }
    const OtherContactTerms& other_contact_terms(std::size_t contact, Mode mode) const {
        return other_contact_terms({contact, mode});
    }
    // The same for a contact with friction, which slides or sticks at its impacts. The third tells why the bouncing has
    // no such programs; empty if it has them, as without friction.
    const BouncingModel& bouncing(const BouncingKey& key) const;
    const OtherContactTerms& other_contact_terms(const BouncingKey& key) const;
    // How the acceleration changes at the Zeno point of a contact that forces see: from there on it acts on them. One
    // output for each coordinate, with v = s (theory-modes.md 5).
    const Program& change_at_zeno_point(const BouncingKey& key) const;
    std::optional<BouncingObstacle> obstacle_to_bouncing(const BouncingKey& key) const;
    // The same for two contacts that bounce together or in turn, first < second. In the mode `closed` they are held with
    // the others; those with friction slide (derive_sliding_pair).
    const PairPrograms& pair(std::size_t first, std::size_t second, Mode closed) const;

    // An evaluator of one of the programs above with the values of the parameters set.
    template <class Scalar = double>
    Evaluator<Scalar> evaluator(const Program& program, std::span<const double> parameters) const {
        Evaluator<Scalar> result(program);
        for (std::size_t i = 0; i < parameters.size(); ++i) result.input(layout_.parameter(i)) = Scalar(parameters[i]);
        result.fix();
        return result;
    }
    template <class Scalar = double, template <class> class TermsOf>
    TermsOf<Evaluator<Scalar>> evaluator(const TypedProgram<TermsOf>& program,
                                         std::span<const double> parameters) const {
        return {evaluator<Scalar>(static_cast<const Program&>(program), parameters), layout_.dof};
    }

    // The same, created at first use: a run needs only a few of the evaluators that it may need.
    template <class Scalar, template <class> class TermsOf>
    TermsOf<Evaluator<Scalar>>& lazily(std::optional<TermsOf<Evaluator<Scalar>>>& evaluator,
                                       const TypedProgram<TermsOf>& program, std::span<const double> parameters) const {
        if (!evaluator) evaluator = this->evaluator<Scalar>(program, parameters);
        return *evaluator;
    }
    using MotionEvaluators = std::map<Mode, MotionTerms<Evaluator<double>>>;
    MotionTerms<Evaluator<double>>& lazily(MotionEvaluators& evaluators, Mode mode,
                                           std::span<const double> parameters) const {
        const auto known = evaluators.find(mode);
        if (known != evaluators.end()) return known->second;
        const ModeDynamics& dynamics = motion(mode);
        return evaluators
            .try_emplace(mode, evaluator(static_cast<const Program&>(dynamics.program), parameters), layout_.dof,
                         contacts() + dynamics.further_events())
            .first->second;
    }

    // The run that the description specifies.
    Run default_run() const { return achilles::default_run(description_); }
    // Throws InputErrors if the run cannot start: start not finite; T, V, h or the acceleration undefined there;
    // restitution outside [0, 1]; M not positive definite; gap clearly negative; dh = 0 in contact; friction negative,
    // or above its static limit at slip 0; a contact that never slides starts with a slip; a parameter subnormal; eps
    // or tolerance not positive; end not after the start.
    void check(const Run& run) const;

    // Programs for the expressions of a view or a drawing. Those of a view may contain t, coordinates, rates,
    // parameters, gap, gap', gap'', lambda and energy. Those of a drawing may contain coordinates, t, parameters and
    // the curve's own parameter. Throw InputError.
    Program compile_view(std::span<const Text> texts) const;
    // The value of a view expression, followed by its derivatives with respect to t, q and v.
    Program compile_section(const Text& text) const;
    // A program over the names of a view and quantities of the run: input layout().count() + i is quantities[i].
    struct MeasureProgram {
        Program program;
        std::vector<RunQuantity> quantities;
    };
    MeasureProgram compile_measures(std::span<const Text> texts) const;
    // A program over the parameters alone.
    Program compile_of_parameters(std::span<const Text> texts) const;
    Program compile_drawing(std::span<const Text> texts, const std::string& own = {}) const;

 private:
    InputError too_large(const char* what, const ExpressionTooLarge& problem) const;
    Expression read(const Text& text, const Scope& scope, Graph& graph) const;
    void compile();
    void compile_jumps();
    ContactPrograms compile_contact(const ModeEquations& motion, std::size_t contact) const;
    ContactModes& contact_modes() const;
    template <class Map, class Make>
    const auto& derived(Map& map, const typename Map::key_type& key, const Make& make) const;
    // These throw Mistake.
    void check_energies(const Run& run, const StartTerms<Evaluator<double>>& start) const;
    void check_gap(const Run& run, std::size_t contact) const;
    void check_friction(const Run& run, const SlidingPlace& place) const;
    void check_mass(const StartTerms<Evaluator<double>>& start) const;
    void check_acceleration(const Run& run, const StartTerms<Evaluator<double>>& start) const;

    SystemDescription description_;
    Layout layout_;
    std::unique_ptr<Graph> graph_;
    Equations equations_;
    std::vector<std::string> slot_names_;
    mutable std::mutex modes_mutex_;  // protects everything that is derived at first use
    mutable std::unique_ptr<ContactModes> modes_;
    mutable std::map<Mode, ModeDynamics> motions_;
    mutable std::map<Mode, SeriesProgram> hddot_series_;
    mutable std::map<std::pair<Mode, std::uint32_t>, MotionVariation> variations_;
    mutable std::map<Mode, Program> powers_;
    mutable std::map<Mode, SeriesProgram> power_series_;
    mutable std::map<ContactInMode, ContactPrograms> programs_;
    mutable std::map<BouncingKey, BouncingModel> bouncings_;
    mutable std::map<BouncingKey, OtherContactTerms> other_contact_terms_;
    mutable std::map<BouncingKey, Program> changes_at_zeno_points_;
    mutable std::map<ContactInMode, bool> closed_without_force_;
    mutable std::map<std::pair<Mode, ContactSet>, PairPrograms> pairs_;
    mutable std::map<ContactInMode, TypedProgram<SlipTerms>> slip_terms_;
    mutable std::map<ContactInMode, Program> friction_forces_;
    std::vector<const ContactPrograms*> free_;  // the entries of programs_ for the mode without held contacts
    std::vector<Program> restitutions_;
    std::vector<WatchedGuard> watched_guards_;
    bool has_conditional_contacts_ = false, has_latches_ = false;
    Program guards_, guard_slopes_;
    std::vector<Program> jump_maps_;
    mutable std::map<Mode, Program> guard_curvatures_;
    Program derived_parameters_;
    SeriesProgram edge_series_;
    std::vector<DomainBoundary> edges_;
    TypedProgram<EnergyTerms> energy_;
    TypedProgram<StartTerms> start_;
    mutable std::map<BouncingKey, std::optional<BouncingObstacle>> obstacles_;
};

// The kinds of events that runs of a system may have, in the order of the kinds.
std::vector<EventNames> possible_events(const Model& model);

// ---- derived parameters ----

// The derived parameters for these values of the parameters, in the order of the description's `derived`.
std::vector<double> derived_values(const Model& model, std::span<const double> parameters);

}  // namespace achilles
