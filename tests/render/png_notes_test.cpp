#include "image/notes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string_view>

#include "image/image.hpp"

namespace achilles {
namespace {

using std::string_literals::operator""s;

std::string small_png() {
    const Image image{3, 2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}, {}};
    return png_bytes(image);
}

std::string big_endian(std::uint32_t value) {
    std::string text;
    for (const int shift : {24, 16, 8, 0}) text += static_cast<char>(value >> shift);
    return text;
}

// CRC-32 bit by bit, and a chunk with a valid checksum.
std::string chunk(const std::string& name_and_data) {
    std::uint32_t sum = 0xFFFFFFFFU;
    for (const char c : name_and_data) {
        sum ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return big_endian(static_cast<std::uint32_t>(name_and_data.size() - 4)) + name_and_data + big_endian(~sum);
}

// A PNG with an arbitrary chunk after its header.
std::string png_with(const std::string& name_and_data) {
    const std::string png = small_png();
    return png.substr(0, 33) + chunk(name_and_data) + png.substr(33);
}

const Notes some_notes{{"Title", "A ball"}, {"Achilles System", "title = \"θ\"\r\n"}, {"Comment", ""}};

TEST(PngNotes, ComeBackInOrderAndLeaveThePictureAlone) {
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

TEST(PngNotes, HaveTheCheckSumOfTheStandard) {
    const std::string png = with_notes(small_png(), {{"k", "v"}});
    EXPECT_EQ(png, png_with(std::string("tEXtk\0v", 7)));
    EXPECT_EQ(png.substr(33, 15), std::string("\0\0\0\3tEXtk\0v\xCB\x04\xF3\x90", 15));
    EXPECT_EQ(png.substr(png.size() - 4), std::string("\xAE\x42\x60\x82", 4));  // of IEND, in every PNG
}

TEST(PngNotes, EveryFlippedBitAndEveryMissingEndIsNoticed) {
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

// The checksums are valid, but parts of the chunks are missing.
TEST(PngNotes, ChunksThatAreNoTextAreRefused) {
    for (const std::string& damaged : {"tEXt"s, "tEXtkeyword"s, "iTXt"s, "iTXtkeyword"s, "iTXtk\0"s, "iTXtk\0\0"s,
                                       "iTXtk\0\0\0"s, "iTXtk\0\0\0en"s, "iTXtk\0\0\0en\0"s, "iTXtk\0\0\0en\0word"s})
        EXPECT_THROW(png_notes(png_with(damaged)), std::runtime_error) << damaged;
    EXPECT_EQ(png_notes(png_with("iTXtk\0\0\0en\0word\0text"s)), (Notes{{"k", "text"}}));
    EXPECT_TRUE(png_notes(png_with("iTXtk\0\1\0\0\0packed"s)).empty());
    EXPECT_TRUE(png_notes(png_with("zTXtk\0\0packed"s)).empty());
    EXPECT_EQ(png_notes(png_with("tEXtk\0a\xE9\x62"s)), (Notes{{"k", "aéb"}}));  // Latin-1
}

TEST(PngNotes, InvalidNotesAreRejected) {
    for (const Note& note : {Note{"", "v"}, Note{std::string(80, 'k'), "v"}, Note{"kä", "v"},
                             Note{"k", std::string("a\0b", 3)}, Note{"k", "\xff"}, Note{"k", "\xf8\x88\x80\x80"}})
        EXPECT_THROW(with_notes(small_png(), {note}), std::runtime_error) << note.keyword;
    EXPECT_THROW(with_notes("GIF89a", {}), std::runtime_error);
}

// ---- files from other programs ----

TEST(PngNotes, AreFoundBeforeBetweenAndAfterThePixels) {
    const std::string png = small_png(), header = png.substr(0, 33), end = png.substr(png.size() - 12);
    const std::string pixels = png.substr(41, png.size() - 41 - 12 - 4);  // of the only IDAT chunk
    const std::string first = chunk("IDAT" + pixels.substr(0, 5)), second = chunk("IDAT" + pixels.substr(5));
    ASSERT_EQ(header + chunk("IDAT" + pixels) + end, png);
    EXPECT_EQ(png_notes(header + chunk("tEXta\0one"s) + chunk("gAMA\0\1\x86\xA0"s) + first + chunk("tIME1234567") +
                        chunk("iTXtb\0\0\0\0\0two \xCE\xB8"s) + second + chunk("tEXtc\0three"s) + end),
              (Notes{{"a", "one"}, {"b", "two θ"}, {"c", "three"}}));
    EXPECT_EQ(png_notes(png_with("tEXta\0v"s) + chunk("tEXtb\0after the end"s)), (Notes{{"a", "v"}}));
}

TEST(PngNotes, OfOneKeywordAllComeInOrder) {
    const std::string png = with_notes(small_png(), {{"k", "one"}, {"l", "two"}});
    EXPECT_EQ(png_notes(with_notes(png, {{"k", "three"}, {"k", ""}, {"k", "one"}})),
              (Notes{{"k", "three"}, {"k", ""}, {"k", "one"}, {"k", "one"}, {"l", "two"}}));
}

// Notes before and after such a chunk are still found.
TEST(PngNotes, InvalidTextChunksAreSkipped) {
    for (const std::string& strange :
         {"tEXt\0no keyword"s, "tEXt"s + std::string(80, 'k') + "\0too long"s, "tEXtH\xF6he\0Latin-1"s,
          "tEXtk\n\0a keyword of two lines"s, "tEXtk\0a zero \0 byte"s, "iTXtk\0\0\0\0\0a zero \0 byte"s,
          "iTXtk\0\0\0\0\0no UTF-8 \xFF"s, "iTXtk\0\0\0\0\0half a letter \xCE"s,
          "iTXtk\0\0\0\0\0a slash in two bytes \xC0\xAF"s, "iTXtk\0\0\0\0\0a surrogate \xED\xA0\x80"s,
          "iTXtk\0\1\0\0\0compressed"s, "zTXtk\0\0compressed"s, "teXtk\0another chunk"s}) {
        const std::string png = with_notes(png_with(strange), some_notes);
        EXPECT_EQ(png_notes(png), some_notes) << strange;
    }
}

TEST(PngNotes, ALengthThatIsWrongIsNoticed) {
    const std::string png = with_notes(small_png(), some_notes);
    const auto is_read = [](const std::string& file) {
        try {
            png_notes(file);
            return true;
        } catch (const std::runtime_error&) {
            return false;
        }
    };
    // Chunk lengths of the header, the first note, the pixels and the end.
    for (const std::size_t at : {std::size_t{8}, std::size_t{33}, png.find("IDAT") - 4, png.size() - 12}) {
        std::uint32_t right = 0;
        for (std::size_t i = at; i < at + 4; ++i) right = right << 8 | static_cast<unsigned char>(png[i]);
        std::string other = png;
        EXPECT_TRUE(is_read(other.replace(at, 4, big_endian(right))));
        const auto left = static_cast<std::uint32_t>(png.size() - at);
        for (const std::uint32_t wrong : {0U, right - 1, right + 1, right + 12, left, left - 12, left - 11, 0x7FFFFFFFU,
                                          0x80000000U, 0xFFFFFFF3U, 0xFFFFFFF4U, 0xFFFFFFFCU, 0xFFFFFFFFU})
            EXPECT_TRUE(wrong == right || !is_read(other.replace(at, 4, big_endian(wrong)))) << at << ' ' << wrong;
    }
    EXPECT_THROW(png_notes(small_png().substr(0, 33) + "\0\0\0\3tEXtk\0v\xCB\x04\xF3\x91"s), std::runtime_error);
}

// Random chunks with valid checksums: the notes that are read can be written and read again, or the file is rejected.
TEST(PngNotes, OfRandomChunksAreSuchAsCanBeWritten) {
    std::mt19937 random(17);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
    const std::string seeds[] = {"tEXtTitle\0A ball"s, "iTXtTitle\0\0\0en\0Titel\0\xCE\xB8 = 1\xE2\x80\xA6"s,
                                 "iTXtk\0\0\0\0\0"s};
    const std::string bytes = "\0\1\n k~\x7F\x80\xBF\xC3\xA9\xE2\xED\xF0\xFF"s;
    int read = 0, refused = 0, left_out = 0;
    for (int round = 0; round < 20000; ++round) {
        std::string body = seeds[below(3)];
        for (std::size_t n = 1 + below(4); n > 0; --n) {
            const std::size_t at = 4 + below(body.size() - 3);
            const std::string byte(1, bytes[below(bytes.size())]);
            body.replace(at, at < body.size() ? below(2) : 0, byte);
            if (below(4) == 0) body.resize(4 + below(body.size() - 3));
        }
        try {
            const Notes notes = png_notes(png_with(body));
            ASSERT_EQ(png_notes(with_notes(small_png(), notes)), notes) << body;
            ++(notes.empty() ? left_out : read);
        } catch (const std::runtime_error& error) {
            ASSERT_NE(std::string_view(error.what()).find("damaged: a text chunk"), std::string_view::npos) << body;
            ++refused;
        }
    }
    EXPECT_GT(read, 1000);
    EXPECT_GT(left_out, 1000);
    EXPECT_GT(refused, 1000);
}

TEST(PngNotes, AreLimitedInNumber) {
    constexpr std::size_t most = 65536;
    const std::string empty = chunk("tEXtk\0"s);
    std::string all;
    for (std::size_t i = 0; i < most; ++i) all += empty;
    const std::string png = small_png();
    EXPECT_EQ(png_notes(png.substr(0, 33) + all + png.substr(33)).size(), most);
    EXPECT_THROW(png_notes(png.substr(0, 33) + all + empty + png.substr(33)), std::runtime_error);
    EXPECT_THROW(with_notes(png, Notes(most + 1, Note{"k", ""})), std::runtime_error);
}

}  // namespace
}  // namespace achilles
