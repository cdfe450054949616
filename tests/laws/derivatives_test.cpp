// Compares every program of every model with finite differences of L and h in 50 digits, where the differences are
// practically exact. So simulate() evaluates the Euler-Lagrange equations and the formulas of theory.md 1.
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <functional>
#include <numeric>
#include <random>
#include <utility>

#include "laws/laws.hpp"

namespace achilles::test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;
using Reals = std::vector<Real>;

// A function of the state x = (q, v, t), and its derivative along a direction.
using Function = std::function<Real(const Reals&)>;

Reals moved(Reals x, const Reals& direction, const Real& by) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += by * direction[i];
    return x;
}

// Central difference. The truncation error h^2 and the cancellation error 1e-50/h are both near 1e-32.
Real along(const Function& function, const Reals& x, const Reals& direction) {
    const Real h = 1e-16;
    return (function(moved(x, direction, h)) - function(moved(x, direction, -h))) / (2 * h);
}

Reals joined(const Reals& a, const Reals& b, const Real& t) {
    Reals result = a;
    result.insert(result.end(), b.begin(), b.end());
    result.push_back(t);
    return result;
}

// Inputs of a program beside the state: hdot and the slip in shifted variables, and the sliding speed of a coefficient.
struct Shift {
    Shift(Real hdot = 0, Real slip = 0, Real speed = 0)
        : sigma(std::move(hdot)), second_sigma(std::move(slip)), sliding_speed(std::move(speed)) {}
    Real sigma, second_sigma, sliding_speed;
};

void expect_same(const Real& found, const Real& expected, const std::string& what) {
    const Real scale = std::max<Real>(1, abs(expected));
    EXPECT_LE(abs(found - expected), 1e-12 * scale) << what << ": " << found << " and not " << expected;
}

class Derivatives : public Law {
 protected:
    void SetUp() override {
        model_ = model_of(GetParam().system);
        dof_ = static_cast<std::size_t>(model_->dof());
    }

    // Outputs [first, first + count) of a program at (q, v, t), and at these further inputs if the program has them.
    Reals evaluate(const Program& program, const Reals& x, std::size_t first, std::size_t count,
                   const Shift& shift = {}) const {
        auto evaluator = model_->evaluator<Real>(program, model_->default_run().parameters);
        for (std::size_t i = 0; i < 2 * dof_; ++i) evaluator.input(i) = x[i];
        evaluator.input(model_->layout().t()) = x.back();
        evaluator.input(model_->layout().sigma()) = shift.sigma;
        evaluator.input(model_->layout().second_sigma()) = shift.second_sigma;
        if (model_->has_friction()) evaluator.input(model_->layout().sliding_speed()) = shift.sliding_speed;
        evaluator.run();
        Reals result;
        for (std::size_t i = first; i < first + count; ++i) result.push_back(evaluator.output(i));
        return result;
    }
    Function output(const Program& program, std::size_t index, const Shift& shift = {}) const {
        return [this, &program, index, shift](const Reals& x) { return evaluate(program, x, index, 1, shift)[0]; };
    }
    Reals unit(std::size_t i) const {
        Reals e(2 * dof_ + 1, 0);
        e[i] = 1;
        return e;
    }
    Reals q(const Reals& x) const { return {x.begin(), x.begin() + static_cast<std::ptrdiff_t>(dof_)}; }
    Reals v(const Reals& x) const { return {x.begin() + static_cast<std::ptrdiff_t>(dof_), x.end() - 1}; }
    // Rate of the state (q, v, t) for this acceleration.
    Reals flow(const Reals& x, const Reals& acceleration) const { return joined(v(x), acceleration, 1); }
    // dT/dv_i, and component i of M times a vector, computed as dT/dv at that velocity.
    Real momentum(const Reals& x, std::size_t i) const { return along(output(model_->energy(), 1), x, unit(dof_ + i)); }
    Real mass_times(const Reals& x, const Reals& vector, std::size_t i) const {
        return momentum(joined(q(x), vector, x.back()), i);
    }

