#include "model/friction_bouncing.hpp"

#include <algorithm>

#include "model/rows.hpp"

namespace achilles {

namespace {

// Whether the contact sticks at its impacts, rather than sliding or having no friction.
bool sticks(const BouncingKey& key, const FrictionLaws& laws) {
    return key.state == ContactState::held && laws.contains(key.contact);
}

// n_sigma = M^-1 (g' - sigma mu d')/W_sigma and W_sigma, with the coefficient at a given speed.
struct SlidingDirection {
    Row n;
    Expression W;
};
SlidingDirection sliding_direction(const ModeEquations& flight, std::size_t contact, int sign, Expression coefficient) {
    const ContactEquations& c = flight.contacts[contact];
    const SlipEquations& s = flight.slips.at(contact);
    const Expression factor = c.hddot.graph().number(sign) * coefficient;
    SlidingDirection result{{}, c.delassus[contact] - factor * s.on_gaps[contact]};
    for (std::size_t i = 0; i < c.impulse.size(); ++i) {
        const Expression impulse = c.impulse[i] - factor * s.impulse[i];
        result.n.push_back(impulse.is_zero() ? impulse : cancelled(impulse / result.W));
    }
    return result;
}

struct SlidingContact {
    BouncingContact contact;
    Expression W;
};
// The contact while it slides with this sign at its impacts. They take the coefficient at the slip of s.
SlidingContact sliding_contact(const BouncingKey& key, ContactModes& modes, const Layout& layout) {
    const ModeEquations& flight = modes.of(key.mode);
    const FrictionLaw& law = modes.friction().at(key.contact);
    const int sign = slip_sign(key.state);
    const std::uint32_t speed[] = {layout.sliding_speed()};
    const Expression value[] = {modes.graph().number(sign) * law.slip};
    const SlidingDirection general = sliding_direction(flight, key.contact, sign, law.level);
    const auto at_slip = [&](Expression x) { return substitute(x, speed, value); };
    SlidingContact result{{flight.contacts[key.contact].hddot, flight.f, {}, {}, {}, {}}, at_slip(general.W)};
    BouncingContact& contact = result.contact;
    for (std::size_t i = 0; i < general.n.size(); ++i) {
        contact.n.push_back(at_slip(general.n[i]));
        contact.f_c.push_back(flight.f[i] - contact.n[i] * contact.hddot);
    }
    if (!depends_on(law.level, speed)) return result;
    contact.d = law.d;
    for (const Expression n : general.n)
        contact.n_u.push_back(modes.graph().number(sign) * at_slip(derivative(n, speed[0])));
    return result;
}

// N = M^-1 [g', d'] W^-1, so that (hdot, u) = (G; D) N sigma = sigma. Other contacts that slide make W unsymmetric.
struct StickingDirections {
    std::array<Row, 2> N;
    Row W;  // W_NN, W_NT, W_TT
    Expression W_TN, det;
};
StickingDirections sticking_directions(const BouncingKey& key, ContactModes& modes) {
    const ModeEquations& flight = modes.of(key.mode);
    const ContactEquations& c = flight.contacts[key.contact];
    const SlipEquations& s = flight.slips.at(key.contact);
    const bool is_symmetric = key.mode.slipping().within(key.mode.held()).empty();
    StickingDirections result;
    result.W = {c.delassus[key.contact], s.on_gaps[key.contact], s.on_slips.at(key.contact)};
    result.W_TN = is_symmetric ? result.W[1] : c.on_slips.at(key.contact);
    const Row& W = result.W;
    result.det = W[0] * W[2] - W[1] * result.W_TN;
    if (result.det.is_zero()) return result;  // an obstacle
    if (W[1].is_zero() && result.W_TN.is_zero()) {
        for (std::size_t i = 0; i < c.impulse.size(); ++i) {
            result.N[0].push_back(c.impulse[i].is_zero() ? c.impulse[i] : cancelled(c.impulse[i] / W[0]));
            result.N[1].push_back(s.impulse[i].is_zero() ? s.impulse[i] : cancelled(s.impulse[i] / W[2]));
        }
        return result;
    }
    for (std::size_t i = 0; i < c.impulse.size(); ++i) {
        result.N[0].push_back((c.impulse[i] * W[2] - s.impulse[i] * result.W_TN) / result.det);
        result.N[1].push_back((s.impulse[i] * W[0] - c.impulse[i] * W[1]) / result.det);
    }
    return result;
}

BouncingModel sticking_model(const BouncingKey& key, ContactModes& modes, const Equations& equations,
                             const Layout& layout) {
    const ModeEquations& flight = modes.of(key.mode);
    const Row& A = modes.of(key.mode.with(key.contact, ContactState::held)).f;
    const StickingDirections directions = sticking_directions(key, modes);
    const std::vector<std::uint32_t> q = slots_from(layout.q(0), layout.dof), v = slots_from(layout.v(0), layout.dof);
    const Row s = symbols(v, modes.graph()), velocity = pair_velocity(directions.N, layout);
    const Expression hddot = flight.contacts[key.contact].hddot;
    const Row accelerations = at_velocity({hddot, flight.slips.at(key.contact).udot}, v, velocity);
    const Row by_v = gradient(hddot, v);
    const Expression rate = product(gradient(hddot, q), s) + product(by_v, A) + derivative(hddot, layout.t());
    BouncingModel result;
    result.variables = q;
    result.variables.insert(result.variables.end(), v.begin(), v.end());
    result.variables.insert(result.variables.end(), {layout.sigma(), layout.second_sigma()});
    if (!equations.autonomous) result.variables.push_back(layout.t());
    result.trend = TypedProgram<TrendTerms>::of(layout.slots(), hddot, rate, product(by_v, directions.N[0]),
                                                Row{product(by_v, directions.N[1])});
    result.sticking = derive_pair_terms(A, directions.N, accelerations, directions.W, !equations.quadratic_in_rates,
                                        layout, {directions.W_TN});
    return result;
}

// The velocity at hdot = sigma (and u = second sigma), and what friction requires.
class FrictionConditionsBuilder {
 public:
    FrictionConditionsBuilder(const BouncingKey& key, ContactModes& modes, const Layout& layout)
        : key_(key),
          modes_(modes),
          layout_(layout),
          v_(slots_from(layout.v(0), layout.dof)),
          sticks_(sticks(key, modes.friction())) {
        Graph& graph = modes.graph();
        const int sign = slip_sign(key.state);
        const Expression sigma = graph.symbol(layout.sigma());
        if (sticks_) {
            velocity_ = pair_velocity(sticking_directions(key, modes).N, layout);
            return;
        }
        if (sign != 0) sliding_ = sliding_contact(key, modes, layout);
        const Row n = sliding_ ? sliding_->contact.n : modes.of(key.mode).contacts.at(key.contact).direction;
        for (std::size_t i = 0; i < layout.dof; ++i) velocity_.push_back(graph.symbol(v_[i]) + n[i] * sigma);
        if (!sliding_) return;
        require(sliding_->W, {key.contact, "is not proved to have a motion while it slides"});
        require(graph.number(sign) * at_flight(modes.friction().at(key.contact).slip), {key.contact, turns_back});
        if (!sliding_->contact.n_u.empty())
            require(graph.number(1) + sigma * product(sliding_->contact.d, sliding_->contact.n_u),
                    {key.contact, "is not proved to have one impulse, because its friction depends on the slip"});
    }

