// Compares every program of every model with finite differences of L and h in 50 digits, where the differences are
// practically exact. So simulate() evaluates the Euler-Lagrange equations and the formulas of theory.md 1.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <functional>
#include <random>

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

    // Outputs [first, first + count) of a program at (q, v, t), and at sigma if the program has this input.
    Reals evaluate(const Program& program, const Reals& x, std::size_t first, std::size_t count, Real sigma = 0) const {
        auto evaluator = model_->evaluator<Real>(program, model_->default_run().parameters);
        for (std::size_t i = 0; i < 2 * dof_; ++i) evaluator.input(i) = x[i];
        evaluator.input(model_->layout().t()) = x.back();
        evaluator.input(model_->layout().sigma()) = sigma;
        evaluator.run();
        Reals result;
        for (std::size_t i = first; i < first + count; ++i) result.push_back(evaluator.output(i));
        return result;
    }
    Function output(const Program& program, std::size_t index, Real sigma = 0) const {
        return [this, &program, index, sigma](const Reals& x) { return evaluate(program, x, index, 1, sigma)[0]; };
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
            const Reals flight = evaluate(model_->motion({}).program, x, 0, 2 * dof_ + 1);
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

// hdot and hddot along f; W and n from M; f_c keeps hdot, and its force is g' lambda; h''' along f_c.
TEST_P(Derivatives, NormalQuantitiesAreThoseOfTheGap) {
    if (model_->has_friction()) return;  // the forces of a mode are then those of theory-friction.md 2
    const Program& surface = model_->contact_terms();
    const Function gap = output(model_->gap(), 0), hdot = output(surface, 1),
                   hddot = output(model_->motion({}).program, 2 * dof_);
    for (const Reals& x : states()) {
        const Reals f = evaluate(model_->motion({}).program, x, 0, dof_),
                    f_c = evaluate(model_->motion(Mode::holding(ContactSet::of(0))).program, x, 0, dof_);
        const Reals n = evaluate(surface, x, 2, dof_), g = evaluate(surface, x, 2 + dof_, dof_);
        const Real W = evaluate(surface, x, 2 + 2 * dof_, 1)[0], lambda = evaluate(model_->force(), x, 0, 1)[0];
        const Reals free = flow(x, f), held = flow(x, f_c);
        expect_same(output(surface, 0)(x), gap(x), "h");
        expect_same(hdot(x), along(gap, x, free), "hdot");
        expect_same(hddot(x), along(hdot, x, free), "hddot");
        expect_same(along(hdot, x, held), 0, "hddot in contact");
        expect_same(lambda, -hddot(x) / W, "lambda");
        Reals push = f_c;
        Real gn = 0;
        for (std::size_t i = 0; i < dof_; ++i) {
            push[i] -= f[i];
            gn += g[i] * n[i];
        }
        expect_same(gn, 1, "g n");
        for (std::size_t i = 0; i < dof_; ++i) {
            expect_same(g[i], along(gap, x, unit(i)), "g");
            expect_same(W * mass_times(x, n, i), g[i], "W M n");
            expect_same(mass_times(x, push, i), lambda * g[i], "the contact force");
        }
        const Real jerk = along(hddot, x, held);
        expect_same(output(model_->motion(Mode::holding(ContactSet::of(0))).program, 2 * dof_)(x), hddot(x),
                    "hddot of the contact program");
        expect_same(output(model_->motion(Mode::holding(ContactSet::of(0))).program, 2 * dof_ + model_->contacts())(x),
                    jerk, "h''' of the contact program");
        expect_same(output(model_->release_terms(), 0)(x), hddot(x), "hddot of the release program");
        expect_same(output(model_->release_terms(), 1)(x), jerk, "h''' of the release program");
        expect_same(output(model_->definition7_terms(), 0)(x), hddot(x), "hddot of the bounds");
        for (std::size_t i = 0; i < dof_; ++i) {
            expect_same(output(model_->definition7_terms(), 1 + i)(x), n[i], "n of the bounds");
            expect_same(output(model_->definition7_terms(), 1 + dof_ + i)(x), f[i], "f of the bounds");
        }
    }
}

// In (q, s): v = s + n hdot, s' = A + B hdot + D hdot^2, and the derivatives in the shadowing bound (theory.md 5.1 and
// 5.2).
TEST_P(Derivatives, TheBouncingIsThatOfTheTangentialVelocity) {
    const BouncingModel& bouncing = model_->bouncing();
    for (const Reals& x : states()) {
        const auto tangential = [&](const Reals& at, std::size_t i) {
            return at[dof_ + i] -
                   evaluate(model_->contact_terms(), at, 2 + i, 1)[0] * output(model_->contact_terms(), 1)(at);
        };
        Reals s;
        for (std::size_t i = 0; i < dof_; ++i) s.push_back(tangential(x, i));
        const Real sigma = output(model_->contact_terms(), 1)(x);
        const Reals y = joined(q(x), s, x.back()), free = flow(x, evaluate(model_->motion({}).program, x, 0, dof_));
        const Program &hddot = bouncing.hddot, &shadow = bouncing.shadow;
        const std::size_t first = bouncing.variables.size();  // the first outputs are the gradient of hddot
        expect_same(evaluate(hddot, y, 0, 1, sigma)[0], output(model_->motion({}).program, 2 * dof_)(x), "hddot");
        const Real h = 1e-16;
        const Real by_sigma =
            (evaluate(hddot, y, 0, 1, sigma + h)[0] - evaluate(hddot, y, 0, 1, sigma - h)[0]) / (2 * h);
        expect_same(evaluate(bouncing.gradient, y, 2 * dof_, 1, sigma)[0], by_sigma, "d hddot/d sigma");
        const Reals A = evaluate(shadow, y, first, dof_, sigma), B = evaluate(shadow, y, first + 2 * dof_, dof_, sigma);
        const Reals D = evaluate(shadow, y, first + 3 * dof_, dof_, sigma),
                    rate = evaluate(bouncing.rates, y, dof_, dof_, sigma);
        const Reals motion = flow(x, rate);
        // If a force makes f_c not quadratic in v, D is only the coefficient of Lagrange's remainder.
        const bool quadratic = D == evaluate(shadow, y, first + 3 * dof_, dof_, 2 * sigma);
        for (std::size_t i = 0; i < dof_; ++i) {
            expect_same(evaluate(bouncing.rates, y, i, 1, sigma)[0], x[dof_ + i], "v");
            expect_same(rate[i], along([&](const Reals& at) { return tangential(at, i); }, x, free), "s'");
            if (quadratic) expect_same(A[i] + B[i] * sigma + D[i] * sigma * sigma, rate[i], "A + B sigma + D sigma^2");
            expect_same(A[i], output(model_->motion(Mode::holding(ContactSet::of(0))).program, i)(y), "A");
            expect_same(evaluate(shadow, y, first + dof_ + i, 1)[0], evaluate(model_->contact_terms(), x, 2 + i, 1)[0],
                        "n");
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
            expect_same(drift[0] + drift[1] * sigma + drift[2] * sigma * sigma,
                        along(output(hddot, 0, Real(0)), y, motion), "P + Phi sigma + Xi sigma^2");
        expect_same(evaluate(bouncing.trend, y, 0, 1)[0], evaluate(hddot, y, 0, 1, Real(0))[0], "hddot at sigma = 0");
        expect_same(evaluate(bouncing.trend, y, 1, 1)[0], drift[0], "P");
        expect_same(evaluate(bouncing.trend, y, 2, 1)[0], evaluate(bouncing.gradient, y, 2 * dof_, 1, Real(0))[0],
                    "d hddot/d sigma at 0");
        for (std::size_t k = 0; k < 2 * dof_; ++k) {
            expect_same(evaluate(shadow, y, k, 1, sigma)[0], evaluate(bouncing.gradient, y, k, 1, sigma)[0], "again");
            expect_same(evaluate(bouncing.gradient, y, k, 1, sigma)[0], along(output(hddot, 0, sigma), y, unit(k)),
                        "d hddot");
        }
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
