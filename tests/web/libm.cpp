// Measures the math library against the bounds that proofs assume (core/number/interval.hpp): prints the largest error
// of each function over many arguments, in ulps, and fails if one exceeds its bound. For the library of a page, which
// is not that of the native program.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "number/interval.hpp"

namespace {

// 256 bits, far more than a double needs; sines of large arguments lose 64 of them.
using Exact =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<256, boost::multiprecision::digit_base_2>>;

// In units of the last place of the result.
double error_of(double computed, const Exact& exact) {
    const double nearest = exact.convert_to<double>();
    const double size = std::abs(nearest);
    const double ulp = std::nextafter(size, INFINITY) - size;
    return boost::multiprecision::abs(Exact(computed) - exact).convert_to<double>() / ulp;
}

struct Function {
    const char* name;
    double (*computed)(double);
    Exact (*exact)(const Exact&);
    double low, high;  // of the arguments or, if is_logarithmic, of their sizes
    bool is_logarithmic;
    int bound;  // ulps
};

#define ACHILLES_FUNCTION(name, low, high, is_logarithmic, bound)                                                   \
    {                                                                                                               \
#name, [](double x) { return std::name(x); }, [](const Exact& x) -> Exact { return name(x); }, low, high,   \
                                                                                                    is_logarithmic, \
                                                                                                    bound           \
    }

using achilles::rounding::hyperbolic;
using achilles::rounding::libm;

const Function functions[] = {
    ACHILLES_FUNCTION(sin, 1e-3, 1e9, true, libm),          ACHILLES_FUNCTION(cos, 1e-3, 1e9, true, libm),
    ACHILLES_FUNCTION(tan, 1e-3, 1e9, true, libm),          ACHILLES_FUNCTION(asin, -1.0, 1.0, false, libm),
    ACHILLES_FUNCTION(acos, -1.0, 1.0, false, libm),        ACHILLES_FUNCTION(atan, 1e-3, 1e6, true, libm),
    ACHILLES_FUNCTION(exp, -700.0, 700.0, false, libm),     ACHILLES_FUNCTION(exp, -1.0, 1.0, false, libm),
    ACHILLES_FUNCTION(log, 1e-300, 1e300, true, libm),      ACHILLES_FUNCTION(log, 0.5, 2.0, false, libm),
    ACHILLES_FUNCTION(sinh, 1e-3, 700.0, true, hyperbolic), ACHILLES_FUNCTION(cosh, 1e-3, 700.0, true, hyperbolic),
    ACHILLES_FUNCTION(tanh, 1e-3, 30.0, true, hyperbolic)};

}  // namespace

int main(int count, char** words) {
    const int samples = count > 1 ? std::atoi(words[1]) : 2000;
    std::mt19937_64 random(1);
    const auto share = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    bool holds = true;
    const auto report = [&holds](const char* name, double low, double high, double worst, int bound) {
        std::printf("%-5s %8g to %8g  %.3f ulp, allowed %d\n", name, low, high, worst, bound);
        holds = holds && worst <= bound;
    };
    for (const Function& function : functions) {
        double worst = 0.0;
        for (int i = 0; i < samples; ++i) {
            double x = function.low + share() * (function.high - function.low);
            if (function.is_logarithmic) {
                const double from = std::log(function.low), to = std::log(function.high);
                x = std::exp(from + share() * (to - from));
            }
            worst = std::max(worst, error_of(function.computed(x), function.exact(Exact(x))));
        }
        report(function.name, function.low, function.high, worst, function.bound);
    }
    double worst = 0.0;
    for (int i = 0; i < samples; ++i) {
        const double x = std::exp(10.0 * share() - 5.0), y = 20.0 * share() - 10.0;
        worst = std::max(worst, error_of(std::pow(x, y), pow(Exact(x), Exact(y))));
    }
    report("pow", std::exp(-5.0), std::exp(5.0), worst, libm);
    return holds ? 0 : 1;
}
