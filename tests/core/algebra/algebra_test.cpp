// Simplification: greatest common divisors, quotients of polynomials, factors, proofs of positivity, and printed forms.
#include "algebra/algebra.hpp"

#include <gtest/gtest.h>

#include <random>

#include "algebra/vanishes.hpp"
#include "algebra/writer.hpp"
#include "expression/parse.hpp"

namespace achilles {
namespace {

Multinomial x() { return Multinomial::atom(0); }
Multinomial y() { return Multinomial::atom(1); }
Multinomial n(long value) { return Multinomial(value); }

// Up to five terms of degree <= 2 in each of three atoms, with coefficients up to 5.
Multinomial random_polynomial(std::mt19937& random) {
    std::vector<Multinomial::Term> terms;
    for (unsigned i = 0; i < 1 + random() % 5; ++i) {
        Multinomial::Term term{{}, static_cast<long>(random() % 11) - 5};
        for (std::size_t atom = 0; atom < 3; ++atom) term.powers[atom] = static_cast<std::uint8_t>(random() % 3);
        terms.push_back(term);
    }
    return Multinomial(terms);
}

TEST(Multinomial, KeepsNoTermTwiceAndNoZero) {
    Work work{1000};
    EXPECT_TRUE((x() - x()).is_zero());
    EXPECT_EQ((x() + x()).terms().size(), 1u);
    EXPECT_EQ(times(x() + y(), x() - y(), work), power(x(), 2, work) - power(y(), 2, work));
    EXPECT_EQ(derivative(power(x() + y(), 3, work), 0), times(n(3), power(x() + y(), 2, work), work));
    EXPECT_FALSE(divide(x(), n(2), work));
    EXPECT_FALSE(divide(power(x(), 2, work) + n(1), x() + n(1), work));
}

// Sums and multiples keep their terms in order without sorting them.
TEST(Multinomial, SumsAndMultiplesAreThoseOfAllTerms) {
    std::mt19937 random(11);
    for (int trial = 0; trial < 200; ++trial) {
        const Multinomial a = random_polynomial(random), b = random_polynomial(random);
        std::vector<Multinomial::Term> sum = a.terms(), difference = a.terms(), multiple;
        for (Multinomial::Term term : b.terms()) {
            sum.push_back(term);
            term.coefficient = -term.coefficient;
            difference.push_back(term);
        }
        Multinomial::Term factor{{}, -3};
        factor.powers[1] = 2;
        for (Multinomial::Term term : a.terms()) {
            term.powers[1] = static_cast<std::uint8_t>(term.powers[1] + 2);
            term.coefficient *= -3;
            multiple.push_back(term);
        }
        ASSERT_EQ(a + b, Multinomial(sum)) << trial;
        ASSERT_EQ(a - b, Multinomial(difference)) << trial;
        ASSERT_EQ(times(a, factor), Multinomial(multiple)) << trial;
    }
}

TEST(Multinomial, PowersHaveALimit) {
    Multinomial::Term high{{}, 1};
    high.powers[47] = 250;
    const Multinomial a(std::vector{high});
    high.powers[47] = 5;
    EXPECT_EQ(times(a, high).degree(47), 255);
    high.powers[47] = 6;
    EXPECT_THROW(times(a, high), SimplificationLimit);
}

TEST(Multinomial, DivisorsHoldBothAndNothingIsLeftInCommon) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 500; ++trial) {
        Work work{10000000};
        const Multinomial a = random_polynomial(random), b = random_polynomial(random), c = random_polynomial(random);
        if (a.is_zero() || b.is_zero() || c.is_zero()) continue;
        const Multinomial left = times(a, c, work), right = times(b, c, work), divisor = gcd(left, right, work);
        ASSERT_TRUE(divide(divisor, c, work) || divide(divisor, -c, work)) << trial;
        const Multinomial p = quotient(left, divisor, work), q = quotient(right, divisor, work);
        ASSERT_TRUE(gcd(p, q, work).is_one()) << trial;
        ASSERT_EQ(gcd(right, left, work), divisor);
    }
}

TEST(Multinomial, WorkHasALimit) {
    Work work{100};
    Multinomial sum;
    for (std::size_t i = 0; i < 20; ++i) sum = sum + Multinomial::atom(i);
    EXPECT_THROW(power(sum, 2, work), SimplificationLimit);
}

