// Every formula of the derivation against closed forms and finite differences.
#include "model/model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/systems.hpp"
#include "simulate/impact.hpp"

namespace achilles {
namespace {

// Evaluates an expression of a model at a state.
double value(const Model& model, Expression e, const Run& run, const State& state) {
    const Program program(std::span(&e, 1),
                          {model.layout().count(), 2 * model.layout().dof, 2 * model.layout().dof + model.layout().p});
    auto evaluator = model.evaluator(program, run.parameters);
    set_state(evaluator, state);
    evaluator.run();
    return evaluator.output(0);
}

State random_state(int n, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    State state{Vector(n), Vector(n)};
    for (int i = 0; i < n; ++i) {
        state.q[i] = uniform(random);
        state.v[i] = uniform(random);
    }
    return state;
}

TEST(Model, TheBallHasItsClosedForm) {
    const auto model = test::load("ball_on_sine");
    const auto run = model->default_run();
    const ContactEquations& c = model->equations().free.contacts[0];
    std::mt19937 random(1);
    for (int trial = 0; trial < 50; ++trial) {
        const State s = random_state(2, random);
        const double x = s.q[0], dx = s.v[0], cosine = std::cos(x), m = run.parameters[0], g = run.parameters[1];
        EXPECT_NEAR(value(*model, c.gap, run, s), s.q[1] - std::sin(x), 1e-15);
        EXPECT_NEAR(value(*model, c.hddot, run, s), dx * dx * std::sin(x) - g, 1e-14);
        EXPECT_NEAR(value(*model, c.W, run, s), (1 + cosine * cosine) / m, 1e-14);
        EXPECT_NEAR(value(*model, c.direction[0], run, s), -cosine / (1 + cosine * cosine), 1e-14);
        EXPECT_NEAR(value(*model, c.direction[1], run, s), 1 / (1 + cosine * cosine), 1e-14);
        EXPECT_NEAR(value(*model, c.lambda, run, s), m * (g - dx * dx * std::sin(x)) / (1 + cosine * cosine), 1e-14);
    }
}

// theory.md 7: hddot = g sin(theta1)/L~ at theta2 = 0, with 3(m1(L1 + 2 L2) + m2 L2) in L~. With all parameters 1, the
// paper's condition is g sin(theta1)/L~ < 0, whatever the rates.
TEST(Model, ThePendulumLocksWhereSinTheta1IsNegative) {
    const auto model = test::load("double_pendulum");
    const auto run = model->default_run();
    const ContactEquations& c = model->equations().free.contacts[0];
    std::mt19937 random(2);
    double ratio = 0.0;
    for (int trial = 0; trial < 50; ++trial) {
        State s = random_state(2, random);
        s.q[1] = 0.0;
        s.v[1] = 0.0;
        const double found = value(*model, c.hddot, run, s) / std::sin(s.q[0]);
        if (trial == 0) ratio = found;
        EXPECT_GT(found, 0.0);
        EXPECT_NEAR(found, ratio, 1e-12);
    }
}

// L = T - V: d/dt dL/dv - dL/dq = 0 along the derived acceleration, by finite differences of T and V.
void check_lagrange(const Model& model, std::mt19937& random) {
    const auto run = model.default_run();
    const Equations& e = model.equations();
    const int n = model.dof();
    const double d = 1e-4;
    const auto L = [&](const State& s) { return value(model, e.kinetic, run, s) - value(model, e.potential, run, s); };
    for (int trial = 0; trial < 10; ++trial) {
        const State s = random_state(n, random);
        Vector f(n);
        for (int i = 0; i < n; ++i) f[i] = value(model, e.free.f[static_cast<std::size_t>(i)], run, s);
        for (int i = 0; i < n; ++i) {
            const auto momentum = [&](State at) {
                State up = at, down = at;
                up.v[i] += d;
                down.v[i] -= d;
                return (L(up) - L(down)) / (2 * d);
            };
            State later = s, earlier = s;
            later.q += d * s.v + 0.5 * d * d * f;
            later.v += d * f;
            earlier.q -= d * s.v - 0.5 * d * d * f;
            earlier.v -= d * f;
            State up = s, down = s;
            up.q[i] += d;
            down.q[i] -= d;
            const double rate = (momentum(later) - momentum(earlier)) / (2 * d), force = (L(up) - L(down)) / (2 * d);
            EXPECT_NEAR(rate, force, 1e-5 * std::max(1.0, std::abs(force)));
        }
    }
}

const char* const odd_system = R"toml(
title = "Three coordinates, nothing constant"
[[coordinate]]
name = "a"
[[coordinate]]
name = "b"
start = 0.5
[[coordinate]]
name = "c"
[[parameter]]
name = "k"
value = 0.7
[lagrangian]
kinetic = "(2 + sin(a))*a'^2/2 + (a'*cos(b) + b')^2*k + (3 + c^2)*(c' - k*a')*(c' - k*a')/2 + exp(b)*c'^2"
potential = "k*cos(a - b) + c^4/4 + a*c"
[[constraint]]
gap = "b + a^2*c/3 + 1/4*sin(c)"
restitution = "k"
)toml";

TEST(Model, EulerLagrangeHoldsOnEverySystem) {
    std::mt19937 random(3);
    check_lagrange(*test::load("ball_on_sine"), random);
    check_lagrange(*test::load("double_pendulum"), random);
    check_lagrange(*test::typed(odd_system), random);
}

// hddot is the second derivative of h along free motion; the jerk is the rate of hddot along constrained motion. W, n,
// s and f_c satisfy their definitions.
TEST(Model, NormalQuantitiesSatisfyTheirDefinitions) {
    std::mt19937 random(4);
    for (const auto& model : {test::load("ball_on_sine"), test::load("double_pendulum"), test::typed(odd_system)}) {
        const auto run = model->default_run();
        const Equations& e = model->equations();
        const ContactEquations& c = e.free.contacts[0];
        const auto n = static_cast<std::size_t>(model->dof());
        for (int trial = 0; trial < 10; ++trial) {
            const State s = random_state(model->dof(), random);
            const double d = 1e-4;
            const auto along = [&](const std::vector<Expression>& acceleration, double dt) {
                State moved = s;
                for (std::size_t i = 0; i < n; ++i) {
                    const auto k = static_cast<Eigen::Index>(i);
                    const double a = value(*model, acceleration[i], run, s);
                    moved.q[k] += dt * s.v[k] + 0.5 * dt * dt * a;
                    moved.v[k] += dt * a;
                }
                return moved;
            };
            const auto rate = [&](Expression x, const std::vector<Expression>& acceleration) {
                return (value(*model, x, run, along(acceleration, d)) -
                        value(*model, x, run, along(acceleration, -d))) /
                       (2 * d);
            };
            const double hddot = value(*model, c.hddot, run, s), W = value(*model, c.W, run, s);
            EXPECT_NEAR(value(*model, c.hdot, run, s), rate(c.gap, e.free.f), 1e-6);
            EXPECT_NEAR(hddot, rate(c.hdot, e.free.f), 1e-5 * std::max(1.0, std::abs(hddot)));
            EXPECT_NEAR(0.0, rate(c.hdot, c.f_c), 1e-5);  // the constrained motion keeps hdot
            const double jerk = ContactKinematics(*model, run).jerk(s);
            EXPECT_NEAR(jerk, rate(c.hddot, c.f_c), 1e-4 * std::max(1.0, std::abs(jerk)));
            EXPECT_NEAR(value(*model, c.lambda, run, s), -hddot / W, 1e-12);
            double gn = 0.0, gs = 0.0;
            for (std::size_t i = 0; i < n; ++i) {
                const double g = value(*model, c.g[i], run, s);
                gn += g * value(*model, c.direction[i], run, s);
                gs += g * value(*model, c.s[i], run, s);
                // M n = g'/W
                double Mn = 0.0;
                for (std::size_t j = 0; j < n; ++j)
                    Mn += value(*model, e.M[i * n + j], run, s) * value(*model, c.direction[j], run, s);
                EXPECT_NEAR(Mn, g / W, 1e-12);
            }
            EXPECT_NEAR(gn, 1.0, 1e-12);
            EXPECT_NEAR(gs, 0.0, 1e-12);
        }
    }
}

// Equation (4): the normal velocity is reversed and scaled, s is unchanged. R* is the Euclidean projection onto g v =
// 0.
TEST(Impacts, SatisfyNewtonsLawAndBothReinitializations) {
    std::mt19937 random(5);
    const auto model = test::typed(odd_system);
    const auto run = model->default_run();
    ContactKinematics surface(*model, run);
    for (int trial = 0; trial < 20; ++trial) {
        const State before = random_state(3, random);
        const Contact contact = surface.at(before);
        const State after{before.q, impact(contact, before.v, 0.3)};
        EXPECT_NEAR(surface.at(after).hdot, -0.3 * contact.hdot, 1e-14);
        const Vector s = reinitialize(contact, before.v, Reinitialization::kinetic);
        EXPECT_LE((reinitialize(surface.at(after), after.v, Reinitialization::kinetic) - s).norm(), 1e-14);
        EXPECT_NEAR(surface.at({before.q, s}).hdot, 0.0, 1e-14);
        EXPECT_LE((impact(contact, before.v, 0.0) - s).norm(), 1e-15);  // the plastic impact
        const Vector v = reinitialize(contact, before.v, Reinitialization::euclidean);
        EXPECT_NEAR(surface.at({before.q, v}).hdot, 0.0, 1e-14);
        EXPECT_NEAR((before.v - v).norm(), std::abs(contact.hdot) / contact.g.norm(), 1e-14);
    }
}

// For M = m I both reinitializations are the same projection.
TEST(Impacts, ReinitializationsAgreeOnTheBall) {
    const auto model = test::load("ball_on_sine");
    ContactKinematics surface(*model, model->default_run());
    std::mt19937 random(6);
    const State s = random_state(2, random);
    const Contact contact = surface.at(s);
    EXPECT_LE((reinitialize(contact, s.v, Reinitialization::kinetic) -
               reinitialize(contact, s.v, Reinitialization::euclidean))
                  .norm(),
              1e-15);
}

// A contact that judges one state after the other decides as one that judges each for the first time: whether its own
// roundings grow with those of q and t, while they shrink, or with an exponential of the time.
TEST(Impacts, ADifferenceOfGapsIsJudgedByTheRoundingOfItsState) {
    const auto model = test::typed(
        "title = \"roundings\"\n[[coordinate]]\nname = \"x\"\n[[coordinate]]\nname = \"y\"\nstart = 1.0\n"
        "[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n"
        "[[constraint]]\ngap = \"y + 1 - exp(x) + 1e-3*exp(t)\"\nrestitution = 0.5\n");
    const auto run = model->default_run();
    const auto state_at = [](double x, double y, double t) {
        State state{Vector(2), Vector::Zero(2), t};
        state.q << x, y;
        return state;
    };
    std::vector<State> states;
    for (int k = 0; k < 30; ++k) states.push_back(state_at(std::exp2(-k), std::exp2(-k), 0.0));
    for (int k = 20; k > 0; --k) states.push_back(state_at(k, 1.0, 0.0));
    for (int k = 0; k < 20; ++k) states.push_back(state_at(k, 1.0, 0.0));
    for (int k = 0; k < 40; ++k) states.push_back(state_at(0.1, 1.0, k));
    int within = 0, outside = 0;
    for (const double part : {0.9, 0.999, 1.001, 10.0, 1e3, 1e5}) {
        ContactKinematics surface(*model, run);
        for (const State& state : states) {
            const Contact contact = surface.at(state);
            const double far = 1e9, error = surface.gap_error(state);
            const bool is_within = surface.within_gap_error(part * 4.0 * error, 4.0, contact, state);
            EXPECT_EQ(is_within, part <= 1.0) << part << " at x = " << state.q[0] << ", t = " << state.t;
            EXPECT_FALSE(surface.within_gap_error(far * error, 4.0, contact, state));
            (is_within ? within : outside)++;
        }
    }
    EXPECT_EQ(within, 2 * 110);
    EXPECT_EQ(outside, 4 * 110);
    // The bound of a state before serves at the next five. The roundings of q shrink much more there than the bound.
    ContactKinematics surface(*model, run);
    for (int k = 0; k <= 24; ++k) {
        const State state = state_at(std::exp2(-2 * k), std::exp2(-2 * k), 0.0);
        const Contact contact = surface.at(state);
        const bool is_near = k % 6 == 0;
        const double value = (is_near ? 3.6 : 1e9) * surface.gap_error(state);
        EXPECT_EQ(surface.within_gap_error(value, 4.0, contact, state), is_near) << k;
    }
}

std::string error_of(std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    try {
        const auto model = test::typed(text);
        model->check(model->default_run());
    } catch (const InputError& error) {
        return error.message;
    }
    return "no error";
}

TEST(BadSystems, AreToldWhatIsWrong) {
    const std::string right = odd_system;
    EXPECT_EQ(error_of(right, "exp(b)*c'^2", "c'^3"), "the term c'^3 of the kinetic energy has degree 3 in the rates");
    EXPECT_EQ(error_of(right, "exp(b)*c'^2", "sin(c')"),
              "the kinetic energy is not a polynomial in the rates: sin(c')");
    EXPECT_EQ(error_of(right, "c^4/4", "c'^2"),
              "the rate c' is not allowed in the potential: write terms with rates in a force or in the dissipation");
    EXPECT_EQ(error_of(right, "a^2*c/3", "a'"),
              "the rate a' is not allowed in the gap: it may depend only on coordinates, parameters and time");
    EXPECT_EQ(error_of(right, "c^4/4", "gap"), "'gap' is allowed only in a [[view]]");
    EXPECT_EQ(error_of(right, "restitution = \"k\"", "restitution = \"2*k\""),
              "the restitution must lie in [0, 1], but it is 1.4");
    EXPECT_EQ(error_of(right, "restitution = \"k\"", "restitution = \"a\""),
              "the coordinate 'a' is not allowed in the restitution: use only parameters");
    EXPECT_EQ(error_of(right, "(2 + sin(a))", "(sin(a) - 2)"),
              "the mass matrix is not positive definite at the start (the pivot of 'b' is -1.3534919379767696)");
    EXPECT_EQ(error_of(right, "start = 0.5", "start = -0.5"), "the gap is negative at the start: h = -0.5");
    EXPECT_EQ(error_of(right, "c^4/4", "log(c)"), "the potential is not defined at the start: log(c), with c = 0");
    EXPECT_EQ(error_of(right, "[lagrangian]",
                       "[[drawing]]\nshape = \"disc\"\nat = [\"a\", \"bb\"]\nradius = 0.1\n[lagrangian]"),
              "unknown name 'bb'; did you mean 'b'?");
    EXPECT_EQ(error_of(right, "b + a^2*c/3 + 1/4*sin(c)", "4"),
              "dh = 0 everywhere: the gap does not change with any coordinate");
    EXPECT_EQ(error_of(right, "b + a^2*c/3 + 1/4*sin(c)", "1 + sin(a)^2 + cos(a)^2"),
              "dh = 0 everywhere: the gap does not change with any coordinate");
    EXPECT_EQ(error_of(right, " + exp(b)*c'^2", " - (3 + c^2)*(c' - k*a')*(c' - k*a')/2"),
              "the kinetic energy has no term in c'^2");
    EXPECT_EQ(error_of(right, "value = 0.7", "value = 0.5"), "no error");
}

TEST(BadSystems, IndefiniteMassesAreToldEvenWhereTheyCancel) {
    EXPECT_EQ(error_of(odd_system,
                       "kinetic = \"(2 + sin(a))*a'^2/2 + (a'*cos(b) + b')^2*k + (3 + c^2)*(c' - k*a')*(c' "
                       "- k*a')/2 + exp(b)*c'^2\"",
                       "kinetic = \"a'^2 - b'^2 + c'^2\"")
                  .substr(0, 60),
              "the mass matrix is not positive definite at the start (the p");
    std::string text = odd_system;
    const std::size_t gap = text.find("b + a^2*c/3 + 1/4*sin(c)");
    text.replace(gap, 24, "a + b + 1");
    EXPECT_EQ(error_of(text,
                       "(2 + sin(a))*a'^2/2 + (a'*cos(b) + b')^2*k + (3 + c^2)*(c' - k*a')*(c' - k*a')/2 + "
                       "exp(b)*c'^2",
                       "a'^2 - b'^2 + c'^2"),
              "the mass matrix is not positive definite at any state: dh M^-1 dh' is 0");
}

TEST(BadSystems, EquationsHaveAStatedLimit) {
    std::string kinetic = "exp(b)*c'^2", potential = "c";
    for (int i = 1; i < 3000; ++i) kinetic += fmt::format(" + 1/{}*(b' + {}*c')^2", 2 * i + 1, i);
    EXPECT_EQ(error_of(odd_system, "exp(b)*c'^2", kinetic),
              "the equations of motion are too large: an exact number has more than 16384 bits; the largest expression "
              "of the file is the kinetic energy, with 15017 operations");
    // What is too large is T, but most of it is in V.
    for (int i = 1; i < 5000; ++i) potential += fmt::format(" + sin(a + {}*b)", i);
    std::string text = odd_system;
    text.replace(text.find("exp(b)*c'^2"), 11, kinetic);
    EXPECT_EQ(error_of(text, "c^4/4", potential),
              "the equations of motion are too large: an exact number has more than 16384 bits; the largest expression "
              "of the file is the potential, with 20001 operations");
}

}  // namespace
}  // namespace achilles
