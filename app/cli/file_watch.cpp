#include "cli/file_watch.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>

namespace achilles {

void FileWatch::follow(const std::string& file) {
    if (file == file_) return;
    stop();
    file_ = file;
    if (file.empty()) return;
    // The folder is watched, since many editors write another file and rename it.
    std::error_code problem;
    const std::filesystem::path path = std::filesystem::absolute(file, problem);
    notices_ = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    end_ = ::eventfd(0, EFD_CLOEXEC);
    if (notices_ < 0 || end_ < 0 ||
        ::inotify_add_watch(notices_, path.parent_path().c_str(), IN_CLOSE_WRITE | IN_MOVED_TO) < 0)
        return;
    thread_ = std::thread(
        [this, notices = notices_, end = end_, name = path.filename().string()] { watch(notices, end, name); });
}

void FileWatch::stop() {
    const std::uint64_t one = 1;
    if (thread_.joinable() && ::write(end_, &one, sizeof one) == sizeof one) thread_.join();
    for (int* const descriptor : {&notices_, &end_}) {
        if (*descriptor >= 0) ::close(*descriptor);
        *descriptor = -1;
    }
    has_changed_ = false;
}

void FileWatch::watch(int notices, int end, const std::string& name) {
    std::array<pollfd, 2> ready{pollfd{notices, POLLIN, 0}, pollfd{end, POLLIN, 0}};
    alignas(inotify_event) std::array<char, 4096> bytes{};
    while (::poll(ready.data(), ready.size(), -1) >= 0 && ready[1].revents == 0) {
        const ssize_t count = ::read(notices, bytes.data(), bytes.size());
        for (ssize_t at = 0; at < count;) {
            const auto* const notice = reinterpret_cast<const inotify_event*>(bytes.data() + at);
            if (notice->len > 0 && name == notice->name) {
                has_changed_ = true;
                changed_();
            }
            at += static_cast<ssize_t>(sizeof(inotify_event) + notice->len);
        }
    }
}

}  // namespace achilles
