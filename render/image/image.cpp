#include "image/image.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <new>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
// The package's header has unused functions.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace achilles {

namespace {

std::size_t bytes(const Image& image) {
    return 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

std::runtime_error file_error(const std::filesystem::path& file, const std::string& reason) {
    return std::runtime_error(file.string() + ": " + reason);
}

}  // namespace

std::vector<std::uint8_t> rgba(const Image& image) {
    std::vector<std::uint8_t> pixels;
    pixels.reserve(image.rgb.size() / 3 * 4);
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
        const auto color = image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i);
        pixels.insert(pixels.end(), color, color + 3);
        pixels.push_back(image.alpha.empty() ? 255 : image.alpha[i]);
    }
    return pixels;
}

std::string png_bytes(const Image& image, const Compression& compression) {
    const bool opaque = image.alpha.empty();
    if (image.width < 1 || image.height < 1 || image.rgb.size() != bytes(image) ||
        (!opaque && 3 * image.alpha.size() != image.rgb.size()))
        throw std::runtime_error("an image without pixels cannot be written as a PNG file");
    stbi_write_png_compression_level = compression.level;
    stbi_write_force_png_filter = compression.filter;
    std::string out;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    const int channels = opaque ? 3 : 4;
    const std::vector<std::uint8_t> mixed = opaque ? std::vector<std::uint8_t>{} : rgba(image);
    const void* const pixels = opaque ? image.rgb.data() : mixed.data();
    if (stbi_write_png_to_func(append, &out, image.width, image.height, channels, pixels, channels * image.width) == 0)
        throw std::bad_alloc();  // the only cause of failure that stb reports
    return out;
}

void write_png(const Image& image, const std::filesystem::path& file) {
    const std::string png = png_bytes(image);
    errno = 0;
    std::ofstream stream(file, std::ios::binary);
    stream.write(png.data(), static_cast<std::streamsize>(png.size()));
    stream.close();
    if (!stream) throw file_error(file, errno != 0 ? std::strerror(errno) : "cannot be written");
}

Image read_png(const std::filesystem::path& file) {
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    const std::string png((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!stream || png.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw file_error(file, errno != 0 ? std::strerror(errno) : "cannot be read");
    Image image;
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()), static_cast<int>(png.size()), &image.width,
                              &image.height, &channels, 4),
        stbi_image_free);
    if (!pixels) throw file_error(file, std::string("is not a readable PNG file: ") + stbi_failure_reason());
    image.rgb.reserve(bytes(image));
    image.alpha.reserve(bytes(image) / 3);
    for (const stbi_uc *p = pixels.get(), *end = p + bytes(image) / 3 * 4; p < end; p += 4) {
        image.rgb.insert(image.rgb.end(), p, p + 3);
        image.alpha.push_back(p[3]);
    }
    const auto is_opaque = [](std::uint8_t alpha) { return alpha == 255; };
    if (std::all_of(image.alpha.begin(), image.alpha.end(), is_opaque)) image.alpha.clear();
    return image;
}

}  // namespace achilles