    const Row& velocity() const { return velocity_; }

    FrictionConditions conditions() {
        require_watched(key_.mode);
        for (const std::size_t j : key_.mode.held()) add_held(j);
        if (sticks_ && !key_.mode.is_free()) {
            // At rest the friction force of the bouncing contact is another part of its normal force than at impacts.
            const Mode closed = key_.mode.with(key_.contact, key_.state);
            for (const std::size_t j : key_.mode.held()) {
                const FrictionForce force = modes_.force_of(j, closed);
                require(at_flight(force.lambda), {j, "is not proved to stay pressed when the bouncing has ended"});
                require(at_flight(force.scale), {j, no_motion});
            }
            require_watched(closed);
        }
        return result_;
    }

    ImpactLawTerms impact_law(const Equations& equations) const;

 private:
    static constexpr std::string_view turns_back = "is not proved to keep the direction of its slip",
                                      no_motion = "is not proved to have a motion";

    Expression at_flight(Expression x) const { return substitute(x, v_, velocity_); }
    void require(Expression positive, BouncingObstacle condition) {
        result_.positive.push_back(positive);
        result_.conditions.push_back(condition);
    }
    // What friction watches of the other contacts and of joints.
    void require_watched(Mode mode) {
        const WatchedFriction watched = modes_.watched_friction(modes_.of(mode));
        for (std::size_t k = 0; k < watched.events.size(); ++k) {
            const FrictionEvent& event = watched.events[k];
            if (event.contact == key_.contact) continue;
            const bool slides = event.watched == FrictionFunction::slip;
            require(at_flight(watched.functions[k]), {event.contact, slides ? turns_back
                                                                     : event.watched == FrictionFunction::pivot
                                                                         ? no_motion
                                                                         : "is not proved to stick between impacts"});
        }
    }
    // The accelerations of gap and slip of a held contact by a unit impulse on the bouncing one, with its friction.
    RowAccelerations by_impulse(const ModeEquations& before, std::size_t held) const {
        RowAccelerations result = by_normal_force(before, held, key_.contact);
        Graph& graph = modes_.graph();
        Expression ratio;  // p_T/p
        if (sticks_) {
            ratio = graph.symbol(layout_.impulse_ratio());
        } else if (sliding_) {
            const Expression slip = modes_.friction().at(key_.contact).slip, sign = graph.number(slip_sign(key_.state)),
                             speed = sign * slip;
            const std::uint32_t slot[] = {layout_.sliding_speed()};
            ratio = -sign * substitute(modes_.friction().at(key_.contact).level, slot, {&speed, 1});
        } else {
            return result;
        }
        const RowAccelerations tangential = by_friction_force(before, held, key_.contact);
        result.gap = result.gap + ratio * tangential.gap;
        if (before.slips.contains(held)) result.slip = result.slip + ratio * tangential.slip;
        return result;
    }
    void add_held(std::size_t j) {
        const ModeEquations& before = modes_.of(key_.mode.without(j));
        const FrictionLaws& laws = modes_.friction();
        const FrictionForce force = friction_force(before, j, key_.mode, laws, layout_),
                            passed_on = reaction(before, j, key_.mode, laws, layout_, by_impulse(before, j));
        const bool rests = laws.contains(j) && key_.mode.state(j) == ContactState::held;
        const Expression kappa = passed_on.lambda / passed_on.scale;
        Expression W = force.scale;
        if (rests) {
            const SlipEquations& s = before.slips.at(j);
            const Expression W_NT = s.on_gaps[j], W_TN = before.contacts[j].on_slips.at(j);
            W = before.contacts[j].delassus[j];
            if (!W_NT.is_zero()) W = W - W_NT * W_TN / s.on_slips.at(j);
        }
        result_.held[j] = {at_flight(negative_force(before, j, key_.mode, laws)), at_flight(W), at_flight(kappa)};
        if (!rests || laws.at(j).never_slides) return;
        const Expression most = laws.at(j).level * kappa, tau = passed_on.tau / passed_on.scale;
        result_.cones.insert(result_.cones.end(), {at_flight(most - tau), at_flight(most + tau)});
        result_.contacts_with_cone.push_back(j);
    }

