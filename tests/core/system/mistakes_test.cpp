// Every kind of mistake in a system file, one at a time: the exact message, location and caret.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

using test::FileEdit, test::changed, test::good, test::told;

TEST(GoodText, HasNoMistake) { EXPECT_EQ(told(good), ""); }

class Mistakes : public testing::TestWithParam<FileEdit> {};

TEST_P(Mistakes, AreToldWithTheirPlace) {
    const FileEdit& change = GetParam();
    EXPECT_EQ(told(changed(good, {{change.from, change.to}})), change.message);
}

const FileEdit in_toml[] = {
    {"\"drop\"\n", "\n", "f.toml:1:9: not valid TOML: expected value, saw '\\n'\n    title = \n            ^"},
    {"start = 1\n", "start 1\n",
     "f.toml:4:7: not valid TOML: expected '=', saw '1'\n    start 1\n          ^\nwrite an equals sign: start = 1"},
    {"[lagrangian]", "[lagrangian",
     "f.toml:14:12: not valid TOML: expected ']', saw '\\n'\n    [lagrangian\n               ^\nwrite [lagrangian]"},
    {"value = 2\n", "value = 2\nvalue = 3\n",
     "f.toml:11:9: not valid TOML: cannot redefine existing integer 'value'\n    value = 3\n            ^\na key may "
     "appear only once in a table: remove one of the two"},
    {"start = 1\n", "start = 1e\n",
     "f.toml:4:11: not valid TOML: expected decimal digit, saw '\\n'\n    start = 1e\n              ^"},
};
INSTANTIATE_TEST_SUITE_P(Toml, Mistakes, testing::ValuesIn(in_toml));

const FileEdit in_keys[] = {
    {"start = 1", "strat = 1",
     "f.toml:4:1: unknown key 'strat' in [[coordinate]]; did you mean 'start'?\n    strat = 1\n    ^\nknown keys: "
     "name, start, rate, force, unit, range, rate_range"},
    {"[lagrangian]", "[langrangian]",
     "f.toml:14:2: unknown key 'langrangian' in a system file; did you mean 'lagrangian'?\n    [langrangian]\n     "
     "^\nknown keys: title, source, coordinate, parameter, lagrangian, constraint, friction, jump, world, body, "
     "ground, "
     "spring, damper, force, torque, run, view, drawing, truncation, orbit, extra"},
    {"[[parameter]]\nname = \"m\"", "[[param]]\nname = \"m\"",
     "f.toml:8:3: unknown key 'param' in a system file; did you mean 'parameter'?\n    [[param]]\n      ^\nknown keys: "
     "title, source, coordinate, parameter, lagrangian, constraint, friction, jump, world, body, ground, spring, "
     "damper, "
     "force, "
     "torque, "
     "run, view, drawing, truncation, orbit, extra"},
    {"end_time = 5", "zeno = 5",
     "f.toml:21:1: unknown key 'zeno' in [run]\n    zeno = 5\n    ^\nknown keys: start_time, end_time, tolerance, "
     "method, max_impacts, max_steps, memory, simultaneous, energy_gain, max_events"},
    {"eps_q", "epsq",
     "f.toml:23:1: unknown key 'epsq' in [truncation]; did you mean 'eps_q'?\n    epsq = 1e-6\n    ^\nknown keys: "
     "eps_q, eps_v, eps_t, conditions, reinitialization"},
    {"name = \"x\"\n", "", "f.toml:2:1: missing key 'name' in [[coordinate]]\n    [[coordinate]]\n    ^"},
    {"value = 2\n", "", "f.toml:8:1: missing key 'value' in [[parameter]]\n    [[parameter]]\n    ^"},
    {"kinetic = \"m/2*(x'^2 + theta'^2)\"\n", "",
     "f.toml:14:1: missing key 'kinetic' in [lagrangian]\n    [lagrangian]\n    ^"},
    {"potential = \"m*x\"\n", "", "f.toml:14:1: missing key 'potential' in [lagrangian]\n    [lagrangian]\n    ^"},
    {"restitution = \"e\"\n", "",
     "f.toml:17:1: missing key 'restitution' in [[constraint]]\n    [[constraint]]\n    ^"},
    {"over = [\"s\", -1, 1]\n", "",
     "f.toml:24:1: missing key 'over' in [[drawing]] of shape curve\n    [[drawing]]\n    ^"},
    {"x = \"x\"\n", "", "f.toml:28:1: missing key 'x' in [[view]]\n    [[view]]\n    ^"},
    {"[[constraint]]\ngap = \"x - sin(theta)/9\"\nrestitution = \"e\"\n", "",
     "f.toml:28:7: gap' needs a [[constraint]], and this system has none\n    y = [\"gap'\"]\n          ^"},
};
INSTANTIATE_TEST_SUITE_P(Keys, Mistakes, testing::ValuesIn(in_keys));

