// The page of a run. tests/python/test_page.py compares its numbers with the run.
#include "pictures/player.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/systems.hpp"
#include "output/output.hpp"
#include "pictures/picture_job.hpp"
#include "pictures/player_drawings.hpp"

namespace achilles {
namespace {

std::string page_of(const std::shared_ptr<const Model>& model) {
    const Trajectory trajectory = simulate(model, model->default_run());
    const ErrorEstimate estimate = estimate_error(trajectory);
    return player_page(trajectory, estimate, views_of(model->description(), {}),
                       {answer(trajectory, estimate, "achilles prove 'x'"), player_command(trajectory, "x.toml", {})});
}

std::string data_of(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"run\">";
    const std::size_t first = page.find(begin) + begin.size();
    return page.substr(first, page.find("</script>", first) - first);
}

TEST(PlayerPage, EscapesTexts) {
    EXPECT_EQ(html_escaped("<a href='x' title=\"y\">&amp;\x01</a>"),
              "&lt;a href=&#39;x&#39; title=&quot;y&quot;&gt;&amp;amp;?&lt;/a&gt;");
    EXPECT_EQ(json_text("</script><!-- \"\\\n&"), "\"\\u003c/script\\u003e\\u003c!-- \\u0022\\u005c\\u000a\\u0026\"");
    EXPECT_EQ(nlohmann::json::parse(json_text("</script>\t\"\\ \u00e4")).get<std::string>(), "</script>\t\"\\ \u00e4");
}

TEST(PlayerPage, TakesTextsOfASystemAsTexts) {
    std::string text = test::load("ball_on_floor")->description().source_text;
    const std::string hostile = "</script><script>alert(1)</script>";
    text.insert(text.find("title = \"") + 9, hostile);
    text.insert(text.find("drawing = [") + 11, "{shape = \"text\", at = [\"0\", \"y\"], text = \"" + hostile + "\"},");
    const std::string page = page_of(test::typed(text));
    EXPECT_EQ(page.find(hostile), std::string::npos);
    const auto count = [&](const std::string& words) {
        std::size_t number = 0;
        for (std::size_t at = page.find(words); at != std::string::npos; at = page.find(words, at + 1)) ++number;
        return number;
    };
    EXPECT_EQ(count("<script"), 2U);
    EXPECT_EQ(count("</script"), 2U);
    EXPECT_EQ(count("&lt;/script&gt;&lt;script&gt;alert(1)"), 2U);  // title and heading
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST(PlayerPage, IsTheSameEachTimeAndSmall) {
    const auto ball = test::load("ball_on_sine");
    const std::string page = page_of(ball);
    EXPECT_EQ(page, page_of(ball));
    EXPECT_LT(page.size(), 500'000U);
    const auto data = nlohmann::json::parse(data_of(page));
    EXPECT_EQ(data["clips"].front()["t"].front(), 0.0);
    EXPECT_EQ(data["clips"].back()["t"].back(), 20.0);
    // The trail is drawn with the time of each of its points.
    ASSERT_FALSE(data["trail"].empty());
    for (const auto& line : data["trail"]) EXPECT_EQ(2 * line["t"].size(), line["numbers"].size());
}

}  // namespace
}  // namespace achilles
