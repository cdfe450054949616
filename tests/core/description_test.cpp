// What a system file says is understood; what is wrong in it is told with its place, a caret and a hint.
#include "model/description.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace achilles {
namespace {

// The message of the error that this text is; "" if it is accepted.
std::string message_of(const std::string& text) {
    try {
        parse_system(text, "f.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

const std::string coordinate = "[[coordinate]]\nname = \"x\"\nstart = 1\nrate = 0\n";
const std::string energies = "[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x\"\n";
const std::string constraint = "[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n";
const std::string title = "title = \"drop\"\n";                // first line of what is accepted
const std::string least = coordinate + energies + constraint;  // lines 1-4, 5-7, 8-10

TEST(Description, reads_a_full_file) {
    const SystemDescription system = parse_system(R"toml(
title  = "Ball"
source = "somewhere"
[[coordinate]]
name  = "x"
start = 0
rate  = 1.5
unit  = "m"
range = [-10, 10.0]
rate_range = [-5.0, 5.0]
[[coordinate]]
name  = "y"
start = 2.0
rate  = 0.0
[[parameter]]
name  = "g"
value = 1
range = [0.1, 20]
unit  = "m/s^2"
about = "gravity"
[[parameter]]
name  = "e"
value = 0.25
[[parameter]]
name  = "low"
value = -3
[lagrangian]
kinetic   = "(x'^2 + y'^2)/2"
potential = "g*y"
[[constraint]]
gap         = "y - sin(x)"
restitution = "e"
[run]
end_time  = 20
tolerance = 1e-9
method = "taylor"
max_impacts = 7
[truncation]
eps_q = 1e-5
eps_v = 1e-4
eps_t = 1e-3
conditions       = "sharp"
reinitialization = "euclidean"
[[drawing]]
shape = "disc"
at    = ["x", 0.5]
radius = 0.08
color = "#a0B1c2"
fill = true
[[drawing]]
shape = "curve"
over  = ["s", -10, "2*g"]
at    = ["s", "sin(s)"]
width = 2
[[drawing]]
shape = "segment"
from  = ["0", "0"]
to    = ["x", "y"]
[[drawing]]
shape = "polyline"
points = [["x", "y"], [0, 1e-5], [1, 1]]
[[drawing]]
shape = "text"
at = [0, 0]
text = "floor"
[[view]]
name = "height"
x = "t"
y = "y"
[[view]]
name = "both"
x = "x"
y = ["y", "gap'"]
[extra]
anything = { goes = [1, "here"] }
)toml",
                                                  "ball.toml");
    EXPECT_EQ(system.file, "ball.toml");
    EXPECT_EQ(system.title, "Ball");
    EXPECT_EQ(system.source, "somewhere");
    ASSERT_EQ(system.coordinates.size(), 2u);
    const CoordinateDescription& x = system.coordinates[0];
    EXPECT_EQ(x.name, "x");
    EXPECT_EQ(x.unit, "m");
    EXPECT_EQ(x.rate, 1.5);
    EXPECT_EQ(x.range, (std::array{-10.0, 10.0}));
    EXPECT_EQ(x.rate_range, (std::array{-5.0, 5.0}));
    EXPECT_EQ(system.coordinates[1].start, 2.0);
    EXPECT_EQ(system.coordinates[1].range, (std::array{0.0, 4.0}));
    EXPECT_EQ(system.coordinates[1].rate_range, (std::array{-1.0, 1.0}));
    ASSERT_EQ(system.parameters.size(), 3u);
    EXPECT_EQ(system.parameters[0].about, "gravity");
    EXPECT_EQ(system.parameters[0].range, (std::array{0.1, 20.0}));
    EXPECT_EQ(system.parameters[1].range, (std::array{0.0, 1.0}));  // the restitution
    EXPECT_EQ(system.parameters[2].range, (std::array{-6.0, 0.0}));
    EXPECT_EQ(system.kinetic.text, "(x'^2 + y'^2)/2");
    EXPECT_EQ(system.gap.text, "y - sin(x)");
    EXPECT_EQ(system.gap.at.line, 31);
    EXPECT_EQ(system.gap.at.column, 16);  // the y, behind the quote
    EXPECT_EQ(system.restitution.text, "e");
    EXPECT_EQ(system.options.end_time, 20.0);
    EXPECT_EQ(system.options.tolerance, 1e-9);
    EXPECT_EQ(system.options.method, Method::taylor);
    EXPECT_EQ(system.options.max_impacts, 7);
    EXPECT_EQ(system.options.truncation.eps_q, 1e-5);
    EXPECT_EQ(system.options.truncation.eps_v, 1e-4);
    EXPECT_EQ(system.options.truncation.eps_t, 1e-3);
    EXPECT_EQ(system.options.truncation.conditions, Conditions::sharp);
    EXPECT_EQ(system.options.truncation.reinitialization, Reinitialization::euclidean);
    ASSERT_EQ(system.drawings.size(), 5u);
    EXPECT_EQ(system.drawings[0].points[0][1].text, "0.5");
    EXPECT_EQ(system.drawings[0].radius.text, "0.08");
    EXPECT_EQ(system.drawings[0].color, "#a0B1c2");
    EXPECT_TRUE(system.drawings[0].fill);
    EXPECT_EQ(system.drawings[1].over, "s");
    EXPECT_EQ(system.drawings[1].over_limits[0].text, "-10");
    EXPECT_EQ(system.drawings[1].over_limits[1].text, "2*g");
    EXPECT_EQ(system.drawings[1].width.text, "2");
    EXPECT_EQ(system.drawings[2].points.size(), 2u);
    EXPECT_EQ(system.drawings[3].points.size(), 3u);
    EXPECT_EQ(system.drawings[3].points[1][1].text, "1e-05");
    EXPECT_EQ(system.drawings[4].text, "floor");
    ASSERT_EQ(system.views.size(), 2u);
    EXPECT_EQ(system.views[0].y.size(), 1u);
    EXPECT_EQ(system.views[1].y[1].text, "gap'");
}

TEST(Description, fills_in_what_is_absent) {
    const SystemDescription system = parse_system(title + least, "dir/drop.toml");
    EXPECT_EQ(system.title, "drop");
    EXPECT_EQ(system.options.end_time, 10.0);
    EXPECT_EQ(system.options.tolerance, 1e-10);
    EXPECT_TRUE(system.drawings.empty());
    ASSERT_EQ(system.views.size(), 2u);  // one coordinate makes no plane
    EXPECT_EQ(system.views[0].name, "x");
    EXPECT_EQ(system.views[1].name, "gap");
    const SystemDescription two = parse_system(title + least + "[[coordinate]]\nname='y'\nstart=0\nrate=0\n");
    ASSERT_EQ(two.views.size(), 4u);
    EXPECT_EQ(two.views[3].name, "plane");
    EXPECT_EQ(two.views[3].x.text, "x");
    EXPECT_EQ(two.views[3].y[0].text, "y");
}

struct Mistake {
    std::string text, message;
};

TEST(Description, tells_what_is_wrong_and_where) {
    const std::vector<Mistake> mistakes{
        {"title = \n", "f.toml:1:9: not valid TOML: expected value, saw '\\n'\n    title = \n            ^"},
        {"a = 1\n\tb c = 2\n", "f.toml:2:4: not valid TOML: expected '=', saw 'c'\n     b c = 2\n       ^"},
        {"[[coordinate]]\nname = \"x\"\nstrat = 1\n",
         "f.toml:3:1: unknown key 'strat' in [[coordinate]]; did you mean 'start'?\n    strat = 1\n    ^\nknown here: "
         "name, start, rate, unit, range, rate_range"},
        {"[[coordinate]]\nstart = 1\nrate = 1\n",
         "f.toml:1:1: missing key 'name' in [[coordinate]]\n    [[coordinate]]\n    ^"},
        {"[[coordinate]]\nname = \"x\"\nstart = \"1\"\n",
         "f.toml:3:9: 'start' in [[coordinate]] must be a number, not a string\n    start = \"1\"\n            ^"},
        {"[[coordinate]]\nname = \"x\"\nstart = nan\nrate = 0",
         "f.toml:3:9: 'start' in [[coordinate]] must be finite, not nan\n    start = nan\n            ^"},
        {"[[coordinate]]\nname = 'sin'\nstart = 1\n",
         "f.toml:2:9: the name 'sin' is reserved\n    name = 'sin'\n            ^\nfunctions, t, pi, gap, lambda and "
         "energy keep their meaning: choose another name"},
        {"[[coordinate]]\nname = \"x y\"\n",
         "f.toml:2:9: 'x y' is not a name\n    name = \"x y\"\n            ^\na name is a letter, then letters, digits "
         "and underscores"},
        {least + "[[parameter]]\nname = \"x\"\nvalue = 1\n",
         "f.toml:12:9: the name 'x' is used twice\n    name = \"x\"\n            ^"},
        {"[coordinate]\nname = \"x\"\n",
         "f.toml:1:2: 'coordinate' must be an array of tables, not a table\n    [coordinate]\n     ^\nwrite "
         "[[coordinate]], once for each"},
        {"title = 1",
         "f.toml:1:9: 'title' in a system file must be a string, not a number\n    title = 1\n            ^"},
        {"", "f.toml:1:1: missing [[coordinate]]: a system needs at least one\nassets/systems has complete examples"},
        {coordinate + constraint, "f.toml:1:1: missing [lagrangian]\nassets/systems has complete examples"},
        {least, "f.toml:1:1: missing title\nassets/systems has complete examples"},
        {coordinate + energies, "f.toml:1:1: missing [[constraint]]\nassets/systems has complete examples"},
        {least + constraint,
         "f.toml:11:1: more than one [[constraint]]\n    [[constraint]]\n    ^\nAchilles simulates systems with "
         "exactly one unilateral constraint"},
        {coordinate + energies + "[[constraint]]\ngap = \"x\"\nrestitution = 1.5\n",
         "f.toml:10:15: restitution must be in [0, 1], not 1.5\n    restitution = 1.5\n                  ^\n0 is "
         "plastic, 1 is elastic"},
        {coordinate + energies + "[[constraint]]\ngap = \"\"\nrestitution = 1\n",
         "f.toml:9:8: 'gap' in [[constraint]] is empty\n    gap = \"\"\n           ^\nan expression is expected"},
        {least + "[run]\nend_time = 0\n",
         "f.toml:12:12: 'end_time' in [run] must be positive, not 0\n    end_time = 0\n               ^"},
        {least + "[run]\ntolerance = -1e-3\n",
         "f.toml:12:13: 'tolerance' in [run] must be positive, not -0.001\n    tolerance = -1e-3\n                ^"},
        {least + "[run]\nmax_impacts = 1.5\n",
         "f.toml:12:15: 'max_impacts' in [run] must be a whole number up to 2147483647\n    max_impacts = 1.5\n        "
         "          ^"},
        {least + "[run]\nmethod = \"tailor\"\n",
         "f.toml:12:11: unknown method 'tailor'; did you mean 'taylor'?\n    method = \"tailor\"\n              "
         "^\nknown: taylor, dopri5"},
        {least + "[truncation]\neps_q = 0.0\n",
         "f.toml:12:9: 'eps_q' in [truncation] must be positive, not 0\n    eps_q = 0.0\n            ^"},
        {least + "[truncation]\nconditions = \"papre\"\n",
         "f.toml:12:15: unknown conditions 'papre'; did you mean 'paper'?\n    conditions = \"papre\"\n                "
         "  ^\nknown: sharp, paper"},
        {least + "[[drawing]]\nshape = \"disk\"\n",
         "f.toml:12:10: unknown shape 'disk'; did you mean 'disc'?\n    shape = \"disk\"\n             ^\nshapes are: "
         "disc, segment, curve, polyline, text"},
        {least + "[[drawing]]\nshape = \"segment\"\nat = [0, 0]\n",
         "f.toml:13:1: unknown key 'at' in [[drawing]] of shape segment\n    at = [0, 0]\n    ^\nknown here: shape, "
         "color, width, fill, from, to"},
        {least + "[[drawing]]\nshape = \"disc\"\nradius = 1\nat = [0, 0, 0]\n",
         "f.toml:14:6: a point of 'at' in [[drawing]] of shape disc has two coordinates, not 3\n    at = [0, 0, 0]\n   "
         "      ^"},
        {least + "[[drawing]]\nshape = \"disc\"\nradius = 1\nat = [0, 0]\ncolor = \"red\"",
         "f.toml:15:10: 'red' is not a colour\n    color = \"red\"\n             ^\na colour is \"#rrggbb\""},
        {least + "[[drawing]]\nshape = \"curve\"\nat = [0, 0]\nover = [\"x\", 0, 1]",
         "f.toml:14:10: the name 'x' is used twice\n    over = [\"x\", 0, 1]\n             ^\na curve's own parameter "
         "needs a name of its own"},
        {least + "[[view]]\nname = \"a\"\nx = \"t\"\ny = []\n",
         "f.toml:14:5: 'y' in [[view]] is empty\n    y = []\n        ^\none expression for each curve"},
        {least + "[[view]]\nname = \"a\"\nx = \"t\"\ny = true\n",
         "f.toml:14:5: 'y' in [[view]] must be an expression (a string or a number), not true or false\n    y = true\n "
         "       ^"},
        {"[[coordinate]]\nname = \"x\"\nstart = 0\nrate = 0\nrange = [1, 1]\n",
         "f.toml:5:9: 'range' in [[coordinate]] must be finite with low < high\n    range = [1, 1]\n            ^"},
    };
    for (const Mistake& mistake : mistakes) EXPECT_EQ(message_of(mistake.text), mistake.message) << mistake.text;
}

TEST(Description, columns_count_characters_not_bytes) {
    EXPECT_EQ(message_of("title = \"Bäll\" x\r\n"),
              "f.toml:1:16: not valid TOML: expected a comment or whitespace, saw 'x'\n    title = \"Bäll\" x\n        "
              "           ^");
}

TEST(Description, expressions_know_where_they_start) {
    const SystemDescription one = parse_system(title + least);
    EXPECT_EQ(one.kinetic.at.line, 7);
    EXPECT_EQ(one.kinetic.at.column, 12);
    EXPECT_EQ(one.restitution.at.column, 15);  // a number has no quotes
    const SystemDescription multi = parse_system(title + coordinate + constraint +
                                                 "[lagrangian]\nkinetic = \"\"\"\n  x'^2\"\"\"\npotential = '''x'''\n");
    EXPECT_EQ(multi.kinetic.at.line, 11);
    EXPECT_EQ(multi.kinetic.at.column, 1);
    EXPECT_EQ(multi.potential.at.column, 16);
    // An error inside an expression: the place of its first character plus the parser's offset.
    const InputError error = one.error({one.gap.at.line, one.gap.at.column}, "unknown name 'x'");
    EXPECT_STREQ(error.what(), "<text>:10:8: unknown name 'x'\n    gap = \"x\"\n           ^");
}

TEST(Description, at_most_eight_coordinates) {
    std::string text;
    for (int i = 0; i < 9; ++i) text += "[[coordinate]]\nname = \"q" + std::to_string(i) + "\"\nstart = 0\nrate = 0\n";
    EXPECT_EQ(message_of(text), "f.toml:34:9: more than 8 coordinates\n    name = \"q8\"\n            ^");
}

TEST(Description, hostile_files_end_in_a_message) {
    const std::string many(1 << 20, 'a');
    const std::string long_line = message_of("title = \"" + many + "\" x");
    EXPECT_EQ(long_line.rfind("f.toml:1:1048588: not valid TOML: expected a comment", 0), 0u);
    EXPECT_LT(long_line.size(), 300u);
    EXPECT_NE(long_line.find("\n    ..." + std::string(54, 'a') + "\" x\n" + std::string(63, ' ') + "^"),
              std::string::npos)
        << long_line;
    EXPECT_LT(message_of(many + " = 1").size(), 600u);
    std::string dots = "a";
    for (int i = 0; i < 200000; ++i) dots += ".a";
    EXPECT_EQ(message_of("x = 1 # ' \"\n[" + dots + "]").rfind("f.toml:2:35: a key of more than 16 parts", 0), 0u);
    EXPECT_EQ(message_of("extra = {a = \"\"\"x\"\"\"\", " + dots + " = 1}").rfind("f.toml:1:", 0), 0u);
    for (const std::string& open : {std::string("["), std::string("{a="), std::string("(")}) {
        std::string nest = "extra = ";
        for (int i = 0; i < 100000; ++i) nest += open;
        EXPECT_NE(message_of(nest), "") << open;
    }
    std::string nest;
    for (int i = 0; i < 100; ++i) nest += '[';
    EXPECT_NE(message_of("extra = " + nest + std::string(100, ']')).find("more than 64 levels of nesting"),
              std::string::npos);
    EXPECT_NE(message_of("title = \"\xff\xfe\"").find("f.toml:1:"), std::string::npos);
    EXPECT_NE(message_of(std::string("a = \0\1\2", 7)).find("f.toml:1:5: not valid TOML"), std::string::npos);
    for (const std::string& text : {std::string("\""), std::string("'''"), std::string("\"\\"), std::string("#"),
                                    std::string("\xef\xbb\xbf"), std::string("\n\n\n["), std::string(1, '\0')}) {
        EXPECT_NE(message_of(text), "") << text;
    }
    // Every prefix of a good file is either good or a message.
    for (std::size_t size = 0; size < least.size(); ++size) message_of(least.substr(0, size));
}

std::string assignment_error(const std::string& text) {
    SystemDescription system = parse_system(title + least + "[[parameter]]\nname = \"mass\"\nvalue = 1\n");
    try {
        assign(system, text);
    } catch (const InputError& error) {
        EXPECT_EQ(error.at.line, 0);
        return error.what();
    }
    return "";
}

TEST(Description, assigns) {
    SystemDescription system = parse_system(title + least + "[[parameter]]\nname = \"mass\"\nvalue = 1\n");
    assign(system, "mass=2.5");
    assign(system, "x = -1e-3");
    assign(system, "x'=+4");
    EXPECT_EQ(system.parameters[0].value, 2.5);
    EXPECT_EQ(system.coordinates[0].start, -1e-3);
    EXPECT_EQ(system.coordinates[0].rate, 4.0);
    EXPECT_EQ(assignment_error("mas=2"),
              "--set mas=2: 'mas' is no parameter, coordinate or rate of this system; did you mean 'mass'?");
    EXPECT_EQ(assignment_error("mass=1x"), "--set mass=1x: '1x' is not a finite number");
    EXPECT_EQ(assignment_error("mass=inf"), "--set mass=inf: 'inf' is not a finite number");
    EXPECT_EQ(assignment_error("mass"),
              "--set mass: a value is missing\nwrite --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5");
}

std::string reading_error(const std::filesystem::path& file) {
    try {
        read_system(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Description, unreadable_files_say_why) {
    EXPECT_EQ(reading_error("no/such.toml"), "no/such.toml: there is no such file");
    EXPECT_EQ(reading_error("/"), "/: cannot read the file: it is a directory");
    EXPECT_EQ(reading_error("/dev/zero"), "/dev/zero: it is larger than 4 MB");
}

}  // namespace
}  // namespace achilles