const FileEdit in_types[] = {
    {"title = \"drop\"", "title = 1",
     "f.toml:1:9: 'title' in a system file must be a string, not a number\n    title = 1\n            ^"},
    {"start = 1", "start = \"2*fast\"",
     "f.toml:4:12: 'start' in [[coordinate]]: '2*fast' is not a finite number: pi is the only name allowed here\n    "
     "start = \"2*fast\"\n               ^"},
    {"start = 1", "start = \"0,4\"",
     "f.toml:4:10: 'start' in [[coordinate]]: '0,4' is not a finite number: write a decimal point, 0.4\n    start = "
     "\"0,4\"\n             ^"},
    {"value = 2", "value = \"30 deg\"",
     "f.toml:10:13: 'value' in [[parameter]]: '30 deg' is not a finite number: 'deg' is allowed only where the unit is "
     "rad, and here it is not\n    value = \"30 deg\"\n                ^"},
    {"value = 2", "value = 2\nunit = \"deg\"",
     "f.toml:11:9: the unit 'deg' is not allowed\n    unit = \"deg\"\n            ^\nwrite unit = "
     "\"rad\", and values in degrees as \"30 deg\""},
    {"start = 1", "start = \"60 deg\"\nunit = \"deg\"",
     "f.toml:5:9: the unit 'deg' is not allowed\n    unit = \"deg\"\n            ^\nwrite unit = "
     "\"rad\", and values in degrees as \"30 deg\""},
    {"value = 2", "value = 2\nunit = \"N*m/deg\"",
     "f.toml:11:9: the unit 'N*m/deg' is not allowed\n    unit = \"N*m/deg\"\n            ^\nwrite unit = "
     "\"N*m/rad\", and values in degrees as \"30 deg\""},
    {"rate = 0.5", "rate = [0.5]",
     "f.toml:5:8: 'rate' in [[coordinate]] must be a number, not an array\n    rate = [0.5]\n           ^"},
    {"value = 2", "value = true",
     "f.toml:10:9: 'value' in [[parameter]] must be a number, not true or false\n    value = true\n            ^"},
    {"value = 2", "value = 2020-01-02",
     "f.toml:10:9: 'value' in [[parameter]] must be a number, not a date\n    value = 2020-01-02\n            ^"},
    {"\"m*x\"", "[\"m*x\"]",
     "f.toml:16:13: 'potential' in [lagrangian] must be an expression (a string or a number), not an array\n    "
     "potential = [\"m*x\"]\n                ^"},
    {"[[constraint]]", "[constraint]",
     "f.toml:17:2: 'constraint' must be an array of tables, not a table\n    [constraint]\n     ^\nwrite one "
     "[[constraint]] for each"},
    {"[run]\nend_time = 5\n", "[[run]]\nend_time = 5\n",
     "f.toml:20:1: [run] must be a table, not an array\n    [[run]]\n    ^\nwrite [run] once, and its keys below"},
    {"end_time = 5", "end_time = \"soon\"",
     "f.toml:21:13: 'end_time' in [run]: 'soon' is not a finite number: pi is the only name allowed here\n    end_time "
     "= \"soon\"\n                ^"},
    {"[\"s\", \"s^2\"]", "\"s\"",
     "f.toml:27:6: 'at' in [[drawing]] of shape curve must be a point [x, y], not a string\n    at = \"s\"\n         "
     "^"},
    {"[\"s\", \"s^2\"]", "[\"s\", \"s^2\", \"s\"]",
     "f.toml:27:6: a point of 'at' in [[drawing]] of shape curve must have two coordinates, not 3\n    at = [\"s\", "
     "\"s^2\", \"s\"]\n         ^"},
    {"[\"s\", -1, 1]", "[\"s\", -1]",
     "f.toml:26:8: 'over' in [[drawing]] must be [\"name\", low, high]\n    over = [\"s\", -1]\n           ^"},
    {"\"x - sin(theta)/9\"", "\"\"",
     "f.toml:18:8: 'gap' in [[constraint]] is empty\n    gap = \"\"\n           ^\nan expression is expected"},
    {"y = [\"gap'\"]", "y = []",
     "f.toml:31:5: 'y' in [[view]] is empty\n    y = []\n        ^\none expression for each curve"},
    {"y = [\"gap'\"]", "y = true",
     "f.toml:31:5: 'y' in [[view]] must be an expression (a string or a number), not true or false\n    y = true\n     "
     "   ^"},
    {"shape = \"curve\"", "shape = \"curv\"",
     "f.toml:25:10: unknown shape 'curv'; did you mean 'curve'?\n    shape = \"curv\"\n             ^\nshapes are: "
     "disc, circle, box, segment, spring, damper, ground, curve, polyline, text"},
    {"shape = \"curve\"\nover = [\"s\", -1, 1]", "shape = \"curv\"\ncolor = \"red\"\nover = [\"s\", \"ss\", 1]",
     "f.toml:25:10: unknown shape 'curv'; did you mean 'curve'?\n    shape = \"curv\"\n             ^\nshapes are: "
     "disc, circle, box, segment, spring, damper, ground, curve, polyline, text\n\nf.toml:26:10: 'red' is not a "
     "color\n    color = \"red\"\n             ^\nwrite a color as \"#rrggbb\"\n\nf.toml:27:15: unknown name 'ss'; did "
     "you mean 's'?\n    over = [\"s\", \"ss\", 1]\n                  ^"},
    {"shape = \"curve\"", "shape = \"curve\"\ncolor = \"red\"",
     "f.toml:26:10: 'red' is not a color\n    color = \"red\"\n             ^\nwrite a color as \"#rrggbb\""},
    {"shape = \"curve\"", "shape = \"curve\"\nfill = 1",
     "f.toml:26:8: 'fill' in [[drawing]] of shape curve must be true or false, not a number\n    fill = 1\n           "
     "^"},
};
INSTANTIATE_TEST_SUITE_P(Types, Mistakes, testing::ValuesIn(in_types));

