// Atomic output files: each is written completely or not at all.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace achilles {

// Opens a device or a named pipe for writing; returns a negative number and sets errno on failure. If a pipe has no
// reader yet, it says so on standard error and waits for one.
int open_in_place(const std::string& path);

// A set of output files. add() checks that each can be written, before the work; nothing remains if the work is
// interrupted. commit() writes all under unique temporary names, flushes them to disk, and then renames them. A
// replaced file keeps its mode and, if permitted, its owner. "-" is standard output.
class OutputFiles {
 public:
    OutputFiles() = default;
    ~OutputFiles();
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;

    // Registers an input file. Throws InputError for outputs that resolve to the same file (same device and inode).
    void protect_input(const std::filesystem::path& input);
    // Registers an output. Throws InputError if it cannot be written, was added before, or is an input.
    void add(const std::string& path);
    // Throws InputError if `path` is a registered output, which is also written for another purpose.
    void refuse_output(const std::string& path) const;
    // Sets the content of a registered output.
    void put(const std::string& path, std::string content);
    // Writes all files. Throws InputError (e.g. disk full); then every file is as it was.
    // `fast` does not flush to disk: for files that can be made again or are written often.
    enum class Durability { fsync, fast };
    void commit(Durability care = Durability::fsync);

 private:
    using Identity = std::pair<dev_t, ino_t>;
    struct File {
        std::string path, content;                // as given
        std::filesystem::path target, temporary;  // temporary is empty unless it exists now
        std::optional<Identity> identity;         // the file that stood at the path; empty if there was no file
        bool in_place = false;                    // a device or standard output
        bool swapped = false;  // target and temporary have been exchanged: the temporary is the old file
        bool made = false;     // the target is new and complete
    };
    static std::optional<Identity> identity_of(const std::string& path);
    void refuse_inputs() const;
    static int open_temporary(File& file);
    static void commit_rename(File& file);
    static void roll_back(File& file);
    std::vector<File> files_;
    std::vector<std::pair<std::filesystem::path, Identity>> spared_;
};

}  // namespace achilles
