#include <gtest/gtest.h>

#include <bit>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "expression/parse.hpp"
#include "number/angle.hpp"
#include "number/jet.hpp"
#include "program/program.hpp"

namespace achilles {
namespace {

// x, y, z in slots 0, 1, 2; z counts as a parameter.
class Expressions : public testing::Test {
 protected:
    Expressions() {
        scope.allowed = {
            {"x", graph.symbol(0)}, {"y", graph.symbol(1)}, {"x'", graph.symbol(1)}, {"z", graph.symbol(2)}};
        scope.forbidden = {{"w", "'w' may not stand here"}};
    }
    Expression read(std::string_view text) { return parse(text, scope, graph); }
    double value(Expression e, double x = 0.0, double y = 0.0, double z = 0.0) {
        const Program program(std::span(&e, 1), Slots{3, 2, 3});
        Evaluator<double> run(program);
        run.input(0) = x;
        run.input(1) = y;
        run.input(2) = z;
        run.fix();
        run.run();
        return run.output(0);
    }
    double value(std::string_view text, double x = 0.0, double y = 0.0, double z = 0.0) {
        return value(read(text), x, y, z);
    }
    std::string error(std::string_view text) {
        try {
            read(text);
        } catch (const ParseError& problem) {
            return std::to_string(problem.offset) + ": " + problem.what();
        }
        return "no error";
    }
    Graph graph;
    Scope scope;
    std::vector<std::string> names{"x", "y", "z"};
};

TEST_F(Expressions, PowersOfOneBaseAreOnePower) {
    EXPECT_EQ(read("x^5/x^2"), read("x^3"));
    EXPECT_EQ(read("x^2/x^5"), read("x^-3"));
    EXPECT_EQ(read("x^2*x^5"), read("x^7"));
    EXPECT_EQ(power(read("x") - read("x") * read("2"), 3), read("-x^3"));
    EXPECT_EQ(value("(-x)^3", 2), -8);
    EXPECT_EQ(value("(-x)^4", 2), 16);
    EXPECT_EQ(value("(-sin(x))^3", 1), -std::pow(std::sin(1.0), 3));
    EXPECT_EQ(value("x^5/x^2", 2), 8);
    EXPECT_EQ(value("sin(x)^5/sin(x)^2", 1), std::pow(std::sin(1.0), 2) * std::sin(1.0));
}

TEST_F(Expressions, WithoutNamesAreNumbers) {
    EXPECT_EQ(value_of_constant(read("3 - pi")), 3.0 - std::numbers::pi);
    EXPECT_EQ(value_of_constant(read("pi/4 - sqrt(2)")), std::numbers::pi / 4.0 - std::sqrt(2.0));
    EXPECT_NEAR(value("x^(4 - pi)", 2), std::pow(2.0, 4.0 - std::numbers::pi), 1e-15);
    EXPECT_NE(error("(3 - pi)^x"), "no error");  // negative base
    EXPECT_EQ(error("(pi - 3)^x"), "no error");
}

TEST_F(Expressions, PrecedenceIsThatOfMathematics) {
    EXPECT_EQ(value("-x^2", 3), -9);
    EXPECT_EQ(value("2^3^2"), 512);
    EXPECT_EQ(value("2^-1"), 0.5);
    EXPECT_EQ(value("x^-2", 2), 0.25);
    EXPECT_EQ(value("1 - 2 - 3"), -4);
    EXPECT_EQ(value("8/4/2"), 1);
    EXPECT_EQ(value("2*x^2/4", 3), 4.5);
    EXPECT_EQ(value("-2*-3"), 6);
    EXPECT_EQ(value("2--3"), 5);
    EXPECT_EQ(value("x' + x", 1, 10), 11);
    EXPECT_DOUBLE_EQ(value("x^(1/3)", 8), 2);
    EXPECT_DOUBLE_EQ(value("2^x", 0.5), std::sqrt(2));
    EXPECT_DOUBLE_EQ(value("x^pi", 2), std::pow(2, std::acos(-1)));
    EXPECT_EQ(value("1e-3"), 1e-3);
    EXPECT_EQ(value("1.5E2 + .5"), 150.5);
}

TEST_F(Expressions, ConstantsAreExactUntilEvaluation) {
    EXPECT_EQ(read("0.1 + 0.2"), read("0.3"));
    EXPECT_EQ(read("1/3 + 1/3 + 1/3"), read("1"));
    EXPECT_EQ(read("1e400/1e400"), read("1"));
    EXPECT_EQ(value("0.1"), 0.1);
    const Constant tenth = graph.constant(read("0.1").id());
    EXPECT_LT(tenth.low, tenth.high);
    EXPECT_EQ(std::nextafter(tenth.low, 1.0), tenth.high);
    const Constant half = graph.constant(read("0.5").id());
    EXPECT_EQ(half.low, half.high);
}

// Numerators and denominators on both sides of 2^53, where the division algorithm changes.
TEST_F(Expressions, AConstantIsEnclosedByNeighbors) {
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 2000; ++trial) {
        const auto draw = [&] { return static_cast<long>(random() >> (1 + random() % 62)); };
        const long p = trial % 2 == 0 ? draw() : -draw(), q = draw() + 1;
        const Constant c = graph.constant(graph.number(p, q).id());
        using Number = boost::multiprecision::cpp_bin_float_100;  // exact where the quotient is a double
        const Number exact = Number(p) / q, low = c.low, high = c.high, nearest = c.nearest;
        EXPECT_TRUE(low <= exact && exact <= high) << p << "/" << q;
        EXPECT_EQ(c.high, low == exact ? c.low : std::nextafter(c.low, 1e300)) << p << "/" << q;
        EXPECT_TRUE(c.nearest == c.low || c.nearest == c.high);
        EXPECT_TRUE(2 * Number(abs(exact - nearest)) <= high - low) << p << "/" << q;
    }
}

TEST_F(Expressions, EqualExpressionsAreOneNode) {
    EXPECT_EQ(read("x*y + sin(x)"), read("sin(x) + y*x"));
    EXPECT_EQ(read("x - x"), read("0"));
    EXPECT_EQ(read("x + x"), read("2*x"));
    EXPECT_EQ(read("x*x*x"), read("x^3"));
    EXPECT_EQ(read("sin(-x)"), read("-sin(x)"));
    EXPECT_EQ(read("cos(-x)"), read("cos(x)"));
    EXPECT_EQ(read("(-x)*(-y)"), read("x*y"));
    EXPECT_EQ(read("x/x"), read("1"));
    EXPECT_EQ(read("2*x/4"), read("x/2"));
    EXPECT_EQ(read("sqrt(x)*sqrt(x)"), read("x"));
    EXPECT_EQ(read("(x^2)^3"), read("x^6"));
}

TEST_F(Expressions, PrintedTextReadsBackAsTheSameNode) {
    for (const char* text : {"x - (y - z)", "-(x + y)^2", "x/(y*z)", "x/y*z", "2^x", "(x^2)^(1/3)", "x - -y", "-x*y",
                             "x^-3", "sin(x)^2/3 - 4/(x + 1)", "(-2)*x", "3/7*x*(y - 5/2)", "pi*x", "1 - x"}) {
        const Expression e = read(text);
        EXPECT_EQ(read(to_text(e, names)), e) << text << " printed as " << to_text(e, names);
    }
}

TEST_F(Expressions, ErrorsNameThePlaceAndTheLikelyWord) {
    EXPECT_EQ(error("x + yy"), "4: unknown name 'yy'; did you mean 'y'?");
    EXPECT_EQ(error("x +"), "3: the expression ends where a value is expected");
    EXPECT_EQ(error(""), "0: an expression is missing");
    EXPECT_EQ(error("(x"), "0: this '(' is never closed");
    EXPECT_EQ(error("x)"), "1: this ')' has no matching '('");
    EXPECT_EQ(error("2x"), "1: an operator is missing here; write '*' for a product");
    EXPECT_EQ(error("abs(x)"),
              "0: 'abs' is not allowed: it is not smooth, and the equations of motion need derivatives");
    EXPECT_EQ(error("sin x"), "0: the function 'sin' needs parentheses: sin(...)");
    EXPECT_EQ(error("sni(x)"), "0: unknown function 'sni'; did you mean 'sin'?");
    EXPECT_EQ(
        error("square(x)"),
        "0: unknown function 'square'; the functions are sqrt, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, "
        "exp, log");
    EXPECT_EQ(error("x[1]"), "1: unexpected '['; coordinates have no index");
    EXPECT_EQ(error("ln(x)"), "0: unknown function 'ln'");
    EXPECT_EQ(error("x(2)"), "0: 'x' is not a function; write '*' for a product");
    EXPECT_EQ(error("x^y"), "1: the exponent of '^' must be a number, or its base a positive number");
    EXPECT_EQ(error("x**2"), "1: unknown operator '**'; write '^' for a power");
    EXPECT_EQ(error("x/0"), "1: division by zero");
    EXPECT_EQ(error("w"), "0: 'w' may not stand here");
    EXPECT_EQ(error("1e999"), "0: this number is out of range: it has an exponent beyond 400");
    EXPECT_EQ(error("x # y"), "2: unexpected '#'");
    EXPECT_EQ(error("\xCE\xB8"), "0: names have Latin letters: write theta for '\xCE\xB8'");
    EXPECT_EQ(error("sin(x, y)"), "5: the function 'sin' takes one argument");
    EXPECT_EQ(error(std::string(100000, '(')).substr(0, 28), "200: nested more than 200 le");
}

TEST_F(Expressions, TowersOfPowersEndAtOnce) {
    EXPECT_EQ(value("(2^10)^3"), 1073741824.0);
    EXPECT_TRUE(std::isinf(value("((((2^64)^64)^64)^64)")));
    EXPECT_EQ(value("((((0.5^64)^64)^64)^64)"), 0.0);
}

TEST_F(Expressions, HugeNumbersEndAtOnce) {
    EXPECT_EQ(error("1 + 1e999999"), "4: this number is out of range: it has an exponent beyond 400");
    EXPECT_EQ(error("1e" + std::string(1000000, '9')),
              "0: this number is out of range: it has a number with more than 400 characters");
    EXPECT_EQ(error(std::string(1000000, '7')),
              "0: this number is out of range: it has a number with more than 400 characters");
    EXPECT_TRUE(std::isinf(value("10^10^10")));
    EXPECT_EQ(value("(1/10)^10^10"), 0.0);
    EXPECT_EQ(value("x^10^10", 0.5), 0.0);
    EXPECT_EQ(value("x^999999999999999999999", 0.5), 0.0);
    EXPECT_EQ(value("x^-2147483648", 1.0), 1.0);
}

TEST_F(Expressions, MidpointsAreNumbersWithoutDerivativesAndWidth) {
    const Expression x = graph.symbol(0), m = midpoint(x * graph.symbol(1));
    EXPECT_EQ(value(m, 3.0, 5.0), 15.0);
    EXPECT_TRUE(derivative(m, 0).is_zero());
    EXPECT_EQ(derivative(m * x, 0), m);
    EXPECT_EQ(midpoint(graph.number(2)), graph.number(2));
    EXPECT_EQ(substitute(m, std::vector<std::uint32_t>{0}, std::vector<Expression>{graph.number(1)}),
              midpoint(graph.symbol(1)));
    EXPECT_EQ(to_text(m, std::vector<std::string>{"x", "y"}), "x*y");
    EXPECT_EQ(value_of_constant(midpoint(graph.pi())), std::numbers::pi);
    const Program program(std::span(&m, 1), Slots{3, 2, 3});
    Evaluator<Interval> enclosure(program);
    enclosure.input(0) = Interval(2.0, 4.0);
    enclosure.input(1) = Interval(5.0);
    enclosure.run();
    EXPECT_EQ(enclosure.output(0).lo(), 15.0);
    EXPECT_EQ(enclosure.output(0).hi(), 15.0);
    using Directed = Jet<Interval, 1>;
    Evaluator<Directed> directed(program);
    directed.input(0) = Directed::variable(Interval(2.0, 4.0), 0);
    directed.input(1) = Directed(5.0);
    directed.run();
    EXPECT_EQ(directed.output(0).value.lo(), 15.0);
    EXPECT_EQ(directed.output(0).slope[0].hi(), 0.0);
}

// Exact arithmetic on fractions without common factors doubles their length, so it must be bounded.
TEST_F(Expressions, SizesHaveStatedLimits) {
    std::string fractions = "1/3";
    for (int i = 2; i < 20000; ++i) fractions += " + 1/" + std::to_string(2 * i + 1);
    const auto reason = [&](const std::string& text) {
        const std::string told = error(text);
        return told.substr(told.find(':'));
    };
    EXPECT_EQ(reason(fractions), ": this expression is too large: an exact number has more than 16384 bits");
    Graph large;
    Expression nested = large.symbol(0);
    try {
        for (int i = 0; i < 7000000; ++i) nested = apply(Operation::sin, nested);
        ADD_FAILURE() << "no limit";
    } catch (const ExpressionTooLarge& problem) {
        EXPECT_STREQ(problem.what(), "more than 6000000 operations");
    }
    std::string digits = "0";  // each within the limit of 1300 bits
    for (int i = 0; i < 60000; ++i) digits += " + " + std::string(i % 2 == 0 ? "1e400" : "1/3e400");
    Graph fresh;
    EXPECT_THROW(parse(digits, Scope{}, fresh), ParseError);
}

TEST_F(Expressions, LongSumsNeedNoDeepStack) {
    std::string text = "x";
    for (int i = 0; i < 20000; ++i) text += " + sin(x + " + std::to_string(i) + ")";
    const Expression e = read(text);
    EXPECT_NEAR(value(derivative(e, 0), 0.3), (value(e, 0.3 + 1e-6) - value(e, 0.3 - 1e-6)) / 2e-6, 1e-5);
}

TEST_F(Expressions, DerivativesAgreeWithFiniteDifferences) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.2, 0.9);
    for (const char* text : {"x*y", "x/y", "x^5", "x^-2", "x^(1/3)", "2^x", "sqrt(x)", "sin(x*y)", "cos(x)/y", "tan(x)",
                             "asin(x)", "acos(x)", "atan(x/y)", "sinh(x)", "cosh(x)", "tanh(x)", "exp(x*y)",
                             "log(x + y)", "sin(x)^2*cos(y)^3/(1 + x^2*y)"}) {
        const Expression e = read(text);
        for (int trial = 0; trial < 20; ++trial) {
            const double x = uniform(random), y = uniform(random), d = 1e-5;
            const std::vector<std::uint32_t> slots{0, 1};
            const auto both = gradient(e, slots);
            EXPECT_NEAR(value(both[0], x, y), (value(e, x + d, y) - value(e, x - d, y)) / (2 * d),
                        1e-8 * std::max(10.0, std::abs(value(both[0], x, y))))
                << text;
            EXPECT_NEAR(value(both[1], x, y), (value(e, x, y + d) - value(e, x, y - d)) / (2 * d),
                        1e-8 * std::max(10.0, std::abs(value(both[1], x, y))))
                << text;
        }
    }
}

