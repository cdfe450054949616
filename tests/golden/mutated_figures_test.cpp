// Tests the comparison of pixels with falsified pictures that it must detect and correct ones that it must accept.
// bench_golden does so with every lie about the gallery and thirty repetitions.
#include <gtest/gtest.h>

#include <map>

#include "golden/mutated_figures.hpp"
#include "golden/pictures.hpp"
#include "image/comparison.hpp"

namespace achilles::golden {
namespace {

constexpr const char* system = "ball_on_sine";

TEST(MutatedFigures, AreNoticedByPixelsAlone) {
    Easel easel(system);
    const Image truth = easel.draw(easel.truth());
    EXPECT_EQ(distance(truth, easel.draw(easel.truth())).score(), 0.0);
    std::map<FigureMutation::Kind, std::vector<FigureMutation>> all;
    for (const FigureMutation& lie : lies_about(easel.truth())) all[lie.kind].push_back(lie);
    EXPECT_EQ(all.size(), 6U);
    for (const auto& [kind, lies] : all) {
        constexpr std::size_t sample = 6;
        ASSERT_GE(lies.size(), sample);
        for (std::size_t i = 0; i < lies.size(); i += lies.size() / sample)
            EXPECT_GT(distance(truth, easel.draw(told(lies[i], easel.truth()))).score(), 1.0)
                << to_text(lies[i], easel.truth());
    }
}

// Pictures drawn with other settings, as on another machine, are below the limits.
TEST(MutatedFigures, APictureByOtherMeansIsTheSame) {
    const Image truth = image_of(figure_command(system));
    for (const char* threads : {"1", "2"})
        for (const char* width : {"128", "256"})
            EXPECT_EQ(distance(truth, image_of(figure_command(system), std::string("LP_NUM_THREADS=") + threads +
                                                                           " LP_NATIVE_VECTOR_WIDTH=" + width))
                          .score(),
                      0.0);
    EXPECT_LT(distance(truth, image_of(figure_command(system), "GALLIUM_OVERRIDE_CPU_CAPS=sse2")).score(), 0.5);
}

// The easel draws the same picture as the program.
TEST(MutatedFigures, AreToldAboutTheGoldenFigure) {
    Easel easel(system);
    EXPECT_EQ(easel.draw(easel.truth()), image_of(figure_command(system)));
}

}  // namespace
}  // namespace achilles::golden