    bool has_contact() const { return model_->contacts() > 0; }
    bool is_rough(std::size_t contact) const { return model_->equations().friction.contains(contact); }
    // M^-1 g' or, with friction, M^-1 d' of contact 0, and the gradients g and d.
    Reals by_force(const Reals& x) const {
        Reals a = evaluate(model_->contact_terms(), x, 2, dof_);
        const Real W = evaluate(model_->contact_terms(), x, 2 + 2 * dof_, 1)[0];
        for (Real& each : a) each *= W;
        return a;
    }
    Reals by_friction(const Reals& x) const { return evaluate(model_->slip_terms(0), x, 5 + dof_, dof_); }
    Reals g(const Reals& x) const { return evaluate(model_->contact_terms(), x, 2 + dof_, dof_); }
    Reals d(const Reals& x) const { return evaluate(model_->slip_terms(0), x, 5, dof_); }
    // n, or n_sigma = M^-1 (g' - sign mu d')/W_sigma of a slip with this sign, with the coefficient at the slip of x
    // (theory-friction.md 2 and 4.1).
    Reals direction(const Reals& x, int sign) const {
        Reals n = by_force(x);
        if (sign != 0) {
            const Real u = output(model_->slip_terms(0), 0)(x);
            const Real factor = sign * evaluate(model_->slip_terms(0), x, 3, 1, {0, 0, sign * u})[0];
            n = moved(n, by_friction(x), -factor);
        }
        const Real W = product(g(x), n);
        for (Real& each : n) each /= W;
        return n;
    }
    static Real product(const Reals& a, const Reals& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), Real(0));
    }
    // N = M^-1 [g', d'] W^-1 (theory-friction.md 4.2)
    std::array<Reals, 2> directions(const Reals& x) const {
        const Reals by_g = by_force(x), by_d = by_friction(x);
        const Real W = product(g(x), by_g), W_NT = product(g(x), by_d), W_TT = product(d(x), by_d),
                   det = W * W_TT - W_NT * W_NT, zero = 0;
        return {moved(moved(Reals(dof_, zero), by_g, W_TT / det), by_d, -W_NT / det),
                moved(moved(Reals(dof_, zero), by_d, W / det), by_g, -W_NT / det)};
    }

    // Random states in the ranges of the sliders at which M is positive definite and all values are finite.
    std::vector<Reals> states() const {
        std::mt19937 random(7);
        std::vector<Reals> result;
        const auto& coordinates = model_->description().coordinates;
        while (result.size() < 4) {
            Reals x;
            for (const auto& c : coordinates)
                x.push_back(std::uniform_real_distribution(c.range[0], c.range[1])(random));
            for (const auto& c : coordinates)
                x.push_back(std::uniform_real_distribution(c.rate_range[0], c.rate_range[1])(random));
            x.push_back(std::uniform_real_distribution(0.0, 5.0)(random));
            const Reals flight = evaluate(model_->motion({}).program, x, 0, 2 * dof_ + (has_contact() ? 1 : 0));
            bool regular = true;
            for (std::size_t i = 0; i < flight.size(); ++i)
                regular = regular && isfinite(flight[i]) && (i < dof_ || i == 2 * dof_ || flight[i] > 0);
            if (regular) result.push_back(x);
        }
        return result;
    }

    std::shared_ptr<const Model> model_;
    std::size_t dof_ = 0;
};

// d/dt dL/dv = dL/dq + Q along f, and the energy changes at the rate Q'v + dV/dt.
TEST_P(Derivatives, FreeMotionIsLagranges) {
    const Program forces(model_->equations().Q, model_->layout().slots());
    for (const Reals& x : states()) {
        const Reals motion = flow(x, evaluate(model_->motion({}).program, x, 0, dof_));
        const Function energy = output(model_->energy(), 0), T = output(model_->energy(), 1),
                       V = output(model_->energy(), 2);
        const Reals Q = forces.output_count() == 0 ? Reals(dof_, 0) : evaluate(forces, x, 0, dof_);
        Real power = along(V, x, unit(2 * dof_));
        for (std::size_t i = 0; i < dof_; ++i) power += Q[i] * x[dof_ + i];
        expect_same(along(energy, x, motion), power, "the rate of the energy");
        expect_same(output(model_->power({}), 0)(x), power, "the power");
        expect_same(energy(x), T(x) + V(x), "the energy");
        for (std::size_t i = 0; i < dof_; ++i) {
            const Real rate = along([&](const Reals& at) { return momentum(at, i); }, x, motion);
            expect_same(rate, along(T, x, unit(i)) - along(V, x, unit(i)) + Q[i], "the momentum's rate");
        }
    }
}

