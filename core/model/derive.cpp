#include "model/derive.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "contacts/contact_law.hpp"
#include "model/rate_polynomial.hpp"
#include "model/rows.hpp"

namespace achilles {

namespace {

// M = L D L' with unit lower triangular L. It needs no square roots and keeps zeros. L D is stored beside L, because it
// is computed before the division.
class PlainFactorisation {
 public:
    PlainFactorisation() = default;
    // `rounded` is applied to every entry of L D and L and to every pivot.
    template <class Round = std::identity>
    PlainFactorisation(const Row& M, std::size_t n, Graph& graph, const Round& rounded = {})
        : dof_(n), lower_(n * n, graph.number(0)), pivots_(n) {
        Row product(n * n, graph.number(0));  // L D
        for (std::size_t j = 0; j < n; ++j) {
            pivots_[j] = M[j * n + j];
            for (std::size_t k = 0; k < j; ++k) pivots_[j] = pivots_[j] - lower_[j * n + k] * product[j * n + k];
            pivots_[j] = rounded(pivots_[j]);
            if (pivots_[j].is_zero()) throw std::domain_error(fmt::format("pivot {} is 0", j + 1));
            for (std::size_t i = j + 1; i < n; ++i) {
                Expression entry = M[i * n + j];
                for (std::size_t k = 0; k < j; ++k) entry = entry - lower_[i * n + k] * product[j * n + k];
                product[i * n + j] = rounded(entry);
                lower_[i * n + j] = rounded(product[i * n + j] / pivots_[j]);
            }
        }
    }

    const Row& lower() const { return lower_; }
    const Row& pivots() const { return pivots_; }

    // M^-1 right
    Row solve(Row x) const {
        for (std::size_t i = 0; i < dof_; ++i)
            for (std::size_t k = 0; k < i; ++k) x[i] = x[i] - lower_[i * dof_ + k] * x[k];
        for (std::size_t i = 0; i < dof_; ++i) x[i] = x[i] / pivots_[i];
        for (std::size_t i = dof_; i-- > 0;)
            for (std::size_t k = i + 1; k < dof_; ++k) x[i] = x[i] - lower_[k * dof_ + i] * x[k];
        return x;
    }

 private:
    std::size_t dof_ = 0;
    Row lower_, pivots_;
};

// The number of coordinates in the largest set that M couples, directly or through others.
std::size_t largest_block(const Row& M, std::size_t n) {
    std::vector<std::size_t> block(n);
    std::iota(block.begin(), block.end(), std::size_t{0});
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (!M[i * n + j].is_zero()) std::replace(block.begin(), block.end(), block[i], std::size_t{block[j]});
    std::ptrdiff_t largest = 0;
    for (const std::size_t b : block) largest = std::max(largest, std::count(block.begin(), block.end(), b));
    return static_cast<std::size_t>(largest);
}

// The factorization of M, or for more than a few coupled coordinates that of K M K', where K is a unit lower triangular
// matrix of numbers near L^-1 (theory.md 1). K M K' is nearly diagonal: over intervals, elimination in M itself makes
// them wider by a factor of about 7 for each coordinate. The pivots of both are the same.
class Factorization {
 public:
    Factorization(const Row& M, std::size_t n, Graph& graph) : dof_(n) {
        if (largest_block(M, n) <= most_eliminated) {
            factors_ = PlainFactorisation(M, n, graph);
            return;
        }
        Row near;  // numbers near M, L D and L
        for (const Expression entry : M) near.push_back(midpoint(entry));
        set_basis(PlainFactorisation(near, n, graph, midpoint).lower(), graph);
        Row half(n * n, graph.number(0)), reduced = half;  // M K', then K M K'
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t k = 0; k <= j; ++k) add(half[i * n + j], M[i * n + k], basis_[j * n + k]);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                for (std::size_t k = 0; k <= i; ++k) add(reduced[i * n + j], basis_[i * n + k], half[k * n + j]);
                reduced[j * n + i] = reduced[i * n + j];
            }
        factors_ = PlainFactorisation(reduced, n, graph);
    }

    const Row& pivots() const { return factors_.pivots(); }

