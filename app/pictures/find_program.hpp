// Programs that others have written and that may be installed: asked for at run time, never needed.
#pragma once

#include <string>

namespace achilles {

// The path of a program of that name, in the folders of PATH; empty where there is none.
std::string find_program(const std::string& name);

}  // namespace achilles