// hdot and hddot along f; W and n from M; f_c keeps hdot, and its force is g' lambda; h''' along f_c. With friction,
// the force and f_c are those of a mode, which sticks.
TEST_P(Derivatives, NormalQuantitiesAreThoseOfTheGap) {
    if (!has_contact()) return;
    const Program& surface = model_->contact_terms();
    // Without the constraint, but with the forces of contact.
    const Mode contact = Mode::holding(ContactSet::of(0)), open = model_->unconstrained(contact, 0);
    const Model::ContactPrograms& programs = model_->programs_of(0, open);
    const Function gap = output(model_->gap(), 0), hdot = output(surface, 1),
                   hddot = output(model_->motion(open).program, 2 * dof_);
    for (const Reals& x : states()) {
        const Reals f = evaluate(model_->motion(open).program, x, 0, dof_), free = flow(x, f);
        const Reals n = evaluate(surface, x, 2, dof_);
        const Real W = evaluate(surface, x, 2 + 2 * dof_, 1)[0];
        expect_same(output(surface, 0)(x), gap(x), "h");
        expect_same(hdot(x), along(gap, x, free), "hdot");
        expect_same(hddot(x), along(hdot, x, free), "hddot");
        expect_same(product(g(x), n), 1, "g n");
        for (std::size_t i = 0; i < dof_; ++i) {
            expect_same(g(x)[i], along(gap, x, unit(i)), "g");
            expect_same(W * mass_times(x, n, i), g(x)[i], "W M n");
        }
        const Reals f_c = evaluate(model_->motion(Mode::holding(ContactSet::of(0))).program, x, 0, dof_),
                    held = flow(x, f_c);
        expect_same(along(hdot, x, held), 0, "hddot in contact");
        if (model_->has_friction()) continue;
        const Real lambda = evaluate(programs.force, x, 0, 1)[0];
        expect_same(lambda, -hddot(x) / W, "lambda");
        for (std::size_t i = 0; i < dof_; ++i)
            expect_same(mass_times(x, moved(f_c, f, -1), i), lambda * g(x)[i], "the contact force");
        const Real jerk = along(hddot, x, held);
        expect_same(output(model_->motion(Mode::holding(ContactSet::of(0))).program, 2 * dof_)(x), hddot(x),
                    "hddot of the contact program");
        const ModeDynamics& dynamics = model_->motion(contact);
        const std::size_t rate = 2 * dof_ + model_->contacts() + dynamics.further_events();
        expect_same(output(dynamics.program, rate)(x), jerk, "h''' of the contact program");
        expect_same(output(programs.release_terms, 0)(x), hddot(x), "hddot of the release program");
        expect_same(output(programs.release_terms, 1)(x), jerk, "h''' of the release program");
        expect_same(output(programs.definition7_terms, 0)(x), hddot(x), "hddot of the bounds");
        for (std::size_t i = 0; i < dof_; ++i) {
            expect_same(output(programs.definition7_terms, 1 + i)(x), n[i], "n of the bounds");
            expect_same(output(programs.definition7_terms, 1 + dof_ + i)(x), f[i], "f of the bounds");
        }
    }
}

// u = d v + c, udot along f, and M^-1 d' of every contact and joint with friction; what sticks keeps u.
TEST_P(Derivatives, SlipQuantitiesAreThoseOfTheSlip) {
    for (const auto& [which, law] : model_->equations().friction) {
        const Program& terms = model_->slip_terms(which);
        const Function u = output(terms, 0);
        for (const Reals& x : states()) {
            const Reals free = flow(x, evaluate(model_->motion({}).program, x, 0, dof_)),
                        stuck = flow(
                            x, evaluate(model_->motion(Mode().with(which, ContactState::held)).program, x, 0, dof_));
            const Reals row = evaluate(terms, x, 5, dof_), impulse = evaluate(terms, x, 5 + dof_, dof_);
            expect_same(u(x), product(row, v(x)) + output(terms, 1)(x), "u");
            expect_same(output(terms, 2)(x), along(u, x, free), "udot");
            expect_same(along(u, x, stuck), 0, "udot of what sticks");
            for (std::size_t i = 0; i < dof_; ++i) {
                expect_same(row[i], along(u, x, unit(dof_ + i)), "d");
                expect_same(mass_times(x, impulse, i), row[i], "M times the acceleration by friction");
            }
        }
    }
}

