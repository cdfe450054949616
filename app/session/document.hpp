// The text of a system being edited, and its file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace achilles {

struct Document {
    std::string name;                  // name of the system, as opened; "untitled" for a new one
    std::string file;                  // where the user opened or saved it; empty: not saved yet
    std::string source;                // source name in error messages
    std::string text;                  // as in the editor
    std::string saved;                 // as in the file
    std::vector<InputError> problems;  // errors of the text; empty: the text is the system that runs

    bool is_changed() const { return text != saved; }
};

// A template for a new system.
Document new_document();

// Loads a file, whether or not it is a valid system. `name` is what the user typed. If it is the name of an asset, not
// a path, the document has no file, so that saving cannot overwrite the asset. Throws InputError if the file cannot be
// read.
Document open_document(const std::string& name, const std::filesystem::path& file);

// Writes the text to a file, which becomes the document's file. The write is atomic. Replaces an existing file other
// than the document's own only with `overwrite`. Throws InputError.
void save(Document& document, const std::string& file, bool overwrite);
// Puts the document in the state after save() without writing: for callers that write the file elsewhere.
void mark_saved(Document& document, const std::string& file);

// The run for a model derived from an edited text. It uses the values of the new text, except where a value is the same
// in both texts: there it keeps the value of `run` (a run of `before`), as set by a slider or the command line.
Run carried_over(const SystemDescription& before, const Run& run, const Model& after);

}  // namespace achilles
