// Folders for pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "image/notes.hpp"

namespace achilles {

// An output folder: created if missing, and removed again if it stays empty.

class OutputFolder {
 public:
    // Throws InputError if it cannot be created.
    explicit OutputFolder(std::filesystem::path folder);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

 private:
    std::filesystem::path path_;
    bool is_created_ = false;
};

// The folder for the numbered pictures of an animation. Valid pictures of the same animation are kept.

// "frame_00042".
std::string frame_name(std::size_t number);
constexpr std::size_t max_frames = 100000;  // five digits, as in the file pattern for ffmpeg

class FrameFolder {
 public:
    // Creates the folder if missing and locks it against other processes of this program. Throws InputError if it
    // cannot be created or is in use.
    explicit FrameFolder(std::filesystem::path folder);
    ~FrameFolder();
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;

    // Frames among 0 to count - 1 that must still be drawn: all except complete ones with the given notes. Removes
    // partly written files of an interrupted run. If a picture with such a name belongs to another run, throws
    // InputError, or with `overwrite` draws it again, and deletes it if its number is too high.
    std::vector<std::size_t> missing(std::size_t count, const std::function<Notes(const std::string& name)>& notes_of,
                                     bool overwrite) const;

    std::filesystem::path file(std::size_t number) const { return folder_.path() / (frame_name(number) + ".png"); }
    // Writes a picture atomically. Throws InputError if it cannot be written.
    void write(std::size_t number, std::string png) const;
    // Tests whether write() would succeed.
    void try_to_write(std::size_t number) const;

 private:
    OutputFolder folder_;
    int lock_ = -1;
};

}  // namespace achilles
