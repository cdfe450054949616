#include "model/read_system.hpp"

#include <utility>

#include "model/read_expressions.hpp"
#include "number/ground.hpp"
#include "system/read_tables.hpp"

namespace achilles {

SystemDescription read_system(const std::filesystem::path& file) {
    return parse_system(read_text(file), file.string());
}

SystemDescription parse_system(std::string text, std::string name) {
    const Ground ground;  // constants become intervals, too
    FileReading read = read_tables(std::move(text), std::move(name));
    check_expressions(read.system, std::move(read.names), read.mistakes);
    read.mistakes.raise(read.system);
    return std::move(read.system);
}

}  // namespace achilles
