#include "pictures/frame_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "cli/write_files.hpp"
#include "image/notes.hpp"
#include "pictures/origin.hpp"
#include "system/description.hpp"

namespace achilles {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(fs::path folder) : path_(std::move(folder)) {
    std::error_code problem;
    is_created_ = fs::create_directories(path_, problem);
    if (!fs::is_directory(path_))
        throw InputError(path_.string(), {}, fmt::format("the folder cannot be created: {}", problem.message()));
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    if (is_created_) fs::remove(path_, ignored);  // succeeds only if it is empty
}

namespace {

constexpr std::string_view prefix = "frame_", picture_ending = ".png", unfinished = ".png.part";
constexpr std::size_t digits = 5, largest_frame = std::size_t{1} << 30;  // bytes

// The number in "frame_00042.png" and the text after the digits; empty for another name.
std::optional<std::pair<std::size_t, std::string>> parsed(const std::string& name) {
    if (name.rfind(prefix, 0) != 0 || name.size() < prefix.size() + digits) return std::nullopt;
    std::size_t number = 0;
    for (const char c : name.substr(prefix.size(), digits)) {
        if (c < '0' || c > '9') return std::nullopt;
        number = 10 * number + static_cast<std::size_t>(c - '0');
    }
    return std::pair{number, name.substr(prefix.size() + digits)};
}

// True if the file is the frame with these notes; false if it is truncated or damaged, e.g. by an interrupted copy.
// Throws InputError if it is a different picture.
bool is_frame(const fs::path& file, const Notes& notes) {
    const std::string bytes = read_text(file, largest_frame);
    const auto refuse = [&](const std::string& why) {
        return InputError(file.string(), {}, why, "draw into another folder, or add --overwrite to replace this file");
    };
    if (bytes.empty()) return false;
    if (picture_format(bytes) != "png") throw refuse("this is not a frame of an animation");
    Origin there;
    try {
        if (png_notes(bytes) == notes) return true;
        there = origin_of(bytes);
    } catch (const std::runtime_error& problem) {
        if (std::string_view(problem.what()).find("does not contain the command") == std::string_view::npos)
            return false;
        throw refuse("this is not a frame of an animation");
    }
    const auto wanted = [&](std::string_view key) {
        const auto at = std::find_if(notes.begin(), notes.end(), [&](const Note& note) { return note.keyword == key; });
        return at == notes.end() ? std::string() : at->text;
    };
    if (there.command != wanted("Achilles Command"))
        throw refuse("this picture was made by another command:\n    " + there.command);
    if (there.software != wanted("Software")) throw refuse("this picture was made by " + there.software);
    throw refuse("this picture was made by the same command, but from a system file that has changed since");
}

}  // namespace

std::string frame_name(std::size_t number) { return fmt::format("{}{:05}", prefix, number); }

FrameFolder::FrameFolder(fs::path folder) : folder_(std::move(folder)) {
    lock_ = ::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    // Some file systems do not support locks; then other processes are not kept out.
    if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(lock_);
        throw InputError(folder_.path().string(), {}, "another process is drawing into this folder");
    }
}

FrameFolder::~FrameFolder() {
    if (lock_ >= 0) ::close(lock_);
}

std::vector<std::size_t> FrameFolder::missing(std::size_t count,
                                              const std::function<Notes(const std::string& name)>& notes_of,
                                              bool overwrite) const {
    std::vector<bool> there(count, false);
    std::vector<std::pair<std::size_t, fs::path>> frames;
    std::vector<fs::path> waste;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
        const auto name = parsed(entry.path().filename().string());
        if (!name) continue;
        if (name->second == picture_ending) frames.emplace_back(name->first, entry.path());
        if (name->second.rfind(unfinished, 0) == 0) waste.push_back(entry.path());
    }
    std::sort(frames.begin(), frames.end());  // so that the first bad file is the one reported
    for (const auto& [number, path] : frames) {
        try {
            const bool whole = is_frame(path, notes_of(frame_name(number)));
            if (number < count)
                there[number] = whole;
            else
                waste.push_back(path);
        } catch (const InputError&) {
            if (!overwrite) throw;
            if (number >= count) waste.push_back(path);
        }
    }
    for (const fs::path& path : waste) fs::remove(path);
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < count; ++i)
        if (!there[i]) numbers.push_back(i);
    return numbers;
}

void FrameFolder::write(std::size_t number, std::string png) const {
    OutputFiles files;
    const std::string path = file(number).string();
    files.add(path);
    files.put(path, std::move(png));
    files.commit(OutputFiles::Durability::fast);
}

void FrameFolder::try_to_write(std::size_t number) const { OutputFiles().add(file(number).string()); }

}  // namespace achilles
