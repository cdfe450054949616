// What is still the same: the only home of these bars. `bench_golden` measures what they part; the figures beside them
// are its own.
#pragma once

namespace achilles::golden {

// Two numbers of a text: a unit in the ninth digit, and rounding errors about zero.
constexpr int digits_compared = 9;
constexpr double absolute_allowed = 1e-12;

// Pictures, the worst 30-pixel tile: the mean difference of colour. It sees what is faint and wide, but misses 71 of
// 186 curves thicker by a fifth (the least scores 0.0033), 45 of 186 hues turned by a tenth (0.0043), and a digit.
constexpr double worst_tile_allowed = 0.005;

// Pictures, the worst 10-pixel tile of those that overlap by half, in the channel that differs most. It sees thin lines
// and letters: the least of those curves scores 0.018, of the hues 0.041, of the digits 0.080, everything else more.
// Honest pictures score 0 with other numbers of threads, other vector widths and by EGL instead of OSMesa, and 0.0016
// where Mesa has to do without AVX.
constexpr double worst_fine_tile_allowed = 0.008;

}  // namespace achilles::golden
