// Dry friction along a run (theory-friction.md 1, 2): which contacts and joints stick or slip at the start and after an
// event. Numbers propose the mode, and intervals over the rounding box prove it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contacts/friction_modes.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

// At most this many contacts and joints with friction are decided together.
constexpr int max_rough = 4;

// Whether the only contact has a slip that is a multiple of its gap rate.
bool slides_along_normal(const FrictionProblem& problem) {
    if (problem.elements.size() != 1) return false;
    const Eigen::Index gap = problem.elements.front().gap, slip = problem.elements.front().slip;
    if (gap < 0 || slip < 0) return false;
    const double both = problem.W(gap, gap) * problem.W(slip, slip), mixed = problem.W(gap, slip);
    constexpr double rounding = 1e-12;
    return both - mixed * mixed <= rounding * both;
}

// The first two joints that rest with equal or opposite slips, or slips that are multiples of one another; none if there
// are no such joints. Only a sum of their friction forces is determined.
std::optional<std::pair<std::size_t, std::size_t>> joints_with_one_slip(const FrictionProblem& problem) {
    constexpr double rounding = 1e-12;
    for (const FrictionProblem::Element& a : problem.elements)
        for (const FrictionProblem::Element& b : problem.elements) {
            if (a.which >= b.which || a.gap >= 0 || b.gap >= 0) continue;
            const double both = problem.W(a.slip, a.slip) * problem.W(b.slip, b.slip),
                         mixed = problem.W(a.slip, b.slip);
            if (both - mixed * mixed <= rounding * both) return std::pair(a.which, b.which);
        }
    return std::nullopt;
}

// Whether all principal minors are positive beyond rounding: those without the first row are, and so are those of its
// Schur complement.
bool is_p_matrix(const Eigen::MatrixXd& W) {
    constexpr double rounding = 1e-12;
    const Eigen::Index rest = W.rows() - 1;
    if (rest < 0) return true;
    if (!(W(0, 0) > rounding * W.row(0).cwiseAbs().maxCoeff())) return false;
    const Eigen::MatrixXd others = W.bottomRightCorner(rest, rest),
                          complement = others - W.col(0).tail(rest) * W.row(0).tail(rest) / W(0, 0);
    return is_p_matrix(others) && is_p_matrix(complement);
}

}  // namespace

std::string ExecutionAutomaton::name_of(std::size_t which) const {
    const SystemDescription& system = model_->description();
    return "'" + (is_joint(which) ? system.frictions[which - max_contacts].name : system.constraints[which].name) + "'";
}

ContactSet ExecutionAutomaton::all_joints() const {
    ContactSet joints;
    for (const std::size_t i : surfaces_->rough())
        if (is_joint(i)) joints = joints.with(i);
    return joints;
}

// The contacts and joints with friction, of these, whose slip is 0 within rounding.
ContactSet ExecutionAutomaton::at_zero_slip(ContactSet contacts_and_joints) {
    constexpr double few = 4.0;
    ContactSet found;
    for (const std::size_t i : contacts_and_joints.within(surfaces_->rough()).without(surfaces_->frictionless()))
        if (std::abs(surfaces_->slip(i, next_.state).u) <= few * surfaces_->slip_error(i, next_.state))
            found = found.with(i);
    return found;
}

// The mode in which these contacts and joints are held, or slip with the sign of their slip.
Mode ExecutionAutomaton::sliding_mode(ContactSet contacts_and_joints) {
    const ContactSet resting = at_zero_slip(contacts_and_joints);
    Mode mode = Mode::holding(contacts_and_joints);
    for (const std::size_t i : contacts_and_joints.within(surfaces_->rough()).without(resting))
        mode = mode.with(i, slip_state(surfaces_->slip(i, next_.state).u > 0.0 ? 1 : -1));
    return mode;
}

