#include "certify/truth.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulate/impact.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

namespace {

std::size_t index_of_restitution(const Model& model) {
    const auto& parameters = model.description().parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i)
        if (parameters[i].name == "e") return i;
    throw std::invalid_argument("the trials vary the parameter e, which this system lacks");
}

// Known to far more than 16 digits, and rounding it cannot turn a violation into none: bounds are never that tight.
double actual(const Real& x) { return static_cast<double>(x); }

}  // namespace

std::vector<Claim> claims(const Trial& trial, const Certified& certified) {
    using About = Claim::About;
    const Certificate& c = certified.certificate;
    const Trial::Restarted& own = trial.restarted(certified.asked.reinitialization);
    const ZenoPoint& truth = *trial.zeno;
    const double t = actual(truth.time), q = actual(distance(truth.point.q, own.restart.q)),
                 v = actual(distance(truth.point.v, own.restart.v));
    const double shadow_q = actual(distance(truth.point.q, own.at_zeno.q)),
                 shadow_v = actual(distance(truth.point.v, own.at_zeno.v));
    std::vector<Claim> result{{About::earliest, t, c.zeno_low},
                              {About::latest, c.zeno_high, t},
                              {About::position, c.position_bound, q},
                              {About::velocity, c.velocity_bound, v}};
    if (c.shadowing_position) result.push_back({About::shadowing_position, *c.shadowing_position, shadow_q});
    if (c.shadowing_velocity) result.push_back({About::shadowing_velocity, *c.shadowing_velocity, shadow_v});
    if (c.uniform_position) result.push_back({About::uniform_position, *c.uniform_position, own.farthest});
    if (certified.best) {
        result.push_back({About::best_estimate, *certified.best, c.zeno_low});
        result.push_back({About::best_estimate, c.zeno_high, *certified.best});
    }
    if (!certified.held) return result;
    // What was asked for: Def. 7 limits how far the Zeno point is, the sharp conditions how well it is known.
    const bool paper = c.conditions == Conditions::paper;
    const double half_width = 0.5 * (c.zeno_high - c.zeno_low);
    result.push_back({About::tolerance, certified.asked.eps_t, paper ? t : half_width});
    result.push_back({About::tolerance, certified.asked.eps_q, paper ? q : shadow_q});
    result.push_back({About::tolerance, certified.asked.eps_v, paper ? v : shadow_v});
    return result;
}

double largest_excursion(const Trial& trial, Reinitialization kind) {
    const Trial::Restarted& own = trial.restarted(kind);
    Real most = distance(trial.zeno->point.v, own.restart.v);
    for (const Reals& v : trial.zeno->velocities) most = std::max(most, distance(v, own.restart.v));
    return actual(most);
}

Trials::Trials(std::shared_ptr<const Model> model, unsigned seed) : model_(std::move(model)), random_(seed) {}

// Written out, since the standard's distributions differ between libraries.
double Trials::uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

std::optional<State> Trials::zeno_equilibrium(const Run& run) {
    ContactKinematics surface(*model_, run);
    State state{run.q, run.v};
    const auto& coordinates = model_->description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        state.q[k] = uniform(coordinates[i].range[0], coordinates[i].range[1]);
        state.v[k] = uniform(coordinates[i].rate_range[0], coordinates[i].rate_range[1]);
    }
    if (!surface.project(state, false) || !(surface.normal_acceleration(state) < 0.0)) return std::nullopt;
    return state;
}

void Trials::certify(Trial& trial, const State& before) {
    const Contact contact = ContactKinematics(*model_, trial.run).at(before);
    const auto collision = [&](Reinitialization kind) {
        return Collision{before, std::abs(contact.hdot), reinitialize(contact, before.v, Reinitialization::kinetic),
                         reinitialize(contact, before.v, kind)};
    };
    trial.kinetic.collision = collision(Reinitialization::kinetic);
    trial.euclidean.collision = collision(Reinitialization::euclidean);
    Run run = trial.run;
    for (const auto conditions : {Conditions::paper, Conditions::sharp}) {
        for (const auto kind : {Reinitialization::kinetic, Reinitialization::euclidean}) {
            run.options.truncation.conditions = conditions;
            run.options.truncation.reinitialization = kind;
            const auto prover = truncation_conditions(*model_, run);
            const Collision& own = trial.restarted(kind).collision;
            if (auto c = prover->certify(own))
                trial.certified.push_back({run.options.truncation, true, *c, best_estimate(run, before, *c)});
            if (auto c = prover->prove_any(own)) trial.certified.push_back({run.options.truncation, false, *c, {}});
        }
    }
}

// Nothing where simulate() goes on bouncing, since its guess whether a proof is worth while said no, or refuses the
// start, which rounding has put a little further below the surface than an input may be.
std::optional<double> Trials::best_estimate(Run run, const State& before, const Certificate& certificate) const {
    run.q = before.q;
    run.v = before.v;
    run.options.end_time = 2.0 * certificate.zeno_high + 1e-9;
    run.options.max_impacts = 1;
    try {
        for (const Event& event : simulate(model_, run).events)
            if (event.kind == Event::Kind::zeno && event.truncation->t == 0.0) return event.t;
    } catch (const InputError&) {
    }
    return std::nullopt;
}

Trial Trials::next() {
    Trial trial;
    trial.run = model_->default_run();
    trial.run.parameters[index_of_restitution(*model_)] = uniform(0.0, 0.95);
    std::optional<State> state;
    while (!state) state = zeno_equilibrium(trial.run);
    const double w = std::pow(10.0, uniform(-5.0, 0.0)), eps = std::pow(10.0, uniform(-6.0, -1.0));
    auto& truncation = trial.run.options.truncation;
    truncation.eps_q = truncation.eps_v = truncation.eps_t = eps;
    state->v -= w * ContactKinematics(*model_, trial.run).at(*state).impulse_direction;
    certify(trial, *state);
    if (trial.certified.empty()) return trial;

    TrueMotion motion(*model_, trial.run);
    const Point collision = motion.collision(*state);
    trial.zeno = motion.zeno(collision);
    if (!trial.zeno) return trial;
    const auto inside = motion.inside(*trial.zeno, 1e-20 * w);
    Reals times;
    for (const Instant& instant : inside) times.push_back(instant.time);
    for (const auto kind : {Reinitialization::kinetic, Reinitialization::euclidean}) {
        auto& restarted = kind == Reinitialization::kinetic ? trial.kinetic : trial.euclidean;
        restarted.restart = motion.restart(collision, kind);
        restarted.at_zeno = motion.constrained(restarted.restart, trial.zeno->time, 1e-20 * w);
        restarted.farthest = actual(distance(trial.zeno->point.q, restarted.at_zeno.q));
        const auto drawn = motion.contact_at(restarted.restart, times, 1e-20 * w);
        for (std::size_t i = 0; i < inside.size(); ++i)
            restarted.farthest = std::max(restarted.farthest, actual(distance(inside[i].point.q, drawn[i].q)));
    }
    return trial;
}

}  // namespace achilles::test
