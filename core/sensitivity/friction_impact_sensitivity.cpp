// The effect of an impact with dry friction on a small change (theory-friction.md 3, 6). The branch of every loaded
// contact is that of the run: it sticks, or slides to one side. In it the impulses obey equations, which are
// differentiated:
//
//     gap     (1 + e) hdot- + (W P)_N = 0
//     stick   u- + (W P)_T = 0
//     slip    P_T + sigma mu(u_s) P_N = 0,    u_s = (u+ + e u-)/(1 + e)
#include <algorithm>
#include <cmath>

#include "certify/truncation.hpp"
#include "contacts/impact_law.hpp"
#include "number/dense.hpp"
#include "sensitivity/chain.hpp"

namespace achilles {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;

namespace {

constexpr double branch_tolerance = 1e-10;  // relative to the size of an impact; below it a branch may change

double impulse_of(const std::vector<std::pair<std::size_t, double>>& impulses, std::size_t contact) {
    for (const auto& [which, impulse] : impulses)
        if (which == contact) return impulse;
    return 0.0;
}

}  // namespace

// The gaps and slips of the loaded contacts, with derivatives by the components before the impact.
struct Chain::ImpactRows {
    struct Row {
        double impulse = 0.0, rate = 0.0;
        RowVectorXd rate_row;
        VectorXd gradient, direction;             // G and M^-1 G', by coordinate
        RowMatrix gradient_rows, direction_rows;  // their derivatives
        // For a gap, its restitution. For a slip, the row of its gap, and the sign: 0 if it sticks.
        double e = 0.0;
        RowVectorXd e_row;
        std::size_t gap = 0;
        bool is_slip = false;
        int sign = 0;
        double coefficient = 0.0, coefficient_rate = 0.0;  // mu, and its derivative by u_s
        RowVectorXd coefficient_row;                       // at a fixed u_s
    };
    std::size_t landing;
    ContactSet loaded;  // besides the landing contact
    std::vector<Row> rows;

