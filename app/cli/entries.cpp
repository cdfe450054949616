#include "cli/entries.hpp"

#include <algorithm>

#include "cli/assets.hpp"
#include "journal/journal.hpp"
#include "model/read_system.hpp"
#include "session/glossary.hpp"

namespace achilles {

std::vector<SystemEntry> known_systems() {
    std::vector<SystemEntry> entries;
    for (const std::filesystem::path& file : system_files()) {
        const std::string name = file.stem().string();
        try {
            entries.push_back({name, read_system(file).title, std::string(group_of(name))});
        } catch (const InputError&) {
            // It stays in the list: choosing it shows what is wrong with it.
            entries.push_back({name, name, std::string(group_of(name))});
        }
    }
    std::stable_sort(entries.begin(), entries.end(), [](const SystemEntry& a, const SystemEntry& b) {
        return place_in_gallery(a.name) < place_in_gallery(b.name);
    });
    return entries;
}

std::vector<SystemEntry> known_tours() {
    std::vector<SystemEntry> entries;
    for (const std::filesystem::path& file : journal_files()) {
        const std::string name = file.stem().string();
        try {
            const std::string text = journal_file(file);
            const std::string line = text.substr(0, text.find('\n'));
            entries.push_back({name, line.rfind("# ", 0) == 0 ? line.substr(2) : name});
        } catch (const InputError&) {
            entries.push_back({name, name});  // choosing it tells what is wrong with it
        }
    }
    return entries;
}

}  // namespace achilles
