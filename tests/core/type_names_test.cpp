// Names of types: two types with one name in one namespace break the rule of one definition. The linker keeps one of their
// inline functions for both, without a word.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace achilles {
namespace {

// The types that a file defines at the outermost level of a named namespace, "achilles::Mode".
std::vector<std::string> types_in(const std::filesystem::path& file) {
    static const std::regex opening(R"(^namespace ?([\w:]*) ?\{$)"), closing(R"(^\}  // namespace.*$)"),
        definition(R"(^(?:template.*> )?(?:struct|class|enum class|union) (\w+)(?: final)?(?: :[^;]*)?(?: \{.*)?$)");
    std::vector<std::string> namespaces, types;
    std::ifstream text(file);
    for (std::string line; std::getline(text, line);) {
        std::smatch found;
        if (std::regex_match(line, found, opening)) {
            namespaces.push_back(found[1]);
        } else if (std::regex_match(line, closing)) {
            if (!namespaces.empty()) namespaces.pop_back();
        } else if (std::regex_match(line, found, definition) && line.back() != ';') {
            std::string name;
            bool is_unnamed = false;
            for (const std::string& each : namespaces) {
                is_unnamed = is_unnamed || each.empty();
                name += each + "::";
            }
            if (!is_unnamed) types.push_back(name + found[1].str());
        }
    }
    return types;
}

TEST(TypeNames, AreDefinedInOneFile) {
    std::map<std::string, std::string> homes;
    for (const char* folder : {"core", "render", "app"})
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::filesystem::path(ACHILLES_SOURCE_DIR) / folder)) {
            const std::string file = entry.path().string();
            if (!file.ends_with(".hpp") && !file.ends_with(".cpp")) continue;
            for (const std::string& type : types_in(entry.path())) {
                const auto [home, is_new] = homes.try_emplace(type, file);
                EXPECT_TRUE(is_new || home->second == file)
                    << type << " is defined in " << home->second << " and " << file;
            }
        }
    EXPECT_GT(homes.size(), 500U);
}

}  // namespace
}  // namespace achilles