    // M^-1 right = K' (K M K')^-1 K right
    Row solve(const Row& right) const {
        if (basis_.empty()) return factors_.solve(right);
        Graph& graph = right.front().graph();
        Row inner(dof_, graph.number(0)), x = inner;
        for (std::size_t i = 0; i < dof_; ++i)
            for (std::size_t k = 0; k <= i; ++k) add(inner[i], basis_[i * dof_ + k], right[k]);
        inner = factors_.solve(inner);
        for (std::size_t k = 0; k < dof_; ++k)
            for (std::size_t i = k; i < dof_; ++i) add(x[k], basis_[i * dof_ + k], inner[i]);
        return x;
    }

 private:
    static constexpr std::size_t most_eliminated = 4;

    static void add(Expression& sum, Expression a, Expression b) { sum = sum + a * b; }

    // K = L^-1, rounded to numbers entry by entry.
    void set_basis(const Row& lower, Graph& graph) {
        basis_.assign(dof_ * dof_, graph.number(0));
        for (std::size_t i = 0; i < dof_; ++i) {
            basis_[i * dof_ + i] = graph.number(1);
            for (std::size_t j = 0; j < i; ++j) {
                Expression entry = graph.number(0);
                for (std::size_t k = j; k < i; ++k) add(entry, lower[i * dof_ + k], basis_[k * dof_ + j]);
                basis_[i * dof_ + j] = midpoint(-entry);
            }
        }
    }

    std::size_t dof_;
    Row basis_;  // K; empty if M is eliminated as it is
    PlainFactorisation factors_;
};

Expression dot(const Row& a, const Row& b, Graph& graph) {
    Expression sum = graph.number(0);
    for (std::size_t i = 0; i < a.size(); ++i) sum = sum + a[i] * b[i];
    return sum;
}

// b_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) v_j v_k + dV/dq_i. The two terms in v_j v_k are combined, which halves the
// number of products.
Row bias(const Row& M, Expression potential, const Row& v, const std::vector<std::uint32_t>& q, Graph& graph) {
    const std::size_t n = v.size();
    const std::vector<Row> dM = jacobian(M, q);  // dM[i n + j][k] = dM_ij/dq_k
    Row b = gradient(potential, q);
    for (std::size_t i = 0; i < n; ++i) {
        const auto of = [&](std::size_t j, std::size_t k) {
            return dM[i * n + j][k] - graph.number(1, 2) * dM[j * n + k][i];
        };
        for (std::size_t j = 0; j < n; ++j) {
            Expression inner = of(j, j) * v[j];
            for (std::size_t k = 0; k < j; ++k) inner = inner + (of(j, k) + of(k, j)) * v[k];
            b[i] = b[i] + inner * v[j];
        }
    }
    return b;
}

// Whether the expression is a polynomial of degree 2 or less in these symbols, by expand_in_rates(): false if it is not
// recognized.
bool is_quadratic(Expression expression, const std::vector<std::uint32_t>& slots) {
    Expression offender;
    const auto expanded = expand_in_rates(expression, slots, offender);
    if (!expanded) return false;
    return std::all_of(expanded->begin(), expanded->end(), [](const auto& term) { return degree(term.first) <= 2; });
}

// Sets the terms of a contact that follow from its impulse, Delassus matrix and hddot, in a mode with acceleration f.
void complete(ContactEquations& c, const Row& f, std::size_t contact, const Row& v) {
    c.W = c.delassus[contact];
    c.direction.clear();
    for (const Expression u : c.impulse) c.direction.push_back(u.is_zero() ? u : cancelled(u / c.W));
    c.lambda = -(c.hddot / c.W);
    c.f_c.clear();
    c.f_by_force.clear();
    c.s.clear();
    for (std::size_t i = 0; i < v.size(); ++i) {
        c.f_c.push_back(f[i] - c.direction[i] * c.hddot);
        c.f_by_force.push_back(f[i] + c.impulse[i] * c.lambda);
        c.s.push_back(v[i] - c.direction[i] * c.hdot);
    }
}

}  // namespace

namespace {

// Expressions with held(NAME) as they are while these contacts are held, and no others.
Row forces_of(Row forces, ContactSet held, const Layout& layout) {
    if (!layout.forces_see_contact) return forces;
    std::vector<std::uint32_t> slots;
    Row values;
    for (std::size_t i = 0; i < layout.contacts; ++i) {
        slots.push_back(layout.held(i));
        values.push_back(forces.front().graph().number(held.contains(i) ? 1 : 0));
    }
    for (Expression& force : forces) force = substitute(force, slots, values);
    return forces;
}

}  // namespace

