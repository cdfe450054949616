// The log of an incomplete sweep.
#include "output/sweep_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

constexpr std::string_view magic = "Achilles sweep, unfinished: 2\n";

// FNV-1a, eight bytes at a time.
std::uint64_t checksum(std::string_view bytes, std::uint64_t hash = 0xCBF29CE484222325u) {
    constexpr std::uint64_t prime = 0x100000001B3u;
    while (bytes.size() >= 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data(), 8);
        hash = (hash ^ word) * prime;
        hash ^= hash >> 29;
        bytes.remove_prefix(8);
    }
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * prime;
    return hash ^ hash >> 32;
}

[[noreturn]] void fail(const std::string& path, int problem) {
    throw std::system_error(problem, std::generic_category(), path);
}

void write_all(int file, std::string_view bytes, std::uint64_t at, const std::string& path) {
    while (!bytes.empty()) {
        const ssize_t count = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(at));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail(path, count == 0 ? ENOSPC : errno);
        bytes.remove_prefix(static_cast<std::size_t>(count));
        at += static_cast<std::uint64_t>(count);
    }
}

// Reads `count` bytes, or fewer at the end of the file.
std::string read_some(int file, std::uint64_t count, std::uint64_t at, const std::string& path) {
    std::string bytes(count, '\0');
    std::size_t have = 0;
    while (have < bytes.size()) {
        const ssize_t more = ::pread(file, bytes.data() + have, bytes.size() - have, static_cast<off_t>(at + have));
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) fail(path, errno);
        if (more == 0) break;
        have += static_cast<std::size_t>(more);
    }
    bytes.resize(have);
    return bytes;
}

std::string text_of(const SweepKey& key) {
    std::string text;
    for (const std::string* part : {&key.software, &key.sweep, &key.files, &key.system})
        text += fmt::format("{}\n", part->size()) + *part + "\n";
    return text;
}

// Removes "SIZE\nTEXT\n" from the front. Returns false if the text does not start with it.
bool take_part(std::string_view& text, std::string& part) {
    const std::size_t end = text.find('\n');
    std::size_t size = 0;
    if (end == text.npos || end > 12) return false;
    for (const char c : text.substr(0, end)) {
        if (c < '0' || c > '9') return false;
        size = 10 * size + static_cast<std::size_t>(c - '0');
    }
    text.remove_prefix(end + 1);
    if (text.size() < size + 1) return false;
    part = text.substr(0, size);
    text.remove_prefix(size + 1);
    return true;
}

}  // namespace

std::string difference(const SweepKey& log, const SweepKey& current) {
    const auto two = [](const char* what, const std::string& there, const std::string& here) {
        return fmt::format("{}\n    there: {}\n    here:  {}", what, printable(there), here);
    };
    if (log.software != current.software)
        return two("it was started by a different version", log.software, current.software);
    if (log.sweep != current.sweep) return two("it is a different sweep", log.sweep, current.sweep);
    if (log.files != current.files) return two("it writes other output files", log.files, current.files);
    if (log.system == current.system) return "";
    for (int line = 1;; ++line) {
        const std::string there = line_of(log.system, line), here = line_of(current.system, line);
        if (there != here) return two(fmt::format("the system has changed in line {}", line).c_str(), there, here);
        if (line > 100000) return "the system has changed";
    }
}

// Precedes the bytes of each chunk.
struct SweepLog::Header {
    std::uint64_t first, count, size, sum;
    std::uint64_t expected(std::string_view bytes) const {
        const std::array<std::uint64_t, 3> numbers{first, count, size};
        return checksum(bytes, checksum({reinterpret_cast<const char*>(numbers.data()), sizeof numbers}));
    }
};

SweepLog::SweepLog(std::string path, const SweepKey& key, bool resume, std::uint64_t points) : path_(std::move(path)) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) throw InputError(path_, {}, fmt::format("the file cannot be written: {}", std::strerror(errno)));
    struct stat there {};
    const bool is_file = ::fstat(file_, &there) == 0 && S_ISREG(there.st_mode);
    try {
        if (!is_file) throw InputError(path_, {}, "this is not a file");
        if (::flock(file_, LOCK_EX | LOCK_NB) != 0) throw InputError(path_, {}, "another process is writing to it");
        if (there.st_size > 0)
            go_on(key, resume, points);
        else
            begin(key);
    } catch (...) {
        if (is_file && there.st_size == 0) ::unlink(path_.c_str());  // the file is new or was empty
        ::close(file_);
        throw;
    }
}

