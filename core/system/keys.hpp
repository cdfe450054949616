// All keys of system files, defined once: the reader rejects other keys, and the manual lists these.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct FileKey {
    std::string_view name;
    std::string_view value;  // allowed values and default
    std::string_view about;
};

// The keys of one table of the file; [run] and [truncation] have those of all_options(). Each shape of [[drawing]] has
// a table with its own keys, in addition to the common ones.
struct FileTable {
    std::string_view heading;  // as written: "[[coordinate]]"; "" before the first heading
    std::vector<FileKey> keys;
};

std::span<const FileTable> file_tables();
// The names of the keys in a table, which must exist.
std::vector<std::string> keys_of(std::string_view heading);

// The key that a word of another program stands for, such as restitution for e; "" if there is none.
std::string other_key(std::string_view word, const std::vector<std::string>& keys);

// Advice on a word of another program without a corresponding key in the table with this heading: friction, gravity, dt;
// "" if there is none.
std::string_view instead_of_key(std::string_view word, std::string_view heading);

}  // namespace achilles