std::vector<WatchedGuard> watched_guards(const std::vector<JumpLaw>& jumps,
                                         const std::vector<std::optional<LatchLaw>>& latches) {
    std::vector<WatchedGuard> guards;
    for (std::size_t i = 0; i < jumps.size(); ++i)
        if (jumps[i].on) guards.push_back({false, i, *jumps[i].on});
    for (std::size_t i = 0; i < latches.size(); ++i)
        if (latches[i] && latches[i]->until) guards.push_back({true, i, *latches[i]->until});
    return guards;
}

Expression cancelled(Expression quotient) {
    Graph& graph = quotient.graph();
    const auto at = [&](std::uint32_t id) { return Expression(&graph, id); };
    const Graph::Node node = graph.node(quotient.id());  // a copy, because nodes are created below
    if (node.operation == Operation::multiply && at(node.a).is_number()) return at(node.a) * cancelled(at(node.b));
    if (node.operation == Operation::multiply && at(node.b).is_number()) return at(node.b) * cancelled(at(node.a));
    if (node.operation != Operation::divide) return quotient;
    const Graph::Node dividend = graph.node(node.a);
    if (dividend.operation != Operation::multiply) return quotient;
    if (dividend.a == node.b) return at(dividend.b);
    return dividend.b == node.b ? at(dividend.a) : quotient;
}

bool Equations::has_power() const {
    return !power.is_zero() || std::any_of(free.contacts.begin(), free.contacts.end(), [](const ContactEquations& c) {
        return !c.gap_t.is_zero();
    }) || std::any_of(free.slips.begin(), free.slips.end(), [](const auto& slip) { return !slip.second.c.is_zero(); });
}

void derive(Equations& e, const Layout& layout, Graph& graph) {
    const std::size_t n = layout.dof;
    const std::uint32_t t = layout.t();
    const std::vector<std::uint32_t> q_slots = slots_from(layout.q(0), n), v_slots = slots_from(layout.v(0), n);
    const Row v = symbols(v_slots, graph);
    const Factorization mass(e.M, n, graph);
    e.pivots = mass.pivots();
    e.bias = bias(e.M, e.potential, v, q_slots, graph);
    const Row forces = forces_of(e.Q, {}, layout);
    Row against(n);  // b - Q
    for (std::size_t i = 0; i < n; ++i) against[i] = e.bias[i] - forces[i];
    Row& f = e.free.f = mass.solve(against);
    for (Expression& entry : f) entry = -entry;

    for (const Expression gap : e.gaps) {
        ContactEquations& c = e.free.contacts.emplace_back();
        c.gap = gap;
        c.g = gradient(gap, q_slots);
        c.gap_t = derivative(gap, t);
        c.hdot = dot(c.g, v, graph) + c.gap_t;
        Expression curvature = graph.number(0);  // v'Hv
        const std::vector<Row> H = jacobian(c.g, q_slots);
        for (std::size_t i = 0; i < n; ++i) {
            const Row& row = H[i];
            c.H.insert(c.H.end(), row.begin(), row.end());
            curvature = curvature + v[i] * dot(row, v, graph);
        }
        c.impulse = mass.solve(c.g);
        const Expression turning = graph.number(2) * dot(derivative(c.g, t), v, graph) + derivative(c.gap_t, t);
        c.hddot = curvature + turning + dot(c.g, f, graph);
    }
    for (std::size_t i = 0; i < e.gaps.size(); ++i) {
        ContactEquations& c = e.free.contacts[i];
        for (const ContactEquations& other : e.free.contacts) c.delassus.push_back(dot(other.g, c.impulse, graph));
        if (c.delassus[i].is_zero()) throw std::domain_error("dh M^-1 dh' is 0");
        complete(c, f, i, v);
    }
    if (!e.friction.empty())
        derive_slips(
            e.friction, layout, [&](const Row& row) { return mass.solve(row); }, e.free);
    e.energy = e.kinetic + e.potential;
    e.power = dot(v, e.Q, graph) + derivative(e.potential, t);
    const auto is_steady = [&](Expression x) { return !depends_on(x, {&t, 1}); };
    e.autonomous = is_steady(e.potential) && std::all_of(e.gaps.begin(), e.gaps.end(), is_steady) &&
                   std::all_of(e.Q.begin(), e.Q.end(), is_steady) &&
                   std::all_of(e.friction.begin(), e.friction.end(), [&](const auto& each) {
                       const FrictionLaw& law = each.second;
                       return is_steady(law.slip) && is_steady(law.level) && is_steady(law.static_level);
                   });
    const auto is_steady_or_none = [&](const std::optional<Expression>& x) { return !x || is_steady(*x); };
    e.autonomous = e.autonomous && std::all_of(e.when.begin(), e.when.end(), is_steady_or_none);
    for (const auto& latch : e.latches) e.autonomous = e.autonomous && (!latch || is_steady_or_none(latch->until));
    for (const JumpLaw& jump : e.jumps) {
        e.autonomous = e.autonomous && is_steady_or_none(jump.on) && is_steady_or_none(jump.when);
        for (const auto& [slot, value] : jump.set) e.autonomous = e.autonomous && is_steady(value);
    }
    for (const Expression force : e.Q) e.quadratic_in_rates = e.quadratic_in_rates && is_quadratic(force, v_slots);
    const std::uint32_t speed = layout.sliding_speed();
    for (const auto& [which, law] : e.friction)
        e.quadratic_in_rates = e.quadratic_in_rates && !depends_on(law.level, {&speed, 1});
}

