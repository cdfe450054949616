// Text is readable and drawings are visible in both themes: contrast ratios of WCAG 2.
#include "figure/palette.hpp"

#include <gtest/gtest.h>

namespace achilles {
namespace {

constexpr double of_text = 4.5, of_signs = 3.0;

TEST(Palette, MeasuresContrastAsTheStandardDoes) {
    EXPECT_DOUBLE_EQ(contrast({0, 0, 0, 255}, {255, 255, 255, 255}), 21.0);
    EXPECT_DOUBLE_EQ(contrast({9, 9, 9, 255}, {9, 9, 9, 255}), 1.0);
    EXPECT_NEAR(contrast({119, 119, 119, 255}, {255, 255, 255, 255}), 4.48, 0.005);  // the gray that just fails
}

TEST(Palette, TextCanBeRead) {
    for (const Theme& theme : {light_theme(), dark_theme()}) {
        for (const Color& paper : {theme.background, theme.page, theme.frame, theme.selected}) {
            EXPECT_GE(contrast(theme.ink, paper), 7.0) << theme.dark;
            EXPECT_GE(contrast(theme.faint, paper), of_text) << theme.dark;
            EXPECT_GE(contrast(theme.accent, paper), of_text) << theme.dark;
        }
        for (const Color& text : {theme.error, theme.ink}) EXPECT_GE(contrast(text, theme.error_card), of_text);
    }
}

TEST(Palette, CurvesAndSignsCanBeSeen) {
    for (const Theme& theme : {light_theme(), dark_theme()}) {
        for (const Phase::Kind kind : {Phase::Kind::hybrid, Phase::Kind::constrained}) {
            EXPECT_GE(contrast(phase_color(theme, kind), theme.background), of_signs);
            for (const std::size_t curves : {1U, 2U, 4U})
                for (std::size_t i = 0; i < curves; ++i)
                    EXPECT_GE(contrast(phase_stroke(theme, kind, i, curves).color, theme.background), of_signs)
                        << theme.dark << " " << i << " of " << curves;
        }
        for (const Event::Kind kind : {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release})
            for (const Color& paper : {theme.background, theme.page})
                EXPECT_GE(contrast(event_markers(theme, kind).fill, paper), of_signs);
        for (int place = 1; place <= max_pinned; ++place)
            EXPECT_GE(contrast(run_color(theme, place), theme.background), of_signs) << theme.dark << " " << place;
        EXPECT_GE(contrast(theme.surface, theme.background), of_signs);
        EXPECT_GE(contrast(theme.body, theme.background), of_text);
        // Grid lines are visible but faint.
        EXPECT_GT(contrast(theme.grid, theme.background), 1.1);
        EXPECT_LT(contrast(theme.grid, theme.background), 2.0);
    }
}

TEST(Palette, AFilesColorStandsAsFarFromDarkPaperAsFromWhite) {
    const Theme dark = dark_theme();
    const Color white{255, 255, 255, 255};
    for (const Color& color : {Color{195, 200, 207, 255}, Color{122, 128, 137, 255}, Color{35, 38, 43, 255},
                               Color{213, 94, 0, 255}, Color{0, 158, 115, 255}}) {
        EXPECT_EQ(on_theme(color, light_theme()), color);
        const Color there = on_theme(color, dark);
        EXPECT_NEAR(contrast(there, dark.background) / contrast(color, white), 1.0, 0.06)
            << int{color.r} << " became " << int{there.r} << " " << int{there.g} << " " << int{there.b};
    }
}

}  // namespace
}  // namespace achilles
