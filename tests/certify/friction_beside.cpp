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

using Long = long double;
using LongVector = Eigen::Matrix<Long, 4, 1>;
using LongMatrix = Eigen::Matrix<Long, 4, 4>;
using RubbingRows = Eigen::Matrix<Long, 4, 4>;  // gap and slip of the held contact, then of the bouncing one
using Signs = std::array<int, 2>;               // of the slips, 0: sticks

constexpr int gap_of[] = {0, 2}, slip_of[] = {1, 3};

// Coordinates x, y, z, phi; constant forces.
//     h_1 = y - A sin x,             u_1 = x' + A cos x y' + r_1 phi'
//     h_2 = z,                       u_2 = (1 + k cos x) x' + phi' + r_2 z'
// The bouncing gap is a coordinate, so that no digits are lost in low flights.
struct RubbingBody {
    LongMatrix M, M_inverse;
    LongVector force;
    double A, r_1, r_2, k;
    std::array<double, 2> mu;
    double e;
    std::array<Rubbing, 2> rubbing;

    // The matrix of the rows, and their accelerations at a = 0.
    RubbingRows rows(const LongVector& q) const {
        const Long c = std::cos(q[0]);
        RubbingRows D;
        D << -A * c, 1, 0, 0,  //
            1, A * c, 0, r_1,  //
            0, 0, 1, 0,        //
            1 + k * c, 0, r_2, 1;
        return D;
    }
    LongVector bending(const LongVector& q, const LongVector& v) const {
        const Long s = std::sin(q[0]);
        return {A * s * v[0] * v[0], -A * s * v[0] * v[1], 0, -k * s * v[0] * v[0]};
    }
    bool has_friction(int contact) const { return rubbing[static_cast<std::size_t>(contact)] != Rubbing::none; }
};

// The impulses or forces of closed contacts in a branch, which bring the gaps by `gaps` and the slips that stick by
// `slips` to 0. Entry of a row: its force.
LongVector forces_in(const RubbingBody& body, const RubbingRows& D, const std::array<bool, 2>& closed,
                     const Signs& signs, const LongVector& rates) {
    const LongMatrix W = D * body.M_inverse * D.transpose();
    std::vector<int> kept;
    std::vector<LongVector> columns;
    for (int i = 0; i < 2; ++i) {
        const auto c = static_cast<std::size_t>(i);
        if (!closed[c]) continue;
        LongVector normal = LongVector::Zero();
        normal[gap_of[i]] = 1;
        if (body.has_friction(i) && signs[c] != 0) normal[slip_of[i]] = -signs[c] * Long(body.mu[c]);
        columns.push_back(normal);
        kept.push_back(gap_of[i]);
        if (!body.has_friction(i) || signs[c] != 0) continue;
        LongVector tangential = LongVector::Zero();
        tangential[slip_of[i]] = 1;
        columns.push_back(tangential);
        kept.push_back(slip_of[i]);
    }
    const auto n = static_cast<Eigen::Index>(kept.size());
    Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic> A(n, n);
    Eigen::Matrix<Long, Eigen::Dynamic, 1> b(n);
    for (Eigen::Index r = 0; r < n; ++r) {
        for (Eigen::Index k = 0; k < n; ++k)
            A(r, k) = W.row(kept[static_cast<std::size_t>(r)]).dot(columns[static_cast<std::size_t>(k)]);
        b[r] = -rates[kept[static_cast<std::size_t>(r)]];
    }
    const Eigen::Matrix<Long, Eigen::Dynamic, 1> p = A.fullPivLu().solve(b);
    LongVector result = LongVector::Zero();
    for (Eigen::Index k = 0; k < n; ++k) result += p[k] * columns[static_cast<std::size_t>(k)];
    return result;
}

// Whether forces obey the law of friction, where the slips after an impact (or their accelerations from 0) are `u`.
bool obeys(const RubbingBody& body, int i, int sign, const LongVector& force, Long u) {
    const auto c = static_cast<std::size_t>(i);
    if (!(force[gap_of[i]] >= 0)) return false;
    if (!body.has_friction(i)) return true;
    return sign == 0 ? std::abs(force[slip_of[i]]) <= body.mu[c] * force[gap_of[i]] : sign * u > 0;
}

