// The entries of a folder, and paths as they are typed. The last part of a path filters the entries.
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

// A path up to and including its last slash, and the rest.
struct PathParts {
    std::string folder, name;
};
PathParts parts_of(const std::string& path);

// Expands "~/a.toml" as a shell does.
std::string expanded(const std::string& path);

// Folders, then files with one of these extensions (".toml"), each sorted by name; at most `max_entries`. Hidden
// entries only if `hidden`. Empty if the folder cannot be read.
constexpr std::size_t max_entries = 2000;
std::vector<FolderEntry> entries_of(const std::string& folder, const std::vector<std::string>& endings, bool hidden);
// Entries whose name contains these letters, ignoring case; those that start with them come first.
std::vector<FolderEntry> filtered(const std::vector<FolderEntry>& entries, std::string_view letters);

// The path with its last part replaced by an entry; a folder gets a trailing slash.
std::string with_entry(const std::string& path, const FolderEntry& entry);
// The path of the parent folder: the effect of Backspace on "a/b/".
std::string one_up(const std::string& folder);
// The path completed by the common prefix of all entries that start with its last part: the effect of Tab.
std::string completed(const std::string& path, const std::vector<FolderEntry>& entries);

}  // namespace achilles
