// Output files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace achilles {

// A set of files. Whether each can be written is tried when it is added, before the work; nothing stays behind if the
// work is interrupted. At the end all are written under temporary names and then get their own. "-" is standard output.
class OutputFiles {
 public:
    OutputFiles() = default;
    ~OutputFiles();
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;

    // Throws InputError if the file cannot be written, or was added before.
    void add(const std::string& path);
    // What an added file will hold.
    void put(const std::string& path, std::string content);
    // Writes all. Throws InputError (the disk is full); then no file has changed.
    void commit();

 private:
    struct File {
        std::string path, content;                // as given
        std::filesystem::path target, temporary;  // no temporary: written in place (a device, standard output)
        bool written = false;                     // the temporary is there
    };
    static int open_temporary(const File& file);
    std::vector<File> files_;
};

}  // namespace achilles