const FileEdit in_values[] = {
    {"start = 1", "start = nan",
     "f.toml:4:9: 'start' in [[coordinate]] must be finite, not nan\n    start = nan\n            ^"},
    {"rate = 0.5", "rate = -inf",
     "f.toml:5:8: 'rate' in [[coordinate]] must be finite, not -inf\n    rate = -inf\n           ^"},
    {"value = 2", "value = inf",
     "f.toml:10:9: 'value' in [[parameter]] must be finite, not inf\n    value = inf\n            ^"},
    {"end_time = 5", "end_time = 0",
     "f.toml:21:12: the end time 0 is not after the start time 0\n    end_time = 0\n               ^"},
    {"end_time = 5", "start_time = -7\nend_time = -8",
     "f.toml:22:12: the end time -8 is not after the start time -7\n    end_time = -8\n               ^"},
    {"end_time = 5", "start_time = 12",
     "f.toml:21:14: the end time 10 is not after the start time 12\n    start_time = 12\n                 ^"},
    {"end_time = 5", "start_time = inf",
     "f.toml:21:14: 'start_time' in [run] must be finite, not inf\n    start_time = inf\n                 ^"},
    {"end_time = 5", "simultaneous = \"moreaus\"",
     "f.toml:21:17: unknown simultaneous 'moreaus'; did you mean 'moreau'?\n    simultaneous = \"moreaus\"\n           "
     "    "
     "     ^\nknown: moreau, stop"},
    {"end_time = 5", "tolerance = -1e-3",
     "f.toml:21:13: 'tolerance' in [run] must be positive, not -0.001\n    tolerance = -1e-3\n                ^"},
    {"end_time = 5", "max_impacts = 1.5",
     "f.toml:21:15: 'max_impacts' in [run] must be a whole number up to 2147483647\n    max_impacts = 1.5\n            "
     "      ^"},
    {"end_time = 5", "max_steps = 9999999999",
     "f.toml:21:13: 'max_steps' in [run] must be a whole number up to 2147483647\n    max_steps = 9999999999\n         "
     "   "
     "    ^"},
    {"end_time = 5", "max_impacts = 0",
     "f.toml:21:15: 'max_impacts' in [run] must be positive, not 0\n    max_impacts = 0\n                  ^"},
    {"end_time = 5", "method = \"tailor\"",
     "f.toml:21:11: unknown method 'tailor'; did you mean 'taylor'?\n    method = \"tailor\"\n              ^\nknown: "
     "taylor, dopri5"},
    {"eps_q = 1e-6", "eps_v = 0.0",
     "f.toml:23:9: 'eps_v' in [truncation] must be positive, not 0\n    eps_v = 0.0\n            ^"},
    {"eps_q = 1e-6", "eps_t = inf",
     "f.toml:23:9: 'eps_t' in [truncation] must be finite, not inf\n    eps_t = inf\n            ^"},
    {"eps_q = 1e-6", "conditions = \"papre\"",
     "f.toml:23:15: unknown conditions 'papre'; did you mean 'paper'?\n    conditions = \"papre\"\n                  "
     "^\nknown: sharp, paper"},
    {"eps_q = 1e-6", "reinitialization = \"kinetics\"",
     "f.toml:23:21: unknown reinitialization 'kinetics'; did you mean 'kinetic'?\n    reinitialization = "
     "\"kinetics\"\n                        ^\nknown: kinetic, euclidean"},
    {"start = 1", "start = 1\nrange = [2, 1]",
     "f.toml:5:9: 'range' in [[coordinate]] must be finite with low < high\n    range = [2, 1]\n            ^"},
    {"start = 1", "start = 1\nrange = [2]",
     "f.toml:5:9: 'range' in [[coordinate]] must be two numbers, [low, high]\n    range = [2]\n            ^"},
    {"value = 2", "value = 2\nrange = [1, 1]",
     "f.toml:11:9: 'range' in [[parameter]] must be finite with low < high\n    range = [1, 1]\n            ^"},
    {"restitution = \"e\"", "restitution = 1.5",
     "f.toml:19:15: the restitution must lie in [0, 1], but it is 1.5\n    restitution = 1.5\n                  ^\n0 "
     "is plastic, 1 is elastic"},
    {"restitution = \"e\"", "restitution = \"1 - 3/2\"",
     "f.toml:19:16: the restitution must lie in [0, 1], but it is -0.5\n    restitution = \"1 - 3/2\"\n                "
     "   ^\n0 is plastic, 1 is elastic"},
};
INSTANTIATE_TEST_SUITE_P(Values, Mistakes, testing::ValuesIn(in_values));

