// Where the assets are, and which systems there are. A file in assets/systems is a system: the folder is the registry.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

// The folder that holds systems/, journals/, manual/ and fonts/: $ACHILLES_ASSETS, else "assets" beside the binary, else
// "../share/achilles". Throws InputError if none is there.
std::filesystem::path assets();
// The binary is this file from now on: a library does not lie where the program lies that has loaded it.
void look_for_assets_beside(const std::filesystem::path& file);

// The system files in assets/systems, sorted by name.
std::vector<std::filesystem::path> system_files();

// The same as names: what SYSTEM may be besides a path.
std::vector<std::string> system_names();

// The same of journals: a file in assets/journals is a tour.
std::vector<std::filesystem::path> journal_files();
std::filesystem::path find_journal(std::string_view journal);

// The pages of the manual.
std::vector<std::filesystem::path> manual_files();

// Whether SYSTEM or JOURNAL is a path, there or not, rather than the name of one of the assets.
bool is_system_path(std::string_view system);
bool is_journal_path(std::string_view journal);

// The file of SYSTEM, a path or a name. Throws InputError with the nearest name and the list of names.
std::filesystem::path find_system(std::string_view system);

}  // namespace achilles
