#include "simulate/contact_cache.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "number/dense.hpp"
#include "number/float_environment.hpp"

namespace achilles {

namespace {

// W^-1 b; the solution of least norm if gradients are linearly dependent.
ContactVector<double> solve(const ContactMatrix<double>& W, const ContactVector<double>& b) {
    ContactSet all;
    for (Eigen::Index i = 0; i < W.rows(); ++i) all = with(all, i);
    if (const auto block = HeldBlock<double>::of(W, all)) return block->solve(b);
    return least_solution(W, Eigen::VectorXd(b));
}

// v -= M^-1 G' W^-1 b
void move_along(Vector& v, const ClosedContacts& closed, const ContactVector<double>& b) {
    v = closed.after(v, -solve(closed.W, b));
}

}  // namespace

ContactSet ClosedContacts::places_of(ContactSet set) const {
    ContactSet places;
    for (std::size_t i = 0; i < which.size(); ++i)
        if (set.contains(which[i])) places = places.with(i);
    return places;
}

ContactSet ClosedContacts::contacts_at(ContactSet places) const {
    ContactSet set;
    for (std::size_t i = 0; i < which.size(); ++i)
        if (places.contains(i)) set = set.with(which[i]);
    return set;
}

ContactVector<double> ClosedContacts::rates() const {
    ContactVector<double> hdot(W.rows());
    for (std::size_t i = 0; i < contacts.size(); ++i) hdot[static_cast<Eigen::Index>(i)] = contacts[i].hdot;
    return hdot;
}

Vector ClosedContacts::after(const Vector& v, const ContactVector<double>& impulses) const {
    Vector result = v;
    for (std::size_t i = 0; i < contacts.size(); ++i)
        result += impulses[static_cast<Eigen::Index>(i)] * contacts[i].W * contacts[i].impulse_direction;
    return result;
}

ContactCache::ContactCache(const Model& model, const Run& run)
    : model_(&model), run_(run), restitutions_(model.restitutions(run.parameters)) {
    free_.reserve(model.contacts());
    for (std::size_t i = 0; i < model.contacts(); ++i) free_.emplace_back(model, run, i);
    if (!model.has_friction()) return;
    const Layout& layout = model.layout();
    std::vector<std::uint32_t> state{layout.t(), layout.sliding_speed()};
    for (std::uint32_t i = 0; i < layout.dof; ++i) state.insert(state.end(), {layout.q(i), layout.v(i)});
    for (const auto& [which, law] : model.equations().friction) {
        rough_ = rough_.with(which);
        if (depends_on(law.level, state) || depends_on(law.static_level, state)) {
            varying_ = varying_.with(which);
        } else if (!law.never_slides) {
            const FrictionLevels levels = friction_levels(which, run.start());
            if (mag(levels.present) == 0.0 && mag(levels.sticking) == 0.0) frictionless_ = frictionless_.with(which);
        }
    }
}

ContactKinematics& ContactCache::of(std::size_t contact, Mode mode) {
    if (mode == Mode()) return free_[contact];
    const ContactInMode key(mode, contact);
    const auto known = in_modes_.find(key);
    if (known != in_modes_.end()) return known->second;
    return in_modes_.emplace(key, ContactKinematics(*model_, run_, contact, mode)).first->second;
}

ClosedContacts ContactCache::at(const State& state, ContactSet contacts, Mode others) {
    ClosedContacts closed;
    for (std::size_t i = 0; i < count(); ++i) {
        if (!contacts.contains(i)) continue;
        closed.which.push_back(i);
        closed.contacts.push_back(of(i, others).at(state));
    }
    const auto n = static_cast<Eigen::Index>(closed.which.size());
    closed.W.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j <= i; ++j) {
            const Contact &a = closed.contacts[static_cast<std::size_t>(i)],
                          &b = closed.contacts[static_cast<std::size_t>(j)];
            closed.W(i, j) = closed.W(j, i) = i == j ? a.W : a.g.dot(b.impulse_direction) * b.W;
        }
    return closed;
}

// ---- friction ----

Vector ContactRows::after(const Vector& v, const Eigen::VectorXd& impulses) const {
    Vector result = v;
    for (Eigen::Index i = 0; i < size(); ++i) result += impulses[i] * rows[static_cast<std::size_t>(i)].impulse;
    return result;
}

Eigen::Index ContactRows::find(std::size_t which, bool is_slip) const {
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].which == which && rows[i].is_slip == is_slip) return static_cast<Eigen::Index>(i);
    return -1;
}

ModeKinematics& ContactCache::motion(Mode mode) {
    const auto known = motions_.find(mode);
    if (known != motions_.end()) return known->second;
    return motions_.try_emplace(mode, *model_, run_.parameters, mode).first->second;
}