// The impact law: every branch is tried. Nothing if not exactly one obeys it.
struct RubbingImpact {
    Signs signs;
    LongVector after, plastic;  // v+, and s of the same branch at restitution 0
    LongVector impulses;
    Long e;  // less than that of the body if the impact is capped
};
std::optional<RubbingImpact> impact_with(const RubbingBody& body, const LongVector& q, const LongVector& v,
                                         const Signs& held_now, Long e) {
    const RubbingRows D = body.rows(q);
    LongVector before = D * v;
    before[0] = 0;
    if (body.has_friction(0) && held_now[0] == 0) before[1] = 0;
    std::optional<RubbingImpact> found;
    int count = 0;
    for (const int first : {0, 1, -1})
        for (const int second : {0, 1, -1})
            for (const bool held : {true, false}) {
                if ((!body.has_friction(0) || !held) && first != 0) continue;
                if (!body.has_friction(1) && second != 0) continue;
                LongVector rates = before;
                rates[2] *= 1 + e;
                const LongVector p = forces_in(body, D, {held, true}, {first, second}, rates);
                const LongVector after = before + D * body.M_inverse * D.transpose() * p;
                const bool valid =
                    obeys(body, 1, second, p, after[3]) && (held ? obeys(body, 0, first, p, after[1]) : after[0] > 0);
                if (!valid) continue;
                ++count;
                if (!held) continue;
                const LongVector s = forces_in(body, D, {true, true}, {first, second}, before);
                found = RubbingImpact{{first, second},
                                      v + body.M_inverse * D.transpose() * p,
                                      v + body.M_inverse * D.transpose() * s,
                                      p,
                                      e};
            }
    return count == 1 ? found : std::nullopt;
}
Long energy_gained(const RubbingBody& body, const LongVector& q, const LongVector& v, const RubbingImpact& impact) {
    const RubbingRows D = body.rows(q);
    return impact.impulses.dot(D * v + D * impact.after) / 2;
}
std::optional<RubbingImpact> impact_of_rubbing(const RubbingBody& body, const LongVector& q, const LongVector& v,
                                               const Signs& held_now) {
    auto result = impact_with(body, q, v, held_now, body.e);
    if (!result || !(energy_gained(body, q, v, *result) > 0)) return result;
    Long low = 0, high = body.e;
    for (int round = 0; round < 70; ++round) {
        const Long middle = (low + high) / 2;
        const auto reduced = impact_with(body, q, v, held_now, middle);
        if (!reduced) return std::nullopt;
        (energy_gained(body, q, v, *reduced) > 0 ? high : low) = middle;
    }
    return impact_with(body, q, v, held_now, low);
}

struct State4 {
    LongVector q, v;
};

// The motion with the first contact, and perhaps the second, held.
struct RubbingMotion {
    const RubbingBody* body;
    std::array<bool, 2> closed;
    Signs signs;

