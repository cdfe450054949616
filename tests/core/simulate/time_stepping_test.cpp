// Moreau's time stepping, as in Siconos, against event-driven executions: another discretization of one impact law.
#include <gtest/gtest.h>

#include <cmath>

#include "contacts/complementarity.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

// Time stepping with a fixed step h. Forces and impacts act at the midpoint, as impulses of the whole step:
//     q_m = q + h/2 v,   v+ = v + h f(q_m, v, t_m) + M^-1 G' p,   q+ = q_m + h/2 v+
//     0 <= p perpendicular hdot+ + e hdot- >= 0 of the contacts whose gap is closed at q_m
class TimeStepping {
 public:
    TimeStepping(const Model& model, const Run& run, double step)
        : dof_(static_cast<std::size_t>(model.dof())),
          step_(step),
          end_time_(run.options.end_time),
          state_(run.start()),
          motion_(model.evaluator(model.motion({}).program, run.parameters)) {
        for (std::size_t i = 0; i < model.contacts(); ++i) {
            gaps_.push_back(model.evaluator(model.gap(i), run.parameters));
            contacts_.push_back(model.evaluator(model.programs_of(i).contact_terms, run.parameters));
            restitutions_.push_back(model.evaluator(model.restitution(i), run.parameters).output(0));
        }
    }

    State run() {
        const auto steps = std::lround((end_time_ - state_.t) / step_);
        for (long k = 0; k < steps; ++k) advance();
        return state_;
    }

 private:
    void advance() {
        State middle = state_;
        middle.q += 0.5 * step_ * state_.v;
        middle.t += 0.5 * step_;
        set_state(motion_, middle);
        motion_.run();
        for (std::size_t i = 0; i < dof_; ++i)
            state_.v[static_cast<Eigen::Index>(i)] += step_ * motion_.acceleration(i);
        ContactSet closed;
        for (std::size_t i = 0; i < gaps_.size(); ++i) {
            set_state(gaps_[i], middle);
            gaps_[i].run();
            if (gaps_[i].output(0) <= 0.0) closed = closed.with(i);
        }
        if (!closed.empty()) collide(closed, middle);
        state_.q = middle.q + 0.5 * step_ * state_.v;
        state_.t += step_;
    }

    // Adds the contact impulses to v, which includes the forces already.
    void collide(ContactSet closed, const State& middle) {
        std::vector<Vector> g, impulse;  // g_i, M^-1 g_i'
        std::vector<double> b;           // hdot + e hdot- without impulses
        for (std::size_t i = 0; i < contacts_.size(); ++i) {
            if (!closed.contains(i)) continue;
            auto& contact = contacts_[i];
            set_state(contact, middle);
            contact.run();
            Vector gradient(state_.v.size()), direction(state_.v.size());
            for (std::size_t k = 0; k < dof_; ++k) {
                gradient[static_cast<Eigen::Index>(k)] = contact.gradient(k);
                direction[static_cast<Eigen::Index>(k)] = contact.W() * contact.impulse_direction(k);
            }
            b.push_back(gradient.dot(state_.v) + contact.gap_t() + restitutions_[i] * contact.hdot());
            g.push_back(gradient);
            impulse.push_back(direction);
        }
        const auto count = static_cast<Eigen::Index>(b.size());
        ContactMatrix<double> W(count, count);
        ContactVector<double> free(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            free[i] = b[static_cast<std::size_t>(i)];
            for (Eigen::Index j = 0; j <= i; ++j)
                W(i, j) = W(j, i) = g[static_cast<std::size_t>(i)].dot(impulse[static_cast<std::size_t>(j)]);
        }
        const auto solved = solve_complementarity(W, free);
        ASSERT_TRUE(solved);
        for (Eigen::Index i = 0; i < count; ++i) state_.v += solved->p[i] * impulse[static_cast<std::size_t>(i)];
    }

    std::size_t dof_;
    double step_, end_time_;
    State state_;
    MotionTerms<Evaluator<double>> motion_;
    std::vector<Evaluator<double>> gaps_;
    std::vector<ContactTerms<Evaluator<double>>> contacts_;
    std::vector<double> restitutions_;
};

// The error is of first order in h. It must be less than half of the difference between the results with h and 10 h.
TEST(TimeStepping, EndsWhereTheExecutionDoes) {
    for (const std::string name : {"ball_in_box", "pendulum_two_stops", "bowl_and_post"}) {
        SCOPED_TRACE(name);
        const auto model = test::load(name);
        const auto run = model->default_run();
        const Trajectory execution = simulate(model, run);
        ASSERT_EQ(execution.outcome.kind, Outcome::Kind::end_time) << execution.outcome.message;
        const State rough = TimeStepping(*model, run, 1e-4).run(), fine = TimeStepping(*model, run, 1e-5).run();
        const auto apart = [](const State& a, const State& b) { return (a.q - b.q).norm() + (a.v - b.v).norm(); };
        EXPECT_LT(apart(fine, execution.end), 0.5 * apart(fine, rough));
        EXPECT_LT(apart(fine, execution.end), 1e-4);
        EXPECT_GT(apart(fine, execution.end), 1e-9);  // the method is a different one
    }
}

}  // namespace
}  // namespace achilles
