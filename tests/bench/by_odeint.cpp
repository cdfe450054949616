// The Boost.Odeint program: dopri5 with dense output, written by an expert for these problems.
// - The first step of a flight comes from its predicted duration, and roots too soon after an impact or a release are
//   ignored. The gap is also evaluated inside steps.
// - TOMS 748 finds the root on dense output. The last step before an event is repeated, so that its end is integrated.
// - A plastic impact ends the sequence, and the state in contact is projected.
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
// Must precede the next header, which does not include it.
#include <boost/numeric/odeint/util/unwrap_reference.hpp>

#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "bench/by_hand.hpp"

namespace achilles::bench {
namespace {

namespace odeint = boost::numeric::odeint;
using Stepper = odeint::runge_kutta_dopri5<Values>;
using Dense = odeint::result_of::make_dense_output<Stepper>::type;

template <class Problem>
class Odeint final : public Program {
 public:
    Result run(const Values& start, const Settings& settings) override {
        settings_ = settings;
        dense_ = odeint::make_dense_output(settings.tolerance, settings.tolerance, Stepper());
        y_ = start;
        left_ = settings.end_time;
        natural_ = 0.1;
        blind_ = hint_ = 0.0;
        result_ = {};
        bool contact = false;
        while (left_ > 0.0) {
            if (contact) {
                stay();
                contact = false;
            } else {
                contact = fly();
            }
        }
        result_.end = y_;
        return result_;
    }

 private:
    // Integrates to the next impact and performs it. True if contact follows.
    bool fly() {
        constexpr auto rates = [](const Values& y, Values& rate, double) { Problem::flight(y, rate); };
        const auto gap = [&](double t) {
            dense_.calc_state(t, sample_);
            return Problem::gap(sample_);
        };
        begin(hint_ > 0.0 ? std::min(hint_, natural_) : natural_);
        for (double positive = blind_;;) {
            step(rates);
            const double from = dense_.previous_time(), to = dense_.current_time();
            constexpr int looks = 4;
            for (int look = 1; look <= looks; ++look) {
                const double t = look == looks ? to : from + look * (to - from) / looks;
                if (t <= blind_) continue;
                if ((look == looks ? Problem::gap(dense_.current_state()) : gap(t)) > 0.0) {
                    positive = t;
                    continue;
                }
                arrive(rates, root(gap, positive, t));
                const double w = -Problem::gap_rate(y_);
                if (w > 0.0) shift(rates, Problem::gap(y_) / w);
                return land();
            }
            if (ended()) return false;
        }
    }

    bool land() {
        const double hdot = Problem::gap_rate(y_);
        Values plastic = y_;
        bounce<Problem>(plastic, hdot, 0.0);
        if (-hdot < settings_.cut && Problem::normal_acceleration(plastic) < 0.0) {
            y_ = plastic;
            project<Problem>(y_);
            ++result_.zenos;
            return true;
        }
        ++result_.impacts;
        bounce<Problem>(y_, hdot, Problem::e);
        const double a = -Problem::normal_acceleration(y_), flight = a > 0.0 ? -2.0 * Problem::e * hdot / a : 0.0;
        hint_ = 1.05 * flight;
        blind_ = a > 0.0 ? 0.25 * flight : 1e-3;
        return false;
    }

    // Integrates to the release.
    void stay() {
        constexpr auto rates = [](const Values& y, Values& rate, double) { Problem::contact(y, rate); };
        const auto lift = [&](double t) {
            dense_.calc_state(t, sample_);
            return Problem::normal_acceleration(sample_);
        };
        begin(natural_);
        while (true) {
            step(rates);
            const Values& end = dense_.current_state();
            if (Problem::normal_acceleration(end) > 0.0) break;
            if (ended()) return project<Problem>(y_);
            const double drift = std::max(std::abs(Problem::gap(end)), std::abs(Problem::gap_rate(end)));
            if (drift > settings_.tolerance) {
                y_ = end;
                left_ -= dense_.current_time();
                project<Problem>(y_);
                begin(natural_);
            }
        }
        arrive(rates, root(lift, dense_.previous_time(), dense_.current_time()));
        project<Problem>(y_);
        ++result_.releases;
        hint_ = 0.0;
        blind_ = 0.05;
    }

    // Time starts from 0 in every segment, so that the shortest flight has full relative accuracy.
    void begin(double dt) { dense_.initialize(y_, 0.0, std::min(dt, left_)); }

    template <class Rates>
    void step(const Rates& rates) {
        const double rest = left_ - dense_.current_time();
        const bool last = dense_.current_time_step() > rest;
        if (last) dense_.initialize(Values(dense_.current_state()), dense_.current_time(), rest);
        const bool short_by_order = last || hint_ > 0.0;
        dense_.do_step(rates);
        natural_ = short_by_order ? std::max(natural_, dense_.current_time_step()) : dense_.current_time_step();
        hint_ = 0.0;
    }

    bool ended() {
        if (left_ - dense_.current_time() > 1e-14 * settings_.end_time) return false;
        y_ = dense_.current_state();
        left_ = 0.0;
        return true;
    }

    // Repeats the last step, to this time.
    template <class Rates>
    void arrive(const Rates& rates, double t) {
        y_ = dense_.previous_state();
        stepper_.reset();  // it keeps the derivative from the end of its last step
        stepper_.do_step(rates, y_, 0.0, t - dense_.previous_time());
        left_ -= t;
    }

    template <class Rates>
    void shift(const Rates& rates, double dt) {
        Values rate;
        rates(y_, rate, 0.0);
        for (std::size_t i = 0; i < y_.size(); ++i) y_[i] += dt * rate[i];
        left_ -= dt;
    }

    template <class Function>
    static double root(const Function& f, double a, double b) {
        const double at_a = f(a), at_b = f(b);
        if ((at_a > 0.0) == (at_b > 0.0)) return a;  // the event lies before this step
        std::uintmax_t rounds = 60;
        const auto [low, high] = boost::math::tools::toms748_solve(
            f, a, b, at_a, at_b, boost::math::tools::eps_tolerance<double>(50), rounds);
        return 0.5 * (low + high);
    }

    Settings settings_;
    Dense dense_;
    Stepper stepper_;
    Values y_{}, sample_{};
    double left_ = 0.0;     // from the start of this segment to the end of the run
    double natural_ = 0.0;  // the next step by the error control
    double hint_ = 0.0;     // bound on the first step of the next flight; 0: none
    double blind_ = 0.0;    // no root is looked for before this time of the flight
    Result result_;
};

}  // namespace

template <class Problem>
std::unique_ptr<Program> by_odeint() {
    return std::make_unique<Odeint<Problem>>();
}
template std::unique_ptr<Program> by_odeint<Ball>();
template std::unique_ptr<Program> by_odeint<Pendulum>();

}  // namespace achilles::bench
