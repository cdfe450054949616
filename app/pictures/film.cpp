#include "pictures/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "pictures/find_program.hpp"
#include "pictures/frame_folder.hpp"
#include "pictures/picture_ending.hpp"

extern char** environ;  // NOLINT: POSIX has it here

namespace achilles {

namespace fs = std::filesystem;

namespace {

constexpr const char* joiner = "ffmpeg";
constexpr double most_gif_fps = 50.0;  // a GIF counts hundredths of a second, and players refuse one

std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Removed in any case.
struct Temporary {
    fs::path path;
    ~Temporary() {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

// The status of a program that reads nothing and says all into this file; -1 where it cannot run or is killed.
int run(const std::vector<std::string>& words, const fs::path& says) {
    std::vector<std::string> kept = words;
    std::vector<char*> pointers;
    for (std::string& word : kept) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, says.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
    pid_t process = 0;
    const int problem = ::posix_spawnp(&process, pointers[0], &actions, nullptr, pointers.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (problem != 0 || ::waitpid(process, &status, 0) != process || !WIFEXITED(status)) return -1;
    return WEXITSTATUS(status);
}

}  // namespace

bool is_film(const std::string& file) {
    const std::string ending = ending_of(file);
    return ending == "mp4" || ending == "gif";
}

fs::path frames_folder(const std::string& film) { return fs::path(film).replace_extension(".frames"); }

std::vector<std::string> join_words(const FrameSeries& frames, const std::string& film) {
    std::vector<std::string> words{joiner, "-framerate", fmt::format("{}", frames.fps), "-i",
                                   (frames.folder / "frame_%05d.png").string()};
    const auto add = [&](const std::vector<std::string>& more) { words.insert(words.end(), more.begin(), more.end()); };
    if (ending_of(film) == "gif") {
        const std::string rate = frames.fps > most_gif_fps ? fmt::format("fps={},", most_gif_fps) : "";
        add({"-filter_complex", rate + "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-loop", "0"});
    } else {
        // Players want even numbers of pixels.
        if (frames.width % 2 != 0 || frames.height % 2 != 0) add({"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"});
        add({"-pix_fmt", "yuv420p"});
    }
    words.push_back(film);
    return words;
}

std::string joined(const FrameSeries& frames, const std::string& film) {
    if (find_program(joiner).empty()) throw std::runtime_error("ffmpeg is not installed");
    // In the folder, with its ending, by which ffmpeg knows what is wanted.
    const Temporary made{frames.folder / ("joined." + ending_of(film))}, said{frames.folder / "joined.log"};
    std::vector<std::string> words = join_words(frames, made.path.string());
    // No date and no version: the same frames give the same file.
    words.insert(words.end() - 1, {"-y", "-map_metadata", "-1", "-fflags", "+bitexact"});
    const int status = run(words, said.path);
    std::string bytes = status == 0 ? content(made.path) : "";
    if (!bytes.empty()) return bytes;
    const std::string all = content(said.path);
    constexpr std::size_t last_words = 600;
    throw std::runtime_error("ffmpeg has made no film: " + all.substr(all.size() - std::min(all.size(), last_words)));
}

void remove_frames(const fs::path& frames, std::size_t count) {
    std::error_code ignored;
    for (std::size_t i = 0; i < count; ++i) fs::remove(frames / (frame_name(i) + ".png"), ignored);
    fs::remove(frames, ignored);  // not where something else is in it
}

}  // namespace achilles