void ExecutionAutomaton::begin_with_friction(ContactSet landing, ContactSet resting,
                                             const UncountedContacts& uncounted) {
    const Mode mode = sliding_mode(resting.with(all_joints()));
    if (!surfaces_->settle(next_.state, mode.with(next_.latched, ContactState::held))) return fail_projection();
    if (landing.empty()) {
        decide_with_friction(resting, mode);
    } else {
        decide_with_friction({}, mode.without(resting));
    }
    open_first_phase(uncounted);
    if (outcome_) return;
    if (landing.empty()) return begin_stretch(next_.mode, run_.options.end_time);
    next_.touching = resting;
    collide_with_friction(landing);
}

// The event functions of friction in the current mode start without known roots, but for slips that start now.
void ExecutionAutomaton::start_friction_functions() {
    const std::vector<FrictionEvent>& friction = model_->motion(next_.mode).friction;
    next_.starts.resize(surfaces_->count() + friction.size());
    for (std::size_t k = 0; k < friction.size(); ++k) {
        EventStart& start = next_.starts[surfaces_->count() + k] = {};
        const auto root = slip_roots_.find(friction[k].contact);
        if (friction[k].watched == FrictionFunction::slip && root != slip_roots_.end())
            start.multiplicity = root->second;
    }
    slip_roots_.clear();
}

bool ExecutionAutomaton::is_pivot(std::size_t event) const {
    const std::vector<FrictionEvent>& friction = model_->motion(next_.mode).friction;
    const std::size_t number = event - surfaces_->count();
    return event >= surfaces_->count() && number < friction.size() &&
           friction[number].watched == FrictionFunction::pivot;
}

void ExecutionAutomaton::accept_friction_event(std::size_t event) {
    if (completing())
        return stop(Outcome::Kind::undecided, "the friction changes before the Zeno time at " + where(next_.state));
    const FrictionEvent what = model_->motion(next_.mode).friction[event - surfaces_->count()];
    switch (what.watched) {
        case FrictionFunction::slip:
            return end_slip(what.contact);
        case FrictionFunction::upper_limit:
            return start_slip({what.contact, -1}, event);
        case FrictionFunction::lower_limit:
            return start_slip({what.contact, 1}, event);
        case FrictionFunction::pivot:
            break;
    }
    const Slip slip = surfaces_->slip(what.contact, next_.state);
    stop(Outcome::Kind::painleve,
         fmt::format(
             "{} slides at u = {:.6g}, and W falls to 0, so that no contact force can keep its gap closed: rigid "
             "bodies with this friction have no motion from here, at {}",
             name_of(what.contact), slip.u, where(next_.state)));
}

// ---- transitions ----

void ExecutionAutomaton::end_slip(std::size_t which) {
    const Mode before = next_.mode;
    Mode resting = before.with(which, ContactState::held);
    if (!surfaces_->settle(next_.state, resting)) return fail_projection();
    // Others may stop at the same instant.
    resting = resting.with(at_zero_slip(before.slipping()), ContactState::held);
    if (!surfaces_->settle(next_.state, resting)) return fail_projection();
    if (!decide_with_friction(before.held(), resting)) return;
    enter_friction_mode(before);
}

// Where mu_s = mu(0) the accelerations are continuous: the slip has a double zero, and it starts because the function
// of the cone falls strictly. Where mu_s > mu(0) the friction force jumps, and the modes are decided anew.
void ExecutionAutomaton::start_slip(const SlipStart& start, std::size_t event) {
    const Mode before = next_.mode;
    ModeKinematics& motion = surfaces_->motion(before);
    const auto values = motion.enclosed(next_.state);
    const FrictionLaws& laws = model_->equations().friction;
    bool jumps = false;
    for (const std::size_t i : sharing_with(before, start.which, laws).with(start.which))
        jumps = jumps || laws.at(i).has_jump;
    bool both = false;  // whether the force itself vanishes
    for (std::size_t k = 0; k < motion.friction().size(); ++k) {
        const FrictionEvent& other = motion.friction()[k];
        const std::size_t number = surfaces_->count() + k;
        const bool is_limit =
            other.watched == FrictionFunction::upper_limit || other.watched == FrictionFunction::lower_limit;
        if (number == event || !is_limit || certainly_positive(values[number].value)) continue;
        if (other.contact != start.which)
            return stop(Outcome::Kind::undecided,
                        fmt::format("cannot decide which of {} and {} starts to slide first, at {}",
                                    name_of(start.which), name_of(other.contact), where(next_.state)));
        both = true;
    }
    if (both && !is_joint(start.which)) return release_with_friction(start.which);
    if (jumps) {
        if (decide_with_friction(before.held(), before, start)) enter_friction_mode(before);
        return;
    }
    if (both || !certainly_negative(values[event].rate))
        return stop(
            Outcome::Kind::undecided,
            fmt::format("the friction force of {} touches its limit: cannot decide whether it starts to slide, at {}",
                        name_of(start.which), where(next_.state)));
    next_.mode = before;
    for (const std::size_t i : sharing_with(before, start.which, laws).with(start.which)) {
        next_.mode = next_.mode.with(i, slip_state(start.sign));
        slip_roots_[i] = 2;
    }
    enter_friction_mode(before);
}

