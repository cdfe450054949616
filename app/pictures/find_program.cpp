#include "pictures/find_program.hpp"

#include <unistd.h>

#include <cstdlib>
#include <sstream>

namespace achilles {

std::string find_program(const std::string& name) {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (const std::string file = folder + "/" + name; !folder.empty() && ::access(file.c_str(), X_OK) == 0)
            return file;
    return {};
}

}  // namespace achilles
