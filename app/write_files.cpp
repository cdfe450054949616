#include "write_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "model/description.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, int reason) {
    throw InputError(path == "-" ? "standard output" : path, {},
                     fmt::format("the file cannot be written: {}", std::strerror(reason)));
}

}  // namespace

OutputFiles::~OutputFiles() {
    for (const File& file : files_) {
        if (file.descriptor > STDERR_FILENO) ::close(file.descriptor);
        std::error_code ignored;
        if (!file.temporary.empty()) fs::remove(file.temporary, ignored);
    }
}

void OutputFiles::add(const std::string& path) {
    File file;
    file.path = path;
    std::error_code problem;
    // A link is followed: what it points at is replaced, not the link.
    file.target = fs::weakly_canonical(path, problem);
    if (problem) file.target = path;
    for (const File& other : files_)
        if (other.target == file.target) throw InputError(path, {}, "two outputs cannot go to the same place");
    const fs::file_status status = fs::status(file.target, problem);
    if (path == "-") {
        file.descriptor = STDOUT_FILENO;
    } else if (fs::is_directory(status)) {
        fail(path, EISDIR);
    } else if (fs::exists(status) && !fs::is_regular_file(status)) {  // a device or a pipe has no other name
        file.descriptor = ::open(file.target.c_str(), O_WRONLY | O_CLOEXEC);
    } else if (fs::exists(status) && ::access(file.target.c_str(), W_OK) != 0) {
        fail(path, errno);
    } else {
        file.temporary = file.target;
        file.temporary += fmt::format(".part{}", ::getpid());
        file.descriptor = ::open(file.temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (file.descriptor < 0) fail(path, errno);
    files_.push_back(file);
}

void OutputFiles::write(const std::string& path, const std::string& content) {
    for (const File& file : files_) {
        if (file.path != path) continue;
        std::size_t done = 0;
        while (done < content.size()) {
            const ssize_t count = ::write(file.descriptor, content.data() + done, content.size() - done);
            if (count < 0 && errno != EINTR) fail(path, errno);
            if (count > 0) done += static_cast<std::size_t>(count);
        }
    }
}

void OutputFiles::commit() {
    for (File& file : files_) {
        if (file.temporary.empty()) continue;
        const int descriptor = std::exchange(file.descriptor, -1);
        if (::close(descriptor) != 0) fail(file.path, errno);
    }
    for (File& file : files_) {
        if (file.temporary.empty()) continue;
        if (::rename(file.temporary.c_str(), file.target.c_str()) != 0) fail(file.path, errno);
        file.temporary.clear();
    }
}

}  // namespace achilles
