// Reads a system file with all its expressions, and reports every mistake in it at once.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "../system/description.hpp"

namespace achilles {

// Reads a file and checks all its expressions. Throws InputError if it cannot be read (no file, not TOML), otherwise
// InputErrors with all mistakes.
SystemDescription read_system(const std::filesystem::path& file);
// The same from text; `name` stands for the file in messages.
SystemDescription parse_system(std::string text, std::string name = "<text>");

// The file with energies, forces, gaps and drawings in place of bodies, as TOML: it describes the same system. Throws like
// parse_system().
std::string expand_system(const std::string& text, const std::string& name);

class Model;
// The equations of motion of a system, derived and compiled once for all its runs. Throws InputErrors if T, V, h or e
// is invalid.
std::shared_ptr<const Model> derive(SystemDescription description);

}  // namespace achilles
