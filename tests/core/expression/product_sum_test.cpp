// Sums of products: what they write, and that it has the value of the expression.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "expression/parse.hpp"
#include "expression/product_sum.hpp"

namespace achilles {
namespace {

class ProductSums : public testing::Test {
 protected:
    ProductSums() {
        using Rank = ProductSumWriter::Rank;
        const char* const slot_names[] = {"x", "y", "x'", "y'", "m", "L", "t"};
        const Rank ranks[] = {Rank::state,    Rank::state,    Rank::rate, Rank::rate,
                              Rank::constant, Rank::constant, Rank::state};
        for (std::uint32_t i = 0; i < 7; ++i) scope_.allowed.emplace(slot_names[i], graph_.symbol(i));
        writer_ = std::make_unique<ProductSumWriter>(
            graph_, std::vector<std::string>{std::begin(slot_names), std::end(slot_names)},
            std::vector<Rank>{std::begin(ranks), std::end(ranks)});
    }
    ProductSum sum(const std::string& text) { return ProductSum::from(parse(text, scope_, graph_)); }
    std::string written(const std::string& text) { return writer_->text(sum(text)); }
    double value(const std::string& text, const std::vector<double>& values) {
        return value_of(parse(text, scope_, graph_), values);
    }

    Graph graph_;
    Scope scope_;
    std::unique_ptr<ProductSumWriter> writer_;
};

TEST_F(ProductSums, AreWrittenWithoutOnesZerosAndDoubleSigns) {
    EXPECT_EQ(written("1*x + 0*y"), "x");
    EXPECT_EQ(written("-x + m"), "m - x");
    EXPECT_EQ(written("m*x + L*x - y"), "(m + L)*x - y");
    EXPECT_EQ(written("x'*m/2*x'"), "m/2*x'^2");
    EXPECT_EQ(written("0.038*x"), "0.038*x");
    EXPECT_EQ(written("x/m"), "1/m*x");
    EXPECT_EQ(written("-(x - y)"), "y - x");
    EXPECT_EQ(written("m*(x - y)^2"), "m*(x - y)^2");
    EXPECT_EQ(written("x - x"), "0");
    EXPECT_EQ(written("sin(-x) + cos(y - x)"), "cos(x - y) - sin(x)");
    EXPECT_EQ(written("cos(x + pi/2)"), "-sin(x)");
    EXPECT_EQ(written("cos(atan(L))"), "1/sqrt(1 + L^2)");
    EXPECT_EQ(written("sqrt(2)*sqrt(2)*x"), "2*x");
}

TEST_F(ProductSums, FoldSquaresOfSineAndCosine) {
    EXPECT_EQ(writer_->text(sum("m*cos(x)^2 + m*sin(x)^2 + y").without_squares()), "y + m");
    EXPECT_EQ(writer_->text(sum("m*cos(x)^2 + L*sin(x)^2").without_squares()), "m*cos(x)^2 + L*sin(x)^2");
}

// A level of nested functions takes no multiple of the time of the one inside.
TEST_F(ProductSums, TakeNestedFunctionsInLinearTime) {
    std::string tangents = "x", roots = "x", sines = "x";
    for (int i = 0; i < 40; ++i) {
        tangents = "cos(atan(" + tangents + "))";
        roots = "0.2*sqrt(1 + " + roots + ")^3";
        sines = "sin(" + sines + " + pi/2)";
    }
    for (const std::string& text : {tangents, roots, sines})
        EXPECT_NEAR(value_of(sum(text).expression(graph_), std::vector{0.5}), value(text, {0.5}),
                    1e-12 * value(text, {0.5}));
}

// Written text, the graph's expression and the derivative have the values of the original, in random states.
TEST_F(ProductSums, HaveTheValueOfTheirExpression) {
    const char* const texts[] = {"m*(x + L)^2/(y^2 + 1) - 3*(x - y)*(x' + y')*cos(x + y)",
                                 "sqrt(1 + x^2)^3*sin(2*x - y - 0.3)/sqrt(1 + x^2)",
                                 "(m + L)*(m - L)*x*exp(-x*y)/7",
                                 "-(-(x - (y - (m - L))))",
                                 "tan(x)*atan(y/m) - 0.125*x^3/y^2",
                                 "cos(pi/2 - x)*sin(3*pi/2 + y) + cos(atan(x*y) + y)",
                                 "2^x + L^2.5"};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.2, 1.7);
    for (const char* text : texts) {
        const ProductSum s = sum(text), slope = s.derivative(0);
        const std::string again = writer_->text(s);
        EXPECT_EQ(written(again), again) << text;
        for (int i = 0; i < 20; ++i) {
            std::vector<double> values(7);
            for (double& each : values) each = uniform(random);
            const double expected = value(text, values), scale = 1e-13 * (1.0 + std::abs(expected));
            EXPECT_NEAR(value(again, values), expected, scale) << text << " as " << again;
            EXPECT_NEAR(value_of(s.expression(graph_), values), expected, scale) << text;
            EXPECT_NEAR(value_of(slope.expression(graph_), values),
                        value_of(derivative(parse(text, scope_, graph_), 0), values),
                        1e-11 * (1.0 + std::abs(expected)))
                << text;
        }
    }
}

}  // namespace
}  // namespace achilles
