// Hostile arguments for Interval, and the table of all its operations. Shared by the unit test and the benchmark.
#pragma once

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <type_traits>
#include <vector>

#include "number/interval.hpp"

namespace achilles::cases {

template <unsigned Digits>
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<Digits>, boost::multiprecision::et_off>;
using Exact = Real<100>;

inline bool encloses(const Interval& interval, const Exact& x) {
    if (isinf(x)) return std::isinf(x > 0 ? interval.hi() : interval.lo());  // greater than any double
    const bool above = std::isinf(interval.lo()) || Exact(interval.lo()) <= x;
    const bool below = std::isinf(interval.hi()) || x <= Exact(interval.hi());
    return interval.is_defined() && above && below;
}

// Doubles that break naive rounding: powers of two and their neighbors, denormals, huge ones, neighbors of multiples of
// pi/2.
inline std::vector<double> hostile() {
    std::vector<double> list{0.0,
                             0x1p-1074,
                             0x3p-1074,
                             0x1p-1022,
                             0x1.fffffffffffffp-1023,
                             1e-300,
                             1e300,
                             std::numeric_limits<double>::max()};
    for (int k : {-1000, -60, -54, -53, -30, -27, -26, -1, 0, 1, 2, 10, 40, 52, 53, 500}) {
        const double x = std::ldexp(1.0, k);
        list.insert(list.end(), {x, std::nextafter(x, 0.0), std::nextafter(x, 2 * x), 0.75 * x});
    }
    for (int k : {1, 2, 3, 4, 5, 100, 12345, 1000001}) {
        const double x = k * 1.5707963267948966;
        list.insert(list.end(), {x, std::nextafter(x, 0.0), std::nextafter(x, 2 * x)});
    }
    const std::size_t half = list.size();
    for (std::size_t i = 0; i < half; ++i) list.push_back(-list[i]);
    return list;
}

// An interval and a double inside it.
struct Argument {
    Interval interval;
    double inside = 0.0;
};

struct Draw {
    std::mt19937_64 engine{20090611};
    std::vector<double> corners = hostile();

    double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine); }
    // Up to two doubles away from x.
    double nudged(double x) {
        const double direction = engine() % 2 == 0 ? -rounding::infinity : rounding::infinity;
        for (std::uint64_t steps = engine() % 3; steps != 0; --steps) x = std::nextafter(x, direction);
        return std::clamp(x, -rounding::largest, rounding::largest);
    }
    // Any size: hostile, near one, over many magnitudes, next to an extremum or a pole.
    double number() {
        switch (engine() % 5) {
            case 0:
                return corners[engine() % corners.size()];
            case 1:
                return uniform(-4.0, 4.0);
            case 2:
                return uniform(-1.0, 1.0) * std::exp2(uniform(-60.0, 60.0));
            case 3:
                return nudged(std::floor(uniform(-1.0, 1.0) * std::exp2(uniform(0.0, 42.0))) * 1.5707963267948966);
            default:
                return uniform(-1000.0, 1000.0);
        }
    }
    // A partner that makes x + y, x - y, x y or x/y hard to round: next to a power of two, half an ulp off, or
    // cancelling.
    double partner(double x) {
        int exponent = 0;
        std::frexp(x, &exponent);
        double y = number();
        switch (engine() % 8) {
            case 0:
                y = std::ldexp(uniform(-0.6, 0.6), exponent - 53);
                break;
            case 1:
                y = nudged(std::ldexp(1.0, static_cast<int>(engine() % 8) + exponent) / x);
                break;
            case 2:
                y = nudged(engine() % 2 == 0 ? x : -x);
                break;
            default:
                break;
        }
        return std::isfinite(y) ? y : 1.0;
    }
    // An interval around x: a point, a few ulps wide, wide, or unbounded.
    Argument around(double x) {
        const std::uint64_t kind = engine() % 32;
        if (kind == 0) return {Interval(x, rounding::infinity), x};
        if (kind == 1) return {Interval(-rounding::infinity, x), x};
        if (kind < 12) return {Interval(x), x};
        if (kind < 20)
            return {Interval(std::nextafter(x, -rounding::largest), std::nextafter(x, rounding::largest)), x};
        return {Interval(x - uniform(0.0, 2.0), x + uniform(0.0, 2.0)), x};
    }
};

