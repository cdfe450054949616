// Compares every picture with its golden files.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/program.hpp"
#include "golden/comparer.hpp"
#include "golden/pictures.hpp"
#include "image/comparison.hpp"

namespace achilles::golden {

void PrintTo(const GoldenPicture& picture, std::ostream* out) { *out << picture.name; }

namespace {

class Golden : public testing::TestWithParam<GoldenPicture> {};

TEST_P(Golden, IsAsItWas) {
    for (const Finding& finding : check(GetParam(), place()))
        ADD_FAILURE() << GetParam().name << "/" << finding.file << ": " << finding.what << how_to_bless << "\n"
                      << (place().report / "index.html").string() << " shows both";
}

std::string test_name(const testing::TestParamInfo<GoldenPicture>& one) {
    std::string name = one.param.name;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
}
INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(pictures()), test_name);

TEST(Goldens, EveryGoldenFileBelongsToAPicture) {
    for (const std::filesystem::path& file : orphans(pictures(), place()))
        ADD_FAILURE() << file.string() << " belongs to no picture; tests/run --bless removes it";
}

// Also for a system that was added after the tests above were listed.
TEST(Goldens, EveryPictureHasGoldenFiles) {
    for (const GoldenPicture& picture : pictures())
        EXPECT_TRUE(std::filesystem::is_directory(place().goldens / picture.name))
            << picture.name << " has no golden files yet; " << how_to_bless;
}

TEST(Goldens, EverySystemAndJournalHasAPicture) {
    std::set<std::string> names;
    for (const GoldenPicture& picture : pictures()) names.insert(picture.name);
    std::size_t files = 0;
    for (const auto& [folder, kind] :
         {std::pair{"assets/systems", "figure"}, std::pair{"assets/journals", "tour"},
          std::pair{"tests/golden/explorer", "explorer"}, std::pair{"tests/golden/frame", "frame"},
          std::pair{"tests/golden/sweep", "sweep"}, std::pair{"tests/golden/proof", "proof"}}) {
        const std::filesystem::path where = std::filesystem::path(ACHILLES_SOURCE_DIR) / folder;
        if (!std::filesystem::exists(where)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(where)) {
            if (!entry.is_regular_file() || entry.path().extension() == ".png") continue;
            EXPECT_TRUE(names.contains(std::string(kind) + "/" + entry.path().stem().string())) << entry.path();
            ++files;
        }
    }
    EXPECT_GE(files, 16U);
    EXPECT_EQ(names.size(), files + 1) << "and the paper";
}

// Tests of check() and bless() with a picture made here.
class GoldenStore : public testing::Test {
 protected:
    GoldenStore() : where{folder.path() / "goldens", folder.path() / "report"} {
        std::filesystem::create_directories(where.goldens);
    }
    GoldenPicture picture(const std::string& text, int gray, const std::string& name = "kind/one") const {
        return {name, [=] {
                    Image image{60, 40, {}};
                    image.rgb.assign(std::size_t{60 * 40 * 3}, static_cast<std::uint8_t>(gray));
                    return std::vector<Layer>{{"trajectory.txt", text}, {"picture.png", image}};
                }};
    }
    std::string page() const { return test::content(where.report / "index.html"); }

    test::Folder folder;
    GoldenFolders where;
};

TEST_F(GoldenStore, AMissingGoldenFailsUntilItIsBlessed) {
    const std::vector<Finding> findings = check(picture("t 1\n", 100), where);
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0].file, "trajectory.txt");
    EXPECT_EQ(findings[0].what, "there is no golden file yet\n");
    EXPECT_NE(std::string(how_to_bless).find("tests/run --bless"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(where.goldens)) << "a test writes no golden files";
    EXPECT_EQ(bless(picture("t 1\n", 100), where),
              (std::vector<std::string>{"kind/one/trajectory.txt: there is no golden file yet\n",
                                        "kind/one/picture.png: there is no golden file yet\n"}));
    EXPECT_TRUE(check(picture("t 1\n", 100), where).empty());
    EXPECT_TRUE(bless(picture("t 1\n", 100), where).empty());
}

