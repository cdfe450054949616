#include "certify/friction_beside.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "certify/truncation.hpp"
#include "model/read_system.hpp"
#include "simulate/contact_cache.hpp"

namespace achilles::test {

namespace {

using Real = long double;
using Vec = Eigen::Matrix<Real, 4, 1>;
using Mat = Eigen::Matrix<Real, 4, 4>;
using Rows = Eigen::Matrix<Real, 4, 4>;  // gap and slip of the held contact, then of the bouncing one
using Signs = std::array<int, 2>;        // of the slips, 0: sticks

constexpr int gap_of[] = {0, 2}, slip_of[] = {1, 3};

// Coordinates x, y, z, phi; constant forces.
//     h_1 = y - A sin x,             u_1 = x' + A cos x y' + r_1 phi'
//     h_2 = z,                       u_2 = (1 + k cos x) x' + phi' + r_2 z'
// The bouncing gap is a coordinate, so that no digits are lost in low flights.
struct Body {
    Mat M, M_inverse;
    Vec force;
    double A, r_1, r_2, k;
    std::array<double, 2> mu;
    double e;
    std::array<Rubbing, 2> rubbing;

    // The matrix of the rows, and their accelerations at a = 0.
    Rows rows(const Vec& q) const {
        const Real c = std::cos(q[0]);
        Rows D;
        D << -A * c, 1, 0, 0,  //
            1, A * c, 0, r_1,  //
            0, 0, 1, 0,        //
            1 + k * c, 0, r_2, 1;
        return D;
    }
    Vec bending(const Vec& q, const Vec& v) const {
        const Real s = std::sin(q[0]);
        return {A * s * v[0] * v[0], -A * s * v[0] * v[1], 0, -k * s * v[0] * v[0]};
    }
    bool has_friction(int contact) const { return rubbing[static_cast<std::size_t>(contact)] != Rubbing::none; }
};

// The impulses or forces of closed contacts in a branch, which bring the gaps by `gaps` and the slips that stick by
// `slips` to 0. Entry of a row: its force.
Vec forces_in(const Body& body, const Rows& D, const std::array<bool, 2>& closed, const Signs& signs,
              const Vec& rates) {
    const Mat W = D * body.M_inverse * D.transpose();
    std::vector<int> kept;
    std::vector<Vec> columns;
    for (int i = 0; i < 2; ++i) {
        const auto c = static_cast<std::size_t>(i);
        if (!closed[c]) continue;
        Vec normal = Vec::Zero();
        normal[gap_of[i]] = 1;
        if (body.has_friction(i) && signs[c] != 0) normal[slip_of[i]] = -signs[c] * Real(body.mu[c]);
        columns.push_back(normal);
        kept.push_back(gap_of[i]);
        if (!body.has_friction(i) || signs[c] != 0) continue;
        Vec tangential = Vec::Zero();
        tangential[slip_of[i]] = 1;
        columns.push_back(tangential);
        kept.push_back(slip_of[i]);
    }
    const auto n = static_cast<Eigen::Index>(kept.size());
    Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> A(n, n);
    Eigen::Matrix<Real, Eigen::Dynamic, 1> b(n);
    for (Eigen::Index r = 0; r < n; ++r) {
        for (Eigen::Index k = 0; k < n; ++k)
            A(r, k) = W.row(kept[static_cast<std::size_t>(r)]).dot(columns[static_cast<std::size_t>(k)]);
        b[r] = -rates[kept[static_cast<std::size_t>(r)]];
    }
    const Eigen::Matrix<Real, Eigen::Dynamic, 1> p = A.fullPivLu().solve(b);
    Vec result = Vec::Zero();
    for (Eigen::Index k = 0; k < n; ++k) result += p[k] * columns[static_cast<std::size_t>(k)];
    return result;
}

// Whether forces obey the law of friction, where the slips after an impact (or their accelerations from 0) are `u`.
bool obeys(const Body& body, int i, int sign, const Vec& force, Real u) {
    const auto c = static_cast<std::size_t>(i);
    if (!(force[gap_of[i]] >= 0)) return false;
    if (!body.has_friction(i)) return true;
    return sign == 0 ? std::abs(force[slip_of[i]]) <= body.mu[c] * force[gap_of[i]] : sign * u > 0;
}

// The impact law: every branch is tried. Nothing if not exactly one obeys it.
struct Impact {
    Signs signs;
    Vec after, plastic;  // v+, and s of the same branch at restitution 0
    Vec impulses;
    Real e;  // less than that of the body if the impact is capped
};
std::optional<Impact> impact_with(const Body& body, const Vec& q, const Vec& v, const Signs& held_now, Real e) {
    const Rows D = body.rows(q);
    Vec before = D * v;
    before[0] = 0;
    if (body.has_friction(0) && held_now[0] == 0) before[1] = 0;
    std::optional<Impact> found;
    int count = 0;
    for (const int first : {0, 1, -1})
        for (const int second : {0, 1, -1})
            for (const bool held : {true, false}) {
                if ((!body.has_friction(0) || !held) && first != 0) continue;
                if (!body.has_friction(1) && second != 0) continue;
                Vec rates = before;
                rates[2] *= 1 + e;
                const Vec p = forces_in(body, D, {held, true}, {first, second}, rates);
                const Vec after = before + D * body.M_inverse * D.transpose() * p;
                const bool valid =
                    obeys(body, 1, second, p, after[3]) && (held ? obeys(body, 0, first, p, after[1]) : after[0] > 0);
                if (!valid) continue;
                ++count;
                if (!held) continue;
                const Vec s = forces_in(body, D, {true, true}, {first, second}, before);
                found = Impact{{first, second},
                               v + body.M_inverse * D.transpose() * p,
                               v + body.M_inverse * D.transpose() * s,
                               p,
                               e};
            }
    return count == 1 ? found : std::nullopt;
}
Real gain(const Body& body, const Vec& q, const Vec& v, const Impact& impact) {
    const Rows D = body.rows(q);
    return impact.impulses.dot(D * v + D * impact.after) / 2;
}
std::optional<Impact> impact(const Body& body, const Vec& q, const Vec& v, const Signs& held_now) {
    auto result = impact_with(body, q, v, held_now, body.e);
    if (!result || !(gain(body, q, v, *result) > 0)) return result;
    Real low = 0, high = body.e;
    for (int round = 0; round < 70; ++round) {
        const Real middle = (low + high) / 2;
        const auto reduced = impact_with(body, q, v, held_now, middle);
        if (!reduced) return std::nullopt;
        (gain(body, q, v, *reduced) > 0 ? high : low) = middle;
    }
    return impact_with(body, q, v, held_now, low);
}

struct State4 {
    Vec q, v;
};

// The motion with the first contact, and perhaps the second, held.
struct Motion {
    const Body* body;
    std::array<bool, 2> closed;
    Signs signs;