// Where an operation is defined, as its Interval must know. Operations have two arguments; functions of one ignore the
// second.
enum class Domain { everywhere, not_negative, positive, unit, divisor, reciprocal, no_pole };

inline bool has_pole(const Interval& a) {
    if (mag(a) > rounding::largest) return true;
    const auto turn = [](double x) { return Exact(floor(Exact(x) / boost::math::constants::pi<Exact>() - 0.5)); };
    return mag(a) < 1e60 && turn(a.lo()) != turn(a.hi());  // beyond that, tan gives up at once
}
inline bool is_inside(Domain domain, const Interval& a, const Interval& b) {
    switch (domain) {
        case Domain::not_negative:
            return a.lo() >= 0.0;
        case Domain::positive:
            return a.lo() > 0.0;
        case Domain::unit:
            return a.lo() >= -1.0 && a.hi() <= 1.0;
        case Domain::divisor:
            return !b.contains(0.0);
        case Domain::reciprocal:
            return !a.contains(0.0);
        case Domain::no_pole:
            return !has_pole(a);
        default:
            return true;
    }
}
// Undefined is allowed within rounding of a pole, and where x^n underflows before its reciprocal is taken.
inline bool may_refuse(Domain domain) { return domain == Domain::no_pole || domain == Domain::reciprocal; }

struct TestOperation {
    const char* name;
    double low, high;  // most arguments are drawn from here, the others from anywhere
    Domain domain = Domain::everywhere;
    bool binary = false, trigonometric = false;
    bool selects = false;  // the value is 1 or plus or minus an argument: nothing is rounded
};

// x^n for any number type; Interval has its own function.
template <class Number>
Number raised(const Number& x, int n) {
    if constexpr (std::is_same_v<Number, Interval>) {
        return integer_power(x, n);
    } else {
        Number result = 1;
        for (int i = 0; i < std::abs(n); ++i) result = result * x;
        return n < 0 ? Number(1) / result : result;
    }
}

// Bounds on intervals as sets: mag is an upper bound of |x|, mig a lower one, and a hull contains both parts.
template <class Number, class Ours>
Number as_set(const Number& exact, Ours ours, const Number& x, const Number& y) {
    if constexpr (std::is_same_v<Number, Interval>) {
        return ours(x, y);
    } else {
        return exact;
    }
}

// Calls visit(operation, f) for each. f takes two numbers of one type: doubles, intervals or multiprecision.
template <class Visit>
void visit_arithmetic(Visit&& visit) {
    constexpr double all = 1e3;
    visit(TestOperation{"+", -all, all, Domain::everywhere, true}, [](const auto& x, const auto& y) { return x + y; });
    visit(TestOperation{"-", -all, all, Domain::everywhere, true}, [](const auto& x, const auto& y) { return x - y; });
    visit(TestOperation{"*", -all, all, Domain::everywhere, true}, [](const auto& x, const auto& y) { return x * y; });
    visit(TestOperation{"/", -all, all, Domain::divisor, true}, [](const auto& x, const auto& y) { return x / y; });
    visit(TestOperation{"negate", -all, all, Domain::everywhere, false, false, true},
          [](const auto& x, const auto&) { return -x; });
    visit(TestOperation{"square", -all, all}, [](const auto& x, const auto&) { return raised(x, 2); });
    visit(TestOperation{"abs", -all, all, Domain::everywhere, false, false, true}, [](const auto& x, const auto&) {
        using std::abs;
        return abs(x);
    });
    visit(TestOperation{"max", -all, all, Domain::everywhere, true, false, true}, [](const auto& x, const auto& y) {
        using std::max;
        return max(x, y);
    });
    const auto joined = [](const auto& x, const auto& y) { return hull(x, y); };
    visit(TestOperation{"hull, first", -all, all, Domain::everywhere, true, false, true},
          [=](const auto& x, const auto& y) { return as_set(x, joined, x, y); });
    visit(TestOperation{"hull, second", -all, all, Domain::everywhere, true, false, true},
          [=](const auto& x, const auto& y) { return as_set(y, joined, x, y); });
    const auto greatest = [](const auto& x, const auto&) { return Interval(-mag(x), mag(x)); };
    visit(TestOperation{"mag", -all, all, Domain::everywhere, false, false, true},
          [=](const auto& x, const auto& y) { return as_set(x, greatest, x, y); });
    const auto least = [](const auto& x, const auto&) { return Interval(mig(x), rounding::infinity); };
    visit(TestOperation{"mig", -all, all, Domain::everywhere, false, false, true}, [=](const auto& x, const auto& y) {
        using std::abs;
        return as_set(std::decay_t<decltype(x)>(abs(x)), least, x, y);
    });
}

