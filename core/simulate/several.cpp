// What an execution does where several contacts are closed: impacts of several, and who is held after an event
// (theory-gaps.md 2.1 to 2.5).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contacts/complementarity.hpp"
#include "contacts/moreau.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

double ulp(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

// The error of a Delassus matrix that was evaluated in double: a few roundings of its terms.
ContactMatrix<double> radius_of(const ContactMatrix<double>& W) {
    constexpr double few = 0x1p-48;
    ContactMatrix<double> radius(W.rows(), W.cols());
    for (Eigen::Index i = 0; i < W.rows(); ++i)
        for (Eigen::Index k = 0; k < W.cols(); ++k)
            radius(i, k) = W(i, k) == 0.0 ? 0.0 : few * std::sqrt(W(i, i) * W(k, k));
    return radius;
}

}  // namespace

std::string Execution::names_of(ContactSet contacts) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < surfaces_->count(); ++i)
        if (contacts.contains(i)) names.push_back("'" + model_->description().constraints[i].name + "'");
    return fmt::format("{}", fmt::join(names, ", "));
}

// Those whose landings cannot be told from this one in time (theory-gaps.md 2.4).
ContactSet Execution::landing_with(std::size_t which, const Contact& contact) {
    const auto uncertainty = [&](std::size_t i, double hdot) {
        return 4.0 * surfaces_->of(i).gap_error(next_.state) + std::abs(hdot) * ulp(next_.state.t);
    };
    const double when = uncertainty(which, contact.hdot) / std::abs(contact.hdot);
    ContactSet landing = ContactSet::of(which);
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (i == which || next_.held.contains(i) || next_.touching.contains(i)) continue;
        const Contact other = surfaces_->of(i).at(next_.state);
        if (other.hdot < 0.0 && other.h <= uncertainty(i, other.hdot) - other.hdot * when) landing = landing.with(i);
    }
    return landing;
}

// Whether an impact on this contact presses all that is held (kappa >= 0), so that it stays held.
bool Execution::passes_on(std::size_t which) {
    if (next_.held.empty()) return true;
    if (next_.held.count() >= most_contacts) return false;
    const Closed closed = surfaces_->at(next_.state, next_.held.with(which));
    const auto held = closed.places_of(next_.held);
    ContactVector<double> e = ContactVector<double>::Zero(closed.W.rows());
    return !order_dependence(enclosure(closed.W, radius_of(closed.W)), e, held, closed.places_of(ContactSet::of(which)))
                .by_transmission;
}

// What an impact does to the energy, with what is passed on to held contacts that move.
Exchange Execution::exchange_of(const Contact& contact, double e) {
    Exchange result = exchange(contact, e);
    if (next_.held.empty() || !model_->equations().has_power()) return result;
    const Closed closed = surfaces_->at(next_.state, next_.held.with(which_));
    const auto block = HeldBlock<double>::of(closed.W, closed.places_of(next_.held));
    if (!block) return result;
    const auto place = std::find(closed.which.begin(), closed.which.end(), which_) - closed.which.begin();
    const ContactVector<double> kappa = block->transmission(closed.W, place).kappa;
    const double impulse = -(1.0 + e) * contact.hdot / contact.W;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (next_.held.contains(closed.which[i]))
            result.work -= kappa[static_cast<Eigen::Index>(i)] * impulse * closed.contacts[i].gap_t;
    return result;
}

