#include "pictures/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "pictures/frame_folder.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

extern char** environ;  // NOLINT: declared by POSIX

namespace achilles {

namespace fs = std::filesystem;

namespace {

constexpr const char* joiner = "ffmpeg";
constexpr double max_gif_fps = 50.0;  // GIF delays are multiples of 1/100 s, and players do not support a delay of 1

std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Deleted on scope exit.
struct Temporary {
    fs::path path;
    ~Temporary() {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

// Runs a program without input, with standard output and standard error sent to these files. Returns its exit status;
// -1 if it cannot be started or is killed. Calls `wait` ten times a second while it runs.
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

// The N of the last "frame=N" in ffmpeg's progress output.
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
        const std::string rate = frames.fps > max_gif_fps ? fmt::format("fps={},", max_gif_fps) : "";
        add({"-filter_complex", rate + "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-loop", "0"});
    } else {
        // Players need even numbers of pixels.
        if (frames.width % 2 != 0 || frames.height % 2 != 0) add({"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"});
        add({"-pix_fmt", "yuv420p"});
    }
    words.push_back(film);
    return words;
}

std::string joined(const FrameSeries& frames, const std::string& film,
                   const std::function<void(std::size_t frames)>& done) {
    if (!has_film_joiner()) throw std::runtime_error("ffmpeg is not installed");
    // The file is in the frame folder. ffmpeg takes the format from its extension.
    const Temporary made{frames.folder / ("joined." + ending_of(film))}, log{frames.folder / "joined.log"},
        progress{frames.folder / "joined.progress"};
    std::vector<std::string> words = join_words(frames, made.path.string());
    // No date and no version in the file, so that the same frames give the same bytes.
    words.insert(words.end() - 1,
                 {"-y", "-nostats", "-progress", "pipe:1", "-map_metadata", "-1", "-fflags", "+bitexact"});
    const int status = run(words, progress.path, log.path, [&] {
        if (done) done(frames_in(content(progress.path)));
    });
    std::string bytes = status == 0 ? content(made.path) : "";
    if (!bytes.empty()) return bytes;
    const std::string all = content(log.path);
    constexpr std::size_t last_words = 600;
    throw std::runtime_error("ffmpeg could not make the film: " +
                             all.substr(all.size() - std::min(all.size(), last_words)));
}

void remove_frames(const fs::path& frames, std::size_t count) {
    std::error_code ignored;
    for (std::size_t i = 0; i < count; ++i) fs::remove(frames / (frame_name(i) + ".png"), ignored);
    fs::remove(frames, ignored);  // fails if something else is in it
}

// ---- an animation being made ----

namespace {

// The path of this program, or of `achilles` beside it.
std::string program() {
    std::error_code problem;
    const fs::path self = fs::read_symlink("/proc/self/exe", problem);
    return (problem ? fs::path("achilles") : self.parent_path() / "achilles").string();
}

// Writes the text to a file named after the system, in a new temporary folder.
fs::path put_text(const std::string& name, const std::string& text) {
    std::string pattern = (fs::temp_directory_path() / "achilles-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw InputError(name, {}, "a temporary folder cannot be created");
    const fs::path file = fs::path(pattern) / (fs::path(name).stem().string() + ".toml");
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

}  // namespace

FilmJob::FilmJob(std::string film, std::vector<std::string> words, const std::string& system_text)
    : film_(std::move(film)) {
    std::error_code ignored;
    had_frames_ = fs::exists(frames_folder(film_), ignored);
    if (!system_text.empty()) {
        const fs::path file = put_text(words.at(1), system_text);
        folder_ = file.parent_path();
        words[1] = file.string();
    }
    words.insert(words.begin(), program());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    std::array<int, 2> out{-1, -1}, err{-1, -1};
    if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0)
        throw InputError(film_, {}, "a new process cannot be started");
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    ::posix_spawn_file_actions_adddup2(&actions, err[1], 2);
    // A process group, so that its drawing processes are stopped with it.
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int problem = ::posix_spawn(&process_, pointers[0], &actions, &attributes, pointers.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(out[1]);
    ::close(err[1]);
    out_ = out[0], err_ = err[0];
    for (const int end : {out_, err_}) ::fcntl(end, F_SETFL, O_NONBLOCK);
    if (problem == 0) return;
    process_ = -1;
    finish(-1);
    throw InputError(film_, {}, words[0] + " cannot be started");
}

FilmJob::~FilmJob() { cancel(); }

bool FilmJob::is_made() const { return output_.starts_with(fs::absolute(film_).string() + ": "); }

bool FilmJob::has_frames() const {
    constexpr int stopped_early = 3;
    std::error_code ignored;
    return !is_made() && status_ == stopped_early && fs::exists(frames_folder(film_), ignored);
}

void FilmJob::read(int descriptor, std::string& into) {
    std::array<char, 4096> part{};
    for (ssize_t n = 0; (n = ::read(descriptor, part.data(), part.size())) > 0;)
        into.append(part.data(), static_cast<std::size_t>(n));
}

// Progress lines start with a bracket; all others are error messages.
void FilmJob::take_lines() {
    for (std::size_t end = 0; (end = unread_.find('\n')) != std::string::npos; unread_.erase(0, end + 1)) {
        const std::string line = unread_.substr(0, end);
        if (line.empty() || line[0] != '[') {
            problems_ += line + "\n";
            continue;
        }
        const std::size_t counts = line.find("%  ");
        progress_ = counts == std::string::npos ? line.substr(1) : line.substr(counts + 3);
        unsigned long done = 0, count = 0;
        if (std::sscanf(progress_.c_str(), "%lu/%lu", &done, &count) == 2 && count > 0)  // NOLINT: both are checked
            share_ = static_cast<double>(done) / static_cast<double>(count);
    }
}

bool FilmJob::update() {
    if (process_ < 0) return true;
    read(err_, unread_);
    read(out_, output_);
    take_lines();
    int status = 0;
    if (::waitpid(process_, &status, WNOHANG) != process_) return false;
    process_ = -1;
    read(err_, unread_);
    read(out_, output_);
    take_lines();
    finish(WIFEXITED(status) ? WEXITSTATUS(status) : -1);
    return true;
}

void FilmJob::finish(int status) {
    status_ = status;
    output_ += problems_ + unread_;
    for (int* end : {&out_, &err_})
        if (*end >= 0) ::close(std::exchange(*end, -1));
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(std::exchange(folder_, {}), ignored);
}

void FilmJob::wait() {
    while (!update()) {
        std::array<pollfd, 2> ends{{{out_, POLLIN, 0}, {err_, POLLIN, 0}}};
        ::poll(ends.data(), ends.size(), 100);
    }
}

void FilmJob::cancel() {
    if (process_ < 0) return;
    ::kill(-process_, SIGKILL);
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
    finish(-1);
    std::error_code ignored;
    if (!had_frames_) fs::remove_all(frames_folder(film_), ignored);
}

}  // namespace achilles
