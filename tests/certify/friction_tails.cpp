#include "certify/friction_tails.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "certify/dual.hpp"
#include "certify/truncation.hpp"
#include "model/read_system.hpp"
#include "simulate/contact_cache.hpp"

namespace achilles::test {

namespace {

using Quad = Real;
using Triple = std::array<Quad, 3>;

Triple operator+(const Triple& a, const Triple& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Triple operator-(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Triple operator*(const Quad& c, const Triple& a) { return {c * a[0], c * a[1], c * a[2]}; }
Quad dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Quad size(const Triple& a) { return sqrt(dot(a, a)); }

constexpr double inertia = 0.4;

// M = [[1, coupling, 0], [coupling, 1, 0], [0, 0, inertia]], V = y, h = y - A sin x,
// u = (x' + A cos x y')/sqrt(1 + A^2 cos^2 x) + r phi', mu = mu_0 + mu_1 exp(-|u|).
struct Body {
    double A, r, coupling, e, mu_0, mu_1;

    Quad mu(const Quad& speed) const { return mu_0 + mu_1 * exp(-speed); }
    Triple by_mass(const Triple& force) const {  // M^-1 force
        const Quad det = 1 - Quad(coupling) * coupling;
        return {(force[0] - coupling * force[1]) / det, (force[1] - coupling * force[0]) / det, force[2] / inertia};
    }
    Triple free() const { return by_mass({0, -1, 0}); }
    // The acceleration in contact: slip with this sign, or stick (0).
    Triple in_contact(int sign, const Triple& q, const Triple& v) const;
};

// The rows of a body at one state, and what follows from them.
struct Rows {
    Triple g, d, to_g, to_d;  // M^-1 g', M^-1 d'
    Quad W_NN, W_NT, W_TT, det, hdot, u, hddot, udot;

    Rows(const Body& body, const Triple& q, const Triple& v) {
        const Quad A = body.A, c = cos(q[0]), s = sin(q[0]), root = sqrt(1 + A * A * c * c), cube = root * root * root;
        g = {-A * c, 1, 0};
        d = {1 / root, A * c / root, body.r};
        const Quad turn = A * A * c * s * v[0] / cube;  // of 1/root
        const Triple ddot{turn, -A * s * v[0] / root + A * c * turn, 0};
        to_g = body.by_mass(g);
        to_d = body.by_mass(d);
        W_NN = dot(g, to_g);
        W_NT = dot(g, to_d);
        W_TT = dot(d, to_d);
        det = W_NN * W_TT - W_NT * W_NT;
        hdot = dot(g, v);
        u = dot(d, v);
        hddot = dot(g, body.free()) + A * s * v[0] * v[0];
        udot = dot(d, body.free()) + dot(ddot, v);
    }
    // M^-1 (g' - sigma mu d')/W_sigma
    Triple sliding(int sign, const Quad& mu) const {
        return (1 / (W_NN - sign * mu * W_NT)) * (to_g - (sign * mu) * to_d);
    }
    // M^-1 (g' p + d' p_T) that changes hdot and u by these amounts.
    Triple change(const Quad& of_hdot, const Quad& of_u) const {
        const Quad p = (W_TT * of_hdot - W_NT * of_u) / det, p_T = (W_NN * of_u - W_NT * of_hdot) / det;
        return p * to_g + p_T * to_d;
    }
};

Triple Body::in_contact(int sign, const Triple& q, const Triple& v) const {
    const Rows rows(*this, q, v);
    if (sign == 0) return free() + rows.change(-rows.hddot, -rows.udot);
    return free() - rows.hddot * rows.sliding(sign, mu(sign * rows.u));
}

// The impact law: the sign of the slip, or 0 if it stops; and v+.
struct Branch {
    int sign;
    Triple after;
};
Branch impact(const Body& body, const Triple& q, const Triple& v) {
    const Rows rows(body, q, v);
    const Quad e = body.e, removed = -(1 + e) * rows.hdot, mu_stick = body.mu(e * abs(rows.u) / (1 + e));
    const Quad p = (removed * rows.W_TT + rows.u * rows.W_NT) / rows.det,
               p_T = -(removed * rows.W_NT + rows.u * rows.W_NN) / rows.det;
    if (p > 0 && abs(p_T) <= mu_stick * p) return {0, v + p * rows.to_g + p_T * rows.to_d};
    for (const int sign : {1, -1}) {
        Quad at_compression = rows.u;
        Triple after = v;
        for (int round = 0; round < 200; ++round) {
            after = v + removed * rows.sliding(sign, body.mu(abs(at_compression)));
            const Quad next = (dot(rows.d, after) + e * rows.u) / (1 + e);
            if (abs(next - at_compression) < 1e-32) break;
            at_compression = next;
        }
        if (sign * dot(rows.d, after) > 0) return {sign, after};
    }
    return {0, v};
}

// The bouncing from a collision until the flights are too short to matter.
struct Bouncing {
    std::vector<int> signs;  // by impact
    struct Instant {
        Quad t;
        Triple q;
    };
    std::vector<Instant> heights;  // in the middle of flights
    Quad zeno_time;
    Triple q, v;
};
Bouncing bounce(const Body& body, Triple q, Triple v) {
    Bouncing result;
    const Triple f = body.free();
    Quad t = 0;
    while (true) {
        const Quad w = -Rows(body, q, v).hdot;
        const Branch branch = impact(body, q, v);
        result.signs.push_back(branch.sign);
        v = branch.after;
        const Rows rows(body, q, v);
        if (w < 1e-12 || result.signs.size() > 400) {
            const Quad rest = 2 * rows.hdot / (-rows.hddot * (1 - Quad(body.e)));
            result.zeno_time = t + rest;
            result.q = q + rest * v;
            const Triple s = v - rows.hdot * (branch.sign == 0 ? rows.change(1, 0)
                                                               : rows.sliding(branch.sign, body.mu(abs(rows.u))));
            result.v = s + rest * body.in_contact(branch.sign, q, s);
            return result;
        }
        const auto at = [&](const Quad& time) { return q + time * v + (time * time / 2) * f; };
        Quad flight = 2 * rows.hdot / -rows.hddot;
        for (int round = 0; round < 60; ++round) {
            const Triple now = at(flight);
            const Triple rate = v + flight * f;
            const Quad h = now[1] - body.A * sin(now[0]), hdot = rate[1] - body.A * cos(now[0]) * rate[0];
            const Quad step = h / hdot;
            flight -= step;
            if (abs(step) < 1e-30 * (flight + 1e-3)) break;
        }
        if (result.heights.size() < 3) result.heights.push_back({t + flight / 2, at(flight / 2)});
        q = at(flight);
        v = v + flight * f;
        t += flight;
    }
}

// The motion in contact, sliding with this sign or sticking (0), over a time, by extrapolation of the midpoint rule.
struct State3 {
    Triple q, v;
};
State3 in_contact(const Body& body, int sign, State3 state, const Quad& duration) {
    const auto acceleration = [&](const State3& x) { return body.in_contact(sign, x.q, x.v); };
    const auto midpoint = [&](const State3& from, const Quad& H, int n) {
        const Quad h = H / n;
        State3 before = from, now{from.q + h * from.v, from.v + h * acceleration(from)};
        for (int k = 1; k < n; ++k) {
            const State3 next{before.q + (2 * h) * now.v, before.v + (2 * h) * acceleration(now)};
            before = now;
            now = next;
        }
        const Triple a = acceleration(now);
        return State3{Quad(0.5) * (now.q + before.q + h * now.v), Quad(0.5) * (now.v + before.v + h * a)};
    };
    constexpr int columns = 7;
    const int parts = duration < 0.05 ? 1 : 4;
    for (int part = 0; part < parts; ++part) {
        std::array<State3, columns> row;
        for (int k = 0; k < columns; ++k) {
            State3 last = midpoint(state, duration / parts, 2 * (k + 1));
            for (int j = 0; j < k; ++j) {  // columns of Neville's scheme in h^2
                const Quad ratio = Quad(k + 1) / Quad(k - j);
                const Quad factor = 1 / (ratio * ratio - 1);
                const State3 better{last.q + factor * (last.q - row[static_cast<std::size_t>(j)].q),
                                    last.v + factor * (last.v - row[static_cast<std::size_t>(j)].v)};
                row[static_cast<std::size_t>(j)] = last;
                last = better;
            }
            row[static_cast<std::size_t>(k)] = last;
        }
        state = row[columns - 1];
    }
    return state;
}

std::string text_of(const Body& body) {
    return fmt::format(R"-(coordinate = [{{name = "x"}}, {{name = "y"}}, {{name = "phi"}}]
lagrangian.kinetic = "(x'^2 + y'^2 + 2*{0:.17g}*x'*y' + 2/5*phi'^2)/2"
lagrangian.potential = "y"
[[constraint]]
gap = "y - {1:.17g}*sin(x)"
restitution = {2:.17g}
slip = "(x' + {1:.17g}*cos(x)*y')/sqrt(1 + ({1:.17g}*cos(x))^2) + {3:.17g}*phi'"
friction = "{4}"
)-",
                       body.coupling, body.A, body.e, body.r,
                       body.mu_1 == 0.0 ? fmt::format("{:.17g}", body.mu_0)
                                        : fmt::format("{:.17g} + {:.17g}*exp(-slip)", body.mu_0, body.mu_1));
}

Triple triple(const Vector& x) { return {Quad(x[0]), Quad(x[1]), Quad(x[2])}; }
Vector rounded(const Triple& x) {
    Vector result(3);
    for (Eigen::Index i = 0; i < 3; ++i) result[i] = static_cast<double>(x[static_cast<std::size_t>(i)]);
    return result;
}

// One random collision: the certificate, and its comparison with the true bouncing.
class FrictionTrial {
 public:
    FrictionTrial(bool sticks, std::mt19937& random) : sticks_(sticks) {
        const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
        body_ = {between(0.1, 1.0),
                 between(0.0, 1.0) < 0.3 ? 0.0 : 0.5,
                 between(0.0, 1.0) < 0.5 ? 0.0 : between(0.0, 0.5),
                 between(0.2, 0.8),
                 sticks ? between(0.6, 1.5) : between(0.05, 0.4),
                 between(0.0, 1.0) < 0.5 ? 0.0 : between(0.0, 0.2)};
        const double x = between(-2.0, 2.0), w = std::pow(10.0, between(-4.0, -0.5));
        q_ = {Quad(x), body_.A * sin(Quad(x)), Quad(0)};
        v_ = {Quad(between(-1.0, 1.0)), Quad(between(-1.0, 1.0)), Quad(between(-1.0, 1.0))};
        Rows rows(body_, q_, v_);
        const Quad u = sticks ? Quad(between(0.0, 1.0)) * 2 * rows.udot / -rows.hddot * w : rows.u;
        v_ = triple(rounded(v_ + rows.change(-w - rows.hdot, u - rows.u)));
    }

    // Nothing if the first impact is of the other kind or nothing is proved.
    std::optional<std::string> check(double& closest) {
        const Branch first = impact(body_, q_, v_);
        if ((first.sign == 0) != sticks_) return std::nullopt;
        const Rows rows(body_, q_, v_);
        if (!(rows.hdot < 0) || !(rows.hddot < 0)) return std::nullopt;
        const auto model = derive(parse_system(text_of(body_)));
        const Run run = model->default_run();
        const ContactState state = sticks_ ? ContactState::held : slip_state(first.sign);
        const auto conditions =
            truncation_conditions(*model, run, Interval(body_.e), BouncingKey{0, Mode(), state}, ContactSet());
        const Triple s = sticks_ ? v_ + rows.change(-rows.hdot, -rows.u)
                                 : (1 / (1 + Quad(body_.e))) * (first.after + Quad(body_.e) * v_);
        s_ = s;
        Collision collision{
            {rounded(q_), rounded(v_), 0.0}, static_cast<double>(-rows.hdot), rounded(s), rounded(s), {}};
        if (sticks_) {
            const FloatEnvironmentGuard ground;
            State restart = conditions->restart_at(collision);
            ContactCache surfaces(*model, run);
            if (!surfaces.settle(restart, Mode::holding(ContactSet::of(0)))) return "projection";
            collision.position = restart.q;
            collision.restart = restart.v;
        }
        const auto certificate = conditions->prove_any(collision);
        if (!certificate || !certificate->uniform_position) return std::nullopt;
        return compare(*certificate, collision, first.sign, closest);
    }

 private:
    std::string compare(const Certificate& c, const Collision& collision, int sign, double& closest) const {
        const Bouncing truth = bounce(body_, q_, v_);
        for (const int each : truth.signs)
            if (each != sign) return "the branch";
        if (truth.zeno_time < c.zeno_low || truth.zeno_time > c.zeno_high) return "the Zeno time";
        // A bound is for the motion from the exact state of the impact: doubles hold y = A sin x to rounding only.
        State3 state{sticks_ ? triple(collision.position) : q_, sticks_ ? triple(collision.restart) : s_};
        if (size(truth.q - state.q) > c.position_bound) return "the position bound";
        if (size(truth.v - state.v) > c.velocity_bound) return "the velocity bound";
        Quad t = 0;
        for (const Bouncing::Instant& instant : truth.heights) {
            state = in_contact(body_, sign, state, instant.t - t);
            t = instant.t;
            if (size(instant.q - state.q) > *c.uniform_position) return "the uniform bound";
        }
        state = in_contact(body_, sign, state, truth.zeno_time - t);
        const double position = static_cast<double>(size(truth.q - state.q)),
                     velocity = static_cast<double>(size(truth.v - state.v));
        closest = std::max({closest, position / *c.shadowing_position, velocity / *c.shadowing_velocity});
        if (position > *c.shadowing_position) return "the position at the Zeno time";
        if (velocity > *c.shadowing_velocity) return "the velocity at the Zeno time";
        return "";
    }

    bool sticks_;
    Body body_{};
    Triple q_, v_, s_{};
};

}  // namespace

FrictionTails check_friction_tails(bool sticks, int trials, std::uint32_t seed) {
    std::mt19937 random(seed);
    FrictionTails result;
    for (; result.trials < trials; ++result.trials) {
        const auto failure = FrictionTrial(sticks, random).check(result.closest);
        if (!failure) continue;
        ++result.proved;
        if (failure->empty()) continue;
        if (++result.violations == 1) result.first_failure = fmt::format("trial {}: {}", result.trials, *failure);
    }
    return result;
}

}  // namespace achilles::test
