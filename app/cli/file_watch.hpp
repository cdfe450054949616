// Watches the file of the system for changes by another program, such as an editor beside the window.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace achilles {

class FileWatch {
 public:
    // `changed` is called on another thread when the file was written, or replaced by another one.
    explicit FileWatch(std::function<void()> changed) : changed_(std::move(changed)) {}
    ~FileWatch() { stop(); }
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    // The file to watch; empty: none. Where the system cannot watch files, nothing is ever reported.
    void follow(const std::string& file);
    // True once after each change.
    bool take_change() { return has_changed_.exchange(false); }

 private:
    void stop();
    void watch(int notices, int end, const std::string& name);

    std::function<void()> changed_;
    std::string file_;
    std::atomic<bool> has_changed_{false};
    int notices_ = -1, end_ = -1;  // descriptors: of the notices, and of the event that ends the thread
    std::thread thread_;
};

}  // namespace achilles
