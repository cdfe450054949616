// Reads files from disk, and recognizes files that are not system files.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "expression/name_suggestions.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"
#include "system/read_tables.hpp"

namespace achilles {

namespace {

// The error for a missing file: suggests the file with the nearest name in its folder, or names the missing folder.
InputError no_file(const std::filesystem::path& file) {
    std::error_code problem;
    const std::filesystem::path folder = file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder, problem))
        return {file.string(), {}, "there is no folder " + shown(folder.string())};
    std::vector<std::string> names;
    constexpr std::size_t max_names = 10000;
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, problem)) {
        if (names.size() == max_names) break;
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
    // Does not block: opening a pipe without a writer would wait forever.
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

namespace {

struct BinaryFormat {
    std::string_view begins, what, advice;
};

constexpr std::string_view reproduce = "achilles reproduce FILE prints the command that made it",
                           start_from_new = "achilles new NAME writes a system file to start from";

// First bytes of binary files.
constexpr BinaryFormat of_bytes[] = {
    {"\x89PNG", "a PNG picture", reproduce},
    {"%PDF", "a PDF document", reproduce},
    {"\xff\xd8\xff", "a JPEG picture", start_from_new},
    {"GIF8", "a GIF picture", start_from_new},
    {"\x89HDF", "an HDF5 file", start_from_new},
    {"PK\x03\x04", "a ZIP archive (a Simulink .slx is one), not a system file", start_from_new},
    {"\x1f\x8b", "a compressed file", "unpack it first: gunzip FILE"},
    {"\x7f"
     "ELF",
     "a program", start_from_new},
    {"MATLAB 5.0", "a MAT file", start_from_new},
};

// First characters of text files, after white space.
constexpr BinaryFormat of_texts[] = {
    {"<svg", "an SVG picture", reproduce},
    {"<?xml", "an SVG picture or other XML", reproduce},
    {"<", "HTML or XML", start_from_new},
    {"{", "JSON, but a system file is TOML", start_from_new},
    {"[{", "JSON, but a system file is TOML", start_from_new},
    {"%", "Matlab or LaTeX, but a system file is TOML", start_from_new},
    {"\\documentclass", "LaTeX, but a system file is TOML", start_from_new},
    {"function ", "Matlab, but a system file is TOML", start_from_new},
    {"import ", "Python, but a system file is TOML", start_from_new},
    {"from ", "Python, but a system file is TOML", start_from_new},
    {"def ", "Python, but a system file is TOML", start_from_new},
    {"model ", "Modelica, but a system file is TOML", start_from_new},
    {"package ", "Modelica, but a system file is TOML", start_from_new},
    {"---", "YAML, but a system file is TOML", start_from_new},
    {"```", "Markdown", "remove the lines with ```"},
};

[[noreturn]] void refuse(const std::string& name, std::string_view what, std::string_view advice) {
    throw InputError(name, {}, fmt::format("this is {}", what), std::string(advice));
}

// True for CSV, which starts like t,phase,x,... or with numbers separated by commas.
bool is_table(std::string_view text) {
    const std::string_view line = text.substr(0, text.find('\n'));
    return std::count(line.begin(), line.end(), ',') >= 2 && line.find_first_of("=[#\"'") == line.npos;
}

}  // namespace

void refuse_other_files(std::string_view text, const std::string& name) {
    const std::string_view head = text.substr(0, 256);
    for (const BinaryFormat& kind : of_bytes)
        if (head.starts_with(kind.begins)) refuse(name, kind.what, kind.advice);
    if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff") ||
        (head.size() > 3 && (head[1] == '\0' || head[0] == '\0') && head.find_first_not_of('\0') != head.npos))
        refuse(name, "text in UTF-16", "save it as UTF-8");
    if (head.find('\0') != head.npos) refuse(name, "not text: it contains zero bytes", start_from_new);
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == text.npos) throw InputError(name, {}, "the file is empty", std::string(start_from_new));
    text.remove_prefix(first);
    for (const BinaryFormat& kind : of_texts) {
        if (!text.starts_with(kind.begins)) continue;
        const bool is_key = kind.begins.ends_with(' ') && text.substr(kind.begins.size()).starts_with("=");
        if (!is_key) refuse(name, kind.what, kind.advice);
    }
    if (is_table(text)) refuse(name, "a table, but a system file is TOML", start_from_new);
}

}  // namespace achilles