Expression jerk_of(const ContactEquations& contact, const Layout& layout) {
    return rate_of(contact.hddot, contact.f_c, layout);
}

Expression rate_of(Expression x, const Expressions& acceleration, const Layout& layout) {
    Graph& graph = x.graph();
    const std::vector<std::uint32_t> q = slots_from(layout.q(0), layout.dof), v = slots_from(layout.v(0), layout.dof);
    return dot(gradient(x, q), symbols(v, graph), graph) + dot(gradient(x, v), acceleration, graph) +
           derivative(x, layout.t());
}

ContactModes::ContactModes(const Equations& equations, const Layout& layout)
    : graph_(equations.energy.graph()), layout_(layout) {
    ModeEquations& free = known_[{}] = equations.free;
    const auto adopt = [&](Expression& x) { x = graph_.adopt(x); };
    const auto adopt_all = [&](Row& row) { std::for_each(row.begin(), row.end(), adopt); };
    adopt_all(free.f);
    for (ContactEquations& c : free.contacts) {
        for (Expression* x : {&c.gap, &c.gap_t, &c.hdot, &c.W, &c.hddot, &c.lambda}) adopt(*x);
        for (Row* row : {&c.g, &c.H, &c.impulse, &c.delassus, &c.direction, &c.s, &c.f_c, &c.f_by_force})
            adopt_all(*row);
        for (auto& [slip, entry] : c.on_slips) adopt(entry);
    }
    for (auto& [which, slip] : free.slips) {
        for (Expression* x : {&slip.u, &slip.c, &slip.udot}) adopt(*x);
        for (Row* row : {&slip.d, &slip.impulse, &slip.on_gaps}) adopt_all(*row);
        for (auto& [other, entry] : slip.on_slips) adopt(entry);
    }
    friction_ = equations.friction;
    for (auto& [which, law] : friction_) {
        for (Expression* x : {&law.slip, &law.c, &law.level, &law.static_level}) adopt(*x);
        adopt_all(law.d);
    }
    when_ = equations.when;
    for (std::optional<Expression>& when : when_)
        if (when) adopt(*when);
    for (const WatchedGuard& guard : achilles::watched_guards(equations.jumps, equations.latches))
        watched_guards_.push_back(graph_.adopt(guard.function));
    in_forces_ = equations.in_forces;
    if (in_forces_.empty()) return;
    M_ = equations.M;
    Q_ = equations.Q;
    adopt_all(M_);
    adopt_all(Q_);
}

// The mode without held contacts in which these act on the forces: f changes by M^-1 (Q - Q_0).
ModeEquations ContactModes::derive_free(ContactSet acting) {
    ModeEquations result = known_.at({});
    result.mode = Mode().with_acting(acting);
    const std::size_t n = layout_.dof;
    const Row now = forces_of(Q_, acting, layout_), without = forces_of(Q_, {}, layout_);
    Row more(n);
    for (std::size_t i = 0; i < n; ++i) more[i] = now[i] - without[i];
    const Row change = Factorization(M_, n, graph_).solve(more);
    for (std::size_t i = 0; i < n; ++i) result.f[i] = result.f[i] + change[i];
    const Row v = symbols(slots_from(layout_.v(0), n), graph_);
    for (std::size_t i = 0; i < result.contacts.size(); ++i) {
        ContactEquations& c = result.contacts[i];
        c.hddot = c.hddot + dot(c.g, change, graph_);
        complete(c, result.f, i, v);
    }
    for (auto& [which, slip] : result.slips) slip.udot = slip.udot + dot(slip.d, change, graph_);
    return result;
}

