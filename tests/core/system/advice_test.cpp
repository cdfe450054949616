// Common mistakes in TOML, in keys, and in expressions with the syntax of other languages: the message says what to
// write.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

using test::FileEdit, test::changed, test::good, test::told;

class Advice : public testing::TestWithParam<FileEdit> {};

TEST_P(Advice, IsInTheMessage) {
    const FileEdit& change = GetParam();
    EXPECT_EQ(told(changed(good, {{change.from, change.to}})), change.message);
}

// Messages with the correction on a line of its own.
const FileEdit with_advice[] = {
    {"\"m*x\"\n", "\"m*x\n",
     "f.toml:16:17: not valid TOML: unescaped control characters other than TAB (U+0009) are explicitly prohibited\n   "
     " potential = \"m*x\n                    ^\nput text in two quotes: potential = \"m*x\""},
    {"\"drop\"", "\u201cdrop\u201d",
     "f.toml:1:9: not valid TOML: could not determine value type\n    title = \u201cdrop\u201d\n            ^\nwrite "
     "plain double quotes, \""},
    {"\"drop\"", "\"a \"big\" drop\"",
     "f.toml:1:13: not valid TOML: expected a comment or whitespace, saw 'b'\n    title = \"a \"big\" drop\"\n         "
     "       ^\nwrite \\\" for a quote inside text"},
    {"\"m/2*(x'^2 + theta'^2)\"", "'m/2*x'^2'",
     "f.toml:15:18: not valid TOML: expected a comment or whitespace, saw '^'\n    kinetic = 'm/2*x'^2'\n              "
     "       ^\nput text with a prime in double quotes: kinetic = \"m/2*x'^2\""},
    {"restitution = \"e\"", "restitution = e",
     "f.toml:19:15: not valid TOML: could not determine value type\n    restitution = e\n                  ^\nput it "
     "in "
     "quotes: restitution = \"e\""},
    {"start = 1\n", "start = .5\n",
     "f.toml:4:9: not valid TOML: expected decimal digit, saw '.'\n    start = .5\n            ^\nwrite the number "
     "alone: "
     "start = 0.5"},
    {"start = 1\n", "start = \u22121\n",
     "f.toml:4:9: not valid TOML: could not determine value type\n    start = \u22121\n            ^\nwrite the number "
     "alone: start = -1"},
    {"start = 1\n", "start: 1\n",
     "f.toml:4:6: not valid TOML: expected '=', saw ':'\n    start: 1\n         ^\nwrite an equals sign: start = 1"},
    {"[truncation]", "[run]",
     "f.toml:22:1: not valid TOML: cannot redefine existing table 'run'\n    [run]\n    ^\nwrite all keys under the "
     "first [run]"},
    {"[[coordinate]]", "[coordinate]",
     "f.toml:6:1: not valid TOML: cannot redefine existing table 'coordinate' as array-of-tables\n    [[coordinate]]\n "
     "   "
     "^\nwrite [[coordinate]] each time: one above has single brackets"},
    {"[[constraint]]", "[constraints]",
     "f.toml:17:2: unknown key 'constraints' in a system file; did you mean 'constraint'?\n    [constraints]\n     "
     "^\nwrite one [[constraint]] for each"},
    {"gap = \"x", "h = \"x",
     "f.toml:18:1: unknown key 'h' in [[constraint]]; did you mean 'gap'?\n    h = \"x - sin(theta)/9\"\n    ^\nknown "
     "keys: name, gap, between, longest, normal, slip, friction, static_friction, restitution, when, latch, begins, "
     "ends, "
     "drawing"},
    {"rate = 0.5", "velocity = 0.5",
     "f.toml:5:1: unknown key 'velocity' in [[coordinate]]; did you mean 'rate'?\n    velocity = 0.5\n    ^\nknown "
     "keys: name, start, rate, force, unit, range, rate_range"},
    {"name = \"theta\"", "name = \"theta\"\nunit = \"radians\"",
     "f.toml:8:9: the unit 'radians' is not known\n    unit = \"radians\"\n            ^\nwrite unit = \"rad\", and "
     "values "
     "in degrees as \"30 deg\""},
    {"start = 1\n", "start = \"1.0 m\"\n",
     "f.toml:4:10: 'start' in [[coordinate]] must be a number without a unit\n    start = \"1.0 m\"\n             "
     "^\nwrite start = 1.0, and unit = \"m\" on a separate line"},
    {"start = 1\n", "start = 1 m\n",
     "f.toml:4:11: not valid TOML: expected a comment or whitespace, saw 'm'\n    start = 1 m\n              ^\nwrite "
     "the number alone: start = 1 if the unit is m, else convert it"},
    {"value = 2\n", "value = \"5 s\"\n",
     "f.toml:10:10: 'value' in [[parameter]] must be a number without a unit\n    value = \"5 s\"\n             "
     "^\nwrite value = 5, and unit = \"s\" on a separate line"},
    {"[[parameter]]", "[parameter]",
     "f.toml:11:1: not valid TOML: cannot redefine existing table 'parameter' as array-of-tables\n    [[parameter]]\n  "
     "  "
     "^\nwrite [[parameter]] each time: one above has single brackets"},
    {"[lagrangian]", "[[lagrangian]]",
     "f.toml:14:1: [lagrangian] must be a table, not an array\n    [[lagrangian]]\n    ^\nwrite [lagrangian] once, and "
     "its "
     "keys below"},
    {"gap = \"x", "friction = 0.3\ngap = \"x",
     "f.toml:18:12: friction needs the sliding velocity: 'slip' is missing\n    friction = 0.3\n               ^\nadd "
     "slip, scaled like the gap: for gap = \"y - r\" it is \"x' + r*phi'\", or \"x'\" for a point; with 'between' in "
     "place of 'gap' it is derived"},
    {"\"m*x\"", "\"0.5x\u00b2\"",
     "f.toml:16:17: an operator is missing here; write '*' for a product\n    potential = \"0.5x\u00b2\"\n             "
     "   "
     "    ^\nwrite 0.5*x^2"},
    {"rate = 0.5", "rate = \"20 deg\"\nunit = \"m\"",
     "f.toml:5:12: 'rate' in [[coordinate]]: '20 deg' is not a finite number: 'deg' is allowed only where the unit is "
     "rad, and here it is m/s\n    rate = \"20 deg\"\n               ^"},
};
INSTANTIATE_TEST_SUITE_P(Lines, Advice, testing::ValuesIn(with_advice));