    Vec forces(const State4& x) const {
        const Rows D = body->rows(x.q);
        return forces_in(*body, D, closed, signs, D * body->M_inverse * body->force + body->bending(x.q, x.v));
    }
    Vec acceleration(const State4& x) const {
        return body->M_inverse * (body->force + body->rows(x.q).transpose() * forces(x));
    }
    // By extrapolation of the midpoint rule.
    State4 after(State4 state, Real duration) const {
        constexpr int most = 6;
        const int columns = duration < 1e-3L ? 4 : most;
        const int parts = duration < 0.05L ? 1 : 4;
        for (int part = 0; part < parts; ++part) {
            std::array<State4, most> row;
            for (int k = 0; k < columns; ++k) {
                State4 last = midpoint(state, duration / parts, 2 * (k + 1));
                for (int j = 0; j < k; ++j) {
                    const Real ratio = Real(k + 1) / Real(k - j), factor = 1 / (ratio * ratio - 1);
                    State4& other = row[static_cast<std::size_t>(j)];
                    const State4 better{last.q + factor * (last.q - other.q), last.v + factor * (last.v - other.v)};
                    other = last;
                    last = better;
                }
                row[static_cast<std::size_t>(k)] = last;
            }
            state = row[static_cast<std::size_t>(columns - 1)];
        }
        return state;
    }

