// Several [[constraint]] entries: reading, names, drawings, and error messages with their location.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

using test::changed, test::good, test::told_by_reading;

const std::string only_one = "[[constraint]]\ngap = \"x - sin(theta)/9\"\nrestitution = \"e\"\n";
const std::string knee = "[[constraint]]\nname = \"knee\"\ngap = \"x - sin(theta)/9\"\nrestitution = \"e\"\n";
const std::string wall = "[[constraint]]\nname = \"wall\"\ngap = \"theta + 2\"\nrestitution = 0\n";

// The valid text with these constraints in place of its own.
std::string with_constraints(const std::string& constraints) {
    return changed(good, {{only_one, constraints}, {"gap'", "gap_knee'"}});
}

TEST(Constraints, OneNeedsNoName) {
    const SystemDescription system = parse_system(good);
    ASSERT_EQ(system.constraints.size(), 1u);
    EXPECT_EQ(system.constraints[0].name, "contact");
    EXPECT_EQ(system.constraints[0].at.line, 17);
    EXPECT_EQ(parse_system(changed(good, {{only_one, knee}})).constraints[0].name, "knee");
}

TEST(Constraints, SeveralAreRead) {
    const SystemDescription system = parse_system(with_constraints(knee + wall));
    ASSERT_EQ(system.constraints.size(), 2u);
    EXPECT_EQ(system.constraints[0].name, "knee");
    EXPECT_EQ(system.constraints[0].restitution.text, "e");
    EXPECT_EQ(system.constraints[1].name, "wall");
    EXPECT_EQ(system.constraints[1].gap.text, "theta + 2");
    EXPECT_EQ(system.constraints[1].at.line, 21);
    EXPECT_EQ(system.parameters[1].range, (std::array{0.0, 1.0}));  // a restitution
}

TEST(Constraints, OfSeveralEveryGapIsPlotted) {
    const std::string views = "[[view]]\nname = \"path\"\nx = \"x\"\ny = [\"gap_knee'\"]\n";
    const SystemDescription system = parse_system(changed(with_constraints(knee + wall), {{views, ""}}));
    ASSERT_EQ(system.views.size(), 5u);
    EXPECT_EQ(system.views[2].name, "gap_knee");
    EXPECT_EQ(system.views[3].y[0].text, "gap_wall");
    EXPECT_EQ(told_by_reading(changed(with_constraints(knee + wall),
                                      {{"\"gap_knee'\"", "\"lambda_wall\", \"gap_knee''\", \"gap_wall'\""}})),
              "");
}

TEST(Constraints, HaveDrawingsOfTheirOwn) {
    const std::string drawn =
        "[[constraint.drawing]]\nshape = \"segment\"\nfrom = [0, 0]\nto = [\"x\", 1]\n"
        "[[constraint.drawing]]\nshape = \"disc\"\nat = [0, 0]\nradius = \"m\"\n";
    const SystemDescription system = parse_system(with_constraints(knee + drawn + wall));
    ASSERT_EQ(system.constraints[0].drawings.size(), 2u);
    EXPECT_EQ(system.constraints[0].drawings[1].radius.text, "m");
    EXPECT_TRUE(system.constraints[1].drawings.empty());
    EXPECT_EQ(system.drawings.size(), 1u);
    const std::vector<DrawingDescription> all = drawings_of(system);
    ASSERT_EQ(all.size(), 3u);  // in the order of the file
    EXPECT_EQ(all[0].shape, DrawingDescription::Shape::segment);
    EXPECT_EQ(all[2].shape, DrawingDescription::Shape::curve);
    EXPECT_EQ(all[0].contact, std::size_t{0});  // highlighted while this contact is held
    EXPECT_FALSE(all[2].contact);
    EXPECT_EQ(told_by_reading(with_constraints(knee + changed(drawn, {{"\"x\"", "\"z\""}}) + wall)),
              "f.toml:24:8: unknown name 'z'\n    to = [\"z\", 1]\n           ^");
    EXPECT_EQ(told_by_reading(with_constraints(knee + changed(drawn, {{"radius", "raduis"}}) + wall)),
              "f.toml:28:1: unknown key 'raduis' in [[drawing]] of shape disc; did you mean 'radius'?\n    raduis = "
              "\"m\"\n    ^\nknown keys: shape, on, color, width, fill, at, radius");
}

