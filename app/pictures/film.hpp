// Animations as one file, MP4 or GIF: numbered pictures, joined by ffmpeg if it is installed.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace achilles {

// True if the file extension is that of an animation.
bool is_film(const std::string& file);

// Whether ffmpeg is installed. If it is not, need_film_joiner() throws InputError about `option`; its hint is the
// command that draws the frames of this animation.
bool has_film_joiner();
void need_film_joiner(const std::string& option, const std::string& system, const std::string& film);

// Checks the --out argument of `achilles frames`: an animation or a folder. Throws InputError for an animation without
// ffmpeg, and for another file extension, unless a folder of that name exists.
void check_frames_out(const std::string& out, const std::string& system);

// Where the frames of an animation are drawn: "film.frames" beside film.mp4.
std::filesystem::path frames_folder(const std::string& film);

// The ffmpeg command that joins the frames of a folder. MP4: H.264 with even numbers of pixels, which all players
// support. GIF: its own palette, at most 50 frames per second, endless loop.
struct FrameSeries {
    std::filesystem::path folder;
    double fps = 30.0;
    int width = 0, height = 0;  // pixels
};
std::vector<std::string> join_words(const FrameSeries& frames, const std::string& film);

// Runs the command and returns the bytes of the file; only the frames remain in the folder. Calls `done` repeatedly
// with the number of frames joined so far. Throws std::runtime_error with ffmpeg's message if it fails or is missing.
std::string joined(const FrameSeries& frames, const std::string& film,
                   const std::function<void(std::size_t frames)>& done = {});

// Deletes the frames of an animation, and the folder if nothing else is in it.
void remove_frames(const std::filesystem::path& frames, std::size_t count);

// An animation being made by `achilles frames` in another process, so that the window stays responsive and can stop it.

class FilmJob {
 public:
    // Starts it. `words` are the arguments of the program. A nonempty `system_text` is written to a temporary file
    // named `words[1]`, which lasts as long as the job. Throws InputError if the process cannot be started.
    FilmJob(std::string film, std::vector<std::string> words, const std::string& system_text);
    // Stops it.
    ~FilmJob();
    FilmJob(const FilmJob&) = delete;
    FilmJob& operator=(const FilmJob&) = delete;

    const std::string& film() const { return film_; }
    // Reads the output of the process. Returns true if it has ended.
    bool update();
    // Waits for its end.
    void wait();
    // Kills the process group and deletes the frames it drew.
    void cancel();

    // "120/300 frames  11.3/s  0:16 left"; empty before the first frame, "joining" at the end.
    const std::string& progress() const { return progress_; }
    double share() const { return share_; }  // fraction of the frames done, 0 to 1
    int status() const { return status_; }   // exit status of the process; -1 if it was stopped
    bool is_made() const;                    // the animation exists, even if the run stopped early
    bool has_frames() const;                 // only frames exist: they could not be joined
    // Its other output: where the animation is, or what went wrong.
    const std::string& output() const { return output_; }

 private:
    void read(int descriptor, std::string& into);
    void take_lines();
    void finish(int status);

    std::string film_;
    std::filesystem::path folder_;  // of the temporary system file; empty: none
    bool had_frames_ = false;       // frames of an earlier attempt existed
    pid_t process_ = -1;            // -1: it has ended
    int out_ = -1, err_ = -1;
    std::string output_, unread_, progress_, problems_;
    double share_ = 0.0;
    int status_ = -1;
};

}  // namespace achilles