const FileEdit in_namesof[] = {
    {"name = \"theta\"", "name = \"sin\"",
     "f.toml:7:9: the name 'sin' is reserved\n    name = \"sin\"\n            ^\nfunctions, t, pi, gap, lambda, "
     "energy, work, loss, power and deg are reserved: choose another name\n\nf.toml:15:24: unknown name theta'\n    "
     "kinetic = \"m/2*(x'^2 + theta'^2)\"\n                           ^"},
    {"name = \"m\"", "name = \"gap\"",
     "f.toml:9:9: the name 'gap' is reserved\n    name = \"gap\"\n            ^\nfunctions, t, pi, gap, lambda, "
     "energy, work, loss, power and deg are reserved: choose another name\n\nf.toml:15:12: unknown name 'm'\n    "
     "kinetic = \"m/2*(x'^2 + theta'^2)\"\n               ^"},
    {"name = \"theta\"", "name = \"floor\"",
     "f.toml:7:9: the name 'floor' is reserved\n    name = \"floor\"\n            ^\nfunctions, t, pi, gap, lambda, "
     "energy, work, loss, power and deg are reserved: choose another name\n\nf.toml:15:24: unknown name theta'\n    "
     "kinetic = \"m/2*(x'^2 + theta'^2)\"\n                           ^"},
    {"name = \"theta\"", "name = \"x\"",
     "f.toml:7:9: the name 'x' is used twice\n    name = \"x\"\n            ^\nit is already the name at line 3"},
    {"name = \"m\"", "name = \"x\"",
     "f.toml:9:9: the name 'x' is used twice\n    name = \"x\"\n            ^\nit is already the name at line 3"},
    {"name = \"theta\"", "name = \"2x\"",
     "f.toml:7:9: '2x' is not a name\n    name = \"2x\"\n            ^\na name is a letter followed by letters, digits "
     "and underscores"},
    {"name = \"theta\"", "name = \"the ta\"",
     "f.toml:7:9: 'the ta' is not a name\n    name = \"the ta\"\n            ^\na name is a letter followed by "
     "letters, digits and underscores"},
    {"[\"s\", -1, 1]", "[\"x\", -1, 1]",
     "f.toml:26:10: the name 'x' is used twice\n    over = [\"x\", -1, 1]\n             ^\nchoose another name for the "
     "curve parameter"},
    {"[\"s\", -1, 1]", "[\"t\", -1, 1]",
     "f.toml:26:10: the name 't' is reserved\n    over = [\"t\", -1, 1]\n             ^"},
    {"y = [\"gap'\"]\n", "y = [\"gap'\"]\n[[view]]\nname = \"path\"\nx = \"t\"\ny = \"x\"\n",
     "f.toml:33:9: the name 'path' is used twice\n    name = \"path\"\n            ^\neach [[view]] needs its own "
     "name"},
};
INSTANTIATE_TEST_SUITE_P(Names, Mistakes, testing::ValuesIn(in_namesof));

