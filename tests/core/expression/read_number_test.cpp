// Numbers as typed by a user: the whole text is read, or an error says why not.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "expression/parse.hpp"

namespace achilles {
namespace {

constexpr double pi = std::numbers::pi;

TEST(ReadNumber, TakesConstantExpressions) {
    for (const auto& [text, value] : std::initializer_list<std::pair<const char*, double>>{{"0.3", 0.3},
                                                                                           {" +4 ", 4.0},
                                                                                           {"-1e-3", -1e-3},
                                                                                           {"5e-324", 5e-324},
                                                                                           {"1e-400", 0.0},
                                                                                           {"-1e-400", 0.0},
                                                                                           {"1/3", 1.0 / 3.0},
                                                                                           {"0.1 + 0.2", 0.3},
                                                                                           {"-(1 + 2)^2/4", -2.25},
                                                                                           {"sqrt(2)", std::sqrt(2.0)},
                                                                                           {"pi/6", pi / 6.0}})
        EXPECT_DOUBLE_EQ(read_number(text).value, value) << text;
}

TEST(ReadNumber, DegreesAreAFactorWhereTheUnitIsRad) {
    for (const auto& [text, value] : std::initializer_list<std::pair<const char*, double>>{{"30 deg", pi / 6.0},
                                                                                           {"30deg", pi / 6.0},
                                                                                           {"30\u00b0", pi / 6.0},
                                                                                           {"-1/2 deg", -pi / 360.0},
                                                                                           {"1e1 deg", pi / 18.0},
                                                                                           {"pi/2 + 30 deg", pi / 1.5},
                                                                                           {"(10 + 20) deg", pi / 6.0},
                                                                                           {"60 deg/2", pi / 6.0},
                                                                                           {"0.5 rad", 0.5}}) {
        EXPECT_NEAR(read_number(text, "rad").value, value, 4e-16) << text;
        EXPECT_TRUE(read_number(text, "rad").has_unit) << text;
    }
    EXPECT_EQ(read_number("30 deg", "rad").value, read_number("pi/6", "rad").value);
    EXPECT_FALSE(read_number("pi/6", "rad").has_unit);
    EXPECT_TRUE(read_number("pi/6", "rad").has_pi);
    EXPECT_FALSE(read_number("1/3", "rad").has_pi);
}

// Degrees per second, for a rate.
TEST(ReadNumber, DegreesASecondAreAFactorWhereTheUnitIsRadPerSecond) {
    for (const char* text : {"20 deg/s", "20\u00b0/s", "20 deg", "20 rad/s*pi/180", "40 deg/s/2"}) {
        EXPECT_NEAR(read_number(text, "rad/s").value, pi / 9.0, 1e-16) << text;
        EXPECT_TRUE(read_number(text, "rad/s").has_unit) << text;
    }
    EXPECT_THROW(read_number("20 deg/s", "rad"), ParseError);
    EXPECT_THROW(read_number("20 deg/sec", "rad/s"), ParseError);
    // If the name s has a value, it means that value.
    Graph graph;
    Scope scope{{{"s", graph.number(4)}}, {}};
    allow_units(scope, "rad/s", graph);
    EXPECT_NEAR(value_of_constant(parse("20 deg/s", scope, graph)), pi / 36.0, 1e-16);
}

std::string told(const std::string& text, const std::string& unit = {}) {
    try {
        read_number(text, unit);
    } catch (const ParseError& error) {
        return std::to_string(error.offset) + " " + error.what();
    }
    return "";
}

TEST(ReadNumber, TellsWhatIsWrongWithTheText) {
    EXPECT_EQ(told("0,4"), "0 '0,4' is not a finite number: write a decimal point, 0.4");
    EXPECT_EQ(told("abc"), "0 'abc' is not a finite number: pi is the only name allowed here");
    EXPECT_EQ(told("p/6"), "0 'p/6' is not a finite number: pi is the only name allowed here; did you mean 'pi'?");
    EXPECT_EQ(told("ten"), "0 'ten' is not a finite number: pi is the only name allowed here");
    EXPECT_EQ(told("tam(1)"), "0 'tam(1)' is not a finite number: unknown function 'tam'; did you mean 'tan'?");
    EXPECT_EQ(told(" 2*x'"), "3 '2*x'' is not a finite number: pi is the only name allowed here");
    EXPECT_EQ(told(""), "0 a number is missing");
    EXPECT_EQ(told("  "), "0 a number is missing");
    EXPECT_EQ(told("inf"), "0 'inf' is not a finite number");
    EXPECT_EQ(told("-nan"), "0 '-nan' is not a finite number");
    EXPECT_EQ(told("1e999"), "0 '1e999' is not a finite number");
    EXPECT_EQ(told("log(0)"), "0 'log(0)' is not a finite number");
    EXPECT_EQ(told("1/0"), "1 '1/0' is not a finite number: division by zero");
    EXPECT_EQ(told("0x10"),
              "1 '0x10' is not a finite number: 'x10' may not follow a number: write numbers without units (a file has "
              "the key unit for that) and products with '*'");
    EXPECT_EQ(told("1e"), "1 '1e' is not a finite number: write the exponent, as in 1e-3");
    for (const char* unit : {"", "m", "rad"})
        EXPECT_EQ(told("1.0 m/s^2", unit),
                  "4 '1.0 m/s^2' is not a finite number: 'm' may not follow a number: write numbers without units (a "
                  "file has the key unit for that) and products with '*'");
    EXPECT_EQ(told("2pi"), "1 '2pi' is not a finite number: an operator is missing here; write '*' for a product");
    EXPECT_EQ(told("30 deg", "m"),
              "3 '30 deg' is not a finite number: 'deg' is allowed only where the unit is rad, and here it is m");
    EXPECT_EQ(
        told("30\u00b0"),
        "2 '30\u00b0' is not a finite number: '\u00b0' is allowed only where the unit is rad, and here it is not");
    EXPECT_EQ(told("deg", "m").find("0 'deg' is not a finite number: "), 0u);
    EXPECT_EQ(told("30 deg deg", "rad"), "7 '30 deg deg' is not a finite number: write one unit only, as in 30 deg");
    EXPECT_EQ(told("deg", "rad"), "0 'deg' is not a finite number: pi is the only name allowed here");
    EXPECT_EQ(told(std::string(1000, '(')).substr(0, 80).find("\n"), std::string::npos);
    EXPECT_NE(told("9^9^9^9^9").find("is not a finite number"), std::string::npos);
}

// Degrees in an equation give an error that says what to write instead.
TEST(ReadNumber, AnExpressionOfAFileHasNoDegrees) {
    Graph graph;
    try {
        parse("sin(30 deg)", Scope{}, graph);
        FAIL();
    } catch (const ParseError& error) {
        EXPECT_EQ(error.offset, 7u);
        EXPECT_NE(std::string(error.what()).find("here write pi/180*"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace achilles
