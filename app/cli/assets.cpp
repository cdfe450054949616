#include "cli/assets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "expression/name_suggestions.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

// The binary beside which assets() looks.
fs::path& binary() {
    std::error_code problem;
    static fs::path file = fs::read_symlink("/proc/self/exe", problem);
    return file;
}

}  // namespace

void look_for_assets_beside(const fs::path& file) { binary() = file; }

fs::path assets() {
    std::error_code problem;
    if (const char* given = std::getenv("ACHILLES_ASSETS"); given != nullptr && *given != '\0') {
        if (!fs::is_directory(given, problem))
            throw InputError("ACHILLES_ASSETS", {}, fmt::format("'{}' is not a folder", given));
        return given;
    }
    const fs::path folder = binary().parent_path();
    const fs::path places[] = {folder / "assets", folder.parent_path() / "share/achilles"};
    for (const fs::path& place : places)
        if (fs::is_directory(place, problem)) return place;
    throw InputError({}, {}, fmt::format("no assets found in {} or in {}", places[0].string(), places[1].string()),
                     "set ACHILLES_ASSETS to the folder that holds systems/ and fonts/");
}

namespace {

std::vector<fs::path> files_in(const char* folder, const char* extension) {
    std::vector<fs::path> files;
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(assets() / folder, problem))
        if (entry.path().extension() == extension && entry.is_regular_file(problem)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool is_path(const fs::path& path, const char* extension) {
    std::error_code problem;
    return path.has_parent_path() || path.extension() == extension || fs::is_regular_file(path, problem);
}

constexpr const char *of_systems = ".toml", *of_journals = ".journal";

// Appends the names of files with this extension in a folder.
void add_files_in(const fs::path& folder, const char* extension, std::vector<std::string>& names) {
    constexpr std::size_t most = 10000;
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, problem)) {
        if (names.size() == most) return;
        if (entry.path().extension() == extension) names.push_back((folder / entry.path().filename()).string());
    }
}

// Error if the user names a folder instead of a file; the hint suggests a file in it.
InputError a_folder(const fs::path& folder, const char* kind, const char* extension) {
    std::vector<std::string> names;
    add_files_in(folder, extension, names);
    std::sort(names.begin(), names.end());
    return {folder.string(),
            {},
            fmt::format("this is a folder; a {} file is expected{}", kind,
                        names.empty() ? "" : fmt::format(", for example {}", names.front()))};
}

// Resolves a path or the name of one of `files`. A word in the form of a path is returned even if the file does not
// exist, unless the gallery has such a file; the reader then reports that it is missing.
fs::path find(std::string_view wanted, const std::vector<fs::path>& files, const char* kind, const char* extension) {
    const fs::path path{std::string(wanted)};
    std::error_code problem;
    const bool is_there = fs::exists(path, problem);
    std::vector<std::string> names;
    for (const fs::path& file : files) {
        if (file.stem() == path && !is_path(path, extension)) return file;
        if (!is_there && file.filename() == path.filename() && !path.has_parent_path())
            throw InputError(
                path.string(), {},
                fmt::format("there is no such file here; write {} for the one in the gallery", file.stem().string()));
        names.push_back(file.stem().string());
    }
    if (fs::is_directory(path, problem)) throw a_folder(path, kind, extension);
    if (is_path(path, extension)) return path;
    const fs::path beside = fs::path(path) += extension;
    if (fs::is_regular_file(beside, problem))
        throw InputError({}, {},
                         fmt::format("there is no {} '{}'; did you mean the file {}?", kind, wanted, beside.string()));
    add_files_in("", extension, names);
    const std::string meant = did_you_mean(wanted, names);
    throw InputError(
        {}, {},
        fmt::format("there is no {} '{}'{}", kind, shown(wanted),
                    !meant.empty()            ? meant
                    : extension == of_systems ? "; SYSTEM is the path of a .toml file or a name from 'achilles list'"
                                              : fmt::format("; write the path of a {} file, or one of: {}", extension,
                                                            fmt::join(names, ", "))));
}

}  // namespace

std::vector<fs::path> system_files() { return files_in("systems", of_systems); }

std::vector<fs::path> journal_files() { return files_in("journals", of_journals); }

std::vector<fs::path> manual_files() { return files_in("manual", ".md"); }

std::vector<std::string> system_names() {
    std::vector<std::string> names;
    for (const fs::path& file : system_files()) names.push_back(file.stem().string());
    return names;
}

bool is_system_path(std::string_view system) { return is_path(std::string(system), of_systems); }

bool is_journal_path(std::string_view journal) { return is_path(std::string(journal), of_journals); }

fs::path find_system(std::string_view system) { return find(system, system_files(), "system", of_systems); }

fs::path find_journal(std::string_view journal) { return find(journal, journal_files(), "journal", of_journals); }

}  // namespace achilles
