// Limits of the comparison with golden files. The scores in the comments were measured by `bench_golden`.
#pragma once

namespace achilles::golden {

// Numbers in a text may differ by one unit in the ninth digit, and near zero by rounding errors.
constexpr int digits_compared = 9;
constexpr double absolute_allowed = 1e-12;

// Coarse limit of pictures: the mean difference of color in the worst 30-pixel tile. It detects faint and wide changes.
// It misses 71 of 186 curves thicker by a fifth (smallest score 0.0033), 45 of 186 hues turned by a tenth (0.0043), and
// a digit.
constexpr double worst_tile_allowed = 0.005;

// Fine limit of pictures: the difference in the worst 10-pixel tile, of tiles that overlap by half, in the channel that
// differs most. It detects thin lines and letters: the smallest score is 0.018 for those curves, 0.041 for the hues,
// 0.080 for the digits, and larger for all others. Correct pictures score 0 with other numbers of threads, other vector
// widths and with EGL instead of OSMesa, and 0.0016 if Mesa does not use AVX.
constexpr double worst_fine_tile_allowed = 0.008;

}  // namespace achilles::golden
