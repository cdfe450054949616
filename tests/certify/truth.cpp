#include "certify/truth.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulate/contact_cache.hpp"
#include "simulate/impact.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

namespace {

void set_tolerances(Run& run, double eps) {
    auto& truncation = run.options.truncation;
    truncation.eps_q = truncation.eps_v = truncation.eps_t = eps;
}

std::size_t index_of_restitution(const Model& model) {
    const auto& parameters = model.description().parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i)
        if (parameters[i].name == "e") return i;
    throw std::invalid_argument("the trials vary the parameter e, which this system lacks");
}

// Rounding to double hides no violation: x has far more than 16 digits, and no bound is that tight.
double actual(const Real& x) { return static_cast<double>(x); }

}  // namespace

std::vector<Claim> claims(const Trial& trial, const CertificateCase& certified) {
    using ClaimKind = Claim::ClaimKind;
    const Certificate& c = certified.certificate;
    const Trial::RestartPoint& own = trial.restarted(certified.asked.reinitialization);
    const ZenoPoint& truth = *trial.zeno;
    const Real tau_k = own.collision.before.t;
    const auto since = [&](double t) { return actual(t - tau_k); };
    const double t = actual(truth.time), q = actual(distance(truth.point.q, own.restart.q)),
                 v = actual(distance(truth.point.v, own.restart.v));
    // If impacts change only hdot, the shadowing error and its bound are 0. The reference is accurate to `known`.
    const Real known = 1e-18 * own.collision.speed;
    const auto shadow = [&](const Reals& a, const Reals& b) {
        return actual(std::max(distance(a, b) - known, Real(0)));
    };
    const double shadow_q = shadow(truth.point.q, own.at_zeno.q), shadow_v = shadow(truth.point.v, own.at_zeno.v);
    std::vector<Claim> result{{ClaimKind::earliest, t, since(c.zeno_low)},
                              {ClaimKind::latest, since(c.zeno_high), t},
                              {ClaimKind::position, c.position_bound, q},
                              {ClaimKind::velocity, c.velocity_bound, v}};
    if (c.shadowing_position) result.push_back({ClaimKind::shadowing_position, *c.shadowing_position, shadow_q});
    if (c.shadowing_velocity) result.push_back({ClaimKind::shadowing_velocity, *c.shadowing_velocity, shadow_v});
    if (c.uniform_position) result.push_back({ClaimKind::uniform_position, *c.uniform_position, own.farthest});
    if (certified.best) {
        result.push_back({ClaimKind::best_estimate, *certified.best, c.zeno_low});
        result.push_back({ClaimKind::best_estimate, c.zeno_high, *certified.best});
    }
    // The certificate implies that held contacts stay held and open ones stay open.
    if (trial.least)
        for (const Reals* part : {&trial.least->forces, &trial.least->gaps, &trial.least->transmissions})
            for (const Real& x : *part) result.push_back({ClaimKind::others, actual(x), 0.0});
    if (c.others) {
        for (std::size_t i = 0; i < c.others->held.size(); ++i) {
            const Certificate::OtherContactBounds::HeldContactBound& held = c.others->held[i];
            result.push_back({ClaimKind::others, actual(trial.least->forces[i]), held.least_force});
            result.push_back({ClaimKind::others, actual(trial.least->transmissions[i]), held.transmission_low});
            result.push_back({ClaimKind::others, held.transmission_high, actual(trial.most->transmissions[i])});
        }
        for (const Real& gap : trial.least->gaps)
            result.push_back({ClaimKind::others, actual(gap), *c.others->least_gap});
    }
    if (!certified.held) return result;
    // The requested tolerances: Def. 7 bounds the distance to the Zeno point, the sharp conditions its uncertainty.
    const bool paper = c.conditions == Conditions::paper;
    const double half_width = 0.5 * (c.zeno_high - c.zeno_low);
    result.push_back({ClaimKind::tolerance, certified.asked.eps_t, paper ? t : half_width});
    result.push_back({ClaimKind::tolerance, certified.asked.eps_q, paper ? q : shadow_q});
    result.push_back({ClaimKind::tolerance, certified.asked.eps_v, paper ? v : shadow_v});
    return result;
}