// a, b, x, y are slots 0 .. 3; the first two are positive.
class Simplification : public testing::Test {
 protected:
    Simplification() {
        for (std::uint32_t i = 0; i < names.size(); ++i) scope.allowed.emplace(names[i], graph.symbol(i));
    }
    Fraction read(std::string_view text) { return algebra.simplify(parse(text, scope, graph)); }
    AlgebraWriter writer(Notation notation) { return {algebra, names, ranks, notation}; }
    std::string simple(std::string_view text, Notation notation = Notation::text) {
        const Fraction fraction = read(text);
        return writer(notation).write(fraction, algebra).text;
    }
    bool positive(std::string_view text) {
        const Fraction fraction = read(text);
        Positivity positivity(algebra, [&](Expression e) {
            return e == graph.symbol(0) || e == graph.symbol(1) ? Sign::positive : Sign::unknown;
        });
        return positivity.is_positive(fraction.numerator) && positivity.is_positive(fraction.denominator);
    }
    Graph graph;
    Scope scope;
    Algebra algebra{graph, Work{1000000}};
    std::vector<std::string> names{"a", "b", "x", "y", "x'"};
    std::vector<int> ranks{0, 0, 1, 1, 2};
};

TEST_F(Simplification, CancelsWhatIsCommon) {
    EXPECT_EQ(simple("(x^2 - y^2)/(x - y)"), "x + y");
    EXPECT_EQ(simple("a*x/(a*b*x + a*x*y)"), "1/(b + y)");
    EXPECT_EQ(simple("1/x + 1/y - (x + y)/(x*y)"), "0");
    EXPECT_EQ(simple("x/(x + 1/(x + 1/x))"), "(x^2 + 1)/(x^2 + 2)");
    EXPECT_EQ(simple("(6*a*x + 4*b*x)/(10*x^2)"), "(3*a + 2*b)/(5*x)");
}

TEST_F(Simplification, KnowsWhatSquaresOfFunctionsAre) {
    EXPECT_EQ(simple("sin(x)^2 + cos(x)^2"), "1");
    EXPECT_EQ(simple("(1 - cos(x)^2)/sin(x)"), "sin(x)");
    EXPECT_EQ(simple("cosh(x)^2 - sinh(x)^2"), "1");
    EXPECT_EQ(simple("tan(x)*cos(x)"), "sin(x)");
    EXPECT_EQ(simple("sqrt(x + y)^3/(x + y)"), "sqrt(x + y)");
    EXPECT_EQ(simple("sin(x - y) + sin(y - x)"), "0");
    EXPECT_EQ(simple("cos(a*(x + y)) - cos(a*x + a*y)"), "0");
}

TEST_F(Simplification, ExpandsAnglesWhereAsked) {
    Algebra expanding(graph, Work{1000000}, true);
    const auto zero = [&](const char* text) { return expanding.simplify(parse(text, scope, graph)).is_zero(); };
    EXPECT_TRUE(zero("sin(x + y) - sin(x)*cos(y) - cos(x)*sin(y)"));
    EXPECT_TRUE(zero("cos(x - y) - cos(x)*cos(y) - sin(x)*sin(y)"));
    EXPECT_FALSE(zero("cos(x - y) - cos(x)*cos(y) + sin(x)*sin(y)"));
}

TEST_F(Simplification, DivisionByZeroIsRefused) {
    EXPECT_THROW(read("1/(sin(x)^2 + cos(x)^2 - 1)"), std::domain_error);
}

TEST_F(Simplification, ProvesWhatIsPositive) {
    EXPECT_TRUE(positive("a + b"));
    EXPECT_TRUE(positive("a + x^2"));
    EXPECT_TRUE(positive("1 + cos(x)^2"));
    EXPECT_TRUE(positive("4*a + 12*b - 9*b*cos(x)^2"));
    EXPECT_TRUE(positive("a*x^2 + b - b*sin(y)/2"));
    EXPECT_TRUE(positive("exp(x) + sqrt(x)"));
    EXPECT_FALSE(positive("a - b"));
    EXPECT_FALSE(positive("x"));
    EXPECT_FALSE(positive("x^2"));
    EXPECT_FALSE(positive("a + x"));
    EXPECT_FALSE(positive("b - b*cos(x)^2"));
    EXPECT_FALSE(positive("4*a + 8*b - 9*b*cos(x)^2"));
    EXPECT_FALSE(positive("1 + a - 2*cos(x)"));
}