TEST_F(Expressions, SubstitutionReplacesSymbols) {
    const std::vector<std::uint32_t> slots{0};
    const std::vector<Expression> values{read("y + 1")};
    EXPECT_EQ(substitute(read("x^2 + z"), slots, values), read("(y + 1)^2 + z"));
    EXPECT_EQ(substitute(read("y*z"), slots, values), read("y*z"));
    EXPECT_TRUE(depends_on(read("x + z"), slots));
    EXPECT_FALSE(depends_on(read("y + z"), slots));
}

TEST_F(Expressions, AProgramEvaluatesTheParametersOnceAndIntervalsEnclose) {
    const Expression e = read("sin(z)*x + exp(z)");
    const Program program(std::span(&e, 1), Slots{3, 2, 3});
    EXPECT_EQ(program.size(), 4u);  // sin, exp, *, +
    Evaluator<Interval> run(program);
    run.input(0) = Interval(0.1, 0.2);
    run.input(2) = Interval(0.5);
    run.fix();
    run.run();
    EXPECT_LE(run.output(0).lo(), std::sin(0.5) * 0.1 + std::exp(0.5));
    EXPECT_GE(run.output(0).hi(), std::sin(0.5) * 0.2 + std::exp(0.5));
    EXPECT_LT(run.output(0).hi() - run.output(0).lo(), 0.0480);
}