Slip ContactCache::slip(std::size_t which, const State& state, Mode mode, std::optional<double> speed) {
    const ContactInMode key(mode, which);
    auto known = slips_.find(key);
    if (known == slips_.end())
        known = slips_.emplace(key, model_->evaluator(model_->slip_terms(which, mode), run_.parameters)).first;
    auto& terms = known->second;
    set_state(terms, state);
    terms.input(model_->layout().sliding_speed()) = speed.value_or(0.0);
    terms.run();
    if (!speed && terms.u() != 0.0) {
        terms.input(model_->layout().sliding_speed()) = std::abs(terms.u());
        terms.run();
    }
    Slip slip{terms.u(),
              terms.c(),
              terms.udot(),
              terms.coefficient(),
              terms.static_coefficient(),
              Vector(state.q.size()),
              Vector(state.q.size())};
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.q.size()); ++i) {
        slip.d[static_cast<Eigen::Index>(i)] = terms.d(i);
        slip.impulse[static_cast<Eigen::Index>(i)] = terms.impulse(i);
    }
    return slip;
}

SlipTerms<Evaluator<Interval>>& ContactCache::slip_at_rest(std::size_t which, const State& state) {
    const FloatEnvironmentGuard ground;
    auto known = slip_enclosures_.find(which);
    if (known == slip_enclosures_.end())
        known = slip_enclosures_.emplace(which, model_->evaluator<Interval>(model_->slip_terms(which), run_.parameters))
                    .first;
    set_rounding_box(known->second, state);
    known->second.input(model_->layout().sliding_speed()) = Interval(0.0);
    known->second.run();
    return known->second;
}

ContactCache::FrictionLevels ContactCache::friction_levels(std::size_t which, const State& state) {
    const FloatEnvironmentGuard ground;
    auto& terms = slip_at_rest(which, state);
    FrictionLevels levels{terms.coefficient(), terms.coefficient(), terms.static_coefficient()};
    terms.input(model_->layout().sliding_speed()) = abs(terms.u());
    terms.run();
    levels.present = terms.coefficient();
    return levels;
}

ContactRows ContactCache::rows(const State& state, ContactSet gaps, ContactSet sliding, Mode mode) {
    ContactRows result;
    for (const std::size_t i : gaps) {
        const Contact c = (mode.is_free() ? free_[i] : of(i, mode)).at(state);
        result.rows.push_back(
            {i, false, c.hdot, c.gap_t, of(i, mode).normal_acceleration(state), c.g, c.W * c.impulse_direction});
    }
    for (const std::size_t i : sliding) {
        const Slip s = slip(i, state, mode);
        result.rows.push_back({i, true, s.u, s.c, s.udot, s.d, s.impulse});
        result.slips.emplace(i, s);
    }
    result.W.resize(result.size(), result.size());
    for (Eigen::Index i = 0; i < result.size(); ++i)
        for (Eigen::Index j = 0; j < result.size(); ++j)
            result.W(i, j) =
                result.rows[static_cast<std::size_t>(i)].gradient.dot(result.rows[static_cast<std::size_t>(j)].impulse);
    return result;
}

std::optional<double> ContactCache::settle_with_friction(State& state, Mode mode) {
    double least = std::numeric_limits<double>::infinity();
    const ContactSet held = mode.held(), stuck = mode.elements_in(ContactState::held).within(rough_);
    if (!held.empty()) {
        const auto gap = project(state, held, stuck.empty() ? held : ContactSet());
        if (!gap) return std::nullopt;
        least = *gap;
    }
    if (stuck.empty()) return least;
    const ContactRows closed = rows(state, held, stuck, {});
    Eigen::VectorXd rates(closed.size());
    for (Eigen::Index i = 0; i < closed.size(); ++i) rates[i] = closed.rows[static_cast<std::size_t>(i)].rate;
    if (rates.isZero(0.0)) return least;
    // With few rows the elimination is exact where nothing couples them.
    ContactSet all;
    for (Eigen::Index i = 0; i < closed.size() && closed.size() <= max_closed_contacts; ++i) all = with(all, i);
    const auto block = all.empty() ? std::nullopt : HeldBlock<double>::of(closed.W, all);
    const Eigen::VectorXd p =
        block ? Eigen::VectorXd(block->solve(-rates)) : least_solution(closed.W, Eigen::VectorXd(-rates));
    if (!p.allFinite()) return std::nullopt;
    state.v = closed.after(state.v, p);
    return least;
}

bool ContactCache::is_nearly_free(std::size_t contact, Mode mode, const State& state, const State& scale) {
    constexpr double roundings = 0x1p-26;  // far more than the errors that a projection leaves
    const State distances{roundings * scale.q, roundings * scale.v, roundings * scale.t};
    const Interval hddot = of(contact, mode).hddot_within(distances, state);
    return !certainly_positive(hddot) && !certainly_negative(hddot);
}

