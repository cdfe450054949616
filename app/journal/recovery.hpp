// Text that was typed and not saved outlives its window, however that ends: it stands in a file while it is not saved, as
// a journal that leads to it, and the next window offers it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session/command.hpp"
#include "session/document.hpp"

namespace achilles {

class Recovery {
 public:
    Recovery() = default;
    ~Recovery() = default;
    Recovery(const Recovery&) = delete;
    Recovery& operator=(const Recovery&) = delete;

    // Keeps the text of a document as it stands in the editor, if it is not kept already. Where no file can be written
    // there is none: typing goes on.
    void keep(const Document& document, const std::string& text);
    // The text is saved, or given up on purpose.
    void forget();

 private:
    std::filesystem::path file_;
    std::string text_;
};

// What a window left that has ended.
struct Unsaved {
    std::filesystem::path file;
    std::string name, when;      // of the document, and when it was written to last
    std::vector<Command> steps;  // to it: the document, then its text
};

// The newest first. Files of windows that are open, and what is no such file, are passed over.
std::vector<Unsaved> left_unsaved();

}  // namespace achilles
