#include "cli/write_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "system/description.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, int reason) {
    throw InputError(path == "-" ? "standard output" : path, {},
                     fmt::format("the file cannot be written: {}", std::strerror(reason)));
}

// Writes and closes; standard output stays open.
void write_all(int descriptor, const std::string& path, const std::string& content) {
    if (descriptor < 0) fail(path, errno);
    int problem = 0;
    for (std::size_t done = 0; done < content.size() && problem == 0;) {
        const ssize_t count = ::write(descriptor, content.data() + done, content.size() - done);
        if (count >= 0)
            done += static_cast<std::size_t>(count);
        else if (errno != EINTR)
            problem = errno;
    }
    if (descriptor != STDOUT_FILENO && ::close(descriptor) != 0 && problem == 0) problem = errno;
    if (problem != 0) fail(path, problem);
}

}  // namespace

OutputFiles::~OutputFiles() {
    for (const File& file : files_) {
        std::error_code ignored;
        if (file.written) fs::remove(file.temporary, ignored);
    }
}

int OutputFiles::open_temporary(const File& file) {
    return ::open(file.temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

void OutputFiles::add(const std::string& path) {
    File file;
    file.path = path;
    std::error_code problem;
    // A link is followed: what it points at is replaced, not the link.
    file.target = fs::weakly_canonical(fs::absolute(path), problem);
    if (problem) file.target = path;
    for (const File& other : files_)
        if (other.target == file.target) throw InputError(path, {}, "two outputs cannot go to the same place");
    const fs::file_status status = fs::status(file.target, problem);
    if (fs::is_directory(status) && path != "-") fail(path, EISDIR);
    const bool in_place = path == "-" || (fs::exists(status) && !fs::is_regular_file(status));
    if (fs::exists(status) && path != "-" && ::access(file.target.c_str(), W_OK) != 0) fail(path, errno);
    if (!in_place) {
        file.temporary = file.target;
        file.temporary += fmt::format(".part{}", ::getpid());
        write_all(open_temporary(file), path, {});
        fs::remove(file.temporary, problem);
    }
    files_.push_back(file);
}

void OutputFiles::put(const std::string& path, std::string content) {
    for (File& file : files_)
        if (file.path == path) {
            file.content = std::move(content);
            return;
        }
}

void OutputFiles::commit() {
    for (File& file : files_) {
        if (file.temporary.empty()) continue;
        const int descriptor = open_temporary(file);
        file.written = descriptor >= 0;
        write_all(descriptor, file.path, file.content);
    }
    // A device can be full: it comes before the names, which cannot fail for lack of room.
    for (const File& file : files_) {
        if (!file.temporary.empty()) continue;
        const bool standard = file.path == "-";
        write_all(standard ? STDOUT_FILENO : ::open(file.target.c_str(), O_WRONLY | O_CLOEXEC), file.path,
                  file.content);
    }
    for (File& file : files_) {
        if (file.temporary.empty()) continue;
        if (::rename(file.temporary.c_str(), file.target.c_str()) != 0) fail(file.path, errno);
        file.written = false;
    }
}

}  // namespace achilles
