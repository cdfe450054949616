// Mistakes in files of bodies as a user meets them: status 2, the caret under the mistake, and nothing written.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <regex>
#include <sstream>

#include "app/program.hpp"

namespace achilles::test {
namespace {

// A change in a reference mechanism, and the text at which the caret must point.
struct FileMistake {
    const char *name, *file, *from, *to, *caret, *message;
};
void PrintTo(const FileMistake& one, std::ostream* out) { *out << one.name; }

const FileMistake file_mistakes[] = {
    {"UnknownBody", "kneed_leg", R"("thigh.end")", R"("tigh.end")", "tigh.end", "did you mean 'thigh'?"},
    {"UnknownPoint", "kneed_leg", R"("shank.end", "floor")", R"("shank.tip", "floor")", "shank.tip", "unknown point"},
    {"UnknownGround", "falling_rod", R"("rod.start", "floor")", R"("rod.start", "flor")", "flor",
     "did you mean 'floor'?"},
    {"Circle", "double_pendulum", R"([0, "-L1"]], )", R"([0, "-L1"]], at = "lower.end", )", "upper", "in a circle"},
    {"TwoShapes", "box_dropped_flat", R"(box = ["w", "h"],)", R"(box = ["w", "h"], disc = "h",)", R"(["w", "h"])",
     "two shapes"},
    {"CenterWithoutInertia", "slider_crank_clearance", "inertia = 7.4e-5, ", "", R"(["l1/2", 0])", "add inertia"},
    {"CoordinateWithoutMass", "ball_on_sine", R"(at = ["x", "y"])", R"(at = ["x", 0])", "y\", start", "M is singular"},
    {"NegativeMass", "ball_on_sine", R"(mass = "m")", R"(mass = "-m")", "-m", "must not be negative"},
    {"NegativeRadius", "newtons_cradle", R"(disc = "r", at = "thread1)", R"(disc = "-r", at = "thread1)", "-r",
     "must be positive"},
    {"MissingRest", "kneed_leg", R"(, rest = "z0 + weight/k")", "", "{between", "write rest = 0"},
    {"Penetration", "falling_rod", "start = 0.53", "start = 0.4", R"(["rod.start")", "swap its ends?"},
    {"WholeBox", "box_dropped_flat", R"("box.lower_left")", R"("box")", "box", "name a corner"},
    {"NothingToTouch", "box_dropped_flat", R"("box.lower_left", "floor")", R"("box.lower_left", "box.center")",
     "box.center", "nothing that can be touched"},
    {"OneBody", "kneed_leg", R"(["world.below", "hip"], stiffness)", R"(["hip", "hip.center"], stiffness)", R"(["hip")",
     "both ends are on one body"},
    {"DiscOnCurve", "ball_on_sine", R"(mass = "m", )", R"(mass = "m", disc = 0.1, )", R"(["ball", "hills"])",
     "along the curve"},
    {"GapWithoutCoordinate", "box_dropped_flat", R"(["box.lower_left", "floor"])", R"([[0, 1], "floor"])", "[[0, 1]",
     "depends on no coordinate"},
    {"TimeInM", "double_pendulum", R"(angle = "theta1"})", R"(angle = "theta1 + theta1*t"})", "{name = \"upper\"",
     "depends on t"},
    {"PointAsNumber", "double_pendulum", R"(gap = "theta2")", R"(gap = "theta2 + upper.end")", "upper.end",
     "a number is needed here"},
    {"KineticBesidesBodies", "falling_rod", "run = {", "lagrangian = {kinetic = \"x'^2\"}\nrun = {", "\"x'^2\"",
     "derived from the bodies"},
    {"ClosedLoop", "double_pendulum", R"(gap = "theta2", )", R"(between = ["lower.end", "world"], )", "world\"",
     "choose coordinates that close the loop"},
    {"Joint", "double_pendulum", "run = {", "joint = [{body = \"upper\"}]\nrun = {", "joint", "no joints"},
    {"GravityAlone", "falling_rod", R"(gravity = [0, "-g"])", R"(gravity = "-g")", "\"-g\"", R"(gravity = [0, "-g"])"},
    {"UnknownShape", "double_pendulum", "rod = [[0, 0], [0, \"-L2\"]]", "bar = [[0, 0], [0, \"-L2\"]]", "bar",
     "unknown key 'bar'"},
    {"WordOfAnotherProgram", "double_pendulum", R"(mass = "m1")", R"(m = "m1")", "m = ", "did you mean 'mass'?"},
};

class MechanismFiles : public testing::TestWithParam<FileMistake> {};

TEST_P(MechanismFiles, AreRefusedWithTheCaretAtTheMistake) {
    const FileMistake& one = GetParam();
    std::string text = content(ACHILLES_SOURCE_DIR "/tests/reference/mechanisms/" + std::string(one.file) + ".toml");
    const std::size_t at = text.find(one.from);
    ASSERT_NE(at, text.npos);
    text.replace(at, std::string(one.from).size(), one.to);
    const Folder folder;
    folder.put("f.toml", text);
    for (const char* command : {"check f.toml --expand", "simulate f.toml --json out.json --csv out.csv",
                                "prove f.toml --json out.json", "figure f.toml --out out.svg"}) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 2) << command << "\n" << answer.err;
        EXPECT_EQ(answer.out, "") << command;
        EXPECT_EQ(folder.files().size(), 1U) << command << " leaves a file";
        EXPECT_NE(answer.err.find(one.message), std::string::npos) << answer.err;
        std::smatch place;
        ASSERT_TRUE(std::regex_search(answer.err, place, std::regex("f\\.toml:(\\d+):(\\d+): "))) << answer.err;
        std::istringstream file(text);
        std::string line;
        for (int i = 0; i < std::stoi(place[1]); ++i) std::getline(file, line);
        EXPECT_EQ(line.substr(std::stoul(place[2]) - 1).find(one.caret), 0U) << answer.err;
        // The printed line, which may be a part of the file's, has the same text over the caret.
        std::istringstream message(answer.err);
        std::string shown, previous;
        while (std::getline(message, shown) && shown.find_first_not_of(' ') != shown.rfind('^')) previous = shown;
        EXPECT_EQ(previous.substr(shown.find('^')).find(std::string(one.caret).substr(0, 3)), 0U) << answer.err;
    }
}

