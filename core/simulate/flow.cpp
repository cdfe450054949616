#include "simulate/flow.hpp"

#include <algorithm>

// Must stand first: dense_output_runge_kutta.hpp forgets to include it.
#include <boost/numeric/odeint/util/unwrap_reference.hpp>

#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

namespace odeint = boost::numeric::odeint;
using Values = std::vector<double>;  // q, v, then what is watched: h, hdot in flight; hddot, 0 in contact
using Dopri5 = odeint::runge_kutta_dopri5<Values>;
using Dense = odeint::result_of::make_dense_output<Dopri5>::type;

bool is_finite(const Values& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

struct Flow::Stepper {
    Stepper(const Model& model, const Run& run)
        : n(static_cast<std::size_t>(model.n())),
          tolerance(run.options.tolerance),
          dense(odeint::make_dense_output(tolerance, tolerance, Dopri5())),
          flight(model.evaluator(model.flight(), run.parameters)),
          contact(model.evaluator(model.contact(), run.parameters)) {}

    // y' = (v, f, hdot, hddot) or (v, f_c, h''', 0). Where M is not positive definite the derivative is NaN, and with
    // it the step.
    void derivative(const Values& y, Values& dydt) {
        ++evaluations;
        Evaluator<double>& program = motion == Motion::flight ? flight : contact;
        for (std::size_t i = 0; i < 2 * n; ++i) program.input(i) = y[i];
        program.run();
        bool regular = true;
        for (std::size_t i = 0; i < n; ++i) regular = regular && program.output(n + 1 + i) > 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            dydt[i] = y[n + i];
            dydt[n + i] = regular ? program.output(i) : std::numeric_limits<double>::quiet_NaN();
        }
        dydt[2 * n] = motion == Motion::flight ? y[2 * n + 1] : program.output(2 * n + 1);
        dydt[2 * n + 1] = motion == Motion::flight ? program.output(n) : 0.0;
    }
    auto system() {
        return [this](const Values& y, Values& dydt, double) { derivative(y, dydt); };
    }

    // Time runs from 0 in every step, so that the shortest flight late in a run has all its digits.
    void set(double dt) {
        Values y = values_of(from);
        if (motion == Motion::flight) {
            y[2 * n] = gap.h;
            y[2 * n + 1] = gap.hdot;
        } else {  // hddot of the state itself: the last output of a step may have been moved
            for (std::size_t i = 0; i < 2 * n; ++i) contact.input(i) = y[i];
            contact.run();
            y[2 * n] = contact.output(n);
        }
        dense.initialize(y, 0.0, dt);
    }

    State state_of(const Values& y) const {
        State state{Vector(static_cast<Eigen::Index>(n)), Vector(static_cast<Eigen::Index>(n))};
        for (std::size_t i = 0; i < n; ++i) {
            state.q[static_cast<Eigen::Index>(i)] = y[i];
            state.v[static_cast<Eigen::Index>(i)] = y[n + i];
        }
        return state;
    }

    // Dense output at theta = 0, 1/4, 1/2, 3/4, 1: a quartic is known by these.
    bool sample_step() {
        const double begin = dense.previous_time(), length = dense.current_time() - begin;
        for (std::size_t k = 0; k < 5; ++k) {
            nodes[k].resize(2 * n + 2);
            if (k == 0) nodes[k] = dense.previous_state();
            if (k == 4) nodes[k] = dense.current_state();
            if (k > 0 && k < 4) dense.calc_state(begin + 0.25 * static_cast<double>(k) * length, nodes[k]);
            if (!is_finite(nodes[k])) return false;
        }
        return true;
    }

    // Steps from `from` by dt, or less if the error control or the domain asks for it.
    Obstacle advance(double dt);
    Obstacle accept();
    Obstacle obstacle_here();
    Values values_of(const State& state) const {
        Values y(2 * n + 2, 0.0);
        for (std::size_t i = 0; i < n; ++i) {
            y[i] = state.q[static_cast<Eigen::Index>(i)];
            y[n + i] = state.v[static_cast<Eigen::Index>(i)];
        }
        return y;
    }

    std::size_t n;
    double tolerance;
    Dense dense;
    Evaluator<double> flight, contact;
    Motion motion = Motion::flight;
    double t = 0.0, span = 0.0;  // of the last step
    double natural = 0.0;        // the step the error control would take next; 0: not known
    double first = 0.0;          // bound on the next step; 0: none
    State from, to;              // the last step's ends
    Gap gap, next_gap;           // in flight: at `from`, and at `to` where the next step starts
    bool continuing = false;     // the stepper itself stands at `to`, ready for the natural step
    std::array<Values, 5> nodes;
    long evaluations = 0;
};

// What a step that never became finite means: the state itself tells.
Flow::Obstacle Flow::Stepper::obstacle_here() {
    for (const double y : values_of(from))
        if (!(std::abs(y) < 1e150)) return Obstacle::not_a_number;  // it ran away to infinity
    return Obstacle::left_the_domain;
}

// Reads the step that was just made.
Flow::Obstacle Flow::Stepper::accept() {
    if (!sample_step()) return Obstacle::not_a_number;
    span = dense.current_time() - dense.previous_time();
    to = state_of(nodes[4]);
    next_gap = {nodes[4][2 * n], nodes[4][2 * n + 1]};
    return Obstacle::none;
}