// In (q, s): v = s + n hdot, s' = A + B hdot + D hdot^2, and the derivatives in the shadowing bound (theory.md 5.1 and
// 5.2). With friction, n is that of a slip with either sign (theory-friction.md 4.1).
TEST_P(Derivatives, TheBouncingIsThatOfTheTangentialVelocity) {
    if (!has_contact()) return;
    const ContactSet silent = ContactSet::of(0).within(model_->equations().in_forces);  // until the Zeno point
    for (const int sign : is_rough(0) ? std::vector<int>{1, -1} : std::vector<int>{0}) {
        const ContactState state = sign == 0 ? ContactState::held : slip_state(sign);
        const BouncingModel& bouncing = model_->bouncing(BouncingKey{0, {}, state});
        const Program &hddot = bouncing.hddot, &shadow = bouncing.shadow, &free = model_->motion({}).program,
                      &held = model_->motion(Mode().with(0, state).with_silent(silent)).program;
        const std::size_t first = bouncing.variables.size();  // the first outputs are the gradient of hddot
        for (const Reals& random : states()) {
            const Real sigma = output(model_->contact_terms(), 1)(random);
            const Reals s = moved(v(random), direction(random, sign), -sigma), y = joined(q(random), s, random.back());
            const Reals n = direction(y, sign), x = joined(q(y), moved(s, n, sigma), y.back());
            const Real acceleration = output(free, 2 * dof_)(x);
            expect_same(evaluate(hddot, y, 0, 1, sigma)[0], acceleration, "hddot");
            const Real h = 1e-16;
            // The derivative with respect to sigma.
            const auto by_sigma = [&](const Program& program, std::size_t i, const Real& at) -> Real {
                return (evaluate(program, y, i, 1, at + h)[0] - evaluate(program, y, i, 1, at - h)[0]) / (2 * h);
            };
            expect_same(evaluate(bouncing.gradient, y, 2 * dof_, 1, sigma)[0], by_sigma(hddot, 0, sigma),
                        "d hddot/d sigma");
            const Reals A = evaluate(shadow, y, first, dof_, sigma),
                        B = evaluate(shadow, y, first + 2 * dof_, dof_, sigma),
                        D = evaluate(shadow, y, first + 3 * dof_, dof_, sigma),
                        rate = evaluate(bouncing.rates, y, dof_, dof_, sigma);
            const Reals motion = flow(x, rate);
            // If a force makes f_c not quadratic in v, or a coefficient depends on the slip, D is only the coefficient
            // of Lagrange's remainder.
            const bool quadratic = D == evaluate(shadow, y, first + 3 * dof_, dof_, 2 * sigma);
            for (std::size_t i = 0; i < dof_; ++i) {
                expect_same(evaluate(bouncing.rates, y, i, 1, sigma)[0], x[dof_ + i], "v");
                const Real turning = along([&](const Reals& at) { return direction(at, sign)[i]; }, y, motion);
                expect_same(rate[i] + turning * sigma + n[i] * acceleration, output(free, i)(x), "s'");
                if (quadratic)
                    expect_same(A[i] + B[i] * sigma + D[i] * sigma * sigma, rate[i], "A + B sigma + D sigma^2");
                expect_same(A[i], output(held, i)(y), "A");
                expect_same(B[i], by_sigma(bouncing.rates, dof_ + i, 0), "B");
                expect_same(evaluate(shadow, y, first + dof_ + i, 1)[0], n[i], "n");
                expect_same(evaluate(shadow, y, first + 4 * dof_ + i, 1, sigma)[0],
                            along(output(shadow, first + dof_ + i, sigma), y, motion), "ndot");
                expect_same(evaluate(shadow, y, first + 5 * dof_ + i, 1, sigma)[0],
                            along(output(shadow, first + 2 * dof_ + i, sigma), y, motion), "Bdot");
                for (std::size_t k = 0; k < 2 * dof_; ++k) {  // dA/dq, then dA/ds, row by row
                    const std::size_t block = k < dof_ ? first + 6 * dof_ : first + 6 * dof_ + dof_ * dof_;
                    expect_same(evaluate(shadow, y, block + i * dof_ + k % dof_, 1, sigma)[0],
                                along(output(shadow, first + i, sigma), y, unit(k)), "dA");
                }
            }
            // The rate of hddot(q, s, 0) along the bouncing motion, and the terms of it that estimate the Zeno time.
            const Reals drift = evaluate(shadow, y, first + 6 * dof_ + 2 * dof_ * dof_, 3);
            if (quadratic)
                expect_same(drift[0] + drift[1] * sigma + drift[2] * sigma * sigma, along(output(hddot, 0), y, motion),
                            "P + Phi sigma + Xi sigma^2");
            expect_same(evaluate(bouncing.trend, y, 0, 1)[0], evaluate(hddot, y, 0, 1)[0], "hddot at sigma = 0");
            expect_same(evaluate(bouncing.trend, y, 1, 1)[0], drift[0], "P");
            expect_same(evaluate(bouncing.trend, y, 2, 1)[0], evaluate(bouncing.gradient, y, 2 * dof_, 1)[0],
                        "d hddot/d sigma at 0");
            for (std::size_t k = 0; k < 2 * dof_; ++k) {
                expect_same(evaluate(shadow, y, k, 1, sigma)[0], evaluate(bouncing.gradient, y, k, 1, sigma)[0],
                            "again");
                expect_same(evaluate(bouncing.gradient, y, k, 1, sigma)[0], along(output(hddot, 0, sigma), y, unit(k)),
                            "d hddot");
            }
        }
    }
}

