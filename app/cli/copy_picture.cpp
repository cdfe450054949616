#include <cstdio>
#include <cstdlib>
#include <string>

#include "cli/explore.hpp"
#include "pictures/picture_format.hpp"
#include "system/input_error.hpp"

namespace achilles {

// A program that stays in the background serves the picture, since the window's library copies text only.
void copy_picture(const std::string& png) {
    const bool is_wayland = std::getenv("WAYLAND_DISPLAY") != nullptr && !find_program("wl-copy").empty();
    if (!is_wayland && find_program("xclip").empty())
        throw InputError("copy picture", {}, "copying a picture needs xclip or wl-copy, and neither is installed",
                         "install the package xclip, or write a file: export figure.png");
    const char* const line =
        is_wayland ? "wl-copy --type image/png" : "xclip -selection clipboard -t image/png >/dev/null";
    std::FILE* const pipe = ::popen(line, "w");
    const bool is_written = pipe != nullptr && std::fwrite(png.data(), 1, png.size(), pipe) == png.size();
    if (pipe == nullptr || ::pclose(pipe) != 0 || !is_written)
        throw InputError("copy picture", {}, "the picture could not be put on the clipboard");
}

}  // namespace achilles