const FileEdit of_other_languages[] = {
    {"\"m*x\"", "\"m\u00b7x\"",
     "f.toml:16:15: unexpected '\u00b7'; write '*' for a product\n    potential = \"m\u00b7x\"\n                  "
     "^\nwrite m*x"},
    {"\"m*x\"", "\"m*x\u00b2\"",
     "f.toml:16:17: unexpected '\u00b2'; write ^2\n    potential = \"m*x\u00b2\"\n                    ^\nwrite m*x^2"},
    {"\"m*x\"", "\"m*x \u2212 1\"",
     "f.toml:16:18: unexpected '\u2212'; write the keyboard minus sign, -\n    potential = \"m*x \u2212 1\"\n          "
     "           ^\nwrite m*x - 1"},
    {"\"m*x\"", "\"m.*x\"",
     "f.toml:16:15: unexpected '.'; write '*'\n    potential = \"m.*x\"\n                  ^\nwrite m*x"},
    {"\"m*x\"", "\"pi()*x\"",
     "f.toml:16:14: 'pi' is not a function; write '*' for a product\n    potential = \"pi()*x\"\n                 ^"},
    {"\"m*x\"", "\"V = m*x\"",
     "f.toml:16:14: write the expression alone, without 'V' and '='\n    potential = \"V = m*x\"\n                 "
     "^\nwrite m*x"},
    {"\"m*x\"", "\"pow(x, 2)\"",
     "f.toml:16:14: unknown function 'pow'; write x^2 for a power\n    potential = \"pow(x, 2)\"\n                 "
     "^\nwrite x^2"},
    {"\"m*x\"", "\"np.sin(x)\"",
     "f.toml:16:14: unknown name 'np'; write the function without a prefix: sin(x)\n    potential = \"np.sin(x)\"\n    "
     "             ^\nwrite sin(x)"},
    {"\"x - sin(theta)/9\"", "\"x >= 0\"",
     "f.toml:18:10: unexpected '>'; write the expression alone: the contact is open where the gap is positive\n    gap "
     "= \"x >= 0\"\n             ^\nwrite x"},
    {"y = [\"gap'\"]", "y = [\"h\", \"v\", \"E\"]",
     "f.toml:31:7: unknown name 'h'; the gap is called gap\n    y = [\"h\", \"v\", \"E\"]\n          "
     "^\n\nf.toml:31:12: unknown name 'v'; rates are written theta'\n    y = [\"h\", \"v\", \"E\"]\n               "
     "^\n\nf.toml:31:17: unknown name 'E'; the energy is called energy\n    y = [\"h\", \"v\", \"E\"]\n                "
     "    ^"},
};
INSTANTIATE_TEST_SUITE_P(Habits, Advice, testing::ValuesIn(of_other_languages));

}  // namespace
}  // namespace achilles
