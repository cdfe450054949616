// Output files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace achilles {

// A set of files. Each is opened under a temporary name when it is added, so that a path that cannot be written is
// known before the work; all get their names at the end. "-" is standard output.
class OutputFiles {
 public:
    OutputFiles() = default;
    ~OutputFiles();
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;

    // Throws InputError if the file cannot be written, or was added before.
    void add(const std::string& path);
    // What the file will hold. Throws InputError (the disk is full).
    void write(const std::string& path, const std::string& content);
    // Gives all files their names. Throws InputError.
    void commit();

 private:
    struct File {
        std::string path;                         // as given
        std::filesystem::path target, temporary;  // no temporary: written in place (a device, standard output)
        int descriptor = -1;
    };
    std::vector<File> files_;
};

}  // namespace achilles
