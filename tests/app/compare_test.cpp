// `achilles compare`: two pictures or two folders, status, sentence, JSON and the picture of the difference.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "image/comparison.hpp"

namespace achilles::test {
namespace {

namespace fs = std::filesystem;

class Compare : public testing::Test {
 protected:
    // A gray picture, with some pixels changed.
    void put(
        const std::string& name, int width = 90, int height = 60,
        const std::function<void(Image&)>& change = [](Image&) {}) const {
        Image image{width, height, {}};
        image.rgb.assign(static_cast<std::size_t>(3 * width * height), 200);
        change(image);
        fs::create_directories((folder_.path() / name).parent_path());
        write_png(image, folder_.path() / name);
    }
    // 16 pixels of one channel, in one tile of 10 pixels: 16 * 100 / (255 * 100), the score 7.8431.
    static void spot(Image& image) {
        for (std::size_t y = 42; y < 50; ++y)
            for (std::size_t x = 37; x < 39; ++x) image.rgb[3 * (90 * y + x) + 1] = 100;
    }
    Image read(const std::string& name) const { return read_png(folder_.path() / name); }
    Folder folder_;
};

TEST_F(Compare, SaysTheMeasureTheThresholdAndThePlace) {
    put("a.png");
    put("b.png", 90, 60, spot);
    const Answer same = folder_.run("compare a.png a.png");
    EXPECT_EQ(same.status, 0);
    EXPECT_EQ(same.out, "a.png and a.png are the same: difference 0, threshold 1\n");
    EXPECT_EQ(same.err, "");
    const Answer other = folder_.run("compare a.png b.png");
    EXPECT_EQ(other.status, 1);
    EXPECT_EQ(other.out,
              "a.png and b.png differ: difference 7.84, threshold 1, worst in the 10-pixel tile at (30, 40)\n");
    EXPECT_EQ(other.err, "");
    EXPECT_EQ(folder_.run("compare a.png b.png --threshold 8").status, 0);
    EXPECT_EQ(folder_.run("compare a.png b.png --threshold 7.844").status, 0);
    // Here three digits would not show which of the two is larger.
    const Answer close = folder_.run("compare a.png b.png --threshold 7.842");
    EXPECT_EQ(close.status, 1);
    EXPECT_EQ(close.out.find("a.png and b.png differ: difference 7.84313"), 0U) << close.out;
    EXPECT_EQ(folder_.run("compare a.png a.png --threshold 0").status, 0);
}

TEST_F(Compare, WritesTenTimesTheDifference) {
    put("a.png");
    put("b.png", 90, 60, spot);
    const Answer answer = folder_.run("compare a.png b.png --out d.png");
    EXPECT_EQ(answer.status, 1);
    const Image difference = read("d.png");
    EXPECT_EQ(difference.width, 90);
    const auto green = [&](std::size_t x, std::size_t y) { return int{difference.rgb[3 * (90 * y + x) + 1]}; };
    EXPECT_EQ(green(37, 42), 255);
    EXPECT_EQ(green(36, 42), 0);
    EXPECT_EQ(difference.rgb[3 * (90 * 42 + 37)], 0);
    EXPECT_EQ(folder_.run("compare a.png b.png --out a.png").status, 2);
    EXPECT_EQ(folder_.run("compare a.png a.png --out same.png").status, 0);
    EXPECT_EQ(read("same.png").rgb, std::vector<std::uint8_t>(3 * 90 * 60, 0));
}

TEST_F(Compare, AnotherSizeIsADifference) {
    put("a.png");
    put("b.png", 60, 80);
    const Answer answer = folder_.run("compare a.png b.png --threshold 1e9 --out d.png");
    EXPECT_EQ(answer.status, 1);
    EXPECT_EQ(answer.out, "a.png and b.png differ: 90 x 60 and 60 x 80 pixels\n");
    const Image difference = read("d.png");
    EXPECT_EQ(difference.width, 90);
    EXPECT_EQ(difference.height, 80);
    EXPECT_EQ(difference.rgb.front(), 0);    // both have this pixel, with the same color
    EXPECT_EQ(difference.rgb[3 * 60], 255);  // only the first has it
    EXPECT_EQ(difference.rgb.back(), 255);
}

TEST_F(Compare, TransparencyIsADifferenceThatIsSeen) {
    const auto with_alpha = [](std::uint8_t alpha, std::uint8_t color) {
        return [=](Image& image) {
            image.alpha.assign(90 * 60, 255);
            for (std::size_t i = 0; i < 400; ++i) image.alpha[i] = alpha, image.rgb[3 * i] = color;
        };
    };
    put("opaque.png");
    put("holes.png", 90, 60, with_alpha(0, 200));
    put("other_holes.png", 90, 60, with_alpha(0, 7));
    EXPECT_EQ(read("holes.png").alpha[0], 0);
    EXPECT_TRUE(read("opaque.png").alpha.empty());
    EXPECT_EQ(folder_.run("compare opaque.png holes.png").status, 1);
    EXPECT_EQ(folder_.run("compare holes.png opaque.png --out d.png").status, 1);
    EXPECT_EQ(read("d.png").rgb[0], 255);
    EXPECT_EQ(folder_.run("compare holes.png other_holes.png --threshold 0").status, 0)
        << "the color of an invisible pixel does not count";
}

TEST_F(Compare, FoldersAreComparedByName) {
    put("before/same.png");
    put("after/same.png");
    put("before/kind/spot.png");
    put("after/kind/spot.png", 90, 60, spot);
    put("before/gone.png");
    put("after/kind/new.png", 30, 30);
    folder_.put("after/notes.txt", "no picture");
    const Answer answer = folder_.run("compare before after --out d --json result.json");
    EXPECT_EQ(answer.status, 1);
    EXPECT_EQ(answer.out,
              "before and after differ in 3 of 4 pictures\n"
              "  gone.png: only in before\n"
              "  kind/new.png: only in after\n"
              "  kind/spot.png: difference 7.84, threshold 1, worst in the 10-pixel tile at (30, 40)\n");
    EXPECT_EQ(read("d/kind/spot.png").rgb[3 * (90 * 42 + 37) + 1], 255);
    EXPECT_EQ(read("d/kind/new.png").width, 30);
    EXPECT_EQ(read("d/gone.png").rgb[0], 255);
    EXPECT_FALSE(fs::exists(folder_.path() / "d/same.png"));
    const nlohmann::json result = nlohmann::json::parse(content(folder_.path() / "result.json"));
    EXPECT_EQ(result["same"], false);
    EXPECT_EQ(result["threshold"], 1.0);
    ASSERT_EQ(result["pictures"].size(), 4U);
    EXPECT_EQ(result["pictures"][0]["name"], "gone.png");
    EXPECT_EQ(result["pictures"][0]["mismatch"], "only in before");
    EXPECT_TRUE(result["pictures"][0]["difference"].is_null());
    EXPECT_NEAR(result["pictures"][2]["difference"].get<double>(), 7.8431, 1e-4);
    EXPECT_EQ(result["pictures"][2]["worst_tile"], (nlohmann::json{{"left", 30}, {"top", 40}, {"size", 10}}));
    EXPECT_EQ(result["pictures"][3]["same"], true);
    const Answer again = folder_.run("compare before after --out d");
    EXPECT_EQ(again.status, 2);
    EXPECT_EQ(again.err, "d: this folder is not empty\nname a new folder\n");
    fs::remove(folder_.path() / "before/gone.png");
    fs::remove(folder_.path() / "after/kind/new.png");
    const Answer mild = folder_.run("compare before after --threshold 10 --json -");
    EXPECT_EQ(mild.status, 0);
    EXPECT_EQ(nlohmann::json::parse(mild.out)["same"], true);
    EXPECT_EQ(mild.err,
              "before and after have the same 2 pictures: largest difference in kind/spot.png: difference 7.84, "
              "threshold 10, worst in the 10-pixel tile at (30, 40)\n");
}

TEST_F(Compare, AFileThatCannotBeReadIsNoDifference) {
    put("before/a.png");
    put("after/a.png");
    put("a.png");
    folder_.put("after/b.png", "no picture");
    folder_.put("before/b.png", "no picture");
    const Answer broken = folder_.run("compare before after --out d");
    EXPECT_EQ(broken.status, 2);
    EXPECT_NE(broken.err.find("before/b.png: is not a readable PNG file"), std::string::npos) << broken.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "d"));
    const Answer none = folder_.run("compare a.png none.png");
    EXPECT_EQ(none.status, 2);
    EXPECT_EQ(none.err, "achilles: none.png: No such file or directory\n");
    EXPECT_EQ(folder_.run("compare a.png before").status, 2);
}

// The pictures of one run are the same, those of another restitution are not.
TEST_F(Compare, SeesWhatTheProgramDraws) {
    for (const char* line : {"a.png", "b.png", "c.png --set e=0.51"})
        ASSERT_EQ(folder_.run(std::string("figure ball_on_sine --view height --size 400x300 --out ") + line).status, 0);
    EXPECT_EQ(folder_.run("compare a.png b.png --threshold 0").status, 0);
    EXPECT_EQ(folder_.run("compare a.png c.png").status, 1);
}

}  // namespace
}  // namespace achilles::test
