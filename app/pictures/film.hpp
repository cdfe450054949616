// An animation as one file, MP4 or GIF: numbered pictures that ffmpeg joins, where that is installed.
#pragma once

#include <sys/types.h>

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

// A film in the making: `achilles frames` in a process of its own, so that a window goes on meanwhile, and may stop it.

class FilmJob {
 public:
    // Begins it. `words` follow the program's name; `system_text`, where it is not empty, is put into a file of the name
    // `words[1]` in a folder of its own until the job ends. Throws InputError if no process can be had.
    FilmJob(std::string film, std::vector<std::string> words, const std::string& system_text);
    // Stops it.
    ~FilmJob();
    FilmJob(const FilmJob&) = delete;
    FilmJob& operator=(const FilmJob&) = delete;

    const std::string& film() const { return film_; }
    // Takes in what the process has said. Whether it has ended.
    bool update();
    // Until it has ended.
    void wait();
    // It ends, with all that it began; frames that it drew go.
    void cancel();

    // "120/300 frames  11.3/s  0:16 left"; empty before the first, "joining" at the end.
    const std::string& progress() const { return progress_; }
    double share() const { return share_; }  // of the frames, 0 to 1
    int status() const { return status_; }   // of the process; of one that was stopped -1
    bool is_made() const;                    // the film, be it that the run stopped early
    bool has_frames() const;                 // these alone: they could not be joined
    // What it said besides: where the film is, or what went wrong.
    const std::string& said() const { return said_; }

 private:
    void read(int descriptor, std::string& into);
    void take_lines();
    void finish(int status);

    std::string film_;
    std::filesystem::path folder_;  // of the text; empty: none
    bool had_frames_ = false;       // from an earlier attempt, by whoever made it
    pid_t process_ = -1;            // -1: it has ended
    int out_ = -1, err_ = -1;
    std::string said_, unread_, progress_, problems_;
    double share_ = 0.0;
    int status_ = -1;
};

}  // namespace achilles
