#include "session/folder_entries.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

namespace achilles {

namespace fs = std::filesystem;

namespace {

std::string small(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace

PathParts parts_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return {"", path};
    return {path.substr(0, slash + 1), path.substr(slash + 1)};
}

std::string expanded(const std::string& path) {
    const char* home = std::getenv("HOME");
    return home != nullptr && path.rfind("~/", 0) == 0 ? home + path.substr(1) : path;
}

std::vector<FolderEntry> entries_of(const std::string& folder, const std::vector<std::string>& endings, bool hidden) {
    std::vector<FolderEntry> entries;
    std::error_code problem;
    fs::directory_iterator at(folder.empty() ? "." : folder, fs::directory_options::skip_permission_denied, problem);
    constexpr std::size_t max_visited = 20000;  // limits the time spent in a frame
    for (std::size_t n = 0; !problem && at != fs::directory_iterator() && n < max_visited; at.increment(problem), ++n) {
        if (entries.size() == max_entries) break;
        const std::string name = at->path().filename().string();
        std::error_code gone;
        const bool is_folder = at->is_directory(gone);
        const bool fits = is_folder || std::find(endings.begin(), endings.end(),
                                                 small(at->path().extension().string())) != endings.end();
        if (fits && (hidden || name[0] != '.')) entries.push_back({name, is_folder});
    }
    std::sort(entries.begin(), entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
        return a.is_folder != b.is_folder ? a.is_folder : a.name < b.name;
    });
    return entries;
}

std::vector<FolderEntry> filtered(const std::vector<FolderEntry>& entries, std::string_view letters) {
    const std::string wanted = small(std::string(letters));
    std::vector<FolderEntry> first, others;
    for (const FolderEntry& entry : entries) {
        const std::size_t at = small(entry.name).find(wanted);
        if (at != std::string::npos) (at == 0 ? first : others).push_back(entry);
    }
    first.insert(first.end(), others.begin(), others.end());
    return first;
}

std::string with_entry(const std::string& path, const FolderEntry& entry) {
    return parts_of(path).folder + entry.name + (entry.is_folder ? "/" : "");
}

std::string one_up(const std::string& folder) {
    if (folder.empty() || folder == "/") return folder.empty() ? "../" : folder;
    const std::string without = folder.substr(0, folder.size() - 1);
    const PathParts parts = parts_of(without);
    // Relative paths start in the working directory.
    if (parts.name == "..") return folder + "../";
    return parts.name == "~" ? one_up(expanded("~/")) : parts.folder;
}

std::string completed(const std::string& path, const std::vector<FolderEntry>& entries) {
    const PathParts parts = parts_of(path);
    std::vector<FolderEntry> fitting;
    for (const FolderEntry& entry : entries)
        if (entry.name.starts_with(parts.name)) fitting.push_back(entry);
    if (fitting.size() == 1) return with_entry(path, fitting[0]);
    if (fitting.empty()) return path;
    std::string common = fitting[0].name;
    for (const FolderEntry& entry : fitting)
        common.resize(static_cast<std::size_t>(
            std::mismatch(common.begin(), common.end(), entry.name.begin(), entry.name.end()).first - common.begin()));
    return parts.folder + common;
}

}  // namespace achilles