void SweepLog::go_on(const SweepKey& key, bool resume, std::uint64_t points) {
    SweepKey known;
    if (!read_key(known))
        throw InputError(path_, {}, "the sweep stores its progress here, but this file is not an unfinished sweep",
                         "choose another name");
    find_end();
    const std::string different = difference(known, key), anew = "delete this file to start over";
    if (done_ == 0 && !different.empty()) return begin(key);
    if (done_ >= points && different.empty()) return;
    if (!resume && done_ > 0)
        throw InputError(path_, {}, fmt::format("this is an unfinished sweep with {} points", done_),
                         different.empty() ? "--resume continues it; " + anew : anew);
    if (!different.empty()) throw InputError(path_, {}, "this unfinished sweep cannot be resumed: " + different, anew);
}

SweepLog::~SweepLog() {
    if (file_ >= 0) ::close(file_);
}

void SweepLog::begin(const SweepKey& key) {
    const std::string text = std::string(magic) + text_of(key);
    if (::ftruncate(file_, 0) != 0) fail(path_, errno);
    write_all(file_, text, 0, path_);
    done_ = 0;
    first_ = size_ = text.size();
}

bool SweepLog::read_key(SweepKey& key) {
    constexpr std::uint64_t most = 2 * largest_file;
    const std::string begin = read_some(file_, most, 0, path_);
    std::string_view text = begin;
    if (!text.starts_with(magic)) return magic.starts_with(text) && begin.size() < magic.size();
    text.remove_prefix(magic.size());
    for (std::string* part : {&key.software, &key.sweep, &key.files, &key.system})
        if (!take_part(text, *part)) {
            key = {};  // writing was interrupted here, so there are no points to lose
            first_ = begin.size();
            return true;
        }
    first_ = begin.size() - text.size();
    return true;
}

// The end of the last valid chunk that follows its predecessor without a gap.
void SweepLog::find_end() {
    size_ = first_;
    done_ = 0;
    for (;;) {
        const std::string bytes = read_some(file_, sizeof(Header), size_, path_);
        Header header{};
        if (bytes.size() < sizeof header) break;
        std::memcpy(&header, bytes.data(), sizeof header);
        constexpr std::uint64_t largest = std::uint64_t{1} << 40;
        struct stat there {};
        if (::fstat(file_, &there) != 0 || header.size > largest || header.first != done_ || header.count == 0 ||
            size_ + sizeof header + header.size > static_cast<std::uint64_t>(there.st_size))
            break;
        if (header.sum != header.expected(read_some(file_, header.size, size_ + sizeof header, path_))) break;
        size_ += sizeof header + header.size;
        done_ += header.count;
    }
    if (::ftruncate(file_, static_cast<off_t>(size_)) != 0) fail(path_, errno);
}

void SweepLog::append(Chunk chunk, const std::string& bytes) {
    Header header{chunk.first, chunk.count, bytes.size(), 0};
    header.sum = header.expected(bytes);
    try {
        write_all(file_, bytes, size_ + sizeof header, path_);
        write_all(file_, {reinterpret_cast<const char*>(&header), sizeof header}, size_, path_);
    } catch (const std::system_error&) {
        // If this fails, too, the partial record fails its checksum.
        [[maybe_unused]] const int ignored = ::ftruncate(file_, static_cast<off_t>(size_));
        throw;
    }
    size_ += sizeof header + bytes.size();
    done_ += chunk.count;
}

void SweepLog::each(const std::function<void(Chunk, std::string_view)>& take) const {
    for (std::uint64_t at = first_; at < size_;) {
        Header header{};
        std::memcpy(&header, read_some(file_, sizeof header, at, path_).data(), sizeof header);
        const std::string bytes = read_some(file_, header.size, at + sizeof header, path_);
        take({header.first, header.count}, bytes);
        at += sizeof header + header.size;
    }
}

void SweepLog::remove() { ::unlink(path_.c_str()); }

}  // namespace achilles