// An impact of several at once, by Newton's law in Moreau's form.
void Execution::collide(ContactSet landing) {
    const ContactSet held = next_.held, still = held.with(next_.touching), all = still.with(landing);
    if (all.count() > most_contacts)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("{} contacts are closed at once, more than the {} that can be decided: {}, at {}",
                                all.count(), most_contacts, names_of(all), where(next_.state)));
    if (completing())
        return stop(Outcome::Kind::undecided, fmt::format("{} before the Zeno time of another contact, at {}",
                                                          names_of(landing), where(next_.state)));
    if (!surfaces_->project(next_.state, all, still)) return fail_projection();
    const Closed closed = surfaces_->at(next_.state, all);
    const ContactSet places = closed.places_of(held);
    ContactVector<double> before = closed.rates(), e(before.size());
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        e[k] = restitutions_[closed.which[i]];
        if (still.contains(closed.which[i])) before[k] = 0.0;
    }
    const auto impact = moreau_impact(closed.W, before, e, places);
    if (!impact)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("no impulse obeys the impact law of {}, at {}", names_of(all), where(next_.state)));
    const Vector v_before = next_.state.v, v_after = closed.after(v_before, impact->impulses);
    if (complete_pair(landing, v_after, false)) return;
    auto joint = std::make_shared<Joint>();
    joint->not_unique = !impact->unique;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        joint->impulses.emplace_back(closed.which[i], impact->impulses[static_cast<Eigen::Index>(i)]);
    const ContactSet open = closed.places_of(all.without(held));
    joint->order_matters = open.count() > 1 && order_matters(closed.W, radius_of(closed.W), e, places, open);
    if (joint->order_matters && run_.options.simultaneous == Simultaneous::stop)
        return stop(
            Outcome::Kind::simultaneous_impacts,
            fmt::format("{} land at once, and what follows depends on which is first (simultaneous = \"stop\"), "
                        "at {}",
                        names_of(all.without(held)), where(next_.state)));
    const auto rates = [&](const ContactVector<double>& after) {
        std::vector<std::pair<std::size_t, double>> list;
        for (std::size_t i = 0; i < closed.which.size(); ++i)
            list.emplace_back(closed.which[i], after[static_cast<Eigen::Index>(i)]);
        return list;
    };
    if (joint->order_matters) {
        joint->alternatives.push_back({std::nullopt, rates(impact->hdot_after)});
        for (const ImpactSequence& other : alternatives(closed.W, before, e, places))
            joint->alternatives.push_back(
                {closed.which[static_cast<std::size_t>(other.first)], rates(other.hdot_after)});
    }
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const double hdot = impact->hdot_after[static_cast<Eigen::Index>(i)];
        if (!(hdot > 0.0) || !too_short_to_resolve(closed.which[i], hdot)) continue;
        if (!complete_pair(landing, v_after, true)) end_chatter(all);
        return;
    }
    Exchange exchange{0.0, impact->loss};
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        exchange.work -= impact->impulses[static_cast<Eigen::Index>(i)] * closed.contacts[i].gap_t;
    double speed = 0.0;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (landing.contains(closed.which[i])) speed = std::max(speed, -closed.contacts[i].hdot);
    record_.impact(next_.state, v_after, speed, exchange, landing, std::move(joint));
    next_.state.v = v_after;
    // Who leaves at once, and who may be held.
    ContactSet resting;
    next_.touching = {};
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const std::size_t contact = closed.which[i];
        const double hdot = impact->hdot_after[static_cast<Eigen::Index>(i)];
        next_.starts[contact] = {{0.0, hdot, 0.0, 0.0, state_error()}, 1};
        if (!(hdot > 0.0)) resting = resting.with(contact);
    }
    next_.held = {};
    change_rates(v_before, all);
    decide(resting);
    record_.after_impact(held.without(next_.held), next_.held);
    if (next_.held != held) enter_phase();
    if (!outcome_) begin_stretch(next_.held, run_.options.end_time);
}

// The impact of those that land leads to v_after. Whether one of them comes to rest together with another contact, which is open, or which the impacts would open.
bool Execution::complete_pair(ContactSet landing, const Vector& v_after, bool below_rounding) {
    if (completing()) return false;
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (!landing.contains(i) || !(restitutions_[i] < 1.0)) continue;
        for (std::size_t j = 0; j < surfaces_->count(); ++j) {
            const ContactSet two = ContactSet::of(i).with(j);
            // All that is closed but these two has to be held.
            if (j == i || !next_.touching.without(two).empty() || !landing.without(two).empty()) continue;
            if (complete_pair(std::min(i, j), std::max(i, j), next_.held.without(two), landing, v_after,
                              below_rounding))
                return true;
        }
    }
    return false;
}