TEST_F(GoldenStore, TextIsToldBeforePixelsAndThePageShowsTheWorstFirst) {
    for (const char* name : {"kind/one", "kind/two"}) bless(picture("t 1\nu 2\n", 100, name), where);
    const std::vector<Finding> findings = check(picture("t 1\nu 3\n", 110), where);
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0].what, "line 2: 1 of the golden lines, 1 of the new ones\n- u 2\n+ u 3\n");
    EXPECT_EQ(findings[1].what, "7.84 times what is allowed, worst at (0, 0); coarse 0.0392, fine 0.0392\n");
    check(picture("t 1\nu 2\n", 200, "kind/two"), where);
    for (const char* file : {"actual.png", "golden.png", "difference.png"})
        EXPECT_TRUE(std::filesystem::exists(where.report / "kind/one" / (std::string("picture.") + file))) << file;
    EXPECT_EQ(read_png(where.report / "kind/one/picture.difference.png").rgb[0], 100);
    EXPECT_EQ(test::content(where.report / "kind/one/trajectory.actual.txt"), "t 1\nu 3\n");
    const std::size_t one = page().find("<h2>kind/one"), two = page().find("<h2>kind/two");
    EXPECT_LT(two, one);
    EXPECT_NE(one, std::string::npos) << page();
    EXPECT_NE(page().find("src=\"kind/one/picture.difference.png\""), std::string::npos);
    EXPECT_TRUE(check(picture("t 1\nu 2\n", 200, "kind/two"), where).size() == 1);
    EXPECT_TRUE(check(picture("t 1\nu 2\n", 100, "kind/two"), where).empty());
    EXPECT_EQ(page().find("kind/two"), std::string::npos) << "what is right again is forgotten";
    EXPECT_TRUE(check(picture("t 1\nu 2\n", 100), where).empty());
    EXPECT_FALSE(std::filesystem::exists(where.report / "index.html"));
}

TEST_F(GoldenStore, AnotherSizeAndALostFileAreTold) {
    bless(picture("t 1\n", 100), where);
    GoldenPicture other = picture("t 1\n", 100);
    other.make = [] { return std::vector<Layer>{{"picture.png", Image{1, 2, std::vector<std::uint8_t>(6, 100)}}}; };
    const std::vector<Finding> findings = check(other, where);
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0].what, "1 x 2 pixels, not 60 x 40\n");
    EXPECT_EQ(findings[1].file + ": " + findings[1].what, "trajectory.txt: nothing makes this any more\n");
    bless(other, where);
    EXPECT_FALSE(std::filesystem::exists(where.goldens / "kind/one/trajectory.txt"));
    EXPECT_TRUE(check(other, where).empty());
}

TEST_F(GoldenStore, AnOrphanIsFound) {
    bless(picture("t 1\n", 100), where);
    bless(picture("t 1\n", 100, "kind/gone"), where);
    std::ofstream(where.goldens / "CMakeLists.txt") << "the machinery's own";
    std::ofstream(where.goldens / "kind/one.journal") << "what a picture is made from";
    EXPECT_EQ(orphans({picture("", 0)}, where),
              (std::vector<std::filesystem::path>{where.goldens / "kind/gone/picture.png",
                                                  where.goldens / "kind/gone/trajectory.txt"}));
}

TEST(ImageDistance, SeesASmallChangeOfOneChannelByTheFineBarAlone) {
    Image before{90, 60, std::vector<std::uint8_t>(std::size_t{3 * 90 * 60}, 200)}, after = before;
    for (std::size_t y = 42; y < 50; ++y)
        for (std::size_t x = 37; x < 39; ++x) after.rgb[3 * (90 * y + x) + 1] = 100;
    const ImageDistance apart = distance(before, after);
    EXPECT_DOUBLE_EQ(apart.fine, 16.0 * 100.0 / (255.0 * 100.0));
    EXPECT_DOUBLE_EQ(apart.coarse, 16.0 * 100.0 / (3.0 * 255.0 * 900.0));
    EXPECT_LT(apart.coarse, worst_tile_allowed);
    EXPECT_DOUBLE_EQ(apart.score(), apart.fine / worst_fine_tile_allowed);
    EXPECT_EQ(apart.left, 30);
    EXPECT_EQ(apart.top, 40);
    EXPECT_EQ(distance(after, before).score(), apart.score());
    EXPECT_EQ(distance(before, before).score(), 0.0);
    EXPECT_TRUE(std::isinf(distance(before, Image{60, 90, before.rgb}).score()));
}

TEST(TextDifference, AllowsAUnitInTheNinthDigitOfNumbersAlone) {
    EXPECT_EQ(difference("t 1.23456789 (2e-17, -0.5)\n", "t 1.2345679 (-3e-17, -0.5)\n"), "");
    EXPECT_EQ(difference("t 9.87654321\n", "t 9.87654323\n"),
              "line 1: 1 of the golden lines, 1 of the new ones\n- t 9.87654321\n+ t 9.87654323\n");
    for (const auto& [golden, actual] : {std::pair{"points 12", "points 13"}, std::pair{"#0072b2ff", "#0072b3ff"},
                                         std::pair{"#10000000ff", "#10000000.0ff"}, std::pair{"x1.0", "x1"},
                                         std::pair{"a b", "a"}, std::pair{"", "a"}, std::pair{"1 2", "1 2 3"}})
        EXPECT_NE(difference(golden, actual), "") << golden;
}

TEST(TextDifference, ShowsALineMoreAsOneLine) {
    EXPECT_EQ(difference("a\nb\nc\n", "a\nnew\nb\nc\n"), "line 2: 0 of the golden lines, 1 of the new ones\n+ new\n");
    const std::string far(500, 'x');
    const std::string told = difference(far + " 1" + far, far + " 2" + far);
    EXPECT_NE(told.find("x 1x"), std::string::npos) << told;
    EXPECT_LT(told.size(), 500U);
}

}  // namespace

}  // namespace achilles::golden