// Whether these contacts, whose forces vanish together, all open: they are all that is held, they slide or are smooth, and
// h''' > 0 for each without their forces. No other choice obeys the laws if W_sigma is a P-matrix, since the rates of the
// forces solve a complementarity problem with it.
bool ExecutionAutomaton::open_together(ContactSet together) {
    const Mode before = next_.mode, open = before.without(together);
    const ContactSet rough = together.within(surfaces_->rough());
    if (!(together == before.held().without(next_.latched))) return false;
    if (!(all_joints().within(open.slipping()) == all_joints())) return false;
    for (const std::size_t i : together) {
        if (rough.contains(i) && slip_sign(before.state(i)) == 0) return false;
        if (!certainly_positive(surfaces_->of(i, open).normal(next_.state).jerk)) return false;
    }
    const ContactRows rows = surfaces_->rows(next_.state, together, rough, open);
    const auto n = static_cast<Eigen::Index>(together.count());
    Eigen::MatrixXd W(n, n);
    Eigen::Index row = 0, column = 0;
    for (const std::size_t i : together) {
        column = 0;
        for (const std::size_t j : together) {
            W(row, column) = rows.W(rows.gap_of(i), rows.gap_of(j));
            if (rough.contains(j))
                W(row, column) -=
                    slip_sign(before.state(j)) * rows.slips.at(j).coefficient * rows.W(rows.gap_of(i), rows.slip_of(j));
            ++column;
        }
        ++row;
    }
    return is_p_matrix(W);
}

// Like release(), for a contact with friction: its friction force vanishes with its force.
void ExecutionAutomaton::release_with_friction(std::size_t which) {
    which_ = which;
    const Mode before = next_.mode;
    const auto values = surfaces_->motion(before).enclosed(next_.state);
    ContactSet together = ContactSet::of(which);
    for (const std::size_t i : before.held().without(next_.latched))
        if (!certainly_negative(values[i].value)) together = together.with(i);
    const bool others = together.count() > 1;
    if (others && open_together(together)) {
        next_.mode = before.without(together);
        for (const std::size_t i : together) next_.starts[i] = {{0.0, 0.0}, 3};
        return enter_friction_mode(before, together);
    }
    // The friction force of a foot that never slides need not vanish with its contact force.
    if (!others && surfaces_->rough().contains(which) && surfaces_->never_slides(which)) {
        const Interval hddot = surfaces_->of(which, before.without(which)).hddot(next_.state);
        if (certainly_negative(hddot))
            return stop(Outcome::Kind::painleve,
                        fmt::format("the contact force of {} vanishes, and released it would penetrate with the "
                                    "acceleration {:.6g}: a foot that never slides would have to pull, at {}",
                                    name_of(which), mid(hddot), where(next_.state)));
        if (certainly_positive(hddot)) {
            next_.mode = before.without(which);
            next_.starts[which] = {{0.0, 0.0}, 2};
            return enter_friction_mode(before, ContactSet::of(which));
        }
    }
    if (others || !certainly_positive(values[which].rate))
        return stop(Outcome::Kind::undecided,
                    fmt::format("the contact force of {} touches zero{}, and h''' > 0 is not proved at {}",
                                name_of(which), others ? " together with another one" : "", where(next_.state)));
    next_.mode = before.without(which);
    // The next contact with an equal slip carries the friction force.
    const ContactSet sharing = sharing_with(before, which, model_->equations().friction);
    if (slip_sign(before.state(which)) == 0 && !before.implied().contains(which) && !sharing.empty())
        next_.mode = next_.mode.with(*sharing.begin(), ContactState::held);
    next_.starts[which] = {{0.0, 0.0}, 3};
    enter_friction_mode(before, ContactSet::of(which));
}

