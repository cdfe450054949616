#include "pictures/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "pictures/find_program.hpp"
#include "pictures/frame_folder.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_ending.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

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

// The status of a program that reads nothing, and writes its output and its messages into these files; -1 where it cannot run or
// is killed. `wait` is called while it runs, ten times a second.
int run(const std::vector<std::string>& words, const fs::path& output, const fs::path& says,
        const std::function<void()>& wait) {
    std::vector<std::string> kept = words;
    std::vector<char*> pointers;
    for (std::string& word : kept) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawn_file_actions_addopen(&actions, 2, says.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t process = 0;
    const int problem = ::posix_spawnp(&process, pointers[0], &actions, nullptr, pointers.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (problem != 0) return -1;
    pid_t ended = 0;
    while ((ended = ::waitpid(process, &status, WNOHANG)) == 0) {
        wait();
        ::usleep(100'000);
    }
    return ended == process && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The last N of "frame=N" in what ffmpeg tells of its progress.
std::size_t frames_in(const std::string& text) {
    constexpr std::string_view key = "frame=";
    const std::size_t at = text.rfind(key);
    return at == text.npos ? 0 : std::strtoul(text.c_str() + at + key.size(), nullptr, 10);
}

}  // namespace

bool has_film_joiner() { return !find_program(joiner).empty(); }

void need_film_joiner(const std::string& option, const std::string& system, const std::string& film) {
    if (!has_film_joiner())
        throw InputError(
            option, {}, "a film needs ffmpeg, which is not installed",
            fmt::format("install ffmpeg, or draw only the frames into a folder: achilles frames {} --out {}",
                        shell_word(system), shell_word(frames_folder(film).string())));
}

void check_frames_out(const std::string& out, const std::string& system) {
    const std::string ending = ending_of(out), option = "--out " + shown(out);
    if (is_film(out)) return need_film_joiner(option, system, out);
    const bool has_letter =
        std::any_of(ending.begin(), ending.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
    std::error_code ignored;
    if (!has_letter || ending == "frames" || fs::is_directory(out, ignored)) return;
    throw InputError(option, {},
                     fmt::format("the name of a film ends in .mp4 or .gif, but this one ends in .{}", shown(ending)),
                     fmt::format("write --out {}; for a folder of this name --out {}/",
                                 fs::path(out).replace_extension(".mp4").string(), out));
}

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

std::string joined(const FrameSeries& frames, const std::string& film,
                   const std::function<void(std::size_t frames)>& done) {
    if (!has_film_joiner()) throw std::runtime_error("ffmpeg is not installed");
    // In the folder, with its ending, by which ffmpeg knows what is wanted.
    const Temporary made{frames.folder / ("joined." + ending_of(film))}, said{frames.folder / "joined.log"},
        told{frames.folder / "joined.progress"};
    std::vector<std::string> words = join_words(frames, made.path.string());
    // No date and no version: the same frames give the same file.
    words.insert(words.end() - 1,
                 {"-y", "-nostats", "-progress", "pipe:1", "-map_metadata", "-1", "-fflags", "+bitexact"});
    const int status = run(words, told.path, said.path, [&] {
        if (done) done(frames_in(content(told.path)));
    });
    std::string bytes = status == 0 ? content(made.path) : "";
    if (!bytes.empty()) return bytes;
    const std::string all = content(said.path);
    constexpr std::size_t last_words = 600;
    throw std::runtime_error("ffmpeg could not make the film: " +
                             all.substr(all.size() - std::min(all.size(), last_words)));
}

void remove_frames(const fs::path& frames, std::size_t count) {
    std::error_code ignored;
    for (std::size_t i = 0; i < count; ++i) fs::remove(frames / (frame_name(i) + ".png"), ignored);
    fs::remove(frames, ignored);  // not where something else is in it
}

}  // namespace achilles
