// What the reader rewrites before it parses expressions: derived parameters and generated texts.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"
#include "model/model.hpp"
#include "model/read_expressions.hpp"
#include "output/output.hpp"
#include "simulate/simulate.hpp"
#include "system/units.hpp"

namespace achilles {
namespace {

using test::changed, test::good, test::told;

std::string parameter(const std::string& name, const std::string& value, const std::string& more = "") {
    return "[[parameter]]\nname = \"" + name + "\"\nvalue = \"" + value + "\"\n" + more;
}

// The valid text with more parameters, the first of them on line 14, and a potential.
std::string with_parameters(const std::string& parameters, const std::string& potential = "m*x") {
    return changed(good, {{"[lagrangian]", parameters + "[lagrangian]"}, {"\"m*x\"", "\"" + potential + "\""}});
}

TEST(DerivedParameters, AreNoParametersOfARun) {
    const SystemDescription system =
        parse_system(with_parameters(parameter("J", "m*L^2/12", "unit = \"kg*m^2\"\nabout = \"inertia\"\n") +
                                     parameter("L", "3/2") + parameter("tilt", "30 deg", "unit = \"rad\"\n")));
    ASSERT_EQ(system.parameters.size(), 4u);
    EXPECT_EQ(system.parameters[2].name, "L");
    EXPECT_EQ(system.parameters[2].value, 1.5);
    EXPECT_NEAR(system.parameters[3].value, 0.5235987755982988, 1e-15);
    ASSERT_EQ(system.derived.size(), 1u);
    EXPECT_EQ(system.derived[0].name, "J");
    EXPECT_EQ(system.derived[0].unit, "kg*m^2");
    EXPECT_EQ(system.derived[0].about, "inertia");
    EXPECT_EQ(system.derived[0].definition.text, "m*L^2/12");
    EXPECT_EQ(system.derived[0].definition.at.line, 16);
    EXPECT_EQ(system.derived[0].definition.at.column, 10);
    EXPECT_EQ(default_run(system).parameters.size(), 4u);
    const std::vector<std::string> names = settable_names(system);
    EXPECT_EQ(std::count(names.begin(), names.end(), "J"), 0);
}

// Derived parameters are replaced by their expressions everywhere, in any order, and follow the parameters.
TEST(DerivedParameters, FollowFromOthersInAnyOrder) {
    const std::string text =
        with_parameters(parameter("k", "2*J + sqrt(e)") + parameter("J", "m*half^2") + parameter("half", "m/2"), "k*x");
    const auto model = test::typed(text);
    EXPECT_EQ(model->layout().p, 2u);
    achilles::Run run = model->default_run();
    EXPECT_EQ(derived_values(*model, run.parameters), (std::vector<double>{1.0, 2.0, 4.0 + std::sqrt(0.5)}));
    run.parameters[0] = 4.0;
    const std::vector<double> values = derived_values(*model, run.parameters);
    EXPECT_EQ(values, (std::vector<double>{2.0, 16.0, 32.0 + std::sqrt(0.5)}));
    auto energy = model->evaluator(model->energy(), run.parameters);
    set_state(energy, State{run.q, run.v});
    energy.run();
    EXPECT_NEAR(energy.potential(), values[2] * run.q[0], 1e-14);
}

// With the expressions in place of the parameters, the motion is the same bit for bit.
TEST(DerivedParameters, AreTheirExpressions) {
    const auto end = [](const std::string& text) {
        const auto model = test::typed(text);
        const Trajectory run = simulate(model, model->default_run());
        return std::pair(run.end.q, run.events.size());
    };
    const auto named = end(with_parameters(parameter("k", "m/2 + e"), "k*x + sin(k)")),
               written = end(with_parameters("", "(m/2 + e)*x + sin(m/2 + e)"));
    EXPECT_EQ(named.second, written.second);
    EXPECT_EQ(named.first, written.first);
}

TEST(DerivedParameters, MayBeARestitutionOrStandInViewsAndDrawings) {
    EXPECT_EQ(
        told(changed(with_parameters(parameter("half", "e/2")), {{"restitution = \"e\"", "restitution = \"half\""},
                                                                 {"\"s^2\"", "\"half*s^2\""},
                                                                 {"[\"s\", -1, 1]", "[\"s\", -1, \"half\"]"},
                                                                 {"\"gap'\"", "\"half*gap'\""},
                                                                 {"sin(theta)/9", "half*sin(theta)/9"},
                                                                 {"m/2*(x'^2", "half*(x'^2"}})),
        "");
    EXPECT_EQ(
        told(changed(with_parameters(parameter("more", "3*e")), {{"restitution = \"e\"", "restitution = \"more\""}})),
        "f.toml:22:16: the restitution must lie in [0, 1], but it is 1.5\n    restitution = \"more\"\n             "
        "      ^\n0 is plastic, 1 is elastic");
}

TEST(DerivedParameters, HaveUnits) {
    const SystemDescription system = parse_system(
        changed(with_parameters(parameter("J", "m*L^2/12") + "[[parameter]]\nname = \"L\"\nvalue = 1\nunit = \"m\"\n" +
                                parameter("w", "2*m", "unit = \"N\"\n") +
                                parameter("right", "tilt + 90 deg", "unit = \"rad\"\n") +
                                "[[parameter]]\nname = \"tilt\"\nvalue = 0\nunit = \"rad\"\n"),
                {{"value = 2\n", "value = 2\nunit = \"kg\"\n"}}));
    EXPECT_EQ(unit_of_expression(system, "J"), "kg*m^2");
    EXPECT_EQ(unit_of_expression(system, "w*L"), "J");
    EXPECT_EQ(unit_of(system, "w"), "N");
    const Model model(system);
    EXPECT_NEAR(derived_values(model, model.default_run().parameters)[2], 1.5707963267948966, 1e-15);
}

TEST(DerivedParameters, AreToldInJsonWithTheValuesOfTheRun) {
    const auto model = test::typed(with_parameters(parameter("J", "m/8", "unit = \"kg*m^2\"\n")));
    achilles::Run run = model->default_run();
    assign(run, model->description(), "m=4");
    const auto json = nlohmann::json::parse(to_json(simulate(model, run)));
    EXPECT_EQ(json["system"]["parameters"], (nlohmann::json{{"m", 4.0}, {"e", 0.5}, {"J", 0.5}}));
    EXPECT_EQ(json["units"]["J"], "kg*m^2");
}

TEST(DerivedParameters, AreNotSet) {
    const SystemDescription system = parse_system(with_parameters(parameter("J", "m/8")));
    achilles::Run run = default_run(system);
    const achilles::Run before = run;
    try {
        assign(run, system, "J=3");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "--set J=3: 'J' is a derived parameter, m/8: set the parameters in this expression");
    }
    EXPECT_EQ(run, before);
}

// Parameter entries, and the whole message for them.
struct WrongParameters {
    std::string parameters, message;
};

void PrintTo(const WrongParameters& one, std::ostream* out) { *out << one.parameters; }

class WrongDerivedParameters : public testing::TestWithParam<WrongParameters> {};

TEST_P(WrongDerivedParameters, IsToldWithItsPlace) {
    EXPECT_EQ(told(with_parameters(GetParam().parameters)), GetParam().message);
}

const WrongParameters wrong_parameters[] = {
    {parameter("J", "m*J"),
     "f.toml:16:10: the definition of the parameter 'J' is circular: J -> J\n    value = \"m*J\"\n             ^\ngive "
     "one of them a number as its value"},
    {parameter("a", "m + c") + parameter("b", "2*a") + parameter("c", "b - 1") + parameter("d", "a + b"),
     "f.toml:16:10: the definition of the parameter 'a' is circular: a -> c -> b -> a\n    value = \"m + c\"\n         "
     "    ^\ngive one of them a number as its value"},
    {parameter("d", "b + 1") + parameter("b", "2*c") + parameter("c", "b"),
     "f.toml:19:10: the definition of the parameter 'b' is circular: b -> c -> b\n    value = \"2*c\"\n             "
     "^\ngive one of them a number as its value"},
    {parameter("J", "m*l^2"), "f.toml:16:12: unknown name 'l'\n    value = \"m*l^2\"\n               ^"},
    {parameter("theta0", "1") + parameter("J", "2*theto0"),
     "f.toml:19:12: unknown name 'theto0'; did you mean 'theta0'?\n    value = \"2*theto0\"\n               ^"},
    {parameter("J", "m*x"),
     "f.toml:16:12: the coordinate 'x' is not allowed in a derived parameter: use only parameters\n    value = "
     "\"m*x\"\n               ^"},
    {parameter("J", "m*t"),
     "f.toml:16:12: 't' is not allowed in a derived parameter: use only parameters\n    value = \"m*t\"\n              "
     " ^"},
    {parameter("J", "m*energy"),
     "f.toml:16:12: 'energy' is allowed only in a [[view]]\n    value = \"m*energy\"\n               ^"},
    {parameter("J", "m*"),
     "f.toml:16:12: the expression ends where a value is expected\n    value = \"m*\"\n               ^"},
    {parameter("J", "m + 30 deg"),
     "f.toml:16:17: 'deg' is allowed only where the unit is rad, and here it is not\n    value = \"m + 30 deg\"\n      "
     "              ^"},
    {parameter("J", "2*m", "range = [0, 1]\n"),
     "f.toml:17:9: 'J' is a derived parameter: it has no slider and no range\n    range = [0, 1]\n            ^"},
    {parameter("m", "2*e"),
     "f.toml:15:9: the name 'm' is used twice\n    name = \"m\"\n            ^\nit is already the name at line 9"},
    {parameter("J", "log(e - 1)"),
     "f.toml:16:10: the derived parameter 'J' is not finite\n    value = \"log(e - 1)\"\n             ^"},
};
INSTANTIATE_TEST_SUITE_P(Reading, WrongDerivedParameters, testing::ValuesIn(wrong_parameters));

TEST(Degrees, MayStandWhereverTheUnitIsRad) {
    const std::string rad =
        "unit = \"rad\"\nstart = \"10 deg\"\nrate = \"-90 deg\"\nrange = [\"-30 deg\", \"30 deg\"]\n"
        "rate_range = [\"-180 deg\", 4]\n";
    const SystemDescription system = parse_system(changed(
        with_parameters("[[parameter]]\nname = \"a\"\nvalue = \"45 deg\"\nunit = \"rad\"\nrange = [0, \"90 deg\"]\n"),
        {{"name = \"theta\"\n", "name = \"theta\"\n" + rad}}));
    constexpr double degree = 0.017453292519943295;
    const CoordinateDescription& theta = system.coordinates[1];
    EXPECT_NEAR(theta.start, 10 * degree, 1e-15);
    EXPECT_NEAR(theta.rate, -90 * degree, 1e-15);
    EXPECT_NEAR(theta.range[0], -30 * degree, 1e-15);
    EXPECT_NEAR(theta.rate_range[0], -180 * degree, 1e-14);
    EXPECT_EQ(theta.rate_range[1], 4.0);
    EXPECT_NEAR(system.parameters[2].value, 45 * degree, 1e-15);
    EXPECT_NEAR(system.parameters[2].range[1], 90 * degree, 1e-15);
    achilles::Run run = default_run(system);
    assign(run, system, "theta'=30 deg");
    assign(run, system, "a=60\u00b0");
    EXPECT_NEAR(run.v[1], 30 * degree, 1e-15);
    EXPECT_NEAR(run.parameters[2], 60 * degree, 1e-15);
    EXPECT_EQ(told(changed(good, {{"rate = 0.5", "rate = \"30 deg\"\nunit = \"m\""}})),
              "f.toml:5:12: 'rate' in [[coordinate]]: '30 deg' is not a finite number: 'deg' is allowed only where the "
              "unit is rad, and here it is m/s\n    rate = \"30 deg\"\n               ^");
    for (const char* range : {"90 deg", "90 deg/s", "90\u00b0/s"})
        EXPECT_EQ(told(changed(
                      good, {{"value = 2", fmt::format("value = 2\nrange = [0, \"{}\"]\nunit = \"rad/s\"", range)}})),
                  "");
    EXPECT_EQ(told(changed(good, {{"value = 2", "value = 2\nrange = [0, \"90 deg\"]\nunit = \"rad/s^2\""}})),
              "f.toml:11:17: 'range' in [[parameter]]: '90 deg' is not a finite number: 'deg' is allowed only where "
              "the unit is rad, and here it is rad/s^2\n    range = [0, \"90 deg\"]\n                    ^");
}

// A generated text has no location. Errors in it are reported at the location of its origin.
TEST(Rewriting, TellsMistakesOfAMadeTextWhereItsOriginStands) {
    for (const bool is_written : {true, false}) {
        ParsedFile reading = read_tables(good, "<text>");
        Text& gap = reading.system.constraints[0].gap;
        gap = {"x - sin(theta)*nothing", gap.at, is_written};
        EXPECT_FALSE(check_expressions(reading.system, reading.names, reading.mistakes));
        try {
            reading.mistakes.raise(reading.system);
            FAIL();
        } catch (const InputErrors& errors) {
            ASSERT_EQ(errors.all.size(), 1u);
            EXPECT_EQ(errors.at.line, gap.at.line);
            EXPECT_EQ(errors.at.column, gap.at.column + (is_written ? 15 : 0));
            EXPECT_NE(errors.message.find("'nothing'"), std::string::npos) << errors.message;
        }
    }
}

}  // namespace
}  // namespace achilles
