// Folders that pictures are written into.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "image/notes.hpp"

namespace achilles {

// A folder for what a command writes: made where it is missing, and taken away again if nothing came into it.

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

// The folder that numbered pictures of an animation are drawn into: what is there of the same run stays.

// "frame_00042".
std::string frame_name(std::size_t number);
constexpr std::size_t most_frames = 100000;  // with five digits, as ffmpeg is told

class FrameFolder {
 public:
    // Makes the folder where it is missing, and keeps other processes of this program out while it lives. Throws
    // InputError if it cannot be made or is in use.
    explicit FrameFolder(std::filesystem::path folder);
    ~FrameFolder();
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;

    // Which of the frames 0 to count - 1 are still to be drawn: all but those that are there, whole, with these notes.
    // What an interrupted run left half-written goes. A picture under such a name that is of another run is bad input
    // (throws InputError), or with `overwrite` drawn anew, and taken away if its number is too high.
    std::vector<std::size_t> missing(std::size_t count, const std::function<Notes(const std::string& name)>& notes_of,
                                     bool overwrite) const;

    std::filesystem::path file(std::size_t number) const { return folder_.path() / (frame_name(number) + ".png"); }
    // Puts a picture there, whole or not at all. Throws InputError if it cannot be written.
    void write(std::size_t number, std::string png) const;
    // Tries whether that will be possible.
    void try_to_write(std::size_t number) const;

 private:
    OutputFolder folder_;
    int lock_ = -1;
};

}  // namespace achilles
