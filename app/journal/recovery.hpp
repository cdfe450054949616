// Crash recovery for unsaved text. While a text is unsaved, a file keeps it as a journal that restores it, and the next
// window offers to open it.
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

    // Saves the editor text of a document, if it has changed. If the file cannot be written, editing continues without
    // it.
    void keep(const Document& document, const std::string& text);
    // Removes the file: the text was saved or deliberately discarded.
    void forget();

 private:
    std::filesystem::path file_;
    std::string text_;
};

// Unsaved text of a window that is no longer open.
struct RecoveredText {
    std::filesystem::path file;
    std::string name, when;      // name of the document, and time of the last write
    std::vector<Command> steps;  // open the document, then set its text
};

// Newest first. Files of open windows and files of another kind are skipped.
std::vector<RecoveredText> left_unsaved();

}  // namespace achilles
