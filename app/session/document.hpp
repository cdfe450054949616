// The text of a system while a person writes it, and the file it belongs to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace achilles {

struct Document {
    std::string name;                  // of the system, as opened; "untitled" for a new one
    std::string file;                  // where the user opened or saved it; empty: nowhere yet
    std::string source;                // what messages call it
    std::string text;                  // as it stands in the editor
    std::string saved;                 // as it stands in the file
    std::vector<InputError> problems;  // why the text is not the system that runs; none: it is

    bool is_changed() const { return text != saved; }
};

// A short system to start from.
Document new_document();

// What a file holds, whether or not it is a system. `name` is how the user called it: where that is no path but the
// name of an asset, the document has no file, so that nothing is saved over the asset unasked. Throws InputError if
// there is nothing to read.
Document open_document(const std::string& name, const std::filesystem::path& file);

// Writes the text to a file, whole or not at all, which then is the document's. Another file than the document's own is
// written over only with `overwrite`. Throws InputError.
void save(Document& document, const std::string& file, bool overwrite);
// As after save(), which did not happen here.
void mark_saved(Document& document, const std::string& file);

// The run of a model derived from an edited text: what the text says, but where a value stands in the text as before,
// what a slider or the command line made of it. `run` is one of `before`.
Run carried_over(const SystemDescription& before, const Run& run, const Model& after);

}  // namespace achilles