bool Execution::complete_pair(std::size_t first, std::size_t second, ContactSet held, ContactSet landing,
                              const Vector& v_after, bool below_rounding) {
    const std::array<std::size_t, 2> pair{first, second};
    PairCollision collision{next_.state, {}, {}};
    double speed = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
        const Contact contact = surfaces_->of(pair[k], held).at(next_.state);
        const bool closed =
            landing.contains(pair[k]) || next_.held.contains(pair[k]) || next_.touching.contains(pair[k]);
        collision.h[k] = closed ? 0.0 : contact.h;
        collision.sigma[k] = next_.held.contains(pair[k]) ? 0.0 : contact.hdot;
        if (landing.contains(pair[k])) speed = std::max(speed, -contact.hdot);
    }
    // Quick: what is high above the tolerances needs no look.
    if (!below_rounding && (speed > 1e-2 || collision.h[0] + collision.h[1] > 1e-4)) return false;
    const auto same = [&](const PairOf& known) {
        return known.first == first && known.second == second && known.held == held;
    };
    auto known = std::find_if(all_pairs_.begin(), all_pairs_.end(), same);
    if (known == all_pairs_.end()) {
        const Closed both = surfaces_->at(next_.state, held.with(first).with(second));
        ContactSet places;
        for (std::size_t i = 0; i < both.which.size(); ++i) places = places.with(i);
        if (!HeldBlock<double>::of(both.W, places)) return false;  // they cannot both be held with the others
        const Ground ground;
        all_pairs_.push_back(
            {first, second, held, std::make_unique<PairConditions>(*model_, run_, first, second, held, ground)});
        known = std::prev(all_pairs_.end());
    }
    auto completion = timed([&] { return known->conditions->certify(collision, below_rounding); });
    if (!completion) return false;
    const ContactSet all = held.with(first).with(second);
    State restart = completion->restart;
    if (!surfaces_->project(restart, all, all)) return false;
    const State before = next_.state;
    const Exchange exchange = record_.exchange_of_jump(before, restart, 0.0);
    record_.impact(before, v_after, speed, exchange, landing);
    Event& event = completion_.emplace();
    event.kind = Event::Kind::zeno;
    event.t = completion->certificate.zeno_time;
    event.truncation = Event::Truncation{before.t, before.q, before.v, restart.v, speed};
    cut_error_ += std::max(completion->certificate.shadowing_position.value_or(0.0),
                           completion->certificate.shadowing_velocity.value_or(0.0));
    event.certificate = std::move(completion->certificate);
    event.contacts = ContactSet::of(first).with(second);
    event.held = all;
    next_.state = restart;
    next_.touching = {};
    for (std::size_t i = 0; i < next_.starts.size(); ++i)
        if (all.contains(i)) next_.starts[i] = {};
    change_rates(before.v, all);
    begin_stretch(all, std::min(event.t, run_.options.end_time));
    return true;
}

// Nothing proves how a chatter that cannot be resolved any more ends. It is of these contacts and of what is near.
void Execution::end_chatter(ContactSet contacts) {
    constexpr double close = 1e-6;
    for (std::size_t i = 0; i < surfaces_->count(); ++i)
        if (surfaces_->of(i).at(next_.state).h < close) contacts = contacts.with(i);
    stop(Outcome::Kind::undecided,
         fmt::format("contacts {} chatter together, in flights shorter than floating point resolves, at {}",
                     names_of(contacts), where(next_.state)));
}

// As for one contact: the flight that begins now, to leading order.
bool Execution::too_short_to_resolve(std::size_t which, double hdot) {
    ContactKinematics& surface = surfaces_->of(which);
    const double a = -surface.normal_acceleration(next_.state);
    if (!(a > 0.0)) return false;
    return hdot * hdot / (2.0 * a) < 4.0 * surface.gap_error(next_.state) || 2.0 * hdot / a < 4.0 * ulp(next_.state.t);
}

