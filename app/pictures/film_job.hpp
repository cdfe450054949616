// A film in the making: `achilles frames` in a process of its own, so that a window goes on meanwhile, and may stop it.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace achilles {

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
