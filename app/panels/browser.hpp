// What a folder holds, under the line that a path is typed in: the last part of the path says which of it is shown.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct FolderEntry {
    std::string name;
    bool is_folder = false;
    friend bool operator==(const FolderEntry&, const FolderEntry&) = default;
};

// A path up to its last slash, and what follows.
struct PathParts {
    std::string folder, name;
};
PathParts parts_of(const std::string& path);

// "~/a.toml" as a shell reads it.
std::string expanded(const std::string& path);

// Folders, then files with one of these endings (".toml"), each by name; at most `most_entries`. Hidden ones only where the
// name asked for begins with a dot. Nothing where the folder cannot be read.
constexpr std::size_t most_entries = 2000;
std::vector<FolderEntry> entries_of(const std::string& folder, const std::vector<std::string>& endings, bool hidden);
// Those whose name has these letters, whatever their case; in front those that begin with them.
std::vector<FolderEntry> filtered(const std::vector<FolderEntry>& entries, std::string_view letters);

// The path with an entry in place of its last part; a folder with a slash behind it.
std::string with_entry(const std::string& path, const FolderEntry& entry);
// The path of the folder above: what Backspace makes of "a/b/".
std::string one_up(const std::string& folder);
// As much more as all entries that begin with the path's last part have in common: what Tab makes of it.
std::string completed(const std::string& path, const std::vector<FolderEntry>& entries);

// Which folder is listed, and which row is chosen.
struct BrowserState {
    std::string folder, letters;  // that the rows are of
    std::vector<std::string> endings;
    bool is_hidden = false;
    std::vector<FolderEntry> all, rows;
    double read_at = -1.0;  // s, of ImGui's clock; below 0: anew
    int chosen = -1;        // none, until an arrow key is pressed
    bool scrolls = false;   // to the chosen row
    std::string line;       // that is to stand in the field, where `rewrites`
    bool rewrites = false, focuses = false;
    bool selects = false;  // what is proposed is to be selected, all of it
    bool tab = false;      // was pressed, and there was nothing to complete
};

}  // namespace achilles
