// Reading from disk.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "expression/nearest.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// The error of a missing file: it names the file with the nearest name beside it, or the folder that is missing.
InputError no_file(const std::filesystem::path& file) {
    std::error_code problem;
    const std::filesystem::path folder = file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder, problem))
        return {file.string(), {}, "there is no folder " + shown(folder.string())};
    std::vector<std::string> names;
    constexpr std::size_t most = 10000;
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, problem)) {
        if (names.size() == most) break;
        if (entry.is_regular_file(problem)) names.push_back(entry.path().filename().string());
    }
    const std::string best = nearest(file.filename().string(), names);
    return {file.string(),
            {},
            "there is no such file" + (best.empty() ? "" : "; did you mean " + shown((folder / best).string()) + "?")};
}

}  // namespace

std::string read_text(const std::filesystem::path& file, std::size_t largest) {
    const std::string name = file.string();
    const auto refuse = [&](const std::string& why) { return InputError(name, {}, "cannot read the file: " + why); };
    const auto reason = [] { return std::generic_category().message(errno); };

    struct Close {
        void operator()(std::FILE* open) const { std::fclose(open); }
    };
    // Without waiting: whoever opens a pipe that nobody writes to waits for ever.
    const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0 && errno == ENOENT) throw no_file(file);
    if (descriptor < 0) throw refuse(reason());
    const std::unique_ptr<std::FILE, Close> open(::fdopen(descriptor, "rb"));
    if (!open) throw refuse(reason());
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) throw refuse(reason());
    if (S_ISDIR(status.st_mode)) throw refuse("it is a directory");
    if (S_ISFIFO(status.st_mode)) throw refuse("it is a pipe");
    std::string text;
    char block[1 << 16];
    while (const std::size_t count = std::fread(block, 1, sizeof block, open.get())) {
        text.append(block, count);
        if (text.size() > largest) break;  // /dev/zero has no end
    }
    if (std::ferror(open.get()) != 0) throw refuse(reason());
    return text;
}

}  // namespace achilles
