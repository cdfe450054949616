// Reading of system files: correct files are understood; errors are reported with location, caret and hint.
#include "system/description.hpp"
#include "model/read_system.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/systems.hpp"

namespace achilles {
namespace {

// The error message for this text; "" if it is accepted.
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
const std::string title = "title = \"drop\"\n";                // first line of an accepted file
const std::string least = coordinate + energies + constraint;  // lines 1-4, 5-7, 8-10

TEST(Description, AViewMayHaveALabelAndAUnit) {
    const std::string view = "[[view]]\nname = \"v\"\nx = \"t\"\ny = \"2*x\"\n";
    const ViewDescription own =
        parse_system(title + least + view + "label = \"twice\"\nunit = \"km\"\n", "f.toml").views[0];
    EXPECT_EQ(own.label, "twice");
    EXPECT_EQ(own.unit, "km");
    const ViewDescription none = parse_system(title + least + view, "f.toml").views[0];
    EXPECT_EQ(none.label + none.unit, "");
    EXPECT_NE(message_of(title + least + view + "unit = \"deg\"\n").find("the unit 'deg'"), std::string::npos);
}

// Files contain "30 deg", not its sixteen digits.
TEST(Description, NumbersOfTheGalleryAreReadable) {
    constexpr std::size_t longest = 10;
    for (const std::string& name : test::all_systems()) {
        std::ifstream stream(test::source_file("assets/systems/" + name + ".toml"));
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        ASSERT_FALSE(text.empty()) << name;
        for (std::size_t end = 0, at = 0; (at = text.find_first_of("0123456789", end)) < text.size();) {
            end = std::min(text.find_first_not_of("0123456789", at), text.size());
            EXPECT_LE(end - at, longest) << name << ": " << text.substr(at, end - at);
        }
    }
    // The value is the nearest double.
    const auto angle = [](const char* name, std::size_t i) { return test::load(name)->description().coordinates[i]; };
    EXPECT_EQ(angle("double_pendulum", 0).start, 0.5235987755982988);
    EXPECT_EQ(angle("swinging_leg", 1).range[1], 2.0943951023931953);
    EXPECT_EQ(angle("bead_in_ring", 1).range[0], -3.141592653589793);
    EXPECT_EQ(test::load("ball_on_egg_crate")->default_run().parameters[2], 6.283185307179586);
}

TEST(Description, ReadsAFullFile) {
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
max_steps = 8
memory = 3e8
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
    ASSERT_EQ(system.constraints.size(), 1u);
    EXPECT_EQ(system.constraints[0].name, "contact");
    EXPECT_EQ(system.constraints[0].gap.text, "y - sin(x)");
    EXPECT_EQ(system.constraints[0].gap.at.line, 31);
    EXPECT_EQ(system.constraints[0].gap.at.column, 16);  // the y after the quote
    EXPECT_EQ(system.constraints[0].restitution.text, "e");
    EXPECT_EQ(system.options.end_time, 20.0);
    EXPECT_EQ(system.options.tolerance, 1e-9);
    EXPECT_EQ(system.options.method, Method::taylor);
    EXPECT_EQ(system.options.max_impacts, 7);
    EXPECT_EQ(system.options.max_steps, 8);
    EXPECT_EQ(system.options.memory, 3e8);
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

TEST(Description, FillsInWhatIsAbsent) {
    const SystemDescription system = parse_system(title + least, "dir/drop.toml");
    EXPECT_EQ(system.title, "drop");
    EXPECT_EQ(system.options.end_time, 10.0);
    EXPECT_EQ(system.options.tolerance, 1e-10);
    EXPECT_TRUE(system.drawings.empty());
    ASSERT_EQ(system.views.size(), 2u);  // one coordinate has no plane view
    EXPECT_EQ(system.views[0].name, "x");
    EXPECT_EQ(system.views[1].name, "gap");
    std::string plane = title + least + "[[coordinate]]\nname='y'\nstart=0\nrate=0\n";
    plane.insert(plane.find("/2"), " + y'^2");
    const SystemDescription two = parse_system(plane);
    ASSERT_EQ(two.views.size(), 4u);
    EXPECT_EQ(two.views[3].name, "plane");
    EXPECT_EQ(two.views[3].x.text, "x");
    EXPECT_EQ(two.views[3].y[0].text, "y");
}

TEST(Description, ColumnsCountCharactersNotBytes) {
    EXPECT_EQ(message_of("title = \"Bäll\" x\r\n"),
              "f.toml:1:16: not valid TOML: expected a comment or whitespace, saw 'x'\n    title = \"Bäll\" x\n        "
              "           ^");
}

TEST(Description, ColumnsInsideAnExpressionCountCharacters) {
    std::string text = title + least;
    text.replace(text.find("\"x\"\n[[c"), 3, "\"x*\xC3\xA9 + # y\"");
    EXPECT_EQ(message_of(text).substr(0, 25), "f.toml:8:16: unexpected '");
    text = title + coordinate + energies + "[[constraint]]\ngap = \"x\"\nrestitution = \"1 \xC3\xA9\"\n";
    EXPECT_EQ(message_of(text),
              "f.toml:11:18: unexpected '\xC3\xA9'\n    restitution = \"1 \xC3\xA9\"\n                     ^");
}

TEST(Description, ExpressionsKnowWhereTheyStart) {
    const SystemDescription one = parse_system(title + least);
    EXPECT_EQ(one.kinetic.at.line, 7);
    EXPECT_EQ(one.kinetic.at.column, 12);
    EXPECT_EQ(one.constraints[0].restitution.at.column, 15);  // a number has no quotes
    const SystemDescription multi = parse_system(title + coordinate + constraint +
                                                 "[lagrangian]\nkinetic = \"\"\"\n  x'^2\"\"\"\npotential = '''x'''\n");
    EXPECT_EQ(multi.kinetic.at.line, 11);
    EXPECT_EQ(multi.kinetic.at.column, 1);
    EXPECT_EQ(multi.potential.at.column, 16);
    // An error inside an expression: location of its first character plus the parser's offset.
    const InputError error = one.error(one.constraints[0].gap.at, "unknown name 'x'");
    EXPECT_STREQ(error.what(), "<text>:10:8: unknown name 'x'\n    gap = \"x\"\n           ^");
}

TEST(Description, AtMostSixteenCoordinates) {
    std::string text = title + least;
    for (int i = 0; i < 17; ++i) text += "[[coordinate]]\nname = \"q" + std::to_string(i) + "\"\nstart = 0\nrate = 0\n";
    EXPECT_EQ(message_of(text), "f.toml:73:9: more than 16 coordinates\n    name = \"q15\"\n            ^");
}

TEST(Description, HostileFilesEndInAMessage) {
    const std::string many(1 << 20, 'a');
    const std::string long_line = message_of("title = \"" + many + "\" x");
    EXPECT_EQ(long_line.rfind("f.toml:1:1048588: not valid TOML: expected a comment", 0), 0u);
    EXPECT_LT(long_line.size(), 300u);
    EXPECT_NE(long_line.find("\n    ..." + std::string(54, 'a') + "\" x\n" + std::string(63, ' ') + "^"),
              std::string::npos)
        << long_line;
    EXPECT_LT(message_of(title + many + " = 1\n" + least).size(), 600u);
    std::string dots = "a";
    for (int i = 0; i < 200000; ++i) dots += ".a";
    EXPECT_EQ(message_of("x = 1 # ' \"\n[" + dots + "]").rfind("f.toml:2:35: a key with more than 16 parts", 0), 0u);
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
    EXPECT_EQ(message_of(std::string("a = \0\1\2", 7)).rfind("f.toml: this is not text: it contains zero bytes", 0), 0u)
        << message_of(std::string("a = \0\1\2", 7));
    for (const std::string& text : {std::string("\""), std::string("'''"), std::string("\"\\"), std::string("#"),
                                    std::string("\xef\xbb\xbf"), std::string("\n\n\n["), std::string(1, '\0')}) {
        EXPECT_NE(message_of(text), "") << text;
    }
    std::string parameters;
    for (int i = 0; i <= 1000; ++i) parameters += "[[parameter]]\nname = \"p" + std::to_string(i) + "\"\nvalue = 1\n";
    EXPECT_EQ(message_of(title + least + parameters),
              "f.toml:3012:1: more than 1000 [[parameter]]\n    [[parameter]]\n    ^");
    // 600 000 strings with locations: on lines of their own, and all on one line. This must stay fast.
    std::string lines = "extra = [", one_line = lines;
    for (int i = 0; i < 300000; ++i) {
        lines += "\"a\",\n";
        one_line += "\"\xCE\xB8\",";
    }
    EXPECT_EQ(message_of(lines + "]\n" + title + least), "");
    EXPECT_EQ(message_of(one_line + "]\n" + title + least), "");
    EXPECT_NE(message_of(one_line + "]\ntitle = 1").find("f.toml:2:9"), std::string::npos);
    EXPECT_EQ(message_of(std::string((4 << 20) + 1, '\n')), "f.toml: the file is larger than 4 MB");
    // No prefix of a valid file may crash the reader.
    for (std::size_t size = 0; size < least.size(); ++size) message_of(least.substr(0, size));
}

std::string assignment_error(const std::string& text) {
    const SystemDescription system = parse_system(title + least + "[[parameter]]\nname = \"mass\"\nvalue = 1\n");
    auto run = default_run(system);
    try {
        assign(run, system, text);
    } catch (const InputError& error) {
        EXPECT_EQ(error.at.line, 0);
        return error.what();
    }
    return "";
}

TEST(Description, Assigns) {
    const SystemDescription system = parse_system(title + least + "[[parameter]]\nname = \"mass\"\nvalue = 1\n");
    auto run = default_run(system);
    assign(run, system, "mass=2.5");
    assign(run, system, "x = -1e-3");
    assign(run, system, "x'=+4");
    EXPECT_EQ(run.parameters[0], 2.5);
    EXPECT_EQ(run.q[0], -1e-3);
    EXPECT_EQ(run.v[0], 4.0);
    EXPECT_EQ(assignment_error("mas=2"),
              "--set mas=2: 'mas' is not a parameter, coordinate or rate of this system; did you mean 'mass'?");
    EXPECT_EQ(assignment_error("mass=1x"),
              "--set mass=1x: '1x' is not a finite number: 'x' may not follow a number: write numbers without units (a "
              "file has the key unit for that) and products with '*'");
    EXPECT_EQ(assignment_error("mass=inf"), "--set mass=inf: 'inf' is not a finite number");
    EXPECT_EQ(assignment_error("mass"),
              "--set mass: a value is missing\nwrite --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5");
}

const std::string arm =
    "title = \"arm\"\n[[coordinate]]\nname = \"theta\"\nstart = \"30 deg\"\nrate = \"-90 deg\"\nunit = \"rad\"\n"
    "range = [\"-180 deg\", \"180 deg\"]\nrate_range = [-5, \"2*pi\"]\n[[parameter]]\nname = \"tilt\"\nvalue = "
    "\"pi/6\"\nunit = \"rad\"\n[[parameter]]\nname = \"L\"\nvalue = \"1/3\"\nunit = \"m\"\nrange = [\"1/10\", 1]\n"
    "[lagrangian]\nkinetic = \"L^2*theta'^2/2\"\npotential = \"L*sin(theta - tilt)\"\n"
    "[[constraint]]\ngap = \"theta\"\nrestitution = 0.5\n[run]\nend_time = \"2*pi\"\n";

TEST(Description, NumbersMayBeConstantExpressions) {
    const SystemDescription system = parse_system(arm);
    const double degree = 0.017453292519943295;
    EXPECT_DOUBLE_EQ(system.coordinates[0].start, 30 * degree);
    EXPECT_DOUBLE_EQ(system.coordinates[0].rate, -90 * degree);
    EXPECT_DOUBLE_EQ(system.coordinates[0].range[0], -180 * degree);
    EXPECT_DOUBLE_EQ(system.coordinates[0].rate_range[1], 360 * degree);
    EXPECT_DOUBLE_EQ(system.parameters[0].value, 30 * degree);
    EXPECT_EQ(system.parameters[1].value, 1.0 / 3.0);
    EXPECT_EQ(system.parameters[1].range[0], 0.1);
    EXPECT_DOUBLE_EQ(system.options.end_time, 360 * degree);
    auto run = default_run(system);
    assign(run, system, "theta=60 deg");
    assign(run, system, "theta'=pi");
    assign(run, system, "L = 2/3");
    EXPECT_DOUBLE_EQ(run.q[0], 60 * degree);
    EXPECT_DOUBLE_EQ(run.v[0], 180 * degree);
    EXPECT_EQ(run.parameters[1], 2.0 / 3.0);
    EXPECT_THROW(assign(run, system, "L=30 deg"), InputError);
    EXPECT_THROW(assign(run, system, "L=0,4"), InputError);
    EXPECT_EQ(run.parameters[1], 2.0 / 3.0);
}

TEST(Description, ValuesOutsideARangeOfTheFileAreTold) {
    const SystemDescription system = parse_system(arm);
    auto run = default_run(system);
    EXPECT_TRUE(outside_ranges(system, run).empty());
    assign(run, system, "theta=30");
    assign(run, system, "theta'=-6");
    assign(run, system, "tilt=1000");  // its range limits the slider only
    assign(run, system, "L=2");
    EXPECT_EQ(outside_ranges(system, run),
              (std::vector<std::string>{
                  "theta = 30 rad is outside its range, -3.14159 to 3.14159: for an angle in degrees write 30 deg",
                  "theta' = -6 rad/s is outside its range, -5 to 6.28319", "L = 2 m is outside its range, 0.1 to 1"}));
}

TEST(Description, LinesTooThinToBeSeenAreTold) {
    std::string text = arm;
    text += "\n[[drawing]]\nshape = \"segment\"\nfrom = [\"0\", \"0\"]\nto = [\"1\", \"0\"]\nwidth = ";
    const auto line = std::count(text.begin(), text.end(), '\n') + 1;
    for (const char* width : {"0.02", "\"1/50\""})
        EXPECT_EQ(unseen_lines(parse_system(text + width + "\n")),
                  (std::vector<std::string>{
                      "line " + std::to_string(line) +
                      ": a width of 0.02 is too small to see: widths are in pixels, not in the units of "
                      "the points (default 2)"}));
    for (const char* width : {"0", "0.5", "\"L/50\""})  // no line, a thin line, a variable width
        EXPECT_TRUE(unseen_lines(parse_system(text + width + "\n")).empty()) << width;
}

std::string reading_error(const std::filesystem::path& file) {
    try {
        read_system(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Description, UnreadableFilesSayWhy) {
    EXPECT_EQ(reading_error("no/such.toml"), "no/such.toml: there is no folder no");
    EXPECT_EQ(reading_error("such.toml"), "such.toml: there is no such file");
    EXPECT_EQ(reading_error("/"), "/: cannot read the file: it is a directory");
    EXPECT_EQ(reading_error("/dev/zero"), "/dev/zero: the file is larger than 4 MB");
    // A pipe that is never written to must not block.
    const std::string pipe = (std::filesystem::temp_directory_path() / "achilles_description_test.toml").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(reading_error(pipe), pipe + ": cannot read the file: it is a pipe");
    std::filesystem::remove(pipe);
}

}  // namespace
}  // namespace achilles