// Contacts with h = 0 and hdot = 0: who of them is held, who leaves, who merely touches (theory-gaps.md 2.2). What was held
// before counts no more.
void Execution::decide(ContactSet closed) {
    next_.held = next_.touching = {};
    not_unique_ = false;
    if (closed.empty()) return;
    if (closed.count() > most_contacts)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("{} contacts are closed at once, more than the {} that can be decided: {}, at {}",
                                closed.count(), most_contacts, names_of(closed), where(next_.state)));
    const Closed all = surfaces_->at(next_.state, closed);
    ContactVector<double> hddot(all.W.rows());
    for (std::size_t i = 0; i < all.which.size(); ++i)
        hddot[static_cast<Eigen::Index>(i)] = surfaces_->of(all.which[i]).normal_acceleration(next_.state);
    const auto forces = solve_complementarity(all.W, hddot);
    if (!forces)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("no forces hold {}, at {}", names_of(closed), where(next_.state)));
    not_unique_ = !forces->unique;
    const ContactSet active = all.contacts_at(forces->active);
    const bool decided = forces->unique ? judge(closed, active) : hold_independent(all, hddot, forces->active);
    if (!decided)
        stop(Outcome::Kind::undecided,
             fmt::format("the contact force and its rate are zero to within rounding: contact or release cannot be "
                         "decided{}{} at {}",
                         surfaces_->count() > 1 ? " for " : "", surfaces_->count() > 1 ? names_of(closed) : "",
                         where(next_.state)));
}

// Contacts whose gradients depend on one another are held by some of them, which carry all: the gaps of the others stay 0
// with theirs.
bool Execution::hold_independent(const Closed& closed, const ContactVector<double>& hddot, ContactSet active) {
    ContactSet all;
    for (std::size_t i = 0; i < closed.which.size(); ++i) all = all.with(i);
    constexpr double pressed = 1e-9;  // a force below that part of the others is in doubt, and carries nothing
    const std::size_t count = closed.which.size();
    for (int size = static_cast<int>(count); size > 0; --size)
        for (std::uint32_t bits = 1; bits < 1u << count; ++bits) {
            ContactSet some;
            for (std::size_t i = 0; i < count; ++i)
                if (bits >> i & 1u) some = some.with(i);
            if (some.count() != size || !some.without(active).empty()) continue;
            const auto block = HeldBlock<double>::of(closed.W, some);
            if (!block) continue;
            const ContactVector<double> lambda = -block->solve(hddot);
            const ContactVector<double> y = hddot + closed.W * lambda;
            bool valid = true;
            ContactSet carried, others;
            for (std::size_t i = 0; i < count; ++i) {
                const auto k = static_cast<Eigen::Index>(i);
                const double scale = 1e-12 * (std::abs(hddot[k]) + closed.W.row(k).cwiseAbs().dot(lambda.cwiseAbs()));
                if (some.contains(i)) valid = valid && lambda[k] > pressed * lambda.cwiseAbs().maxCoeff();
                if (some.contains(i)) continue;
                valid = valid && y[k] >= -scale;
                const bool depends = block->transmission(closed.W, k).W <= HeldBlock<double>::clear * closed.W(k, k);
                // What neither depends on them nor leaves needs a force of its own: they do not carry all.
                if (!depends) valid = valid && y[k] > scale;
                (depends ? carried : others) = (depends ? carried : others).with(i);
            }
            if (!valid) continue;
            next_.touching = closed.contacts_at(carried);
            // What is carried is so by all of these.
            if (judge(closed.contacts_at(some.with(others)), closed.contacts_at(some)) &&
                closed.contacts_at(some).without(next_.held).empty())
                return true;
        }
    // At rest for ever nothing has to be told apart.
    const ContactSet pressed_ones = closed.contacts_at(active);
    if (!is_at_rest(pressed_ones)) return false;
    next_.held = pressed_ones;
    next_.touching = closed.contacts_at(all).without(pressed_ones);
    for (std::size_t i = 0; i < next_.starts.size(); ++i)
        if (pressed_ones.contains(i)) next_.starts[i] = {};
    return true;
}

// Those of the doubtful whose force grows from 0, while these are held.
ContactSet Execution::pressed_by_rates(ContactSet doubtful, ContactSet held) {
    const Closed closed = surfaces_->at(next_.state, doubtful.with(held));
    const auto block = HeldBlock<double>::of(closed.W, closed.places_of(held));
    if (!block) return {};
    std::vector<std::size_t> which;
    std::vector<Eigen::Index> places;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (doubtful.contains(closed.which[i])) {
            which.push_back(closed.which[i]);
            places.push_back(static_cast<Eigen::Index>(i));
        }
    const auto n = static_cast<Eigen::Index>(which.size());
    ContactMatrix<double> W(n, n);
    ContactVector<double> jerk(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto at = static_cast<std::size_t>(i);
        jerk[i] = surfaces_->of(which[at], held).jerk(next_.state);
        const ContactVector<double> kappa = block->transmission(closed.W, places[at]).kappa;
        for (Eigen::Index k = 0; k < n; ++k)
            W(k, i) = HeldBlock<double>::between(closed.W, places[static_cast<std::size_t>(k)], places[at], kappa);
    }
    const auto rates = solve_complementarity(W, jerk);
    ContactSet pressed;
    for (std::size_t i = 0; rates && i < which.size(); ++i)
        if (rates->active.contains(i)) pressed = pressed.with(which[i]);
    return pressed;
}