// Records what has changed since a mode, and begins a segment in the present one. The contacts in `released` are known
// to be released by a vanishing force, those in `unlatched` by the end of their latch.
void ExecutionAutomaton::enter_friction_mode(Mode before, ContactSet released, ContactSet unlatched) {
    const Mode mode = next_.mode;
    start_released(released);
    if (outcome_) return;
    ContactSet stick, slip, reversal;
    for (const std::size_t i : before.held().with(before.joints())) {
        const int was = slip_sign(before.state(i)), is = slip_sign(mode.state(i));
        if (!mode.is_held(i))
            released = released.with(i);
        else if (was != 0 && is == 0)
            stick = stick.with(i);
        else if (was == 0 && is != 0)
            slip = slip.with(i);
        else if (was != is)
            reversal = reversal.with(i);
    }
    record_friction(Event::Kind::stick, stick);
    record_friction(Event::Kind::slip, slip);
    record_friction(Event::Kind::reversal, reversal);
    record_friction(Event::Kind::release, released, !released.within(unlatched).empty());
    if (outcome_) return;
    enter_phase();
    begin_stretch(mode, run_.options.end_time);
}

void ExecutionAutomaton::record_friction(Event::Kind kind, ContactSet contacts, bool ends_latch) {
    if (contacts.empty() || outcome_) return;
    if (kind != Event::Kind::release && ++friction_events_ > run_.options.max_events)
        return stop(Outcome::Kind::too_many_events, fmt::format("{} sticks, slips and reversals by t = {:.9g}",
                                                                run_.options.max_events, next_.state.t));
    Event event;
    event.kind = kind;
    event.contacts = contacts;
    event.ends_latch = ends_latch;
    event.mode = next_.mode;
    event.t = next_.state.t;
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    record_.event(std::move(event));
}

// Ends the run where coefficients leave the domain of their law. Called at ends of steps, which are shortened to it,
// and at events; the values at the start of a run are checked with its input. False if the run ends.
bool ExecutionAutomaton::check_friction_levels(ContactSet contacts_and_joints) {
    for (const std::size_t i : contacts_and_joints.within(surfaces_->varying())) {
        const ContactCache::FrictionLevels levels = surfaces_->friction_levels(i, next_.state);
        if (levels.are_allowed()) continue;
        const std::string text =
            certainly_negative(levels.present)
                ? fmt::format("the {} of {} falls below 0 at the slip {:.6g}", is_joint(i) ? "level" : "friction",
                              name_of(i), surfaces_->slip(i, next_.state).u)
                : fmt::format("the static {0} of {1} falls below its {0} at slip 0, {2:.6g}",
                              is_joint(i) ? "level" : "friction", name_of(i), mid(levels.at_rest));
        stop(Outcome::Kind::left_the_domain, fmt::format("{}, at {}", text, where(next_.state)));
    }
    return !outcome_;
}

// The slips of these rows, with the numbers of Painleve's paradox: W_sigma of what slides, and the free acceleration of
// its gap.
std::string ExecutionAutomaton::slips_text(const ContactRows& rows, Mode sliding) const {
    std::string text;
    for (const auto& [i, slip] : rows.slips) {
        const int sign = slip_sign(sliding.state(i));
        text += fmt::format("{}{} {} at u = {:.6g}", text.empty() ? "" : ", ", name_of(i), sign != 0 ? "slides" : "is",
                            slip.u);
        if (sign == 0 || is_joint(i)) continue;
        const Eigen::Index gap = rows.gap_of(i);
        const double W = rows.W(gap, gap) - sign * slip.coefficient * rows.W(gap, rows.slip_of(i));
        text += fmt::format(" with W = {:.6g} and the free acceleration {:.6g} of its gap", W,
                            rows.rows[static_cast<std::size_t>(gap)].acceleration);
    }
    return text;
}

