// Pictures with a size in millimeters and points.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "app/open.hpp"
#include "app/program.hpp"
#include "cli/inputs.hpp"
#include "journal/journal.hpp"
#include "pictures/export.hpp"
#include "pictures/picture_format.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

TEST(Page, IsAsLargeAsItSays) {
    const PictureSize png = on_page({85.0, 0.0, 8.0, 300.0}, "png", 14.0, 1.5);
    EXPECT_EQ(png.width, 1004);  // 85/25.4*300
    EXPECT_EQ(png.height, 669);
    EXPECT_NEAR(14.0 * png.scale, 8.0 / 72.0 * 300.0, 1e-9);  // 8 pt in pixels
    const PictureSize svg = on_page({170.0, 100.0, 10.0, 0.0}, "svg", 14.0, 1.5);
    EXPECT_EQ(svg.width, 1200);
    EXPECT_NEAR(14.0 * svg.scale * 170.0 / 1200.0, 10.0 / 72.0 * 25.4, 1e-9);  // 10 pt in mm
    EXPECT_EQ(size_text({85.0, 0.0, 8.0, 300.0}, "png", 1.5), "85 \u00d7 56.67 mm, 1004 \u00d7 669 px at 300 dpi");
    for (const PaperSize& wrong :
         {PaperSize{5.0, 0.0, 0.0, 0.0}, PaperSize{85.0, 0.0, 100.0, 0.0}, PaperSize{0.0, 0.0, 8.0, 0.0},
          PaperSize{85.0, 0.0, 0.0, 5.0}, PaperSize{85.0, 3.0, 0.0, 0.0}, PaperSize{NAN, 0.0, 0.0, 0.0}})
        EXPECT_THROW(check(wrong, ""), InputError) << wrong.width;
    EXPECT_THROW(on_page({1200.0, 0.0, 8.0, 1200.0}, "png", 14.0, 1.5), InputError);
}

// On such a page the plots determine the height after their curves are sampled: sampling must not assume a lower page.
TEST(Page, IsResolvedWhateverHeightItsPlotsNeed) {
    const PaperSize page{85.0, 0.0, 8.0, 300.0};
    const Resolution known = resolution_of(page, {}, "png");
    for (const int plots : {1, 2, 6, 12})
        for (const int columns : {1, 2, 3})
            EXPECT_GE(known.height, on_page(page, "png", 1.0, shape_of(plots, columns)).height) << plots << columns;
    EXPECT_EQ(resolution_of({85.0, 30.0, 8.0, 300.0}, {}, "png").height, 354.0);
}

// The size stored in the file, which typesetting programs read.
TEST(Page, IsSaidByTheFile) {
    const test::Folder folder;
    const std::string words = "figure ball_on_sine --view height --width-mm 85 --font-pt 9 --out ";
    ASSERT_EQ(folder.run(words + "a.svg").status, 0);
    const std::string svg = test::content(folder.path() / "a.svg");
    EXPECT_NE(svg.find("width=\"85mm\" height=\"56.6667mm\" viewBox=\"0 0 600 400\""), std::string::npos)
        << svg.substr(0, 300);
    ASSERT_EQ(folder.run(words + "a.png --dpi 254").status, 0);
    const std::string png = test::content(folder.path() / "a.png");
    const std::size_t at = png.find("pHYs");
    ASSERT_NE(at, std::string::npos);
    EXPECT_EQ(png.substr(at + 4, 9), std::string("\0\0\x27\x10\0\0\x27\x10\x01", 9));  // 10000 pixels per meter
    EXPECT_EQ(folder.run("reproduce a.png").status, 0);
    EXPECT_EQ(folder.run("reproduce a.svg").status, 0);
    if (find_program("rsvg-convert").empty()) return;
    ASSERT_EQ(folder.run(words + "a.pdf").status, 0);
    const std::string pdf = test::content(folder.path() / "a.pdf");
    const std::size_t box = pdf.find("/MediaBox [ 0 0 ");
    ASSERT_NE(box, std::string::npos);
    EXPECT_NEAR(std::strtod(pdf.c_str() + box + 16, nullptr), 85.0 / 25.4 * 72.0, 0.01);
}