Flow::Obstacle Flow::Stepper::advance(double dt) {
    // Shorter than half the resolution of time is no step.
    const double least = 1e-16 * std::max(1e-3, std::abs(t));
    bool finite = true;
    for (; dt > least; dt *= 0.25) {
        set(dt);
        try {
            dense.do_step(system());
        } catch (const odeint::odeint_error&) {  // 500 rejections in a row
            return Obstacle::step_too_small;
        }
        finite = accept() == Obstacle::none;
        if (finite) return span > least ? Obstacle::none : Obstacle::step_too_small;
    }
    return finite ? Obstacle::step_too_small : obstacle_here();
}

Flow::Flow(const Model& model, const Run& run) : stepper_(std::make_unique<Stepper>(model, run)) {}
Flow::~Flow() = default;

void Flow::fly(double t, const State& state, const Gap& gap, double first_step) {
    start(Motion::flight, t, state, first_step);
    stepper_->next_gap = gap;
}

void Flow::stay(double t, const State& state) { start(Motion::contact, t, state, 0.0); }

void Flow::start(Motion motion, double t, const State& state, double first_step) {
    Stepper& s = *stepper_;
    s.motion = motion;
    s.t = t;
    s.span = 0.0;
    s.to = state;
    s.first = first_step;
    s.continuing = false;
    if (s.natural > 0.0) return;
    // The first stretch of a run: a guess from the first derivative, which the error control corrects at once.
    Values dydt(2 * s.n + 2);
    const Values y = s.values_of(state);
    s.derivative(y, dydt);
    double size = 1e-3, rate = 1e-3;
    for (std::size_t i = 0; i < 2 * s.n; ++i) {
        size = std::max(size, std::abs(y[i]));
        rate = std::max(rate, std::abs(dydt[i]));
    }
    s.natural = std::isfinite(rate) ? size / rate * std::pow(s.tolerance, 0.2) : 1e-3;
}

Flow::Obstacle Flow::step(double longest) {
    Stepper& s = *stepper_;
    const double wanted = s.first > 0.0 ? std::min(s.first, s.natural) : s.natural;
    const bool by_order = wanted < s.natural || wanted > longest;
    s.first = 0.0;
    s.t += s.span;
    s.from = s.to;
    s.gap = s.next_gap;
    Obstacle obstacle = Obstacle::not_a_number;
    if (s.continuing && !by_order) {
        try {
            s.dense.do_step(s.system());
            obstacle = s.accept();
        } catch (const odeint::odeint_error&) {
            return Obstacle::step_too_small;
        }
    }
    if (obstacle != Obstacle::none) obstacle = s.advance(std::min(wanted, longest));
    if (obstacle != Obstacle::none) return obstacle;
    // A step that was short by order says nothing about what the error control would allow.
    const double next = s.dense.current_time_step();
    s.natural = by_order ? std::max(next, s.natural) : next;
    s.continuing = true;
    return obstacle;
}

Flow::Obstacle Flow::retake(double duration) {
    stepper_->continuing = false;
    return stepper_->advance(duration);
}

void Flow::move_end(const State& state) {
    stepper_->to = state;
    stepper_->continuing = false;
}

void Flow::move_gap(const Gap& gap) {
    stepper_->next_gap = gap;
    stepper_->continuing = false;
}

void Flow::shift_end(double dt) {
    Stepper& s = *stepper_;
    Values dydt(2 * s.n + 2);
    s.derivative(s.values_of(s.to), dydt);
    for (Eigen::Index i = 0; i < s.to.q.size(); ++i) {
        const double a = dydt[s.n + static_cast<std::size_t>(i)];
        s.to.q[i] += dt * (s.to.v[i] + 0.5 * dt * a);
        s.to.v[i] += dt * a;
    }
    s.span += dt;
    s.continuing = false;
}

Polynomial Flow::watched() const {
    const Stepper& s = *stepper_;
    const std::size_t i = 2 * s.n;
    return interpolate({s.nodes[0][i], s.nodes[1][i], s.nodes[2][i], s.nodes[3][i], s.nodes[4][i]});
}

Piece Flow::piece(std::vector<double>& coefficients) const {
    const Stepper& s = *stepper_;
    Piece piece;
    piece.start = s.t;
    piece.end = s.t + s.span;
    piece.first = coefficients.size();
    piece.degree = 4;
    piece.contact = s.motion == Motion::contact;
    coefficients.resize(piece.first + 10 * s.n);
    const Values end = s.values_of(s.to);
    for (std::size_t i = 0; i < 2 * s.n; ++i) {
        Polynomial p = interpolate({s.nodes[0][i], s.nodes[1][i], s.nodes[2][i], s.nodes[3][i], s.nodes[4][i]});
        p.c[1] += end[i] - p(1.0);  // an end that was moved onto the surface is met
        for (std::size_t k = 0; k <= 4; ++k) coefficients[piece.first + 2 * s.n * k + i] = p.c[k];
    }
    return piece;
}

double Flow::begin_time() const { return stepper_->t; }
double Flow::duration() const { return stepper_->span; }
const State& Flow::end() const { return stepper_->to; }
long Flow::evaluations() const { return stepper_->evaluations; }

}  // namespace achilles