std::string sixteen_and(int more) {
    std::string all = knee;
    for (int i = 1; i < 16 + more; ++i)
        all += "[[constraint]]\nname = \"c" + std::to_string(i) + "\"\ngap = \"x + " + std::to_string(i) +
               "\"\nrestitution = 0\n";
    return with_constraints(all);
}

TEST(Constraints, AreAtMostSixteen) {
    EXPECT_EQ(told_by_reading(sixteen_and(0)), "");
    EXPECT_EQ(parse_system(sixteen_and(0)).constraints.size(), 16u);
    EXPECT_EQ(told_by_reading(sixteen_and(2)), "f.toml:81:1: more than 16 [[constraint]]\n    [[constraint]]\n    ^");
}

TEST(Constraints, OfSeveralEachNeedsANameOfItsOwn) {
    const std::string no_name = changed(wall, {{"name = \"wall\"\n", ""}});
    EXPECT_EQ(told_by_reading(with_constraints(knee + no_name)),
              "f.toml:21:1: missing key 'name' in [[constraint]]\n    [[constraint]]\n    ^\nwith several constraints "
              "each needs its own name");
    EXPECT_EQ(told_by_reading(with_constraints(knee + changed(wall, {{"wall", "knee"}}))),
              "f.toml:22:9: the name 'knee' is used twice\n    name = \"knee\"\n            ^\nit is already the name "
              "at line 18");
    EXPECT_EQ(told_by_reading(with_constraints(knee + changed(wall, {{"wall", "the wall"}}))),
              "f.toml:22:9: 'the wall' is not a name\n    name = \"the wall\"\n            ^\na name is a letter "
              "followed by letters, digits and underscores");
    EXPECT_EQ(told_by_reading(changed(good, {{only_one, changed(knee, {{"knee", "2"}})}})).substr(0, 25),
              "f.toml:18:9: '2' is not a");
}

TEST(Constraints, OfSeveralAPlainGapIsOfNone) {
    EXPECT_EQ(told_by_reading(changed(with_constraints(knee + wall), {{"gap_knee'", "gap''"}})),
              "f.toml:36:7: gap'' is ambiguous with several constraints: gap_knee'', gap_wall''\n    y = [\"gap''\"]\n "
              "         ^");
    EXPECT_EQ(told_by_reading(changed(with_constraints(knee + wall), {{"gap_knee'", "gap_kne"}})),
              "f.toml:36:7: unknown name 'gap_kne'; did you mean 'gap_knee'?\n    y = [\"gap_kne\"]\n          ^");
    EXPECT_EQ(
        told_by_reading(changed(with_constraints(knee + wall), {{"\"m*x\"", "\"m*gap_wall\""}})),
        "f.toml:16:16: 'gap_wall' is allowed only in a [[view]]\n    potential = \"m*gap_wall\"\n                   ^");
}

TEST(Constraints, OfSeveralHaveNamesForTheirGapsAndForces) {
    const std::vector<std::pair<std::string, std::string>> renamed{
        {"name = \"m\"", "name = \"gap_m\""}, {"m/2", "gap_m/2"}, {"\"m*x\"", "\"gap_m*x\""}};
    EXPECT_EQ(told_by_reading(changed(good, renamed)), "") << "of one gap it is free";
    EXPECT_EQ(told_by_reading(changed(with_constraints(knee + wall), renamed)),
              "f.toml:9:9: the name 'gap_m' is reserved\n    name = \"gap_m\"\n            ^\nwith several constraints "
              "gap_NAME and lambda_NAME are reserved: choose another name");
}

}  // namespace
}  // namespace achilles