TEST(Page, IsRefusedWhereItMakesNoSense) {
    const test::Folder folder;
    for (const char* words : {"--width-mm 5", "--font-pt 8", "--width-mm x", "--at 3", "--width-mm 85 --dpi 9",
                              "--mechanism --view height", "--width-mm 1200 --dpi 1200"}) {
        const test::Answer answer = folder.run(std::string("figure ball_on_sine --out a.png ") + words);
        EXPECT_EQ(answer.status, 2) << words << answer.err;
        EXPECT_NE(answer.err, "") << words;
    }
    EXPECT_TRUE(folder.files().empty());
}

void replay(const std::string& picture, Session& session) {
    for (const Command& command : session_in(picture, trust_of(true, {}))) session.apply(command);
}

// Every format, of plots and mechanism, can be reproduced, and dropped on the window it restores the session.
TEST(Export, OfAPageIsMadeAgainAndLeadsBack) {
    const test::Folder folder;
    Session session = test::session("ball_on_sine");
    for (const char* line : {"set e 0.3", "seek 2.5", "grid 1 2"}) session.apply(parse_command(line));
    int i = 0;
    for (const char* words : {"f{}.svg width 85 font 9", "f{}.png plot 2 width 60 height 40 dpi 100 dark",
                              "f{}.svg mechanism width 85", "f{}.png mechanism dark", "f{}.pdf mechanism width 85"}) {
        const std::string line = fmt::format(fmt::runtime(words), ++i), name = line.substr(0, line.find(' '));
        if (name.ends_with(".pdf") && find_program("rsvg-convert").empty()) continue;
        session.apply(parse_command("export " + (folder.path() / line).string()));
        ASSERT_EQ(session.error(), "") << line;
        EXPECT_EQ(folder.run("reproduce " + name).status, 0) << line;
        Session again = test::session("double_pendulum");
        replay((folder.path() / name).string(), again);
        EXPECT_EQ(again.value("e"), 0.3) << line;
        EXPECT_EQ(again.theme().dark, line.find("dark") != std::string::npos);
        if (line.find("mechanism") != std::string::npos)
            EXPECT_EQ(again.time(), 2.5);
        else
            EXPECT_EQ(again.plotted().list().size(), line.find("plot 2") == std::string::npos ? 2U : 1U);
    }
    session.apply(parse_command("export " + (folder.path() / "run.json").string() + " mechanism"));
    EXPECT_NE(session.error().find("end it in .svg, .png or .pdf"), std::string::npos) << session.error();
}

TEST(Export, OfASystemWithoutDrawingHasNoMechanism) {
    const test::Folder folder;
    Session session = test::session("ball_on_sine");
    session.apply(command::SetText{test::drop_text});
    session.apply(parse_command("export " + (folder.path() / "a.svg").string() + " mechanism"));
    EXPECT_NE(session.error().find("no drawing of a mechanism"), std::string::npos) << session.error();
}

// The vector form has the lines and fills of the pixel form: a filled disk, the surface, the trail.
TEST(Mechanism, IsDrawnAsLinesToo) {
    const test::Folder folder;
    ASSERT_EQ(folder.run("figure ball_on_cylinder --mechanism --at 0.5 --out a.svg").status, 0);
    const std::string svg = test::content(folder.path() / "a.svg");
    EXPECT_NE(svg.find("Z\"/>"), std::string::npos) << "nothing is filled";
    EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos) << "there is no way";
    ASSERT_EQ(folder.run("figure ball_on_cylinder --mechanism --at 0.5 --do 'hide trail' --out b.svg").status, 0);
    EXPECT_EQ(test::content(folder.path() / "b.svg").find("stroke-dasharray"), std::string::npos);
    ASSERT_EQ(folder.run("figure ball_on_cylinder --mechanism --transparent --out c.svg").status, 0);
    const std::string page = "height=\"800\" fill=\"#ffffff\"";
    EXPECT_NE(svg.find(page), std::string::npos);
    EXPECT_EQ(test::content(folder.path() / "c.svg").find(page), std::string::npos);
}

}  // namespace
}  // namespace achilles