template <int N, class Visit>
void visit_power(const char* name, Visit&& visit) {
    visit(TestOperation{name, -1e3, 1e3, N < 0 ? Domain::reciprocal : Domain::everywhere, false, false, N == 0},
          [](const auto& x, const auto&) { return raised(x, N); });
}

template <class Visit>
void visit_powers(Visit&& visit) {
    visit_power<-3>("power -3", visit);
    visit_power<-2>("power -2", visit);
    visit_power<-1>("power -1", visit);
    visit_power<0>("power 0", visit);
    visit_power<1>("power 1", visit);
    visit_power<3>("power 3", visit);
    visit_power<4>("power 4", visit);
    visit_power<7>("power 7", visit);
    visit(TestOperation{"pow", 1e-10, 1e3, Domain::positive, true}, [](const auto& x, const auto& y) {
        using std::pow;
        return pow(x, y);
    });
}

#define ACHILLES_CASE(function, ...)                                              \
    visit(TestOperation{#function, __VA_ARGS__}, [](const auto& x, const auto&) { \
        using std::function;                                                      \
        return static_cast<std::decay_t<decltype(x)>>(function(x));               \
    })

template <class Visit>
void visit_functions(Visit&& visit) {
    ACHILLES_CASE(sqrt, 0, 1e9, Domain::not_negative);
    ACHILLES_CASE(sin, -1e6, 1e6, Domain::everywhere, false, true);
    ACHILLES_CASE(cos, -1e6, 1e6, Domain::everywhere, false, true);
    ACHILLES_CASE(tan, -1e6, 1e6, Domain::no_pole, false, true);
    ACHILLES_CASE(asin, -1, 1, Domain::unit);
    ACHILLES_CASE(acos, -1, 1, Domain::unit);
    ACHILLES_CASE(atan, -1e6, 1e6);
    ACHILLES_CASE(sinh, -700, 700);
    ACHILLES_CASE(cosh, -700, 700);
    ACHILLES_CASE(tanh, -30, 30);
    ACHILLES_CASE(exp, -740, 700);
    ACHILLES_CASE(log, 1e-300, 1e9, Domain::positive);
}
#undef ACHILLES_CASE

template <class Visit>
void visit_everything(Visit&& visit) {
    visit_arithmetic(visit);
    visit_powers(visit);
    visit_functions(visit);
}

// Arguments for an operation: mostly in its domain, one in eight anywhere.
inline std::pair<Argument, Argument> arguments(Draw& draw, const TestOperation& operation) {
    double x = draw.number();
    const bool anywhere = draw.engine() % 8 == 0;
    for (int i = 0; i < 20 && !anywhere && !(x >= operation.low && x <= operation.high); ++i) {
        x = i % 2 == 0 ? std::abs(draw.number()) : std::ldexp(draw.number(), -8);
    }
    Argument a = draw.around(x);
    if (!anywhere && x >= operation.low && x <= operation.high) {
        const Interval inside(std::max(a.interval.lo(), operation.low), std::min(a.interval.hi(), operation.high));
        if (inside.contains(x)) a.interval = inside;
    }
    if (!operation.binary) return {a, Argument{Interval(1.0), 1.0}};
    return {a, draw.around(draw.partner(x))};
}

// |x - mid| <= rad holds for every x inside, and width >= hi - lo.
inline bool sizes_hold(const Interval& a, double x) {
    if (!(rad(a) < rounding::infinity)) return true;
    return abs(Exact(x) - Exact(mid(a))) <= Exact(rad(a)) && Exact(a.hi()) - Exact(a.lo()) <= Exact(width(a)) &&
           a.contains(mid(a));
}

}  // namespace achilles::cases