    const BouncingKey& key_;
    ContactModes& modes_;
    const Layout& layout_;
    std::vector<std::uint32_t> v_;
    bool sticks_;
    std::optional<SlidingContact> sliding_;
    Row velocity_;
    FrictionConditions result_;
};

// The rates before an impact are 0 for held gaps and slips that stick.
ImpactLawTerms FrictionConditionsBuilder::impact_law(const Equations& equations) const {
    ImpactLawTerms result;
    const ModeEquations& free = modes_.of({});
    Graph& graph = modes_.graph();
    struct PlacedRow {
        std::size_t which;
        bool is_slip;
    };
    std::vector<PlacedRow> rows;
    Row rates, levels;
    const ContactSet closed = key_.mode.held().with(key_.contact);
    const std::uint32_t speed[] = {layout_.sliding_speed()};
    bool is_rough = false;
    for (const std::size_t i : closed.with(key_.mode.elements_in(ContactState::held))) {
        ImpactLawTerms::Element each{i};
        const auto law = modes_.friction().find(i);
        const bool bounces = i == key_.contact;
        if (!is_joint(i)) {
            each.gap = static_cast<int>(rows.size());
            rows.push_back({i, false});
            rates.push_back(bounces ? graph.symbol(layout_.sigma()) : graph.number(0));
            each.has_moving_surface = !free.contacts[i].gap_t.is_zero();
        }
        if (law != modes_.friction().end()) {
            is_rough = true;
            each.slip = static_cast<int>(rows.size());
            rows.push_back({i, true});
            const ContactState state = bounces ? key_.state : key_.mode.state(i);
            each.slides = slip_sign(state) != 0;
            each.never_slides = law->second.never_slides;
            each.depends_on_speed = depends_on(law->second.level, speed);
            each.has_moving_surface = each.has_moving_surface || !law->second.c.is_zero();
            const bool moves = each.slides || bounces;
            rates.push_back(moves ? at_flight(law->second.slip) : graph.number(0));
            levels.insert(levels.end(), {law->second.level, law->second.static_level});
        }
        result.elements.push_back(each);
    }
    if (!is_rough || key_.mode.is_free()) return {};
    Row W;
    for (const PlacedRow& a : rows)
        for (const PlacedRow& b : rows) {
            if (b.is_slip)
                W.push_back(a.is_slip ? free.slips.at(b.which).on_slips.at(a.which)
                                      : free.slips.at(b.which).on_gaps[a.which]);
            else
                W.push_back(a.is_slip ? free.contacts[b.which].on_slips.at(a.which)
                                      : free.contacts[b.which].delassus[a.which]);
        }
    result.rows = rows.size();
    const Expression doubled = graph.number(2) * at_flight(graph.adopt(equations.kinetic));
    result.program = Program(joined({W, rates, levels, {doubled}}), layout_.slots());
    return result;
}

}  // namespace

std::optional<BouncingObstacle> obstacle_to_bouncing(const BouncingKey& key, ContactModes& modes,
                                                     const Layout& layout) {
    const ContactSet implied = key.mode.implied();
    if (!implied.empty()) return BouncingObstacle{*implied.begin(), "sticks with the slip of another contact"};
    const bool has_law = modes.friction().contains(key.contact);
    const Mode sliding = key.mode.without(key.mode.elements_in(ContactState::held).within(key.mode.joints()));
    const ModeEquations& free = modes.of(sliding);
    for (const std::size_t joint : key.mode.joints()) {
        if (slip_sign(key.mode.state(joint)) != 0) continue;
        const bool feels_gap = !free.contacts[key.contact].on_slips.at(joint).is_zero(),
                   feels_slip = has_law && !free.slips.at(key.contact).on_slips.at(joint).is_zero();
        if (feels_gap || feels_slip) return BouncingObstacle{joint, "sticks and feels the impulses"};
    }
    if (key.mode.is_free()) return std::nullopt;
    const ModeEquations& flight = modes.of(key.mode);
    Row columns = flight.contacts[key.contact].impulse;
    if (has_law) columns = joined({columns, flight.slips.at(key.contact).impulse});
    const std::vector<std::uint32_t> v = slots_from(layout.v(0), layout.dof);
    const bool depend = std::any_of(columns.begin(), columns.end(), [&](Expression x) { return depends_on(x, v); });
    const std::uint32_t speed[] = {layout.sliding_speed()};
    for (const std::size_t j : key.mode.slipping().within(key.mode.held()))
        if (depend && depends_on(modes.friction().at(j).level, speed))
            return BouncingObstacle{j, "slides with a friction that depends on its slip, and feels the impulses"};
    const bool is_fixed = flight.contacts[key.contact].delassus[key.contact].is_zero() ||
                          (sticks(key, modes.friction()) && sticking_directions(key, modes).det.is_zero());
    if (is_fixed) return BouncingObstacle{key.contact, "cannot move while the others are held"};
    return std::nullopt;
}

BouncingModel derive_bouncing(const BouncingKey& key, ContactModes& modes, const Equations& equations,
                              const Layout& layout) {
    if (sticks(key, modes.friction())) return sticking_model(key, modes, equations, layout);
    if (slip_sign(key.state) != 0)
        return derive_bouncing(sliding_contact(key, modes, layout).contact, equations, layout);
    const ContactEquations& c = modes.of(key.mode).contacts.at(key.contact);
    return derive_bouncing({c.hddot, {}, c.f_c, c.direction, {}, {}}, equations, layout);
}

OtherContactTerms derive_other_contacts(const BouncingKey& key, ContactModes& modes, const Equations& equations,
                                        const Layout& layout) {
    if (modes.friction().empty()) return derive_other_contacts(key.contact, key.mode, modes, layout);
    FrictionConditionsBuilder friction(key, modes, layout);
    OtherContactTerms result =
        derive_other_contacts({key.contact}, key.mode, friction.velocity(), modes, layout, friction.conditions());
    result.impact_law = friction.impact_law(equations);
    return result;
}

bool slides_evenly(std::size_t contact, ContactState state, const FrictionLaws& laws, const Layout& layout) {
    const auto law = laws.find(contact);
    if (law == laws.end()) return true;
    const std::uint32_t speed[] = {layout.sliding_speed()};
    return slip_sign(state) != 0 && !law->second.never_slides && !depends_on(law->second.level, speed);
}

PairPrograms derive_sliding_pair(std::size_t first, std::size_t second, Mode closed, ContactModes& modes,
                                 const Equations& equations, const Layout& layout) {
    const std::array<std::size_t, 2> pair{first, second};
    const Mode others = closed.without(ContactSet::of(first).with(second));
    const ModeEquations& flight = modes.of(others);
    Graph& graph = modes.graph();
    const std::vector<std::uint32_t> v = slots_from(layout.v(0), layout.dof);
    std::array<Row, 2> N;
    std::array<std::array<Expression, 2>, 2> W;
    for (std::size_t l = 0; l < 2; ++l) {
        const auto law = modes.friction().find(pair[l]);
        // The direction of the impulses, with the reaction of the other contact.
        const ModeEquations& with_other = modes.of(closed.without(pair[l]));
        if (law == modes.friction().end()) {
            N[l] = with_other.contacts[pair[l]].direction;
            for (std::size_t k = 0; k < 2; ++k) W[k][l] = flight.contacts[pair[l]].delassus[pair[k]];
            continue;
        }
        const int sign = slip_sign(closed.state(pair[l]));
        N[l] = sliding_direction(with_other, pair[l], sign, law->second.level).n;
        const Expression factor = graph.number(sign) * law->second.level;
        for (std::size_t k = 0; k < 2; ++k)
            W[k][l] = flight.contacts[pair[l]].delassus[pair[k]] - factor * flight.slips.at(pair[l]).on_gaps[pair[k]];
    }
    const Row velocity = pair_velocity(N, layout), free{flight.contacts[first].hddot, flight.contacts[second].hddot};
    Row A;
    for (std::size_t i = 0; i < layout.dof; ++i) A.push_back(flight.f[i] - N[0][i] * free[0] - N[1][i] * free[1]);
    PairPrograms result;
    Row slips;
    for (const std::size_t k : pair) {
        const auto law = modes.friction().find(k);
        if (law == modes.friction().end()) continue;
        const Expression sign = graph.number(slip_sign(closed.state(k)));
        slips.push_back(sign * law->second.slip);
        for (const Row& direction : N) slips.push_back(sign * product(law->second.d, direction));
        ++result.sliding;
    }
    result.slips = Program(slips, layout.slots());
    result.terms = derive_pair_terms(A, N, at_velocity(free, v, velocity), {W[0][0], W[0][1], W[1][1]},
                                     !equations.quadratic_in_rates, layout, {W[1][0]});
    result.others = derive_other_contacts({first, second}, others, velocity, modes, layout);
    return result;
}

}  // namespace achilles
