// A text that a picture carries with it.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct Note {
    std::string keyword;  // 1 to 79 printable ASCII characters; "Software" and "Title" are PNG's own
    std::string text;     // UTF-8
    friend bool operator==(const Note&, const Note&) = default;
};
using Notes = std::vector<Note>;

// A picture with more of them is refused: those of a stranger take ten times their file's size.
constexpr std::size_t most_notes = std::size_t{1} << 16;

inline bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

}  // namespace achilles
