// Every key that a system file may have, said once: reading refuses any other, and the manual lists these.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct FileKey {
    std::string_view name;
    std::string_view value;  // what may stand there, and what does where nothing does
    std::string_view about;
};

// The keys of one table of the file; [run] and [truncation] have those of all_options(). Of the shapes of [[drawing]],
// the keys that one has beside those of all, under the shape's name.
struct FileTable {
    std::string_view heading;  // as it is written, "[[coordinate]]"; "" before the first heading
    std::vector<FileKey> keys;
};

std::span<const FileTable> file_tables();
// The names in one of them. There must be such a table.
std::vector<std::string> keys_of(std::string_view heading);

// Which of some keys is meant by another word, of those that people write who know other programs: restitution by e; "" where none is.
std::string other_key(std::string_view word, const std::vector<std::string>& keys);

// What stands for a key of other programs where no key does: friction, gravity, dt; "" where there is nothing to say.
std::string_view instead_of_key(std::string_view word);

}  // namespace achilles