double largest_excursion(const Trial& trial, Reinitialization kind) {
    const Trial::RestartPoint& own = trial.restarted(kind);
    Real most = distance(trial.zeno->point.v, own.restart.v);
    for (const Reals& v : trial.zeno->velocities) most = std::max(most, distance(v, own.restart.v));
    return actual(most);
}

Trials::Trials(std::shared_ptr<const Model> model, unsigned seed, Vary vary)
    : model_(std::move(model)), random_(seed), vary_(vary) {}

// Own formula, since the distributions of the standard library differ between implementations.
double Trials::uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

std::size_t Trials::any_of(std::size_t count) { return static_cast<std::size_t>(random_() % count); }

// A random Zeno equilibrium: this contact and the held ones at h = 0 with positive force, the other gaps open.
std::optional<State> Trials::zeno_equilibrium(Trial& trial) {
    State state = trial.run.start();
    const auto& coordinates = model_->description().coordinates;
    const std::size_t contacts = model_->contacts();
    if (vary_ == Vary::everything) {
        state.t = uniform(0.0, trial.run.options.end_time);
        for (double& x : state.q) x += uniform(-1.5, 1.5);
        for (double& x : state.v) x += uniform(-1.0, 1.0);
        trial.contact = any_of(contacts);
        trial.mode = {};
        const std::size_t other = any_of(contacts);
        if (other != trial.contact && any_of(2) == 1) trial.mode = Mode::holding(ContactSet::of(other));
    } else {
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            state.q[k] = uniform(coordinates[i].range[0], coordinates[i].range[1]);
            state.v[k] = uniform(coordinates[i].rate_range[0], coordinates[i].rate_range[1]);
        }
    }
    ContactCache surfaces(*model_, trial.run);
    const ContactSet closed = trial.mode.held().with(trial.contact);
    if (!surfaces.project(state, closed, closed)) return std::nullopt;
    if (!(surfaces.of(trial.contact, trial.mode).normal_acceleration(state) < 0.0)) return std::nullopt;
    for (std::size_t j = 0; j < contacts; ++j) {
        const bool fits = closed.contains(j) ? surfaces.of(j, trial.mode.without(j)).normal_acceleration(state) < 0.0
                                             : surfaces.of(j).at(state).h > 0.0;
        if (!fits) return std::nullopt;
    }
    return state;
}

void Trials::collide(Trial& trial, const State& before) const {
    const Contact contact = ContactKinematics(*model_, trial.run, trial.contact, trial.mode).at(before);
    const auto collision = [&](Reinitialization kind) {
        return Collision{before, std::abs(contact.hdot), reinitialize(contact, before.v, Reinitialization::kinetic),
                         reinitialize(contact, before.v, kind)};
    };
    trial.kinetic.collision = collision(Reinitialization::kinetic);
    trial.euclidean.collision = collision(Reinitialization::euclidean);
}

void Trials::certify(Trial& trial, const State& before) {
    Run run = trial.run;
    for (const auto conditions : {Conditions::paper, Conditions::sharp}) {
        for (const auto kind : {Reinitialization::kinetic, Reinitialization::euclidean}) {
            run.options.truncation.conditions = conditions;
            run.options.truncation.reinitialization = kind;
            const auto prover = truncation_conditions(*model_, run, trial.contact, trial.mode);
            const Collision& own = trial.restarted(kind).collision;
            if (auto c = prover->certify(own))
                trial.certified.push_back({run.options.truncation, true, *c, best_estimate(run, before, *c)});
            if (auto c = prover->prove_any(own)) trial.certified.push_back({run.options.truncation, false, *c, {}});
        }
    }
}

// Returns nullopt if simulate() does not cut here, since its estimate in double precision predicted no proof. The same
// if it rejects the start because rounding made the gap slightly negative.
std::optional<double> Trials::best_estimate(Run run, const State& before, const Certificate& certificate) const {
    run.q = before.q;
    run.v = before.v;
    run.options.start_time = before.t;
    run.options.end_time = 2.0 * certificate.zeno_high - before.t + 1e-9;
    run.options.max_impacts = 1;
    try {
        for (const Event& event : simulate(model_, run).events)
            if (event.kind == Event::Kind::zeno && event.truncation->t == before.t) return event.t;
    } catch (const InputError&) {
    }
    return std::nullopt;
}

