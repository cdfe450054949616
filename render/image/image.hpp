// Images: reading and writing PNG files. image.cpp is the only file that includes stb.
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

// The pixels as red, green, blue and alpha, 4 bytes each.
std::vector<std::uint8_t> rgba(const Image& image);

// Both throw std::runtime_error with the path and the reason.
void write_png(const Image& image, const std::filesystem::path& file);
// Reads colors, 8 bits each, and transparency. `alpha` is empty if all pixels are opaque.
Image read_png(const std::filesystem::path& file);

// PNG compression: level of stb, and the filter of every row (0 none, 1 left, 2 up, 3 average, 4 Paeth, -1 the one with
// the smallest sum). Chosen by measurement, see tests/bench/pictures.cpp.
struct Compression {
    int level = 5, filter = 0;
};
// The bytes of a PNG file.
std::string png_bytes(const Image& image, const Compression& compression = {});

}  // namespace achilles
