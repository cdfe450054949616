#include "image/comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace achilles {

namespace {

constexpr int coarse_tile = 30, fine_tile = 10, fine_stride = 5;

// A tile and its difference.
struct Tile {
    double value = 0.0;
    int left = 0, top = 0;
};

bool is_same_size(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.rgb.size() == b.rgb.size();
}

std::size_t at(const Image& image, int x, int y) {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
}

// The sums of the differences over a tile, by channel. Pixels outside the image count as equal, and the tile is
// averaged over its full size; otherwise a single pixel at the edge could fail a test.
std::array<long, 3> channel_sums(const Image& a, const Image& b, int left, int top, int size) {
    std::array<long, 3> sums{};
    const int right = std::min(left + size, a.width), bottom = std::min(top + size, a.height);
    for (int y = top; y < bottom; ++y)
        for (std::size_t i = at(a, left, y); i < at(a, right, y); i += 3)
            for (std::size_t c = 0; c < 3; ++c) sums[c] += std::abs(int{a.rgb[i + c]} - int{b.rgb[i + c]});
    return sums;
}

template <class Measure>
Tile worst(const Image& a, int stride, const Measure& measure) {
    Tile result;
    for (int top = 0; top < a.height; top += stride)
        for (int left = 0; left < a.width; left += stride)
            if (const double value = measure(left, top); value > result.value) result = {value, left, top};
    return result;
}

Tile worst_coarse_tile(const Image& a, const Image& b) {
    return worst(a, coarse_tile, [&](int left, int top) {
        const std::array<long, 3> sums = channel_sums(a, b, left, top, coarse_tile);
        return static_cast<double>(sums[0] + sums[1] + sums[2]) / (3.0 * 255.0 * coarse_tile * coarse_tile);
    });
}

Tile worst_fine_tile(const Image& a, const Image& b) {
    return worst(a, fine_stride, [&](int left, int top) {
        const std::array<long, 3> sums = channel_sums(a, b, left, top, fine_tile);
        return static_cast<double>(*std::max_element(sums.begin(), sums.end())) / (255.0 * fine_tile * fine_tile);
    });
}

ImageDistance opaque_distance(const Image& a, const Image& b) {
    const Tile coarse = worst_coarse_tile(a, b), fine = worst_fine_tile(a, b);
    const bool is_coarse = coarse.value / worst_tile_allowed > fine.value / worst_fine_tile_allowed;
    const Tile& tile = is_coarse ? coarse : fine;
    return {coarse.value, fine.value, tile.left, tile.top, is_coarse ? coarse_tile : fine_tile};
}

// The image on a gray ground.
Image laid_on(Image image, int gray) {
    for (std::size_t i = 0; i < image.alpha.size(); ++i)
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
            image.rgb[c] =
                static_cast<std::uint8_t>((image.rgb[c] * image.alpha[i] + gray * (255 - image.alpha[i]) + 127) / 255);
    image.alpha.clear();
    return image;
}

}  // namespace

double worst_tile(const Image& a, const Image& b) {
    return is_same_size(a, b) ? worst_coarse_tile(a, b).value : std::numeric_limits<double>::infinity();
}

double ImageDistance::score() const { return std::max(coarse / worst_tile_allowed, fine / worst_fine_tile_allowed); }

ImageDistance distance(const Image& a, const Image& b) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!is_same_size(a, b)) return {infinity, infinity};
    if (a.alpha.empty() && b.alpha.empty()) return opaque_distance(a, b);
    const ImageDistance on_white = opaque_distance(laid_on(a, 255), laid_on(b, 255));
    const ImageDistance on_black = opaque_distance(laid_on(a, 0), laid_on(b, 0));
    return on_black.score() > on_white.score() ? on_black : on_white;
}

Image difference(const Image& a, const Image& b) {
    if (!a.alpha.empty() || !b.alpha.empty()) {
        // On white and on black, whichever differs more, as in distance().
        const Image white = difference(laid_on(a, 255), laid_on(b, 255));
        Image larger = difference(laid_on(a, 0), laid_on(b, 0));
        std::transform(larger.rgb.begin(), larger.rgb.end(), white.rgb.begin(), larger.rgb.begin(),
                       [](std::uint8_t x, std::uint8_t y) { return std::max(x, y); });
        return larger;
    }
    Image result{std::max(a.width, b.width), std::max(a.height, b.height), {}};
    result.rgb.assign(at(result, 0, result.height), 255);
    for (int y = 0; y < std::min(a.height, b.height); ++y)
        for (int x = 0; x < std::min(a.width, b.width); ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const int apart = std::abs(int{a.rgb[at(a, x, y) + c]} - int{b.rgb[at(b, x, y) + c]});
                result.rgb[at(result, x, y) + c] = static_cast<std::uint8_t>(std::min(10 * apart, 255));
            }
    return result;
}

}  // namespace achilles