// Names of bodies in options: values, their units, derivatives, and what is told of a wrong name.
TEST(NamesOfBodies, AreKnownToSweeps) {
    const Folder folder;
    folder.put("arm.toml", R"(coordinate = [{name = "theta", start = 0.5, unit = "rad"}]
parameter = [{name = "L", value = 2, unit = "m"}]
body = [{name = "arm", mass = 1, rod = [[0, 0], ["L", 0]], angle = "theta"}]
constraint = [{gap = "theta", restitution = 0.5}]
run = {end_time = 1}
)");
    const std::string sweep = "sweep arm.toml --over L=1:3:3 --csv - --print ";
    const Answer values = folder.run(sweep + "arm.end.x --print \"d(arm.end.y, theta)\"");
    EXPECT_EQ(values.status, 0) << values.err;
    std::istringstream lines(values.out);
    std::string line;
    std::getline(lines, line);
    EXPECT_NE(line.find("arm.end.x"), std::string::npos) << line;
    for (const double length : {1.0, 2.0, 3.0}) {
        ASSERT_TRUE(std::getline(lines, line));
        double L = 0.0, x = 0.0, slope = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &L, &x, &slope), 3) << line;
        EXPECT_EQ(L, length);
        EXPECT_NEAR(x, length * std::cos(0.5), 1e-12);
        EXPECT_NEAR(slope, length * std::cos(0.5), 1e-9);
    }
    for (const auto& [print, message] :
         {std::pair{"am.end.x", "--print am.end.x: unknown body or ground 'am'; did you mean 'arm'?"},
          {"arm.tip.x", "unknown point 'tip' of 'arm'"},
          {"arm", "'arm' is a body, and a number is needed here"},
          {"arm.end", "write arm.end.x or arm.end.y"},
          {"1+arm.end.z", "write arm.end.x or arm.end.y"}}) {
        const Answer wrong = folder.run(sweep + print);
        EXPECT_EQ(wrong.status, 2) << print;
        EXPECT_NE(wrong.err.find(message), std::string::npos) << wrong.err;
        EXPECT_NE(wrong.err.find('^'), std::string::npos) << wrong.err;
    }
    EXPECT_EQ(folder.run("sweep arm.toml --over L=1:3:3 --print t --at \"arm.end.x - 1\"").status, 0);
}

INSTANTIATE_TEST_SUITE_P(OneAtATime, MechanismFiles, testing::ValuesIn(file_mistakes),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace achilles::test
