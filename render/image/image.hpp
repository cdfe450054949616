// Images: reading and writing PNG files, and comparing two images. image.cpp is the only file that includes stb.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace achilles {

struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;      // top row first, 3 bytes per pixel
    std::vector<std::uint8_t> alpha{};  // 1 byte per pixel, 255 is opaque; empty: all pixels are opaque
    friend bool operator==(const Image&, const Image&) = default;
};

// Both throw std::runtime_error with the path and the reason.
void write_png(const Image& image, const std::filesystem::path& file);
// Reads the colors; transparency is dropped.
Image read_png(const std::filesystem::path& file);

// PNG compression: level of stb, and the filter of every row (0 none, 1 left, 2 up, 3 average, 4 Paeth, -1 the one with
// the smallest sum). Chosen by measurement, see tests/bench/pictures.cpp.
struct Compression {
    int level = 5, filter = 0;
};
// The bytes of a PNG file.
std::string png_bytes(const Image& image, const Compression& compression = {});

// Mean absolute color difference of a tile of 30 x 30 pixels, maximum over all tiles (0: equal, 1: black against
// white). Infinite for images of different sizes.
double worst_tile(const Image& a, const Image& b);

}  // namespace achilles