bool ContactCache::needs_no_force(std::size_t contact, Mode mode, const State& state, const State& scale) {
    if (!is_nearly_free(contact, mode, state, scale)) return false;
    if (!mode.is_free()) {
        const ContactSet all = mode.held().with(contact);
        const ClosedContacts closed = at(state, all);
        if (!HeldBlock<double>::of(closed.W, closed.places_of(all))) return false;
    }
    return unpressed().needs_no_force(contact, mode) || unpressed().needs_no_force_from(state, contact, mode);
}

UnpressedContacts& ContactCache::unpressed() {
    if (!unpressed_) unpressed_ = std::make_unique<UnpressedContacts>(*model_, run_.parameters);
    return *unpressed_;
}

// Newton's method, as in ContactKinematics::project().
std::optional<double> ContactCache::project_several(State& state, ContactSet onto, ContactSet still) {
    if (onto.count() > max_closed_contacts) return std::nullopt;
    constexpr int rounds = 8;
    double before = std::numeric_limits<double>::infinity();
    ContactVector<double> p = ContactVector<double>::Zero(onto.count());  // of the last correction
    for (int round = 0;; ++round) {
        const ClosedContacts closed = at(state, onto);
        double largest = 0.0, least = std::numeric_limits<double>::infinity();
        bool near = true, regular = true;
        ContactVector<double> h(closed.W.rows());
        for (std::size_t i = 0; i < closed.contacts.size(); ++i) {
            const Contact& c = closed.contacts[i];
            regular = regular && c.W > 0.0 && std::isfinite(c.h);
            h[static_cast<Eigen::Index>(i)] = c.h;
            largest = std::max(largest, std::abs(c.h));
            least = std::min(least, c.h);
            // A correction required by other gaps has its own rounding, which may be large for this gap.
            const double left = 0x1p-50 * closed.W.row(static_cast<Eigen::Index>(i)).cwiseAbs().dot(p.cwiseAbs());
            near = near && regular &&
                   (std::abs(c.h) <= left ||
                    free_[closed.which[i]].within_gap_error(c.h, round < rounds ? 1.0 : 4.0, c, state));
        }
        if (!regular) return std::nullopt;
        if (near || (round > 0 && largest <= 0x1p-40 * before)) {
            if (still.empty()) return least;
            const ClosedContacts held = still == onto ? closed : at(state, still);
            move_along(state.v, held, held.rates());
            return least;
        }
        if (round == rounds) return std::nullopt;
        before = largest;
        p = solve(closed.W, h);
        state.q = closed.after(state.q, -p);
    }
}

bool ContactCache::land_while_held(State& state, std::size_t contact, Mode mode, Contact& landed) {
    if (!project(state, mode.held().with(contact), mode.held())) return false;
    landed = of(contact, mode).at(state);
    return true;
}

namespace {

// |dh|, or the change of h per unit length along dh if that is much smaller, as for sin(1e9 x).
double size_of(ContactKinematics& surface, const State& start) {
    constexpr double much = 16.0;
    const Contact contact = surface.at(start);
    const double slope = contact.g.norm();
    double change = 0.0;
    for (const double way : {-1.0, 1.0}) {
        State beside = start;
        beside.q += way / slope * contact.g;
        const double h = surface.at(beside).h;
        change = std::max(change, std::isfinite(h) ? std::abs(h - contact.h) : slope);
    }
    return slope > much * change ? change : slope;
}

}  // namespace

GapUnits::GapUnits(const Model& model, const Run& run, ContactCache& surfaces)
    : surfaces_(&surfaces), units_(model.contacts(), 1.0), guard_units_(model.watched_guards().size(), 1.0) {
    if (!guard_units_.empty()) guard_slopes_ = model.evaluator(model.guard_slopes(), run.parameters);
    find(run.start());
}

void GapUnits::find(const State& state) {
    constexpr double step = 8.0;  // of the exponent, so that sizes around 1 give the unit 1
    const auto unit_of = [](double size) {
        const bool is_usable = size > 0.0 && std::isfinite(size);
        return is_usable ? std::exp2(step * std::round(std::log2(size) / step)) : 1.0;
    };
    place_ = state.q;
    for (std::size_t i = 0; i < units_.size(); ++i) units_[i] = unit_of(size_of(surfaces_->of(i), state));
    if (!guard_slopes_) return;
    set_state(*guard_slopes_, state);
    guard_slopes_->run();
    const auto width = static_cast<std::size_t>(2 * state.q.size());
    for (std::size_t k = 0; k < guard_units_.size(); ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < width; ++i) sum += std::pow(guard_slopes_->output(k * width + i), 2);
        guard_units_[k] = unit_of(std::sqrt(sum));
    }
}

double GapUnits::operator[](const FrictionEvent& event) const {
    return event.power == 0 ? 1.0 : std::pow(units_[event.contact], event.power);  // exact: a power of 256
}

const std::vector<double>& GapUnits::at(const State& state) {
    constexpr double far = 1.0;
    if ((state.q - place_).cwiseAbs().maxCoeff() > far) find(state);
    return units_;
}

}  // namespace achilles