const ModeEquations& ContactModes::of(Mode mode) {
    const auto known = known_.find(mode);
    return known != known_.end() ? known->second : known_.emplace(mode, derive(mode)).first->second;
}

// Adds the last contact k that keeps its gap to the mode without it, which is derived first if necessary.
ModeEquations ContactModes::derive(Mode mode) {
    if (mode.is_free() && mode.joints().empty()) return derive_free(mode.acting());
    if (!friction_.empty()) return derive_with_friction(mode);
    const ContactSet kept = contacts_keeping(mode, Constraint::gap);
    std::size_t k = 0;
    for (const std::size_t i : kept) k = i;
    const ModeEquations& before = of(unconstrained(mode, k));
    const ContactEquations& last = before.contacts.at(k);
    if (last.delassus[k].is_zero())
        throw std::domain_error("contacts with linearly dependent gradients cannot all be held");
    ModeEquations result{mode, last.f_c, before.contacts, {}};
    const Row v = symbols(slots_from(layout_.v(0), layout_.dof), graph_);
    for (std::size_t i = 0; i < result.contacts.size(); ++i) {
        ContactEquations& c = result.contacts[i];
        if (kept.contains(i)) {
            c = of(unconstrained(mode, i)).contacts[i];
            continue;
        }
        const Expression part = c.delassus[k] / last.W;
        const Expression along = dot(last.g, c.g, graph_) / dot(last.g, last.g, graph_);
        for (std::size_t j = 0; j < c.g.size(); ++j) c.g[j] = c.g[j] - last.g[j] * along;
        for (std::size_t j = 0; j < c.impulse.size(); ++j) c.impulse[j] = c.impulse[j] - last.impulse[j] * part;
        for (std::size_t j = 0; j < c.delassus.size(); ++j) c.delassus[j] = c.delassus[j] - last.delassus[j] * part;
        c.hddot = c.hddot - part * last.hddot;
        if (!c.delassus[i].is_zero()) complete(c, result.f, i, v);
    }
    return result;
}

// Adds the last joint or contact that is not open to the mode without it.
ModeEquations ContactModes::derive_with_friction(Mode mode) {
    const ContactSet all = mode.held().with(mode.joints());
    std::size_t k = 0;
    for (const std::size_t i : all) k = i;
    ModeEquations result = of(unconstrained(mode, k));
    result.mode = mode;
    add_to_mode(result, k, mode, friction_, layout_);
    const Row v = symbols(slots_from(layout_.v(0), layout_.dof), graph_);
    for (std::size_t i = 0; i < result.contacts.size(); ++i) {
        if (mode.is_held(i)) {
            result.contacts[i] = of(unconstrained(mode, i)).contacts[i];
        } else if (!result.contacts[i].delassus[i].is_zero()) {
            complete(result.contacts[i], result.f, i, v);
        }
    }
    for (auto& [which, slip] : result.slips)
        if (mode.is_held(which)) slip = of(unconstrained(mode, which)).slips.at(which);
    return result;
}

WatchedFriction ContactModes::watched_friction(const ModeEquations& motion) {
    return achilles::watched_friction(motion, friction_, layout_, [&](std::size_t i) -> const ModeEquations& {
        return of(unconstrained(motion.mode, i));
    });
}

Expressions ContactModes::powers(Mode mode, Expression work) {
    const ModeEquations& motion = of(mode);
    work = forces_of({work}, mode.seen_by_forces(), layout_).front();
    for (const std::size_t i : contacts_keeping(mode, Constraint::gap)) {
        const Expression gap_t = motion.contacts[i].gap_t;
        if (friction_.empty()) {
            work = work - motion.contacts[i].lambda * gap_t;
        } else if (!gap_t.is_zero()) {
            const FrictionForce force = force_of(i, mode);
            work = work - force.lambda / force.scale * gap_t;
        }
    }
    if (friction_.empty()) return {work};
    const FrictionPower friction = friction_power(
        motion, friction_, layout_, [&](std::size_t i) -> const ModeEquations& { return of(unconstrained(mode, i)); });
    return {work + friction.work, friction.heat};
}