// A contact that sticks at its impacts, in (q, s): v = s + N sigma with sigma = (hdot, u), s' = A + B sigma + D sigma^2
// and derivatives of them (theory-friction.md 4.2).
TEST_P(Derivatives, TheStickingBouncingIsThatOfTheTangentialVelocity) {
    if (!has_contact() || !is_rough(0)) return;
    const BouncingModel& bouncing = model_->bouncing();
    const Program &terms = bouncing.sticking, &free = model_->motion({}).program,
                  &stuck = model_->motion(Mode().with(0, ContactState::held)).program;
    const auto row = [&](std::size_t k, std::size_t i) { return 5 + k * dof_ + i; };  // the order of PairTerms
    for (const Reals& x : states()) {
        const std::array<Real, 2> sigma{output(model_->contact_terms(), 1)(x), output(model_->slip_terms(0), 0)(x)};
        const std::array<Real, 2> acceleration{output(free, 2 * dof_)(x), output(model_->slip_terms(0), 2)(x)};
        const std::array<Reals, 2> N = directions(x);
        const Reals s = moved(moved(v(x), N[0], -sigma[0]), N[1], -sigma[1]), y = joined(q(x), s, x.back());
        const Shift shift{sigma[0], sigma[1]};
        const auto value = [&](std::size_t k, std::size_t i) { return output(terms, row(k, i), shift)(y); };
        for (std::size_t k = 0; k < 2; ++k) expect_same(output(terms, k, shift)(y), acceleration[k], "acceleration");
        expect_same(output(terms, 2)(y), product(g(x), by_force(x)), "W_NN");
        expect_same(output(terms, 3)(y), product(g(x), by_friction(x)), "W_NT");
        expect_same(output(terms, 4)(y), product(d(x), by_friction(x)), "W_TT");
        // s' = f - N (hddot, udot) - Ndot (hdot, u)
        Reals rate = evaluate(free, x, 0, dof_);
        for (std::size_t k = 0; k < 2; ++k) {
            const Reals still = flow(x, Reals(dof_, Real(0)));
            for (std::size_t i = 0; i < dof_; ++i) {
                const Real turning = along([&](const Reals& at) { return directions(at)[k][i]; }, y, still);
                expect_same(value(1 + k, i), N[k][i], "N");
                expect_same(value(5 + k, i), turning, "Ndot");
                rate[i] -= N[k][i] * acceleration[k] + turning * sigma[k];
            }
        }
        const Reals motion = flow(x, rate);
        for (std::size_t i = 0; i < dof_; ++i) {
            expect_same(value(0, i), output(stuck, i)(y), "A");
            Real sum = value(0, i);
            for (std::size_t k = 0; k < 2; ++k) sum += value(3 + k, i) * sigma[k];
            const std::array<Real, 3> squares{sigma[0] * sigma[0], sigma[0] * sigma[1], sigma[1] * sigma[1]};
            for (std::size_t k = 0; k < 3; ++k) sum += value(9 + k, i) * squares[k];
            expect_same(sum, rate[i], "s'");  // all forces of the gallery's rough systems are quadratic in the rates
            for (std::size_t k = 0; k < 2; ++k)
                expect_same(value(7 + k, i), along(output(terms, row(3 + k, i), shift), y, motion), "Bdot");
            for (std::size_t k = 0; k < 2 * dof_; ++k)
                expect_same(value(12 + (k < dof_ ? i : dof_ + i), k % dof_),
                            along(output(terms, row(0, i), shift), y, unit(k)), "dA");
        }
        // hddot(q, s), its rate along the motion that sticks, and its derivatives with respect to hdot and u.
        const Function hddot = output(free, 2 * dof_);
        const Reals none(dof_, Real(0)), trend = evaluate(bouncing.trend, y, 0, 4);
        expect_same(trend[0], hddot(y), "hddot at sigma = 0");
        expect_same(trend[1], along(hddot, y, flow(y, evaluate(stuck, y, 0, dof_))), "P");
        for (std::size_t k = 0; k < 2; ++k)
            expect_same(trend[2 + k], along(hddot, y, joined(none, N[k], 0)), "d hddot/d sigma");
    }
}

// The models do not depend on the method.
std::vector<Case> systems() {
    std::vector<Case> cases = all_cases();
    std::erase_if(cases, [&](const Case& one) { return one.method != cases.front().method; });
    return cases;
}

INSTANTIATE_TEST_SUITE_P(Model, Derivatives, testing::ValuesIn(systems()), name_of);

}  // namespace
}  // namespace achilles::test