 private:
    State4 midpoint(const State4& from, Real H, int n) const {
        const Real h = H / n;
        State4 before = from, now{from.q + h * from.v, from.v + h * acceleration(from)};
        for (int k = 1; k < n; ++k) {
            const State4 next{before.q + 2 * h * now.v, before.v + 2 * h * acceleration(now)};
            before = now;
            now = next;
        }
        return {(now.q + before.q + h * now.v) / 2, (now.v + before.v + h * acceleration(now)) / 2};
    }
};

// The bouncing from an impact until the flights are too short to matter.
struct Bouncing {
    std::vector<Signs> signs;  // by impact
    std::vector<bool> capped;
    bool is_regular = true;  // every impact has one solution, and the held contact keeps its state in flights
    struct Instant {
        Real t;
        Vec q;
    };
    std::vector<Instant> heights;  // in the middle of flights
    Real zeno_time = 0;
    Vec q, v;
};
Bouncing bounce(const Body& body, State4 state, const Signs& held) {
    Bouncing result;
    const Motion flight{&body, {true, false}, held};
    Real t = 0;
    for (;;) {
        const Real w = -(body.rows(state.q) * state.v)[2];
        const auto solved = impact(body, state.q, state.v, held);
        if (!solved) {
            result.is_regular = false;
            return result;
        }
        result.signs.push_back(solved->signs);
        result.capped.push_back(solved->e < body.e);
        State4 now{state.q, solved->after};
        const Rows D = body.rows(now.q);
        const Real a = -(D * flight.acceleration(now) + body.bending(now.q, now.v))[2];
        if (w < 1e-9L || result.signs.size() > 400) {
            const Motion contact{&body, {true, true}, solved->signs};
            const Real rest = 2 * (D * now.v)[2] / (a * (1 - solved->e));
            result.zeno_time = t + rest;
            result.q = now.q + rest * now.v;
            result.v = solved->plastic + rest * contact.acceleration({now.q, solved->plastic});
            return result;
        }
        Real span = 2 * (D * now.v)[2] / a;
        State4 landed;
        for (int round = 0; round < 12; ++round) {
            landed = flight.after(now, span);
            const Real step = landed.q[2] / landed.v[2];
            span -= step;
            if (std::abs(step) < 1e-18L * span) break;
        }
        const State4 middle = flight.after(now, span / 2);
        for (const State4& x : {now, middle, landed}) {
            const Vec force = flight.forces(x);
            const Real u = (body.rows(x.q) * x.v)[1];
            result.is_regular = result.is_regular && obeys(body, 0, held[0], force, u) && force[0] > 0;
        }
        if (result.heights.size() < 3) result.heights.push_back({t + span / 2, middle.q});
        state = landed;
        state.q[2] = 0;
        t += span;
    }
}

std::string text_of(const Body& body) {
    const auto m = [&](int i, int k) { return static_cast<double>(body.M(i, k)); };
    std::string kinetic, potential;
    constexpr const char* names[] = {"x", "y", "z", "phi"};
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) kinetic += fmt::format(" + {:.17g}/2*{}'*{}'", m(i, k), names[i], names[k]);
    for (int i = 0; i < 4; ++i) potential += fmt::format(" - {:.17g}*{}", static_cast<double>(body.force[i]), names[i]);
    const auto friction = [&](int i, const std::string& slip) {
        return body.has_friction(i)
                   ? fmt::format("slip = \"{}\"\nfriction = {:.17g}\n", slip, body.mu[static_cast<std::size_t>(i)])
                   : std::string();
    };
    return fmt::format(R"-(coordinate = [{{name = "x"}}, {{name = "y"}}, {{name = "z"}}, {{name = "phi"}}]
lagrangian.kinetic = "0{}"
lagrangian.potential = "0{}"
[[constraint]]
name = "held"
gap = "y - {:.17g}*sin(x)"
restitution = 0.5
{}[[constraint]]
name = "bouncing"
gap = "z"
restitution = {:.17g}
{})-",
                       kinetic, potential, body.A,
                       friction(0, fmt::format("x' + {:.17g}*cos(x)*y' + {:.17g}*phi'", body.A, body.r_1)), body.e,
                       friction(1, fmt::format("(1 + {:.17g}*cos(x))*x' + phi' + {:.17g}*z'", body.k, body.r_2)));
}

Vector rounded(const Vec& x) {
    Vector result(4);
    for (Eigen::Index i = 0; i < 4; ++i) result[i] = static_cast<double>(x[i]);
    return result;
}
Vec exact(const Vector& x) {
    Vec result;
    for (Eigen::Index i = 0; i < 4; ++i) result[i] = x[i];
    return result;
}

