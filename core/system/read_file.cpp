// Reading from disk.
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "system/description.hpp"

namespace achilles {

std::string read_text(const std::filesystem::path& file, std::size_t largest) {
    const std::string name = file.string();
    const auto refuse = [&](const std::string& why) { return InputError(name, {}, "cannot read the file: " + why); };
    const auto reason = [] { return std::generic_category().message(errno); };

    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) throw refuse("it is a directory");
    struct Close {
        void operator()(std::FILE* open) const { std::fclose(open); }
    };
    const std::unique_ptr<std::FILE, Close> open(std::fopen(name.c_str(), "rb"));
    if (!open && errno == ENOENT) throw InputError(name, {}, "there is no such file");
    if (!open) throw refuse(reason());
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
