// An animation as one file, MP4 or GIF: numbered pictures that ffmpeg joins, where that is installed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace achilles {

// Whether a name's ending says so.
bool is_film(const std::string& file);

// Whether ffmpeg is there to join one. need_film_joiner() throws InputError about an option where it is not; the advice is the
// command that draws the frames of this film of the system.
bool has_film_joiner();
void need_film_joiner(const std::string& option, const std::string& system, const std::string& film);

// What --out of `achilles frames` names: a film that can be joined, or a folder. Throws InputError for a film where there is no
// ffmpeg, and for an ending of another kind of file, unless a folder of that name is there.
void check_frames_out(const std::string& out, const std::string& system);

// Where the pictures of a film are drawn: "film.frames" beside film.mp4.
std::filesystem::path frames_folder(const std::string& film);

// The words of the command that joins the frames of a folder. MP4: H.264 of an even number of pixels, which every player
// shows. GIF: with a palette of its own, at most 50 pictures a second, played without end.
struct FrameSeries {
    std::filesystem::path folder;
    double fps = 30.0;
    int width = 0, height = 0;  // pixels
};
std::vector<std::string> join_words(const FrameSeries& frames, const std::string& film);

// Runs it and returns the file's bytes; nothing but the frames stays in the folder. `done` hears now and then how many frames are
// joined. Throws std::runtime_error, with what
// ffmpeg said, where it fails, and where there is none.
std::string joined(const FrameSeries& frames, const std::string& film,
                   const std::function<void(std::size_t frames)>& done = {});

// Takes the frames of a film, and the folder where nothing else is in it.
void remove_frames(const std::filesystem::path& frames, std::size_t count);

}  // namespace achilles