    double W(std::size_t i, std::size_t j) const { return rows[i].gradient.dot(rows[j].direction); }
    // The rate after the impact minus that before it, and its derivative at fixed impulses.
    double jump(std::size_t i) const {
        double sum = 0.0;
        for (std::size_t j = 0; j < rows.size(); ++j) sum += W(i, j) * rows[j].impulse;
        return sum;
    }
    RowVectorXd jump_row(std::size_t i) const {
        RowVectorXd sum = RowVectorXd::Zero(rows[i].rate_row.size());
        for (const Row& other : rows)
            sum += other.impulse * (other.direction.transpose() * rows[i].gradient_rows +
                                    rows[i].gradient.transpose() * other.direction_rows);
        return sum;
    }
    // dP: the equations above are A dP + b = 0.
    MatrixXd impulse_rows() const;
    // The derivative of v+ - v-.
    RowMatrix velocity_rows() const;
    // v+ - v-
    VectorXd velocity_jump() const {
        VectorXd sum = VectorXd::Zero(rows.front().direction.size());
        for (const Row& row : rows) sum += row.impulse * row.direction;
        return sum;
    }
    // The impact after which the gaps stay closed, in the same branch: restitution 0. u_s is the same, and so is mu.
    ImpactRows plastic() const;
};

MatrixXd Chain::ImpactRows::impulse_rows() const {
    const auto count = static_cast<Index>(rows.size());
    MatrixXd A(count, count), b(count, rows.front().rate_row.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto k = static_cast<Index>(i);
        const Row& row = rows[i];
        RowVectorXd by_impulses(count);
        for (Index j = 0; j < count; ++j) by_impulses[j] = W(i, static_cast<std::size_t>(j));
        const RowVectorXd changed = jump_row(i);
        if (!row.is_slip) {
            A.row(k) = by_impulses;
            b.row(k) = (1.0 + row.e) * row.rate_row + row.rate * row.e_row + changed;
        } else if (row.sign == 0) {
            A.row(k) = by_impulses;
            b.row(k) = row.rate_row + changed;
        } else {
            const double p = row.sign * rows[row.gap].impulse, once = 1.0 + row.e, u = row.rate + jump(i) / once;
            const double by_speed = p * row.coefficient_rate * (u < 0.0 ? -1.0 : 1.0);
            A.row(k) = by_speed / once * by_impulses;
            A(k, k) += 1.0;
            A(k, static_cast<Index>(row.gap)) += row.sign * row.coefficient;
            b.row(k) = p * row.coefficient_row +
                       by_speed * (row.rate_row + changed / once - jump(i) / (once * once) * row.e_row);
        }
    }
    return -least_solution(A, b);
}

RowMatrix Chain::ImpactRows::velocity_rows() const {
    const MatrixXd impulses = impulse_rows();
    RowMatrix change = RowMatrix::Zero(rows.front().direction.size(), impulses.cols());
    for (std::size_t i = 0; i < rows.size(); ++i)
        change += rows[i].direction * impulses.row(static_cast<Index>(i)) + rows[i].impulse * rows[i].direction_rows;
    return change;
}

Chain::ImpactRows Chain::ImpactRows::plastic() const {
    const auto count = static_cast<Index>(rows.size());
    MatrixXd A(count, count);
    VectorXd b(count);
    for (Index i = 0; i < count; ++i) {
        const Row& row = rows[static_cast<std::size_t>(i)];
        const bool slides = row.is_slip && row.sign != 0;
        for (Index j = 0; j < count; ++j)
            A(i, j) = slides ? 0.0 : W(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
        if (slides) {
            A(i, i) = 1.0;
            A(i, static_cast<Index>(row.gap)) = row.sign * row.coefficient;
        }
        b[i] = slides ? 0.0 : -row.rate;
    }
    const VectorXd impulses = least_solution(A, b);
    ImpactRows result = *this;
    for (Index i = 0; i < count; ++i) {
        Row& row = result.rows[static_cast<std::size_t>(i)];
        row.impulse = impulses[i];
        row.e = 0.0;
        row.e_row.setZero();
    }
    return result;
}

// mu'(u_s)
double Chain::coefficient_rate(std::size_t which, double speed) {
    const std::uint32_t slot = model_->layout().sliding_speed();
    auto& [program, rate] = coefficient_rates_[which];
    if (!rate) {
        Graph graph(model_->equations().energy.graph());  // a copy, because threads share the model
        const Expression change = derivative(graph.adopt(model_->equations().friction.at(which).level), slot);
        program = Program(std::span(&change, 1), model_->layout().slots());
        rate = model_->evaluator(program, trajectory_->run.parameters);
    }
    set_state(*rate, state_);
    rate->input(slot) = speed;
    rate->run();
    return rate->output(0);
}

// Adds the gap of the landing contact and of those that the impact loads, with their slips. Breaks off and returns
// false where a small change may load others.
bool Chain::add_loaded_contacts(const Event& now, ContactSet latched, ImpactRows& impact) {
    double scale = 0.0;
    for (const auto& [contact, impulse] : now.joint->impulses) scale = std::max(scale, impulse);
    for (const auto& [contact, impulse] : now.joint->impulses) {
        const bool lands = contact == impact.landing;
        if (!lands && !mode_.is_held(contact)) {
            break_off("a contact that is closed without a force takes part in an impact");
            return false;
        }
        const bool is_latched = latched.contains(contact);  // loaded by an impulse of either sign
        if (!lands && !is_latched && !(impulse > branch_tolerance * scale)) {
            if (surfaces_.of(contact).at({now.q, now.v_after, now.t}).hdot > branch_tolerance * now.impact_speed)
                continue;
            break_off("an impact neither loads a held contact nor opens it");
            return false;
        }
        if (!lands) impact.loaded = impact.loaded.with(contact);
        ContactGradient& gap = surface(contact, {});
        gap.at(state_);
        ImpactRows::Row& row = impact.rows.emplace_back();
        row.impulse = impulse;
        row.rate = lands ? -now.impact_speed : 0.0;
        row.rate_row = RowVectorXd::Zero(tangent_.size());
        row.gap = impact.rows.size() - 1;
        row.rate_row[tangent_.u(contact)] = 1.0;  // a held contact has u' = 0
        row.e = surfaces_.restitution(contact).value;
        row.e_row = restitution(contact).row(0);
        const auto n = static_cast<Index>(tangent_.dof);
        row.gradient.resize(n);
        row.direction.resize(n);
        row.gradient_rows.resize(n, tangent_.size());
        row.direction_rows.resize(n, tangent_.size());
        for (std::size_t i = 0; i < tangent_.dof; ++i) {
            const auto k = static_cast<Index>(i);
            row.gradient[k] = gap.g(i);
            row.direction[k] = gap.W() * gap.n(i);
            row.gradient_rows.row(k) = gap.g_row(i);
            row.direction_rows.row(k) = gap.W() * gap.n_row(i) + gap.n(i) * gap.W_row();
        }
        if (surfaces_.rough().contains(contact) && !add_slip(now, contact, impact)) return false;
    }
    return true;
}

// Adds the slip of the last contact, in the branch of its impulse.
bool Chain::add_slip(const Event& now, std::size_t contact, ImpactRows& impact) {
    ImpactRows::Row row = impact.rows.back();
    const double normal = row.impulse, e = row.e, before = surfaces_.slip(contact, state_).u;
    const double after = surfaces_.slip(contact, {now.q, now.v_after, now.t}).u;
    const double speed = newton::slip_speed(after, e, before);
    SlipGradient& slip = this->slip(contact);
    slip.at(state_, speed);
    row.is_slip = true;
    row.impulse = now.friction ? impulse_of(now.friction->tangential, contact) : 0.0;
    row.rate = mode_.state(contact) == ContactState::held ? 0.0 : before;
    row.rate_row = slip.u_row();
    for (std::size_t i = 0; i < tangent_.dof; ++i) {
        const auto k = static_cast<Index>(i);
        row.gradient[k] = slip.d(i);
        row.direction[k] = slip.impulse(i);
        row.gradient_rows.row(k) = slip.d_row(i);
        row.direction_rows.row(k) = slip.impulse_row(i);
    }
    // The impulse decides, because rounding hides u+ = 0 at small speeds.
    const bool sticks = surfaces_.never_slides(contact) ||
                        std::abs(row.impulse) < (1.0 - branch_tolerance) * slip.coefficient() * normal;
    const double rounding =
        std::max(branch_tolerance * (std::abs(before) + now.impact_speed), 4.0 * surfaces_.slip_error(contact, state_));
    if (!sticks && std::abs(after) <= rounding) {
        break_off(
            "an impact is at the limit between sticking and sliding: the derivatives depend on the direction of "
            "the perturbation");
        return false;
    }
    row.sign = sticks ? 0 : after > 0.0 ? 1 : -1;
    if (!sticks) {
        row.coefficient = slip.coefficient();
        row.coefficient_row = slip.coefficient_row();
        row.coefficient_rate = coefficient_rate(contact, speed);
    }
    impact.rows.push_back(std::move(row));
    return true;
}

void Chain::land_with_friction(std::size_t event) {
    const Event& now = trajectory_->events[event];
    if (now.contacts.count() != 1)
        return break_off(
            "several contacts close at the same time: which is first depends on the direction of the perturbation");
    if (now.friction && now.friction->energy_cap)
        return break_off(
            "an impact would gain energy, and its restitution is reduced: derivatives are not computed past it");
    if (waiting_) return break_off("an impact happens before the Zeno time of another contact");
    ContactSet joins;
    if (auto reason = next_completion(event, joins)) return break_off(std::move(*reason));
    const std::size_t i = now.contacts.only();
    const bool completes = joins.contains(i), rests = completes && surfaces_.restitution(i).value == 0.0;
    ChainLink& crossing = cross_surface(event);
    ImpactRows impact{i, {}, {}};
    if (!add_loaded_contacts(now, latched_before(event), impact)) return;
    if (options_.errors) meet_surface(i, {}, crossing);
    ChainLink& link = add(ChainLink::Kind::jump, event);
    RowMatrix& J = link.J;
    move_onto(J, mode_.held().with(i));  // the rows of q leave it by the omitted terms of steps
    J.row(tangent_.h(i)).setZero();
    if (rests)
        come_to_rest(event, impact, link);
    else if (completes)
        truncate_with_friction({i, mode_.only(impact.loaded), state_of_bouncing(event, i)}, now.impact_speed, impact,
                               link);
    else
        bounce_with_friction(now, impact, J);
    settle(J, mode_);
    set_rate_rows(J, i);
    set_gaps();
    if (mode_.is_held(i)) return;
    h_[i] = 0.0;
    u_[i] = newton::rate_after(surfaces_.restitution(i).value, -now.impact_speed);
}

// J with the rows of v after an impact.
RowMatrix Chain::after_impact(const ImpactRows& impact, const RowMatrix& J) const {
    RowMatrix result = J;
    result.middleRows(tangent_.v(0), static_cast<Index>(tangent_.dof)) += impact.velocity_rows() * J;
    return result;
}

// Sets the rows of v and of the gap rate to those after the impact, and the mode.
void Chain::bounce_with_friction(const Event& now, const ImpactRows& impact, RowMatrix& J) {
    const std::size_t i = impact.landing;
    const double e = surfaces_.restitution(i).value, u = -now.impact_speed;
    const RowVectorXd u_row = J.row(tangent_.u(i));
    state_.v = now.v_after;
    J = after_impact(impact, J);
    J.row(tangent_.u(i)) = -(e * u_row + u * restitution(i).row(0) * J);
    mode_ = now.mode;
}

// With restitution 0 the contact rests from here on; a restitution that grows from 0 moves its Zeno time by 2 w e'/a,
// and nothing else.
void Chain::come_to_rest(std::size_t event, const ImpactRows& impact, ChainLink& link) {
    const Event& now = trajectory_->events[event];
    const std::size_t i = impact.landing;
    if (!options_.errors)
        link.completion = ChainLink::PendingCompletion{
            {i, mode_.only(impact.loaded)}, state_, now.impact_speed, after_impact(impact, link.J)};
    link.J = after_impact(impact.plastic(), link.J);
    state_.v = now.v_after;
    mode_ = trajectory_->events[event + 1].mode;
    const double a = -surfaces_.of(i, mode_.without(i)).normal_acceleration(state_);
    link.J.row(tangent_.accumulation_time()) = 2.0 * now.impact_speed / a * restitution(i).row(0);
    waiting_ = true;
}

// The state in which a contact is held by the motion that replaces its bouncing after this impact.
ContactState Chain::state_of_bouncing(std::size_t event, std::size_t contact) const {
    const auto& events = trajectory_->events;
    const bool waits = event + 1 == events.size() || events[event + 1].t > events[event].t;
    return (waits ? trajectory_->pieces[next_piece_].mode : events[event + 1].mode).state(contact);
}

// The cut of a bouncing sequence that slides or sticks (theory-friction.md 4): the rows of q and s, and of the
// accumulation time. A contact that sticks also drifts: q += n_T I_u, s += C I_u.
void Chain::truncate_with_friction(const BouncingKey& key, double speed, const ImpactRows& impact, ChainLink& link) {
    const ImpactRows plastic = impact.plastic();
    RowMatrix newton = after_impact(impact, link.J);
    link.J = after_impact(plastic, link.J);
    state_.v += plastic.velocity_jump();
    link.completion = ChainLink::PendingCompletion{key, state_, speed, std::move(newton)};
    link.J.row(tangent_.accumulation_time()) = accumulation_time_row(link.J, key, speed);
    if (sticks_at_impacts(*model_, key)) add_drift_of_slip(link.J, key, speed);
    mode_ = mode_after_cut(key.mode.with(key.contact, key.state));
    waiting_ = true;
}

// The terms of a contact that sticks, at hdot = u = 0.
Gradient& Chain::sticking(const BouncingKey& key) {
    auto& known = stickings_[key];
    if (!known)
        known =
            std::make_unique<Gradient>(*model_, model_->bouncing(key).sticking, tangent_, trajectory_->run.parameters);
    known->set_input(model_->layout().sigma(), 0.0);
    known->set_input(model_->layout().second_sigma(), 0.0);
    known->at(state_);
    return *known;
}

void Chain::add_drift_of_slip(RowMatrix& J, const BouncingKey& key, double speed) {
    const Gradient& terms = sticking(key);
    const PairTerms<IdentityLayout> places({}, tangent_.dof);
    using Number = Jet<double, 4>;
    const std::size_t a = places.hddot(0), alpha = places.hddot(1);
    const Number I = estimated_slip_integral(
        Number::variable(-terms.value(a), 0), Number::variable(terms.value(alpha), 1),
        Number::variable(surfaces_.restitution(key.contact).value, 2), Number::variable(speed, 3));
    const RowMatrix at_cut = J;
    const RowVectorXd I_row = (I.slope[1] * terms.row(alpha) - I.slope[0] * terms.row(a)) * at_cut +
                              I.slope[2] * restitution(key.contact).row(0) * at_cut -
                              I.slope[3] * at_cut.row(tangent_.u(key.contact));
    for (std::size_t i = 0; i < tangent_.dof; ++i) {
        const auto k = static_cast<Index>(i);
        const std::size_t n = places.N(1, i), C = places.B(1, i);
        J.row(tangent_.q(i)) += I.value * terms.row(n) * at_cut + terms.value(n) * I_row;
        J.row(tangent_.v(i)) += I.value * terms.row(C) * at_cut + terms.value(C) * I_row;
        state_.q[k] += terms.value(n) * I.value;
        state_.v[k] += terms.value(C) * I.value;
    }
}

}  // namespace achilles