const FileEdit in_expression[] = {
    {"\"m*x\"", "\"m*xx\"",
     "f.toml:16:16: unknown name 'xx'; did you mean 'x'?\n    potential = \"m*xx\"\n                   ^"},
    {"\"m*x\"", "\"mm*x + 2*mm\"",
     "f.toml:16:14: unknown name 'mm'; did you mean 'm'?\n    potential = \"mm*x + 2*mm\"\n                 ^"},
    {"\"m*x\"", "\"m*x + velocity\"",
     "f.toml:16:20: unknown name 'velocity'\n    potential = \"m*x + velocity\"\n                       ^"},
    {"\"m*x\"", "\"m'*x\"",
     "f.toml:16:14: 'm' is a parameter: it has no rate\n    potential = \"m'*x\"\n                 ^"},
    {"\"m*x\"", "\"m*x''\"",
     "f.toml:16:16: the acceleration x'' is not allowed in an expression: it follows from the equations of motion\n    "
     "potential = \"m*x''\"\n                   ^"},
    {"\"m*x\"", "\"m*lambda\"",
     "f.toml:16:16: 'lambda' is allowed only in a [[view]]\n    potential = \"m*lambda\"\n                   ^"},
    {"restitution = \"e\"", "restitution = \"e*x\"",
     "f.toml:19:18: the coordinate 'x' is not allowed in the restitution: use only parameters\n    restitution = "
     "\"e*x\"\n                     ^"},
    {"\"m*x\"", "\"m*(x + 1\"",
     "f.toml:16:16: this '(' is never closed\n    potential = \"m*(x + 1\"\n                   ^"},
    {"\"m*x\"", "\"m*x)\"",
     "f.toml:16:17: this ')' has no matching '('\n    potential = \"m*x)\"\n                    ^"},
    {"\"m*x\"", "\"m x\"",
     "f.toml:16:16: an operator is missing here; write '*' for a product\n    potential = \"m x\"\n                   "
     "^\nwrite m*x"},
    {"\"m*x\"", "\"2x\"",
     "f.toml:16:15: an operator is missing here; write '*' for a product\n    potential = \"2x\"\n                  "
     "^\nwrite 2*x"},
    {"\"m*x\"", "\"m*x +\"",
     "f.toml:16:19: the expression ends where a value is expected\n    potential = \"m*x +\"\n                      ^"},
    {"\"m*x\"", "\"m**x\"",
     "f.toml:16:15: unknown operator '**'; write '^' for a power\n    potential = \"m**x\"\n                  ^"},
    {"\"m*x\"", "\"m*x^theta\"",
     "f.toml:16:17: the exponent of '^' must be a number, or its base a positive number\n    potential = "
     "\"m*x^theta\"\n                    ^"},
    {"\"m*x\"", "\"m*x/0\"", "f.toml:16:17: division by zero\n    potential = \"m*x/0\"\n                    ^"},
    {"\"m*x\"", "\"m*abs(x)\"",
     "f.toml:16:16: 'abs' is not allowed: it is not smooth, and the equations of motion need derivatives\n    "
     "potential = \"m*abs(x)\"\n                   ^\nsqrt(x^2 + w^2) approximates |x| for small w"},
    {"\"m*x\"", "\"m*|x|\"",
     "f.toml:16:16: |x| is not allowed: it is not smooth, and the equations of motion need derivatives\n    potential "
     "= \"m*|x|\"\n                   ^\nsqrt(x^2 + w^2) approximates |x| for small w"},
    {"\"m*x\"", "\"m|x|\"",
     "f.toml:16:15: |x| is not allowed: it is not smooth, and the equations of motion need derivatives\n    potential "
     "= \"m|x|\"\n                  ^\nsqrt(x^2 + w^2) approximates |x| for small w"},
    {"\"m*x\"", "\"min(m, x)\"",
     "f.toml:16:14: 'min' is not allowed: it is not smooth, and the equations of motion need derivatives\n    "
     "potential = \"min(m, x)\"\n                 ^\nwrite one [[constraint]] for each of two gaps; elsewhere (a + b - "
     "sqrt((a - b)^2 + w^2))/2 approximates min(a, b) for small w"},
    {"\"m*x\"", "\"floor(x)\"",
     "f.toml:16:14: 'floor' is not allowed: it is not smooth, and the equations of motion need derivatives\n    "
     "potential = \"floor(x)\"\n                 ^\n(1 + tanh(x/w))/2 approximates a step at x = 0 for small w"},
    {"name = \"theta\"\n", "name = \"theta\"\nforce = \"-m*sign(x')\"\n",
     "f.toml:8:13: 'sign' is not allowed: it is not smooth, and the equations of motion need derivatives\n    force = "
     "\"-m*sign(x')\"\n                ^\ntanh(x/w) approximates sign(x) for small w"},
    {"name = \"theta\"\n", "name = \"theta\"\nforce = \"-m*sgn(x')\"\n",
     "f.toml:8:13: 'sgn' is not allowed: it is not smooth, and the equations of motion need derivatives\n    force = "
     "\"-m*sgn(x')\"\n                ^\ntanh(x/w) approximates sign(x) for small w"},
    {"name = \"theta\"\n", "name = \"theta\"\nforce = \"max(x, m)\"\n",
     "f.toml:8:10: 'max' is not allowed: it is not smooth, and the equations of motion need derivatives\n    force = "
     "\"max(x, m)\"\n             ^\n(a + b + sqrt((a - b)^2 + w^2))/2 approximates max(a, b) for small w"},
    {"\"m*x\"", "\"sni(x)\"",
     "f.toml:16:14: unknown function 'sni'; did you mean 'sin'?\n    potential = \"sni(x)\"\n                 ^"},
    {"\"m*x\"", "\"ln(x)\"",
     "f.toml:16:14: unknown function 'ln'\n    potential = \"ln(x)\"\n                 ^\nwrite log(x)"},
    {"\"m*x\"", "\"sin x\"",
     "f.toml:16:14: the function 'sin' needs parentheses: sin(...)\n    potential = \"sin x\"\n                 "
     "^\nwrite sin(x)"},
    {"\"m*x\"", "\"sin(x, m)\"",
     "f.toml:16:19: the function 'sin' takes one argument\n    potential = \"sin(x, m)\"\n                      ^"},
    {"\"m*x\"", "\"m*x # y\"", "f.toml:16:18: unexpected '#'\n    potential = \"m*x # y\"\n                     ^"},
    {"\"m*x\"", "\"\"\"\nm*x\n  + bb\"\"\"", "f.toml:18:5: unknown name 'bb'\n      + bb\"\"\"\n        ^"},
    {"\"m*x\"", "\"m*x + θ + k\"",
     "f.toml:16:20: names have Latin letters: write theta for 'θ'\n    potential = \"m*x + θ + k\"\n                   "
     "    "
     "^"},
    {"\"s^2\"", "\"r^2\"", "f.toml:27:13: unknown name 'r'\n    at = [\"s\", \"r^2\"]\n                ^"},
    {"\"s^2\"", "\"x'\"",
     "f.toml:27:13: the rate x' is not allowed in the drawing: it may depend only on coordinates, parameters and "
     "time\n    at = [\"s\", \"x'\"]\n                ^"},
    {"y = [\"gap'\"]", "y = [\"t\", \"gap'''\"]",
     "f.toml:31:12: unknown name gap'''; did you mean gap''?\n    y = [\"t\", \"gap'''\"]\n               ^"},
    {"y = [\"gap'\"]", "y = [\"lamda\"]",
     "f.toml:31:7: unknown name 'lamda'; did you mean 'lambda'?\n    y = [\"lamda\"]\n          ^"},
};
INSTANTIATE_TEST_SUITE_P(Expression, Mistakes, testing::ValuesIn(in_expression));

