// A folder for what a command writes: made where it is missing, and taken away again if nothing came into it.
#pragma once

#include <filesystem>

namespace achilles {

class OutputFolder {
 public:
    // Throws InputError if it cannot be made.
    explicit OutputFolder(std::filesystem::path folder);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

 private:
    std::filesystem::path path_;
    bool made_ = false;
};

}  // namespace achilles
