#include "image/png_notes.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "image/image.hpp"

namespace achilles {
namespace {

std::string small_png() {
    const Image image{3, 2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}, {}};
    return png_bytes(image);
}

// CRC-32 bit by bit, and a chunk with a right one.
std::string chunk(const std::string& name_and_data) {
    std::uint32_t sum = 0xFFFFFFFFU;
    for (const char c : name_and_data) {
        sum ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    const auto bytes = [](std::uint32_t value) {
        std::string text;
        for (const int shift : {24, 16, 8, 0}) text += static_cast<char>(value >> shift);
        return text;
    };
    return bytes(static_cast<std::uint32_t>(name_and_data.size() - 4)) + name_and_data + bytes(~sum);
}

// With a chunk of anybody's after the header.
std::string png_with(const std::string& name_and_data) {
    const std::string png = small_png();
    return png.substr(0, 33) + chunk(name_and_data) + png.substr(33);
}

const Notes some_notes{{"Title", "A ball"}, {"Achilles System", "title = \"θ\"\r\n"}, {"Comment", ""}};

TEST(PngNotes, come_back_in_order_and_leave_the_picture_alone) {
    const std::string png = with_notes(small_png(), some_notes);
    EXPECT_EQ(png_notes(png), some_notes);
    EXPECT_TRUE(png_notes(small_png()).empty());
    EXPECT_NE(png.find("tEXtTitle"), std::string::npos);
    EXPECT_NE(png.find("iTXtAchilles System"), std::string::npos);
    const auto file = std::filesystem::path(testing::TempDir()) / "achilles_notes.png";
    std::ofstream(file, std::ios::binary) << png;
    EXPECT_EQ(read_png(file).rgb.back(), 17);
    std::filesystem::remove(file);
}

TEST(PngNotes, have_the_check_sum_of_the_standard) {
    const std::string png = with_notes(small_png(), {{"k", "v"}});
    EXPECT_EQ(png, png_with(std::string("tEXtk\0v", 7)));
    EXPECT_EQ(png.substr(33, 15), std::string("\0\0\0\3tEXtk\0v\xCB\x04\xF3\x90", 15));
    EXPECT_EQ(png.substr(png.size() - 4), std::string("\xAE\x42\x60\x82", 4));  // of IEND, in every PNG
}

TEST(PngNotes, every_flipped_bit_and_every_missing_end_is_noticed) {
    const std::string png = with_notes(small_png(), some_notes);
    for (std::size_t i = 0; i < png.size(); ++i) {
        EXPECT_THROW(png_notes(std::string_view(png).substr(0, i)), std::runtime_error) << i;
        for (int bit = 0; bit < 8; ++bit) {
            std::string damaged = png;
            damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
            EXPECT_THROW(png_notes(damaged), std::runtime_error) << i << " bit " << bit;
        }
    }
}

// Check sums are right here, but parts are missing.
TEST(PngNotes, chunks_that_are_no_text_are_refused) {
    using std::string_literals::operator""s;
    for (const std::string& damaged : {"tEXt"s, "tEXtkeyword"s, "iTXt"s, "iTXtkeyword"s, "iTXtk\0"s, "iTXtk\0\0"s,
                                       "iTXtk\0\0\0"s, "iTXtk\0\0\0en"s, "iTXtk\0\0\0en\0"s, "iTXtk\0\0\0en\0word"s})
        EXPECT_THROW(png_notes(png_with(damaged)), std::runtime_error) << damaged;
    EXPECT_EQ(png_notes(png_with("iTXtk\0\0\0en\0word\0text"s)), (Notes{{"k", "text"}}));
    EXPECT_TRUE(png_notes(png_with("iTXtk\0\1\0\0\0packed"s)).empty());
    EXPECT_TRUE(png_notes(png_with("zTXtk\0\0packed"s)).empty());
    EXPECT_EQ(png_notes(png_with("tEXtk\0a\xE9\x62"s)), (Notes{{"k", "aéb"}}));  // Latin-1
}

TEST(PngNotes, what_no_chunk_can_hold_is_refused) {
    for (const Note& note : {Note{"", "v"}, Note{std::string(80, 'k'), "v"}, Note{"kä", "v"},
                             Note{"k", std::string("a\0b", 3)}, Note{"k", "\xff"}, Note{"k", "\xf8\x88\x80\x80"}})
        EXPECT_THROW(with_notes(small_png(), {note}), std::runtime_error) << note.keyword;
    EXPECT_THROW(with_notes("GIF89a", {}), std::runtime_error);
}

}  // namespace
}  // namespace achilles