TEST_F(Simplification, WritesAsAPersonWould) {
    EXPECT_EQ(simple("x'*sin(x)*x' - a"), "x'^2*sin(x) - a");
    EXPECT_EQ(simple("-a + b"), "b - a");
    EXPECT_EQ(simple("a - a*cos(x)^2 + y*sin(x)"), "a*sin(x)^2 + y*sin(x)");
    EXPECT_EQ(simple("a*cos(x*b/2)"), "a*cos(b*x/2)");
    EXPECT_EQ(simple("y*x/2*3*b*a"), "3*a*b*x*y/2");
    EXPECT_EQ(simple("a*(x + 2*y) + b*y"), "a*(x + 2*y) + b*y");
    EXPECT_EQ(simple("-a/2 - b/2"), "-(a + b)/2");
    EXPECT_EQ(simple("a/(2*b)"), "a/(2*b)");
    EXPECT_EQ(simple("(x + y)^2/(a + b)^3/7"), "(x + y)^2/(7*(a + b)^3)");
}

TEST_F(Simplification, WritesLatex) {
    EXPECT_EQ(simple("x'^2*sin(x)^2 - a/3", Notation::latex), "\\dot{x}^{2} \\sin^{2} x - \\tfrac{1}{3} a");
    EXPECT_EQ(simple("sqrt(x + y)/(2*b)", Notation::latex), "\\frac{\\sqrt{x + y}}{2 b}");
    const auto name = [](const char* plain) { return write_name(plain, Notation::latex).text; };
    EXPECT_EQ(name("theta1"), "\\theta_{1}");
    EXPECT_EQ(name("theta1'"), "\\dot{\\theta}_{1}");
    EXPECT_EQ(name("L12"), "L_{12}");
    EXPECT_EQ(name("m_foot2"), "m_{\\mathit{foot},2}");
    EXPECT_EQ(name("rest"), "\\mathit{rest}");
}

TEST_F(Simplification, TellsWhatIsZeroHoweverItIsWritten) {
    const auto zero = [&](const std::string& text) { return vanishes(parse(text, scope, graph)); };
    EXPECT_TRUE(zero("0"));
    EXPECT_TRUE(zero("a*x/x - a*y/y"));
    EXPECT_TRUE(zero("sin(x)^2 + cos(x)^2 - 1"));
    EXPECT_FALSE(zero("a*x/x - b*y/y"));
}

TEST_F(Simplification, TellsWhatIsZeroWhereOthersAre) {
    const auto parsed = [&](const std::string& text) { return parse(text, scope, graph); };
    const std::uint32_t unknowns[] = {2, 3};  // x, y
    const auto zero = [&](const std::string& text, const std::vector<std::string>& where) {
        std::vector<Expression> zeros;
        for (const std::string& one : where) zeros.push_back(parsed(one));
        return vanishes_where(parsed(text), zeros, unknowns);
    };
    EXPECT_TRUE(zero("a*x", {"3*x"}));
    EXPECT_TRUE(zero("sin(x - a)*y", {"2*x - 2*a"}));
    EXPECT_TRUE(zero("a*(x - sin(y))^2", {"x - sin(y)"}));
    EXPECT_TRUE(zero("x*y - 2", {"x - y - 1", "y - 1"}));
    EXPECT_TRUE(zero("a*sqrt(x^2 + y^2) - 2*a", {"sqrt(x^2 + y^2)/2 - 1"}));
    EXPECT_FALSE(zero("a*x", {"y"}));
    EXPECT_FALSE(zero("a*x + b", {"x"}));
    EXPECT_FALSE(zero("y*(x - 1)", {"y*(x - a)"}));  // y = 0 is excluded
    EXPECT_FALSE(zero("x - a", {"a*x - a^2"}));      // a may be 0
    EXPECT_FALSE(zero("y - a", {"x + sin(x) - y"}));
    EXPECT_FALSE(zero("x - sin(y)", {"x + sin(x) - 2*sin(y)"}));
}

}  // namespace
}  // namespace achilles
