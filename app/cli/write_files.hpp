// Output files that are there whole or not at all.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace achilles {

// Opens a device or a named pipe to write to it; negative, with errno, where it cannot be opened. Waits for a program that reads
// the pipe, and says so on standard error.
int open_in_place(const std::string& path);

// A set of files. Whether each can be written is tried when it is added, before the work; nothing stays behind if the
// work is interrupted. At the end all are written under temporary names, which no other process uses, are on disk, and
// then get their own. A file that is replaced keeps its mode and, where that may be given away, its owner. "-" is
// standard output.
class OutputFiles {
 public:
    OutputFiles() = default;
    ~OutputFiles();
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;

    // A file that was read: no output may be it, by whatever name. Throws InputError where one is.
    void spare(const std::filesystem::path& input);
    // Throws InputError if the file cannot be written, or was added or is spared.
    void add(const std::string& path);
    // Throws InputError where somebody else would write to a file that was added.
    void refuse_output(const std::string& path) const;
    // What an added file will hold.
    void put(const std::string& path, std::string content);
    // Writes all. Throws InputError (the disk is full); then every file is as it was.
    enum class Care { on_disk, quick };  // quick: what can be made again, or is written at every letter
    void commit(Care care = Care::on_disk);

 private:
    using Identity = std::pair<dev_t, ino_t>;
    struct File {
        std::string path, content;                // as given
        std::filesystem::path target, temporary;  // no temporary: none is written now
        std::optional<Identity> identity;         // of what is there
        bool in_place = false;                    // a device, standard output
        bool swapped = false;                     // the target has its content, the temporary what was there
        bool made = false;                        // the target has its content, and there was none
    };
    static std::optional<Identity> identity_of(const std::string& path);
    void refuse_inputs() const;
    static int open_temporary(File& file);
    static void take_name(File& file);
    static void give_back(File& file);
    std::vector<File> files_;
    std::vector<std::pair<std::filesystem::path, Identity>> spared_;
};

}  // namespace achilles