FrictionForce ContactModes::force_of(std::size_t which, Mode mode) {
    return friction_force(of(unconstrained(mode, which)), which, mode, friction_, layout_);
}

Expression ContactModes::watched_force(std::size_t contact, Mode mode) {
    if (friction_.empty()) return of(mode).contacts[contact].hddot;
    return negative_force(of(unconstrained(mode, contact)), contact, mode, friction_);
}

namespace {

// Two expressions of the acceleration in a mode: first as derived, second as f + impulse lambda. The second is empty
// unless exactly one contact is held.
std::pair<Expressions, Expressions> accelerations(const ModeEquations& motion) {
    for (std::size_t i = 0; i < motion.contacts.size() && motion.slips.empty(); ++i)
        if (motion.mode.held() == ContactSet::of(i)) return {motion.f, motion.contacts[i].f_by_force};
    return {motion.f, {}};
}

// The pivots of M, adopted into the mode's graph.
Expressions pivots_of(const Equations& equations, Graph& graph) {
    Expressions pivots;
    for (const Expression pivot : equations.pivots) pivots.push_back(graph.adopt(pivot));
    return pivots;
}

struct ModeSeries {
    SeriesProgram program;
    Expressions acceleration;
};
// The series of a mode with these event functions. Of the two forms of the acceleration, the one with fewer products is
// used.
ModeSeries series_of(const ModeEquations& motion, const Expressions& event_functions, const Expressions& pivots,
                     const Layout& layout) {
    const auto with = [&](const Expressions& acceleration) {
        return SeriesProgram(Program(joined({acceleration, event_functions, pivots}), layout.slots()), layout.dof,
                             event_functions.size());
    };
    const auto [f, by_force] = accelerations(motion);
    ModeSeries series{with(f), f};
    if (!by_force.empty()) {
        SeriesProgram other = with(by_force);
        if (other.inner_sums() < series.program.inner_sums()) series = {std::move(other), by_force};
    }
    return series;
}

}  // namespace

SeriesProgram make_hddot_series(const ModeEquations& motion, const Equations& equations, const Layout& layout) {
    Expressions hddot;
    for (const ContactEquations& contact : motion.contacts) hddot.push_back(contact.hddot);
    return series_of(motion, hddot, pivots_of(equations, motion.f.front().graph()), layout).program;
}

ModeDynamics make_motion(const ModeEquations& motion, const Equations& e, const Layout& layout, ContactModes& modes) {
    const Slots slots = layout.slots();
    Graph& graph = motion.f.front().graph();
    const Expressions pivots = pivots_of(e, graph);
    Expressions values, rates, event_functions;
    for (std::size_t i = 0; i < motion.contacts.size(); ++i) {
        const ContactEquations& c = motion.contacts[i];
        switch (law_of(motion.mode.state(i)).watched) {
            case WatchedFunction::gap:
                values.push_back(c.hddot);
                event_functions.push_back(c.gap);
                break;
            case WatchedFunction::normal_force:
                values.push_back(modes.watched_force(i, motion.mode));
                event_functions.push_back(values.back());
                rates.push_back(motion.slips.empty() ? jerk_of(c, layout) : rate_of(values.back(), motion.f, layout));
                break;
        }
    }
    WatchedFriction friction;
    if (!motion.slips.empty()) friction = modes.watched_friction(motion);
    const Expressions& guards = modes.watched_guards();
    Expressions further = joined({friction.functions, guards});
    for (const Expression function : further) {
        values.push_back(function);
        event_functions.push_back(function);
        rates.push_back(rate_of(function, motion.f, layout));
    }
    Expressions powers;
    if (!motion.slips.empty()) powers = modes.powers(motion.mode, graph.adopt(e.power));
    if (std::all_of(powers.begin(), powers.end(), [](Expression power) { return power.is_zero(); })) powers.clear();
    ModeSeries series = series_of(motion, joined({event_functions, powers}), pivots, layout);
    event_functions.resize(motion.contacts.size());
    return {motion.mode,
            std::move(series.acceleration),
            std::move(event_functions),
            TypedProgram<MotionTerms>::of(slots, motion.f, pivots, joined({values, rates})),
            std::move(series.program),
            std::move(friction.events),
            guards.size(),
            powers.size()};
}

}  // namespace achilles