const std::string of_degree_2 = "kinetic energy must have degree 2 or less in the rates, as in m/2*(x' + u*cos(t))^2";
const FileEdit in_kinetic[] = {
    {"m/2*(x'^2 + theta'^2)", "m/2*(x'^2 + theta'^2) - 3*x*x'^3",
     "f.toml:15:36: the term 3*x*x'^3 of the kinetic energy has degree 3 in the rates\n    kinetic = \"m/2*(x'^2 + "
     "theta'^2) - 3*x*x'^3\"\n                                       ^\n" +
         of_degree_2},
    {"m/2*(x'^2 + theta'^2)", "(x' + 1)^3 + theta'^2",
     "f.toml:15:12: the term x'^3 of the kinetic energy has degree 3 in the rates\n    kinetic = \"(x' + 1)^3 + "
     "theta'^2\"\n               ^\n" +
         of_degree_2},
    {"m/2*(x'^2 + theta'^2)", "m/2*(x'^2 + theta'^2) + sqrt(x'^2 + 1)",
     "f.toml:15:36: the kinetic energy is not a polynomial in the rates: sqrt(x'^2 + 1)\n    kinetic = \"m/2*(x'^2 + "
     "theta'^2) + sqrt(x'^2 + 1)\"\n                                       ^\n" +
         of_degree_2},
    {"m/2*(x'^2 + theta'^2)", "m/2*(x'^2 + theta'^2) + 1/x'",
     "f.toml:15:36: the kinetic energy is not a polynomial in the rates: 1/x'\n    kinetic = \"m/2*(x'^2 + theta'^2) + "
     "1/x'\"\n                                       ^\n" +
         of_degree_2},
    {"m/2*(x'^2 + theta'^2)", "x'^2 + x'*theta'",
     "f.toml:15:12: the kinetic energy has no term in theta'^2\n    kinetic = \"x'^2 + x'*theta'\"\n               "
     "^\nevery coordinate needs a positive inertia"},
    {"m/2*(x'^2 + theta'^2)", "x'^9 + theta'^2",
     "f.toml:15:12: the kinetic energy has a degree far above 2 in the rates: x'^9\n    kinetic = \"x'^9 + "
     "theta'^2\"\n               ^\n" +
         of_degree_2},
    {"m/2*(x'^2 + theta'^2)", "m/2*(x'^2 + theta'^2)*(2 + sin(t))",
     "f.toml:15:12: the term theta'^2*(m*(2 + sin(t)))/2 of the kinetic energy makes the mass matrix depend on "
     "t\n    kinetic = \"m/2*(x'^2 + theta'^2)*(2 + sin(t))\"\n               ^\nchoose a coordinate that moves with "
     "the "
     "prescribed motion: with s = l(t)*theta instead of theta, m/2*(l(t)*theta')^2 is m/2*(s' - s*l'(t)/l(t))^2, and "
     "the factor of s'^2 does not depend on t"},
    {"m/2*(x'^2 + theta'^2)", "0",
     "f.toml:15:12: the kinetic energy has no term in x'^2\n    kinetic = \"0\"\n               ^\nevery coordinate "
     "needs a positive inertia"},
    {"\"x - sin(theta)/9\"", "\"m\"",
     "f.toml:18:8: dh = 0 everywhere: the gap does not change with any coordinate\n    gap = \"m\"\n           ^"},
};
INSTANTIATE_TEST_SUITE_P(Kinetic, Mistakes, testing::ValuesIn(in_kinetic));

