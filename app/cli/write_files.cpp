#include "cli/write_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>
#include <utility>

#include "cli/terminal.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void cannot_write(const std::string& path, int reason) {
    std::error_code ignored;
    const fs::path folder = fs::path(path).parent_path();
    if (reason == ENOENT && !folder.empty() && !fs::is_directory(folder, ignored))
        throw InputError(path, {}, "there is no folder " + shown(folder.string()));
    throw InputError(path == "-" ? "standard output" : path, {},
                     fmt::format("the file cannot be written: {}", std::strerror(reason)));
}

// Writes and closes the file; standard output stays open. With `to_disk` the data are flushed to disk.
void write_all(int descriptor, const std::string& path, const std::string& content, bool to_disk = false) {
    if (descriptor < 0) cannot_write(path, errno);
    int problem = 0;
    for (std::size_t done = 0; done < content.size() && problem == 0;) {
        const ssize_t count = ::write(descriptor, content.data() + done, content.size() - done);
        if (count >= 0)
            done += static_cast<std::size_t>(count);
        else if (errno != EINTR)
            problem = errno;
    }
    if (to_disk && problem == 0 && ::fsync(descriptor) != 0 && errno != EINVAL) problem = errno;
    if (descriptor != STDOUT_FILENO && ::close(descriptor) != 0 && problem == 0) problem = errno;
    if (problem != 0) cannot_write(path, problem);
}

// Flushes a folder so that renames survive a power failure. A folder that cannot be opened is skipped.
void keep_names(const fs::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

// Resolves symbolic links: their target is replaced or created, not the link.
fs::path place_of(const std::string& path) {
    std::error_code problem;
    fs::path place = fs::absolute(path, problem);
    constexpr int max_links = 40;
    for (int i = 0; i < max_links && !fs::exists(place, problem) && fs::is_symlink(place, problem); ++i)
        place = place.parent_path() / fs::read_symlink(place, problem);
    const fs::path whole = fs::weakly_canonical(place, problem);
    return problem ? fs::path(path) : whole;
}

// The mode of a new file, from the umask.
mode_t default_file_mode() {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return 0666 & ~mask;
}

// Exchanges two files. False if the system or the file system cannot.
bool exchange_names(const char* a, const char* b) {
#if defined(RENAME_EXCHANGE)
    return ::renameat2(AT_FDCWD, a, AT_FDCWD, b, RENAME_EXCHANGE) == 0;
#else
    static_cast<void>(a), static_cast<void>(b);
    return false;
#endif
}

}  // namespace

int open_in_place(const std::string& path) {
    const int at_once = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
    if (at_once >= 0) {
        ::fcntl(at_once, F_SETFL, ::fcntl(at_once, F_GETFL) & ~O_NONBLOCK);
        return at_once;
    }
    if (errno != ENXIO) return at_once;
    print_clean(stderr, "achilles: {}: waiting for a program that reads this pipe\n", path);
    return ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
}

OutputFiles::~OutputFiles() {
    for (const File& file : files_) {
        std::error_code ignored;
        if (!file.temporary.empty()) fs::remove(file.temporary, ignored);
    }
}

std::optional<OutputFiles::Identity> OutputFiles::identity_of(const std::string& path) {
    struct stat there {};
    const int problem = path == "-" ? ::fstat(STDOUT_FILENO, &there) : ::stat(path.c_str(), &there);
    if (problem != 0 || !S_ISREG(there.st_mode)) return std::nullopt;
    return Identity{there.st_dev, there.st_ino};
}

void OutputFiles::protect_input(const fs::path& input) {
    if (const auto identity = identity_of(input.string())) spared_.emplace_back(input, *identity);
    refuse_inputs();
}

void OutputFiles::refuse_inputs() const {
    for (const File& file : files_)
        for (const auto& [input, identity] : spared_)
            if (file.identity == identity)
                throw InputError(file.path == "-" ? "standard output" : file.path, {},
                                 fmt::format("this output would overwrite the input file {}", input.string()),
                                 "write to another file");
}

int OutputFiles::open_temporary(File& file) {
    std::string name = file.target.string() + ".partXXXXXX";
    const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0) return descriptor;
    file.temporary = name;
    struct stat there {};
    const bool is_there = ::stat(file.target.c_str(), &there) == 0;
    mode_t mode = is_there ? there.st_mode & 07777 : default_file_mode();
    // If the owner cannot be kept, drop setuid and setgid bits: they must not apply to another owner.
    if (is_there && ::fchown(descriptor, there.st_uid, there.st_gid) != 0) mode &= 0777;
    if (::fchmod(descriptor, mode) != 0) ::fchmod(descriptor, mode & 0777);  // some file systems do not support modes
    return descriptor;
}

void OutputFiles::add(const std::string& path) {
    File file;
    file.path = path;
    std::error_code problem;
    file.target = place_of(path);
    file.identity = identity_of(path);
    refuse_output(path);
    const fs::file_status status = fs::status(file.target, problem);
    if (fs::is_directory(status) && path != "-") cannot_write(path, EISDIR);
    file.in_place = path == "-" || (fs::exists(status) && !fs::is_regular_file(status));
    if (fs::exists(status) && path != "-" && ::access(file.target.c_str(), W_OK) != 0) cannot_write(path, errno);
    if (!file.in_place) {
        write_all(open_temporary(file), path, {});
        fs::remove(std::exchange(file.temporary, {}), problem);
    }
    files_.push_back(file);
    refuse_inputs();
}

void OutputFiles::refuse_output(const std::string& path) const {
    const fs::path target = place_of(path);
    const auto identity = identity_of(path);
    for (const File& other : files_)
        if (other.target == target || (identity && other.identity == identity))
            throw InputError(path, {}, "two outputs cannot go to the same file");
}

void OutputFiles::put(const std::string& path, std::string content) {
    for (File& file : files_)
        if (file.path == path) {
            file.content = std::move(content);
            return;
        }
}

// Renames the temporary file to the target. If the file system can exchange names, the old file is kept until all are
// renamed.
void OutputFiles::commit_rename(File& file) {
    const char *from = file.temporary.c_str(), *to = file.target.c_str();
    std::error_code problem;
    const fs::file_status there = fs::symlink_status(file.target, problem);
    if (fs::is_directory(there)) cannot_write(file.path, EISDIR);
    file.swapped = fs::exists(there) && exchange_names(from, to);
    if (file.swapped) return;
    if (::rename(from, to) != 0) cannot_write(file.path, errno);
    file.made = !fs::exists(there);
    file.temporary.clear();
}

void OutputFiles::roll_back(File& file) {
    if (file.swapped)
        exchange_names(file.temporary.c_str(), file.target.c_str());
    else if (file.made)
        ::unlink(file.target.c_str());
}

void OutputFiles::commit(Durability care) {
    refuse_inputs();
    for (File& file : files_)
        if (!file.in_place) write_all(open_temporary(file), file.path, file.content, care == Durability::fsync);
    // Devices can be full, so they are written before the renames, which need no space.
    for (const File& file : files_) {
        if (!file.in_place) continue;
        const bool standard = file.path == "-";
        write_all(standard ? STDOUT_FILENO : open_in_place(file.target.string()), file.path, file.content);
    }
    std::set<fs::path> folders;
    try {
        for (File& file : files_) {
            if (file.in_place) continue;
            commit_rename(file);
            folders.insert(file.target.parent_path());
        }
    } catch (const InputError&) {
        for (File& file : files_) roll_back(file);
        throw;
    }
    for (const fs::path& folder : folders)
        if (care == Durability::fsync) keep_names(folder);
}

}  // namespace achilles
