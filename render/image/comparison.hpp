// The measured difference of two images, for screenshot regression tests: of the golden pictures and of `achilles
// compare`. The scores in the comments were measured by `bench_golden`.
#pragma once

#include "image/image.hpp"

namespace achilles {

// Coarse limit: the mean difference of color in the worst 30-pixel tile. It detects faint and wide changes. It misses
// 71 of 186 curves thicker by a fifth (smallest score 0.0033), 45 of 186 hues turned by a tenth (0.0043), and a digit.
constexpr double worst_tile_allowed = 0.005;

// Fine limit: the difference in the worst 10-pixel tile, of tiles that overlap by half, in the channel that differs
// most. It detects thin lines and letters: the smallest score is 0.018 for those curves, 0.041 for the hues, 0.080 for
// the digits, and larger for all others. Correct pictures score 0 with other numbers of threads, other vector widths
// and with EGL instead of OSMesa, and 0.0016 if Mesa does not use AVX.
constexpr double worst_fine_tile_allowed = 0.008;

// Mean absolute color difference of a tile of 30 x 30 pixels, maximum over all tiles (0: equal, 1: black against
// white). Infinite for images of different sizes. Transparency is ignored.
double worst_tile(const Image& a, const Image& b);

struct ImageDistance {
    double coarse = 0.0, fine = 0.0;   // the two measures above; infinite for images of different sizes
    int left = 0, top = 0, tile = 30;  // the worst tile: its corner and size, pixels
    // The larger of both in units of its limit: above 1 the images are different.
    double score() const;
};

// The distance of two images. Transparent ones are laid on white and on black; the larger distance counts.
ImageDistance distance(const Image& a, const Image& b);

// Ten times the difference, on black. A pixel that only one of the images has is white.
Image difference(const Image& a, const Image& b);

}  // namespace achilles
