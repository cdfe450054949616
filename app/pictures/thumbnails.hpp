// Small pictures of systems for the gallery, computed on another thread when needed, and cached.
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

// The mechanism at the first Zeno point or, without one, after a third of the run, with its trail until then.
struct Thumbnail {
    Drawing light, dark;  // empty if the system has no drawing or cannot run
};
// Deterministic: the same file gives the same picture. Never throws; errors are reported when the system is opened.
Thumbnail thumbnail_of(const std::filesystem::path& system);

class Thumbnails {
 public:
    // `find` returns the file of a system. With `waits`, find() below computes each thumbnail at once, as needed for a
    // picture.
    Thumbnails(std::function<std::filesystem::path(const std::string&)> find, bool waits);
    // `ready` is called on another thread when a thumbnail is finished.
    void on_ready(const std::function<void()>& ready) { worker_.on_ready(ready); }

    // Null while it is being computed. Only systems requested since the last update() are computed, in order of
    // request.
    const Thumbnail* find(const std::string& system);
    // Receives a finished thumbnail and starts the next; call once per frame.
    void update();
    bool is_busy() const { return !in_progress_.empty() || !queue_.empty(); }

 private:
    std::function<std::filesystem::path(const std::string&)> find_;
    bool waits_;
    std::map<std::string, Thumbnail> thumbnails_;
    std::vector<std::string> queue_;
    std::string in_progress_;
    Worker<std::shared_ptr<Thumbnail>> worker_;
};

}  // namespace achilles
