// A text that a picture carries with it.
#pragma once

#include <string>
#include <vector>

namespace achilles {

struct Note {
    std::string keyword;  // 1 to 79 printable ASCII characters; "Software" and "Title" are PNG's own
    std::string text;     // UTF-8
    friend bool operator==(const Note&, const Note&) = default;
};
using Notes = std::vector<Note>;

}  // namespace achilles
