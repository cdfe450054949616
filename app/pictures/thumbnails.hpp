// Small pictures of systems, made one after the other on a thread of their own when somebody looks for them, and kept.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "figure/figure.hpp"
#include "session/worker.hpp"

namespace achilles {

// The mechanism where the first bouncing comes to rest, or after a third of a run without one, with the way until then.
struct Thumbnail {
    Drawing light, dark;  // nothing in them: the system draws no mechanism, or cannot run
};
// The same file gives the same picture. Never throws: what is wrong with a system is told where it is opened.
Thumbnail thumbnail_of(const std::filesystem::path& system);

class Thumbnails {
 public:
    // `find` leads from a name to a file. `waits`: each is made when it is asked for, as a picture of the explorer wants it.
    Thumbnails(std::function<std::filesystem::path(const std::string&)> find, bool waits);
    // Called on another thread when one is ready.
    void on_ready(std::function<void()> ready) { worker_.on_ready(std::move(ready)); }

    // Null while it is being made. Only the systems asked for since the last frame are made, in the order of asking.
    const Thumbnail* find(const std::string& system);
    // Takes in what is ready and begins the next; once a frame.
    void update();
    bool is_busy() const { return !making_.empty() || !wanted_.empty(); }

 private:
    std::function<std::filesystem::path(const std::string&)> find_;
    bool waits_;
    std::map<std::string, Thumbnail> made_;
    std::vector<std::string> wanted_;
    std::string making_;
    Worker<std::shared_ptr<Thumbnail>> worker_;
};

}  // namespace achilles
