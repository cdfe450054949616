#include "assets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "expression/nearest.hpp"
#include "model/description.hpp"

namespace achilles {

namespace fs = std::filesystem;

fs::path assets() {
    std::error_code problem;
    if (const char* given = std::getenv("ACHILLES_ASSETS"); given != nullptr && *given != '\0') {
        if (!fs::is_directory(given, problem))
            throw InputError("ACHILLES_ASSETS", {}, fmt::format("'{}' is no folder", given));
        return given;
    }
    const fs::path binary = fs::read_symlink("/proc/self/exe", problem);
    const fs::path places[] = {binary.parent_path() / "assets", binary.parent_path().parent_path() / "share/achilles"};
    for (const fs::path& place : places)
        if (fs::is_directory(place, problem)) return place;
    throw InputError({}, {},
                     fmt::format("the assets are neither in {} nor in {}", places[0].string(), places[1].string()),
                     "set ACHILLES_ASSETS to the folder that holds systems/ and fonts/");
}

std::vector<fs::path> system_files() {
    std::vector<fs::path> files;
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(assets() / "systems", problem))
        if (entry.path().extension() == ".toml" && entry.is_regular_file(problem)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> system_names() {
    std::vector<std::string> names;
    for (const fs::path& file : system_files()) names.push_back(file.stem().string());
    return names;
}

fs::path find_system(std::string_view system) {
    // What looks like a path is one, there or not: its absence is read_system's to tell.
    std::error_code problem;
    const fs::path path{std::string(system)};
    if (path.has_parent_path() || path.extension() == ".toml" || fs::is_regular_file(path, problem)) return path;
    for (const fs::path& file : system_files())
        if (file.stem() == path) return file;
    const std::vector<std::string> names = system_names();
    throw InputError({}, {}, fmt::format("there is no system '{}'{}", system, did_you_mean(system, names)),
                     fmt::format("a system is a path to a .toml file or one of: {}", fmt::join(names, ", ")));
}

}  // namespace achilles
