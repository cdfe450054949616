// Location of the assets, and lookup of systems, journals and manual pages. Every file in assets/systems is a system.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

// The folder with systems/, journals/, manual/ and fonts/: $ACHILLES_ASSETS, else "assets" beside the binary, else
// "../share/achilles". Throws InputError if none exists.
std::filesystem::path assets();
// Looks for the assets beside this file from now on. A library needs this: it is not in the folder of its host program.
void look_for_assets_beside(const std::filesystem::path& file);

// The system files in assets/systems, sorted by name.
std::vector<std::filesystem::path> system_files();

// Their names: valid values of SYSTEM besides paths.
std::vector<std::string> system_names();

// The same for journals: every file in assets/journals is a tour.
std::vector<std::filesystem::path> journal_files();
std::filesystem::path find_journal(std::string_view journal);

// The pages of the manual.
std::vector<std::filesystem::path> manual_files();

// True if SYSTEM or JOURNAL has the form of a path, existing or not; false if it is the name of an asset.
bool is_system_path(std::string_view system);
bool is_journal_path(std::string_view journal);

// The file of SYSTEM, a path or a name. Throws InputError with the closest name and the list of names.
std::filesystem::path find_system(std::string_view system);

}  // namespace achilles
