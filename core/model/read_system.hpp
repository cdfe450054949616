// A system file, read with all its expressions: every mistake in it is told at once.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "../system/description.hpp"

namespace achilles {

// Reads a file, and all its expressions to see whether they can be. Throws InputError where there is nothing to read
// (no file, no TOML), else InputErrors: all mistakes.
SystemDescription read_system(const std::filesystem::path& file);
// The same from text; `name` stands for the file in messages.
SystemDescription parse_system(std::string text, std::string name = "<text>");

class Model;
// The equations of motion of a system, derived and compiled once, for all its runs. Throws InputErrors for T, V, h or e that is
// not what it should be.
std::shared_ptr<const Model> derive(SystemDescription description);

}  // namespace achilles
