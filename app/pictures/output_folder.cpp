#include "pictures/output_folder.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "system/description.hpp"

namespace achilles {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(fs::path folder) : path_(std::move(folder)) {
    std::error_code problem;
    made_ = fs::create_directories(path_, problem);
    if (!fs::is_directory(path_))
        throw InputError(path_.string(), {}, fmt::format("the folder cannot be created: {}", problem.message()));
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    if (made_) fs::remove(path_, ignored);  // only if it is empty
}

}  // namespace achilles