// One random collision: the certificate, and its comparison with the true bouncing.
class Trial {
 public:
    Trial(Rubbing held, Rubbing bouncing, bool capped, std::mt19937& random) {
        const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
        body_.rubbing = {held, bouncing};
        body_.M.setZero();
        for (int i = 0; i < 4; ++i) {
            body_.M(i, i) = between(0.5, 2.0);
            for (int k = 0; k < i; ++k) body_.M(i, k) = body_.M(k, i) = between(-0.3, 0.3) * (capped ? 1.5 : 1.0);
        }
        body_.M(1, 2) = body_.M(2, 1) = between(-0.05, 0.5);  // positive: impulses press the held contact
        body_.M_inverse = body_.M.inverse();
        body_.force << between(-0.3, 0.3), between(-2.0, -1.0), between(-2.0, -1.0), between(-0.3, 0.3);
        body_.A = between(0.1, 0.8);
        body_.r_1 = between(-0.5, 0.5);
        body_.r_2 = capped ? (between(0.0, 1.0) < 0.5 ? between(-1.2, -0.6) : between(0.6, 1.2)) : between(-0.6, 0.6);
        body_.k = between(-0.5, 0.5);
        const auto coefficient = [&](Rubbing how) {
            return how == Rubbing::sticks ? between(0.5, capped ? 2.5 : 1.5) : between(0.05, 0.3);
        };
        body_.mu = {coefficient(held), coefficient(bouncing)};
        body_.e = capped ? between(0.85, 0.97) : between(0.2, 0.8);
        const double x = between(-2.0, 2.0), w = std::pow(10.0, between(-3.0, -1.0));
        const Real y = body_.A * std::sin(Real(x));
        state_.q << x, y, 0, 0;
        state_.v << between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1);
        if (capped) make_skew_flights(between(0.8, 1.2));
        settle(w, capped ? between(0.9, 1.1) : between(0.0, 1.0));
        state_.v = exact(rounded(state_.v));
        settle(-(body_.rows(state_.q) * state_.v)[2], -1);
    }

    // Nothing if the first impact is of another kind or nothing is proved.
    std::optional<std::string> check(BesideHeld& tally) {
        const auto first = impact(body_, state_.q, state_.v, held_);
        if (!first) return std::nullopt;
        for (int i = 0; i < 2; ++i) {
            const auto c = static_cast<std::size_t>(i);
            const bool sticks = first->signs[c] == 0 && body_.has_friction(i);
            if (sticks != (body_.rubbing[c] == Rubbing::sticks)) return std::nullopt;
        }
        if (body_.rubbing[0] == Rubbing::slides && first->signs[0] != held_[0]) return std::nullopt;
        signs_ = first->signs;
        const auto model = derive(parse_system(text_of(body_)));
        const Run run = model->default_run();
        const auto state_of = [&](std::size_t i) {
            return signs_[i] == 0 ? ContactState::held : slip_state(signs_[i]);
        };
        const BouncingKey key{1, Mode().with(std::size_t{0}, state_of(0)), state_of(1)};
        if (const auto obstacle = model->obstacle_to_bouncing(key)) return std::string(obstacle->text);
        const auto conditions = truncation_conditions(*model, run, Interval(body_.e), key, ContactSet());
        s_ = first->plastic;
        Collision collision{{rounded(state_.q), rounded(state_.v), 0.0},
                            static_cast<double>(-(body_.rows(state_.q) * state_.v)[2]),
                            rounded(s_),
                            rounded(s_),
                            {},
                            first->e < body_.e};
        sticks_ = body_.rubbing[1] == Rubbing::sticks;
        if (sticks_) {
            const FloatEnvironmentGuard ground;
            State restart = conditions->restart_at(collision);
            ContactCache surfaces(*model, run);
            if (!surfaces.settle(restart, key.mode.with(1, key.state))) return std::nullopt;
            collision.position = restart.q;
            collision.restart = restart.v;
        }
        const auto certificate = conditions->prove_any(collision);
        if (!certificate || !certificate->uniform_position) {
            const auto& obstacle = conditions->obstacle();
            ++tally.obstacles[obstacle ? fmt::format("{} {}", obstacle->which, obstacle->text) : "other"];
            return std::nullopt;
        }
        tally.capped += collision.is_capped ? 1 : 0;
        return compare(*certificate, collision, tally.closest);
    }

 private:
    // Sets a force so that later impacts have u/w near -W_NT/W_NN, where they gain most.
    void make_skew_flights(double part) {
        const Motion flight{&body_, {true, false}, {0, 0}};
        const Rows D = body_.rows(state_.q);
        const Mat W = D * body_.M_inverse * D.transpose();
        const auto off = [&](Real force) {
            body_.force[3] = force;
            const Vec a = D * flight.acceleration(state_) + body_.bending(state_.q, state_.v);
            return 2 * a[3] * W(2, 2) - Real(part) * W(2, 3) * a[2];
        };
        const Real at_zero = off(0), slope = off(1) - at_zero;
        body_.force[3] = static_cast<double>(-at_zero / slope);
    }
    // Sets hdot = u = 0 of what is held, and hdot = -w. A contact that sticks at its impacts has a part of the slip to
    // which a flight leads, or keeps its slip if `part` is negative.
    void settle(Real w, Real part) {
        const Rows D = body_.rows(state_.q);
        Vec change = -(D * state_.v);
        if (body_.rubbing[0] != Rubbing::sticks) change[1] = 0;
        change[2] -= w;
        if (body_.rubbing[1] != Rubbing::sticks || part < 0) {
            change[3] = 0;
        } else {
            held_[0] = body_.rubbing[0] != Rubbing::slides ? 0 : (D * state_.v)[1] > 0 ? 1 : -1;
            const Motion flight{&body_, {true, false}, held_};
            const Vec a = D * flight.acceleration(state_) + body_.bending(state_.q, state_.v);
            change[3] += part * 2 * w * a[3] / -a[2];
        }
        state_.v += body_.M_inverse * D.transpose() * (D * body_.M_inverse * D.transpose()).inverse() * change;
        held_[0] = body_.rubbing[0] != Rubbing::slides ? 0 : (body_.rows(state_.q) * state_.v)[1] > 0 ? 1 : -1;
    }

    std::string compare(const Certificate& c, const Collision& collision, double& closest) const {
        const Bouncing truth = bounce(body_, state_, held_);
        if (!truth.is_regular) return "the state of the held contact, or an impact with several solutions";
        for (const Signs& each : truth.signs)
            if (each != signs_) return "the branch";
        for (const bool capped : truth.capped)
            if (capped != collision.is_capped) return "the cap";
        if (truth.zeno_time < c.zeno_low || truth.zeno_time > c.zeno_high) return "the Zeno time";
        const Motion contact{&body_, {true, true}, signs_};
        State4 state{sticks_ ? exact(collision.position) : state_.q, sticks_ ? exact(collision.restart) : s_};
        constexpr double own_error = 1e-17;  // of the flights and impacts in long double
        if ((truth.q - state.q).norm() > c.position_bound) return "the position bound";
        if ((truth.v - state.v).norm() > c.velocity_bound) return "the velocity bound";
        Real t = 0;
        for (const Bouncing::Instant& instant : truth.heights) {
            state = contact.after(state, instant.t - t);
            t = instant.t;
            if ((instant.q - state.q).norm() > *c.uniform_position) return "the uniform bound";
        }
        state = contact.after(state, truth.zeno_time - t);
        const auto position = static_cast<double>((truth.q - state.q).norm()) - own_error,
                   velocity = static_cast<double>((truth.v - state.v).norm()) - own_error;
        closest = std::max({closest, position / *c.shadowing_position, velocity / *c.shadowing_velocity});
        if (position > *c.shadowing_position) return "the position at the Zeno time";
        if (velocity > *c.shadowing_velocity) return "the velocity at the Zeno time";
        return "";
    }

    Body body_{};
    State4 state_;
    Signs held_{}, signs_{};
    Vec s_;
    bool sticks_ = false;
};

}  // namespace

BesideHeld check_bouncing_beside(Rubbing held, Rubbing bouncing, int trials, std::uint32_t seed, bool capped) {
    std::mt19937 random(seed);
    BesideHeld result;
    for (; result.trials < trials; ++result.trials) {
        const auto failure = Trial(held, bouncing, capped, random).check(result);
        if (!failure) continue;
        ++result.proved;
        if (failure->empty()) continue;
        if (++result.violations == 1) result.first_failure = fmt::format("trial {}: {}", result.trials, *failure);
    }
    return result;
}

}  // namespace achilles::test