// Proves for each contact what the forces say of it: `active` are held by them, the others leave. Where that cannot be told,
// the rate of hddot along the motion decides, of one contact or of several that do not feel one another.
bool Execution::judge(ContactSet closed, ContactSet active) {
    ContactSet held, doubtful;
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (!closed.contains(i)) continue;
        const Interval hddot = surfaces_->of(i, active.without(i)).normal(next_.state).hddot;
        if (certainly_negative(hddot)) {
            held = held.with(i);
            next_.starts[i] = {};
        } else if (certainly_positive(hddot)) {
            next_.starts[i] = {{0.0, 0.0}, 2};
        } else {
            doubtful = doubtful.with(i);
        }
    }
    if (!doubtful.empty()) {
        // The rates of hddot decide, 0 <= mu perpendicular h''' + W mu >= 0 over the doubtful, as far as they are proved.
        ContactSet pressed = doubtful.count() == 1 ? doubtful : pressed_by_rates(doubtful, held);
        const bool alone = doubtful.count() == 1;
        for (std::size_t i = 0; i < surfaces_->count(); ++i) {
            if (!doubtful.contains(i)) continue;
            const auto normal = surfaces_->of(i, alone ? held : held.with(pressed).without(i)).normal(next_.state);
            if (certainly_negative(normal.jerk) && pressed.contains(i)) {
                held = held.with(i);
                next_.starts[i] = {{}, 1};
            } else if (certainly_positive(normal.jerk) && (alone || !pressed.contains(i))) {
                next_.starts[i] = {{0.0, 0.0}, 3};
            } else if (stays_closed(i, held)) {
                next_.touching = next_.touching.with(i);
            } else {
                return false;
            }
        }
    }
    next_.held = held;
    return true;
}

// Whether a contact with h = hdot = hddot = 0 stays so along the motion that holds these: where hddot is 0 everywhere, or
// the whole system is at rest for ever.
bool Execution::stays_closed(std::size_t contact, ContactSet held) {
    return (surfaces_->count() > 1 && model_->is_carried(contact, held)) || is_at_rest(held);
}

// What merely touches must go on to do so.
void Execution::check_touching() {
    if (next_.touching.empty()) return;
    constexpr double closed = 1e-9;
    const double size = 1.0 + next_.state.q.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < surfaces_->count(); ++i)
        if (next_.touching.contains(i) && !(std::abs(surfaces_->of(i).at(next_.state).h) <= closed * size))
            return stop(
                Outcome::Kind::redundant_contacts,
                fmt::format("{} was closed with {}, and is so no more: which of them carry cannot be decided, at {}",
                            names_of(ContactSet::of(i)), names_of(next_.held), where(next_.state)));
}

// Nothing moves, nothing depends on the time, and the forces that hold these leave no acceleration.
bool Execution::is_at_rest(ContactSet held) {
    if (!model_->equations().autonomous || next_.state.v != Vector::Zero(next_.state.v.size())) return false;
    const Closed closed = surfaces_->at(next_.state, held);
    ContactSet places;
    for (std::size_t i = 0; i < closed.which.size(); ++i) places = places.with(i);
    if (!held.empty() && !HeldBlock<double>::of(closed.W, places)) return false;
    auto motion = model_->evaluator(model_->motion(held).program, run_.parameters);
    MotionTerms<Evaluator<double>> terms(std::move(motion), static_cast<std::size_t>(model_->dof()),
                                         model_->contacts());
    set_state(terms, next_.state);
    terms.run();
    for (std::size_t i = 0; i < static_cast<std::size_t>(model_->dof()); ++i)
        if (terms.acceleration(i) != 0.0) return false;
    return true;
}

}  // namespace achilles
