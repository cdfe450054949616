// bench_engine [ROUNDS] [BALLS]: compares the engine with two programs written by hand, in one process: Boost.Odeint
// (by_odeint) and SUNDIALS ARKODE (by_arkode).
//
// Work and precision, for both problems of the paper's Fig. 4 to t = 20. For each error of the final state, the fastest
// setting of each contestant with this error is selected. The error must also hold for tolerances up to ten times
// smaller, so that no accidental cancellation wins. Then medians over ROUNDS (101) interleaved rounds are taken.
// Settings are the tolerance and the cut: by the impact speed for the programs, by the certified bounds eps_q = eps_v
// for the engine. eps_t stays 1e-6, since the motion does not depend on the estimated Zeno time.
//
// Ensemble: BALLS (10 000) random balls at tolerance 1e-9 on one core. Errors are those of the first 200, against 34
// digits. "lost" counts all that end under the floor or with a failure. The engine simulates single runs, as the
// programs do, or batches of eight (simulate_ends).
//
// The engine's time is that of simulate(): checks, dense output, events, statistics and certificates. With "end", and
// in the ensemble, only the final state is recorded (Recording::final_state), as in the programs. The time without
// certificates, which the programs do not have, is printed as well. Certificates are measured by repeating their
// requests in the same round, in the ensemble by the runs' own statistics. Times are processor times; the processor is
// named beside every ratio. Ratios are medians of the ratios to Boost.Odeint in each round; above 1 is faster.
//
// Optimizations, and the change of the engine's time (ball and pendulum at 1e-9, then at 1e-12):
//   sums, differences and multiples as linear forms instead of rules       pendulum -35 percent
//   fewer products in the equations (bias, f_c, n), whole vectors stored,
//   dense output scaled once, no domain check without a boundary           -13, -16, -14, -20 percent
//   rules as machine code, inner sums compiled for each number of lanes    -21, -19, -20, -15 percent
//   order 0 and the contact programs as machine code                       -4, -7, -1, -7 percent
//   one component watched per order instead of all, tables set up once,
//   Newton's method stopped by its own convergence                         -7, -7, -10, -10 percent
//   fewer evaluations per impact                                           0 to -10 percent
//   a whole order as machine code, then all orders up to the first small
//   one: half of the instructions                                          -18, -26 percent at 1e-9
//   ends evaluated only if requested, descents found by partial sums
//   instead of Bernstein coefficients, projection in place                 -15 percent of the ball's
//   sine and cosine together, and those of the last angles cached          -5 percent
//   certificates postponed by the result of the last proof                 their time, at 1e-12: -45 percent
//   contact forces from the series alone, polynomials not zeroed first,
//   orders below the minimum not checked, inner sums aligned to a cache
//   line (else none can be read back before all are stored), -O2 instead
//   of -O3 (not for the programs, which become slower with it)          -8, -4, -8, -4 percent
//   evaluators built at first use, one program for the estimate of a cut
//                                                                       ball -2 percent
//   less than 128 kB reserved for the record of a typical run: glibc returns more than that to the system after each
//   run, and the next one has page faults; larger records grow by four
//                                       everything kept: ball -11, pendulum -7 percent; kneed_leg -2 to -8 percent
//   end of a flight not evaluated where no coefficient of friction varies, no certificate formed whose time bound
//   fails (final states only)                                           ball at 1e-6, keeping the end: -3 percent
//   halves of a polynomial in the search for crossings in vectors       ball_on_vibrating_table -5 percent
//   force in contact below zero by partial sums (dopri5)                -4, -2 percent of dopri5
//   distances from the edges of domains in time, from the motion's own orders, without its polynomials; the bound of a
//   gap's rounding kept for values far above it, and that of the time of an impact computed only if another contact
//   approaches; a rough quotient that finds most intervals of angles free of extrema; squares as products in machine
//   code; slopes of a polynomial only if its values do not decide
//                 instructions: newtons_cradle -16 percent, other systems with edges -3 to -6, kneed_leg -2,
//                               ball_on_vibrating_table and the pendulum -1, ball 0
// The same for dopri5, in instructions of a run with everything kept (ball at 3.2e-10, pendulum at 1e-9):
//   rates of an event function stored as a pair, gaps known by a flag    -3, -3 percent
//   a gap far from zero not needed to the tolerance                      ball -23 percent (332 steps become 235)
//   a gap that surely stays open not searched, its rounding not bounded  -2, -3 percent
// An own Runge-Kutta method in place of Odeint's took 9 and 7 percent fewer instructions without these changes, and 7
// and 5 percent fewer with them. It was left out: a library is preferred to own code.
// Without effect, or with a loss:
//   sums of that method in vectors of four                               -4 percent of its instructions, no time
//   quick sines (lanes.hpp) of all angles of a stage of it at once       -3 percent of its instructions, no time
//   more of the rounding of a gap in the fast check of it: of the differences from h(q) that still need the bound in
//   newtons_cradle, more than half lie within it, most of these by a factor below 16
//   distances expanded only until their last terms are below a 64th of the start: -2 percent of newtons_cradle, but a
//   narrow dip beyond the radius of convergence would be missed
//   the largest coefficient of an order first and then its component, or two components at a time
//                                                                       +0.7, +0.5 percent of the ball's
//   dense output in pairs of components                                 none: the compiler does so
//   vectors of eight instead of four doubles                            none on a Zen 4
//   other weights in the order's cost                                   within 3 percent
//   accelerations carried in registers from one order to the next, code
//   that begins with a cache line, no errno, AVX2 for all of the core   none
//   older rows unrolled, with a jump to the first                       none (26 orders in a loop: -6 percent)
//   the last terms of inner sums one by one, from registers             +10 percent from order 14 on
//   the newest of the older rows last                                   within 2 percent of 26 orders
//   operands of a rule sorted by the time at which they are known       +10 percent with cold caches
//   four components in one vector when an end is evaluated              +5 percent
// Percent of all instructions with AVX2 (callgrind, bench_run), before the last five changes of the Taylor method; of
// newtons_cradle and dopri5 with all of them. Columns "end" keep the end, the others everything. The gallery's systems
// have their own tolerance, 1e-10; dopri5 has 3.2e-10 (ball) and 1e-9. Intervals are those of certificates and of the
// rounding of gaps.
//                                    ball  ball  pend. pend. kneed newtons_ vibrating dopri5 dopri5
//                                    1e-6  1e-9  1e-6  1e-9  _leg  cradle   _table    ball   pend.
//                                    end   end         end
//   thousands of instructions a run  400   462   867   987 11777   3928     2269      1755   4364
//   series, machine code              19    25    27    38    33     27       11         0      0
//   series, order 0, order, length    19    18    17    17     8     13        9         0      0
//   intervals                         17    15    17    15    16      6       17         3      2
//   roots and events of a step        13    13     9    10     6     11       29        12     11
//   automaton                          8     7     5     5     2      5        5         6      4
//   allocation and copying             8     7     6     5     5      5        5         3      3
//   sine, cosine, powers               5     5     5     4     5      7        3        22     29
//   contacts, projection               5     4     3     3     5      6        3         5      2
//   end of a step                      3     3     3     2     1      2        3         2      2
//   dense output, record, work         1     1     6     1    19      5       14         6      5
//   domains of functions               0     0     0     0     0     11        0         0      0
//   Runge-Kutta with its equations     0     0     0     0     0      0        0        40     40
//   other                              2     2     2     1     1      2        2         1      1
// No function of the ball's run but the machine code has more than 6 percent. Steps allocate nothing. In runs of dopri5
// the method, its equations and their sines are 63 and 69 percent.
// The program written by hand with Boost.Odeint needs 521 and 1804 thousand instructions. With the cuts chosen here it
// has as many evaluations of the right side for the pendulum (3456, dopri5 3528) and fewer for the ball (1460, dopri5
// 2167): in flight it does not integrate the gap, and it does not evaluate again after each projection. An evaluation
// with its share of a step takes 357 and 522 instructions there, 878 and 1309 in dopri5: 200 and 370 for sines, of
// which a third is their cache, and 350 and 530 for the method and the equations. The rest is what the program does not
// do at all.
// The remaining time of the ball at 1e-9: two fifths is the series, where every order waits for the one before (some 62
// cycles, plus inner sums with 2 loads a term). The rest is the other work in each of 45 steps: two evaluations of the
// contact, the root, and the step's length.
//
// Batches of eight, change of the ensemble's time (a single run takes 29 us, the series of its contact alone 12):
//   regular flights and contacts as vectors, others by the run's own stepper;
//   orders as machine code                                                      -38 percent
//   Executions reused instead of rebuilt, lane programs as machine code         -18 percent
//   functions compiled for AVX-512 with everything inlined into them (with
//   target_clones alone their comparisons stay scalar), flights of lower order  -18 percent
//   inner sums and accelerations in registers from one order to the next, each
//   factor loaded once                                                          -11 percent
//   contact steps until the remainder, not the last term, reaches the tolerance -4 percent
//   steps in contact repeated in the lanes until one of the runs ends them      -5 percent
//   one program for the estimate of a cut instead of three; sines by pairs      -5 percent
//   without AVX-512: machine code for AVX2, each half of an order by itself, and
//   halves of programs between two calls of functions                           -46 percent of the 128-bit loops'
//   the other functions for AVX2 as well, numbers loaded and copied as whole
//   vectors: a wider load from a copy in pieces of 16 bytes waits for them      -27 percent (AVX2)
//   runs in contact keep their lanes, which are refilled one by one             -3 percent (AVX2)
//   square roots of four at once                                                -1 percent (AVX2)
//   certificates of final states without the enclosure of third order           -4 percent (AVX2)
// The pendulum's map (bench_explorer sweep), whose flights take many steps:
//   flights with 1.2 times the order of a single step; half of that for short
//   ones, predicted by the flight before                                        -12 percent
//   a flight after a release returns to the lanes once its gap is open          -12 percent
//   right factors of inner sums in the registers that results leave idle         -6 percent
//   roots of eight at once                                                       -2 percent
// Without effect: rows summed in another order, no vzeroupper between orders, more or fewer runs at a time (12 to 48).
// With AVX2: rules of both halves emitted alternately, results that no rule reads again not stored, factors of the
// newest row loaded once for all sums, -O3, prefetching of the next run, batch_simulator.cpp in one unit with the
// automaton; other orders in contact or in flight; roots of concave gaps without Bernstein coefficients (few gaps are
// found to be concave). With a loss: both ends of an interval in one vector (+8 percent).
// The remaining time of an ensemble of balls with AVX2: 18.2 us a run, for 60 steps, 18 impacts and 1.1 certificates.
// All lanes are in use (99.6 percent), and 0.4 percent of the steps are made alone.
//   machine code of the series (3.6 instructions a cycle)              27 percent
//   certificates, with their sines and memory (2.8 us each)            18
//   compiled functions of eight runs, with their sines                 19
//   impacts, requests and results of single runs                       18
//   roots that partial sums do not show, steps made alone               5
//   start and end of a run, memory, the rest                           13
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
        if (!(difference <= error)) error = difference;  // keeps NaN
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
