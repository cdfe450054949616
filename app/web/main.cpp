// The explorer on a page. The page passes what follows # in its address: the session of a link, if any.
#include <emscripten.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

#include "cli/explore.hpp"
#include "journal/link.hpp"
#include "web/browser.hpp"

extern "C" void show_failure(const char* text);  // window.cpp

namespace {

// What the user opens and saves, in memory.
constexpr const char* folder = "/files";

achilles::ExploreOptions options_of(const std::string& fragment) {
    achilles::ExploreOptions options;
    options.page = achilles::PageFunctions{achilles::download, achilles::choose_file};
    // A fragment without a session is the start of a link that was cut off: the explorer says so.
    if (!fragment.empty()) options.journal = achilles::is_link(fragment) ? fragment : "#run=";
    return options;
}

// The browser calls for frames after main() has returned, so the window is never destroyed.
achilles::ExplorerWindow* window = nullptr;

// What the functions below return stays until the next call of one of them.
template <class Text>
const char* kept(const Text& text) {
    static std::string last;
    try {
        last = text();
    } catch (const std::exception& problem) {
        last = std::string("failed: ") + problem.what();
    }
    return last.c_str();
}

}  // namespace

// For tests of the page (tests/web): the session as text, the event times of its run with all their bits, the time its
// computation took, what was copied, and the place of a control, as "left top width height" in pixels.
extern "C" EMSCRIPTEN_KEEPALIVE const char* achilles_session() {
    return kept([] { return to_text(window->session()); });
}
extern "C" EMSCRIPTEN_KEEPALIVE const char* achilles_events() {
    return kept([] {
        std::string text;
        for (const achilles::Event& event : window->session().trajectory().events)
            text += fmt::format("{:a}\n", event.t);
        return text;
    });
}
extern "C" EMSCRIPTEN_KEEPALIVE const char* achilles_place(const char* control) {
    const auto& places = window->panels().places;
    const auto found = places.find(control);
    if (found == places.end()) return "";
    const achilles::Rectangle& area = found->second;
    return kept([&] { return fmt::format("{} {} {} {}", area.x, area.y, area.width, area.height); });
}
extern "C" EMSCRIPTEN_KEEPALIVE const char* achilles_seconds() {
    return kept([] { return fmt::format("{}", window->session().trajectory().statistics.seconds); });
}
extern "C" EMSCRIPTEN_KEEPALIVE const char* achilles_copied() {
    return kept([] { return window->session().copied(); });
}

// Arguments: the address of the page, and what follows # in it.
int main(int count, char** words) try {
    if (count > 1) setenv("ACHILLES_WEB", words[1], 1);
    setenv("ACHILLES_ASSETS", "/assets", 1);
    umask(S_IWGRP | S_IWOTH);  // Emscripten starts with 0777, and nobody could read a new file.
    std::filesystem::create_directory(folder);
    std::filesystem::current_path(folder);
    window = new achilles::ExplorerWindow(options_of(count > 2 ? words[2] : ""));
    window->run();
    return 0;
} catch (const std::exception& problem) {
    show_failure(problem.what());
    return 2;
}