// ---- decision ----

// The closed contacts and joints to be decided, with the states that they may take. In `sliding` those with u = 0 are
// held, the others slip. `base`: the mode of the joints whose forces are known.
FrictionProblem ExecutionAutomaton::friction_problem(const ContactRows& rows, ContactSet decided, Mode sliding,
                                                     Mode base, const std::optional<SlipStart>& start) {
    using enum ContactState;
    FrictionProblem problem;
    problem.W = rows.W;
    problem.accelerations.resize(rows.size());
    for (Eigen::Index k = 0; k < rows.size(); ++k)
        problem.accelerations[k] = rows.rows[static_cast<std::size_t>(k)].acceleration;
    ContactSet starting;
    if (start) starting = sharing_with(sliding, start->which, model_->equations().friction).with(start->which);
    for (const std::size_t i : decided) {
        FrictionProblem::Element each{i, rows.gap_of(i), rows.slip_of(i), 0.0, 0.0, false, {}};
        if (!is_joint(i)) each.states.push_back(open);
        if (each.slip < 0) {
            each.states.push_back(held);
            problem.elements.push_back(each);
            continue;
        }
        const Slip& slip = rows.slips.at(i);
        each.slides = slip_sign(sliding.state(i)) != 0;
        each.sliding = each.slides ? slip.coefficient : surfaces_->slip(i, next_.state, base, 0.0).coefficient;
        each.resting = slip.static_coefficient;
        const bool never = surfaces_->never_slides(i);
        if (never) each.resting = std::numeric_limits<double>::infinity();
        if (each.slides) {
            each.states.push_back(sliding.state(i));
        } else if (starting.contains(i)) {
            each.states.push_back(slip_state(start->sign));
        } else {
            each.states.push_back(held);
            if (!never) each.states.insert(each.states.end(), {slip_plus, slip_minus});
        }
        problem.elements.push_back(each);
    }
    group_equal_slips(problem);
    return problem;
}

// Ends the run where rigid bodies have no motion (`none`), or several.
void ExecutionAutomaton::stop_at_paradox(const FrictionProblem& problem, const std::string& slips, bool none) {
    const bool pulls = none && std::any_of(problem.elements.begin(), problem.elements.end(),
                                           [](const auto& each) { return std::isinf(each.resting); });
    stop(Outcome::Kind::painleve,
         fmt::format("{}: rigid bodies with this friction have {} motion from here{}, at {}", slips,
                     none ? "no" : "more than one", pulls ? ": a foot that never slides would have to pull" : "",
                     where(next_.state)));
}

// Ends the run where the forces of the chosen mode are not unique, or else the mode is not proved.
void ExecutionAutomaton::stop_in_doubt(const FrictionProblem& problem, bool are_forces_unique) {
    std::string names;
    for (const FrictionProblem::Element& each : problem.elements)
        names += (names.empty() ? "" : ", ") + name_of(each.which);
    if (slides_along_normal(problem))
        stop(Outcome::Kind::redundant_contacts,
             fmt::format("the slip of {} is a multiple of its gap rate, so that its forces are not unique while it "
                         "sticks, at {}",
                         names, where(next_.state)));
    else if (const auto pair = joints_with_one_slip(problem); !are_forces_unique && pair)
        stop(
            Outcome::Kind::redundant_contacts,
            fmt::format("{} and {} stick with one slip, and only the sum of their friction forces is determined; write "
                        "one [[friction]] for both, at {}",
                        name_of(pair->first), name_of(pair->second), where(next_.state)));
    else if (!are_forces_unique)
        stop(Outcome::Kind::redundant_contacts,
             fmt::format("the forces of {} are not unique while they stick, at {}", names, where(next_.state)));
    else
        stop(Outcome::Kind::undecided,
             fmt::format("a force, or the acceleration of a gap or slip, is zero to within rounding: cannot decide "
                         "whether {} sticks, slides or leaves, at {}",
                         names, where(next_.state)));
}

