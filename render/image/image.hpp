// Pixels: in and out of PNG files, and how far two images are apart. The only file that includes stb.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace achilles {

struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;      // top row first, 3 bytes a pixel
    std::vector<std::uint8_t> alpha{};  // a byte a pixel, 255 is opaque; empty: all are
    friend bool operator==(const Image&, const Image&) = default;
};

// Throw std::runtime_error with the path and the reason.
void write_png(const Image& image, const std::filesystem::path& file);
// Without its transparency.
Image read_png(const std::filesystem::path& file);

// How a PNG is compressed: stb's level, and the filter of every row (0 none, 1 left, 2 up, 3 average, 4 Paeth, -1 the
// one of least sum). Chosen by measurement, see tests/bench/pictures.cpp.
struct Compression {
    int level = 5, filter = 0;
};
// The PNG file as bytes.
std::string png_bytes(const Image& image, const Compression& compression = {});

// The largest, over 30-pixel tiles, of the tile's mean absolute colour difference (0: equal, 1: black against white).
// Images of different size are infinitely far apart.
double worst_tile(const Image& a, const Image& b);

}  // namespace achilles