    LongVector forces(const State4& x) const {
        const RubbingRows D = body->rows(x.q);
        return forces_in(*body, D, closed, signs, D * body->M_inverse * body->force + body->bending(x.q, x.v));
    }
    LongVector acceleration(const State4& x) const {
        return body->M_inverse * (body->force + body->rows(x.q).transpose() * forces(x));
    }
    // By extrapolation of the midpoint rule.
    State4 after(State4 state, Long duration) const {
        constexpr int most = 6;
        const int columns = duration < 1e-3L ? 4 : most;
        const int parts = duration < 0.05L ? 1 : 4;
        for (int part = 0; part < parts; ++part) {
            std::array<State4, most> row;
            for (int k = 0; k < columns; ++k) {
                State4 last = midpoint(state, duration / parts, 2 * (k + 1));
                for (int j = 0; j < k; ++j) {
                    const Long ratio = Long(k + 1) / Long(k - j), factor = 1 / (ratio * ratio - 1);
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
    State4 midpoint(const State4& from, Long H, int n) const {
        const Long h = H / n;
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
struct RubbingBouncing {
    std::vector<Signs> signs;  // by impact
    std::vector<bool> capped;
    bool is_regular = true;  // every impact has one solution, and the held contact keeps its state in flights
    struct Instant {
        Long t;
        LongVector q;
    };
    std::vector<Instant> heights;  // in the middle of flights
    Long zeno_time = 0;
    LongVector q, v;
};
RubbingBouncing bounce_rubbing(const RubbingBody& body, State4 state, const Signs& held) {
    RubbingBouncing result;
    const RubbingMotion flight{&body, {true, false}, held};
    Long t = 0;
    for (;;) {
        const Long w = -(body.rows(state.q) * state.v)[2];
        const auto solved = impact_of_rubbing(body, state.q, state.v, held);
        if (!solved) {
            result.is_regular = false;
            return result;
        }
        result.signs.push_back(solved->signs);
        result.capped.push_back(solved->e < body.e);
        State4 now{state.q, solved->after};
        const RubbingRows D = body.rows(now.q);
        const Long a = -(D * flight.acceleration(now) + body.bending(now.q, now.v))[2];
        if (w < 1e-9L || result.signs.size() > 400) {
            const RubbingMotion contact{&body, {true, true}, solved->signs};
            const Long rest = 2 * (D * now.v)[2] / (a * (1 - solved->e));
            result.zeno_time = t + rest;
            result.q = now.q + rest * now.v;
            result.v = solved->plastic + rest * contact.acceleration({now.q, solved->plastic});
            return result;
        }
        Long span = 2 * (D * now.v)[2] / a;
        State4 landed;
        for (int round = 0; round < 12; ++round) {
            landed = flight.after(now, span);
            const Long step = landed.q[2] / landed.v[2];
            span -= step;
            if (std::abs(step) < 1e-18L * span) break;
        }
        const State4 middle = flight.after(now, span / 2);
        for (const State4& x : {now, middle, landed}) {
            const LongVector force = flight.forces(x);
            const Long u = (body.rows(x.q) * x.v)[1];
            result.is_regular = result.is_regular && obeys(body, 0, held[0], force, u) && force[0] > 0;
        }
        if (result.heights.size() < 3) result.heights.push_back({t + span / 2, middle.q});
        state = landed;
        state.q[2] = 0;
        t += span;
    }
}

std::string text_of_rubbing(const RubbingBody& body) {
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

Vector rounded_long(const LongVector& x) {
    Vector result(4);
    for (Eigen::Index i = 0; i < 4; ++i) result[i] = static_cast<double>(x[i]);
    return result;
}
LongVector exact_long(const Vector& x) {
    LongVector result;
    for (Eigen::Index i = 0; i < 4; ++i) result[i] = x[i];
    return result;
}

// One random collision: the certificate, and its comparison with the true bouncing.
class RubbingTrial {
 public:
    RubbingTrial(Rubbing held, Rubbing bouncing, bool capped, std::mt19937& random) {
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
        const Long y = body_.A * std::sin(Long(x));
        state_.q << x, y, 0, 0;
        state_.v << between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1);
        if (capped) make_skew_flights(between(0.8, 1.2));
        settle(w, capped ? between(0.9, 1.1) : between(0.0, 1.0));
        state_.v = exact_long(rounded_long(state_.v));
        settle(-(body_.rows(state_.q) * state_.v)[2], -1);
    }

    // Nothing if the first impact is of another kind or nothing is proved.
    std::optional<std::string> check(BesideHeld& tally) {
        const auto first = impact_of_rubbing(body_, state_.q, state_.v, held_);
        if (!first) return std::nullopt;
        for (int i = 0; i < 2; ++i) {
            const auto c = static_cast<std::size_t>(i);
            const bool sticks = first->signs[c] == 0 && body_.has_friction(i);
            if (sticks != (body_.rubbing[c] == Rubbing::sticks)) return std::nullopt;
        }
        if (body_.rubbing[0] == Rubbing::slides && first->signs[0] != held_[0]) return std::nullopt;
        signs_ = first->signs;
        const auto model = derive(parse_system(text_of_rubbing(body_)));
        const Run run = model->default_run();
        const auto state_of = [&](std::size_t i) {
            return signs_[i] == 0 ? ContactState::held : slip_state(signs_[i]);
        };
        const BouncingKey key{1, Mode().with(std::size_t{0}, state_of(0)), state_of(1)};
        if (const auto obstacle = model->obstacle_to_bouncing(key)) return std::string(obstacle->text);
        const auto conditions = truncation_conditions(*model, run, Interval(body_.e), key, ContactSet());
        s_ = first->plastic;
        Collision collision{{rounded_long(state_.q), rounded_long(state_.v), 0.0},
                            static_cast<double>(-(body_.rows(state_.q) * state_.v)[2]),
                            rounded_long(s_),
                            rounded_long(s_),
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
    // Sets a force so that later impacts have u/w near -W_NT/W_NN, where they energy_gained most.
    void make_skew_flights(double part) {
        const RubbingMotion flight{&body_, {true, false}, {0, 0}};
        const RubbingRows D = body_.rows(state_.q);
        const LongMatrix W = D * body_.M_inverse * D.transpose();
        const auto off = [&](Long force) {
            body_.force[3] = force;
            const LongVector a = D * flight.acceleration(state_) + body_.bending(state_.q, state_.v);
            return 2 * a[3] * W(2, 2) - Long(part) * W(2, 3) * a[2];
        };
        const Long at_zero = off(0), slope = off(1) - at_zero;
        body_.force[3] = static_cast<double>(-at_zero / slope);
    }
    // Sets hdot = u = 0 of what is held, and hdot = -w. A contact that sticks at its impacts has a part of the slip to
    // which a flight leads, or keeps its slip if `part` is negative.
    void settle(Long w, Long part) {
        const RubbingRows D = body_.rows(state_.q);
        LongVector change = -(D * state_.v);
        if (body_.rubbing[0] != Rubbing::sticks) change[1] = 0;
        change[2] -= w;
        if (body_.rubbing[1] != Rubbing::sticks || part < 0) {
            change[3] = 0;
        } else {
            held_[0] = body_.rubbing[0] != Rubbing::slides ? 0 : (D * state_.v)[1] > 0 ? 1 : -1;
            const RubbingMotion flight{&body_, {true, false}, held_};
            const LongVector a = D * flight.acceleration(state_) + body_.bending(state_.q, state_.v);
            change[3] += part * 2 * w * a[3] / -a[2];
        }
        state_.v += body_.M_inverse * D.transpose() * (D * body_.M_inverse * D.transpose()).inverse() * change;
        held_[0] = body_.rubbing[0] != Rubbing::slides ? 0 : (body_.rows(state_.q) * state_.v)[1] > 0 ? 1 : -1;
    }

    std::string compare(const Certificate& c, const Collision& collision, double& closest) const {
        const RubbingBouncing truth = bounce_rubbing(body_, state_, held_);
        if (!truth.is_regular) return "the state of the held contact, or an impact with several solutions";
        for (const Signs& each : truth.signs)
            if (each != signs_) return "the branch";
        for (const bool capped : truth.capped)
            if (capped != collision.is_capped) return "the cap";
        if (truth.zeno_time < c.zeno_low || truth.zeno_time > c.zeno_high) return "the Zeno time";
        const RubbingMotion contact{&body_, {true, true}, signs_};
        State4 state{sticks_ ? exact_long(collision.position) : state_.q, sticks_ ? exact_long(collision.restart) : s_};
        constexpr double own_error = 1e-17;  // of the flights and impacts in long double
        if ((truth.q - state.q).norm() > c.position_bound) return "the position bound";
        if ((truth.v - state.v).norm() > c.velocity_bound) return "the velocity bound";
        Long t = 0;
        for (const RubbingBouncing::Instant& instant : truth.heights) {
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

    RubbingBody body_{};
    State4 state_;
    Signs held_{}, signs_{};
    LongVector s_;
    bool sticks_ = false;
};

}  // namespace

BesideHeld check_bouncing_beside(Rubbing held, Rubbing bouncing, int trials, std::uint32_t seed, bool capped) {
    std::mt19937 random(seed);
    BesideHeld result;
    for (; result.trials < trials; ++result.trials) {
        const auto failure = RubbingTrial(held, bouncing, capped, random).check(result);
        if (!failure) continue;
        ++result.proved;
        if (failure->empty()) continue;
        if (++result.violations == 1) result.first_failure = fmt::format("trial {}: {}", result.trials, *failure);
    }
    return result;
}

}  // namespace achilles::test
