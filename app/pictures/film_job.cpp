#include "pictures/film_job.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <utility>

#include "pictures/film.hpp"
#include "system/description.hpp"

extern char** environ;  // NOLINT: POSIX has it here

namespace achilles {

namespace fs = std::filesystem;

namespace {

// The program that this is, or that stands beside it.
std::string program() {
    std::error_code problem;
    const fs::path self = fs::read_symlink("/proc/self/exe", problem);
    return (problem ? fs::path("achilles") : self.parent_path() / "achilles").string();
}

// A file that holds the text, under the name by which the system is known, in a folder of its own.
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
    // A group of its own: those that draw are stopped with it.
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

bool FilmJob::is_made() const { return said_.starts_with(fs::absolute(film_).string() + ": "); }

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

// Lines of progress begin with a bracket; all others are problems.
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
    read(out_, said_);
    take_lines();
    int status = 0;
    if (::waitpid(process_, &status, WNOHANG) != process_) return false;
    process_ = -1;
    read(err_, unread_);
    read(out_, said_);
    take_lines();
    finish(WIFEXITED(status) ? WEXITSTATUS(status) : -1);
    return true;
}

void FilmJob::finish(int status) {
    status_ = status;
    said_ += problems_ + unread_;
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
