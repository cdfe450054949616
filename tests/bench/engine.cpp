// bench_engine [ROUNDS] [BALLS]: the engine beside two programs written by hand, in one run: Boost.Odeint (by_odeint)
// and SUNDIALS ARKODE (by_arkode).
//
// Work and precision, for both problems of the paper's Fig. 4 to t = 20: for each error in the end state, the fastest
// setting of each contestant that meets it, also with a tolerance up to ten times smaller (so that no lucky error
// wins), then medians over ROUNDS (101) interleaved rounds. Settings are the tolerance and when the bouncing is cut: by
// the impact speed for the programs, by the certified bounds eps_q = eps_v for the engine; eps_t stays 1e-6, since the
// motion does not depend on where the Zeno event is put in time.
//
// Ensemble: BALLS (10 000) random balls at tolerance 1e-9, one core; the errors are those of the first 200, against 34
// digits, and "lost" are all that end under the floor, or not at all. The engine makes the runs one by one, as the
// programs do, or eight at a time (simulate_ends).
//
// The engine's time is the whole of simulate(): checks, dense output, events, statistics, certificates; where it says
// "end", and in the ensemble, only the end is kept (Keep::end), as the programs do. What it would be without the
// certificates, which the programs do not have, stands behind it: they are measured by asking the same questions again
// in the same round, in the ensemble by what the runs say of themselves. Times are those of the processor, which is
// named beside every ratio. Ratios are medians of the rounds' ratios to Boost.Odeint: above 1 is faster.
//
// What was tried, and what it gave of the engine's time (ball and pendulum at 1e-9, then at 1e-12):
//   sums, differences and multiples as linear forms instead of rules       pendulum -35 percent
//   fewer products in the equations (bias, f_c, n), whole vectors stored,
//   dense output scaled once, no look at the domain without an edge        -13, -16, -14, -20 percent
//   rules as machine code, inner sums compiled for each number of lanes    -21, -19, -20, -15 percent
//   order 0 and the surface's programs as machine code                     -4, -7, -1, -7 percent
//   one component watched per order instead of all, tables set up once,
//   Newton's method stopped by its own convergence                         -7, -7, -10, -10 percent
//   fewer evaluations per impact                                           0 to -10 percent
//   a whole order as machine code, then all orders up to the first small
//   one: half of the instructions                                          -18, -26 percent at 1e-9
//   ends evaluated where they are asked for, descents told from partial
//   sums instead of Bernstein coefficients, projection in place            -15 percent of the ball's
//   sine and cosine at once, and those of the last angles remembered       -5 percent
//   certificates put off by what the last proof found                      theirs, at 1e-12: -45 percent
//   contact forces told from the series alone, polynomials not filled with
//   zeros first, orders below the least not looked at, inner sums from a
//   cache line on (else none can be read back before all are stored), -O2
//   instead of -O3 (not for the programs, which it makes slower)        -8, -4, -8, -4 percent
//   evaluators made where they are first asked for, one program for the
//   guess of a cut                                                      ball -2 percent
// What gave nothing, or less:
//   vectors of eight instead of four doubles                            none on a Zen 4
//   other weights in the order's cost                                   within 3 percent
//   accelerations carried in registers from one order to the next, code
//   that begins with a cache line, no errno, AVX2 for all of the core   none
//   older rows laid out without a loop, with a jump to where they
//   begin                                                               none (26 orders in a loop: -6 percent)
//   the last terms of inner sums one by one, from registers             +10 percent from order 14 on
//   the newest of the older rows last                                   within 2 percent of 26 orders
//   operands of a rule by when they are known                           +10 percent with cold caches
//   four components in one vector when an end is evaluated              +5 percent
// What is left of the ball's time at 1e-9: two fifths is series, where every order waits for the one before (some 62
// cycles; inner sums that take 2 loads a term come on top of it); the rest is what each of 45 steps takes besides (two
// looks at the surface, the root, the step's length).
//
// Eight runs at a time, of the ensemble's time (one by one, a run takes 29 us; the series of its contact alone 12):
//   plain flights and contacts as vectors, left to the run's own stepper
//   where they are not plain; orders as machine code                            -38 percent
//   Executions used again instead of made anew, lane programs as machine code   -18 percent
//   functions compiled for AVX-512 with all that becomes a part of them (with
//   target_clones alone their comparisons stay scalar), flights of lower order  -18 percent
//   inner sums and accelerations in registers from one order to the next, each
//   factor loaded once                                                          -11 percent
//   contact to where what is left out, not the last term, reaches the tolerance -4 percent
//   steps in contact repeated in the lanes until one of the runs ends them      -5 percent
//   one program for the guess of a cut instead of three; sines by pairs of terms -5 percent
//   without AVX-512: machine code for AVX2, each half of an order by itself, and
//   halves of programs between two calls of functions                           -46 percent of the 128-bit loops'
// Of the pendulum's map (bench_explorer sweep), whose flights take many steps:
//   flights of 1.2 times the order that a step alone would have, brief ones, as
//   the bounce before tells them, of half of that                               -12 percent
//   a flight after a release goes back to the lanes once its gap is open        -12 percent
//   right factors of inner sums in the registers that results leave idle         -6 percent
//   roots of eight at once                                                       -2 percent
// What gave nothing: rows summed in another order, no vzeroupper between orders, more or fewer runs under way (12 to
// 48), 256-bit vectors instead of 128 without machine code, or for what is left to the compiler beside machine code.
#include "bench/engine.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "bench/measure.hpp"
#include "simulate/simulate.hpp"

namespace achilles::bench {

Values values_of(const State& state) { return {state.q[0], state.q[1], state.v[0], state.v[1]}; }

double error_of(const Values& end, const Values& truth) {
    double error = 0.0;
    for (std::size_t i = 0; i < end.size(); ++i) {
        const double difference = std::abs(end[i] - truth[i]);
        if (!(difference <= error)) error = difference;  // NaN stays
    }
    return error;
}

Run run_with(const Model& model, Method method, const Setting& setting) {
    Run run = model.default_run();
    run.options.method = method;
    run.options.end_time = 20.0;
    run.options.tolerance = setting.tolerance;
    run.options.truncation.eps_q = run.options.truncation.eps_v = setting.cut;
    return run;
}

std::vector<Method> methods(const std::shared_ptr<const Model>& model) {
    const auto end = [&](Method method) {
        return values_of(simulate(model, run_with(*model, method, {1e-9, 1e-9})).end);
    };
    if (end(Method::taylor) == end(Method::dopri5)) return {Method::dopri5};
    return {Method::dopri5, Method::taylor};
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

std::string ratio(const std::vector<double>& reference, const std::vector<double>& times) {
    if (reference.empty()) return "     -";
    std::vector<double> ratios;
    for (std::size_t i = 0; i < times.size(); ++i) ratios.push_back(reference[i] / times[i]);
    return fmt::format("{:6.2f}", median(ratios));
}

}  // namespace achilles::bench

int main(int count, char** arguments) {
    const int rounds = count > 1 ? std::atoi(arguments[1]) : 101, balls = count > 2 ? std::atoi(arguments[2]) : 10000;
    if (rounds < 1 || balls < 1) {
        fmt::print(stderr, "usage: bench_engine [ROUNDS] [BALLS]\n");
        return 2;
    }
    using namespace achilles::bench;
    measure_work_and_precision(rounds);
    measure_ensemble(balls, 1 + rounds / 20);
}
