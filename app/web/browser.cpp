#include "web/browser.hpp"

#include <emscripten.h>
#include <spawn.h>
#include <cerrno>

#include "cli/explore.hpp"
#include "cli/file_watch.hpp"

// clang-format off
EM_JS(void, download_file, (const char* file), {
    const path = UTF8ToString(file);
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([FS.readFile(path)]));
    link.download = path.split('/').pop();
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
})
EM_JS(void, ask_for_file, (), {
    const field = document.createElement('input');
    field.type = 'file';
    field.accept = '.toml,.journal,.svg,.png';
    field.addEventListener('change', () => takeFiles(field.files));
    field.click();
})
EM_JS(void, write_picture, (const void* bytes, int size), {
    const picture = new Blob([HEAPU8.slice(bytes, bytes + size)], {type: 'image/png'});
    navigator.clipboard.write([new ClipboardItem({'image/png': picture})])
        .catch((problem) => window.alert('The browser does not copy pictures: ' + problem.message));
})
// Browsers offer the clipboard to pages that come encrypted or from the same machine.
EM_JS(int, has_clipboard, (), { return navigator.clipboard && window.ClipboardItem ? 1 : 0; })
// clang-format on

namespace achilles {

void download(const std::string& file) { download_file(file.c_str()); }

void choose_file() { ask_for_file(); }

void copy_picture(const std::string& png) {
    if (has_clipboard() == 0)
        throw InputError("copy picture", {}, "this browser has no clipboard for pictures here",
                         "use File, Export figure");
    write_picture(png.data(), static_cast<int>(png.size()));
}

// No other program writes the files of a page, which are in memory.
void FileWatch::follow(const std::string&) {}
void FileWatch::stop() {}

}  // namespace achilles

// A page starts no other program. The code of films and PDF files, which a page does not reach, asks for one.
extern "C" int posix_spawnp(pid_t*, const char*, const posix_spawn_file_actions_t*, const posix_spawnattr_t*,
                            char* const[], char* const[]) {
    return ENOSYS;
}
