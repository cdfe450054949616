// bench_interval [COUNT]: tests COUNT operations of Interval with special and random arguments. Each result is compared
// with the exact value at the ends, the midpoint and random members of the arguments. Exit code 1 if one exact value is
// outside.
//
// Three precisions are used, each only if the one before cannot decide. The first has 113 bits and a margin of 2^-100
// (libquadmath errs by a few 2^-113), the second 100 digits and a margin of 2^-200. The third has 700 digits, in which
// sums and products of doubles are exact and every double is reduced modulo pi. It also repeats one decision in a
// thousand.
#include <boost/multiprecision/float128.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "core/number/interval_cases.hpp"

namespace achilles::cases {
namespace {

using Quad = boost::multiprecision::float128;
using Wide = Real<700>;

enum class Verdict { inside, outside, doubtful };

// `margin` is relative to the value; 0 takes the value as exact.
template <class Number>
Verdict judge(const Interval& interval, const Number& value, double margin) {
    if (value != value) return Verdict::doubtful;
    if (!(value - value == 0)) {  // overflow in this precision, far beyond any double
        return std::isinf(value > 0 ? interval.hi() : interval.lo()) ? Verdict::inside : Verdict::outside;
    }
    // Possibly underflow in this precision, of exp or pow, whose values are positive.
    if (value == 0 && margin > 0.0 && !(interval.lo() <= 0.0 && interval.hi() > 0.0)) return Verdict::doubtful;
    const Number slack = abs(value) * Number(margin);
    const bool above = std::isinf(interval.lo()) || Number(interval.lo()) <= value - slack;
    const bool below = std::isinf(interval.hi()) || value + slack <= Number(interval.hi());
    if (above && below) return Verdict::inside;
    const bool outside = value + slack < Number(interval.lo()) || Number(interval.hi()) < value - slack;
    return outside ? Verdict::outside : Verdict::doubtful;
}

struct Tally {
    long operations = 0, values = 0, violations = 0, undefined = 0, hundred = 0, seven_hundred = 0;
    double nanoseconds = 0.0;

    void add(const Tally& other) {
        operations += other.operations;
        values += other.values;
        violations += other.violations;
        undefined += other.undefined;
        hundred += other.hundred;
        seven_hundred += other.seven_hundred;
        nanoseconds += other.nanoseconds;
    }
};

struct Case {
    Argument a, b;
    Interval ours;
};

template <class Function>
class Bench {
 public:
    Bench(const TestOperation& operation, Function function, Draw& draw)
        : operation_(operation), function_(function), draw_(draw) {}

    Tally run(long count) {
        std::vector<Case> batch(1000);
        std::vector<double> times;  // of each batch; the median is used, since other processes may interrupt some
        while (tally_.operations < count) {
            for (Case& c : batch) std::tie(c.a, c.b) = arguments(draw_, operation_);
            const auto start = std::chrono::steady_clock::now();
            for (Case& c : batch) c.ours = function_(c.a.interval, c.b.interval);
            times.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
            for (const Case& c : batch) check(c);
            tally_.operations += static_cast<long>(batch.size());
        }
        const auto median = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
        std::nth_element(times.begin(), median, times.end());
        tally_.nanoseconds = *median * static_cast<double>(times.size());
        return tally_;
    }

 private:
    void check(const Case& c) {
        const bool inside = is_inside(operation_.domain, c.a.interval, c.b.interval);
        if (!c.ours.is_defined()) {
            ++tally_.undefined;
            if (inside && !may_refuse(operation_.domain)) complain(c, c.a.inside, c.b.inside, "undefined");
            return;
        }
        if (!inside) return complain(c, c.a.inside, c.b.inside, "not undefined");
        if (!sizes_hold(c.a.interval, c.a.inside)) complain(c, c.a.inside, c.b.inside, "mid, rad or width");
        const Interval &a = c.a.interval, &b = c.b.interval;
        member(c, c.a.inside, c.b.inside);
        member(c, random(a), random(b));
        member(c, mid(a), mid(b));
        if (a.lo() == a.hi() && b.lo() == b.hi()) return;
        member(c, a.lo(), b.lo());
        member(c, a.hi(), b.hi());
        if (!operation_.binary) return;
        member(c, a.lo(), b.hi());
        member(c, a.hi(), b.lo());
    }

    double random(const Interval& a) {
        const double lo = std::max(a.lo(), -rounding::largest), hi = std::min(a.hi(), rounding::largest);
        const double t = draw_.uniform(0.0, 1.0);
        return std::clamp((1.0 - t) * lo + t * hi, lo, hi);
    }

    // Checks one member of the arguments. An infinite end is no member.
    void member(const Case& c, double x, double y) {
        if (!std::isfinite(x) || !std::isfinite(y)) return;
        Verdict verdict = judge(c.ours, function_(Quad(x), Quad(y)), operation_.selects ? 0.0 : 0x1p-100);
        const bool repeat = ++tally_.values % 1000 == 0;
        const bool huge = operation_.trigonometric && std::abs(x) > 0x1p40;
        if (verdict == Verdict::doubtful && !huge) {
            ++tally_.hundred;
            verdict = judge(c.ours, function_(Exact(x), Exact(y)), 0x1p-200);
        }
        if (verdict == Verdict::doubtful || repeat) {
            ++tally_.seven_hundred;
            const Verdict last = judge(c.ours, function_(Wide(x), Wide(y)), 0.0);
            if (verdict != Verdict::doubtful && last != Verdict::doubtful && last != verdict) {
                complain(c, x, y, "the judges disagree");
            }
            verdict = last;
        }
        if (verdict != Verdict::inside) complain(c, x, y, "outside");
    }

    void complain(const Case& c, double x, double y, const char* what) {
        if (++tally_.violations > 5) return;
        std::printf("VIOLATION %s: %s: [%a, %a] [%a, %a] at %a %a gives [%a, %a]\n", what, operation_.name,
                    c.a.interval.lo(), c.a.interval.hi(), c.b.interval.lo(), c.b.interval.hi(), x, y, c.ours.lo(),
                    c.ours.hi());
    }

    TestOperation operation_;
    Function function_;
    Draw& draw_;
    Tally tally_;
};

void print(const char* name, const Tally& t) {
    std::printf("%-14s %11ld %12ld %10ld %10ld %9ld %9ld %8.1f\n", name, t.operations, t.values, t.violations,
                t.undefined, t.hundred, t.seven_hundred, t.nanoseconds / static_cast<double>(t.operations));
    std::fflush(stdout);
}

int run(double count) {
    int kinds = 0;
    visit_everything([&](const TestOperation&, auto) { ++kinds; });
    std::printf("%-14s %11s %12s %10s %10s %9s %9s %8s\n", "operation", "operations", "values", "violations",
                "undefined", "by 100", "by 700", "ns");
    Draw draw;
    Tally all;
    visit_everything([&](const TestOperation& operation, auto function) {
        const Tally tally = Bench(operation, function, draw).run(std::lround(std::ceil(count / kinds)));
        print(operation.name, tally);
        all.add(tally);
    });
    print("all", all);
    return all.violations == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace achilles::cases

int main(int argc, char** argv) {
    const double count = argc > 1 ? std::atof(argv[1]) : 1e7;
    if (!(count >= 1.0 && count <= 1e15)) {
        std::fprintf(stderr, "usage: bench_interval [COUNT]\n");
        return 2;
    }
    try {
        return achilles::cases::run(count);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_interval: %s\n", error.what());
        return 2;
    }
}