// Decides the modes of closed contacts and of all joints. In `sliding`, those with u = 0 are held or open, the others
// slip. With `start`, that one must slip with this sign. Sets the mode and the starts of next_; false if the run ends.
bool ExecutionAutomaton::decide_with_friction(ContactSet closed, Mode sliding, std::optional<SlipStart> start) {
    forget_held();
    closed = closed.without(next_.latched);
    const ContactSet joints = all_joints(), rough = closed.with(joints).within(surfaces_->rough());
    if (!check_friction_levels(rough)) return false;
    Mode base = latched_mode();  // with the joints that slip: their forces are known
    for (const std::size_t i : joints)
        if (slip_sign(sliding.state(i)) != 0) base = base.with(i, sliding.state(i));
    base = with_forces_of_now(base, closed);
    const ContactSet decided = closed.with(joints).without(base.slipping());
    if (decided.within(surfaces_->rough()).count() > max_rough || closed.count() > max_closed_contacts) {
        stop(Outcome::Kind::redundant_contacts,
             fmt::format("{} contacts and joints with friction are closed or at rest at once, and at most {} can be "
                         "resolved, at {}",
                         decided.count(), max_rough, where(next_.state)));
        return false;
    }
    if (decided.empty()) {
        next_.mode = base.without(base.acting());
        return true;
    }
    const ContactRows rows = surfaces_->rows(next_.state, closed, rough.without(base.slipping()), base);
    const FrictionProblem problem = friction_problem(rows, decided, sliding, base, start);
    const FrictionChoice choice = choose_mode(problem);
    if (choice.kind == FrictionChoice::Kind::none || choice.kind == FrictionChoice::Kind::several) {
        stop_at_paradox(problem, slips_text(rows, sliding), choice.kind == FrictionChoice::Kind::none);
        return false;
    }
    const FrictionMotion& chosen = choice.motions.front();
    Mode mode = base.without(base.acting());
    for (const FrictionProblem::Element& each : problem.elements)
        mode = mode.with(each.which, chosen.mode.state(each.which));
    for (const std::size_t i : implied_slips(problem, chosen.mode)) mode = mode.with_implied_slip(i);
    if (choice.kind == FrictionChoice::Kind::undecided || !chosen.is_unique || !is_proved(mode, closed, sliding)) {
        stop_in_doubt(problem, chosen.is_unique);
        return false;
    }
    next_.mode = mode;
    for (const std::size_t i : closed) {
        next_.starts[i] = {};
        if (!mode.is_held(i)) next_.starts[i] = {{0.0, 0.0}, 2};
    }
    for (const FrictionProblem::Element& each : problem.elements)
        if (slip_sign(mode.state(each.which)) != 0 && !each.slides) slip_roots_[each.which] = 1;
    return true;
}

// Whether the signs that the mode requires are certain over the rounding box of the state.
bool ExecutionAutomaton::is_proved(Mode mode, ContactSet closed, Mode sliding) {
    ModeKinematics& motion = surfaces_->motion(mode);
    const auto values = motion.enclosed(next_.state);
    for (const std::size_t i : closed) {
        const Interval& value = values[i].value;
        if (mode.is_held(i) ? !certainly_negative(value) : !certainly_positive(value)) return false;
    }
    for (std::size_t k = 0; k < motion.friction().size(); ++k) {
        const FrictionEvent& event = motion.friction()[k];
        const auto& value = values[surfaces_->count() + k];
        const bool starts = event.watched == FrictionFunction::slip && slip_sign(sliding.state(event.contact)) == 0;
        if (event.watched == FrictionFunction::slip && !starts) continue;
        if (!certainly_positive(starts ? value.rate : value.value)) return false;
    }
    return true;
}

}  // namespace achilles