// Bit-identical to the math library, at the first evaluation and at later ones.
TEST(SineCosine, AreThoseOfTheLibrary) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-330.0, 300.0), angle(-10.0, 10.0);
    std::vector<double> angles{0.0, -0.0, 1e308, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()};
    for (int i = 0; i < 20000; ++i)
        angles.push_back(i % 2 == 0 ? angle(random) : angle(random) * std::pow(10.0, exponent(random)));
    const auto expect_bits = [](double a, double b, double at) {
        EXPECT_TRUE((std::isnan(a) && std::isnan(b)) ||
                    std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b))
            << a << ", " << b << " at " << at;
    };
    for (std::size_t i = 0; i < angles.size(); ++i) {
        for (const double x : {angles[i], angles[i - i % 3], angles[i]}) {
            const SineCosine value = sine_and_cosine(x);
            volatile double alone = x;  // keeps the compiler from computing both at once
            expect_bits(value.sine, std::sin(alone), x);
            expect_bits(value.cosine, std::cos(alone), x);
        }
    }
}

// Machine code gives the same bits as the loop: more operations than registers, every function, odd powers.
TEST(Program, GivesTheSameBitsAsMachineCode) {
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}, {"y", graph.symbol(1)}, {"p", graph.symbol(2)}};
    std::vector<Expression> outputs;
    for (const char* text : {"x + y",
                             "x - y",
                             "x*y",
                             "x/y",
                             "-x",
                             "-(x*y)",
                             "x^7",
                             "x^(-3)",
                             "2^x",
                             "y^pi",
                             "sqrt(y)",
                             "sin(x)",
                             "cos(x)",
                             "tan(x)",
                             "asin(x)",
                             "acos(x)",
                             "atan(x)",
                             "sinh(x)",
                             "cosh(x)",
                             "tanh(x)",
                             "exp(x)",
                             "log(y)",
                             "p*x + sin(p)*y",
                             "(x + y)*(x - y)/(1 + x^2) - sqrt(x^2 + y^2)*cos(x*y)",
                             "log(x - 2)"})
        outputs.push_back(parse(text, scope, graph));
    for (int k = 1; k < 40; ++k) outputs.push_back(outputs[outputs.size() - 20] * outputs[2] - outputs.back());
    const Program program(outputs, Slots{3, 2, 3});
    Evaluator<double> code(program), loop(program);
    for (const double x : {0.3, -0.7, 0.0, -0.0, 1e-310, 1.0, 1e200}) {
        for (Evaluator<double>* one : {&code, &loop}) {
            one->input(0) = x;
            one->input(1) = 1.7;
            one->input(2) = 0.4;
            one->fix();
        }
        code.run();
        loop.run_by_loop();
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            const double a = code.output(i), b = loop.output(i);
            EXPECT_TRUE(std::isnan(a) ? std::isnan(b)
                                      : std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b))
                << i << " at " << x << ": " << a << ", " << b;
        }
    }
}

}  // namespace
}  // namespace achilles