const FileEdit in_start[] = {
    {"start = 1", "start = -1",
     "f.toml:18:8: the gap is negative at the start: h = -1\n    gap = \"x - sin(theta)/9\"\n           ^\nchoose a "
     "start with h(q) >= 0, or reverse its sign: the gap is positive where the system is free"},
    {"value = 0.5", "value = 1.5",
     "f.toml:19:16: the restitution must lie in [0, 1], but it is 1.5\n    restitution = \"e\"\n                   "
     "^\n0 is plastic, 1 is elastic"},
    {"value = 2", "value = -2",
     "f.toml:15:12: the mass matrix is not positive definite at the start (the pivot of 'x' is -2)\n    kinetic = "
     "\"m/2*(x'^2 + theta'^2)\"\n               ^\nevery coordinate needs a positive inertia"},
    {"value = 2", "value = 0",
     "f.toml:15:12: the mass matrix is not positive definite at the start (the pivot of 'x' is 0)\n    kinetic = "
     "\"m/2*(x'^2 + theta'^2)\"\n               ^\nevery coordinate needs a positive inertia"},
    {"\"x - sin(theta)/9\"", "\"(x - 1)^2\"",
     "f.toml:18:8: the start is in contact, and dh = 0 there: the normal is not defined\n    gap = \"(x - 1)^2\"\n     "
     "      ^\nwrite a gap whose dh is not 0 where h = 0, for example x instead of x^2 or x^3"},
    {"\"x - sin(theta)/9\"", "\"log(x - 2)\"",
     "f.toml:18:8: the gap is not defined at the start: log(x - 2), with x - 2 = -1\n    gap = \"log(x - 2)\"\n      "
     "     ^"},
    {"\"m*x\"", "\"m*sqrt(x - 2)\"",
     "f.toml:16:14: the potential is not defined at the start: sqrt(x - 2), with x - 2 = -1\n    potential = "
     "\"m*sqrt(x - 2)\"\n                 ^"},
};
INSTANTIATE_TEST_SUITE_P(Start, Mistakes, testing::ValuesIn(in_start));

}  // namespace
}  // namespace achilles