Run Trials::any_run() {
    Run run = model_->default_run();
    if (vary_ == Vary::everything)
        for (double& parameter : run.parameters) parameter *= uniform(0.5, 1.5);
    run.parameters[index_of_restitution(*model_)] = uniform(0.0, 0.95);
    return run;
}

Trial Trials::next() {
    Trial trial;
    trial.run = any_run();
    std::optional<State> state;
    while (!state) state = zeno_equilibrium(trial);
    const double w = std::pow(10.0, uniform(-5.0, 0.0));
    set_tolerances(trial.run, std::pow(10.0, uniform(-6.0, -1.0)));
    ContactKinematics surface(*model_, trial.run, trial.contact, trial.mode);
    state->v -= w * surface.at(*state).impulse_direction;
    collide(trial, *state);
    certify(trial, *state);
    if (!trial.certified.empty()) find_truth(trial, *state);
    return trial;
}

std::vector<Trial> Trials::next_run() {
    Run run = any_run();
    for (double& x : run.q) x += uniform(-0.3, 0.3);
    for (double& x : run.v) x += uniform(-0.5, 0.5);
    set_tolerances(run, std::pow(10.0, uniform(-6.0, -1.0)));
    run.options.max_impacts = 2000;
    std::vector<Trial> trials;
    try {
        for (const Event& event : simulate(model_, run).events) {
            if (event.kind != Event::Kind::zeno || is_plastic_landing(event)) continue;
            if (!event.contacts.has_one()) continue;  // the reference motion has one bouncing contact
            Trial& trial = trials.emplace_back();
            trial.run = run;
            while (!event.contacts.contains(trial.contact)) ++trial.contact;
            trial.mode = event.mode.without(event.contacts);
            const State before{event.truncation->q, event.truncation->v_before, event.truncation->t};
            collide(trial, before);
            trial.certified.push_back(
                {run.options.truncation, !event.certificate->cut_at_resolution, *event.certificate, event.t});
            find_truth(trial, before);
        }
    } catch (const InputError&) {  // negative gap at the start
    }
    return trials;
}

void Trials::find_truth(Trial& trial, const State& before) const {
    TrueMotion motion(*model_, trial.run, 1e300, trial.contact, trial.mode);
    const Point collision = motion.collision(before);
    const double tolerance = 1e-20 * trial.kinetic.collision.speed;
    trial.zeno = motion.zeno(collision);
    if (!trial.zeno) return;
    const auto inside = motion.inside(*trial.zeno, tolerance);
    Reals times;
    for (const Instant& instant : inside) times.push_back(instant.time);
    for (const auto kind : {Reinitialization::kinetic, Reinitialization::euclidean}) {
        auto& restarted = kind == Reinitialization::kinetic ? trial.kinetic : trial.euclidean;
        restarted.restart = motion.restart(collision, kind);
        restarted.at_zeno = motion.constrained(restarted.restart, trial.zeno->time, tolerance);
        restarted.farthest = actual(distance(trial.zeno->point.q, restarted.at_zeno.q));
        const auto drawn = motion.contact_at(restarted.restart, times, tolerance);
        for (std::size_t i = 0; i < inside.size(); ++i)
            restarted.farthest = std::max(restarted.farthest, actual(distance(inside[i].point.q, drawn[i].q)));
    }
    if (model_->contacts() == 1) return;
    const auto look = [&](const Point& point) {
        const TrueMotion::OtherContacts now = motion.others(point);
        if (!trial.least) trial.least = trial.most = now;
        for (const auto part : {&TrueMotion::OtherContacts::forces, &TrueMotion::OtherContacts::gaps,
                                &TrueMotion::OtherContacts::transmissions})
            for (std::size_t i = 0; i < (now.*part).size(); ++i) {
                const Real& x = (now.*part)[i];
                Real &low = ((*trial.least).*part)[i], &high = ((*trial.most).*part)[i];
                if (x < low) low = x;
                if (x > high) high = x;
            }
    };
    look(collision);
    for (const Instant& instant : inside) look(instant.point);
    look(trial.zeno->point);
}

}  // namespace achilles::test
